"""Starting meshes on analytic surfaces: a rectangle of parameters becomes a control mesh.

Two layouts, told apart by the parameters they are given in:

* :class:`AsymptoticPatch` - a rectangle in the asymptotic parameters (p, q): every lamella runs
  from edge to edge, the net D1 is a complete rectangular grid.
* :class:`BisectingPatch` - a rectangle in u = (p + q) / 2, v = (p - q) / 2: the control mesh
  follows the bisecting (principal) lines and the lamellas cross it diagonally, as in the paper's
  Fig. 9. It may close into a ring where the surface does.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.errors import SettingError
from gridshell.mesh import ControlMesh, QuadMesh, as_control_mesh, control_mesh, grid_quads
from gridshell.surface import AnalyticSurface

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


Patch = AsymptoticPatch | BisectingPatch | ConjugatePatch


def control_patch(surface: AnalyticSurface, patch: Patch) -> ControlMesh:
    """The control mesh of *patch* on *surface*.

    Raises
    ------
    NotHyperbolicError
        Where the Gaussian curvature is not negative, of layouts along asymptotic directions.
    SettingError
        Where the surface's formula does not reach, or a ring is asked of an open surface.
    """
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
