"""Hinges between tubes: what is drilled, what goes through, and that it all fits and closes."""

from dataclasses import replace
from math import asin, radians

import numpy as np
import pytest

import fabrication as fab
import gridshell as gs
from fabrication.fitting import clash_volumes
from fabrication.jointed import Feature

TUBE = fab.HollowProfile(40.0, 14.0, fab.GRP, 2.0)
JOINT = fab.HingedJoint(6.0)


@pytest.fixture(scope="module")
def design():
    position = gs.Umbrella(10, 1200.0, (700.0, 650.0, 700.0, 600.0)).position(0.4)
    return fab.structure(gs.diagonal_meshes(position.control())[0], TUBE)


@pytest.fixture(scope="module")
def jointed(design):
    return JOINT.build(design)


@pytest.fixture(scope="module")
def parts(jointed):
    return fab.parts_of(jointed)


def test_every_tube_is_drilled_at_every_node_it_passes(design, jointed):
    for strip in jointed.strips.lamellas:
        drills = jointed.cuts[strip.mark].drills
        assert len(drills) == len(strip.nodes)
        assert [d.x for d in drills] == sorted(d.x for d in drills)
        assert {d.diameter for d in drills} == {6.3}
    assert sum(f.feature is Feature.DRILL for f in jointed.fixtures) == 2 * len(design.nodes)


def test_the_middle_of_every_drill_is_engraved_at_both_edges(parts):
    for part in parts:
        ticks = sorted((label.x, label.y) for label in part.labels if label.text == "|")
        assert [x for x, _ in ticks] == [drill.x for drill in part.drills for _ in range(2)]
        assert all(0.0 < min(y, TUBE.width - y) <= 5.0 for _, y in ticks)


def test_the_own_mark_of_a_tube_keeps_off_its_partners(parts):
    for part in parts:
        own, *others = part.labels
        reach = own.height * len(own.text) / 2.0
        assert own.text == part.mark
        assert min(abs(label.x - own.x) for label in others) > reach + others[0].height / 2.0


def test_the_two_tubes_of_a_node_lie_on_two_levels_with_the_gap_between(design, jointed):
    places = {}
    for fixture in jointed.fixtures:
        places.setdefault(fixture.node, []).append(fixture.position)
    for node in design.nodes:
        upper, lower = places[node.name]
        apart = upper - lower
        assert np.linalg.norm(apart) == pytest.approx(40.0 + 4.0)
        np.testing.assert_allclose(np.cross(apart, node.axis), 0.0, atol=1e-9)


def test_pins_nuts_and_spacers_are_listed_and_there(design, jointed):
    count = len(design.nodes)
    made = {kind.name: len(kind.bodies) for kind in jointed.connectors}
    assert made == {"bolts": count, "heads and nuts": 2 * count, "spacers": count}
    assert {line.item: line.quantity for line in jointed.bill} == {
        "pin": count,
        "nut": count,
        "spacer": count,
    }


def test_nothing_clashes_and_larger_pins_or_spacers_do(jointed, parts):
    clashes = clash_volumes(jointed.strips, parts, jointed.connectors)
    assert len(clashes) == len(jointed.design.nodes)
    assert max(clashes.values()) < 1e-3
    tight = tuple(
        replace(part, drills=tuple(replace(d, diameter=5.8) for d in part.drills)) for part in parts
    )
    found = clash_volumes(jointed.strips, tight, jointed.connectors)
    assert min(found.values()) > 1.0
    close = fab.HingedJoint(6.0, gap=4.0)
    crowded = close.build(jointed.design)
    kinds = [kind for kind in crowded.connectors if kind.name == "spacers"]
    thick = tuple(
        replace(k, shapes=tuple(replace(s, low=s.low - 0.2, high=s.high + 0.2) for s in k.shapes))
        for k in kinds
    )
    assert min(clash_volumes(crowded.strips, parts, thick).values()) > 0.1


def test_tubes_of_one_level_touch_where_their_bays_are_shortest(design):
    room = max(14.0, 2.0 * 1.6 / np.sqrt(3.0) * 6.0)
    shortest = min(float(np.diff(strip.stations).min()) for strip in design.lamellas)
    assert JOINT.folded(design) == pytest.approx(asin(room / shortest))
    assert not [f for f in JOINT.build(design).findings if f.code == "hinge-fold"]


def test_a_net_that_is_folded_further_is_an_error(design):
    wide = replace(design, profile=fab.HollowProfile(600.0, 560.0, fab.GRP, 4.0))
    codes = {f.code for f in JOINT.build(wide).findings}
    assert "hinge-fold" in codes


def test_a_pin_at_the_very_end_is_an_error(design):
    short = replace(
        design,
        lamellas=tuple(
            replace(strip, start=strip.stations[0] - 3.0, end=strip.stations[-1] + 3.0)
            for strip in design.lamellas
        ),
    )
    found = [f for f in JOINT.build(short).findings if f.code == "hinge-at-end"]
    assert len(found) == 2 * len(design.lamellas)
    assert all(f.value == pytest.approx(3.0, abs=0.5) for f in found)


def test_a_gap_that_twist_takes_up_is_an_error(design):
    (finding,) = fab.HingedJoint(6.0, gap=0.1).build(design).findings
    assert finding.code == "hinge-gap"
    wider = fab.HingedJoint(6.0, gap=finding.limit + 0.05).build(design).findings
    assert wider == ()


def test_solid_strips_have_no_hinges(design):
    solid = replace(design, profile=fab.Profile(40.0, 4.0, fab.GRP))
    with pytest.raises(gs.SettingError, match="need hollow sections") as info:
        JOINT.build(solid)
    assert info.value.where == "profile.wall"


@pytest.mark.parametrize("joint", [fab.SlotJoint(), fab.ReciprocalJoint(gap=1.0)])
def test_other_joints_do_not_go_with_tubes(design, joint):
    with pytest.raises(gs.SettingError, match="does not go with the section"):
        fab.flat_parts(design, joint)


def test_a_pin_goes_between_the_walls(design):
    with pytest.raises(gs.SettingError, match="between the walls") as info:
        fab.HingedJoint(10.0).build(design)
    assert fab.HingedJoint(float(info.value.advice.split()[0])).build(design).bill


@pytest.mark.parametrize(("key", "value"), [("pin", 0.0), ("gap", 0.0), ("play", -0.1)])
def test_sizes_that_cannot_be_are_refused(key, value):
    with pytest.raises(gs.SettingError) as info:
        fab.HingedJoint(**{"pin": 6.0, key: value})
    assert info.value.where == key


def write(jointed, parts, path):
    made = fab.solids(jointed.strips, parts)
    fab.write_step(fab.assembly(made, jointed.strips, name="umbrella"), path)


def test_the_files_close_onto_the_design(jointed, parts, tmp_path):
    stock = fab.Sheet(6000.0, 1500.0)
    sheets = fab.write_dxf(fab.nest(parts, stock), tmp_path / "sheets")
    step = tmp_path / "s.step"
    write(jointed, parts, step)
    found = fab.closure(replace(jointed, connectors=()), parts, sheets, step)
    assert found.holes == 2 * len(jointed.design.nodes)
    assert found.max_mm < 1e-3
    assert found.volume_ppm < 1.0


def test_a_tube_drilled_elsewhere_is_noticed(jointed, parts, tmp_path):
    """One drill of one tube a tenth of a millimetre along."""
    first, *others = parts
    drill, *more = first.drills
    moved = replace(first, drills=(replace(drill, x=drill.x + 0.1), *more))
    sheets = fab.write_dxf(fab.nest(parts, fab.Sheet(6000.0, 1500.0)), tmp_path / "sheets")
    step = tmp_path / "s.step"
    write(jointed, [moved, *others], step)
    found = fab.closure(replace(jointed, connectors=()), parts, sheets, step)
    assert found.max_mm == pytest.approx(0.1, abs=1e-3)
    assert found.worst == f"{first.mark} at {drill.node}"


def test_angles_of_the_motion_end_where_the_hinges_fold(design):
    assert 0.0 < JOINT.folded(design) < radians(5.0)
