import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from shapely.geometry import Polygon

import fabrication as fab
import gridshell as gs
from fabrication.outlines import polygon_area
from gridshell.mesh import grid_quads

SPEC = fab.PanelSpec(gap=20.0, thickness=12.0, material=fab.GLASS, clearance=2.0)
WAYS = st.tuples(*[st.floats(-3.0, 3.0)] * 3, *[st.floats(-1e5, 1e5)] * 3)


def rectangles(rows=2, columns=3, size=(1000.0, 600.0)):
    """Flat rectangles in a row and column, node (i, j) at index i * (columns + 1) + j."""
    i, j = np.meshgrid(np.arange(rows + 1), np.arange(columns + 1), indexing="ij")
    points = np.stack([size[0] * i, size[1] * j, 0.0 * i], axis=-1).reshape(-1, 3)
    quads = [
        [a * (columns + 1) + b + k for k in (0, columns + 1, columns + 2, 1)]
        for a in range(rows)
        for b in range(columns)
    ]
    return gs.panel_mesh(points, np.array(quads), np.tile([0.0, 0.0, 1.0], (len(points), 1)))


def test_a_rectangle_is_set_back_by_half_the_gap_and_the_clearance():
    panel = fab.panels(rectangles(), SPEC)[0]
    assert np.ptp(panel.outline, axis=0).tolist() == pytest.approx([1000.0 - 24.0, 600.0 - 24.0])
    assert panel.area == pytest.approx(976.0 * 576.0)
    assert panel.mass == pytest.approx(0.976 * 0.576 * 0.012 * 2500.0)
    np.testing.assert_allclose(panel.corner_angles, np.pi / 2.0)
    assert panel.thickness == 12.0


def test_every_side_carries_its_neighbour():
    made = fab.panels(rectangles(), SPEC)
    # side 0 runs along i at j = 0, then counter-clockwise; P1 is (0, 0), P2 is (0, 1), P4 (1, 0)
    assert made[0].neighbours == (None, "P4", "P2", None)
    assert made[1].neighbours == ("P1", "P5", "P3", None)


def test_neighbours_agree_and_share_the_edge(principal_dome):
    mesh = gs.skin(principal_dome, gs.Skin.D1)
    made = {p.mark: p for p in fab.panels(mesh, SPEC)}
    for panel in made.values():
        for side, other in enumerate(panel.neighbours):
            if other is not None:
                back = made[other].neighbours.index(panel.mark)
                assert made[other].edges[back] == panel.edges[side]


@pytest.mark.parametrize("which", list(gs.Skin))
def test_flat_outlines_put_back_close_onto_the_net(principal_dome, which):
    mesh = gs.skin(principal_dome, which)
    worst = 0.0
    for panel in fab.panels(mesh, SPEC):
        corners = mesh.corner_points(panel.index)
        worst = max(worst, float(np.abs(panel.frame.place(panel.face) - corners).max()))
        # each corner of the outline is 12 mm from the two edges of the net that meet there
        placed = panel.in_space()
        along = np.roll(corners, -1, axis=0) - corners
        along /= np.linalg.norm(along, axis=1)[:, None]
        for away, direction in (
            (placed - corners, along),
            (placed - corners, np.roll(along, 1, 0)),
        ):
            distance = np.linalg.norm(np.cross(away, direction), axis=1)
            worst = max(worst, float(np.abs(distance - SPEC.setback).max()))
    assert worst < 1e-6


def test_the_gap_between_neighbours_is_the_one_asked_for():
    made = fab.panels(rectangles(), SPEC)
    flat = [Polygon(p.in_space()[:, :2]) for p in made]
    assert flat[0].distance(flat[1]) == pytest.approx(24.0)
    assert flat[0].distance(flat[3]) == pytest.approx(24.0)


def test_outlines_are_seen_from_the_positive_side(principal_dome):
    mesh = gs.skin(principal_dome, gs.Skin.PATTERN)
    normals = mesh.normals()
    for panel in fab.panels(mesh, SPEC)[::25]:
        assert polygon_area(panel.outline) > 0.0
        np.testing.assert_allclose(panel.frame.normal, normals[panel.index], atol=1e-9)


@given(WAYS)
def test_panels_do_not_change_when_the_net_is_moved(way):
    mesh = rectangles(1, 2)
    bent = mesh.vertices + np.array([[0.0, 0, 0], [0, 5, 0], [0, 0, 3]] * 2)
    one = gs.panel_mesh(bent, mesh.faces, mesh.axes)
    turn = Rotation.from_rotvec(way[:3])
    other = gs.panel_mesh(turn.apply(bent) + way[3:], mesh.faces, turn.apply(np.array(mesh.axes)))
    for a, b in zip(fab.panels(one, SPEC), fab.panels(other, SPEC), strict=True):
        np.testing.assert_allclose(a.outline, b.outline, atol=1e-8)
        assert a.planarity == pytest.approx(b.planarity, abs=1e-8)


def test_a_bent_panel_is_reported_with_its_distance():
    mesh = rectangles()
    points = np.array(mesh.vertices)
    points[0, 2] = 8.0
    made = fab.panels(gs.panel_mesh(points, mesh.faces, mesh.axes), SPEC)
    assert made[0].planarity == pytest.approx(2.0, rel=1e-3)
    (finding,) = fab.panel_findings(made)
    assert (finding.code, finding.where) == ("panel-planarity", "P1")
    assert finding.severity is fab.Severity.ERROR
    assert finding.value == made[0].planarity
    assert finding.limit == pytest.approx(5e-5 * np.hypot(1000.0, 600.0), rel=1e-3)


def test_flat_panels_are_not_reported(principal_dome):
    made = fab.panels(gs.skin(principal_dome, gs.Skin.D1), SPEC)
    assert 650 < len(made) < 750
    assert fab.panel_findings(made) == ()


@given(st.floats(600.0, 1e6))
def test_a_gap_too_large_is_refused_with_the_panel_s_name(gap):
    with pytest.raises(gs.SettingError, match="panel P1"):
        fab.panels(rectangles(), fab.PanelSpec(gap, 12.0, fab.GLASS))


@given(st.floats(0.0, 599.0))
def test_any_smaller_gap_leaves_a_panel(gap):
    panel = fab.panels(rectangles(), fab.PanelSpec(gap, 12.0, fab.GLASS))[0]
    assert panel.area == pytest.approx((1000.0 - gap) * (600.0 - gap))


@pytest.mark.parametrize(
    ("settings", "key"),
    [
        ({"gap": -1.0, "thickness": 10.0}, "gap"),
        ({"gap": np.nan, "thickness": 10.0}, "gap"),
        ({"gap": 1.0, "thickness": 0.0}, "thickness"),
        ({"gap": 1.0, "thickness": np.inf}, "thickness"),
        ({"gap": 1.0, "thickness": 10.0, "clearance": -0.1}, "clearance"),
    ],
)
def test_bad_settings_are_refused_by_name(settings, key):
    with pytest.raises(gs.SettingError, match=key):
        fab.PanelSpec(material=fab.GLASS, **settings)


def test_the_panels_of_a_rotational_net_are_equal_around_the_axis():
    """A torus cut along its principal lines: planar trapezoids, one kind per ring."""
    around, across = 24, 5
    u, v = np.meshgrid(
        2.0 * np.pi * np.arange(around) / around, np.linspace(-1.0, 0.7, across + 1), indexing="ij"
    )
    out = 9000.0 + 3000.0 * np.cos(v)
    points = np.stack([out * np.cos(u), out * np.sin(u), 3000.0 * np.sin(v)], axis=-1)
    w = across + 1
    quads = [
        [i * w + j, (i + 1) % around * w + j, (i + 1) % around * w + j + 1, i * w + j + 1]
        for i in range(around)
        for j in range(across)
    ]
    flat = points.reshape(-1, 3)
    mesh = gs.panel_mesh(flat, np.array(quads), flat)
    made = fab.panels(mesh, SPEC)
    assert max(p.planarity for p in made) < 1e-9
    groups = fab.panel_groups(made, 0.01)
    assert [len(g.members) for g in groups] == [around] * across
    # a ring's panel is its own mirror image, so no member needs turning over
    assert not any(m.mirrored for g in fab.panel_groups(made, 0.01, mirror=True) for m in g.members)


def test_a_rotational_net_of_rhombi_has_one_kind_of_panel_per_ring():
    """Fig. 7 at 60 degrees, optimised and not built by hand.

    A panel is its own mirror image about its meridian, so one turned round fits below the equator.
    """
    around, across, turn = 24, 7, np.pi / 3.0
    v = (np.arange(across + 1) - across / 2.0) * 2.0 * np.pi / around / np.tan(turn / 2.0)
    u, v = np.meshgrid(2.0 * np.pi * np.arange(around) / around, v, indexing="ij")
    xyz = [np.cos(u) / np.cosh(v), np.sin(u) / np.cosh(v), np.tanh(v)]
    points = 8000.0 * np.stack(xyz, axis=-1).reshape(-1, 3)
    start = gs.as_control_mesh(gs.QuadMesh(points, grid_quads(around, across, ring=True)))
    found = gs.optimize(start, gs.pq_net(angle=turn, rhombus=True), anchor=gs.Free()).require()
    made = fab.panels(gs.skin(found.control, gs.Skin.D1), SPEC)
    # six rings of white faces, half of them in D1, twelve panels each
    assert len(made) == 6 * 12
    groups = fab.panel_groups(made, 0.01)
    assert [len(g.members) for g in groups] == [24] * 3
