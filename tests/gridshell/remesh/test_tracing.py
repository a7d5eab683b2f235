"""Lines from crossing to crossing."""

import numpy as np
import pytest
from charts_by_hand import cone, convex, plane, ring, scrambled

from gridshell.remesh.lattice import AXES, UNIT, ExactChart, ports
from gridshell.remesh.tracing import trace


def traced(chart):
    exact = ExactChart.of(chart.mesh, chart.corners, chart.flips)
    found = ports(exact)
    return exact, found, trace(exact, found)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("kind", ["plane", "ring", "cone"])
def test_the_way_back_is_the_way_there(seed, kind):
    rng = np.random.default_rng(seed)
    chart = {
        "plane": lambda: plane(*convex(rng, [(0.5, 0), (6.5, 1), (5, 5.25), (0, 4)])),
        "ring": lambda: ring(rng, 5, 3),
        "cone": lambda: cone(rng, 6, 3),
    }[kind]()
    _, found, lines = traced(scrambled(chart, rng))
    there = np.flatnonzero(lines.reverse >= 0)
    assert len(there)
    assert (lines.reverse[lines.reverse[there]] == there).all()
    assert (found.owner[lines.reverse[there]] != found.owner[there]).all()


def test_lines_that_leave_end_on_the_boundary_within_a_cell():
    for seed in range(8):
        rng = np.random.default_rng(seed)
        chart, found, lines = traced(
            scrambled(plane(*convex(rng, [(0.5, 0.25), (6.5, 1), (5, 5.25), (0, 4)])), rng)
        )
        out = np.flatnonzero(lines.exits >= 0)
        assert len(out)
        assert (chart.mesh.twin[lines.exits[out]] < 0).all()
        assert ((lines.reverse[out] >= 0) | (lines.exits[out] >= 0)).all()
        for p in out:
            at, axis = lines.lefts[p, :2], int(lines.lefts[p, 2])
            h = lines.exits[p]
            a = chart.flat[h]
            along = chart.along(np.array([h]))[0]
            d = AXES[axis]
            turn = d[0] * along[1] - d[1] * along[0]
            reach = ((a - at)[0] * along[1] - (a - at)[1] * along[0]) / turn
            assert 0.0 <= reach < UNIT
        inside = found.whole[found.owner]
        assert ((lines.reverse >= 0) | (lines.exits >= 0))[inside].all()


def test_a_line_goes_around_a_ring_and_comes_back():
    rng = np.random.default_rng(0)
    _, found, lines = traced(scrambled(ring(rng, 6, 2), rng))
    around = 0
    for start in range(len(found.owner)):
        port, steps = start, 0
        while True:
            back = int(lines.reverse[port])
            if back < 0 or steps > 6:
                break
            steps += 1
            owner = found.owner[back]
            same = np.flatnonzero(found.owner == owner)
            k = int(np.flatnonzero(same == back)[0])
            if len(same) != 4:
                break
            port = int(same[(k + 2) % 4])
            if port == start:
                around += steps == 6
                break
    assert around == 12  # both ways, from each of the six crossings in the middle
