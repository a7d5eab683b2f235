"""The cutting list of bars: ``bars.csv``, and what the report says of the stock."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from fabrication.bars import BarPlan
from fabrication.errors import OutputError
from fabrication.splice_plan import SplicePlan

_HEADER = ("bar", "position", "mark", "start_mm", "length_mm", "offcut_mm")


def write_bars(path: Path | str, plan: BarPlan) -> Path:
    """One line per piece: bar, its position in it, mark, start from the bar's end, length, offcut.

    The offcut of a bar is told with its last piece.

    Raises
    ------
    OutputError
        When the file cannot be written.
    """
    path = Path(path)
    try:
        with path.open("w", newline="", encoding="utf-8") as file:
            table = csv.writer(file)
            table.writerow(_HEADER)
            for cut in plan.cut:
                last = len(cut.pieces)
                placed = zip(cut.pieces, cut.positions, strict=True)
                for number, (piece, start) in enumerate(placed, start=1):
                    offcut = f"{cut.offcut:.1f}" if number == last else ""
                    sizes = (f"{start:.1f}", f"{piece.length:.2f}", offcut)
                    table.writerow((cut.number, number, piece.mark, *sizes))
    except OSError as error:
        raise OutputError(
            "The list of bars cannot be written", where=str(path), value=error.strerror or ""
        ) from None
    return path


def stock_report(plan: SplicePlan, front: Sequence[SplicePlan] = ()) -> dict[str, Any]:
    """The chosen *plan*, and the *front* it was chosen from, for ``report.json``."""
    bars = plan.bars
    return {
        "bar_mm": bars.bar.length,
        "kerf_mm": bars.bar.kerf,
        "trim_mm": bars.bar.trim,
        **_figures(plan),
        "waste_mm": round(bars.waste, 1),
        "text": stock_text(plan),
        "tradeoff": [_figures(one) for one in front],
    }


def stock_text(plan: SplicePlan) -> str:
    """One sentence: bars, whether fewer could do, yield, splices."""
    bars = plan.bars
    told = (
        "proven to be the fewest for these pieces"
        if bars.proven
        else f"at least {bars.bound} are needed for these pieces"
    )
    return (
        f"{bars.bars} bars of {bars.bar.length:g} mm, {told} "
        f"({plan.floor} whatever the splices), yield {100.0 * bars.used:.1f} %, "
        f"{plan.count} splices"
    )


def _figures(plan: SplicePlan) -> dict[str, Any]:
    bars = plan.bars
    return {
        "bars": bars.bars,
        "bound": bars.bound,
        "proven": bars.proven,
        "bound_any_splices": plan.floor,
        "yield": round(bars.used, 4),
        "splices": plan.count,
        "splices_not_staggered": len(plan.findings),
    }
