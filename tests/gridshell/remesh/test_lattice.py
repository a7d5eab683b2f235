"""Crossings and ports, in exact integers."""

import numpy as np
import pytest
from charts_by_hand import cone, convex, plane, ring, scrambled

from gridshell.remesh.lattice import (
    AXES,
    UNIT,
    ExactChart,
    _lattice_in,
    edge_key,
    ports,
    quarter,
)
from gridshell.surface.triangle_mesh import after

SQUARE = [(0, 0), (5, 0), (5, 4), (0, 4)]


def exact(chart):
    return ExactChart.of(chart.mesh, chart.corners, chart.flips)


def test_quarters_begin_at_the_axes():
    for axis in range(4):
        a, b = AXES[axis], AXES[(axis + 1) % 4]
        assert quarter(a) == axis
        assert quarter(a + b) == axis
        assert quarter(1000 * b + a) == axis


def test_lattice_points_of_boxes():
    rng = np.random.default_rng(0)
    low = rng.integers(-4 * UNIT, 4 * UNIT, size=(50, 2))
    high = low + rng.integers(0, 3 * UNIT, size=(50, 2))
    low[:5] = low[:5] // UNIT * UNIT
    row, at = _lattice_in(low, high)
    found = set(zip(row.tolist(), map(tuple, at.tolist()), strict=True))
    grid = [(i * UNIT, j * UNIT) for i in range(-5, 9) for j in range(-5, 9)]
    expected = {
        (k, p) for k in range(50) for p in grid if (low[k] <= p).all() and (high[k] >= p).all()
    }
    assert found == expected
    assert len(row) == len(expected)


def test_transitions_carry_corners_onto_corners():
    rng = np.random.default_rng(1)
    chart = exact(scrambled(cone(rng, 6, 3), rng))
    inner = np.flatnonzero(chart.mesh.twin >= 0)
    other = chart.mesh.twin[inner]
    moved = chart.flips[inner, None] * chart.flat[inner] + chart.shifts[inner]
    assert (moved == chart.flat[after(other)]).all()
    moved = chart.flips[inner, None] * chart.flat[after(inner)] + chart.shifts[inner]
    assert (moved == chart.flat[other]).all()


@pytest.mark.parametrize("seed", range(8))
def test_crossings_inside_have_a_port_in_every_direction(seed):
    rng = np.random.default_rng(seed)
    found = ports(exact(scrambled(plane(*convex(rng, SQUARE)), rng)))
    count = np.bincount(found.owner, minlength=len(found.face))
    assert len(found.face) == 6 * 5
    assert (count[found.whole] == 4).all()
    rim = np.sort(count[~found.whole])
    assert rim.tolist() == [2] * 4 + [3] * 14
    assert (np.diff(found.owner) >= 0).all()
    assert (np.diff(found.keys) > 0).all()


@pytest.mark.parametrize("valence", [2, 6, 8])
def test_the_centre_of_a_cone_has_as_many_ports_as_its_valence(valence):
    rng = np.random.default_rng(valence)
    found = ports(exact(scrambled(cone(rng, valence, 2), rng)))
    count = np.bincount(found.owner, minlength=len(found.face))
    others = [4] * (np.count_nonzero(found.whole) - 1)
    assert sorted(count[found.whole]) == sorted([valence, *others])


def test_ports_go_round_counter_clockwise():
    rng = np.random.default_rng(5)
    found = ports(exact(plane(*convex(rng, SQUARE))))
    for c in np.flatnonzero(found.whole):
        axes = found.axes[found.owner == c]
        assert ((np.roll(axes, -1) - axes) % 4 == 1).all()


def test_the_name_of_a_point_on_an_edge_is_the_same_from_both_sides():
    rng = np.random.default_rng(2)
    chart = exact(scrambled(ring(rng, 5, 3), rng))
    for h in np.flatnonzero(chart.mesh.twin >= 0):
        along = chart.along(np.array([h]))[0]
        step = int(np.gcd(*np.abs(along)))
        at = chart.flat[h] + along // step * (step // 3)
        there = chart.flips[h] * at + chart.shifts[h]
        twin = chart.mesh.twin[h]
        assert edge_key(chart, np.array([h]), at[None]) == edge_key(
            chart, np.array([twin]), there[None]
        )
