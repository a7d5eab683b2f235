from math import radians

import numpy as np
import pytest

import fabrication as fab
import gridshell as gs

SPEC = fab.PanelSpec(gap=20.0, thickness=10.0, material=fab.GLASS)


@pytest.fixture(scope="module")
def roof():
    """Fig. 16: an A-net at 60 degrees, with the axes of its nodes."""
    patch = gs.AsymptoticPatch((-1.0, 1.0), (-1.0, 1.0), (11, 11))
    start = gs.control_patch(gs.Enneper(scale=4000.0), patch)
    found = gs.optimize(start, gs.a_net(angle=radians(60)), anchor=gs.Free()).require()
    net = gs.diagonal_meshes(found.control)[0]
    built = fab.structure(net, fab.Profile(100.0, 2.5, fab.STAINLESS))
    return net, np.array([node.axis for node in built.nodes])


def one_bay(corners):
    """A net with a single bay; only what a facade reads."""
    control = gs.as_control_mesh(gs.QuadMesh(*_around(np.asarray(corners, dtype=float))))
    nets = gs.diagonal_meshes(control)
    return next(net for net in nets if len(net.faces) == 1)


def _around(corners):
    """Four quads around their middle; the bay joins the middles' neighbours."""
    middle = corners.mean(axis=0)
    outer = corners + np.roll(corners, -1, axis=0) - middle
    points = np.vstack([[middle], corners, outer])
    quads = [[0, k + 1, k + 5, (k + 1) % 4 + 1] for k in range(4)]
    return points, np.array(quads)


@pytest.mark.parametrize("rule", list(fab.DiagonalRule))
def test_two_flat_triangles_per_bay(roof, rule):
    net, axes = roof
    made = fab.triangulated_facade(net, SPEC, axes=axes, rule=rule)
    bays = len(net.faces)
    assert len(made.panels) == 2 * bays
    assert len(made.secondary) == len(made.lengths) == len(made.folds) == bays
    np.testing.assert_array_equal(np.bincount(made.bay), 2)
    assert max(panel.planarity for panel in made.panels) < 1e-9
    for panel in made.panels:
        corners = net.vertices[net.faces[made.bay[panel.index]]]
        for corner in panel.frame.place(panel.face):
            assert np.linalg.norm(corners - corner, axis=1).min() < 1e-9


def test_the_axes_are_those_of_the_nodes(roof):
    net, axes = roof
    made = fab.triangulated_facade(net, SPEC, axes=axes)
    for vertex, axis in zip(made.mesh.vertices, made.mesh.axes, strict=True):
        own = int(np.argmin(np.linalg.norm(net.vertices - vertex, axis=1)))
        np.testing.assert_allclose(axis, axes[own], atol=1e-12)


def test_the_shorter_diagonal_is_taken_in_every_bay(roof):
    net, axes = roof
    made = fab.triangulated_facade(net, SPEC, axes=axes, rule=fab.DiagonalRule.SHORTER)
    bay = made.bay[made.mesh.edge_faces[made.secondary, 0]]
    corners = net.vertices[net.faces]
    both = [np.linalg.norm(corners[:, k + 2] - corners[:, k], axis=1) for k in (0, 1)]
    np.testing.assert_allclose(made.lengths, np.minimum(*both)[bay], atol=1e-9)


def fold_about(a, b, c, d):
    """Angle between the triangles a b c and a c d, from their dihedral angle."""
    along = (c - a) / np.linalg.norm(c - a)
    sides = [p - a - ((p - a) @ along) * along for p in (b, d)]
    cosine = sides[0] @ sides[1] / np.linalg.norm(sides[0]) / np.linalg.norm(sides[1])
    return np.pi - np.arccos(np.clip(cosine, -1.0, 1.0))


def test_the_flatter_diagonal_is_taken_in_every_bay(roof):
    net, axes = roof
    made = fab.triangulated_facade(net, SPEC, axes=axes, rule=fab.DiagonalRule.FLATTER)
    bay = made.bay[made.mesh.edge_faces[made.secondary, 0]]
    for s, face in enumerate(bay):
        a, b, c, d = net.vertices[net.faces[face]]
        smaller = min(fold_about(a, b, c, d), fold_about(b, c, d, a))
        assert made.folds[s] == pytest.approx(smaller, abs=1e-7)


def test_the_two_rules_differ_where_a_corner_lies_close_to_the_shorter_diagonal():
    net = one_bay([[0, 0, 0], [1000, -500, 100], [1060, 0, 0], [1000, 500, 100]])
    axes = np.tile([0.0, 0.0, 1.0], (len(net.vertices), 1))
    short, flat = (
        fab.triangulated_facade(net, SPEC, axes=axes, rule=rule)
        for rule in (fab.DiagonalRule.SHORTER, fab.DiagonalRule.FLATTER)
    )
    assert short.lengths.tolist() == pytest.approx([1000.0])
    assert short.folds.tolist() == pytest.approx([np.arctan(0.1) + np.arctan(100.0 / 60.0)])
    assert flat.lengths.tolist() == pytest.approx([1060.0])
    assert flat.folds.tolist() == pytest.approx([2.0 * np.arctan(0.2)])


def test_the_fold_of_a_roof_of_known_pitch():
    net = one_bay([[0, 0, 0], [1000, -800, -300], [2000, 0, 0], [1000, 800, -300]])
    axes = np.tile([0.0, 0.0, 1.0], (len(net.vertices), 1))
    made = fab.triangulated_facade(net, SPEC, axes=axes, rule=fab.DiagonalRule.SHORTER)
    # the ridge 0-2 is 2000 long, the valley 1-3 is 1600: the valley carries the profile
    assert made.lengths.tolist() == pytest.approx([1600.0])
    assert made.folds.tolist() == pytest.approx([2.0 * np.arctan(300.0 / 1000.0)])
    assert [len(panel.outline) for panel in made.panels] == [3, 3]
    assert made.panels[0].neighbours.count("P2") == 1


def test_a_bay_of_six_gets_a_fan():
    rays = 2.0 * np.pi * np.arange(12) / 12
    ring = 1000.0 * np.stack([np.cos(rays), np.sin(rays), 0.1 * np.cos(3.0 * rays)], axis=1)
    points = np.vstack([[[0.0, 0.0, 0.0]], ring * np.where(np.arange(12) % 2, 1.7, 1.0)[:, None]])
    quads = [[0, 2 * k + 1, 2 * k + 2, (2 * k + 2) % 12 + 1] for k in range(6)]
    control = gs.as_control_mesh(gs.QuadMesh(points, np.array(quads)))
    net = next(n for n in gs.diagonal_meshes(control) if len(n.faces) == 1)
    axes = np.tile([0.0, 0.0, 1.0], (len(net.vertices), 1))
    made = fab.triangulated_facade(net, SPEC, axes=axes)
    assert (len(made.panels), len(made.secondary)) == (4, 3)


def test_a_gap_too_large_is_refused_by_name(roof):
    net, axes = roof
    wide = fab.PanelSpec(gap=5000.0, thickness=10.0, material=fab.GLASS)
    with pytest.raises(gs.SettingError, match="panel P1"):
        fab.triangulated_facade(net, wide, axes=axes)


def test_a_net_without_bays_is_refused():
    control = gs.as_control_mesh(gs.QuadMesh(*_around(np.eye(4)[:, :3] * 1000.0)))
    net = next(n for n in gs.diagonal_meshes(control) if len(n.faces) == 0)
    with pytest.raises(gs.MeshError, match="too small"):
        fab.triangulated_facade(net, SPEC, axes=np.ones((len(net.vertices), 3)))
