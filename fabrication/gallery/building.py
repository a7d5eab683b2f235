"""All figures, made one after the other, their pictures and reports written beside each other."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fabrication.errors import OutputError
from fabrication.gallery import (
    fig_03,
    fig_05,
    fig_06,
    fig_07,
    fig_08,
    fig_09,
    fig_10,
    fig_12,
    fig_13,
    fig_14,
    fig_15,
    fig_16,
    fig_17,
    fig_18,
)
from fabrication.gallery.figure import Figure
from gridshell import GridshellError, SettingError

FIGURES: dict[str, Callable[[], Figure]] = {
    "3": fig_03.figure,
    "5": fig_05.figure,
    "6": fig_06.figure,
    "7": fig_07.figure,
    "8": fig_08.figure,
    "9": fig_09.figure,
    "10": fig_10.figure,
    "12": fig_12.figure,
    "13": fig_13.figure,
    "14": fig_14.figure,
    "15": fig_15.figure,
    "16": fig_16.figure,
    "17": fig_17.figure,
    "18": fig_18.figure,
}
"""By their names in the paper; the others show photographs or definitions."""


@dataclass(frozen=True, eq=False)
class Row:
    """One line of the table.

    Parameters
    ----------
    name : of the figure.
    figure : None where it could not be made.
    fault : why not.
    seconds : it took.
    """

    name: str
    figure: Figure | None
    fault: str
    seconds: float

    @property
    def holds(self) -> bool:
        """Whether the figure was made and holds."""
        return self.figure is not None and self.figure.holds

    def report(self) -> dict[str, Any]:
        """For ``fig_NN.json``."""
        figure = self.figure
        if figure is None:
            made: dict[str, Any] = {"fault": self.fault}
        else:
            made = {
                "title": figure.title,
                "paper": dict(figure.paper),
                "ours": dict(figure.ours),
                "conditions": [
                    {"what": c.what, "value": _finite(c.value), "limit": c.limit, "holds": c.holds}
                    for c in figure.conditions
                ],
                "remarks": list(figure.remarks),
            }
        return {"figure": self.name, "holds": self.holds, **made, "seconds": round(self.seconds, 2)}


def chosen(names: Iterable[str]) -> tuple[str, ...]:
    """The figures called *names*, all of them for none; a letter behind the number is let go.

    Raises
    ------
    SettingError
        For a figure that is not here.
    """
    plain = (name.strip().lower().removeprefix("fig").strip(". ") for name in names)
    wanted = [name.rstrip("abcdef").lstrip("0") for name in plain]
    wrong = [name for name in wanted if name not in FIGURES]
    if wrong:
        raise SettingError(
            "The gallery has no such figure",
            where="FIGURE",
            value=repr(wrong[0]),
            limit=", ".join(FIGURES),
        )
    return tuple(name for name in FIGURES if name in wanted) or tuple(FIGURES)


def build(
    out: Path | str,
    names: Iterable[str] = (),
    *,
    announce: Callable[[str], None] = lambda name: None,
) -> list[Row]:
    """Make figures and write ``fig_NN.png``, ``fig_NN.json`` and ``gallery.json`` into *out*.

    Parameters
    ----------
    out : created if it is not there.
    names : of figures; all if none.
    announce : called with the name of each figure as it begins.

    Raises
    ------
    SettingError
        For a figure that is not here.
    OutputError
        When *out* cannot be written.
    """
    out = Path(out)
    figures = chosen(names)
    try:
        out.mkdir(parents=True, exist_ok=True)
        rows = list(_made(out, figures, announce))
        table = {"holds": all(row.holds for row in rows), "rows": [row.report() for row in rows]}
        _write_json(out / "gallery.json", table)
    except OSError as error:
        raise OutputError(
            "The gallery cannot be written", where=str(out), value=error.strerror or ""
        ) from None
    return rows


def _made(out: Path, figures: Iterable[str], announce: Callable[[str], None]) -> Iterator[Row]:
    from fabrication.export.raster import write_png

    for name in figures:
        announce(name)
        begin = time.perf_counter()
        stem = f"fig_{int(name):02d}"
        try:
            figure = FIGURES[name]()
            write_png(out / f"{stem}.png", figure.scenes, columns=figure.columns)
            row = Row(name, figure, "", time.perf_counter() - begin)
        except GridshellError as error:
            if isinstance(error, OutputError):
                raise
            row = Row(name, None, str(error), time.perf_counter() - begin)
        _write_json(out / f"{stem}.json", row.report())
        yield row


def _write_json(path: Path, content: dict[str, Any]) -> None:
    path.write_text(json.dumps(content, indent=2, allow_nan=False) + "\n", encoding="utf-8")


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
