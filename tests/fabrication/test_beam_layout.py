from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely.geometry import Polygon
from shapely.ops import unary_union

import fabrication as fab
import gridshell as gs

SECTION = fab.BeamSection(width=60.0, height=120.0)


def star(angles, slope=0.0):
    turn = np.asarray(angles)
    arms = 1000.0 * np.stack(
        [np.cos(turn), np.sin(turn), np.full_like(turn, np.tan(slope))], axis=1
    )
    k = len(turn)
    faces = np.array([[0, i + 1, (i + 1) % k + 1] for i in range(k)])
    return gs.panel_mesh(
        np.vstack([[0.0, 0.0, 0.0], arms]), faces, np.tile([0.0, 0.0, 1.0], (k + 1, 1))
    )


def test_mitres_are_half_the_angles_to_the_neighbours():
    made = fab.beams(star([0.0, 1.0, 2.6, 4.4]), SECTION)
    # edges 0-1, 0-2, 0-3, 0-4 come first: all start at node 0
    starts = [beam.start for beam in made[:4]]
    assert [end.left for end in starts] == pytest.approx([0.5, 0.8, 0.9, np.pi - 2.2], abs=1e-12)
    assert [end.right for end in starts] == pytest.approx([np.pi - 2.2, 0.5, 0.8, 0.9], abs=1e-12)


@given(st.lists(st.floats(0.75, 1.0), min_size=3, max_size=6))
def test_flat_beams_meet_in_their_mitres_without_gap_or_overlap(shares):
    angles = 2.0 * np.pi * np.cumsum(shares) / sum(shares)
    made = fab.beams(star(angles), fab.BeamSection(40.0, 100.0))[: len(shares)]
    pieces = [Polygon(beam.frame.place(beam.plan)[:, :2]) for beam in made]
    assert all(piece.is_valid for piece in pieces)
    whole = unary_union(pieces)
    assert sum(piece.area for piece in pieces) == pytest.approx(whole.area, rel=1e-9)
    # the node lies inside: nothing is left open between the mitres
    assert whole.buffer(1e-6).contains(Polygon([(-1, -1), (1, -1), (0, 1)]))


def test_the_rim_is_cut_square():
    triangle = gs.panel_mesh(
        np.array([[0.0, 0, 0], [1000, 0, 0], [500, 800, 0]]),
        np.array([[0, 1, 2]]),
        np.tile([0.0, 0, 1], (3, 1)),
    )
    first = fab.beams(triangle, SECTION)[0]
    corner = np.arctan2(800.0, 500.0)
    assert first.start.left == pytest.approx(corner / 2.0)
    assert first.start.right is None
    assert first.end.left is None
    assert first.end.right == pytest.approx(corner / 2.0)
    back = 30.0 / np.tan(corner / 2.0)
    assert first.plan.tolist() == pytest.approx(
        np.array([[0, -30], [1000, -30], [1000, 0], [1000 - back, 30], [back, 30], [0, 0]])
    )
    assert first.cut_length == pytest.approx(1000.0)


def test_a_slope_is_measured_from_the_plane_across_the_axis():
    made = fab.beams(star([0.0, 2.0, 4.0], slope=-0.2), SECTION)[0]
    assert made.start.slope == pytest.approx(-0.2)
    assert made.end.slope == pytest.approx(0.2)
    assert made.length == pytest.approx(1000.0 / np.cos(0.2))
    assert made.start.roll == pytest.approx(0.0, abs=1e-12)


@given(st.floats(-0.4, 0.4))
def test_a_twisted_edge_rolls_by_half_to_either_end(twist):
    half = twist / 2.0
    points = np.array([[0.0, 0, 0], [1000, 0, 0], [500, 800, 0]])
    axes = np.array(
        [[0, np.sin(half), np.cos(half)], [0, -np.sin(half), np.cos(half)], [0, 0, 1.0]]
    )
    beam = fab.beams(gs.panel_mesh(points, np.array([[0, 1, 2]]), axes), SECTION)[0]
    # seen away from either node the upright is turned from that node's axis by the same half
    assert beam.start.roll == pytest.approx(half, abs=1e-12)
    assert beam.end.roll == pytest.approx(half, abs=1e-12)


def test_mitres_of_a_dome_lie_on_planes_through_the_axes(principal_dome):
    mesh = gs.skin(principal_dome, gs.Skin.D1)
    made = fab.beams(mesh, SECTION)
    rolls = [abs(end.roll) for beam in made for end in (beam.start, beam.end)]
    assert max(rolls) < 1e-3
    inner = [b for b in made if not mesh.boundary[[b.start.node, b.end.node]].any()]
    assert len(inner) > 1000
    for beam in inner[::20]:
        corner = beam.frame.place(beam.plan)[4]
        node, axis = mesh.vertices[beam.start.node], mesh.axes[beam.start.node]
        away = corner - node
        level = away - (away @ axis) * axis
        along = beam.frame.x - (beam.frame.x @ axis) * axis
        cosine = level @ along / np.linalg.norm(level) / np.linalg.norm(along)
        assert np.arccos(cosine) == pytest.approx(beam.start.left, abs=1e-9)


def test_a_setback_cuts_square_and_shortens():
    made = fab.beams(star([0.0, 2.0, 4.0]), replace(SECTION, setback=80.0))[0]
    assert made.cut_length == pytest.approx(840.0)
    assert made.plan.tolist() == [[80.0, -30.0], [920.0, -30.0], [920.0, 30.0], [80.0, 30.0]]


@given(st.floats(500.0, 1e5))
def test_a_setback_too_large_is_refused_with_the_beam_s_name(setback):
    with pytest.raises(gs.SettingError, match="beam B1"):
        fab.beams(star([0.0, 2.0, 4.0]), replace(SECTION, setback=setback))


@given(st.floats(3000.0, 1e6))
def test_a_beam_wider_than_its_mitres_allow_is_refused(width):
    with pytest.raises(gs.SettingError, match="beam B1"):
        fab.beams(star([0.0, 2.0, 4.0]), replace(SECTION, width=width))


def test_beams_that_lie_on_each_other_are_refused():
    flat = gs.panel_mesh(
        np.array([[0.0, 0, 0], [1000, 0, 0], [2000, 0, 0]]),
        np.array([[0, 1, 2]]),
        np.tile([0.0, 0, 1], (3, 1)),
    )
    with pytest.raises(gs.SettingError, match="beam B1"):
        fab.beams(flat, SECTION)


@pytest.mark.parametrize("change", [{"width": 0.0}, {"height": np.nan}, {"setback": -1.0}])
def test_bad_settings_are_refused_by_name(change):
    with pytest.raises(gs.SettingError, match=next(iter(change))):
        replace(SECTION, **change)
