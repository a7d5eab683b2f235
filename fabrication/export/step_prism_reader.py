"""Prisms read back from a STEP file, straight from its text: no kernel, nothing healed.

Every occurrence of a solid is found by its name, and the corners of the solid's two ends are moved
to where the file says that the occurrence lies.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from gridshell import FileError
from gridshell.arrays import Floats, Points

_LEVEL = 1e-6
"""Corners this close to the lowest or highest one belong to that end, mm."""

_NUMBER = re.compile(rb"#(\d+)")
_TYPE = re.compile(rb"\s*([A-Z0-9_]*)\s*\(")
_NAME = re.compile(rb"'((?:[^']|'')*)'")
_CODE = re.compile(r"\\X2\\((?:[0-9A-F]{4})+)\\X0\\")


@dataclass(frozen=True, eq=False)
class StepPrism:
    """What a STEP file says of one prism.

    Parameters
    ----------
    mark : the name of the occurrence.
    product : the name of the product it is an occurrence of.
    low, high : (k, 3) corners of its two ends where the occurrence lies, each around its face, mm.
    """

    mark: str
    product: str
    low: Points
    high: Points

    @property
    def height(self) -> float:
        """From the one end to the other, mm."""
        return float(np.linalg.norm(self.high.mean(axis=0) - self.low.mean(axis=0)))

    @property
    def middle(self) -> Points:
        """(k, 3) the corners half-way between the ends, mm."""
        return np.asarray(self.low + (self.high.mean(axis=0) - self.low.mean(axis=0)) / 2.0)

    def volume(self) -> float:
        """Of a prism without arcs: area of the end times the height, mm3."""
        arms = self.low - self.low[0]
        area = np.linalg.norm(np.cross(arms[:-1], arms[1:]).sum(axis=0)) / 2.0
        return float(area) * self.height


def read_prisms(path: Path | str) -> tuple[StepPrism, ...]:
    """All occurrences of prisms of an assembly, in the file's order.

    Raises
    ------
    FileError
        When the file is missing, or is no STEP file of prisms.
    """
    try:
        content = Path(path).read_bytes()
    except OSError as error:
        raise FileError(
            "The STEP file cannot be read", where=str(path), value=error.strerror or ""
        ) from None
    try:
        return tuple(_Model(content).prisms())
    except (KeyError, ValueError, IndexError) as error:
        raise FileError(
            "The STEP file holds something else than prisms", where=str(path), value=str(error)
        ) from None


@dataclass(frozen=True, eq=False)
class StepCopy:
    """An occurrence of an assembly: x -> turn x + shift, mm.

    Parameters
    ----------
    name : of the occurrence.
    """

    name: str
    turn: Floats
    shift: Floats


def read_copies(path: Path | str, name: str) -> tuple[StepCopy, ...]:
    """Where the occurrences of the assembly called *name* lie, in the file's order.

    Raises
    ------
    FileError
        When the file cannot be read.
    """
    try:
        return tuple(_Model(Path(path).read_bytes()).copies(name))
    except (OSError, KeyError, ValueError, IndexError) as error:
        raise FileError("The STEP file cannot be read", where=str(path), value=str(error)) from None


class _Model:
    """The entities of a file by their numbers, as they are written."""

    def __init__(self, content: bytes) -> None:
        self.text: dict[int, bytes] = {}
        self.kind: dict[bytes, list[int]] = {}
        _, data = content.split(b"DATA;", 1)
        whole = data[: data.index(b"ENDSEC;")].strip()
        for piece in re.split(rb";\s*\n#", whole[1:]):
            number, _, text = piece.partition(b"=")
            found = _TYPE.match(text)
            if found:
                self.text[int(number)] = text
                self.kind.setdefault(found[1], []).append(int(number))

    def prisms(self) -> Iterator[StepPrism]:
        """Occurrences whose product is a solid."""
        shapes = dict(self._representations())
        places = dict(self._places())
        ends: dict[int, tuple[Points, Points]] = {}
        for number in self.kind.get(b"NEXT_ASSEMBLY_USAGE_OCCURRENCE", []):
            product = self._refs(number)[1]
            solid = self._solid(shapes[product])
            if solid is None or self._bent(solid):
                continue
            if product not in ends:
                ends[product] = self._ends(solid)
            turn, shift = places[number]
            low, high = (points @ turn.T + shift for points in ends[product])
            formation = self._refs(product)[0]
            yield StepPrism(
                self._names(number)[1], self._names(self._refs(formation)[0])[0], low, high
            )

    def copies(self, name: str) -> Iterator[StepCopy]:
        """Occurrences of the product called *name*."""
        places = dict(self._places())
        for number in self.kind.get(b"NEXT_ASSEMBLY_USAGE_OCCURRENCE", []):
            formation = self._refs(self._refs(number)[1])[0]
            if self._names(self._refs(formation)[0])[0] == name:
                yield StepCopy(self._names(number)[1], *places[number])

    def _refs(self, number: int) -> list[int]:
        return [int(n) for n in _NUMBER.findall(self.text[number])]

    def _names(self, number: int) -> list[str]:
        return [_plain(text) for text in _NAME.findall(self.text[number])]

    def _floats(self, number: int) -> Floats:
        text = self.text[number]
        inner = text[text.rindex(b"(") + 1 : text.index(b")")]
        return np.array([float(x) for x in inner.split(b",")])

    def _representations(self) -> Iterator[tuple[int, int]]:
        """Product definitions with their shape representations."""
        for number in self.kind.get(b"SHAPE_DEFINITION_REPRESENTATION", []):
            definition, representation = self._refs(number)
            yield self._refs(definition)[0], representation

    def _places(self) -> Iterator[tuple[int, tuple[Floats, Floats]]]:
        """Occurrences with their motions x -> turn x + shift."""
        for number in self.kind.get(b"CONTEXT_DEPENDENT_SHAPE_REPRESENTATION", []):
            relation, definition = self._refs(number)
            before, after = self._refs(self._refs(relation)[2])
            (here, origin), (there, target) = self._axes(before), self._axes(after)
            turn = there @ here.T
            yield self._refs(definition)[0], (turn, target - turn @ origin)

    def _axes(self, number: int) -> tuple[Floats, Floats]:
        """Columns x, y, z of a placement, and its origin."""
        origin, z, x = (self._floats(n) for n in self._refs(number))
        return np.stack([x, np.cross(z, x), z], axis=1), origin

    def _solid(self, representation: int) -> int | None:
        solids = set(self.kind.get(b"MANIFOLD_SOLID_BREP", []))
        return next((n for n in self._refs(representation) if n in solids), None)

    def _bent(self, solid: int) -> bool:
        """Whether it has a spline face: a strip, which is no prism."""
        faces = self._refs(self._refs(solid)[0])
        return not self._splines.isdisjoint(self._refs(face)[-1] for face in faces)

    @cached_property
    def _splines(self) -> frozenset[int]:
        return frozenset(self.kind.get(b"B_SPLINE_SURFACE_WITH_KNOTS", []))

    def _ends(self, solid: int) -> tuple[Points, Points]:
        """The corners of the faces at the lowest and the highest z of the solid's coordinates."""
        loops = [self._outer_loop(face) for face in self._refs(self._refs(solid)[0])]
        z = np.concatenate([loop[:, 2] for loop in loops])
        low = [loop for loop in loops if (np.abs(loop[:, 2] - z.min()) < _LEVEL).all()]
        high = [loop for loop in loops if (np.abs(loop[:, 2] - z.max()) < _LEVEL).all()]
        if len(low) != 1 or len(high) != 1 or len(low[0]) != len(high[0]):
            raise ValueError(f"#{solid} is no prism")
        return low[0], high[0]

    def _outer_loop(self, face: int) -> Points:
        """(k, 3) corners of the largest loop of a face; the others are openings."""
        loops = [self._loop(bound) for bound in self._refs(face)[:-1]]
        return max(loops, key=lambda loop: float(np.ptp(loop, axis=0).max()))

    def _loop(self, bound: int) -> Points:
        """(k, 3) corners of a loop."""
        corners = []
        for oriented in self._refs(self._refs(bound)[0]):
            edge = self._refs(oriented)[0]
            end = 0 if b".T." in self.text[oriented] else 1
            vertex = self._refs(edge)[end]
            corners.append(self._floats(self._refs(vertex)[0]))
        return np.array(corners)


def _plain(text: bytes) -> str:
    written = text.decode("ascii").replace("''", "'")

    def letters(found: re.Match[str]) -> str:
        return bytes.fromhex(found[1]).decode("utf-16-be")

    return _CODE.sub(letters, written)
