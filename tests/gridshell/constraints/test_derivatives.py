"""Every constraint's Jacobian against central differences, with its lag held still.

Adding a constraint means adding one line to CONSTRAINTS.
"""

import numpy as np
import pytest

import gridshell as gs
from gridshell import constraints
from gridshell.constraints import (
    AcrossNormal,
    AngleBounds,
    Closeness,
    Coplanarity,
    EdgeLength,
    EqualDiagonals,
    Fairness,
    FieldAngle,
    Glide,
    NodeAngle,
    Proximity,
    Symmetry,
    UnitNormal,
    other_stars,
    planar_faces,
    planar_white_faces,
    regular_stars,
    smooth_curve,
    spherical_stars,
    stars_across_normals,
    white_quads_across_normals,
)

RNG = np.random.default_rng(20)
SOME = np.array([0, 3, 11, 4])
ANGLE, START, TARGET = RNG.uniform(0.5, 2.5, 24), RNG.normal(size=30), RNG.normal(size=(12, 3))
ARC = np.column_stack([np.cos(np.arange(5.0)), np.sin(np.arange(5.0)), np.arange(5.0)])
SPAN = RNG.normal(size=(4, 6))
LENGTHS = RNG.uniform(0.5, 2.0, 100)
PAIRS = np.array([[0, 3], [11, 4], [5, 5]])
"""Coefficients p, q and two rows w over six points."""


def in_order(mesh, count):
    return np.arange(count * (len(mesh.vertices) // count)).reshape(-1, count)


CONSTRAINTS = {
    "node angle": lambda m: NodeAngle(m.quads, ANGLE),
    "node angle, lengths lagged": lambda m: NodeAngle(m.quads, ANGLE, lag_lengths=True),
    "field of node angles": lambda m: FieldAngle(
        m.quads, lambda p: 1.5 + 0.3 * np.sin(p @ [0.5, -0.2, 0.7])
    ),
    "bounds of node angles": lambda m: AngleBounds(m.quads, ANGLE[:24], ANGLE[:24] + 0.3),
    "planar stars of four diagonals": lambda m: regular_stars(gs.diagonal_stars(m)),
    "planar stars of four edges": lambda m: regular_stars(gs.edge_stars(m)),
    "other planar stars of diagonals": lambda m: other_stars(gs.diagonal_stars(m)),
    "other planar stars of edges": lambda m: other_stars(gs.edge_stars(m)),
    "vectors across a normal": lambda m: AcrossNormal(in_order(m, 6), SPAN[:, :5]),
    "planar stars, eq. 7 as printed": lambda m: stars_across_normals(gs.diagonal_stars(m), 0),
    "white quads, eq. 6 as printed": lambda m: white_quads_across_normals(gs.edge_stars(m), 0),
    "planar faces": lambda m: planar_faces(m.quads),
    "planar white faces": lambda m: planar_white_faces(gs.edge_stars(m)),
    "spherical stars": lambda m: spherical_stars(gs.diagonal_stars(m)),
    "equal diagonals": lambda m: EqualDiagonals(m.quads),
    "equal diagonals as printed": lambda m: EqualDiagonals(m.quads, as_printed=True),
    "edge lengths": lambda m: EdgeLength(m.edges, LENGTHS[: len(m.edges)]),
    "symmetry": lambda m: Symmetry(PAIRS, np.array([0.3, -0.2, 1.0]), np.array([0.6, 0.0, 0.8])),
    "coplanarity of six points": lambda m: Coplanarity(in_order(m, 6), *SPAN[:2], SPAN[2:]),
    "unit normals": lambda m: UnitNormal(SOME),
    "fairness": lambda m: Fairness(in_order(m, 3), TARGET),
    "closeness": lambda m: Closeness(START),
    "proximity": lambda m: Proximity(SOME, gs.Torus(4.0, 1.5)),
    "glide, open curve": lambda m: Glide(SOME, smooth_curve(ARC, closed=False)),
    "glide, closed curve": lambda m: Glide(SOME, smooth_curve(ARC, closed=True)),
}


def jacobian(constraint, values, size):
    """(m * rows, size), dense, from an evaluation's (m, rows, k) values."""
    pattern = constraint.pattern()
    dense = np.zeros((len(pattern.columns), pattern.rows, size))
    for k, columns in enumerate(pattern.columns.T):
        dense[np.arange(len(columns)), :, columns] += values[:, :, k]
    return dense.reshape(-1, size)


def differences(constraint, x, lag, step=1e-6):
    """(m * rows, size), central."""
    sides = [
        [constraint.evaluate(x + sign * step * e, lag).residual.ravel() for e in np.eye(len(x))]
        for sign in (1.0, -1.0)
    ]
    return ((np.array(sides[0]) - np.array(sides[1])) / (2.0 * step)).T


@pytest.fixture(params=CONSTRAINTS)
def constraint(request, sectors):
    """Over a disk with a vertex of valence six, corners, boundary and regular stars."""
    return CONSTRAINTS[request.param](sectors(6, 2))


@pytest.fixture(params=[1, 2, 3])
def x(request, sectors):
    size = sectors(6, 2).vertices.size
    return np.random.default_rng(request.param).normal(scale=2.0, size=size)


def test_the_jacobian_is_the_derivative_of_the_residual(constraint, x):
    lag = constraint.lag(x)
    exact = jacobian(constraint, constraint.evaluate(x, lag).values, len(x))
    numeric = differences(constraint, x, lag)
    largest = np.abs(exact).max(axis=1, initial=1.0, keepdims=True)
    np.testing.assert_allclose(exact / largest, numeric / largest, atol=2e-7)


def test_the_shapes_are_those_of_the_pattern(constraint, x):
    pattern = constraint.pattern()
    found = constraint.evaluate(x, constraint.lag(x))
    elements, width = pattern.columns.shape
    assert elements > 0
    assert found.residual.shape == (elements, pattern.rows)
    assert found.values.shape == (elements, pattern.rows, width)


def test_evaluating_changes_nothing(constraint, x):
    before, lag = x.copy(), constraint.lag(x)
    first = constraint.evaluate(x, lag).residual.copy()
    np.testing.assert_array_equal(constraint.evaluate(x, lag).residual, first)
    np.testing.assert_array_equal(x, before)


def test_every_constraint_is_in_the_list(sectors):
    listed = {type(make(sectors(6, 2))) for make in CONSTRAINTS.values()}
    public = {value for value in vars(constraints).values() if hasattr(value, "evaluate")}
    assert listed == public
