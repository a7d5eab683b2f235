import numpy as np

import fabrication as fab
import gridshell as gs
from fabrication.gallery.scenery import connector_faces, lamella_faces
from gridshell.painter import polygons, seen_from


def test_padded_faces_repeat_their_last_corner():
    points = np.eye(4, 3)
    found = polygons(points, np.array([[0, 1, 2, 3], [3, 1, 2, -1]]))
    np.testing.assert_array_equal(found[0], points)
    np.testing.assert_array_equal(found[1], points[[3, 1, 2, 2]])


def test_a_view_is_a_rotation_that_looks_from_where_it_says():
    view = seen_from(1.0, -2.0, 0.5)
    np.testing.assert_allclose(view.frame @ view.frame.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(view.frame) > 0.0
    eye = np.array([1.0, -2.0, 0.5])
    np.testing.assert_allclose(view.seen(eye / np.linalg.norm(eye)), [0.0, 0.0, 1.0], atol=1e-12)
    assert view.seen(np.array([0.0, 0.0, 1.0]))[1] > 0.0


def test_strips_are_drawn_where_they_are_and_connectors_with_them():
    patch = gs.AsymptoticPatch(p=(-0.2, 0.2), q=(-0.2, 0.2), lamellas=(3, 3))
    net = gs.diagonal_meshes(gs.control_patch(gs.Hypar(3000.0), patch))[0]
    profile = fab.Profile(100.0, 1.5, fab.S235)
    joint = fab.StudJoint(40.0, fab.Stud(fab.S235, wall=3.0), level=51.0)
    jointed = joint.build(fab.structure(net, profile))
    layers = lamella_faces(jointed.strips)
    assert len(layers) == 2
    for layer in layers:
        up = layer.corners[:, 3] - layer.corners[:, 0]
        np.testing.assert_allclose(np.linalg.norm(up, axis=1), 100.0, rtol=1e-9)
    (studs,) = connector_faces(jointed.connectors)
    nodes = np.array([node.position for node in jointed.design.nodes])
    away = np.linalg.norm(studs.corners.mean(axis=1)[:, None] - nodes[None], axis=2).min(axis=1)
    assert away.max() < 120.0
