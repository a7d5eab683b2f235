"""The colours of the two families, the same in solids, reports and pictures."""

from __future__ import annotations

FAMILY_COLOURS = {1: (0.80, 0.52, 0.25), 2: (0.36, 0.47, 0.58)}
"""sRGB, 0 to 1."""


def css(colour: tuple[float, float, float], shade: float = 1.0) -> str:
    """An sRGB colour, darker by *shade*, as CSS."""
    return "rgb({}, {}, {})".format(*(round(255 * shade * c) for c in colour))
