"""Outlines with arcs as outlines of short lines, for checks that know only lines."""

from __future__ import annotations

import numpy as np

from gridshell.arrays import Floats

SAGITTA = 0.01
"""Between an arc and its lines, mm; more only where an arc would take over 300 of them."""


def flattened(rows: Floats, *, closed: bool, step: float | None = None) -> Floats:
    """(n, 2) points of a line with bulges (k, 3); closed ones begin again with the first.

    Parameters
    ----------
    step : largest turn of an arc between two points, radians, in place of the usual sagitta.
    """
    if closed and len(rows):
        rows = np.concatenate([rows, rows[:1]])
    if not rows[:-1, 2].any():
        return rows[:, :2]
    with np.errstate(all="ignore"):
        return _with_arcs(rows, step)


def _with_arcs(rows: Floats, step: float | None) -> Floats:
    """(n, 2) points of an open line (k, 3); not finite where its numbers are absurd."""
    bulge, start = rows[:-1, 2], rows[:-1, :2]
    chord = np.diff(rows[:, :2], axis=0)
    length = np.hypot(*chord.T)
    sweep = 4.0 * np.arctan(bulge)
    curved = (np.abs(sweep) > 0.0) & (length > 0.0)
    radius = np.where(curved, length / (2.0 * np.abs(np.sin(sweep / 2.0)) + 1e-300), 1.0)
    fine = 2.0 * np.arccos(np.clip(1.0 - SAGITTA / radius, -1.0, 1.0))
    turn = np.maximum(fine, 0.02) if step is None else step
    count = np.where(curved, np.ceil(np.abs(sweep) / turn), 1).astype(int)
    first = np.repeat(np.arange(len(count)), count)
    place = np.arange(len(first)) - np.repeat(np.cumsum(count) - count, count)
    share = place / count[first]
    turned = np.where(curved, sweep, 0.0)[first]
    return np.concatenate([_on_arc(start[first], chord[first], turned, share), rows[-1:, :2]])


def _on_arc(start: Floats, chord: Floats, sweep: Floats, share: Floats) -> Floats:
    """(n, 2) points at *share* of arcs with a chord and a sweep; on the chord where it is 0."""
    half = sweep / 2.0
    straight = np.abs(half) < 1e-12
    safe = np.where(straight, 1.0, np.sin(half))
    reach = np.where(straight, share, np.sin(share * half) / safe)
    turn = np.where(straight, 0.0, (share - 1.0) * half)
    c, s = np.cos(turn), np.sin(turn)
    x, y = chord.T
    return np.asarray(start + reach[:, None] * np.stack([c * x - s * y, s * x + c * y], axis=1))


def corners(outline: Floats, step: float | None = None) -> Floats:
    """(n, 2) corners of a closed outline (k, 2), or (k, 3) with bulges: arcs as short lines."""
    return outline if outline.shape[1] == 2 else flattened(outline, closed=True, step=step)[:-1]
