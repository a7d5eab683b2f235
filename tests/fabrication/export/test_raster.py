import numpy as np
import pytest
from PIL import Image

from fabrication.errors import OutputError
from fabrication.export.raster import Scene, write_png
from gridshell.painter import Dots, Faces, Lines, View

VIEW = View(np.eye(3))
RED, BLUE = np.array([[1.0, 0.0, 0.0]]), np.array([[0.0, 0.0, 1.0]])


def square(z, size=1.0):
    corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]) * size
    return (corners + np.array([0.0, 0.0, z]))[None]


def pixel(path, x, y):
    with Image.open(path) as image:
        return image.convert("RGB").getpixel((x, y))


def test_the_nearer_face_covers_the_farther_one(tmp_path):
    layers = (Faces(square(1.0, 0.5), BLUE), Faces(square(0.0), RED))
    write_png(tmp_path / "p.png", [Scene("", layers, VIEW)], cell=(200, 226))
    middle, beside = pixel(tmp_path / "p.png", 100, 126), pixel(tmp_path / "p.png", 30, 126)
    assert middle[2] > 150
    assert middle[0] < 20
    assert beside[0] > 150
    assert beside[2] < 20


def test_scenes_lie_in_rows(tmp_path):
    scenes = [Scene(name, (Faces(square(0.0), RED),), VIEW) for name in "abc"]
    write_png(tmp_path / "p.png", scenes, columns=2, cell=(100, 120))
    with Image.open(tmp_path / "p.png") as image:
        assert image.size == (200, 240)
    assert pixel(tmp_path / "p.png", 150, 73)[0] > 150
    assert pixel(tmp_path / "p.png", 150, 193) == (255, 255, 255)


def test_lines_and_dots_are_as_thick_as_they_say(tmp_path):
    ends = np.array([[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]])
    frame = Faces(square(-5.0), np.array([[1.0, 1.0, 1.0]]))
    layers = (frame, Lines(ends, RED, 6.0), Dots(np.array([[0.0, 0.6, 0.0]]), BLUE, 5.0))
    write_png(tmp_path / "p.png", [Scene("", layers, VIEW, 2.0)], cell=(200, 226))
    with Image.open(tmp_path / "p.png") as image:
        values = np.asarray(image.convert("RGB"), dtype=int)
    red = (values[:, 40, 0] > 200) & (values[:, 40, 1] < 100)
    assert 10 <= red.sum() <= 14
    blue = (values[:, 100, 2] > 200) & (values[:, 100, 1] < 100)
    assert 17 <= blue.sum() <= 23


def test_the_same_scene_is_the_same_bytes(tmp_path):
    for name in ("a.png", "b.png"):
        write_png(tmp_path / name, [Scene("t", (Faces(square(0.0), RED),), VIEW)])
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_a_place_that_cannot_be_written_is_told(tmp_path):
    with pytest.raises(OutputError, match="picture cannot be written"):
        write_png(tmp_path / "no" / "p.png", [Scene("t", (Faces(square(0.0), RED),), VIEW)])
