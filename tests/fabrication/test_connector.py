from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely.geometry import LineString, Point, Polygon

import fabrication as fab
import gridshell as gs
from gridshell.mesh import grid_quads

SPEC = fab.ConnectorSpec(radius=60.0, height=200.0, plate_thickness=10.0, clearance=0.5, depth=30.0)


def star(angles, slope=0.0):
    """A fan of triangles around node 0 with arms at these angles, every arm at a slope."""
    turn = np.asarray(angles)
    arms = 1000.0 * np.stack(
        [np.cos(turn), np.sin(turn), np.full_like(turn, np.tan(slope))], axis=1
    )
    points = np.vstack([[0.0, 0.0, 0.0], arms])
    k = len(turn)
    faces = np.array([[0, i + 1, (i + 1) % k + 1] for i in range(k)])
    return gs.panel_mesh(points, faces, np.tile([0.0, 0.0, 1.0], (k + 1, 1)))


def polygon(section, steps=200):
    """The section with its arcs drawn as short chords, by the definition of the bulge."""
    points = []
    for (x, y, bulge), (u, v, _) in zip(section, np.roll(section, -1, axis=0), strict=True):
        points.append((x, y))
        if bulge:
            sweep, chord = 4.0 * np.arctan(bulge), np.hypot(u - x, v - y)
            radius = chord / 2.0 / np.sin(sweep / 2.0)
            mid, apothem = np.array([x + u, y + v]) / 2.0, radius * np.cos(sweep / 2.0)
            centre = mid + apothem * np.array([-(v - y), u - x]) / chord
            start = np.arctan2(y - centre[1], x - centre[0])
            turn = start + np.linspace(0.0, sweep, steps)[1:-1]
            rim = centre + abs(radius) * np.stack([np.cos(turn), np.sin(turn)], axis=1)
            points += rim.tolist()
    return Polygon(points)


def test_the_arms_of_a_known_star():
    made = fab.connectors(star([0.3, 1.9, 3.0, 5.0], slope=-0.1), SPEC)[0]
    assert (made.mark, made.node) == ("N1", 0)
    np.testing.assert_allclose(made.slot_angles, [0.0, 1.6, 2.7, 4.7], atol=1e-12)
    np.testing.assert_allclose(made.between, [1.6, 1.1, 2.0, 2.0 * np.pi - 4.7], atol=1e-12)
    assert [arm.slope for arm in made.arms] == pytest.approx([-0.1] * 4)
    assert [arm.node for arm in made.arms] == [1, 2, 3, 4]
    np.testing.assert_allclose(made.frame.normal, [0.0, 0.0, 1.0], atol=1e-12)


def test_every_plate_lies_in_its_slot(principal_dome):
    mesh = gs.skin(principal_dome, gs.Skin.D1)
    section = fab.PlateSection(-200.0, 0.0, 10.0, fab.S235, setback=SPEC.floor)
    plates = fab.supports(mesh, section)
    for made in fab.connectors(mesh, SPEC):
        np.testing.assert_allclose(made.frame.normal, mesh.axes[made.node], atol=1e-12)
        for arm in made.arms:
            plate = plates[arm.edge]
            end = plate.in_space()[[0, 3] if plate.nodes[0] == made.node else [1, 2]]
            flat = made.frame.flat(end)
            # on the slot's centre line, at its floor
            expected = SPEC.floor * np.array([np.cos(arm.angle), np.sin(arm.angle)])
            np.testing.assert_allclose(flat, np.tile(expected, (2, 1)), atol=1e-4)


@given(st.integers(3, 6), st.floats(0.0, 6.0))
def test_the_section_is_a_disc_less_its_slots(count, start):
    made = fab.connectors(star(start + 2.0 * np.pi * np.arange(count) / count), SPEC)[0]
    disc = Point(0.0, 0.0).buffer(SPEC.radius, quad_segs=2000)
    for arm in made.arms:
        ray = np.array([np.cos(arm.angle), np.sin(arm.angle)])
        slot = LineString([SPEC.floor * ray, 2.0 * SPEC.radius * ray])
        disc = disc.difference(slot.buffer(SPEC.slot_width / 2.0, cap_style="flat"))
    drawn = polygon(made.section())
    assert drawn.is_valid
    assert drawn.exterior.is_ccw
    assert drawn.symmetric_difference(disc).area < 1e-4 * disc.area


@given(st.floats(0.2, 3.0))
def test_the_web_is_the_distance_of_the_slots_floors(between):
    made = fab.connectors(star([0.0, between, between + 0.5 * (2.0 * np.pi - between)]), SPEC)[0]
    half = SPEC.slot_width / 2.0
    corners = []
    for angle, side in ((0.0, half), (between, -half)):
        c, s = np.cos(angle), np.sin(angle)
        corners.append([SPEC.floor * c - side * s, SPEC.floor * s + side * c])
    distance = np.linalg.norm(np.subtract(*corners))
    assert abs(made.webs[0]) == pytest.approx(distance, abs=1e-9)
    # negative where the walls have crossed before they reach their floors
    assert (made.webs[0] < 0.0) == (SPEC.floor < half / np.tan(between / 2.0))


def test_a_crowded_connector_is_reported_with_a_radius_that_works():
    mesh = star([0.0, 0.4, 2.5, 4.5])
    (finding,) = fab.connector_findings(fab.connectors(mesh, SPEC)[:1])
    assert (finding.code, finding.where, finding.limit) == ("connector-crowded", "N1", 10.0)
    assert finding.severity is fab.Severity.ERROR
    assert finding.value == pytest.approx(2.0 * 30.0 * np.sin(0.2) - 10.5 * np.cos(0.2))
    assert "22.9 degrees" in finding.message
    advised = float(finding.message.split("a radius of ")[1].split(" mm")[0])
    assert fab.connector_findings(fab.connectors(mesh, replace(SPEC, radius=advised))[:1]) == ()
    assert fab.connector_findings(fab.connectors(mesh, replace(SPEC, radius=advised - 0.2))[:1])


def test_right_angles_leave_room(principal_dome):
    made = fab.connectors(gs.skin(principal_dome, gs.Skin.D1), SPEC)
    assert fab.connector_findings(made) == ()


@pytest.mark.parametrize(
    ("change", "key"),
    [
        ({"radius": 0.0}, "radius"),
        ({"height": -1.0}, "height"),
        ({"plate_thickness": 0.0}, "plate_thickness"),
        ({"clearance": -0.1}, "clearance"),
        ({"depth": 60.0}, "depth"),
        ({"depth": np.nan}, "depth"),
        ({"web": 0.0}, "web"),
        ({"plate_thickness": 120.0}, "plate_thickness"),
    ],
)
def test_bad_settings_are_refused_by_name(change, key):
    with pytest.raises(gs.SettingError, match=key):
        replace(SPEC, **change)


def test_an_edge_along_the_axis_is_refused():
    mesh = star([0.0, 2.0, 4.0])
    axes = np.array(mesh.axes)
    axes[0] = [1.0, 0.0, 0.0]
    with pytest.raises(gs.SettingError, match="connector N1"):
        fab.connectors(mesh.with_axes(axes), SPEC)


def test_equal_connectors_are_grouped_turned_or_turned_over():
    turns = np.array([0.0, 1.0, 2.2, 4.0])
    stars = [star(turns), star(turns + 0.7), star(-turns), star([0.0, 1.0, 2.2, 4.1])]
    made = [fab.connectors(mesh, SPEC)[0] for mesh in stars]
    groups = fab.connector_groups(made, 0.01)
    assert [[m.index for m in g.members] for g in groups] == [[0, 1, 2], [3]]
    assert [g.name for g in groups] == ["K1", "K2"]
    assert [m.mirrored for m in groups[0].members] == [False, False, True]


def test_on_a_cylinder_all_inner_connectors_are_one():
    turn, along = np.meshgrid(np.linspace(-0.6, 0.6, 9), 900.0 * np.arange(7.0), indexing="ij")
    points = np.stack([5000.0 * np.sin(turn), along, 5000.0 * np.cos(turn)], axis=-1)
    control = gs.control_mesh(gs.QuadMesh(points.reshape(-1, 3), grid_quads(8, 6)))
    mesh = gs.skin(control, gs.Skin.D1)
    made = [c for c in fab.connectors(mesh, SPEC) if not mesh.boundary[c.node]]
    assert len(made) > 1
    (group,) = fab.connector_groups(made, 1e-6)
    assert len(group.members) == len(made)
