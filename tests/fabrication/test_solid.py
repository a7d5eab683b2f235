import sys
from dataclasses import replace
from importlib.util import module_from_spec, spec_from_file_location

import build123d
import cadquery
import numpy as np
import pytest
from OCP.BRepCheck import BRepCheck_Analyzer

import fabrication as fab
import gridshell as gs
from fabrication import solid
from fabrication.colours import FAMILY_COLOURS
from fabrication.cut import Edge, Floor, Hole, Relief, Slot
from fabrication.errors import KernelError
from fabrication.parts import parts_of

pytestmark = pytest.mark.xdist_group("kernel")

NAMES = ["catenoid", "enneper", "hypar", "pair"]


@pytest.fixture(scope="module")
def hoop(tube):
    """A closed strip and its solid."""
    lamella = next(one for one in tube.structure.lamellas if one.closed)
    part = tube.part(lamella.mark)
    return lamella, part, solid.lamella_solid(lamella, part)


@pytest.mark.parametrize("name", NAMES)
def test_solids_are_valid_and_closed(name, request, files):
    for body in files(request.getfixturevalue(name)).solids:
        assert body.is_valid
        assert body.is_manifold


@pytest.mark.parametrize("name", NAMES)
def test_bending_keeps_the_volume(name, request, files):
    design = request.getfixturevalue(name)
    for body, part in zip(files(design).solids, design.parts, strict=True):
        flat = part.area * part.thickness
        assert solid.volume(body.wrapped) == pytest.approx(flat, rel=20e-6)


@pytest.mark.parametrize("name", NAMES)
def test_there_is_one_face_per_outline_edge_and_two_sides(name, request, files):
    design = request.getfixturevalue(name)
    for body, part in zip(files(design).solids, design.parts, strict=True):
        assert len(body.faces()) == len(part.outline) + 2


def test_long_bays_keep_the_volume_too(profile):
    """Two nodes 1.43 m apart, twisted by 20 degrees between them."""
    patch = gs.AsymptoticPatch(p=(-0.25, 0.25), q=(-0.25, 0.25), lamellas=(2, 2))
    net = gs.diagonal_meshes(gs.control_patch(gs.Catenoid(4000.0), patch))[0]
    structure = fab.structure(net, profile)
    part = fab.flat_parts(structure, fab.SlotJoint())[0]
    found = solid.volume(solid.lamella_solid(structure.lamellas[0], part))
    assert found == pytest.approx(part.area * part.thickness, rel=20e-6)


def test_a_closed_strip_is_a_valid_solid(hoop):
    _, part, body = hoop
    assert BRepCheck_Analyzer(body).IsValid()
    assert len(build123d.Solid(body).faces()) == len(part.outline) + 2


def test_a_closed_strip_keeps_its_volume(hoop, with_slots):
    """Without slots: a hoop bends edgewise, and slots on one side only would miss the balance."""
    lamella, part, _ = hoop
    bare = with_slots(part, [])
    found = solid.volume(solid.lamella_solid(lamella, bare))
    assert found == pytest.approx(bare.area * bare.thickness, rel=20e-6)


def test_a_closed_strip_stops_a_millimetre_short_of_its_own_start(hoop):
    lamella, part, body = hoop
    vertices = np.array([tuple(v) for v in build123d.Solid(body).vertices()])
    ends = [
        lamella.place(np.full(2, s), np.full(2, part.thickness / 2.0), np.array([-50.0, 50.0]))
        for s in (lamella.start, lamella.end)
    ]
    for point in np.concatenate(ends):
        assert np.linalg.norm(vertices - point, axis=1).min() < 1e-3
    assert np.linalg.norm(ends[0] - ends[1], axis=1) == pytest.approx([1.0, 1.0], abs=0.05)


def test_corners_of_a_solid_are_the_placed_corners_of_its_outline(enneper, files):
    lamella, part = enneper.structure.lamellas[1], enneper.parts[1]
    x, y = part.outline.T
    half = np.full(len(x), part.thickness / 2.0)
    expected = np.concatenate(
        [lamella.place(x + lamella.start, side * half, y - part.width / 2.0) for side in (1, -1)]
    )
    found = np.array([tuple(v) for v in files(enneper).solids[1].vertices()])
    apart = np.linalg.norm(found[:, None] - expected, axis=2)
    assert len(found) == len(expected)
    assert apart.min(axis=1).max() < 5e-3
    assert apart.min(axis=0).max() < 5e-3


def test_the_width_stands_on_the_surface_and_the_slots_open_upwards(hypar, files):
    """The middle of an upper slot of family A is empty in the solid, that of its floor is not."""
    lamella, part, body = hypar.structure.lamellas[0], hypar.parts[0], files(hypar).solids[0]
    s = np.array([part.slots[0].x + lamella.start])
    above, below = (lamella.place(s, np.zeros(1), np.array([z]))[0] for z in (20.0, -20.0))
    assert part.slots[0].edge is Edge.UPPER
    assert not body.is_inside(build123d.Vector(*above))
    assert body.is_inside(build123d.Vector(*below))


def test_solids_carry_the_mark_and_the_colour_of_their_family(pair, files):
    solids = files(pair).solids
    assert [body.label for body in solids] == ["A1", "A2", "B1", "B2"]
    for body, lamella in zip(solids, pair.structure.lamellas, strict=True):
        assert tuple(body.color)[:3] == pytest.approx(FAMILY_COLOURS[lamella.family], abs=1e-6)


def test_solids_are_build123d_solids(pair, files):
    assert {type(body) for body in files(pair).solids} == {build123d.Solid}


@pytest.mark.parametrize(
    ("case", "x", "width", "depth"),
    [
        ("two slots that overlap", (500.0, 501.0), 3.0, 50.0),
        ("a slot through the whole strip", (500.0,), 3.0, 120.0),
    ],
)
def test_a_strip_that_falls_apart_is_refused(pair, with_slots, case, x, width, depth):
    slots = [Slot(at, width, depth, Edge.UPPER, "N1", "B1") for at in x]
    with pytest.raises(KernelError, match="refuses") as info:
        solid.lamella_solid(pair.structure.lamellas[0], with_slots(pair.parts[0], slots))
    assert info.value.where == "A1", case


def test_a_slot_that_runs_out_of_the_strip_is_refused(pair, with_slots):
    slots = [Slot(1.0, 3.0, 50.0, Edge.UPPER, "N1", "B1")]
    with pytest.raises(KernelError, match="cannot make") as info:
        solid.lamella_solid(pair.structure.lamellas[0], with_slots(pair.parts[0], slots))
    assert info.value.where == "A1"


def test_as_many_parts_as_lamellas_are_needed(pair):
    with pytest.raises(ValueError, match="argument"):
        fab.solids(pair.structure, pair.parts[:-1])


def test_a_twisted_solid_is_measured_more_finely_than_the_kernel_does_by_itself(catenoid, files):
    """The kernel's own integration is off by several ppm; the error must not hide in the figure."""
    body, part = files(catenoid).solids[0], catenoid.parts[0]
    exact = part.area * part.thickness
    assert abs(solid.volume(body.wrapped) - exact) < 0.2 * abs(body.volume - exact)


def test_without_the_kernel_the_error_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "build123d", None)
    spec = spec_from_file_location("without_kernel", solid.__file__)
    with pytest.raises(KernelError, match="cannot be loaded") as info:
        spec.loader.exec_module(module_from_spec(spec))
    assert "libgl1" in info.value.advice


def test_thickness_is_centred_on_the_middle_surface(pair, with_slots):
    """Twice the thickness gives twice the volume, grown evenly to both sides."""
    lamella, part = pair.structure.lamellas[0], with_slots(pair.parts[0], [])
    thick = replace(part, thickness=2.0 * part.thickness)
    thin_volume, thick_volume = (
        solid.volume(solid.lamella_solid(lamella, one)) for one in (part, thick)
    )
    assert thick_volume == pytest.approx(2.0 * thin_volume, rel=1e-5)


# ---- arcs, holes and bevelled ends --------------------------------------------------------------


@pytest.mark.parametrize("relief", [Relief(), Relief(Floor.ROUND), Relief(Floor.DOGBONE, 0.3)])
@pytest.mark.parametrize("bevels", [(0.0, 0.0), (0.9, -0.8), (-0.9, 0.8)])
def test_any_cuts_keep_the_volume_and_come_back_from_step(enneper, relief, bevels, tmp_path):
    lamella = enneper.structure.lamellas[0]
    part = parts_of(fab.SlotJoint().build(enneper.structure), relief)[0]
    holes = tuple(Hole(x, 20.0, 6.0, "N1", "bolt M5") for x in (15.0, part.length - 15.0))
    part = replace(part, holes=holes, bevels=bevels)
    made = solid.lamella_solid(lamella, part)
    assert solid.volume(made) == pytest.approx(part.volume, rel=2e-6)
    whole = cadquery.Assembly(name="one").add(cadquery.Shape.cast(made), name="A1")
    fab.write_step(whole, tmp_path / "one.step")
    (found,) = fab.read_step(tmp_path / "one.step")
    assert found.volume() == pytest.approx(part.volume, rel=2e-5)
    np.testing.assert_allclose(found.circles(), part.circles, atol=2e-3)
    for loops, face in zip((found.near_loops, found.far_loops), part.faces, strict=True):
        loop = found.unrolled_loop(loops[0])
        wanted = np.column_stack([face, np.zeros(len(face))]) if face.shape[1] == 2 else face
        assert loop.shape == wanted.shape
        apart = np.abs(loop[:, None] - wanted[None]).max(axis=2)
        assert apart.min(axis=0).max() < 5e-3
