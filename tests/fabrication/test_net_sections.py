from dataclasses import replace

import numpy as np
import pytest

from fabrication.cut import Edge, Floor, Hole, Relief, Slot
from fabrication.net_sections import net_sections


def slot(x, depth, edge=Edge.UPPER, relief=None):
    plain = Slot(x, 4.0, depth, edge, "N1", "B1")
    return plain if relief is None else replace(plain, relief=relief)


def brute_force(low, high, holes, width, count=400_001):
    """Shares of area, second moment and section modulus, by counting fine layers of the strip."""
    y = (np.arange(count) + 0.5) / count * width
    solid = (y > low) & (y < high)
    for centre, diameter in holes:
        solid &= np.abs(y - centre) > diameter / 2.0
    layer = width / count
    area = solid.sum() * layer
    level = y[solid].mean()
    inertia = ((y[solid] - level) ** 2).sum() * layer
    extreme = max(y[solid].max() - level, level - y[solid].min())
    return area / width, inertia * 12 / width**3, inertia / extreme * 6 / width**2


def test_a_half_lap_leaves_a_half_an_eighth_and_a_quarter(strip):
    x, shares = net_sections(strip("A1", 1000.0, [slot(400.0, 50.0)]))
    assert x.tolist() == [400.0]
    assert shares[:, 0] == pytest.approx([1 / 2, 1 / 8, 1 / 4])


@pytest.mark.parametrize(
    ("relief", "reach"),
    [
        (Relief(Floor.ROUND), 50.0 + 2.0),
        (Relief(Floor.DOGBONE, 0.5), 50.0 + 0.5 * (1.0 - np.sqrt(0.5))),
    ],
)
def test_reliefs_take_from_the_section(strip, relief, reach):
    _, shares = net_sections(strip("A1", 1000.0, [slot(400.0, 50.0, relief=relief)]))
    left = 1.0 - reach / 100.0
    assert shares[:, 0] == pytest.approx([left, left**3, left**2])


def test_two_slots_from_both_edges_count_together_where_they_meet(strip):
    slots = [slot(400.0, 30.0), slot(402.0, 20.0, Edge.LOWER), slot(600.0, 20.0, Edge.LOWER)]
    _, shares = net_sections(strip("A1", 1000.0, slots))
    assert shares[0] == pytest.approx([0.5, 0.5, 0.8])


def test_a_hole_behind_a_slot_is_as_brute_force_finds_it(strip):
    hole = Hole(400.0, 22.0, 9.0, "N1", "bolt M8")
    part = replace(strip("A1", 1000.0, [slot(400.0, 50.5)]), holes=(hole,))
    _, shares = net_sections(part)
    wanted = brute_force(0.0, 49.5, [(22.0, 9.0)], 100.0)
    for column in shares.T:
        assert column == pytest.approx(wanted, rel=1e-4)


def test_a_hole_on_the_middle_costs_little_stiffness(strip):
    part = replace(strip("A1", 1000.0), holes=(Hole(300.0, 50.0, 10.0, "N1", "bolt"),))
    _, shares = net_sections(part)
    assert shares[:, 0] == pytest.approx([0.9, 1 - 0.1**3, 1 - 0.1**3])


def test_slots_that_cut_the_strip_through_leave_nothing(strip):
    slots = [slot(400.0, 60.0), slot(400.0, 60.0, Edge.LOWER)]
    assert net_sections(strip("A1", 1000.0, slots))[1].max() == 0.0


def test_a_strip_without_cuts_has_no_net_section(strip):
    x, shares = net_sections(strip("A1", 1000.0))
    assert (x.shape, shares.shape) == ((0,), (3, 0))
