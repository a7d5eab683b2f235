import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from gridshell.painter import Dots, Faces, Lines, View, bounds, hexadecimal, shaded, svg

SQUARE = np.array([[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]], dtype=float) * 1000.0
RED, BLUE = np.array([[1.0, 0.0, 0.0]]), np.array([[0.0, 0.0, 1.0]])


def drawn(*layers):
    view = View.onto(np.array([0.0, 0.0, 1.0]))
    return svg(layers, view, bounds(layers, view), label="a square")


@pytest.mark.parametrize(
    "normal", [(0, 0, 1), (0, 0, -1), (0, 0, 0), (1, 0, 0), (0, -1, 0), (0.6, 0.0, 0.8)]
)
def test_a_view_is_a_right_handed_frame_with_the_eye_above(normal):
    view = View.onto(np.array(normal, dtype=float))
    np.testing.assert_allclose(view.frame @ view.frame.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(view.frame) == pytest.approx(1.0)
    if normal[2] != 0:
        assert view.frame[2, 2] > 0.0


def test_what_is_nearer_is_drawn_later():
    lower, upper = Faces(SQUARE, RED), Faces(SQUARE + np.array([0.0, 0.0, 500.0]), BLUE)
    for layers in ((lower, upper), (upper, lower)):
        colours = re.findall(r'color="#(..)..(..)"', drawn(*layers))
        assert [colour[1] != "00" for colour in colours] == [False, True]


def test_lines_and_dots_lie_on_their_faces():
    line = Lines(SQUARE[:, :2], BLUE, 1.0)
    dot = Dots(SQUARE[:, 0], RED, 3.0)
    root = ET.fromstring(drawn(dot, line, Faces(SQUARE, RED)))
    kinds = [element.tag.rpartition("}")[2] for element in root[0]]
    assert kinds == ["path", "path", "circle"]
    assert root[0][0].get("d").endswith("Z")
    assert root.get("aria-label") == "a square"


def test_a_face_seen_from_the_side_is_darker():
    view = View.onto(np.array([0.0, 0.0, 1.0]))
    white = np.ones((1, 3))
    upright = np.stack([SQUARE[..., 0], SQUARE[..., 2], SQUARE[..., 1]], axis=-1)
    flat, steep = (shaded(Faces(x, white), view).mean() for x in (SQUARE, upright[..., [1, 0, 2]]))
    assert steep < flat <= 1.0


def test_colours_in_hexadecimal():
    assert hexadecimal(np.array([0.0, 0.5, 1.2])) == "#0080ff"
