import numpy as np
import pytest
import trimesh

import fabrication as fab
from fabrication.export.view_meshes import columns, shape_mesh
from fabrication.flattening import corners
from fabrication.joints.double_slot import StarWasher
from fabrication.shapes import Shape, circle

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


def test_columns_leave_the_slots_out(pair):
    part = pair.parts[0]
    x, lower, upper = columns(part, 4)
    area = ((upper - lower) * np.diff(x)).sum()
    assert area == pytest.approx(part.area, rel=1e-6)
    walls = [slot.x + side * slot.width / 2.0 for slot in part.slots for side in (-1.0, 1.0)]
    assert np.abs(np.subtract.outer(walls, x)).min(axis=1).max() < 1e-6
