"""The unit a file is in: the one it states, or the one that is given, never two that differ."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from gridshell.errors import UnitError
from gridshell.io.obj import Unit


def required_unit(path: Path, unit: Unit | None, kind: str) -> Unit:
    """*unit*, of a file that states none.

    Parameters
    ----------
    kind : what the file is, with its article: "The surface file".

    Raises
    ------
    UnitError
        Where there is none.
    """
    if unit is None:
        raise UnitError(
            f"{kind} states no unit",
            where=str(path),
            limit=", ".join(u.name.lower() for u in Unit),
            advice="give the unit the file was drawn in",
        )
    return unit


def require_same_unit(path: Path, unit: Unit | None, own: Sequence[float]) -> None:
    """Refuse a given *unit* that differs from one the file states.

    Parameters
    ----------
    own : sizes of the units the file states, mm; NaN where one is unknown.

    Raises
    ------
    UnitError
        Naming both.
    """
    odd = [size for size in own if not (unit is None or math.isclose(size, unit.value))]
    if odd and unit is not None:
        raise UnitError(
            "The unit given contradicts the file's own",
            where=str(path),
            value=f"{unit.name.lower()}; the file says {_name(odd[0])}",
            advice="leave the unit out: the file states it",
        )


def _name(size: float) -> str:
    """The unit of *size* mm."""
    for unit in Unit:
        if math.isclose(size, unit.value):
            return unit.name.lower()
    return "an unknown unit" if math.isnan(size) else f"{size:.6g} mm"
