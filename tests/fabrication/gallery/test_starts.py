import numpy as np
import pytest

import gridshell as gs
from fabrication.gallery.starts import dome, graph, ring_on_sphere, shell, triangles


@pytest.mark.parametrize("degrees", [60.0, 90.0, 120.0])
def test_the_ring_lies_on_its_sphere_and_its_diagonals_meet_at_the_angle(degrees):
    control = ring_on_sphere(200, 60, np.radians(degrees), 500.0)
    np.testing.assert_allclose(np.linalg.norm(control.vertices, axis=1), 500.0)
    assert np.degrees(np.abs(gs.node_angles(control) - np.radians(degrees))).max() < 0.2
    assert (len(control.vertices), len(control.quads)) == (200 * 61, 200 * 60)


@pytest.mark.parametrize("height", [dome, shell])
def test_graphs_have_their_height(height):
    mesh = graph(4, 8, height, 100.0)
    x, y, z = mesh.vertices.T / 100.0
    np.testing.assert_allclose(z, height(x, y), atol=1e-12)
    assert (np.ptp(x), np.ptp(y)) == (2.0, 4.0)


def test_triangles_face_upwards():
    surface = triangles(dome, 100.0, 6)
    a, b, c = np.moveaxis(surface.vertices[surface.triangles], 1, 0)
    assert (np.cross(b - a, c - a)[:, 2] > 0.0).all()
    assert len(surface.triangles) == 72
