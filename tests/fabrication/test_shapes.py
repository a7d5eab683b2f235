import numpy as np
import pytest

from fabrication.outlines import Frame
from fabrication.shapes import Body, Prisms, Shape, circle, joined

FRAME = Frame(np.zeros(3), np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))
SQUARE = np.array([[-5, -5, 0], [5, -5, 0], [5, 5, 0], [-5, 5, 0]], dtype=float)


def kind(name, count, shapes=1):
    made = tuple(Shape(f"{name}{k}", SQUARE, 0.0, 2.0) for k in range(shapes))
    bodies = tuple(Body(f"{name}-{k}", k % shapes, FRAME) for k in range(count))
    return Prisms(name, (0.5, 0.5, 0.5), made, bodies)


def test_the_volume_is_the_outline_less_its_openings_times_the_height():
    shape = Shape("W1", SQUARE, -1.0, 3.0, (circle(2.0), circle(1.0, 3.0, 3.0)))
    assert shape.volume == pytest.approx(4.0 * (100.0 - np.pi * 5.0))


def test_a_circle_is_two_half_circles_around_its_centre():
    rows = circle(4.0, 1.0, 2.0)
    assert rows[:, 2].tolist() == [1.0, 1.0]
    assert rows[:, :2].mean(axis=0).tolist() == [1.0, 2.0]
    assert Shape("C", rows, 0.0, 1.0).volume == pytest.approx(np.pi * 16.0)


def test_kinds_are_joined_with_their_shapes_counted_on():
    whole = joined(kind("a", 3, 2), kind("empty", 0), kind("b", 2))
    assert [k.name for k in whole.kinds] == ["a", "b"]
    assert [body.shape for body in whole.kinds[0].bodies] == [0, 1, 0]
    assert [body.shape for body in whole.kinds[1].bodies] == [2, 2]
    assert len(whole.shapes) == 3
