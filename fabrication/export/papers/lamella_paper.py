"""The report to print on lamellas: what the report's page shows, on A4 portrait pages."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from fabrication.colours import FAMILY_COLOURS
from fabrication.export.papers.flow import Block, heading, paragraph, table, write_flow
from fabrication.export.papers.index_page import BILL_COLUMNS, bill_row
from fabrication.export.papers.report_figures import (
    facade_figures,
    file_figures,
    net_figures,
    stress_figures,
    strip_figures,
)
from fabrication.export.papers.report_front import (
    charts,
    foot_words,
    found,
    front,
    key_figures,
    surface_group,
)
from fabrication.export.papers.tables import Column
from fabrication.export.quality_series import Series, stress_series
from fabrication.export.schedule import mass
from fabrication.export.stress_view import stress_rows
from fabrication.jointed import Jointed
from fabrication.nesting import NestedSheet, sheets_of
from fabrication.outlines import Frame
from fabrication.parts import FlatPart
from fabrication.ribbons import ribbons
from fabrication.strength import BayStress
from fabrication.stress_checks import stress_section
from fabrication.words import fixed, number
from gridshell.painter import Faces, painted

_COPY = (0.80, 0.82, 0.84)
_MOST_FACES = 4_000
"""Faces in the picture, about."""

_STRESS = (
    *(Column("mark", 0.8), Column("worst bay", 1.4), Column("used, %", 0.8, "right")),
    Column("von Mises, N/mm²", 1.0, "right"),
    *(Column(word, 1.0, "right") for word in ("bending", "shear by twist", "stretch by twist")),
    *(Column("strong axis", 1.0, "right"), Column("radius, m", 1.0, "right")),
    *(Column("twist, °/m", 0.9, "right"), Column("largest thickness, mm", 1.1, "right")),
    Column("net section, %", 1.0, "right"),
)
_STRIPS = (
    *(Column("mark", 0.8), Column("pieces", 0.7, "right"), Column("length, mm", 1.1, "right")),
    *(Column("slots", 0.6, "right"), Column("slot width, mm", 1.5, "right")),
    *(Column("holes", 0.6, "right"), Column("mass, kg", 0.9, "right"), Column("sheet", 1.2)),
)


def write_lamella_paper(
    path: Path | str,
    *,
    name: str,
    report: Mapping[str, Any],
    series: Sequence[Series],
    jointed: Jointed,
    parts: Sequence[FlatPart],
    stress: BayStress,
    sheets: Sequence[NestedSheet] = (),
    copies: Sequence[Frame] = (),
) -> Path:
    """Write the report on lamellas; the same input gives the same bytes on the same day.

    Parameters
    ----------
    name : the project's.
    report : what ``report.json`` holds; a figure that is missing reads "not measured".
    series : of the net; that of the stress is added.
    parts : one per strip, in the strips' order.
    sheets : where the parts lie.
    copies : where else the shell stands.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    strips, profile = jointed.strips, jointed.strips.profile
    longest = max(parts, key=lambda part: round(part.length, 1), default=None)
    told = "" if longest is None else f"longest {longest.mark}, {fixed(longest.length, 1)} mm"
    material = stress_section(stress)
    raw = "bar" if (report.get("stock") or {}).get("bars") else "sheet"
    blocks = [
        *front(
            name,
            report,
            f"{len(jointed.design.lamellas)} lamellas, {len(jointed.design.nodes)} nodes. Strips "
            f"{profile.size} mm, {profile.material.name}.",
            _shell(jointed, copies),
            (("Family A", FAMILY_COLOURS[1]), ("Family B", FAMILY_COLOURS[2])),
        ),
        *key_figures(
            *surface_group(report),
            ("Net", net_figures(report.get("net") or {})),
            ("Structure", strip_figures(report.get("structure") or {}, told, raw)),
            ("Material", stress_figures(material)),
            ("Files and fit", file_figures(report)),
            *((("Facade", facade_figures(report["facade"])),) if report.get("facade") else ()),
        ),
        *found(report, f"Not checked: {', '.join(material['not_checked'])}."),
        *charts((*series, stress_series(stress))),
        heading("Stress by strip"),
        *table(_STRESS, [_stress_row(row) for row in stress_rows(strips, stress)]),
        *paragraph("Stresses in N/mm², of each the largest along the strip.", grey=0.35),
        *(_bill(jointed) if jointed.bill else ()),
        heading("Cut list"),
        *table(_STRIPS, _strip_rows(parts, jointed, sheets)),
    ]
    return write_flow(path, blocks, title=f"{name}: report", foot=foot_words(name))


def _shell(jointed: Jointed, copies: Sequence[Frame]) -> tuple[Faces, ...]:
    """The strips as ribbons, and pale ones where the shell stands once more."""
    strips = jointed.strips.lamellas
    bays = sum(len(strip.stations) for strip in strips) * (1 + len(copies))
    per_bay = int(np.clip(_MOST_FACES // max(bays, 1), 1, 4))
    width = jointed.strips.profile.width
    own = ribbons(strips[:: max(1, bays // (2 * _MOST_FACES))], width, per_bay=per_bay)
    again = tuple(
        Faces(frame.place(faces.corners), painted(_COPY, len(faces.corners)))
        for frame in copies
        for faces in own
    )
    return (*again, *own)


def _stress_row(row: Mapping[str, Any]) -> tuple[str, ...]:
    texts = (text for _, text in row["cells"])
    return (row["mark"], row["bay"], fixed(row["used"], 0), *texts)


def _bill(jointed: Jointed) -> Iterator[Block]:
    yield heading("Bill of material")
    yield from table(BILL_COLUMNS, [bill_row(line) for line in jointed.bill])


def _strip_rows(
    parts: Sequence[FlatPart], jointed: Jointed, sheets: Sequence[NestedSheet]
) -> list[tuple[str, ...]]:
    on, material = sheets_of(sheets), jointed.strips.profile.material
    rows: list[tuple[str, ...]] = []
    for part in parts:
        widths = [slot.width for slot in part.slots]
        low, high = (f"{end:.2f}" if widths else "" for end in _ends(widths))
        rows.append(
            (
                part.mark,
                f"{part.quantity}",
                fixed(part.length, 1),
                f"{len(part.slots)}",
                low if low == high else f"{low} to {high}",
                f"{len(part.holes) + len(part.drills)}",
                number(mass(part, material)),
                " ".join(map(str, on.get(part.mark, ()))),
            )
        )
    count = sum(part.quantity for part in parts)
    metres = fixed(sum(part.quantity * part.length for part in parts), 1)
    cuts = sum(part.quantity * len(part.slots) for part in parts)
    holes = sum(part.quantity * (len(part.holes) + len(part.drills)) for part in parts)
    whole = number(sum(part.quantity * mass(part, material) for part in parts))
    return [*rows, ("all", f"{count}", metres, f"{cuts}", "", f"{holes}", whole, "")]


def _ends(values: Sequence[float]) -> tuple[float, float]:
    return (min(values), max(values)) if values else (0.0, 0.0)
