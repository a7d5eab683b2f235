"""Starting meshes on analytic surfaces: a rectangle of parameters becomes a control mesh.

Layouts, told apart by the parameters they are given in:

* :class:`AsymptoticPatch` - a rectangle in the asymptotic parameters (p, q): every lamella runs
  from edge to edge, the net D1 is a complete rectangular grid.
* :class:`BisectingPatch` - a rectangle in u = (p + q) / 2, v = (p - q) / 2: the control mesh
  follows the bisecting (principal) lines and the lamellas cross it diagonally, as in the paper's
  Fig. 9. It may close into a ring where the surface does.
* :class:`ConjugatePatch` - panels along u and v, for nets of planar quads.
* :class:`SingularPatch` - sectors around a central singularity of even valence, as in Fig. 13.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Indices
from gridshell.errors import SettingError
from gridshell.mesh import ControlMesh, QuadMesh, as_control_mesh, control_mesh, grid_quads
from gridshell.surface import AnalyticSurface, Enneper

Range = tuple[float, float]


@dataclass(frozen=True)
class AsymptoticPatch:
    """Lamellas at equal steps of the asymptotic parameters.

    Parameters
    ----------
    p, q : first and last value of each parameter.
    lamellas : lamellas of family 1 (along p, spread over q) and of family 2, at least 2 each.

    Raises
    ------
    SettingError
        For an empty range or fewer than two lamellas.
    """

    p: Range
    q: Range
    lamellas: tuple[int, int]

    def __post_init__(self) -> None:
        _check_range("p", self.p)
        _check_range("q", self.q)
        _check_counts("lamellas", self.lamellas, 2)


@dataclass(frozen=True)
class BisectingPatch:
    """Control quads at one step in both bisecting parameters.

    The diagonals follow the asymptotic lines only where both steps are equal, so the number of
    quads across follows from the number along, and the range of v is widened or narrowed evenly
    on both sides to a whole number of steps.

    Parameters
    ----------
    v : first and last value across.
    cells : control quads along u.
    u : first and last value along; None closes the ring over a full turn.

    Raises
    ------
    SettingError
        For an empty range, fewer than two cells, or an odd number of cells around a ring.
    """

    v: Range
    cells: int
    u: Range | None = None

    def __post_init__(self) -> None:
        if self.u is not None:
            _check_range("u", self.u)
        _check_range("v", self.v)
        _check_counts("cells", (self.cells,), 2)
        if self.u is None and (self.cells % 2 or self.cells < 4):
            raise SettingError(
                "A ring needs an even number of cells around it, or D1 and D2 run into each other",
                where="cells",
                value=f"{self.cells}",
                limit="even, at least 4",
                advice=f"{max(4, self.cells + self.cells % 2)} cells",
            )


@dataclass(frozen=True)
class ConjugatePatch:
    """Panels along the parameters u and v, for nets of planar quads.

    The lines of u and v are conjugate on every surface of this package: they bisect the asymptotic
    parameters, and on surfaces of revolution they are the principal lines.

    Parameters
    ----------
    v : first and last value across.
    panels : of D1 along u and across.
    u : first and last value along; None closes the ring over a full turn.

    Raises
    ------
    SettingError
        For an empty range, fewer than two panels, or fewer than three around a ring.
    """

    v: Range
    panels: tuple[int, int]
    u: Range | None = None

    def __post_init__(self) -> None:
        if self.u is not None:
            _check_range("u", self.u)
        _check_range("v", self.v)
        _check_counts("panels", self.panels, 2)
        if self.u is None:
            _check_counts("panels", self.panels[:1], 3)


@dataclass(frozen=True)
class SingularPatch:
    """Sectors of control quads around a central singularity (Fig. 13), on Enneper's surfaces.

    Enneper's surface of order k (Gauss map z^k) has a flat point of valence 2 k + 2 in its centre;
    the control mesh follows its principal lines, which are the parallels of w = z^((k + 1) / 2).

    Parameters
    ----------
    valence : of the central vertex, even: 4 is the regular net, 6 that of the paper.
    cells : control quads along a sector, either way.
    reach : |z| where the rays between the sectors end; 1 is where the surface stands upright.
    cut : quads in a row that are cut off diagonally at the outer corner of every sector; 1 takes
        the corner quad.

    Raises
    ------
    SettingError
        For an odd valence or one below 4, fewer than two cells, a reach that is not positive or
        beyond which the surface cuts through itself, or a cut that leaves no quads.
    """

    valence: int
    cells: int
    reach: float
    cut: int = 0

    def __post_init__(self) -> None:
        if self.valence % 2 or self.valence < 4:
            raise SettingError(
                "Families of diagonals continue around a vertex of even valence only (Fig. 4)",
                where="valence",
                value=f"{self.valence}",
                limit="even, at least 4",
                advice=f"{max(4, self.valence + self.valence % 2)}",
            )
        _check_counts("cells", (self.cells,), 2)
        furthest = farthest_reach(self.valence)
        if not 0.0 < self.reach < furthest:
            raise SettingError(
                "The patch has no room on the surface",
                where="reach",
                value=f"{self.reach:g}",
                limit=f"above 0 and below {furthest:.4g}, where the surface cuts through itself",
                advice=f"{0.7 * furthest:.2g}",
            )
        if not 0 <= self.cut < self.cells:
            raise SettingError(
                "The cut takes more than the corners",
                where="cut",
                value=f"{self.cut}",
                limit=f"0 .. {self.cells - 1}",
            )


Patch = AsymptoticPatch | BisectingPatch | ConjugatePatch | SingularPatch


def control_patch(surface: AnalyticSurface, patch: Patch) -> ControlMesh:
    """The control mesh of *patch* on *surface*.

    Raises
    ------
    NotHyperbolicError
        Where the Gaussian curvature is not negative, of layouts along asymptotic directions.
    SettingError
        Where the surface's formula does not reach, or a ring is asked of an open surface, or a
        central singularity of a surface that has none.
    """
    if isinstance(patch, SingularPatch):
        return _singular(surface, patch)
    if isinstance(patch, AsymptoticPatch):
        return _asymptotic(surface, patch)
    if isinstance(patch, ConjugatePatch):
        return _conjugate(surface, patch)
    return _bisecting(surface, patch)


def _asymptotic(surface: AnalyticSurface, patch: AsymptoticPatch) -> ControlMesh:
    """M has two steps per bay and half a bay of rim; D1 sits on its odd positions."""
    across_q, across_p = patch.lamellas
    p, q = np.meshgrid(
        _half_steps(patch.p, across_p), _half_steps(patch.q, across_q), indexing="ij"
    )
    u, v = (p + q) / 2.0, (p - q) / 2.0
    vertices = _vertices(surface, u, v)
    # u to the right and v up are ccw for the normal xu x xv; (p, q) turns the other way
    quads = grid_quads(2 * across_p, 2 * across_q)[:, ::-1]
    # the first quad's first diagonal runs along j, which is q
    return control_mesh(QuadMesh(vertices, quads)).families_exchanged()


def _bisecting(surface: AnalyticSurface, patch: BisectingPatch) -> ControlMesh:
    ring = patch.u is None
    first, last = patch.u if patch.u is not None else (0.0, _full_turn(surface))
    step = (last - first) / patch.cells
    across = max(2, round((patch.v[1] - patch.v[0]) / step))
    middle = (patch.v[0] + patch.v[1]) / 2.0
    u_line = first + step * np.arange(patch.cells + (not ring))
    v_line = middle + step * (np.arange(across + 1) - across / 2.0)
    u, v = np.meshgrid(u_line, v_line, indexing="ij")
    vertices = _vertices(surface, u, v)
    return as_control_mesh(QuadMesh(vertices, grid_quads(patch.cells, across, ring=ring)))


def _conjugate(surface: AnalyticSurface, patch: ConjugatePatch) -> ControlMesh:
    """M has two steps per panel and half a panel of rim, but none around a ring."""
    ring, (along, across) = patch.u is None, patch.panels
    if patch.u is None:
        u_line = _full_turn(surface) * np.arange(2 * along) / (2 * along)
    else:
        u_line = _half_steps(patch.u, along + 1)
    u, v = np.meshgrid(u_line, _half_steps(patch.v, across + 1), indexing="ij")
    surface.check(u.ravel(), v.ravel())
    vertices = surface.point(u.ravel(), v.ravel())
    quads = grid_quads(len(u_line) - (not ring), 2 * (across + 1), ring=ring)
    return control_mesh(QuadMesh(vertices, quads))


def farthest_reach(valence: int) -> float:
    """|z| at which Enneper's surface of that valence meets itself in its axis: (2 k + 1)^(1 / 2 k).

    On the circle |z| = r the points nearest to the axis lie at the distance r - r^(2 k + 1) /
    (2 k + 1) from it, all at one height.
    """
    twice = valence - 1  # 2 k + 1
    return float(twice ** (1.0 / (twice - 1)))


def _singular(surface: AnalyticSurface, patch: SingularPatch) -> ControlMesh:
    """Vertices by sector; the ray between two sectors belongs to the second one."""
    if not isinstance(surface, Enneper):
        raise SettingError(
            "This surface has no family with a central singularity",
            where="layout",
            value=f"'singular' on {type(surface).__name__}",
            limit="Enneper's surface",
            advice="kind = 'enneper', or remesh a surface that has such a point",
        )
    n, sectors = patch.cells, patch.valence
    s, i, j = (
        a.ravel()
        for a in np.meshgrid(np.arange(sectors), np.arange(n), np.arange(n), indexing="ij")
    )

    def number(i: Indices, j: Indices) -> Indices:
        ray, along, across = np.where(i == 0, (s + 1) % sectors, s), np.where(i == 0, j, i), j
        across = np.where(i == 0, 0, across)
        at = 1 + ray * n * (n + 1) + (along - 1) * (n + 1) + across
        return np.where((i == 0) & (j == 0), 0, at)

    quads = np.stack([number(i + a, j + b) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))], axis=1)
    quads = quads[i + j <= 2 * (n - 1) - patch.cut]
    along, across = np.meshgrid(np.arange(1, n + 1), np.arange(n + 1), indexing="ij")
    corner = (along + 1j * across).ravel() / n
    turns = np.pi / 2.0 * np.arange(sectors)[:, None]
    size, turn = np.abs(corner), np.angle(corner) + turns
    power = 4.0 / sectors  # z = w^(2 / (k + 1)) with k + 1 = sectors / 2
    z = patch.reach * (size**power * np.exp(1j * power * turn)).ravel()
    vertices = _enneper_of_order(np.r_[0.0, z], sectors // 2 - 1, surface.scale)
    used, compact = np.unique(quads, return_inverse=True)
    return as_control_mesh(QuadMesh(vertices[used], compact.reshape(-1, 4)))


def _enneper_of_order(z: np.ndarray, order: int, scale: float) -> np.ndarray:
    """Weierstrass' formula with f = 1 and g = z^order; for order 1 the surface of the package."""
    high = z ** (2 * order + 1) / (2 * order + 1)
    middle = 2.0 * z ** (order + 1) / (order + 1)
    parts = [(z - high).real, -(z + high).imag, middle.real]
    return scale * np.stack(parts, axis=1)


def _full_turn(surface: AnalyticSurface) -> float:
    if surface.period_u is None:
        raise SettingError(
            "This surface does not close into a ring",
            where="u",
            value=type(surface).__name__,
            advice="give u = [first, last], or use a surface of revolution",
        )
    return surface.period_u


def _vertices(surface: AnalyticSurface, u: np.ndarray, v: np.ndarray) -> np.ndarray:
    u, v = u.ravel(), v.ravel()
    surface.check(u, v)
    surface.require_hyperbolic(u, v)
    return surface.point(u, v)


def _half_steps(limits: Range, nodes: int) -> np.ndarray:
    bay = (limits[1] - limits[0]) / (nodes - 1)
    return limits[0] + bay * (np.arange(2 * nodes + 1) - 1) / 2.0


def _check_range(key: str, limits: Range) -> None:
    if not (np.isfinite(limits).all() and limits[0] < limits[1]):
        raise SettingError(
            "A range needs two numbers, the smaller first", where=key, value=str(list(limits))
        )


def _check_counts(key: str, counts: tuple[int, ...], least: int) -> None:
    for count in counts:
        if count < least:
            raise SettingError("Too few", where=key, value=str(list(counts)), limit=f">= {least}")
