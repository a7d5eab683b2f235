"""The Asymptotic Umbrella (Fig. 18): a net of revolution that opens while its edges keep length.

The nodes lie on rings of n, each ring turned by half a step, pi / n, against the one below it. With
c = cos(pi / n) the mirror image of a node's two neighbours on a ring of radius r lies at r c in the
node's own meridian plane. Its star is planar (eq. 7) if and only if the two such points above and
below it and the node itself are collinear there. From two rings the next one follows: a ray from
the node, away from the point below, and on it the place where the edge has its length, a quadratic
equation. With the base ring given, one number is left free: the motion.

Lengths mm, angles radians.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gridshell.arrays import Floats, Mask, Points, frozen
from gridshell.errors import SettingError
from gridshell.mesh import ControlMesh, QuadMesh, as_control_mesh, grid_quads

_SAMPLES = 4001
"""Positions that are tried for the range of the motion before its ends are halved down."""

_HALVINGS = 60


@dataclass(frozen=True)
class Umbrella:
    """The lengths that a motion keeps.

    Parameters
    ----------
    ribs : nodes around each ring, as many as strips of either family.
    radius : of the base ring, mm; it stays.
    bays : length of the edges between each ring and the next, from the base up, mm.

    Raises
    ------
    SettingError
        For fewer than three ribs or two bays, a size that is not positive, or first bays too short
        to reach the neighbours on the base ring.
    """

    ribs: int
    radius: float
    bays: tuple[float, ...]

    def __post_init__(self) -> None:
        if self.ribs < 3:
            raise _bad("ribs", f"{self.ribs}", "at least 3", "12")
        if len(self.bays) < 2:
            raise _bad("bays", f"{len(self.bays)}", "at least 2", "8")
        for key, value in (("radius", self.radius), *(("bays", bay) for bay in self.bays)):
            if not 0.0 < value < np.inf:
                raise _bad(key, f"{value:g} mm", "above 0")
        half = self.radius * np.sin(np.pi / self.ribs)
        if not self.bays[0] > half:
            raise _bad(
                "bays", f"{self.bays[0]:g} mm", f"above {half:g} mm, half a step of the base ring"
            )

    # ---- the recursion -------------------------------------------------------------------------

    def rings(self, first: Floats) -> tuple[Floats, Floats]:
        """Radii and heights (p, m + 1) of all rings, mm, from the base up.

        Parameters
        ----------
        first : (p,) radius of the first ring above the base: the motion's parameter, mm.

        Returns
        -------
        nan from the first ring on that does not exist.
        """
        c, t = np.cos(np.pi / self.ribs), np.tan(np.pi / self.ribs) ** 2
        first = np.asarray(first, dtype=np.float64)
        r = np.full((len(self.bays) + 1, len(first)), np.nan)
        z = np.full_like(r, np.nan)
        r[0], z[0], r[1] = self.radius, 0.0, first
        with np.errstate(invalid="ignore"):
            rise = self.bays[0] ** 2 - first**2 + 2.0 * first * self.radius * c - self.radius**2
            z[1] = np.sqrt(rise)
            for k in range(1, len(self.bays)):
                along, up = r[k] - c * r[k - 1], z[k] - z[k - 1]
                size = np.hypot(along, up)
                along, up = along / size, up / size
                # the next ring's mirror point is s (along, up) away; s^2 + t (r + s along)^2 = l^2
                a, b = 1.0 + t * along**2, t * r[k] * along
                s = (np.sqrt(b * b - a * (t * r[k] ** 2 - self.bays[k] ** 2)) - b) / a
                r[k + 1] = np.where(s > 0.0, (r[k] + s * along) / c, np.nan)
                r[k + 1] = np.where(r[k + 1] >= 0.0, r[k + 1], np.nan)
                z[k + 1] = z[k] + s * up
        lost = np.isnan(r) | np.isnan(z)
        return np.where(lost, np.nan, r).T, np.where(lost, np.nan, z).T

    @cached_property
    def locks(self) -> tuple[Position, Position]:
        """The two positions where the motion locks: the closed one and the opened one.

        Closed, the last ring has shrunk into the axis, or the first edges stand as steeply as they
        can; opened, a bay's two edges have come into one line (its node angle is 180 degrees), or
        the first ring has come down to the base.

        Raises
        ------
        SettingError
            When no position holds all rings.
        """
        c = np.cos(np.pi / self.ribs)
        reach = np.sqrt(self.bays[0] ** 2 - (self.radius * np.sin(np.pi / self.ribs)) ** 2)
        low, high = max(0.0, self.radius * c - reach), self.radius * c + reach
        tried = low + (high - low) * np.linspace(0.0, 1.0, _SAMPLES)
        exists = self._exists(tried)
        if not exists.any():
            raise SettingError(
                "No position of the umbrella holds all of its rings",
                where="bays",
                value=f"{len(self.bays)} bays of {min(self.bays):g} to {max(self.bays):g} mm",
                advice=f"fewer bays than {len(self.bays)}, shorter ones, or more ribs",
            )
        start, stop = _longest_run(exists)
        ends = []
        for inside, outside in ((start, start - 1), (stop, stop + 1)):
            good = tried[inside]
            bad = tried[outside] if 0 <= outside < len(tried) else good
            for _ in range(_HALVINGS):
                middle = (good + bad) / 2.0
                good, bad = (middle, bad) if self._exists(middle[None])[0] else (good, middle)
            ends.append(self._position(float(good)))
        return ends[0], ends[1]

    def node_angles(self, radii: Floats) -> Floats:
        """(p, m) angle between the two edges that rise from a node of each ring, radians.

        Parameters
        ----------
        radii : (p, m + 1) of all rings, mm, as of :meth:`rings`.
        """
        half = radii[..., 1:] * np.sin(np.pi / self.ribs) / np.array(self.bays)
        return np.asarray(2.0 * np.arcsin(np.clip(half, -1.0, 1.0)))

    def _exists(self, first: Floats) -> Mask:
        return np.asarray(np.isfinite(self.rings(first)[0]).all(axis=1))

    def position(self, opening: float) -> Position:
        """The position at *opening*: 0 is the closed lock, 1 the opened one.

        Raises
        ------
        SettingError
            For an opening beyond either lock.
        """
        if not 0.0 <= opening <= 1.0:
            raise SettingError(
                "The umbrella locks before it gets there",
                where="opening",
                value=f"{opening:g}",
                limit="0 (closed) to 1 (opened)",
                advice=f"{min(max(opening, 0.0), 1.0):g}",
            )
        closed, opened = self.locks
        return self._position(closed.first + opening * (opened.first - closed.first))

    def positions(self, count: int) -> tuple[Position, ...]:
        """*count* positions from the closed lock to the opened one, at equal steps of opening."""
        return tuple(self.position(opening) for opening in np.linspace(0.0, 1.0, count).tolist())

    def _position(self, first: float) -> Position:
        r, z = self.rings(np.array([first]))
        return Position(self, frozen(r[0]), frozen(z[0]))

    def at_cable(self, cable: Cable, length: float) -> Position:
        """The position in which *cable* is as long as *length*, mm: the most opened one of them.

        Raises
        ------
        SettingError
            When the umbrella locks before the cable gets that short or that long.
        """
        from scipy.optimize import brentq

        closed, opened = self.locks
        tried = np.linspace(closed.first, opened.first, _SAMPLES)
        found = cable.lengths(*self.rings(tried)) - length
        crossing = np.flatnonzero((found[:-1] > 0.0) != (found[1:] > 0.0))
        if len(crossing) == 0:
            shortest, longest = found.min() + length, found.max() + length
            raise SettingError(
                "The umbrella locks before the cable has that length",
                where="cable",
                value=f"{length:.6g} mm",
                limit=f"{shortest:.6g} to {longest:.6g} mm",
                advice=f"{shortest if length < shortest else longest:.6g} mm",
            )
        k = int(crossing[-1])

        def off(first: float) -> float:
            return float(cable.lengths(*self.rings(np.array([first])))[0]) - length

        return self._position(float(brentq(off, tried[k], tried[k + 1], xtol=1e-12)))

    def dead_point(self, cable: Cable) -> float | None:
        """The opening at which the cable is longest, where that is not the closed lock.

        Nearer to the closed lock a shorter cable closes the umbrella instead of opening it.
        """
        closed, opened = self.locks
        tried = np.linspace(closed.first, opened.first, _SAMPLES)
        k = int(np.argmax(cable.lengths(*self.rings(tried))))
        return None if k == 0 else k / (_SAMPLES - 1)


@dataclass(frozen=True)
class Cable:
    """A vertical cable between two rings, in one meridian plane.

    Parameters
    ----------
    low, high : numbers of the rings, 0 for the base.

    Raises
    ------
    SettingError
        For rings that are not in order, or whose nodes do not lie in the same meridian planes.
    """

    low: int
    high: int

    def __post_init__(self) -> None:
        if not 0 <= self.low < self.high or (self.high - self.low) % 2:
            near = self.low + 2 * max(1, round((self.high - self.low) / 2))
            raise SettingError(
                "A cable joins two nodes above each other",
                where="cable",
                value=f"rings {self.low} and {self.high}",
                limit="the lower ring first, an even number of rings apart",
                advice=f"rings {max(self.low, 0)} and {max(near, max(self.low, 0) + 2)}",
            )

    def lengths(self, radii: Floats, heights: Floats) -> Floats:
        """(p,) lengths at positions with *radii* and *heights* (p, m + 1), mm.

        Raises
        ------
        SettingError
            For a ring that the umbrella does not have.
        """
        last = radii.shape[1] - 1
        if self.high > last:
            raise SettingError(
                "The cable ends above the umbrella",
                where="cable",
                value=f"ring {self.high}",
                limit=f"at most {last}",
                advice=f"ring {last - (last - self.low) % 2}",
            )
        low, high = self.low, self.high
        return np.asarray(
            np.hypot(radii[:, high] - radii[:, low], heights[:, high] - heights[:, low])
        )

    def length(self, position: Position) -> float:
        """Its length in one *position*, mm.

        Raises
        ------
        SettingError
            For a ring that the umbrella does not have.
        """
        return float(self.lengths(position.radii[None], position.heights[None])[0])


@dataclass(frozen=True, eq=False)
class Position:
    """One position of an umbrella.

    Parameters
    ----------
    umbrella : whose.
    radii, heights : (m + 1,) of the rings from the base up, mm.
    """

    umbrella: Umbrella
    radii: Floats
    heights: Floats

    @property
    def first(self) -> float:
        """Radius of the first ring above the base, mm."""
        return float(self.radii[1])

    @property
    def opening(self) -> float:
        """From 0, closed, to 1, opened."""
        closed, opened = self.umbrella.locks
        return (self.first - closed.first) / (opened.first - closed.first)

    @cached_property
    def node_angles(self) -> Floats:
        """(m,) angle between the two edges that rise from a node of each ring, radians."""
        return self.umbrella.node_angles(self.radii)

    @property
    def height(self) -> float:
        """Of the highest ring over the base, mm."""
        return float(self.heights.max())

    def control(self) -> ControlMesh:
        """The control mesh whose D1 is the umbrella; D2 lies between its nodes."""
        n, m = 2 * self.umbrella.ribs, len(self.umbrella.bays)
        i, k = (a.ravel() for a in np.meshgrid(np.arange(n), np.arange(m + 1), indexing="ij"))
        turn = np.pi / self.umbrella.ribs * i
        r, z = self.radii[k], self.heights[k]
        vertices = np.stack([r * np.cos(turn), r * np.sin(turn), z], axis=1)
        mesh = QuadMesh(vertices, grid_quads(n, m, ring=True))
        return as_control_mesh(mesh.moved(_between(mesh, (i + k) % 2 == 1, vertices)))


def _between(mesh: QuadMesh, moved: Mask, vertices: Points) -> Points:
    """Every vertex that is *moved* in the middle of its neighbours along the edges."""
    total = np.zeros_like(vertices)
    count = np.zeros(len(vertices))
    for a, b in (mesh.edges.T, mesh.edges.T[::-1]):
        np.add.at(total, a, vertices[b])
        np.add.at(count, a, 1.0)
    return np.where(moved[:, None], total / count[:, None], vertices)


def _longest_run(flags: Mask) -> tuple[int, int]:
    """First and last index of the longest run of True."""
    edges = np.flatnonzero(np.diff(np.r_[False, flags, False]))
    starts, stops = edges[::2], edges[1::2] - 1
    k = int(np.argmax(stops - starts))
    return int(starts[k]), int(stops[k])


def _bad(key: str, value: str, limit: str, advice: str | None = None) -> SettingError:
    return SettingError(
        "The umbrella cannot be built", where=key, value=value, limit=limit, advice=advice
    )
