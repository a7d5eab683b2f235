"""Fig. 15: four orthogonal joints, each made on one node field and tried for fit."""

from __future__ import annotations

from math import radians

import numpy as np

import fabrication as fab
import gridshell as gs
from fabrication.export.raster import Scene
from fabrication.gallery.figure import Condition, Figure, largest
from fabrication.gallery.scenery import connector_faces, lamella_faces
from gridshell.painter import Faces, Layer, View, seen_from

_NARROW, _WIDE = fab.Profile(100.0, 2.5, fab.STAINLESS), fab.Profile(100.0, 1.5, fab.S235)
JOINTS: dict[str, tuple[str, fab.Profile, fab.Joint]] = {
    "a": ("slotted and welded", _NARROW, fab.SlotJoint(clearance=0.0, weld=40.0)),
    "b": ("segmented, reciprocal", _NARROW, fab.ReciprocalJoint(gap=0.5)),
    "c": (
        "two levels and a square pipe",
        _WIDE,
        fab.StudJoint(40.0, fab.Stud(fab.S235, wall=3.0), level=51.0),
    ),
    "d": (
        "double slots and star washers",
        _WIDE,
        fab.DoubleSlotJoint(30.0, 8.0, fab.StarWasher(4.0, 18.0, 8.0, fab.S235), clearance=0.0),
    ),
}
_CLOSE_UP = 170.0
"""What is drawn around the middle node, mm."""


def figure() -> Figure:
    """Slots without any clearance, pieces half a millimetre short: no two parts clash."""
    patch = gs.AsymptoticPatch(p=(-0.15, 0.15), q=(-0.15, 0.15), lamellas=(3, 3))
    start = gs.control_patch(gs.Enneper(4000.0), patch)
    net = gs.optimize(start, gs.a_net(angle=radians(90.0)), anchor=gs.Free())
    skin = gs.diagonal_meshes(net.control)[0]
    scenes, conditions = (
        [],
        [Condition("angle, degrees", largest(net.quality.angle_error_deg), 0.01)],
    )
    ours: dict[str, float | int | str] = {}
    for letter, (what, profile, joint) in JOINTS.items():
        jointed = joint.build(fab.structure(skin, profile))
        parts = fab.parts_of(jointed)
        fitted = fab.fit(jointed.strips, parts, jointed.connectors)
        ours[f"{letter}, parts"] = len(parts) + sum(len(k.bodies) for k in jointed.connectors)
        conditions.append(Condition(f"{letter}: clash, mm3", fitted.max_mm3, 1e-3))
        layers = (*lamella_faces(jointed.strips), *connector_faces(jointed.connectors))
        scenes.append(Scene(f"{letter} {what}", _near(layers), _view()))
    return Figure(
        name="15",
        title="Orthogonal joints",
        paper={"angle, degrees": 90},
        ours=ours,
        conditions=tuple(conditions),
        scenes=tuple(scenes),
        columns=2,
    )


def _view() -> View:
    return seen_from(0.5, -1.0, 0.9)


def _near(layers: tuple[Faces, ...]) -> tuple[Layer, ...]:
    """What lies around the middle of all layers."""
    kept = []
    for layer in layers:
        middle = layer.corners.mean(axis=1)
        near = np.abs(middle).max(axis=1) < _CLOSE_UP
        kept.append(Faces(layer.corners[near], layer.colours[near]))
    return tuple(kept)
