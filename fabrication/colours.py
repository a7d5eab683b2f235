"""The colours of the two families, the same in solids, reports and pictures."""

from __future__ import annotations

from gridshell.picture import FAMILY_COLOURS

__all__ = ["FAMILY_COLOURS", "css"]


def css(colour: tuple[float, float, float], shade: float = 1.0) -> str:
    """An sRGB colour, darker by *shade*, as CSS."""
    return "rgb({}, {}, {})".format(*(round(255 * shade * c) for c in colour))
