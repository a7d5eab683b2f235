"""The material check as the report shows it: colours of the strips, and a table by strip."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from fabrication.export.scene.layers import Colouring
from fabrication.strength import BayStress
from fabrication.structures import Structure
from fabrication.words import fixed, number
from gridshell.arrays import Floats


def stress_colourings(stress: BayStress) -> list[Colouring]:
    """What the strips can be coloured by, bay by bay.

    Utilisation has a fixed scale, so that red means used up; the others run to their own largest.
    """
    bend = 1.0 / np.maximum(stress.radius, 1e-9)
    twist = np.degrees(stress.twist) * 1e3
    sharpest, fastest = _largest(bend), _largest(twist)
    worst, most = _largest(stress.von_mises_edge), _largest(stress.edgewise)
    tightest = "straight" if sharpest == 0.0 else f"radius {number(1e-3 / sharpest, 3)} m"
    scales = (
        ("Utilisation", stress.utilisation, 1.0, "0 %", "100 % of the strength, or more"),
        ("Von Mises stress", stress.von_mises_edge, worst, "0", f"{number(worst, 3)} N/mm²"),
        ("Bending radius", bend, sharpest, "straight", tightest),
        ("Twist", twist, fastest, "0", f"{number(fastest, 3)} °/m"),
        ("Strong-axis bending", stress.edgewise, most, "0", f"{number(most, 3)} N/mm²"),
    )
    return [
        Colouring(name, "bays", values / (top or 1.0), low, high)
        for name, values, top, low, high in scales
    ]


def stress_rows(strips: Structure, stress: BayStress) -> list[dict[str, Any]]:
    """Of every strip its worst bay, and the worst of each figure, as the table shows them."""
    rows = []
    for index, lamella in enumerate(strips.lamellas):
        bays = stress.of_strip(index)
        if len(bays) == 0:
            continue
        worst = int(bays[np.argmax(stress.utilisation[bays])])
        rows.append(
            {
                "mark": lamella.mark,
                "family": lamella.family,
                "bay": stress.bays[worst],
                "used": 100.0 * float(stress.utilisation[worst]),
                "cells": _cells(stress, bays),
            }
        )
    return rows


def _cells(stress: BayStress, bays: Any) -> list[tuple[float, str]]:
    """Value and text of the remaining columns, in their order."""
    tightest, thickest = float(stress.radius[bays].min()), float(stress.thickest[bays].min())
    figures = [
        (float(values[bays].max()), 0)
        for values in (
            *(stress.von_mises_edge, stress.bending, stress.shear),
            *(stress.helix_edge, stress.edgewise),
        )
    ]
    return [
        *((value, fixed(value, decimals)) for value, decimals in figures),
        _open(tightest / 1e3, "straight"),
        (rate := float(np.degrees(stress.twist[bays].max()) * 1e3), fixed(rate, 1)),
        ((0.0, "none") if thickest == 0.0 else _open(np.floor(thickest * 100.0) / 100.0, "any")),
        (share := 100.0 * float(stress.net_modulus[bays].min()), fixed(share, 0)),
    ]


def _open(value: float, word: str) -> tuple[float, str]:
    """*value* with two decimals; *word* where it has no end."""
    return (float(value), fixed(float(value), 2)) if np.isfinite(value) else (1e12, word)


def net_words(stress: BayStress) -> tuple[float, float]:
    """Smallest shares of the section's area and section modulus, %."""
    shares: Sequence[Floats] = (stress.net_area, stress.net_modulus)
    area, modulus = (100.0 * float(values.min(initial=1.0)) for values in shares)
    return area, modulus


def _largest(values: Floats) -> float:
    return float(values.max(initial=0.0))
