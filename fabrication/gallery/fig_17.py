"""Fig. 17: the canopy of four equal segments, its angles from 90 at the top to 60 degrees."""

from __future__ import annotations

import numpy as np

import fabrication as fab
import gridshell as gs
from fabrication.export.painter import Faces, Layer
from fabrication.export.raster import Scene
from fabrication.gallery.figure import Condition, Figure, largest
from fabrication.gallery.scenery import lamella_faces, seen_from
from gridshell.arrays import Floats

SEGMENTS = 4


def segment() -> gs.OptimizedNet:
    """A quarter of a roof of four hyperbolic paraboloids, a seam's width off the axes."""
    patch = gs.AsymptoticPatch(p=(0.02, 1.0), q=(-1.0, -0.02), lamellas=(10, 10))
    start = gs.control_patch(gs.Hypar(5000.0), patch)
    return gs.optimize(start, gs.a_net(), anchor=gs.Free())


def figure() -> Figure:
    """One segment is solved and drawn four times; its slots vary with the angle."""
    net = segment()
    design = fab.structure(
        gs.diagonal_meshes(net.control)[0], fab.Profile(100.0, 2.5, fab.STAINLESS)
    )
    parts = fab.flat_parts(design, fab.SlotJoint(clearance=0.2))
    fitted = fab.fit(design, parts)
    angles = np.degrees([node.angle for node in design.nodes if node.angle is not None])
    widths = np.array([slot.width for part in parts for slot in part.slots])
    own = lamella_faces(design)
    canopy = tuple(_turned(layer, k) for k in range(SEGMENTS) for layer in own)
    hanging = tuple(Faces(layer.corners * [1.0, -1.0, -1.0], layer.colours) for layer in own)
    return Figure(
        name="17",
        title="Canopy of four equal segments",
        paper={"segments": 4, "angles, degrees": "90 to about 60", "profile, mm": "2.5 x 100"},
        ours={
            "segments": SEGMENTS,
            "angles, degrees": f"{angles.max():.1f} to {angles.min():.1f}",
            "profile, mm": "2.5 x 100",
            "distinct strips": len(parts),
            "strips": SEGMENTS * len(parts),
            "slots, mm": f"{widths.min():.2f} to {widths.max():.2f}",
        },
        conditions=(
            Condition("star planarity", largest(net.quality.star_planarity), 1e-6),
            Condition("largest angle off 90 degrees", abs(float(angles.max()) - 90.0), 1.0),
            Condition("smallest angle off 60 degrees", abs(float(angles.min()) - 60.0), 2.0),
            Condition("clash, mm3", fitted.max_mm3, 1e-3),
            Condition("segments into each other, mm", -_seam(canopy, len(own)), 0.0),
        ),
        scenes=(
            Scene("Prefabricated hanging", hanging, seen_from(0.3, -1.0, 0.35)),
            Scene("Canopy", canopy, seen_from(0.35, -1.0, 0.55)),
        ),
        columns=2,
    )


def _turned(layer: Faces, quarter: int) -> Faces:
    c, s = np.cos(np.pi / 2.0 * quarter), np.sin(np.pi / 2.0 * quarter)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return Faces(layer.corners @ turn.T, layer.colours)


def _seam(canopy: tuple[Layer, ...], own: int) -> float:
    """Least distance of a segment's points from its two neighbours' sector, mm."""
    points: Floats = np.concatenate(
        [layer.corners.reshape(-1, 3) for layer in canopy[:own] if isinstance(layer, Faces)]
    )
    turn = np.arctan2(points[:, 1], points[:, 0])
    middle = np.arctan2(points[:, 1].mean(), points[:, 0].mean())
    aside = np.abs(np.angle(np.exp(1j * (turn - middle))))
    r = np.hypot(points[:, 0], points[:, 1])
    return float((r * np.sin(np.clip(np.pi / SEGMENTS - aside, -1.0, np.pi / 2.0))).min())
