import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from fabrication.export.interchange.sheeting import divided, lines_across, rim_of, sheeted
from fabrication.flattening import corners
from fabrication.shapes import circle

OUTLINE = np.array(
    [
        *([0.0, 0.0], [30.0, 0.0], [30.0, 40.0], [33.0, 40.0], [33.0, 0.0], [200.0, 0.0]),
        *([196.0, 80.0], [120.0, 80.0], [118.0, 35.0], [116.0, 35.0], [114.0, 80.0], [3.0, 80.0]),
    ]
)
"""A slot from below, a narrowing one from above, and ends at an angle."""

HOLES = [corners(circle(9.0, 60.0, 30.0)), corners(circle(4.0, 150.0, 60.0))]


def polygon(rings):
    return shapely.Polygon(rings[0], rings[1:])


def areas(flat, triangles):
    a, b, c = np.moveaxis(flat[triangles], 1, 0)
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    return (ux * vy - uy * vx) / 2.0


def check(rings, lines):
    flat, triangles = sheeted(rings, lines)
    found = areas(flat, triangles)
    assert (found > 0.0).all()
    assert found.sum() == pytest.approx(polygon(rings).area, rel=1e-12)
    x = flat[triangles][:, :, 0]
    for line in lines:
        assert not ((x.min(axis=1) < line) & (x.max(axis=1) > line)).any()
    given_corners = {tuple(corner) for ring in rings for corner in ring.tolist()}
    assert given_corners <= {tuple(corner) for corner in flat.tolist()}
    rim = rim_of(triangles)
    assert sorted(rim[:, 0].tolist()) == sorted(rim[:, 1].tolist())  # closed rings
    length = np.linalg.norm(flat[rim[:, 0]] - flat[rim[:, 1]], axis=1).sum()
    assert length == pytest.approx(polygon(rings).length, rel=1e-12)
    return flat, triangles


def test_an_outline_with_slots_and_holes_is_covered_once():
    rings = [OUTLINE, *(hole[::-1] for hole in HOLES)]
    check(rings, lines_across(rings, np.linspace(4.0, 195.0, 40)))


def test_either_sense_of_a_hole_will_do():
    for holes in (HOLES, [hole[::-1] for hole in HOLES]):
        check([OUTLINE, *holes], np.array([58.1, 61.7, 100.3]))


def test_without_lines_it_is_one_piece():
    check([OUTLINE, *HOLES], np.zeros(0))


def test_a_rectangle_has_two_triangles_a_band():
    rectangle = np.array([[0.0, 0.0], [100.0, 0.0], [100.0, 10.0], [0.0, 10.0]])
    flat, triangles = check([rectangle], np.linspace(10.0, 90.0, 9))
    assert (len(flat), len(triangles)) == (22, 20)


def test_lines_keep_clear_of_corners():
    wanted = np.array([29.9999, 30.5, 33.0, 60.0, 114.0005, 150.2])
    found = lines_across([OUTLINE], wanted)
    assert found.tolist() == [30.5, 60.0, 150.2]


def test_crossings_lie_just_on_their_lines_from_either_side():
    lines = np.array([31.3, 115.1])
    forward, backward = divided(OUTLINE, lines), divided(OUTLINE[::-1], lines)
    assert {x for x in forward[:, 0] if x in lines} == set(lines)
    assert {tuple(c) for c in forward.round(9)} == {tuple(c) for c in backward.round(9)}


@given(
    st.lists(st.floats(0.05, 0.95), min_size=1, max_size=5),
    st.lists(st.floats(0.01, 0.99), max_size=30),
    st.floats(1.0, 14.0),
)
def test_any_holes_and_lines(places, shares, radius):
    x = np.unique(np.round(np.array(places) * 20.0)) * 40.0 + 20.0
    outline = np.array([[0.0, 0.0], [840.0, 0.0], [840.0, 40.0], [0.0, 40.0]])
    rings = [outline, *(corners(circle(radius, at, 20.0)) for at in x.tolist())]
    check(rings, lines_across(rings, np.unique(np.array(shares)) * 840.0))
