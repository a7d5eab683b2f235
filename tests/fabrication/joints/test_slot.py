from dataclasses import dataclass, replace
from math import cos, degrees, radians, sin, tan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import fabrication as fab
import gridshell as gs
from fabrication.cut import Edge
from fabrication.joints import slot_width

T = 2.5


def flat_width(angle, own=T, partner=T):
    """Drawn width of a slot between flat strips: t2 / sin a + t1 / |tan a|."""
    return partner / sin(angle) + own / abs(tan(angle))


def width(angle, *, own_twist=0.0, partner_twist=0.0, own=T, partner=T, heights=0.0):
    return slot_width(
        angle=angle,
        own_twist=own_twist,
        partner_twist=partner_twist,
        own_thickness=own,
        partner_thickness=partner,
        heights=np.asarray(heights, dtype=float),
    )


# ---- without twist --------------------------------------------------------------------------


@pytest.mark.parametrize(("angle", "ratio"), [(90, 1.00), (75, 1.30), (60, 1.73), (45, 2.41)])
def test_flat_strips_fill_so_many_thicknesses(angle, ratio):
    assert width(radians(angle)) / T == pytest.approx(ratio, abs=5e-3)


@given(st.floats(0.2, 2.9), st.floats(0.5, 10.0), st.floats(0.5, 10.0), st.floats(-50.0, 50.0))
def test_flat_strips_fill_the_same_width_at_every_height(angle, own, partner, height):
    found = width(angle, own=own, partner=partner, heights=height)
    assert found == pytest.approx(flat_width(angle, own, partner), rel=1e-9)


@given(st.floats(0.2, 2.9))
def test_flat_strips_fill_as_much_from_the_other_side(angle):
    assert width(-angle) == pytest.approx(float(width(angle)), rel=1e-12)


# ---- with twist, against a brute-force search -----------------------------------------------


@dataclass(frozen=True)
class Helicoid:
    """A straight strip through the origin, turning at a constant rate; the node axis is z."""

    tangent: np.ndarray
    rate: float

    def rulings(self, s):
        upright = np.array([0.0, 0.0, 1.0])
        across = np.cross(upright, self.tangent)
        turn = (self.rate * s)[..., None]
        n = np.cos(turn) * upright + np.sin(turn) * across
        return n, np.cross(n, self.tangent)

    def place(self, s, y, z):
        n, b = self.rulings(s)
        return s[..., None] * self.tangent + y[..., None] * b + z * n

    def across(self, points):
        """Distance of points from the middle surface, along the thickness."""
        _, b = self.rulings(points @ self.tangent)
        return np.einsum("...c,...c->...", points, b)


def brute_width(angle, own_twist, partner_twist, own, partner, height):
    """Length along the own strip that touches the partner's material, by bisection.

    Rays along s through the own strip's thickness, from the node outwards, until they leave the
    partner for good; the slot is centred on the node, so the farther side counts twice.
    """
    strip = Helicoid(np.array([1.0, 0.0, 0.0]), own_twist)
    other = Helicoid(np.array([cos(angle), sin(angle), 0.0]), partner_twist)
    direction, y = np.meshgrid([-1.0, 1.0], np.linspace(-own / 2.0, own / 2.0, 9))
    inside, outside = np.zeros_like(y), np.full_like(y, 40.0 * T)
    sense = np.sign(other.across(strip.place(direction * outside, y, height)))
    for _ in range(30):
        middle = (inside + outside) / 2.0
        side = sense * other.across(strip.place(direction * middle, y, height))
        within = side <= partner / 2.0
        inside, outside = np.where(within, middle, inside), np.where(within, outside, middle)
    return 2.0 * inside.max()


RATE = 0.25e-3
TWISTS = [(RATE, -RATE), (-RATE, RATE), (RATE, -0.4 * RATE), (RATE, RATE), (0.0, RATE)]


@pytest.mark.parametrize("angle", [90.0, 75.0, 60.0, 45.0, 120.0, -60.0, -105.0])
@pytest.mark.parametrize("twists", TWISTS)
def test_twisted_strips_fill_what_a_search_through_both_solids_finds(angle, twists):
    for height in (-50.0, -20.0, 0.0, 50.0):
        case = (radians(angle), *twists, T, T)
        found = width(case[0], own_twist=twists[0], partner_twist=twists[1], heights=height)
        assert found == pytest.approx(brute_width(*case, height), abs=1e-3)


def test_unequal_thicknesses_are_found_by_the_search_too():
    found = width(
        radians(60), own_twist=RATE, partner_twist=-RATE, own=2.0, partner=6.0, heights=40
    )
    assert found == pytest.approx(brute_width(radians(60), RATE, -RATE, 2.0, 6.0, 40.0), abs=1e-3)


def test_a_twist_of_a_quarter_radian_per_metre_needs_a_thirtieth_of_a_millimetre():
    found = width(radians(90), own_twist=RATE, partner_twist=-RATE, heights=50.0)
    assert found == pytest.approx(2.5314, abs=5e-4)


# ---- the joint ------------------------------------------------------------------------------


@pytest.mark.parametrize("key", ["clearance", "depth_clearance"])
@pytest.mark.parametrize("value", [-0.01, np.nan, np.inf])
def test_a_negative_clearance_is_refused(key, value):
    with pytest.raises(gs.SettingError, match="cannot be negative") as info:
        fab.SlotJoint(**{key: value})
    assert info.value.where == key


@pytest.mark.parametrize("depth", [50.0, 60.0])
def test_slots_that_cut_the_strips_through_are_refused(hypar, depth):
    with pytest.raises(gs.SettingError, match="cut the strips through") as info:
        fab.SlotJoint(depth_clearance=depth).build(hypar.structure)
    assert (info.value.where, info.value.value) == ("depth_clearance", f"{depth:g} mm")
    assert "50 mm" in info.value.limit


def test_slots_that_leave_a_thread_are_cut(hypar):
    assert drawn(hypar, fab.SlotJoint(depth_clearance=49.99))


def drawn(design, joint):
    return {
        (mark, slot.node): slot
        for mark, cuts in joint.build(design.structure).cuts.items()
        for slot in cuts.slots
    }


def test_hypar_slots_hold_the_widest_height_of_the_search(hypar):
    """Angle and twist from the surface's own formula, not from the lamellas."""
    surface, h, deeper = gs.Hypar(6000.0), 100.0, 0.5
    slots = drawn(hypar, fab.SlotJoint(clearance=0.0, depth_clearance=deeper))
    for node in hypar.structure.nodes:
        x, y, _ = node.position / surface.scale
        rate = 1.0 / (surface.scale * (1.0 + x * x + y * y))
        for own, partner in (node.crossings, node.crossings[::-1]):
            a, b = (hypar.structure.lamellas[c.lamella] for c in (own, partner))
            t1, t2 = (one.axis.tangents(np.zeros(1))[0] for one in (a, b))
            angle = np.arctan2(np.cross(t1, t2) @ node.axis, t1 @ t2)
            w1, w2 = (np.sign(one.twist(np.zeros(1))[0]) * rate for one in (a, b))
            heights = (-deeper, h / 4.0, h / 2.0) if a.family == 1 else (deeper, -h / 4.0, -h / 2.0)
            widest = max(brute_width(angle, w1, w2, T, T, z) for z in heights)
            assert slots[a.mark, node.name].width == pytest.approx(widest, abs=2e-3)


@pytest.mark.parametrize("name", ["catenoid", "enneper", "hypar"])
def test_the_clearance_is_added_to_every_slot(name, request):
    design = request.getfixturevalue(name)
    tight, loose = (drawn(design, fab.SlotJoint(clearance=c)) for c in (0.0, 0.25))
    for key, slot in tight.items():
        assert loose[key].width == pytest.approx(slot.width + 0.25, abs=1e-12)


def test_no_slot_is_narrower_than_flat_strips_at_its_angle(enneper):
    angles = {node.name: node.angle for node in enneper.structure.nodes}
    for (_, node), slot in drawn(enneper, fab.SlotJoint(clearance=0.0)).items():
        assert slot.width >= flat_width(angles[node]) - 1e-9


@pytest.mark.parametrize("name", ["catenoid", "enneper", "tube"])
def test_the_families_are_slotted_from_opposite_edges(name, request):
    design = request.getfixturevalue(name)
    edges = {1: Edge.UPPER, 2: Edge.LOWER}
    for lamella, part in zip(design.structure.lamellas, design.parts, strict=True):
        assert {slot.edge for slot in part.slots} == {edges[lamella.family]}


def test_a_slot_is_as_deep_as_half_the_width_and_the_depth_clearance(enneper, profile):
    slots = drawn(enneper, fab.SlotJoint(depth_clearance=0.7))
    assert {slot.depth for slot in slots.values()} == {profile.width / 2.0 + 0.7}


@pytest.mark.parametrize("name", ["catenoid", "enneper", "ring", "tube", "saddle"])
def test_every_regular_node_is_one_slot_in_either_lamella(name, request):
    design = request.getfixturevalue(name)
    lamellas = design.structure.lamellas
    expected = {
        (lamellas[own.lamella].mark, node.name, lamellas[partner.lamella].mark)
        for node in design.structure.nodes
        if node.regular
        for own, partner in (node.crossings, node.crossings[::-1])
    }
    slots = [(part.mark, slot.node, slot.partner) for part in design.parts for slot in part.slots]
    assert len(slots) == len(expected)
    assert set(slots) == expected


def test_slots_sit_at_the_stations_of_their_nodes(enneper):
    for lamella, part in zip(enneper.structure.lamellas, enneper.parts, strict=True):
        centres = [slot.x for slot in part.slots]
        np.testing.assert_allclose(centres, lamella.stations - lamella.start, atol=1e-9)


def test_a_good_net_gives_no_findings(enneper):
    assert fab.SlotJoint().build(enneper.structure).findings == ()


def test_a_sharp_angle_is_an_error_at_its_node(hypar):
    nodes = hypar.structure.nodes
    angles = [radians(14.9), radians(15.1), np.pi - radians(14.9), np.pi - radians(15.1)]
    bent = [replace(node, angle=a) for node, a in zip(nodes, angles, strict=False)]
    structure = replace(hypar.structure, nodes=(*bent, *nodes[len(angles) :]))
    found = fab.SlotJoint().build(structure).findings
    assert [f.code for f in found] == ["sharp-angle"] * 2
    assert [f.where for f in found] == [nodes[0].name, nodes[2].name]
    assert [f.severity for f in found] == [fab.Severity.ERROR] * 2
    assert [f.value for f in found] == pytest.approx([14.9, degrees(np.pi - radians(14.9))])
    assert [f.limit for f in found] == pytest.approx([15.0, 15.0])


def test_signs_of_twist_are_those_of_the_frames():
    """The search turns its rulings as lamellas do: dn/ds . b is the rate of twist."""
    strip, step = Helicoid(np.array([1.0, 0.0, 0.0]), RATE), 1e-3
    (before, after), _ = strip.rulings(np.array([-step, step]))
    _, b = strip.rulings(np.zeros(1))
    assert (after - before) @ b[0] / (2.0 * step) == pytest.approx(RATE, rel=1e-6)


def test_every_joint_is_reached_by_its_name():
    assert fab.JOINTS["slot"] is fab.SlotJoint
    assert all(issubclass(joint, fab.Joint) for joint in fab.JOINTS.values())
