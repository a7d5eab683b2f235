from math import ceil, pi, sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fabrication.bolts import FLATS, FREE, HEAD, NUT, bolt_bodies, bolt_length
from fabrication.outlines import Frame, outline_area


@given(st.floats(1.0, 500.0), st.sampled_from([5.0, 6.0, 8.0, 10.0, 12.0, 16.0]))
def test_a_bolt_is_the_shortest_that_takes_its_nut_with_free_thread(grip, diameter):
    length = bolt_length(grip, diameter)
    needed = grip + NUT * diameter + FREE * diameter
    assert length % 5.0 == 0.0
    assert length >= needed - 1e-6
    assert length - 5.0 < needed
    assert length == pytest.approx(5.0 * ceil(needed / 5.0 - 1e-6), abs=5.0)


def placed():
    frames = [
        Frame(np.array([100.0 * i, 0.0, 10.0]), np.array([1.0, 0, 0]), np.array([0, 1.0, 0]))
        for i in range(3)
    ]
    grips = np.array([100.0, 108.0, 100.2])
    lengths = [bolt_length(float(g), 8.0) for g in grips]
    return grips, lengths, bolt_bodies(["N1", "N2", "N3"], frames, grips, lengths, 8.0)


def test_equal_lengths_share_a_shape_and_heads_and_nuts_are_two_shapes():
    _, lengths, (bolts, ends) = placed()
    assert len(bolts.shapes) == len(set(lengths)) == 2
    assert [bolts.shapes[body.shape].low for body in bolts.bodies] == [-size for size in lengths]
    assert [body.mark for body in bolts.bodies] == ["N1-bolt", "N2-bolt", "N3-bolt"]
    assert len(ends.shapes) == 2
    assert len(ends.bodies) == 6


def test_the_nut_sits_under_the_grip_and_leaves_thread():
    grips, lengths, (bolts, ends) = placed()
    for grip, length, bolt, nut in zip(
        grips, lengths, bolts.bodies, ends.bodies[1::2], strict=True
    ):
        below = (bolt.frame.origin - nut.frame.origin) @ bolt.frame.normal
        assert below == pytest.approx(grip)
        assert length - below - NUT * 8.0 >= FREE * 8.0 - 1e-9


def test_heads_and_nuts_are_hexagons_and_nuts_hold_the_shank():
    _, _, (bolts, ends) = placed()
    head, nut = ends.shapes
    flats = FLATS * 8.0
    assert head.volume == pytest.approx(sqrt(3.0) / 2.0 * flats**2 * HEAD * 8.0)
    assert nut.volume == pytest.approx((sqrt(3.0) / 2.0 * flats**2 - pi * 16.0) * NUT * 8.0)
    assert outline_area(bolts.shapes[0].outline) == pytest.approx(pi * 16.0)


def test_no_places_are_no_bolts():
    bolts, ends = bolt_bodies([], [], np.zeros(0), [], 8.0)
    assert (bolts.shapes, bolts.bodies, ends.shapes, ends.bodies) == ((), (), (), ())
