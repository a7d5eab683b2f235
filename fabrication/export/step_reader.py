"""Lamellas read back from a STEP file, straight from its entities.

The general import heals every shape it meets, which takes minutes for a large assembly and would
hide what it mends. Here the file's own surfaces and loops are taken as they are written: the two
large ruled faces of each solid, and the corners of the loop that trims them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.interpolate import BSpline, CubicHermiteSpline

from fabrication.export.step_faces import RuledSide, extent, ruled
from fabrication.export.step_loops import quadrature, read_loops, segments
from gridshell import FileError
from gridshell.arrays import Floats

_TUBE_FACES = 8
_PARALLEL = 0.9
"""Cosine above which the rulings of two faces point the same way."""

_SAME_DRILL = 1e-3
"""What the holes of a drill may be apart on both walls, mm."""

_Candidate = tuple[float, Any, Any]
"""Area of the parameters, surface, face."""


@dataclass(frozen=True, eq=False)
class StepPart:
    """What a STEP file says of one lamella.

    Parameters
    ----------
    mark : the product's name.
    near, far : the two large faces, with common parameters.
    near_loops, far_loops : the loops that trim them, rows u, v, bulge; the outer one first.
    cavity : of a tube, what the file says of the space inside.
    """

    mark: str
    near: RuledSide
    far: RuledSide
    near_loops: tuple[Floats, ...]
    far_loops: tuple[Floats, ...]
    cavity: Cavity | None = None

    @property
    def loop(self) -> Floats:
        """(k, 2) corners of the near face's outer loop."""
        return self.near_loops[0][:, :2]

    @cached_property
    def middle(self) -> RuledSide:
        """The ruled surface half-way between the faces."""
        lower = BSpline(self.near.lower.t, (self.near.lower.c + self.far.lower.c) / 2.0, 3)
        upper = BSpline(self.near.upper.t, (self.near.upper.c + self.far.upper.c) / 2.0, 3)
        return RuledSide(lower, upper, self.near.width)

    def place(self, x: Floats, y: Floats) -> Floats:
        """Lay points (x, y) of a flat strip along the middle surface: positions (n, 3).

        x is measured along the middle line from its start, whatever the file's parameters say.
        """
        return self.middle.points(self._arc(inverse=True)(x), y)

    def unrolled_loop(self, loop: Floats | None = None) -> Floats:
        """A trimming loop (k, 2) or (k, 3) on the flat strip; the near face's if none is given.

        u becomes arc length along the middle line; v, and bulges, stay what they are.
        """
        rows = np.array(self.loop if loop is None else loop)
        rows[:, 0] = self._arc(inverse=False)(rows[:, 0])
        return rows

    def circles(self) -> Floats:
        """(m, 3) rows x, y, diameter of the holes on the flat strip, in order of x."""
        rows = [
            [*self.unrolled_loop(loop)[:, :2].mean(axis=0), np.ptp(loop[:, 0])]
            for loop in self.near_loops[1:]
        ]
        return np.array(sorted(rows)).reshape(-1, 3)

    def volume(self) -> float:
        """Volume between the faces, by Gauss quadrature, mm3.

        Circular segments between arcs and their chords, holes among them, are taken with what lies
        over the middle of their chord; at bevelled ends with the mean of both faces' loops. Of a
        tube the cavity is taken off, and what is drilled out of its narrow walls.
        """
        if self.cavity is not None:
            whole = abs(self._over(self.near_loops))
            return whole - self.cavity.inside.volume() - self.cavity.drilled()
        near, far = self.near_loops, self.far_loops
        if any(len(a) != len(b) for a, b in zip(near, far, strict=True)):
            raise FileError("The two large faces of a solid have other corners", where=self.mark)
        square = np.allclose(near[0][:, 0].min(), far[0][:, 0].min(), atol=1e-6) and np.allclose(
            near[0][:, 0].max(), far[0][:, 0].max(), atol=1e-6
        )
        sides = (near,) if square else (near, far)
        return float(np.mean([abs(self._over(loops)) for loops in sides]))

    def drills(self) -> Floats:
        """(m, 2) x on the flat strip and diameter of the holes through a tube's upper wall.

        Raises
        ------
        FileError
            Where the lower wall is drilled in other places.
        """
        if self.cavity is None:
            return np.zeros((0, 2))
        walls = []
        for loops in self.cavity.flanges:
            rows = [[self.unrolled_loop(r)[:, 0].mean(), np.ptp(r[:, 0])] for r in loops[1:]]
            walls.append(np.array(sorted(rows)).reshape(-1, 2))
        upper, lower = walls
        if upper.shape != lower.shape or np.abs(upper - lower).max(initial=0.0) > _SAME_DRILL:
            raise FileError("The walls of a tube are drilled in different places", where=self.mark)
        return upper

    def _over(self, loops: Sequence[Floats]) -> float:
        """Volume between the faces over the loops of one of them."""
        knots = np.unique(self.near.lower.t)
        u, v, weight = quadrature(loops[0], knots)
        for loop in loops:
            middle, areas = segments(loop)
            u, v = np.r_[u, middle[:, 0]], np.r_[v, middle[:, 1]]
            weight = np.r_[weight, areas]
        total = 0.0
        for share, part in zip((leggauss(3)[0] + 1.0) / 2.0, leggauss(3)[1] / 2.0, strict=True):
            a, b = self.near.slopes(u, v), self.far.slopes(u, v)
            by_u, by_v = ((1.0 - share) * p + share * q for p, q in zip(a, b, strict=True))
            across = self.far.points(u, v) - self.near.points(u, v)
            density = np.einsum("nc,nc->n", np.cross(by_u, by_v), across)
            total += part * float(density @ weight)
        return total

    def _arc(self, *, inverse: bool) -> CubicHermiteSpline:
        """Arc length of the middle line by parameter, or the other way round."""
        line = BSpline(self.near.lower.t, (self.middle.lower.c + self.middle.upper.c) / 2.0, 3)
        knots = np.unique(line.t)
        stops = (knots[:-1, None] + np.diff(knots)[:, None] * np.arange(4) / 4.0).ravel()
        stops = np.r_[stops, knots[-1]]
        nodes, weights = leggauss(6)
        half = np.diff(stops)[:, None] / 2.0
        inside = np.linalg.norm(line(stops[:-1, None] + half * (1.0 + nodes), 1), axis=2)
        arc = np.r_[0.0, np.cumsum((inside * half) @ weights)]
        speed = np.linalg.norm(line(stops, 1), axis=1)
        if inverse:
            return CubicHermiteSpline(arc, stops, 1.0 / speed)
        return CubicHermiteSpline(stops, arc, speed)


@dataclass(frozen=True, eq=False)
class Cavity:
    """What makes a tube of a solid.

    Parameters
    ----------
    inside : the two wide inner faces, as a part of its own.
    flanges : loops of the upper and of the lower narrow outer face, the outer loop first.
    wall : between a narrow outer face and the inner one behind it, mm.
    """

    inside: StepPart
    flanges: tuple[tuple[Floats, ...], tuple[Floats, ...]]
    wall: float

    def drilled(self) -> float:
        """Volume of all holes, mm3: the area of a hole's circle times the wall."""
        holes = [loop for loops in self.flanges for loop in loops[1:]]
        return float(sum(np.pi / 4.0 * np.ptp(loop[:, 0]) ** 2 for loop in holes)) * self.wall


def read_step(path: Path | str) -> tuple[StepPart, ...]:
    """Read the lamellas of an assembly, in the file's order.

    Raises
    ------
    FileError
        When the file is missing, cannot be read, or a solid has no two large ruled faces.
    """
    from OCP.IFSelect import IFSelect_RetDone
    from OCP.STEPControl import STEPControl_Reader

    from fabrication.export.step import quiet

    quiet()
    if not Path(path).is_file():
        raise FileError("The STEP file is missing", where=str(path))
    reader = STEPControl_Reader()
    if reader.ReadFile(str(path)) != IFSelect_RetDone:
        raise FileError("The STEP file cannot be read", where=str(path))
    found = [_part(path, name, brep) for name, brep in _named_solids(reader.StepModel())]
    parts = tuple(part for part in found if part is not None)
    if found and not parts:
        raise FileError("No solid has two large ruled faces", where=str(path))
    return parts


def _named_solids(model: Any) -> Iterator[tuple[str, Any]]:
    from OCP.StepShape import StepShape_ManifoldSolidBrep, StepShape_ShapeDefinitionRepresentation

    for i in range(1, model.NbEntities() + 1):
        entity = model.Entity(i)
        if not isinstance(entity, StepShape_ShapeDefinitionRepresentation):
            continue
        definition = entity.Definition().PropertyDefinition().Definition().ProductDefinition()
        name = definition.Formation().OfProduct().Name().ToCString()
        representation = entity.UsedRepresentation()
        for k in range(1, representation.NbItems() + 1):
            item = representation.ItemsValue(k)
            if isinstance(item, StepShape_ManifoldSolidBrep):
                yield name, item


def _part(path: Path | str, name: str, brep: Any) -> StepPart | None:
    """The lamella that a solid is; None for a connector, which has no spline face at all."""
    from OCP.StepGeom import StepGeom_BSplineSurfaceWithKnots

    shell = brep.Outer()
    candidates: list[_Candidate] = []
    for face in (shell.CfsFacesValue(i) for i in range(1, shell.NbCfsFaces() + 1)):
        surface = face.FaceGeometry()
        if isinstance(surface, StepGeom_BSplineSurfaceWithKnots) and surface.VDegree() == 1:
            candidates.append((extent(surface), surface, face))
    candidates.sort(key=lambda candidate: candidate[0], reverse=True)
    if not candidates:
        return None
    if len(candidates) < 2:
        raise FileError("A solid has no two large ruled faces", where=f"{path}, {name}")
    where = f"{path}, {name}"
    whole = _between(where, name, candidates[:2])
    return replace(whole, cavity=_cavity(where, whole, candidates))


def _between(where: str, name: str, pair: Sequence[_Candidate]) -> StepPart:
    near, far = (ruled(surface) for _, surface, _ in pair)
    if not np.array_equal(near.lower.t, far.lower.t):
        raise FileError("The two large faces of a solid differ", where=where)
    loops = [
        read_loops(face, side.parameters)
        for side, (_, _, face) in zip((near, far), pair, strict=True)
    ]
    return StepPart(name, near, far, loops[0], loops[1])


def _cavity(where: str, whole: StepPart, candidates: Sequence[_Candidate]) -> Cavity | None:
    """Of a solid with eight faces along its whole length: four around it, four inside."""
    knots = whole.near.lower.t
    long = [
        c
        for c in candidates
        if c[1].UDegree() == whole.near.lower.k
        and np.allclose([c[1].UKnotsValue(1), c[1].UKnotsValue(c[1].NbUKnots())], knots[[0, -1]])
    ]
    if len(long) != _TUBE_FACES:
        return None
    u, half = np.array([(knots[0] + knots[-1]) / 2.0]), np.array([whole.near.width / 2.0])
    middle = whole.middle.points(u, half)[0]
    up = whole.middle.slopes(u, half)[1][0]
    wide: list[tuple[float, bool, _Candidate]] = []
    narrow: list[tuple[float, bool, _Candidate]] = []
    for candidate in long[2:]:
        side = ruled(candidate[1])
        here = np.array([side.width / 2.0])
        along = abs(float(side.slopes(u, here)[1][0] @ up))
        height = float((side.points(u, here)[0] - middle) @ up)
        (wide if along > _PARALLEL else narrow).append((abs(height), height > 0.0, candidate))
    if len(wide) != 2 or len(narrow) != 4:
        return None
    narrow.sort(key=lambda found: found[0], reverse=True)  # both outer ones first
    outer = sorted(narrow[:2], key=lambda found: found[1], reverse=True)
    loops = [read_loops(c[2], ruled(c[1]).parameters) for _, _, c in outer]
    return Cavity(
        inside=_between(where, whole.mark, [c for _, _, c in wide]),
        flanges=(loops[0], loops[1]),
        wall=narrow[0][0] - narrow[2][0],
    )
