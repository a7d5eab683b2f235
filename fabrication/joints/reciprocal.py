"""Segmented, reciprocal lamellas (Fig. 15b): one runs through a node, the other is cut there.

Either one family runs through everywhere, or the families take turns from node to node: a
pinwheel, in which every piece crosses one node and ends at its neighbours. Pieces are bevelled so
that they lie against the strip that runs through, and welded to it or held by angle cleats.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fabrication.cut import Cuts
from fabrication.finding import Finding, Severity
from fabrication.jointed import BillLine, Jointed
from fabrication.joints.cleats import Cleat, cleat_findings, cleat_lines, cleats
from fabrication.joints.joint import Joint
from fabrication.joints.piece_ends import (
    Ends,
    Span,
    cut_ends,
    end_fixtures,
    piece_ends,
    spans,
    through_families,
)
from fabrication.lamella import Lamella, piece_of
from fabrication.node import Crossing
from fabrication.shapes import Prisms
from fabrication.stock import Profile, require_distance, require_positive
from fabrication.structures import Structure
from gridshell import SettingError
from gridshell.arrays import Floats, Indices, Mask


@dataclass(frozen=True)
class ReciprocalJoint(Joint):
    """Pieces from bay to bay between strips that run through.

    Parameters
    ----------
    gap : what a piece is shorter than its place, both ends together, mm.
    through : family that runs through, 1 or 2; of a pinwheel that at its first node.
    pinwheel : whether the families take turns from node to node.
    square_ends : whether ends are cut square and not bevelled to the node angle.
    weld : length of the seams at one end of a piece, mm; twice the width unless said otherwise,
        0 where nothing is welded.
    cleat : an angle on either side of every end; none unless said otherwise.
    shortest : length of a piece below which it is told, mm; twice the width unless said otherwise.
    sharpest : smallest node angle an end can be bevelled to, radians.

    Raises
    ------
    SettingError
        For a negative length, a family that does not exist, or an angle out of (0, pi / 2).
    """

    gap: float = 0.5
    through: int = 1
    pinwheel: bool = False
    square_ends: bool = False
    weld: float | None = None
    cleat: Cleat | None = None
    shortest: float | None = None
    sharpest: float = float(np.radians(30.0))

    def __post_init__(self) -> None:
        require_distance("gap", self.gap)
        if self.weld is not None:
            require_distance("weld", self.weld)
        if self.shortest is not None:
            require_positive("shortest", self.shortest)
        if self.through not in (1, 2):
            raise SettingError(
                "No such family", where="through", value=f"{self.through}", limit="1 or 2"
            )
        if not 0.0 < self.sharpest < np.pi / 2.0:
            raise SettingError(
                "The sharpest bevel is an angle between two strips",
                where="sharpest",
                value=f"{np.degrees(self.sharpest):g} degrees",
                limit="between 0 and 90 degrees",
                advice="30 degrees",
            )

    def build(self, design: Structure) -> Jointed:
        """Through strips whole, the others in pieces with bevelled ends.

        Raises
        ------
        SettingError
            When nothing is left of a piece, a pinwheel does not close, or a cleat is higher than
            the strips.
        """
        self._require_cleat(design.profile)
        through = through_families(design, self.through, pinwheel=self.pinwheel)
        made = [
            span
            for number, lamella in enumerate(design.lamellas)
            for span in spans(lamella, number, _cut(lamella, through))
        ]
        ends = piece_ends(design, made, square=self.square_ends)
        trims, bevels = self._trims(made, ends)
        marks = _marks(design, made)
        pieces = tuple(
            _piece(design, span, mark, cut_ends(design, span, (row[0], row[1])))
            for span, mark, row in zip(made, marks, trims.tolist(), strict=True)
        )
        for piece, bevel in zip(pieces, bevels, strict=True):
            _require_length(piece, float(np.abs(bevel).sum()))
        connectors: tuple[Prisms, ...] = ()
        bill = tuple(self._bill(design.profile, len(ends.node)))
        if self.cleat is not None:
            connectors = (cleats(self.cleat, design, ends, marks),)
            bill = (*bill, *cleat_lines(self.cleat, connectors[0]))
        return Jointed(
            design=design,
            strips=_structure(design, pieces, made),
            carriers=tuple(span.carrier for span in made),
            cuts={
                mark: Cuts(bevels=(row[0], row[1]))
                for mark, row in zip(marks, bevels.tolist(), strict=True)
            },
            fixtures=end_fixtures(design, made, pieces, ends, bevels, self.gap),
            connectors=connectors,
            bill=bill,
            findings=tuple(self._findings(design, pieces, made, ends)),
        )

    def _require_cleat(self, profile: Profile) -> None:
        if self.cleat is not None and self.cleat.height > profile.width:
            raise SettingError(
                "The cleats are higher than the strips",
                where="cleat.height",
                value=f"{self.cleat.height:g} mm",
                limit=f"at most the width, {profile.width:g} mm",
                advice=f"{0.6 * profile.width:g} mm",
            )

    def _trims(self, made: Sequence[Span], ends: Ends) -> tuple[Floats, Floats]:
        """(n, 2) what is cut back from the nodes of each span, and its bevels, mm."""
        trims, bevels = np.zeros((len(made), 2)), np.zeros((len(made), 2))
        trims[ends.span, ends.side] = np.minimum(ends.near, ends.far) + self.gap / 2.0
        bevels[ends.span, ends.side] = np.round(ends.far - ends.near, 9)
        return trims, bevels

    def _bill(self, profile: Profile, ends: int) -> Iterator[BillLine]:
        seam = 2.0 * profile.width if self.weld is None else self.weld
        if seam > 0.0 and ends > 0:
            note = f"fillets, {ends} ends of pieces with {seam:g} mm each"
            yield BillLine("weld", f"{seam:g} mm", ends * seam, "mm", note=note)

    # ---- findings ------------------------------------------------------------------------------

    def _findings(
        self, design: Structure, pieces: Sequence[Lamella], made: Sequence[Span], ends: Ends
    ) -> Iterator[Finding]:
        yield from _singular(design)
        shortest = 2.0 * design.profile.width if self.shortest is None else self.shortest
        for piece, span in zip(pieces, made, strict=True):
            if any(span.cut) and piece.length < shortest:
                yield Finding(
                    "short-piece",
                    Severity.WARNING,
                    piece.mark,
                    piece.length,
                    shortest,
                    "mm",
                    f"{piece.mark} is {piece.length:.1f} mm long; pieces below {shortest:g} mm are "
                    "hard to hold and to weld. Use fewer lamellas, or let the other family run "
                    "through.",
                )
        if not self.square_ends:
            yield from self._sharp(design, ends)
        if self.cleat is not None:
            yield from cleat_findings(self.cleat, design, ends)

    def _sharp(self, design: Structure, ends: Ends) -> Iterator[Finding]:
        for number in dict.fromkeys(ends.node.tolist()):
            node = design.nodes[number]
            angle = node.angle or np.pi / 2.0
            sharp = float(np.degrees(min(angle, np.pi - angle)))
            if sharp < np.degrees(self.sharpest):
                yield Finding(
                    "sharp-bevel",
                    Severity.ERROR,
                    node.name,
                    sharp,
                    float(np.degrees(self.sharpest)),
                    "degrees",
                    f"The lamellas meet at {sharp:.1f} degrees at {node.name}; ends can be "
                    f"bevelled to {np.degrees(self.sharpest):.0f}. Use square ends, or open the "
                    "node angle.",
                )


# ---- pieces ------------------------------------------------------------------------------------


def _cut(lamella: Lamella, through: Indices) -> Mask:
    """(k,) whether a lamella is cut at each of its nodes."""
    there = through[lamella.nodes]
    return np.asarray((there != 0) & (there != lamella.family))


def _marks(design: Structure, made: Sequence[Span]) -> list[str]:
    """Marks of pieces in order along a lamella, "B3.1", "B3.2", ...; a whole one keeps its own."""
    count: dict[int, int] = {}
    marks = []
    for span in made:
        count[span.carrier] = count.get(span.carrier, 0) + 1
        mark = design.lamellas[span.carrier].mark
        marks.append(f"{mark}.{count[span.carrier]}" if any(span.cut) else mark)
    return marks


def _piece(design: Structure, span: Span, mark: str, ends: tuple[float, float]) -> Lamella:
    lamella = design.lamellas[span.carrier]
    if not any(span.cut):
        return lamella
    return piece_of(lamella, mark, (span.first, span.last), *ends)


def _require_length(piece: Lamella, bevels: float) -> None:
    if not piece.length - bevels > 0.0:
        raise SettingError(
            "Nothing is left of a piece between two strips that run through",
            where=piece.mark,
            value=f"{piece.length - bevels:.1f} mm",
            limit="> 0",
            advice="fewer lamellas, a smaller gap, or the other family running through",
        )


def _structure(design: Structure, pieces: Sequence[Lamella], made: Sequence[Span]) -> Structure:
    """The pieces, and the design's nodes with all strips that pass there or end there."""
    crossings: list[list[Crossing]] = [[] for _ in design.nodes]
    for index, piece in enumerate(pieces):
        for node, station in zip(piece.nodes.tolist(), piece.stations.tolist(), strict=True):
            crossings[node].append(Crossing(index, station))
    nodes = tuple(
        replace(node, crossings=tuple(own))
        for node, own in zip(design.nodes, crossings, strict=True)
    )
    return Structure(tuple(pieces), nodes, design.profile)


def _singular(design: Structure) -> Iterator[Finding]:
    """Nodes where more than two lamellas end: nothing runs through."""
    for node in design.nodes:
        if len(node.crossings) > 2:
            yield Finding(
                "singular-node",
                Severity.WARNING,
                node.name,
                float(len(node.crossings)),
                2.0,
                "lamellas",
                f"{len(node.crossings)} lamellas end at {node.name}; a reciprocal joint connects "
                "two. The strips stop short of each other: add a connector.",
            )
