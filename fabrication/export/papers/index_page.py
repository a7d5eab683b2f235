"""The first sheets: what there is, what is bought, what was found, what is not checked."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

from fabrication.export.papers.sheet_frame import Area, Page, Pen
from fabrication.export.papers.tables import Column, table_pages
from fabrication.finding import Finding
from fabrication.jointed import BillLine, Jointed
from fabrication.parts import FlatPart
from fabrication.strength import NOT_CHECKED

BILL_COLUMNS = (
    Column("item", 1.2),
    Column("size", 3.0),
    Column("quantity", 0.8, "right"),
    Column("material", 1.2),
    Column("mass of one, kg", 1.0, "right"),
    Column("note", 3.2),
)
_FINDINGS = (
    Column("severity", 0.7),
    Column("code", 1.1),
    Column("how many", 0.6, "right"),
    Column("the first", 8.0),
)


def index_page(
    jointed: Jointed, parts: Sequence[FlatPart], pages: Sequence[Page], *, name: str
) -> Page:
    """Counts, the list of sheets, and what is not checked."""
    profile = jointed.design.profile
    count = parts[0].quantity if parts else 1
    mass = sum(part.quantity * part.volume for part in parts) * profile.material.density * 1e-9
    connectors = count * sum(len(kind.bodies) for kind in jointed.connectors)
    facts: tuple[str, ...] = (
        f"{len(jointed.design.lamellas)} lamellas, {len(jointed.design.nodes)} nodes",
        f"{len(parts)} strips of {profile.size} mm, "
        f"{profile.material.name}: {sum(p.quantity * p.length for p in parts) / 1e3:.1f} m, "
        f"{mass:.1f} kg",
        f"{connectors} connectors",
    )
    if count > 1:
        told = f"{count} equal segments: plans, nodes and the list of strips show one of them"
        facts = (*facts, f"{told}; metres, mass, connectors and the bill are those of all")

    def draw(pen: Pen, area: Area) -> None:
        x, y = area.x + 12.0, area.y + area.height - 22.0
        pen.text(x, y, name, height=8.0, bold=True, within=area.width - 24.0)
        for line in facts:
            y -= 7.0
            pen.text(x, y, line, height=3.2)
        y -= 12.0
        pen.text(x, y, "Sheets", height=3.5, bold=True)
        for number, title in _listed([page.title for page in pages], first=2):
            y -= 5.0
            pen.text(x, y, number)
            pen.text(x + 22.0, y, title)
        y -= 12.0
        pen.text(x, y, "Not checked", height=3.5, bold=True)
        for line in NOT_CHECKED:
            y -= 5.0
            pen.text(x, y, line, within=area.width - 24.0)

    return Page("Index", "-", draw)


def bill_pages(jointed: Jointed, *, paper: str) -> Iterator[Page]:
    """The bill of material besides the strips."""
    if jointed.bill:
        rows = [bill_row(line) for line in jointed.bill]
        yield from table_pages("Bill of material", BILL_COLUMNS, rows, paper=paper)


def finding_pages(findings: Sequence[Finding], *, paper: str) -> Iterator[Page]:
    """One row per kind of finding."""
    if not findings:
        return
    counts = Counter((f.severity.value, f.code) for f in findings)
    first = {(f.severity.value, f.code): f.message for f in reversed(findings)}
    order = ("error", "warning", "info")
    rows = [
        (severity, code, f"{count}", first[severity, code])
        for (severity, code), count in sorted(
            counts.items(), key=lambda item: (order.index(item[0][0]), item[0][1])
        )
    ]
    yield from table_pages("Findings", _FINDINGS, rows, paper=paper)


def bill_row(line: BillLine) -> tuple[str, ...]:
    """The cells of a line of the bill."""
    quantity = f"{line.quantity:g}" if line.unit == "pcs" else f"{line.quantity / 1e3:.2f} m"
    mass = "" if line.mass is None else f"{line.mass:.3g}"
    return (line.item, line.size, quantity, line.material, mass, line.note)


def _listed(titles: Sequence[str], first: int) -> Iterator[tuple[str, str]]:
    """Sheet numbers and titles, sheets of one kind together, as many lines as fit a page."""
    kinds: list[list[int]] = []
    words: list[str] = []
    for number, title in enumerate(titles, start=first):
        word = title.split(" ")[0].rstrip("s")
        if words and words[-1] == word:
            kinds[-1].append(number)
        else:
            words.append(word)
            kinds.append([number])
    for numbers in kinds:
        low, high = numbers[0], numbers[-1]
        title = titles[low - first]
        if high > low:
            yield f"{low} - {high}", f"{title} ... {titles[high - first]}"
        else:
            yield f"{low}", title
