import numpy as np
import pytest

import fabrication as fab
import gridshell as gs
from fabrication.segment_checks import (
    largest_difference,
    require_apart,
    seam_findings,
    seam_of,
)
from fabrication.segments import Segments, hanging

PROFILE = fab.Profile(100.0, 2.5, fab.STAINLESS)


def quarter(near=0.02):
    patch = gs.AsymptoticPatch(p=(near, 1.0), q=(-1.0, -near), lamellas=(4, 4))
    net = gs.diagonal_meshes(gs.control_patch(gs.Hypar(5000.0), patch))[0]
    return fab.structure(net, PROFILE)


@pytest.fixture(scope="module")
def design():
    return quarter()


@pytest.mark.parametrize("count", [2, 3, 4, 5, 7])
def test_copies_are_turned_about_the_axis_and_close_the_circle(count):
    segments = Segments(count, centre=(300.0, -200.0))
    points = np.random.default_rng(1).normal(scale=1000.0, size=(20, 3))
    np.testing.assert_allclose(segments.placed(points, 0), points, atol=1e-9)
    once = points
    for _ in range(count):
        once = segments.placed(once, 1)
    np.testing.assert_allclose(once, points, atol=1e-9)
    for number, pose in enumerate(segments.poses):
        np.testing.assert_allclose(
            pose.origin + points @ np.stack([pose.x, pose.y, pose.normal]),
            segments.placed(points, number),
            atol=1e-9,
        )


def test_quarters_are_exact():
    placed = Segments(4).placed(np.array([[1.0, 2.0, 3.0]]), 1)
    assert placed.tolist() == [[-2.0, 1.0, 3.0]]


def test_the_seam_between_straight_strips_is_their_distance(design):
    """Along both axes run straight strips upright: twice 100 mm apart, less their twist."""
    seam = seam_of(Segments(4), design)
    points = np.concatenate([_surface(strip) for strip in design.lamellas])
    there = Segments(4).placed(points, 1)
    from scipy.spatial import cKDTree

    brute = cKDTree(there).query(points)[0].min()
    assert seam.distance + PROFILE.thickness == pytest.approx(brute, abs=0.1)
    assert seam.distance + PROFILE.thickness <= brute + 1e-6


def _surface(strip):
    s = np.linspace(strip.start, strip.end, 1500)
    s, z = (a.ravel() for a in np.meshgrid(s, np.linspace(-50.0, 50.0, 11)))
    return strip.place(s, np.zeros_like(s), z)


def test_a_narrow_seam_is_a_warning_and_its_advice_mends_it(design):
    seam = seam_of(Segments(4), design)
    wanted = seam.distance + 20.0
    (finding,) = seam_findings(Segments(4, seam=wanted), seam)
    assert (finding.code, finding.severity) == ("segment-seam", fab.Severity.WARNING)
    assert seam_findings(Segments(4, seam=seam.distance - 0.1), seam) == []
    outwards = float(finding.message.split("move the net ")[1].split(" mm")[0])
    away = np.array([np.sqrt(0.5), -np.sqrt(0.5)]) * (outwards + 0.1)
    moved = Segments(4, centre=tuple(-away))
    assert seam_of(moved, design).distance >= wanted - 0.2


def test_segments_that_reach_into_each_other_name_the_number_that_fits(design):
    with pytest.raises(gs.SettingError, match="reach into each other") as info:
        require_apart(Segments(5), design)
    assert info.value.advice == "count = 4"
    assert "5 segments" in info.value.value
    assert require_apart(Segments(4), design).distance > 0.0
    with pytest.raises(gs.SettingError):
        require_apart(Segments(4), quarter(0.0))


@pytest.mark.parametrize(("count", "seam"), [(1, 0.0), (4, -1.0), (4, np.nan)])
def test_segments_that_cannot_be_are_refused(count, seam):
    with pytest.raises(gs.SettingError) as info:
        Segments(count, seam=seam)
    assert info.value.where.startswith("segments.")


def test_the_hanging_state_is_the_segment_turned_over_not_mirrored(design):
    points = np.array([node.position for node in design.nodes])
    found = hanging(design)
    apart = np.linalg.norm(points[:, None] - points[None], axis=2)
    hung = np.linalg.norm(found[:, None] - found[None], axis=2)
    np.testing.assert_allclose(hung, apart, atol=1e-8)
    assert found[:, 2].min() == 0.0
    some = [0, 3, 7, 12]
    volume = [np.linalg.det(p[some[1:]] - p[some[0]]) for p in (points, found)]
    assert volume[0] == pytest.approx(volume[1], rel=1e-9)
    assert abs(volume[0]) > 1.0
    np.testing.assert_allclose(found[:, 2] + points[:, 2], (found[:, 2] + points[:, 2])[0])


def test_a_copy_that_is_elsewhere_is_measured(design):
    segments = Segments(4)
    points = np.array([node.position for node in design.nodes])
    exact = [(segments.turn(k), np.zeros(3)) for k in range(4)]
    assert largest_difference(segments, exact, points) == 0.0
    exact[2] = (exact[2][0], np.array([0.0, 0.01, 0.0]))
    assert largest_difference(segments, exact, points) == pytest.approx(0.01)
