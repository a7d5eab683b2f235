"""Fig. 17: the canopy of four equal segments, its angles from 90 at the top to 60 degrees."""

from __future__ import annotations

import numpy as np

import fabrication as fab
import gridshell as gs
from fabrication.export.raster import Scene
from fabrication.gallery.figure import Condition, Figure, equal, largest
from fabrication.gallery.scenery import lamella_faces
from gridshell.painter import Faces, seen_from

SEGMENTS = fab.Segments(4, seam=50.0)
_NOISE = 0.5
"""What the starts of the unsymmetric solve are moved by, mm."""


def figure() -> Figure:
    """One segment is solved and built four times; its slots vary with the angle."""
    net = solved()
    design, parts = _built(net.control)
    fitted = fab.fit(design, parts)
    angles = np.degrees([node.angle for node in design.nodes if node.angle is not None])
    widths = np.array([slot.width for part in parts for slot in part.slots])
    seam = fab.seam_of(SEGMENTS, design)
    unsymmetric = [part for k in range(4) for part in _built(solved(seed=k + 1).control)[1]]
    own = lamella_faces(design)
    hung = fab.hanging(design)
    nodes = np.array([node.position for node in design.nodes])
    return Figure(
        name="17",
        title="Canopy of four equal segments",
        paper={"segments": 4, "angles, degrees": "90 to about 60", "profile, mm": "2.5 x 100"},
        ours={
            "segments": SEGMENTS.count,
            "angles, degrees": f"{angles.max():.1f} to {angles.min():.1f}",
            "profile, mm": f"{design.profile.thickness:g} x {design.profile.width:g}",
            "distinct strips": len(parts),
            "distinct strips unsymmetric": _distinct(unsymmetric),
            "slots, mm": f"{widths.min():.2f} to {widths.max():.2f}",
            "seam, mm": round(seam.distance, 1),
        },
        conditions=(
            Condition("star planarity", largest(net.quality.star_planarity), 1e-6),
            Condition("largest angle off 90 degrees", abs(float(angles.max()) - 90.0), 1.0),
            Condition("smallest angle off 60 degrees", abs(float(angles.min()) - 60.0), 2.0),
            Condition("clash, mm3", fitted.max_mm3, 1e-3),
            Condition("seam narrower than asked, mm", SEGMENTS.seam - seam.distance, 0.0),
            equal("distinct strips of one segment", _distinct(parts), len(parts)),
            equal("distinct strips without symmetry", _distinct(unsymmetric), 4 * len(parts)),
            Condition("hung segment against the built one, mm", _bent(nodes, hung), 1e-6),
        ),
        scenes=(
            Scene(
                "Prefabricated hanging",
                tuple(Faces(f.corners * [1.0, -1.0, -1.0], f.colours) for f in own),
                seen_from(0.3, -1.0, 0.35),
            ),
            Scene(
                "Canopy",
                tuple(_copy(layer, k) for k in range(SEGMENTS.count) for layer in own),
                seen_from(0.35, -1.0, 0.55),
            ),
        ),
        columns=2,
    )


def solved(seed: int = 0) -> gs.OptimizedNet:
    """A quarter of a roof of four hyperbolic paraboloids; a *seed* moves its start."""
    patch = gs.AsymptoticPatch(p=(0.02, 1.0), q=(-1.0, -0.02), lamellas=(10, 10))
    start = gs.control_patch(gs.Hypar(5000.0), patch)
    if seed:
        noise = np.random.default_rng(seed).normal(scale=_NOISE, size=start.vertices.shape)
        start = start.moved(start.vertices + noise)
    return gs.optimize(start, gs.a_net(), anchor=gs.Free()).require()


def _built(control: gs.ControlMesh) -> tuple[fab.Structure, tuple[fab.FlatPart, ...]]:
    profile = fab.Profile(100.0, 2.5, fab.STAINLESS)
    design = fab.structure(gs.diagonal_meshes(control)[0], profile)
    return design, fab.flat_parts(design, fab.SlotJoint(clearance=0.2))


def _distinct(parts: list[fab.FlatPart] | tuple[fab.FlatPart, ...]) -> int:
    """How many strips differ by more than a hundredth of a millimetre in length or a slot."""
    return len({tuple(np.round([p.length, *(s.x for s in p.slots)], 2)) + _edge(p) for p in parts})


def _edge(part: fab.FlatPart) -> tuple[float, ...]:
    """Which edge the slots open to, as a number."""
    return tuple(float(slot.edge is fab.Edge.UPPER) for slot in part.slots[:1])


def _copy(layer: Faces, number: int) -> Faces:
    corners = SEGMENTS.placed(layer.corners.reshape(-1, 3), number)
    return Faces(corners.reshape(layer.corners.shape), layer.colours)


def _bent(nodes: np.ndarray, hung: np.ndarray) -> float:
    """Largest change of the distance of any two nodes, mm."""
    apart = [np.linalg.norm(p[:, None] - p[None], axis=2) for p in (nodes, hung)]
    return float(np.abs(apart[0] - apart[1]).max())
