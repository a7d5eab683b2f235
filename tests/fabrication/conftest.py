"""Small structures the tests share, built once: exact and optimised nets, a tube, a saddle."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from io import BytesIO
from itertools import pairwise
from math import radians
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import settings

import fabrication as fab
import gridshell as gs
from fabrication import kernel_job
from fabrication.bodies import structure_bodies
from fabrication.cut import Cuts, Slot, outline
from fabrication.jointed import Jointed
from fabrication.panel_structure import PanelStructure, PanelSystem, panelled
from fabrication.unroll import Development
from gridshell.mesh import grid_quads

settings.register_profile("no deadline", deadline=None)
settings.load_profile("no deadline")


@dataclass(frozen=True, eq=False)
class Design:
    """A net and what is built of it."""

    control: gs.ControlMesh
    net: gs.DiagonalMesh
    structure: fab.Structure
    parts: tuple[fab.FlatPart, ...]

    def lamella(self, mark: str) -> fab.Lamella:
        return next(one for one in self.structure.lamellas if one.mark == mark)

    def part(self, mark: str) -> fab.FlatPart:
        return next(one for one in self.parts if one.mark == mark)


@dataclass(frozen=True, eq=False)
class Files:
    """A design as a shop gets it."""

    solids: list[Any]
    nested: tuple[fab.NestedSheet, ...]
    sheets: list[Path]
    step: Path
    net: gs.DiagonalMesh


# ---- stock and nets -------------------------------------------------------------------------


@pytest.fixture(scope="session")
def profile() -> fab.Profile:
    return fab.Profile(width=100.0, thickness=2.5, material=fab.STAINLESS)


@pytest.fixture(scope="session")
def sheet() -> fab.Sheet:
    return fab.Sheet(12000.0, 1500.0)


def _design(control: gs.ControlMesh, profile: fab.Profile) -> Design:
    net = gs.diagonal_meshes(control)[0]
    structure = fab.structure(net, profile)
    return Design(control, net, structure, fab.flat_parts(structure, fab.SlotJoint()))


@pytest.fixture(scope="session")
def catenoid(profile: fab.Profile) -> Design:
    """Five lamellas each way on an exact catenoid: every angle is 90 degrees."""
    patch = gs.AsymptoticPatch(p=(-0.5, 0.5), q=(-0.5, 0.5), lamellas=(5, 5))
    return _design(gs.control_patch(gs.Catenoid(4000.0), patch), profile)


@pytest.fixture(scope="session")
def enneper(profile: fab.Profile) -> Design:
    """Five lamellas each way, optimised from Enneper's surface to 60 degrees."""
    patch = gs.AsymptoticPatch(p=(-0.5, 0.5), q=(-0.5, 0.5), lamellas=(5, 5))
    start = gs.control_patch(gs.Enneper(4000.0), patch)
    result = gs.optimize(start, gs.a_net(angle=radians(60)), anchor=gs.Free())
    return _design(result.require().control, profile)


@pytest.fixture(scope="session")
def hypar(profile: fab.Profile) -> Design:
    """Three straight lamellas one way and four the other."""
    patch = gs.AsymptoticPatch(p=(-0.3, 0.3), q=(-0.2, 0.4), lamellas=(3, 4))
    return _design(gs.control_patch(gs.Hypar(6000.0), patch), profile)


@pytest.fixture(scope="session")
def pair(profile: fab.Profile) -> Design:
    """Two lamellas each way with two nodes each."""
    patch = gs.AsymptoticPatch(p=(-0.15, 0.15), q=(-0.15, 0.15), lamellas=(2, 2))
    return _design(gs.control_patch(gs.Catenoid(4000.0), patch), profile)


@pytest.fixture(scope="session")
def ring(profile: fab.Profile) -> Design:
    """A catenoid all around, crossed by helical lamellas."""
    patch = gs.BisectingPatch(v=(-0.6, 0.6), cells=24)
    return _design(gs.control_patch(gs.Catenoid(4000.0), patch), profile)


@pytest.fixture(scope="session")
def tube(profile: fab.Profile) -> Design:
    """The edges of a grid around a hyperboloid: closed hoops and open meridians."""
    around, across = 32, 6
    angle = 2.0 * np.pi * np.arange(around) / around
    angle, z = np.meshgrid(angle, np.linspace(-600.0, 600.0, across + 1), indexing="ij")
    radius = 1500.0 * np.hypot(1.0, z / 3000.0)
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), z], axis=-1).reshape(-1, 3)
    mesh = gs.QuadMesh(points, grid_quads(around, across, ring=True))
    return _design(gs.control_mesh(mesh), profile)


@pytest.fixture(scope="session")
def saddle_mesh() -> gs.QuadMesh:
    """Six sectors of rhombi around one vertex of valence six, lifted to a monkey saddle."""
    size, rays = 4, 2.0 * np.pi * np.arange(7) / 6
    corners, quads = [], []
    for a, b in pairwise(rays):
        i, j = np.meshgrid(np.arange(size + 1), np.arange(size + 1), indexing="ij")
        x, y = (i * f(a) + j * f(b) for f in (np.cos, np.sin))
        quads.append(grid_quads(size, size) + len(corners) * (size + 1) ** 2)
        corners.append(np.stack([x.ravel(), y.ravel()], axis=1))
    flat, number = np.unique(np.round(np.concatenate(corners), 9), axis=0, return_inverse=True)
    x, y = flat.T
    points = 600.0 * np.stack([x, y, 0.02 * (x**3 - 3.0 * x * y * y)], axis=1)
    return gs.QuadMesh(points, number[np.concatenate(quads)])


@pytest.fixture(scope="session")
def saddle(saddle_mesh: gs.QuadMesh, profile: fab.Profile) -> Design:
    """A net with one node where six lamellas end."""
    control = gs.as_control_mesh(saddle_mesh)
    nets = gs.diagonal_meshes(control)
    net = next(net for net in nets if net.stars.count.max() == 6)
    structure = fab.structure(net, profile)
    return Design(control, net, structure, fab.flat_parts(structure, fab.SlotJoint()))


# ---- parts and files ------------------------------------------------------------------------


def recut(part: fab.FlatPart, slots: Sequence[Slot]) -> fab.FlatPart:
    """The same strip with other slots."""
    return replace(part, slots=tuple(slots), outline=outline(part.length, part.width, slots))


@pytest.fixture(scope="session")
def with_slots() -> Callable[[fab.FlatPart, Sequence[Slot]], fab.FlatPart]:
    return recut


@pytest.fixture(scope="session")
def strip() -> Callable[..., fab.FlatPart]:
    """A strip of any size that belongs to no structure."""

    def build(
        mark: str, length: float, slots: Sequence[Slot] = (), width: float = 100.0
    ) -> fab.FlatPart:
        return fab.FlatPart(
            mark=mark,
            outline=outline(length, width, slots),
            slots=tuple(slots),
            labels=(),
            width=width,
            thickness=2.5,
            development=Development(length, np.zeros(0), 0.0, 0.0),
        )

    return build


@pytest.fixture(scope="session")
def files(tmp_path_factory: pytest.TempPathFactory, sheet: fab.Sheet) -> Callable[[Design], Files]:
    """Write a design once: sheets, assembly and net, all read back from disk later."""
    written: dict[int, Files] = {}

    def write(design: Design) -> Files:
        if id(design) not in written:
            folder = tmp_path_factory.mktemp("files")
            solids = fab.solids(design.structure, design.parts)
            nested = fab.nest(design.parts, sheet)
            step = folder / "structure.step"
            fab.write_step(fab.assembly(solids, design.structure, name="shell"), step)
            gs.write_net(folder / "net.json", design.control)
            net = gs.diagonal_meshes(gs.read_net(folder / "net.json"))[0]
            sheets = fab.write_dxf(nested, folder / "sheets")
            written[id(design)] = Files(solids, nested, sheets, step, net)
        return written[id(design)]

    return write


# ---- the CAD kernel -------------------------------------------------------------------------


class KernelProcess:
    """Stands in for the kernel's own process and does its work in this one."""

    returncode = 0

    def __init__(self, command: Sequence[str], **_: Any) -> None:
        self.order, self.answer = map(Path, command[-2:])
        self.stdin = BytesIO()

    def communicate(self) -> tuple[bytes, bytes]:
        answer = kernel_job._work(self.order, self.stdin.getvalue)
        self.answer.write_bytes(pickle.dumps(answer))
        return b"", b""

    def poll(self) -> int:
        return self.returncode


@pytest.fixture(scope="session")
def stand_in() -> SimpleNamespace:
    """What to put in the place of ``subprocess`` to have the kernel's work done here."""
    return SimpleNamespace(Popen=KernelProcess, DEVNULL=None, PIPE=None)


@pytest.fixture(scope="module")
def kernel_here(stand_in: SimpleNamespace) -> Iterator[None]:
    """Let runs use the kernel that is loaded here: another process takes seconds to load it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(kernel_job, "subprocess", stand_in)
        yield


# ---- nets of planar quads -------------------------------------------------------------------


def _dome(degrees: float) -> gs.ControlMesh:
    """A dome of some 24 m whose D1 has about 700 panels with sides of a metre."""
    x, y = np.meshgrid(np.linspace(-1, 1, 39), np.linspace(-1, 1, 41), indexing="ij")
    z = -0.35 * x**2 - 0.25 * y**2 + 0.05 * x * y**2
    points = 12_000.0 * np.stack([x, y, z], axis=-1).reshape(-1, 3)
    start = gs.as_control_mesh(gs.QuadMesh(points, grid_quads(38, 40)))
    recipe = gs.pq_net(angle=np.radians(degrees))
    return gs.optimize(start, recipe, anchor=gs.Free()).require().control


@pytest.fixture(scope="session")
def principal_dome() -> gs.ControlMesh:
    """Planar quads with a node angle of 90 degrees."""
    return _dome(90.0)


@pytest.fixture(scope="session")
def oblique_dome() -> gs.ControlMesh:
    """Planar quads with a node angle of 75 degrees."""
    return _dome(75.0)


@pytest.fixture(scope="session")
def paraboloid() -> gs.ControlMesh:
    """z = (x^2 + y^2) / (2 R), R = 5 m, swept along itself: exact parallelograms.

    The edges of D1 and D2 run along x and y over 600 mm, and their axes are the surface's normals.
    """
    x, y = np.meshgrid(300.0 * np.arange(-6.0, 7.0), 300.0 * np.arange(-5.0, 6.0), indexing="ij")
    points = np.stack([x, y, (x**2 + y**2) / 10_000.0], axis=-1).reshape(-1, 3)
    return gs.control_mesh(gs.QuadMesh(points, grid_quads(12, 10)))


# ---- planar nets ----------------------------------------------------------------------------

SYSTEM = PanelSystem(
    panels=fab.PanelSpec(gap=10.0, thickness=8.0, material=fab.GLASS, clearance=1.0),
    plates=fab.PlateSection(-120.0, -10.0, 6.0, fab.S235, setback=16.0),
    connectors=fab.ConnectorSpec(30.0, 90.0, 6.0, 0.3, 15.0),
    connector_material=fab.STAINLESS,
)


def on_first_skin(control: gs.ControlMesh, system: PanelSystem = SYSTEM) -> PanelStructure:
    return panelled(gs.skin(control, gs.Skin.D1), system)


@pytest.fixture(scope="session")
def tower() -> PanelStructure:
    """Three equal storeys' worth of parts around a hyperboloid, at 90 degrees."""
    patch = gs.ConjugatePatch(v=(-0.4, 0.5), panels=(8, 3))
    return on_first_skin(gs.control_patch(gs.Hyperboloid(2000.0, 3000.0), patch))


@pytest.fixture(scope="session")
def leaning() -> PanelStructure:
    """Panels at 70 degrees, so that plates are twisted."""
    patch = gs.ConjugatePatch(u=(-0.3, 0.4), v=(-0.35, 0.3), panels=(4, 3))
    start = gs.control_patch(gs.Enneper(5000.0), patch)
    recipe = gs.pq_net(angle=radians(70.0), conditions=(gs.FlatRim(),))
    return on_first_skin(gs.optimize(start, recipe, anchor=gs.Free()).require().control)


@pytest.fixture(scope="session")
def bodies_file(tmp_path_factory: pytest.TempPathFactory) -> Callable[[PanelStructure], Path]:
    """The STEP file of a structure, written once."""
    written: dict[int, Path] = {}

    def write(built: PanelStructure) -> Path:
        if id(built) not in written:
            from fabrication.export.step_bodies import write_bodies

            path = tmp_path_factory.mktemp("bodies") / "structure.step"
            write_bodies(structure_bodies(built), path, name="Käfig")
            written[id(built)] = path
        return written[id(built)]

    return write


@pytest.fixture(scope="session")
def in_program():
    """Writes a quad mesh in metres as Rhino (.3dm) or COMPAS (.json) do."""
    import rhino3dm
    from compas.datastructures import Mesh

    def write(path, mesh):
        metres, quads = (mesh.vertices / 1e3).tolist(), mesh.quads.tolist()
        if path.suffix == ".json":
            Mesh.from_vertices_and_faces(metres, quads).to_json(str(path))
            return
        file, made = rhino3dm.File3dm(), rhino3dm.Mesh()
        file.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Meters
        made.Vertices.UseDoublePrecisionVertices = True
        for row in metres:
            made.Vertices.AddPoint3d(*row)
        for quad in quads:
            made.Faces.AddFace(*quad)
        file.Objects.AddMesh(made, rhino3dm.ObjectAttributes())
        assert file.Write(str(path), 7)

    return write


@pytest.fixture(scope="session")
def drilled_tubes() -> Callable[[gs.ControlMesh], tuple[fab.Structure, tuple[fab.FlatPart, ...]]]:
    """Tubes of 50 x 20 x 2.5 mm on a net, drilled 8.3 mm at every node: structure and parts."""

    def build(control: gs.ControlMesh) -> tuple[fab.Structure, tuple[fab.FlatPart, ...]]:
        profile = fab.HollowProfile(50.0, 20.0, fab.GRP, 2.5)
        design = fab.structure(gs.diagonal_meshes(control)[0], profile)
        cuts = {
            strip.mark: Cuts(
                drills=tuple(
                    fab.Drill(float(s - strip.start), 8.3, f"N{i}", "pin")
                    for i, s in enumerate(strip.stations)
                )
            )
            for strip in design.lamellas
        }
        jointed = Jointed(design, design, tuple(range(len(design.lamellas))), cuts, ())
        return design, fab.parts_of(jointed)

    return build
