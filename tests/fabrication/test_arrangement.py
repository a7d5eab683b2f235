from functools import cache
from math import cos, cosh, log, radians, sin

import numpy as np
import pytest

import fabrication as fab
import gridshell as gs
from fabrication.arrangement import LEFT, RIGHT, Lane, arranged

E = 15.0
PAIR = (Lane(LEFT, E), Lane(RIGHT, -E))
R = 4000.0
ANGLES = (45, 60, 75, 90, 120)


def doubled(design, **kwargs):
    return arranged(design, {1: PAIR, 2: PAIR}, **kwargs)


@cache
def oblique(degrees: int) -> fab.Structure:
    """Three twisted lamellas each way at about the angle, on an optimised piece of Enneper's."""
    patch = gs.AsymptoticPatch(p=(-0.4, 0.4), q=(-0.4, 0.4), lamellas=(3, 3))
    start = gs.control_patch(gs.Enneper(R), patch)
    best = gs.optimize(start, gs.a_net(angle=radians(degrees)), anchor=gs.Free()).require()
    profile = fab.Profile(width=100.0, thickness=1.5, material=fab.S235)
    return fab.structure(gs.diagonal_meshes(best.control)[0], profile)


@pytest.fixture(scope="module")
def fine(profile):
    """Nine lamellas each way on an exact catenoid."""
    patch = gs.AsymptoticPatch(p=(-0.5, 0.5), q=(-0.5, 0.5), lamellas=(9, 9))
    return fab.structure(gs.diagonal_meshes(gs.control_patch(gs.Catenoid(R), patch))[0], profile)


def pairs(made):
    """Left strip, right strip and number of the design's lamella."""
    strips = made.strips.lamellas
    assert [strip.mark[-1] for strip in strips] == [LEFT, RIGHT] * (len(strips) // 2)
    return zip(strips[::2], strips[1::2], made.carriers[::2], strict=True)


# ---- lengths -----------------------------------------------------------------------------------


def test_the_two_strips_of_a_catenoid_differ_by_the_turn_of_their_axis(fine):
    """Metric R^2 cosh^2 v (du^2 + dv^2), v = z / R: the turn is the integral of tanh v dv."""
    ends = {node.name: node.position[2] / R for node in fine.nodes}
    for left, right, carrier in pairs(doubled(fine)):
        axis = fine.lamellas[carrier]
        v0, v1 = (ends[fine.nodes[axis.nodes[i]].name] for i in (0, -1))
        turn = log(cosh(v1) / cosh(v0))
        found = left.stations[-1] - right.stations[-1]
        assert abs(found) == pytest.approx(2.0 * E * abs(turn), abs=0.02)


def test_the_outer_of_two_strips_is_the_longer_one(fine):
    """The length of each on the surface's own formula, by many chords of an offset curve."""
    first, last = fine.nodes[fine.lamellas[0].nodes[0]], fine.nodes[fine.lamellas[0].nodes[-1]]
    u = [np.arctan2(node.position[1], node.position[0]) for node in (first, last)]
    v = [node.position[2] / R for node in (first, last)]
    share = np.linspace(0.0, 1.0, 4001)
    u, v = (a + share * (b - a) for a, b in (u, v))
    axis = R * np.stack([np.cosh(v) * np.cos(u), np.cosh(v) * np.sin(u), v], axis=1)
    normal = np.stack([np.cos(u), np.sin(u), -np.sinh(v)], axis=1) / np.cosh(v)[:, None]
    normal *= np.sign(normal[0] @ first.axis)
    tangent = np.gradient(axis, axis=0)
    b = np.cross(normal, tangent / np.linalg.norm(tangent, axis=1)[:, None])
    lengths = [np.linalg.norm(np.diff(axis + y * b, axis=0), axis=1).sum() for y in (E, -E)]
    strips = doubled(fine).strips.lamellas[:2]
    for strip, length in zip(strips, lengths, strict=True):
        assert strip.stations[-1] == pytest.approx(length, abs=0.03)
    assert abs(lengths[0] - lengths[1]) > 3.0


def test_on_a_hypar_strips_beside_straight_axes_differ_by_nothing_but_their_twist(hypar):
    for left, right, _ in pairs(doubled(hypar.structure)):
        assert left.stations[-1] == pytest.approx(right.stations[-1], abs=1e-2)


# ---- crossings ---------------------------------------------------------------------------------


@pytest.mark.parametrize("degrees", ANGLES)
def test_slots_lie_beside_the_node_where_two_pairs_of_parallels_cross(degrees):
    """Own strip a to the left, partner b, turned by w: (a cos w - b) / sin w along the own one."""
    design = oblique(degrees)
    made = doubled(design)
    carriers, lanes = made.carriers, made.lanes
    for node in made.strips.nodes:
        w = signed_angle(design, next(n for n in design.nodes if n.name == node.name[:-2]))
        sides = zip(node.crossings, node.crossings[::-1], (w, -w), strict=True)
        for own, partner, turn in sides:
            strip = made.strips.lamellas[own.lamella]
            base = next(n for n in design.nodes if n.name == node.name[:-2])
            at = next(c.station for c in base.crossings if c.lamella == carriers[own.lamella])
            k = int(np.argmin(np.abs(design.lamellas[carriers[own.lamella]].stations - at)))
            a, b = lanes[own.lamella].across, lanes[partner.lamella].across
            expected = (a * cos(turn) - b) / sin(turn)
            assert own.station - strip.stations[k] == pytest.approx(expected, abs=0.35)


def signed_angle(design, node):
    a, b = (
        design.lamellas[c.lamella].axis.tangents(np.array([c.station]))[0] for c in node.crossings
    )
    return np.arctan2(np.cross(a, b) @ node.axis, a @ b)


@pytest.mark.parametrize("degrees", ANGLES)
def test_curves_of_a_pair_meet_and_both_strips_hold_the_axis_there(degrees):
    made = doubled(oblique(degrees))
    assert made.miss.max() < 0.05
    closes(made)


def closes(made, limit=0.02):
    """Both strips come to lie at the node, over their whole width."""
    for node in made.strips.nodes:
        for crossing in node.crossings if node.regular else ():
            strip = made.strips.lamellas[crossing.lamella]
            for z in (-50.0, 0.0, 50.0):
                (placed,) = strip.place(np.array([crossing.station]), np.zeros(1), np.array([z]))
                assert np.linalg.norm(placed - node.position - z * node.axis) < limit


@pytest.mark.parametrize("name", ["catenoid", "hypar", "ring", "tube", "saddle"])
def test_every_regular_node_is_four_crossings(name, request):
    design = request.getfixturevalue(name).structure
    made = doubled(design)
    regular = [node for node in design.nodes if node.regular]
    names = [node.name for node in made.strips.nodes if node.regular]
    assert sorted(names) == sorted(
        node.name + a + b for node in regular for a in (LEFT, RIGHT) for b in (LEFT, RIGHT)
    )
    assert len(made.strips.nodes) == len(design.nodes) + 3 * len(regular)
    assert len(made.miss) == 4 * len(regular)


def test_closed_lamellas_get_two_closed_strips_with_the_same_seam(tube):
    made = doubled(tube.structure)
    seen = 0
    for left, right, carrier in pairs(made):
        if tube.structure.lamellas[carrier].closed:
            seen += 1
            for strip in (left, right):
                assert strip.closed
                assert strip.axis.length - strip.length == pytest.approx(1.0, abs=1e-6)
                turned = strip.place(np.array([0.0, strip.axis.length]), np.zeros(2), np.zeros(2))
                np.testing.assert_allclose(turned[0], turned[1], atol=1e-6)
    assert seen > 0


def test_two_levels_keep_the_nodes_of_the_design_with_all_strips(enneper):
    design = enneper.structure
    levels = {1: (Lane("", 0.0, 60.0),), 2: (Lane("", 0.0, -60.0),)}
    made = arranged(design, levels, crossing=False)
    assert [node.name for node in made.strips.nodes] == [node.name for node in design.nodes]
    for node in made.strips.nodes:
        for crossing in node.crossings:
            strip = made.strips.lamellas[crossing.lamella]
            (placed,) = strip.place(np.array([crossing.station]), np.zeros(1), np.zeros(1))
            high = 60.0 if strip.family == 1 else -60.0
            np.testing.assert_allclose(placed, node.position + high * node.axis, atol=0.01)


def test_a_lane_on_the_axis_is_the_lamella_itself(enneper):
    made = arranged(enneper.structure, {1: (Lane(),), 2: (Lane(),)})
    for strip, lamella in zip(made.strips.lamellas, enneper.structure.lamellas, strict=True):
        assert strip.mark == lamella.mark
        assert strip.length == lamella.length
    assert made.miss.max() < 1e-9


@pytest.mark.parametrize("name", ["catenoid", "hypar", "ring", "tube"])
def test_strips_beside_an_axis_twist_as_fast_as_it(name, request):
    design = request.getfixturevalue(name).structure
    for left, right, carrier in pairs(doubled(design)):
        axis = design.lamellas[carrier]
        inside = np.linspace(0.1, 0.9, 50)
        own = np.abs(axis.twist(inside * axis.stations[-1])).max()
        for strip in (left, right):
            found = np.abs(strip.twist(inside * strip.stations[-1])).max()
            assert found == pytest.approx(own, rel=0.15, abs=2e-5)


@pytest.mark.parametrize("name", ["catenoid", "enneper", "hypar", "ring"])
def test_strips_lie_in_their_nodes_on_the_other_nets_too(name, request):
    closes(doubled(request.getfixturevalue(name).structure))
