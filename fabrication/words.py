"""Numbers and counts as people read them."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from fabrication.finding import Severity


def plural(count: int, word: str) -> str:
    """*count* and *word*, with an s where it wants one ("info" has no plural)."""
    return f"{count} {word}" if count == 1 or word == Severity.INFO.value else f"{count} {word}s"


def number(value: Any, digits: int = 4) -> str:
    """*value* with so many digits that count; a power of ten where it is very small or large."""
    if isinstance(value, int) or not finite(value) or value == 0.0:
        return fixed(value, 0)
    if not 1e-3 <= abs(value) < 1e7:
        mantissa, exponent = f"{value:.2e}".replace("-", "−").split("e")
        power = f"{int(exponent.replace('−', '-'))}"
        return f"{mantissa} × 10{power.translate(str.maketrans('-0123456789', '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'))}"
    return fixed(value, max(0, digits - 1 - int(np.floor(np.log10(abs(value))))))


def fixed(value: Any, decimals: int) -> str:
    """*value* with so many decimals, thousands apart; a dash where there is none."""
    if not finite(value):
        return "–"
    return f"{value:,.{decimals}f}".replace(",", "\u202f").replace("-", "−")


def finite(value: Any) -> bool:
    """Whether *value* is a number that can be shown."""
    return isinstance(value, (int, float)) and bool(np.isfinite(value))


def raised(text: str) -> str:
    """*text* with mm2 and mm3 as mm² and mm³."""
    return re.sub(r"\bmm([23])\b", lambda found: "mm" + "²³"[int(found[1]) - 2], text)
