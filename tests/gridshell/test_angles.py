import numpy as np
import pytest

import gridshell as gs
from gridshell.angles import angles_at, edge_crossings, face_crossings
from gridshell.mesh import crossing_angles

POINTS = np.array([[0.0, 0.0, 0.0], [3.0, 4.0, 0.0], [30.0, 40.0, 0.0]])


def test_one_angle_holds_everywhere():
    assert angles_at(1.2, POINTS).tolist() == [1.2, 1.2, 1.2]


def test_a_list_gives_one_to_each():
    assert angles_at(np.array([1.0, 1.1, 1.2]), POINTS).tolist() == [1.0, 1.1, 1.2]


def test_a_list_of_another_length_is_refused():
    with pytest.raises(gs.SettingError, match="one for every crossing") as info:
        angles_at(np.array([1.0, 1.1]), POINTS)
    assert (info.value.value, info.value.limit) == ("shape (2,)", "(3,)")


def test_a_field_is_asked_at_the_places():
    field = gs.RadialAngle((0.0, 0.0, 0.0), (0.0, 10.0), (1.5, 1.0))
    np.testing.assert_allclose(angles_at(field, POINTS), [1.5, 1.25, 1.0])


def test_a_field_outside_0_to_180_degrees_names_the_crossing():
    with pytest.raises(gs.SettingError, match="node angle") as info:
        angles_at(lambda points: points[:, 0] + 1.0, POINTS)
    assert info.value.where == "angle of crossing 1"


def test_faces_cross_at_their_corners(grid):
    control = gs.as_control_mesh(grid(2, 3))
    np.testing.assert_array_equal(face_crossings(control), control.quads)


@pytest.mark.parametrize("shear", [-0.4, 0.0, 0.7])
def test_edges_of_a_sheared_grid_cross_at_its_angle(grid, shear):
    """Family 1 of the edges is that of edge 0-1 of a labelled quad, everywhere the same."""
    mesh = grid(4, 5)
    x, y, z = mesh.vertices.T
    control = gs.as_control_mesh(mesh.moved(np.stack([x + shear * y, y, z], axis=1)))
    corners = edge_crossings(control)
    assert len(corners) == 12
    angle = np.arctan2(1.0, shear)
    first = control.vertices[control.quads[0, 1]] - control.vertices[control.quads[0, 0]]
    expected = angle if abs(first[1]) < 1e-9 else np.pi - angle
    np.testing.assert_allclose(crossing_angles(control.vertices, corners), expected, rtol=1e-12)


def test_a_singular_vertex_is_no_crossing_of_edges(sectors):
    control = gs.as_control_mesh(sectors(6, 3))
    centres = control.vertices[edge_crossings(control)].mean(axis=1)
    assert np.linalg.norm(centres, axis=1).min() > 0.5
