from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest

import fabrication as fab
import gridshell as gs
from fabrication.motion import motion
from fabrication.motion_checks import motion_findings, motion_section

UMBRELLA = gs.Umbrella(16, 1200.0, (480.0,) * 8)
PROFILE = fab.Profile(50.0, 4.0, fab.GRP)


@pytest.fixture(scope="module")
def moved():
    limits = (radians(15.0), radians(165.0))
    return motion(UMBRELLA.position(0.3), PROFILE, count=25, limits=limits)


def test_edges_keep_their_lengths_and_stars_stay_planar(moved):
    assert moved.kept < 1e-6
    assert moved.planar < 1e-6
    assert len(moved.steps) == 25


def test_it_runs_between_the_angles_that_the_joints_let_be(moved):
    angles = np.degrees([step.angles for step in moved.steps])
    assert angles.min() >= 15.0
    assert angles.max() <= 165.0
    low, high = moved.locks
    beyond = [UMBRELLA.position(o) for o in (low - 0.01, high + 0.01)]
    assert np.degrees(beyond[0].node_angles.min()) < 15.0
    assert np.degrees(beyond[1].node_angles.max()) > 165.0


def test_the_base_ring_stays_and_the_crown_comes_down(moved):
    for step in moved.steps:
        feet = step.strips[:, 0].mean(axis=1)  # every strip begins at the base
        ends = step.strips[:, -1].mean(axis=1)
        base = np.where((np.abs(feet[:, 2]) < np.abs(ends[:, 2]))[:, None], feet, ends)
        np.testing.assert_allclose(np.hypot(*base[:, :2].T), UMBRELLA.radius, rtol=1e-9)
    heights = [step.height for step in moved.steps]
    assert heights[-1] < heights[0]
    assert moved.steps[-1].top_radius > moved.steps[0].top_radius


def test_the_cables_do_the_work_that_the_strips_store():
    """Virtual work over the whole way: the sum of force times way is the change of energy."""
    found = motion(UMBRELLA.position(0.3), PROFILE, count=81, limits=(0.5, 2.4))
    energy = np.array([stored(step) for step in (found.steps[0], found.steps[-1])])
    length = np.array([step.cable for step in found.steps])
    force = np.array([step.force for step in found.steps])
    work = -float(np.trapezoid(force, length))
    assert work == pytest.approx(energy[1] - energy[0], rel=0.01)


def stored(step):
    """Strain energy of all strips from their drawn edges alone, by finite differences, N mm."""
    total = 0.0
    h, t, e, g = PROFILE.width, PROFILE.thickness, fab.GRP.modulus, fab.GRP.rigidity
    for strip in step.strips:
        middle = strip.mean(axis=1)
        up = strip[:, 1] - strip[:, 0]
        up /= np.linalg.norm(up, axis=1)[:, None]
        ds = np.linalg.norm(np.diff(middle, axis=0), axis=1)
        s = np.r_[0.0, np.cumsum(ds)]
        tangent = np.gradient(middle, s, axis=0, edge_order=2)
        tangent /= np.linalg.norm(tangent, axis=1)[:, None]
        bend = np.gradient(tangent, s, axis=0, edge_order=2)
        across = np.cross(up, tangent)
        weak, strong = (np.einsum("nc,nc->n", bend, d) for d in (across, up))
        twist = np.einsum("nc,nc->n", np.gradient(up, s, axis=0, edge_order=2), across)
        density = e * h * t**3 / 12 * weak**2 + e * t * h**3 / 12 * strong**2
        density += g * h * t**3 / 3 * twist**2
        total += float(np.trapezoid(density, s)) / 2.0
    return total


def test_a_larger_umbrella_of_the_same_shape_bends_less(moved):
    large = gs.Umbrella(16, 2400.0, (960.0,) * 8)
    limits = moved.limits
    found = motion(large.position(0.3), PROFILE, count=25, limits=limits)
    for a, b in zip(moved.steps[::6], found.steps[::6], strict=True):
        assert b.radius == pytest.approx(2.0 * a.radius, rel=1e-3)
        assert b.twist == pytest.approx(a.twist / 2.0, rel=1e-3)


def test_a_sound_motion_has_no_findings(moved):
    assert motion_findings(moved, 0.3, "GRP") == []


def test_what_is_built_beyond_a_lock_is_an_error_with_the_nearest_that_works(moved):
    (finding,) = motion_findings(moved, 0.001, "GRP")
    assert finding.code == "motion-built"
    assert finding.severity is fab.Severity.ERROR
    assert finding.limit == moved.locks[0]


def test_a_strip_that_breaks_on_its_way_is_an_error_that_says_where_it_does_not():
    thick = fab.Profile(50.0, 16.0, fab.GRP)
    found = motion(UMBRELLA.position(0.3), thick, count=25)
    (finding,) = motion_findings(found, 0.3, "GRP")
    assert finding.code == "motion-stress"
    assert finding.value > 1.0
    assert "bears openings from" in finding.message


def test_below_a_dead_point_cables_close_what_they_should_open(moved):
    dead = replace(moved, dead_point=0.2)
    (finding,) = motion_findings(dead, 0.3, "GRP")
    assert (finding.code, finding.value) == ("dead-point", 0.2)


def test_the_cable_ends_at_the_highest_ring_above_the_base():
    odd = gs.Umbrella(16, 1200.0, (480.0,) * 7)
    assert motion(odd.position(0.3), PROFILE, count=2).cable == gs.Cable(0, 6)


def test_limits_that_no_position_keeps_name_some_that_one_does():
    with pytest.raises(gs.SettingError, match="No position keeps") as info:
        motion(UMBRELLA.position(0.3), PROFILE, limits=(radians(80.0), radians(90.0)))
    numbers = dict(part.split(" = ") for part in info.value.advice.split(", "))
    limits = tuple(radians(float(numbers[key])) for key in ("smallest", "largest"))
    assert motion(UMBRELLA.position(0.3), PROFILE, count=2, limits=limits).steps


def test_the_section_of_the_report(moved):
    section = motion_section(moved)
    assert section["positions"] == 25
    assert section["node_angle_deg"]["closed"][0] == pytest.approx(15.0, abs=0.2)
    assert section["cable_mm"][0] > section["cable_mm"][1]
    assert 0.0 < section["utilisation_max"] < 1.0
    assert pi > radians(section["node_angle_deg"]["opened"][1]) > 0.0
