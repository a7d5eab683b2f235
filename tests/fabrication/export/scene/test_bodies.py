import numpy as np
import pytest

import fabrication as fab
from fabrication.export.scene.bodies import connector_layers
from fabrication.joints.double_slot import StarWasher
from fabrication.outlines import Frame
from fabrication.shapes import Body, Prisms, Shape


def washer(angle=1.2):
    outline, hole = StarWasher(4.0, 18.0, 8.0, fab.S235).outline(angle, 15.0, 9.0)
    return Shape("W1", outline, 0.0, 4.0, (hole,))


def bodies(count):
    frames = [
        Frame(np.array([100.0 * k, 0.0, 0.0]), np.eye(3)[0], np.eye(3)[1]) for k in range(count)
    ]
    marks = [f"N{k}" for k in range(count)]
    made = tuple(Body(mark, 0, frame) for mark, frame in zip(marks, frames, strict=True))
    return Prisms("star washers", (0.5, 0.5, 0.5), (washer(),), made)


def test_every_shape_is_told_once_and_every_body_by_nine_numbers():
    (layer,) = connector_layers([bodies(20)], np.zeros(3))
    assert (layer.name, layer.visible) == ("Star washers", True)
    assert len(layer.shapes) == 1
    assert layer.frames.shape == (20, 9)
    assert layer.frames[1, :3] == pytest.approx([0.1, 0.0, 0.0])
    assert [part.mark for part in layer.parts] == [f"N{k}" for k in range(20)]


def test_many_connectors_wait_to_be_asked_for():
    (layer,) = connector_layers([bodies(2000)], np.zeros(3))
    assert not layer.visible


def test_a_kind_without_bodies_is_left_out():
    empty = Prisms("bolts", (0.5, 0.5, 0.5), (), ())
    assert connector_layers([empty], np.zeros(3)) == []
