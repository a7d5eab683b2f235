import numpy as np
import pytest
from shapely.geometry import Point, Polygon

from fabrication.shapes import Shape, circle
from fabrication.sheet_parts import _turned, panel_piece, plate_piece, shape_piece


def sides(outline):
    return np.linalg.norm(np.roll(outline, -1, axis=0) - outline, axis=1)


def test_a_piece_lies_in_its_box_with_its_longer_side_along_the_sheet(leaning):
    for panel in leaning.panels:
        piece = panel_piece(panel)
        assert piece.outline.min(axis=0) == pytest.approx([0.0, 0.0], abs=1e-9)
        assert piece.outline.max(axis=0) == pytest.approx([piece.length, piece.width])
        assert piece.length >= piece.width
        assert piece.area == pytest.approx(panel.area)


def test_a_piece_has_the_panel_s_sides_in_their_order(leaning):
    panel = leaning.panels[4]
    piece = panel_piece(panel)
    sides = [
        np.linalg.norm(np.roll(o, -1, axis=0) - o, axis=1) for o in (panel.outline, piece.outline)
    ]
    assert sides[0] == pytest.approx(sides[1])


def test_no_box_is_smaller(leaning):
    for panel in leaning.panels:
        outline = panel.outline
        smallest = Polygon(outline).minimum_rotated_rectangle.area
        piece = panel_piece(panel)
        assert piece.length * piece.width == pytest.approx(smallest, rel=1e-9)


def test_every_label_lies_within_the_piece(leaning):
    for piece in [*map(panel_piece, leaning.panels), *map(plate_piece, leaning.plates)]:
        inside = Polygon(piece.outline)
        for label in piece.labels:
            half = 0.45 * label.height * len(label.text)
            along = np.array([np.cos(label.angle), np.sin(label.angle)]) * half
            for side in (-1.0, 0.0, 1.0):
                assert inside.contains(Point(np.array([label.x, label.y]) + side * along))


def test_the_neighbours_stand_along_their_sides(leaning):
    panel = leaning.panels[4]
    texts = [label.text for label in panel_piece(panel).labels]
    assert texts == [panel.mark, *(mark for mark in panel.neighbours if mark)]


def test_the_nodes_stand_at_their_ends(leaning):
    plate = leaning.plates[3]
    own, end, start = plate_piece(plate).labels
    assert own.text == "S4"
    assert (start.text, end.text) == tuple(f"N{node + 1}" for node in plate.nodes)


def test_text_is_never_upside_down(leaning):
    for panel in leaning.panels:
        for label in panel_piece(panel).labels:
            assert -np.pi / 2 < label.angle <= np.pi / 2 + 1e-9


def test_a_rectangle_that_stands_is_laid_down():
    flat = _turned(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 5.0], [0.0, 5.0]]))
    assert flat.max(axis=0) == pytest.approx([5.0, 1.0])


# ---- connectors that are cut from sheet ---------------------------------------------------------


def test_a_washer_lies_in_its_box_with_its_hole_where_it_was():
    outline = np.array([[30, -9, 0], [30, 9, 0], [-20, 9, 0], [-20, -9, 0]], dtype=float)
    shape = Shape("W1", outline, 0.0, 4.0, (circle(4.5, 5.0, 0.0),))
    piece = shape_piece("N7-top", shape)
    assert (piece.length, piece.width, piece.thickness) == (50.0, 18.0, 4.0)
    assert piece.circles.tolist() == [[25.0, 9.0, 9.0]]
    assert piece.area * 4.0 == pytest.approx(shape.volume)
    assert piece.outline.shape == (4, 2)


def test_a_round_plate_has_the_box_of_its_circle():
    piece = shape_piece("R1", Shape("R1", circle(20.0, 3.0, -4.0), 0.0, 2.0))
    assert (piece.length, piece.width) == pytest.approx((40.0, 40.0))
    assert piece.area == pytest.approx(np.pi * 400.0)
    (label,) = piece.labels
    assert (label.text, label.x, label.y) == ("R1", pytest.approx(20.0), pytest.approx(20.0))
