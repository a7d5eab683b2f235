from dataclasses import replace
from math import radians

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import fabrication as fab
import gridshell as gs
from fabrication.outlines import polygon_area

SECTION = fab.PlateSection(below=-200.0, above=0.0, thickness=10.0, material=fab.S235, setback=40.0)


def two_nodes(twist, length=1000.0, tilt=0.0):
    """A single triangle whose first edge, along x, has axes turned by +- half the twist."""
    points = np.array([[0.0, 0, 0], [length, 0, 0], [length / 2.0, 700.0, 0]])
    half = twist / 2.0
    lean = np.array([[-np.sin(tilt)], [np.sin(tilt)], [0.0]]) * [[1.0, 0, 0]]
    upright = np.array(
        [[0, np.sin(half), np.cos(half)], [0, -np.sin(half), np.cos(half)], [0, 0, 1]]
    )
    return gs.panel_mesh(points, np.array([[0, 1, 2]]), upright * np.cos(tilt) + lean)


def per_metre(plates):
    return max(1000.0 * p.out_of_plane / p.length for p in plates)


# ---- figures ---------------------------------------------------------------------------------


@pytest.mark.parametrize("which", [gs.Skin.D1, gs.Skin.D2])
def test_plates_at_90_degrees_are_flat_and_the_classical_ones_are_not(principal_dome, which):
    mesh = gs.skin(principal_dome, which)
    assert 650 < len(mesh.faces) < 750
    assert 900.0 < mesh.edge_lengths.mean() < 1100.0
    plates = fab.supports(mesh, SECTION)
    assert per_metre(plates) < 1e-6
    assert fab.support_findings(plates, SECTION) == ()
    classical = fab.supports(mesh.with_axes(gs.averaged_normals(mesh)), SECTION)
    assert per_metre(classical) > 0.2


def test_plates_of_the_pattern_at_90_degrees_are_flat(principal_dome):
    plates = fab.supports(gs.skin(principal_dome, gs.Skin.PATTERN), SECTION)
    assert per_metre(plates) < 0.01


@pytest.mark.parametrize("which", list(gs.Skin))
def test_plates_at_another_angle_are_not_flat_and_say_so(oblique_dome, which):
    plates = fab.supports(gs.skin(oblique_dome, which), SECTION)
    assert 0.3 < per_metre(plates) < 3.0
    found = fab.support_findings(plates, SECTION)
    assert len(found) == sum(not p.flat for p in plates) > 0.9 * len(plates)
    assert {f.code for f in found} == {"support-twist"}
    assert {f.severity for f in found} == {fab.Severity.INFO}


def test_flat_plates_put_back_close_onto_the_axes(principal_dome):
    mesh = gs.skin(principal_dome, gs.Skin.D1)
    worst = 0.0
    for plate in fab.supports(mesh, SECTION):
        worst = max(worst, float(np.abs(plate.frame.place(plate.face) - plate.corners).max()))
        placed = plate.in_space()
        for node, ends in zip(plate.nodes, (placed[[0, 3]], placed[[1, 2]]), strict=True):
            away = np.cross(ends - mesh.vertices[node], mesh.axes[node])
            worst = max(worst, float(np.abs(np.linalg.norm(away, axis=1) - 40.0).max()))
    assert worst < 1e-5


# ---- truth -----------------------------------------------------------------------------------


def test_axes_through_one_point_make_every_plate_flat():
    rng = np.random.default_rng(3)
    ball = rng.normal(size=(30, 3))
    ball = 8000.0 * ball / np.linalg.norm(ball, axis=1)[:, None]
    triangles = np.array([[3 * k, 3 * k + 1, 3 * k + 2] for k in range(10)])
    section = replace(SECTION, setback=0.0)
    for plate in fab.supports(gs.panel_mesh(ball, triangles, ball), section):
        assert plate.out_of_plane < 1e-9
        assert abs(plate.twist) < 1e-12
        # the axes are radii: the angle between them is the edge's over the radius
        assert plate.axis_angle == pytest.approx(2.0 * np.arcsin(plate.length / 16_000.0))
        lower, upper = (np.linalg.norm(plate.face[b] - plate.face[a]) for a, b in ((0, 1), (3, 2)))
        assert lower / upper == pytest.approx(7800.0 / 8000.0)


def test_the_twist_on_a_paraboloid_is_the_one_of_its_normals(paraboloid):
    mesh = gs.skin(paraboloid, gs.Skin.D1)
    radius = 5000.0
    checked = 0
    for plate in fab.supports(mesh, SECTION):
        (x1, y1, _), (x2, y2, _) = mesh.vertices[list(plate.nodes)]
        if plate.partial or abs(y1 - y2) > 1e-6:
            continue
        # e = (1, 0, (x1 + x2) / 2R), n = (-x / R, -y / R, 1), all over the same length of x
        e = np.array([1.0, 0.0, (x1 + x2) / (2.0 * radius)]) * np.sign(x2 - x1)
        b = [np.cross(e, [-x / radius, -y1 / radius, 1.0]) for x in (x1, x2)]
        volume = -(x2 - x1) * y1 * (x1 + x2) / (2.0 * radius**3) * np.sign(x2 - x1)
        sine = np.linalg.norm(e) * volume / np.linalg.norm(b[0]) / np.linalg.norm(b[1])
        assert np.sin(plate.twist) == pytest.approx(sine, abs=1e-12)
        checked += 1
    assert checked >= 9


@given(st.floats(-0.5, 0.5), st.floats(300.0, 3000.0))
def test_a_twist_of_known_size(twist, length):
    plate = fab.supports(two_nodes(twist, length), SECTION)[0]
    # axes turned from +y to -y about x: counter-clockwise, seen from the far end
    assert plate.twist == pytest.approx(twist, abs=1e-12)
    assert plate.axis_angle == pytest.approx(abs(twist), abs=1e-9)
    # corners a b c d with the upper ones on the edge: the tetrahedron's two diagonals
    a, b, c, d = plate.corners
    normal = np.cross(c - a, d - b)
    expected = abs((b - a) @ normal) / np.linalg.norm(normal) / 2.0
    assert plate.out_of_plane == pytest.approx(expected, abs=1e-9)
    assert plate.out_of_plane == pytest.approx(200.0 * abs(np.sin(twist / 2.0)) / 2.0, rel=0.1)


@given(
    st.tuples(*[st.floats(-3.0, 3.0)] * 3),
    st.tuples(*[st.floats(-1e5, 1e5)] * 3),
    st.floats(-0.3, 0.3),
)
def test_plates_do_not_change_when_the_net_is_moved(turn, away, twist):
    mesh = two_nodes(twist)
    turned = Rotation.from_rotvec(turn)
    points, axes = (turned.apply(np.array(v)) for v in (mesh.vertices, mesh.axes))
    other = gs.panel_mesh(points + away, mesh.faces, axes)
    for a, b in zip(fab.supports(mesh, SECTION), fab.supports(other, SECTION), strict=True):
        np.testing.assert_allclose(a.outline, b.outline, atol=1e-7)
        assert a.twist == pytest.approx(b.twist, abs=1e-9)
        assert a.out_of_plane == pytest.approx(b.out_of_plane, abs=1e-7)


def test_the_outline_is_set_back_at_both_ends():
    plate = fab.supports(two_nodes(0.0), SECTION)[0]
    assert np.ptp(plate.outline, axis=0).tolist() == pytest.approx([920.0, 200.0])
    assert np.ptp(plate.face, axis=0).tolist() == pytest.approx([1000.0, 200.0])
    assert polygon_area(plate.outline) == pytest.approx(920.0 * 200.0)
    assert plate.mass == pytest.approx(0.92 * 0.2 * 0.01 * 7850.0)
    assert (plate.mark, plate.edge, plate.nodes) == ("S1", 0, (0, 1))


# ---- what a twist takes ----------------------------------------------------------------------


def test_the_cost_of_a_twist():
    plate = fab.supports(two_nodes(0.1), SECTION)[0]
    cost = fab.twist_cost(plate, SECTION)
    shear_modulus = 210_000.0 / 2.6
    assert cost.rate == pytest.approx(1e-4)
    assert cost.shear == pytest.approx(shear_modulus * 10.0 * 1e-4)
    assert cost.moment == pytest.approx(shear_modulus * 200.0 * 10.0**3 / 3.0 * 1e-4)
    assert cost.edge_strain == pytest.approx(1e-8 * 100.0**2 / 2.0)
    assert cost.stretch == pytest.approx(210_000.0 * 1e-8 * 200.0**2 / 12.0)


@pytest.mark.parametrize(
    ("degrees", "severity"),
    [(0.5, "info"), (6.0, "warning"), (15.0, "error")],
)
def test_a_bent_plate_is_reported_by_what_it_bears(degrees, severity):
    plates = fab.supports(two_nodes(radians(degrees)), SECTION)[:1]
    (finding,) = fab.support_findings(plates, SECTION)
    assert (finding.code, finding.where, finding.unit) == ("support-twist", "S1", "mm")
    assert finding.severity.value == severity
    assert finding.value == plates[0].out_of_plane
    assert finding.limit == pytest.approx(0.05)
    assert f"{degrees:g} degrees over 1000 mm" in finding.message
    assert ("does not bear" in finding.message) == (severity == "error")


# ---- bad input -------------------------------------------------------------------------------


@given(st.floats(500.0, 1e6))
def test_a_setback_too_large_is_refused_with_the_plate_s_name(setback):
    with pytest.raises(gs.SettingError, match="plate S1"):
        fab.supports(two_nodes(0.0), replace(SECTION, setback=setback))


def test_axes_that_meet_within_the_height_are_refused():
    steep = two_nodes(0.0, length=100.0, tilt=1.0)
    with pytest.raises(gs.SettingError, match="plate S1"):
        fab.supports(steep, replace(SECTION, setback=0.0))


@pytest.mark.parametrize(
    ("change", "key"),
    [
        ({"thickness": 0.0}, "thickness"),
        ({"below": 0.0}, "below, above"),
        ({"above": np.nan}, "below, above"),
        ({"setback": -1.0}, "setback"),
    ],
)
def test_bad_settings_are_refused_by_name(change, key):
    with pytest.raises(gs.SettingError, match=key):
        replace(SECTION, **change)


def test_equal_plates_are_grouped_also_when_turned_over(paraboloid):
    """The paraboloid has two planes of symmetry: its plates come in mirror pairs and fours."""
    plates = fab.supports(gs.skin(paraboloid, gs.Skin.D1), SECTION)
    groups = fab.plate_groups(plates, 0.01)
    assert sum(len(g.members) for g in groups) == len(plates)
    assert len(groups) < 0.4 * len(plates)
    for group in groups:
        lengths = [plates[m.index].length for m in group.members]
        assert np.ptp(lengths) < 0.1


@pytest.mark.parametrize("which", list(gs.Skin))
def test_torsion_free_axes_make_plates_flat_at_any_angle(oblique_dome, which):
    mesh = gs.skin(oblique_dome, which)
    leaning = gs.torsion_free_axes(mesh)
    plates = fab.supports(mesh.with_axes(leaning.axes), SECTION)
    assert per_metre(plates) < 1e-6
    assert fab.support_findings(plates, SECTION) == ()
    assert radians(2.0) < leaning.tilt.max() < radians(12.0)


def test_at_90_degrees_torsion_free_axes_are_the_nodes_own(principal_dome):
    leaning = gs.torsion_free_axes(gs.skin(principal_dome, gs.Skin.D1))
    assert leaning.tilt.max() < radians(0.01)
    np.testing.assert_allclose(leaning.distance, 1.0, atol=1e-4)
