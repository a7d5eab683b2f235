import re
from xml.etree import ElementTree

import numpy as np
import pytest

import fabrication as fab
from fabrication.export.flat_drawing import piece_svg, shape_svg
from fabrication.joints.double_slot import StarWasher
from fabrication.outlines import outline_area
from fabrication.shapes import Shape, circle
from fabrication.sheet_parts import panel_piece, plate_piece, star_piece

SVG = "{http://www.w3.org/2000/svg}"


def area(text, scale):
    """Of the path's straight pieces, mm2."""
    total = 0.0
    path = ElementTree.fromstring(text).find(f"{SVG}path").get("d")
    for ring in path.split("Z")[:-1]:
        points = np.array([p.split()[-2:] for p in re.findall(r"[MLA]([^MLAZ]*)", ring)], float)
        after = np.roll(points, -1, axis=0)
        total += np.sum(points[:, 0] * after[:, 1] - points[:, 1] * after[:, 0]) / 2.0
    return abs(total) / scale**2


def scale_of(length, width):
    return min(440.0 / length, 320.0 / width)


def texts(text):
    return [node.text for node in ElementTree.fromstring(text).iter(f"{SVG}text")]


def test_a_panel_is_drawn_to_scale_with_its_neighbours(leaning):
    for panel in leaning.panels:
        piece = panel_piece(panel)
        drawn = piece_svg(piece)
        scale = scale_of(piece.length, piece.width)
        assert area(drawn, scale) == pytest.approx(panel.area, rel=5e-3)
        assert {panel.mark, *filter(None, panel.neighbours)} <= set(texts(drawn))


def test_size_and_thickness_are_written(leaning):
    for plate in leaning.plates:
        piece = plate_piece(plate)
        size = f"{piece.length:,.1f} × {piece.width:,.1f} × {piece.thickness:.1f} mm"
        assert size.replace(",", "\u202f") in texts(piece_svg(piece))


def test_stars_are_drawn_where_there_are_any(leaning):
    for piece in leaning.pieces[:3]:
        assert piece.mark in texts(piece_svg(star_piece(piece)))


def test_a_washer_has_its_hole():
    outline, hole = StarWasher(4.0, 18.0, 8.0, fab.S235).outline(1.2, 15.0, 9.0)
    drawn = shape_svg(Shape("W1", outline, 0.0, 4.0, (hole,)))
    path = ElementTree.fromstring(drawn).find(f"{SVG}path").get("d")
    assert path.count("Z") == 2
    assert texts(drawn)[-1].endswith("× 4.0 mm")


def test_a_round_shape_is_as_large_as_its_diameter():
    drawn = shape_svg(Shape("bolt", circle(6.0, 100.0, -40.0), 0.0, 30.0))
    assert texts(drawn)[-1] == "12.0 × 12.0 × 30.0 mm"
    assert outline_area(circle(6.0)) == pytest.approx(np.pi * 36.0)


def test_a_hostile_mark_stays_a_text(leaning):
    from dataclasses import replace

    drawn = piece_svg(replace(panel_piece(leaning.panels[0]), mark='</svg><script>"'))
    assert ElementTree.fromstring(drawn).tag == f"{SVG}svg"
