"""Fig. 18: the Asymptotic Umbrella, from cylinder to funnel."""

from __future__ import annotations

import time

import numpy as np

import fabrication as fab
import gridshell as gs
from fabrication.export.raster import Scene
from fabrication.gallery.figure import Condition, Figure, largest
from fabrication.gallery.scenery import edges, lamella_faces
from gridshell.arrays import Floats, Indices, Points
from gridshell.painter import Layer, seen_from

UMBRELLA = gs.Umbrella(ribs=16, radius=1000.0, bays=(400.0,) * 8)
TUBE = fab.HollowProfile(40.0, 14.0, fab.GRP, wall=2.0)
CABLE = gs.Cable(0, 8)
POSITIONS = 60
_RANGE = (0.05, 0.95)
"""Openings between which the solver follows the recursion."""


def figure() -> Figure:
    """The exact recursion, and the same motion out of the solver, driven by the cables alone."""
    positions = [UMBRELLA.position(o) for o in np.linspace(*_RANGE, POSITIONS).tolist()]
    rest = _nodes(positions[0])
    mesh = gs.quads_of(gs.diagonal_meshes(positions[0].control())[0])
    base, cables = _cables(rest, positions[0])
    mechanism = gs.Mechanism(mesh, base, cables)
    begin = time.perf_counter()
    found = mechanism.motion([np.full(len(cables), CABLE.length(p)) for p in positions])
    seconds = time.perf_counter() - begin
    lengths = [mesh.moved(x).edge_lengths / mesh.edge_lengths - 1.0 for x in found]
    stars = [
        gs.net_quality(gs.without_families(mesh.moved(x)), planarity=gs.Planarity.EDGE_STARS)
        for x in found
    ]
    off = [float(np.abs(x - _nodes(p)).max()) for x, p in zip(found, positions, strict=False)]
    locks = UMBRELLA.locks
    angles = np.degrees([p.node_angles for p in positions])
    return Figure(
        name="18",
        title="Asymptotic Umbrella",
        paper={"base radius": "constant", "edge lengths": "constant"},
        ours={
            "positions": len(found),
            "seconds": round(seconds, 2),
            "angles closed, degrees": f"{angles[0].min():.1f} to {angles[0].max():.1f}",
            "angles opened, degrees": f"{angles[-1].min():.1f} to {angles[-1].max():.1f}",
            "height, m": f"{positions[0].height / 1e3:.2f} to {positions[-1].height / 1e3:.2f}",
            "locks, top radius, m": " and ".join(f"{p.radii[-1] / 1e3:.2f}" for p in locks),
        },
        conditions=(
            Condition("positions not found", POSITIONS - len(found), 0),
            Condition("edge lengths off, relative", float(np.abs(lengths).max()), 1e-6),
            Condition("star planarity", max(largest(s.star_planarity) for s in stars), 1e-6),
            Condition("solver off the recursion, mm", max(off), 1e-3),
            Condition("seconds for 60 positions", seconds, 10.0),
            Condition("hinges: clash, mm3", _clash(), 1e-3),
        ),
        scenes=tuple(
            Scene(f"{name}: {100.0 * o:.0f} % open", _layers(o), seen_from(0.3, -1.0, 0.3))
            for name, o in (("Closed", 0.06), ("Half way", 0.4), ("Funnel", 0.85))
        ),
    )


def _clash() -> float:
    """Of tubes and pins, half way."""
    net = gs.diagonal_meshes(UMBRELLA.position(0.4).control())[0]
    jointed = fab.HingedJoint(6.0).build(fab.structure(net, TUBE))
    return fab.fit(jointed.strips, fab.parts_of(jointed), jointed.connectors).max_mm3


def _nodes(position: gs.Position) -> Points:
    return gs.diagonal_meshes(position.control())[0].vertices


def _cables(nodes: Points, position: gs.Position) -> tuple[Indices, Indices]:
    """The base ring, and from each of its nodes the one above it at the top."""
    turn = np.exp(1j * np.arctan2(nodes[:, 1], nodes[:, 0]))
    low, high = (
        np.flatnonzero(np.abs(nodes[:, 2] - position.heights[k]) < 1e-6)
        for k in (CABLE.low, CABLE.high)
    )
    above: Floats = np.abs(turn[low][:, None] - turn[high][None])
    return low, np.stack([low, high[np.argmin(above, axis=1)]], axis=1)


def _layers(opening: float) -> tuple[Layer, ...]:
    position = UMBRELLA.position(opening)
    net = gs.diagonal_meshes(position.control())[0]
    built = fab.structure(net, TUBE)
    _, cables = _cables(net.vertices, position)
    return (*lamella_faces(built), edges(net.vertices, cables, (0.2, 0.2, 0.2), 0.6))
