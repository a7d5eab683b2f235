import numpy as np
import pytest
import trimesh

import fabrication as fab
from fabrication.export.connector_view import connector_traces, shape_mesh
from fabrication.flattening import corners
from fabrication.joints.double_slot import StarWasher
from fabrication.outlines import Frame
from fabrication.shapes import Body, Prisms, Shape, circle

SQUARE = np.array([[0.0, 0.0, 0.0], [40.0, 0.0, 0.0], [40.0, 30.0, 0.0], [0.0, 30.0, 0.0]])


def washer(angle=1.2):
    outline, hole = StarWasher(4.0, 18.0, 8.0, fab.S235).outline(angle, 15.0, 9.0)
    return Shape("W1", outline, 0.0, 4.0, (hole,))


@pytest.mark.parametrize(
    "shape",
    [
        Shape("block", SQUARE, -5.0, 12.0),
        Shape("tube", SQUARE, 0.0, 60.0, (circle(8.0, 20.0, 15.0),)),
        Shape("stud", circle(10.0), -3.0, 70.0),
        washer(),
    ],
    ids=lambda shape: shape.mark,
)
def test_a_shape_is_a_closed_body_of_nearly_its_volume(shape):
    points, faces = shape_mesh(shape)
    mesh = trimesh.Trimesh(points, faces, process=False)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.volume == pytest.approx(shape.volume, rel=0.11)
    assert mesh.bounds[:, 2] == pytest.approx([shape.low, shape.high])


@pytest.mark.parametrize("bulge", [1.0, -1.0, 0.3, -2.0])
def test_arcs_are_cut_into_chords_on_their_circle(bulge):
    ring = corners(np.array([[0.0, 0.0, bulge], [10.0, 0.0, 0.0], [5.0, 30.0, 0.0]]))
    on_arc = ring[: -2 + 1]
    assert len(on_arc) > 2
    radius = 10.0 * (1.0 + bulge**2) / (4.0 * abs(bulge))
    hub = np.array([5.0, 5.0 * (1.0 - bulge**2) / (2.0 * bulge)])
    assert np.linalg.norm(on_arc - hub, axis=1) == pytest.approx(radius)
    middle = np.array([5.0, -5.0 * bulge])  # the sagitta is bulge times half the chord
    assert np.linalg.norm(on_arc - middle, axis=1).min() < 0.4 * radius


def bodies(count):
    frames = [
        Frame(np.array([100.0 * k, 0.0, 0.0]), np.eye(3)[0], np.eye(3)[1]) for k in range(count)
    ]
    marks = [f"N{k}" for k in range(count)]
    made = tuple(Body(mark, 0, frame) for mark, frame in zip(marks, frames, strict=True))
    return Prisms("star washers", (0.5, 0.5, 0.5), (washer(),), made)


def test_every_shape_is_told_once_and_every_body_by_nine_numbers():
    (trace,) = connector_traces([bodies(20)], np.zeros(3))
    assert (trace.name, trace.visible) == ("Star washers", True)
    assert len(trace.meta["shapes"]) == 1
    assert np.array(trace.meta["frames"]).shape == (180,)
    assert trace.meta["frames"][9:12] == pytest.approx([0.1, 0.0, 0.0])


def test_many_connectors_wait_to_be_asked_for():
    (trace,) = connector_traces([bodies(2000)], np.zeros(3))
    assert trace.visible == "legendonly"


def test_a_kind_without_bodies_is_left_out():
    empty = Prisms("bolts", (0.5, 0.5, 0.5), (), ())
    assert connector_traces([empty], np.zeros(3)) == []
