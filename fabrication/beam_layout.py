"""Beams along the edges of a skin: lengths, and the mitres that make them meet at the nodes.

Seen along the node axis, neighbouring beams at an angle b are both cut along the bisector of their
lines, at b / 2 to either. A beam stands upright on the mean of its two axes, so at a node it
*slopes* out of the plane across the axis and *rolls* about itself against it; both are bevels a saw
has to know. Where two neighbours open more than half a turn, as at the rim, the end is cut square.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fabrication.outlines import Frame, is_simple
from fabrication.stock import require_positive
from gridshell import PanelMesh, SettingError
from gridshell.arrays import Floats, frozen, unit


@dataclass(frozen=True)
class BeamSection:
    """A rectangular beam.

    Parameters
    ----------
    width : across the edge, on the skin, mm.
    height : along the axes, mm.
    setback : from the node to the beam's end where connectors join them, mm; 0 for beams that
        meet in their mitres.

    Raises
    ------
    SettingError
        For a size that is not positive or a negative setback.
    """

    width: float
    height: float
    setback: float = 0.0

    def __post_init__(self) -> None:
        require_positive("width", self.width)
        require_positive("height", self.height)
        if not (np.isfinite(self.setback) and self.setback >= 0.0):
            raise SettingError(
                "A distance cannot be negative", where="setback", value=f"{self.setback} mm"
            )


@dataclass(frozen=True)
class BeamEnd:
    """How one end of a beam is cut.

    Parameters
    ----------
    node : where.
    left, right : mitres against the beam's line, seen from above the node and looking along the
        beam away from it: half the angle to the next beam on that side, radians; None where that
        is half a turn or more, for a square cut.
    slope : of the beam out of the plane across the node axis, upwards away from the node, radians.
    roll : of the beam's upright against the node axis, right-handed about the direction away from
        the node, radians.
    """

    node: int
    left: float | None
    right: float | None
    slope: float
    roll: float


@dataclass(frozen=True, eq=False)
class Beam:
    """One beam.

    Parameters
    ----------
    mark : "B1", "B2", ...: the number of the edge plus one.
    edge : index of the net's edge.
    start, end : its ends, at the smaller node first.
    length : between the nodes, mm.
    cut_length : the beam from its first to its last point, mm.
    frame : origin at the first node, x along the beam, y to its left seen from above.
    plan : (k, 2) the beam seen from above in that frame, in the plane of the net,
        counter-clockwise, mm; each corner lies on its mitre's plane, which holds the node axis.
    """

    mark: str
    edge: int
    start: BeamEnd
    end: BeamEnd
    length: float
    cut_length: float
    frame: Frame
    plan: Floats


def beams(mesh: PanelMesh, section: BeamSection) -> tuple[Beam, ...]:
    """One beam per edge of *mesh*, in the order of its edges.

    Raises
    ------
    SettingError
        Naming the first beam that its mitres or setbacks leave nothing of.
    """
    mitres = _mitres(mesh)
    return tuple(_beam(mesh, section, edge, mitres[edge]) for edge in range(len(mesh.edges)))


Sides = tuple[float | None, float | None]


def _mitres(mesh: PanelMesh) -> list[list[Sides]]:
    """For each edge at its first and its second node: left and right mitre."""
    found: list[list[Sides]] = [[(None, None), (None, None)] for _ in range(len(mesh.edges))]
    ends = [(int(v), e, side) for e, pair in enumerate(mesh.edges) for side, v in enumerate(pair)]
    around: list[list[tuple[int, int]]] = [[] for _ in range(len(mesh.vertices))]
    for v, e, side in ends:
        around[v].append((e, side))
    for v, star in enumerate(around):
        others = [int(mesh.edges[e, 1 - side]) for e, side in star]
        angle = _about(mesh.vertices[others] - mesh.vertices[v], mesh.axes[v])
        order = np.argsort(angle, kind="stable")
        gaps = np.diff(angle[order], append=angle[order[0]] + 2.0 * np.pi)
        halves = [float(g) / 2.0 if g < np.pi else None for g in gaps]
        for place, k in enumerate(order.tolist()):
            e, side = star[k]
            found[e][side] = (halves[place], halves[place - 1])
    return found


def _about(run: Floats, axis: Floats) -> Floats:
    """(k,) angles about the axis from the first of the directions (k, 3), in [0, 2 pi)."""
    level = run - (run @ axis)[:, None] * axis
    x = unit(level[0])
    angle = np.arctan2(level @ np.cross(axis, x), level @ x) % (2.0 * np.pi)
    angle[0] = 0.0
    return np.asarray(angle)


def _beam(mesh: PanelMesh, section: BeamSection, edge: int, mitres: Sequence[Sides]) -> Beam:
    i, j = mesh.edges[edge].tolist()
    run = mesh.vertices[j] - mesh.vertices[i]
    length = float(np.linalg.norm(run))
    along = run / length
    upright = mesh.axes[i] + mesh.axes[j]
    up = unit(upright - (upright @ along) * along)
    start = _end(i, mesh.axes[i], along, up, mitres[0])
    end = _end(j, mesh.axes[j], -along, up, mitres[1])
    plan = _plan(
        section,
        length,
        _backs(section, start, mesh.axes[i], along, up),
        _backs(section, end, mesh.axes[j], -along, up),
    )
    if not _sound(plan):
        raise SettingError(
            "A beam has nothing sound left between its nodes",
            where=f"beam B{edge + 1}, nodes {i} and {j}, {length:.1f} mm apart",
            value=f"{section.width:g} mm wide, {section.setback:g} mm set back",
            limit="ends that do not meet",
            advice="a narrower beam, a smaller setback, or a coarser net",
        )
    return Beam(
        mark=f"B{edge + 1}",
        edge=edge,
        start=start,
        end=end,
        length=length,
        cut_length=float(np.ptp(plan[:, 0])),
        frame=Frame(mesh.vertices[i], along, np.cross(up, along)),
        plan=frozen(plan),
    )


def _end(node: int, axis: Floats, away: Floats, up: Floats, sides: Sides) -> BeamEnd:
    level = unit(axis - (axis @ away) * away)
    roll = np.arctan2(np.cross(level, up) @ away, level @ up)
    return BeamEnd(node, sides[0], sides[1], float(np.arcsin(away @ axis)), float(roll))


def _backs(
    section: BeamSection, end: BeamEnd, axis: Floats, away: Floats, up: Floats
) -> tuple[float, float]:
    """How far from the node the left and the right side of the beam begin, mm."""
    half = section.width / 2.0
    if section.setback > 0.0:
        return section.setback, section.setback
    level = unit(away - (away @ axis) * axis)
    left, side = np.cross(axis, level), np.cross(up, away)

    def back(mitre: float | None, sign: float) -> float:
        if mitre is None:
            return 0.0
        across = np.cross(axis, np.cos(mitre) * level + sign * np.sin(mitre) * left)
        reach = float(away @ across)
        return -sign * half * float(side @ across) / reach if reach else np.inf

    return back(end.left, 1.0), back(end.right, -1.0)


def _plan(
    section: BeamSection, length: float, near: tuple[float, float], far: tuple[float, float]
) -> Floats:
    """The points of both ends from the right of the start, counter-clockwise."""
    half, setback = section.width / 2.0, section.setback
    points = [[near[1], -half], [length - far[0], -half], [length - far[1], half], [near[0], half]]
    if setback == 0.0:
        points = [*points[:2], [length, 0.0], *points[2:], [0.0, 0.0]]
    return np.array(points)


def _sound(plan: Floats) -> bool:
    """Whether it is a polygon and both long edges, the pieces with the extreme y, run forward."""
    if not np.isfinite(plan).all():
        return False
    lower = plan[plan[:, 1] == plan[:, 1].min()][:, 0]
    upper = plan[plan[:, 1] == plan[:, 1].max()][:, 0]
    return bool(lower[1] > lower[0] and upper[1] < upper[0]) and is_simple(plan)
