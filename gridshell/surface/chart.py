"""Chart: parameters stretched along u and along v so that lengths are nearly those in space."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats
from gridshell.surface.forms import Derivatives, dot

Evaluate = Callable[[Floats, Floats], Derivatives]

_CELLS = 48
"""Cells per parameter in which the metric is measured."""

_FLOOR = 1e-3
"""Least stretch over the mean one: keeps the chart invertible where a side shrinks to a point."""

_GOLDEN = (0.7548776662466927, 0.5698402909980532)  # R2 sequence, M. Roberts 2018


@dataclass(frozen=True, eq=False)
class Chart:
    """Chart coordinates p = (U(u) + shear V(v), width V(v)), each U and V piecewise linear."""

    evaluate: Evaluate
    knots_u: Floats
    knots_v: Floats
    lengths_u: Floats
    lengths_v: Floats
    shear: float
    cell_areas: Floats

    @classmethod
    def of(cls, evaluate: Evaluate, border: Floats) -> Chart:
        """The chart over the box around *border* (k, 2)."""
        low, high = border.min(axis=0), border.max(axis=0)
        knots = [np.linspace(a, b, _CELLS + 1) for a, b in zip(low, high, strict=True)]
        centres = [(k[1:] + k[:-1]) / 2.0 for k in knots]
        u, v = np.meshgrid(*centres, indexing="ij")
        d = evaluate(u.ravel(), v.ravel())
        e, f, g = dot(d.xu, d.xu), dot(d.xu, d.xv), dot(d.xv, d.xv)
        area = np.sqrt(np.maximum(e * g - f * f, 0.0)).reshape(_CELLS, _CELLS)
        shear = float(np.clip(f.sum() / np.sqrt(e.sum() * g.sum()), -0.9, 0.9))
        rates = [
            np.sqrt(e).reshape(_CELLS, _CELLS).mean(axis=1),
            np.sqrt(g).reshape(_CELLS, _CELLS).mean(axis=0),
        ]
        lengths = [
            np.concatenate([[0.0], np.cumsum(np.maximum(r, _FLOOR * r.mean()) * np.diff(k))])
            for r, k in zip(rates, knots, strict=True)
        ]
        cell = (knots[0][1] - knots[0][0]) * (knots[1][1] - knots[1][0])
        return cls(evaluate, knots[0], knots[1], lengths[0], lengths[1], shear, area * cell)

    @property
    def area(self) -> float:
        """Area of the surface over the whole box, mm2."""
        return float(self.cell_areas.sum())

    @property
    def width(self) -> float:
        """What the shear leaves of a length along v."""
        return float(np.sqrt(1.0 - self.shear**2))

    def to_chart(self, parameters: Floats) -> Floats:
        """Chart coordinates (n, 2) of parameters (n, 2)."""
        first = np.interp(parameters[:, 0], self.knots_u, self.lengths_u)
        second = np.interp(parameters[:, 1], self.knots_v, self.lengths_v)
        return np.stack([first + self.shear * second, self.width * second], axis=1)

    def to_parameters(self, points: Floats) -> Floats:
        """Parameters (n, 2) of chart coordinates (n, 2)."""
        second = points[:, 1] / self.width
        first = points[:, 0] - self.shear * second
        return np.stack(
            [
                np.interp(first, self.lengths_u, self.knots_u),
                np.interp(second, self.lengths_v, self.knots_v),
            ],
            axis=1,
        )

    def derivatives(self, points: Floats) -> Derivatives:
        """The surface at chart coordinates (n, 2): x, xu and xv in chart lengths, rest zero."""
        parameters = self.to_parameters(points)
        d = self.evaluate(parameters[:, 0], parameters[:, 1])
        xu = d.xu * _rate(parameters[:, 0], self.knots_u, self.lengths_u)[:, None]
        xv = d.xv * _rate(parameters[:, 1], self.knots_v, self.lengths_v)[:, None]
        none = np.zeros_like(xu)
        return Derivatives(d.x, xu, (xv - self.shear * xu) / self.width, none, none, none)

    def samples(self, count: int) -> Floats:
        """*count* chart points (n, 2), as many per area of the surface everywhere.

        The same points every time: the R2 sequence through the inverse of the area's distribution.
        """
        index = np.arange(1, count + 1)
        first, second = ((0.5 + index * g) % 1.0 for g in _GOLDEN)
        rows = self.cell_areas.sum(axis=1)
        u_share = np.concatenate([[0.0], np.cumsum(rows)]) / rows.sum()
        row = np.clip(np.searchsorted(u_share, first, side="right") - 1, 0, _CELLS - 1)
        u = np.interp(first, u_share, self.knots_u)
        inside = np.cumsum(self.cell_areas, axis=1) / np.maximum(rows, 1e-300)[:, None]
        # one rising sequence over all rows: row i occupies i .. i + 1
        steps = (inside + np.arange(_CELLS)[:, None]).ravel()
        target = second + row
        cell = np.clip(np.searchsorted(steps, target), row * _CELLS, row * _CELLS + _CELLS - 1)
        below = np.where(cell % _CELLS > 0, steps[cell - 1], row)
        rest = (target - below) / np.maximum(steps[cell] - below, 1e-300)
        width = self.knots_v[1] - self.knots_v[0]
        v = self.knots_v[cell % _CELLS] + np.clip(rest, 0.0, 1.0) * width
        return self.to_chart(np.stack([u, v], axis=1))


def _rate(t: Floats, knots: Floats, lengths: Floats) -> Floats:
    """Parameter per chart length at *t* (n,)."""
    cell = np.clip(np.searchsorted(knots, t, side="right") - 1, 0, len(knots) - 2)
    rate: Floats = (np.diff(knots) / np.diff(lengths))[cell]
    return rate
