"""A lamella as a straight flat strip, and how far from straight it would have to be.

The strip that holds the surface normal along an asymptotic curve is not developable (K = -tau^2),
but its axis has no normal curvature: the strip is straight, its width stands on the surface, and
the price is a stretch of the edges of tau^2 (h/2)^2 / 2, which is reported.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fabrication.lamella import Lamella
from gridshell.arrays import Floats, frozen

_SAMPLES_PER_BAY = 8


@dataclass(frozen=True, eq=False)
class Development:
    """The flat strip of one lamella.

    Parameters
    ----------
    length : developed length, mm.
    node_x : (k,) position of each node from the strip's cut end, mm.
    edgewise : largest distance of the unrolled axis from a straight line between its end nodes,
        or its ends where it stops short of them, mm: what the strip is pushed sideways to lie in
        its place. Zero on an asymptotic curve.
    edge_strain : largest stretch of the strip's edges.
    """

    length: float
    node_x: Floats
    edgewise: float
    edge_strain: float


def unroll(lamella: Lamella, width: float) -> Development:
    """Unroll *lamella*, a strip of *width* mm."""
    nodes = len(lamella.stations)
    s = np.linspace(*_held(lamella), _SAMPLES_PER_BAY * nodes + 1)
    _, strong = lamella.bending(s)
    along = s - s[0]
    slope = np.r_[0.0, np.cumsum((strong[1:] + strong[:-1]) / 2.0 * along[1])]
    sag = np.r_[0.0, np.cumsum((slope[1:] + slope[:-1]) / 2.0 * along[1])]
    straight = sag[-1] * along / along[-1] if along[-1] > 0.0 else sag
    twist = lamella.twist(s)
    return Development(
        length=lamella.length,
        node_x=frozen(lamella.stations - lamella.start),
        edgewise=float(np.abs(sag - straight).max()),
        edge_strain=float((twist**2).max() * (width / 2.0) ** 2 / 2.0),
    )


def _held(lamella: Lamella) -> tuple[float, float]:
    """Stations between which the strip must lie in its place: it need not reach its end nodes."""
    if lamella.closed:
        return lamella.start, lamella.end
    return max(0.0, lamella.start), min(float(lamella.stations[-1]), lamella.end)
