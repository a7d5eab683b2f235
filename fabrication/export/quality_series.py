"""The figures of a design element by element, as what histograms are drawn of.

A report page calls::

    series = (*net_series(quality.figures, surface_limit=limit), stress_series(stress))
    pictures = [Markup(svg) for svg in histograms(series)]
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import gridshell as gs
from fabrication.export.histogram import histogram
from fabrication.strength import BayStress
from gridshell.arrays import Floats


@dataclass(frozen=True, eq=False)
class Series:
    """Values of one figure.

    Parameters
    ----------
    title : what they are.
    unit : empty for a ratio.
    values : (n,) in that unit.
    limit : what is allowed; None where nothing says.
    """

    title: str
    unit: str
    values: Floats
    limit: float | None = None


def net_series(figures: gs.NetFigures, *, surface_limit: float | None = None) -> tuple[Series, ...]:
    """What a net is judged by, as far as it was asked for.

    Parameters
    ----------
    figures : ``NetQuality.figures``.
    surface_limit : distance from the surface above which it is remarked, mm.
    """
    found = (
        ("Node angle error", "°", figures.angle_error_deg, None),
        ("Star planarity, over mean edge", "", figures.star_planarity, None),
        ("Face planarity, over mean diagonal", "", figures.face_planarity, None),
        ("Sphericity, over mean edge", "", figures.sphericity, None),
        ("Rhombus error, over mean diagonal", "", figures.rhombus_error, None),
        ("Edge length over the mean", "", figures.edge_ratio, None),
        ("Distance from the surface", "mm", figures.surface_distance_mm, surface_limit),
    )
    return tuple(
        Series(title, unit, values, limit)
        for title, unit, values, limit in found
        if values is not None and len(values)
    )


def stress_series(stress: BayStress) -> Series:
    """Utilisation of every bay, %, with the strength as its limit."""
    return Series("Utilisation of the strength, by bay", "%", 100.0 * stress.utilisation, 100.0)


def histograms(series: Iterable[Series]) -> list[str]:
    """One SVG for each."""
    return [
        histogram(one.values, title=one.title, unit=one.unit, limit=one.limit) for one in series
    ]
