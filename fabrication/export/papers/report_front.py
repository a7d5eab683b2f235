"""What the reports on strips and on panels share: title, key figures, findings, histograms."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from fabrication.export.papers.drawn import (
    Colour,
    Figure,
    box,
    chart_blocks,
    figure_blocks,
    picture_block,
)
from fabrication.export.papers.flow import (
    BODY,
    LINE,
    Block,
    heading,
    paragraph,
    space,
    subheading,
    table,
    wrapped,
)
from fabrication.export.papers.report_figures import remesh_figures
from fabrication.export.papers.sheet_frame import Area, Pen, text_width, today
from fabrication.export.papers.tables import Column
from fabrication.export.quality_series import Series
from fabrication.export.verdicts import finding_groups, verdict
from gridshell.painter import Faces

_GRADES = {
    "good": (0.17, 0.48, 0.29),
    "warning": (0.66, 0.41, 0.05),
    "error": (0.70, 0.15, 0.12),
}
_UNKNOWN = (0.35, 0.39, 0.45)

_PLACES = 6
"""Of a kind of finding, where it was found, at most."""

_FINDINGS = (
    Column("severity", 0.8),
    Column("code", 1.4),
    Column("places", 0.6, "right"),
    Column("where", 1.4),
    Column("what the first says", 4.8),
)


def front(
    name: str,
    report: Mapping[str, Any],
    subtitle: str,
    layers: Sequence[Faces],
    legend: Sequence[tuple[str, Colour]],
) -> Iterator[Block]:
    """Name, verdict and picture of the shell."""
    level, words = verdict(report.get("findings"))
    yield from paragraph("Fabrication report", size=1.8, grey=0.35)
    for line in wrapped(name, LINE, 5.0, bold=True):
        yield _title(line)
    yield space(3.0)
    yield from paragraph(subtitle, grey=0.35)
    yield _verdict(words, _GRADES.get(level, _UNKNOWN))
    yield space(4.0)
    yield picture_block(layers)
    yield _legend(legend)


def _title(line: str) -> Block:
    def draw(pen: Pen, area: Area) -> None:
        pen.text(area.x, area.y + 1.6, line, height=5.0, bold=True)

    return Block(8.6, draw, joined=True)


def _verdict(words: str, colour: Colour) -> Block:
    def draw(pen: Pen, area: Area) -> None:
        box(pen, area, (0.96, 0.965, 0.975))
        box(pen, Area(area.x, area.y, 1.4, area.height), colour)
        pen.text(area.x + 5.0, area.y + 3.0, words, height=2.6, bold=True, within=LINE - 8.0)

    return Block(8.6, draw)


def _legend(entries: Sequence[tuple[str, Colour]]) -> Block:
    def draw(pen: Pen, area: Area) -> None:
        x = area.x
        for word, colour in entries:
            box(pen, Area(x, area.y + 1.6, 2.4, 2.4), colour)
            pen.text(x + 4.0, area.y + 1.9, word, height=1.8, grey=0.35)
            x += text_width(word, 1.8) + 10.0

    return Block(6.0, draw)


def key_figures(*groups: tuple[str, Iterable[Figure]]) -> Iterator[Block]:
    """Groups of key figures under their titles."""
    yield heading("Key figures")
    for title, figures in groups:
        yield subheading(title)
        yield from figure_blocks(list(figures))


def surface_group(report: Mapping[str, Any]) -> tuple[tuple[str, Iterable[Figure]], ...]:
    """Key figures of the way from the surface to the net, where there was one."""
    laid = report.get("remesh")
    return (("From the surface to the net", remesh_figures(laid)),) if laid else ()


def found(report: Mapping[str, Any], unchecked: str) -> Iterator[Block]:
    """The findings by kind, and what is not checked."""
    yield heading("Findings")
    findings = report.get("findings")
    if findings is None:
        yield from paragraph("The design was not checked.")
    elif not findings:
        yield from paragraph("No findings.")
    else:
        yield from table(_FINDINGS, [_finding_row(g) for g in finding_groups(findings)])
    yield from paragraph(unchecked, size=BODY, grey=0.35)


def _finding_row(group: Sequence[Mapping[str, Any]]) -> tuple[str, ...]:
    first = group[0]
    words = (str(first.get(key, "")) for key in ("severity", "code"))
    places = [str(finding.get("where", "")) for finding in group]
    told = ", ".join(places[:_PLACES]) + (" ..." if len(places) > _PLACES else "")
    return (*words, f"{len(group)}", told, str(first.get("message", "")))


def charts(series: Sequence[Series]) -> Iterator[Block]:
    """The histograms."""
    yield heading("Quality")
    yield from chart_blocks(series)


def foot_words(name: str) -> str:
    """What stands at the foot of every page."""
    return f"{name}   -   report of {today().isoformat()}"
