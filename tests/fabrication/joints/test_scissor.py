from functools import cache
from math import degrees, pi, radians, sin, tan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

import fabrication as fab
import gridshell as gs
from fabrication.fitting import fit

T = 2.5


@cache
def oblique(angle: int) -> fab.Structure:
    """Three twisted lamellas each way at about the angle, on an optimised piece of Enneper's."""
    patch = gs.AsymptoticPatch(p=(-0.4, 0.4), q=(-0.4, 0.4), lamellas=(3, 3))
    start = gs.control_patch(gs.Enneper(4000.0), patch)
    best = gs.optimize(start, gs.a_net(angle=radians(angle)), anchor=gs.Free()).require()
    profile = fab.Profile(width=100.0, thickness=T, material=fab.S235)
    return fab.structure(gs.diagonal_meshes(best.control)[0], profile)


def slots(jointed):
    return [slot for cuts in jointed.cuts.values() for slot in cuts.slots]


def flat_reach(angle, thickness):
    """Along one flat strip, what another of its thickness covers: corners of their overlap."""
    own = np.array([[1.0, 0.0], [0.0, 1.0]])
    partner = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    corners = [
        np.linalg.solve(np.array([own[1], partner[1]]), thickness / 2.0 * np.array([i, j]))[0]
        for i in (-1.0, 1.0)
        for j in (-1.0, 1.0)
    ]
    return max(corners) - min(corners)


@pytest.mark.parametrize("angle", [45, 60, 75, 90, 120])
@pytest.mark.parametrize("opens", [30, 45, 70])
def test_slots_pass_every_angle_of_the_sweep_and_the_sharpest_fills_them(angle, opens):
    """The overlap of two flat strips, step by step from closed to closed the other way."""
    design = oblique(angle)
    built, tight = (
        slots(joint.build(design))
        for joint in (
            fab.SlotJoint(clearance=0.0),
            fab.ScissorJoint(opens_from=radians(opens), clearance=0.0),
        )
    )
    swept = max(flat_reach(a, T) for a in np.linspace(radians(opens), pi - radians(opens), 181))
    for own, slot in zip(built, tight, strict=True):
        assert slot.width == pytest.approx(max(swept, own.width), abs=1e-9)


@pytest.mark.parametrize("angle", [45, 60, 75, 90, 120])
def test_scissor_slots_are_never_narrower_than_slots_that_fit(angle):
    design = oblique(angle)
    fitted = slots(fab.SlotJoint().build(design))
    loose = slots(fab.ScissorJoint().build(design))
    assert all(b.width >= a.width for a, b in zip(fitted, loose, strict=True))
    jointed = fab.ScissorJoint().build(design)
    assert fit(jointed.strips, fab.parts_of(jointed)).max_mm3 == 0.0


@given(st.floats(20.0, 90.0), st.floats(0.0, 0.5))
def test_the_play_is_where_flat_strips_fill_the_slot(opens, clearance):
    design = oblique(90)
    jointed = fab.ScissorJoint(opens_from=radians(opens), clearance=clearance).build(design)
    plays = fab.angle_play(jointed)
    assert set(plays) == {node.name for node in design.nodes if node.regular}
    for name, play in list(plays.items())[:2]:
        width = min(slot.width for slot in slots(jointed) if slot.node == name)
        sharpest = brentq(lambda a, w=width: flat_reach(a, T) - w, 1e-3, pi / 2.0 + 1e-9)
        assert play.angle - play.sharper == pytest.approx(sharpest, abs=1e-6)
        assert play.angle + play.blunter == pytest.approx(pi - sharpest, abs=1e-6)


def test_a_tight_slot_at_sixty_degrees_does_not_close_but_still_opens():
    jointed = fab.ScissorJoint(opens_from=pi / 2.0, clearance=0.0).build(oblique(60))
    for play in fab.angle_play(jointed).values():
        assert 0.0 <= degrees(play.sharper) < 1.0
        assert degrees(play.blunter) > 50.0


def test_play_is_told_for_the_loosest_node_with_the_others_counted():
    design = oblique(90)
    calm = fab.ScissorJoint(opens_from=radians(85.0), clearance=0.0).build(design)
    (found,) = calm.findings
    assert (found.code, found.severity) == ("angle-play", fab.Severity.INFO)
    wild = fab.ScissorJoint(opens_from=radians(40.0)).build(design)
    (found,) = wild.findings
    plays = fab.angle_play(wild)
    assert (found.code, found.severity) == ("angle-play", fab.Severity.WARNING)
    assert found.value == pytest.approx(degrees(max(p.sharper for p in plays.values())))
    assert found.value == pytest.approx(degrees(plays[found.where].sharper))
    assert found.value > 50.0
    assert f"{len(plays)} of {len(plays)} nodes" in found.message


def test_a_slot_wider_than_the_web_is_an_error_and_the_advised_angle_works():
    design = oblique(90)
    joint = fab.ScissorJoint(opens_from=radians(5.0))
    found = [f for f in joint.build(design).findings if f.code == "wide-slot"]
    (one,) = found
    assert one.severity is fab.Severity.ERROR
    assert one.value > one.limit == pytest.approx(49.5)
    advised = int(one.message.split("from ")[1].split(" degrees")[0])
    assert T / tan(radians(advised) / 2.0) <= 49.2
    better = fab.ScissorJoint(opens_from=radians(advised + 1)).build(design)
    assert "wide-slot" not in {f.code for f in better.findings}


@pytest.mark.parametrize("name", ["ring", "tube", "saddle"])
def test_rings_and_singular_nodes_have_slots_where_two_cross(name, request):
    design = request.getfixturevalue(name).structure
    jointed = fab.ScissorJoint(opens_from=radians(60.0)).build(design)
    regular = sum(node.regular for node in design.nodes)
    assert len(slots(jointed)) == 2 * regular == 2 * len(fab.angle_play(jointed))
    singular = sum(len(node.crossings) > 2 for node in design.nodes)
    assert sum(f.code == "singular-node" for f in jointed.findings) == singular


@given(st.one_of(st.floats(max_value=0.0), st.floats(min_value=1.58), st.just(float("nan"))))
def test_an_angle_that_is_none_is_refused(angle):
    with pytest.raises(gs.SettingError) as info:
        fab.ScissorJoint(opens_from=angle)
    assert info.value.where == "opens_from"


@pytest.mark.parametrize("key", ["clearance", "depth_clearance", "control"])
@given(value=st.one_of(st.floats(max_value=-1e-9), st.just(float("nan"))))
def test_negative_clearances_are_refused(key, value):
    with pytest.raises(gs.SettingError) as info:
        fab.ScissorJoint(**{key: value})
    assert info.value.where == key


def test_the_search_knows_flat_strips():
    assert flat_reach(radians(60.0), T) == pytest.approx(
        T / sin(radians(60.0)) + T / tan(radians(60.0))
    )
