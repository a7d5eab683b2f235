from dataclasses import replace
from itertools import pairwise
from math import sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

import fabrication as fab
import gridshell as gs
from fabrication.arrangement import Lane, arranged
from fabrication.joints.double_slot import DoubleSlotJoint, StarWasher
from fabrication.lamella import piece_of
from fabrication.net_sections import net_sections
from fabrication.parts import parts_of
from fabrication.strength import bay_stress, section_stress
from fabrication.structures import Structure

RADIUS = 4000.0
"""Of the catenoid's waist: twist sech(v)^2 / R and geodesic curvature tanh(v) sech(v) / (sqrt(2) R)
along its asymptotic curves, normal curvature nought."""

SHARPEST, FASTEST = 1.0 / (2.0 * sqrt(2.0) * RADIUS), 1.0 / RADIUS


def at(weak, strong, twist, *, width=100.0, thickness=2.5, material=fab.STAINLESS):
    rates = (np.array([float(value)]) for value in (weak, strong, twist))
    figures = section_stress(*rates, width=width, thickness=thickness, material=material)
    return {key: float(values[0]) for key, values in figures.items()}


# ---- the section ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("width", "thickness", "material", "wanted"),
    [
        (100.0, 1.5, fab.S235, 58.0),
        (100.0, 2.5, fab.STAINLESS, 89.0),
        (60.0, 4.0, replace(fab.BIRCH_PLY, shear_modulus=None, shear_strength=None), 7.0),
    ],
)
def test_the_built_cases_see_what_was_worked_out_for_them(width, thickness, material, wanted):
    """The sharpest bend and the fastest twist of a catenoid of 4 m, together."""
    found = at(SHARPEST, 0.0, FASTEST, width=width, thickness=thickness, material=material)
    assert found["von_mises_edge"] == pytest.approx(wanted, abs=0.5)


def test_a_twisted_strip_stretches_as_its_fibres_say():
    """Fibres on helices, of a strip as long as makes nothing pull along it; no formula of ours."""
    rate, width, e = 0.5e-3, 100.0, fab.STAINLESS.modulus

    def strain(z, shortening):
        length = quad(lambda s: sqrt((1.0 - shortening) ** 2 + (rate * z) ** 2), 0.0, 1.0)[0]
        return length - 1.0

    def pull(shortening):
        return quad(lambda z: strain(z, shortening), -width / 2.0, width / 2.0)[0]

    low, high = 0.0, 1e-2
    for _ in range(60):
        middle = (low + high) / 2.0
        low, high = (middle, high) if pull(middle) > 0.0 else (low, middle)
    found = at(0.0, 0.0, rate, width=width)
    assert found["helix_edge"] == pytest.approx(e * strain(width / 2.0, low), rel=1e-3)
    assert found["helix_mid"] == pytest.approx(-e * strain(0.0, low), rel=1e-3)
    assert low == pytest.approx(rate**2 * width**2 / 24.0, rel=1e-3)
    assert found["edge_strain"] == pytest.approx(strain(width / 2.0, 0.0), rel=1e-3)


def test_the_moment_of_the_helix_stress_is_that_of_its_energy():
    """E t h^5 / 360 rate^3: what the stress turns about the axis, each fibre pulling at rate z."""
    rate, h, t, e = 0.4e-3, 100.0, 2.5, 200e3

    def pull(z):
        return e * rate**2 / 2.0 * (z**2 - h**2 / 12.0) * t * rate * z**2

    assert quad(pull, -h / 2, h / 2)[0] == pytest.approx(e * t * h**5 / 360.0 * rate**3)
    edge = at(0.0, 0.0, rate)["helix_edge"]
    assert edge == pytest.approx(e * rate**2 / 2.0 * (h**2 / 4.0 - h**2 / 12.0))


@pytest.mark.parametrize(("width", "thickness", "over"), [(100.0, 2.5, 1e-9), (30.0, 10.0, 0.02)])
def test_shear_by_twist_is_the_exact_one_of_a_rectangle(width, thickness, over):
    """Saint-Venant's series for the middle of the long side; a strip of a third errs safely."""
    rate, g, n = 3e-4, fab.STAINLESS.rigidity, np.arange(1, 60, 2)
    decay = 1.0 / np.cosh(np.minimum(n * np.pi * width / (2.0 * thickness), 700.0))
    exact = g * rate * thickness * (1.0 - 8.0 / np.pi**2 * (decay / n**2).sum())
    found = at(0.0, 0.0, rate, width=width, thickness=thickness)["shear"]
    assert exact <= found * (1.0 + 1e-12)
    assert found == pytest.approx(exact, rel=over)


RATES = st.floats(0.0, 1e-3)


@given(RATES, RATES.map(lambda k: k / 20.0), RATES, st.sampled_from([-1.0, 1.0]))
def test_no_place_of_the_section_sees_more_than_its_worse_edge(weak, strong, twist, sign):
    material, h, t = fab.STAINLESS, 100.0, 2.5
    z, y = np.meshgrid(np.linspace(-h / 2, h / 2, 501), np.linspace(-t / 2, t / 2, 11))
    e = material.modulus
    along = e * (y * weak + sign * z * strong + twist**2 / 2.0 * (z**2 - h**2 / 12.0))
    shear = 2.0 * material.rigidity * y * twist
    worst = np.sqrt(along**2 + 3.0 * shear**2).max()
    found = at(weak, strong, twist)
    assert found["von_mises_edge"] == pytest.approx(worst, rel=1e-9, abs=1e-9)
    assert found["von_mises_mid"] <= found["von_mises_edge"] + 1e-9
    assert found["utilisation"] == pytest.approx(worst / material.strength, rel=1e-9, abs=1e-12)


@given(RATES, RATES.map(lambda k: k / 20.0), RATES, st.sampled_from([fab.GRP, fab.STAINLESS]))
def test_a_strip_as_thick_as_passes_is_used_up(weak, strong, twist, material):
    thickest = at(weak, strong, twist, material=material)["thickest"]
    if 1e-6 < thickest < 1e6:
        used = at(weak, strong, twist, thickness=thickest, material=material)["utilisation"]
        assert used == pytest.approx(1.0, rel=1e-6)
    elif thickest == 0.0:
        thin = at(weak, strong, twist, thickness=1e-9, material=material)["utilisation"]
        assert thin >= 1.0 - 1e-9
    else:
        assert thickest == np.inf or weak + twist < 1e-6 or thickest <= 1e-6


@given(RATES, RATES.map(lambda k: k / 20.0), RATES)
def test_a_strip_as_wide_as_passes_is_used_up(weak, strong, twist):
    widest = at(weak, strong, twist)["widest"]
    if 1e-3 < widest < 1e7:
        assert at(weak, strong, twist, width=widest)["utilisation"] == pytest.approx(1.0, rel=1e-6)
    elif widest == 0.0:
        assert at(weak, strong, twist, width=1e-6)["utilisation"] >= 1.0 - 1e-9


def test_a_straight_flat_strip_bears_any_size():
    found = at(0.0, 0.0, 0.0)
    assert (found["thickest"], found["widest"], found["radius"]) == (np.inf, np.inf, np.inf)
    assert found["utilisation"] == 0.0


def test_a_strip_stretched_beyond_its_strength_by_its_width_is_mended_by_no_thickness():
    found = at(0.0, 0.0, 0.5e-3, width=400.0)
    assert found["helix_edge"] > fab.STAINLESS.strength
    assert found["thickest"] == 0.0
    assert 0.0 < found["widest"] < 400.0


def test_plywood_is_judged_by_its_own_shear_strength():
    rate = fab.BIRCH_PLY.shear_limit / (fab.BIRCH_PLY.rigidity * 4.0)
    found = at(0.0, 0.0, rate, width=1e-3, thickness=4.0, material=fab.BIRCH_PLY)
    assert found["utilisation"] == pytest.approx(1.0)
    assert found["von_mises_edge"] == pytest.approx(9.0 * sqrt(3.0))


# ---- the bays -------------------------------------------------------------------------------


def test_every_bay_of_a_catenoid_bends_and_twists_as_the_surface_does(catenoid):
    stress = bay_stress(catenoid.structure, catenoid.parts)
    assert len(stress) == sum(len(one.nodes) - 1 for one in catenoid.structure.lamellas)
    for bay in range(len(stress)):
        lamella = catenoid.structure.lamellas[stress.strip[bay]]
        ends = lamella.axis.spline(np.array([stress.start[bay], stress.end[bay]]))
        v = np.linspace(*(ends[:, 2] / RADIUS), 200)
        twist = (1.0 / np.cosh(v) ** 2).max() / RADIUS
        bend = np.abs(np.tanh(v) / np.cosh(v)).max() / (sqrt(2.0) * RADIUS)
        assert stress.twist[bay] == pytest.approx(twist, rel=0.02)
        assert 1.0 / stress.radius[bay] == pytest.approx(bend, rel=0.1, abs=2e-6)


def test_bays_are_named_after_their_strip_and_nodes(enneper):
    stress = bay_stress(enneper.structure, enneper.parts)
    names = {node.name for node in enneper.structure.nodes}
    first = enneper.structure.lamellas[0]
    nodes = [enneper.structure.nodes[k].name for k in first.nodes]
    wanted = [f"A1 {a}-{b}" for a, b in pairwise(nodes)]
    assert [stress.where(bay) for bay in stress.of_strip(0)] == wanted
    assert all(end in names for bay in stress.bays for end in bay.split("-"))


def test_half_laps_leave_less_than_an_eighth_in_every_bay(enneper):
    stress = bay_stress(enneper.structure, enneper.parts)
    assert stress.net_area == pytest.approx(0.495)
    assert stress.net_inertia == pytest.approx(0.495**3)
    assert stress.net_modulus == pytest.approx(0.495**2)


def test_a_closed_strip_has_a_bay_on_either_side_of_its_seam(tube):
    stress = bay_stress(tube.structure, tube.parts)
    index, hoop = next((i, one) for i, one in enumerate(tube.structure.lamellas) if one.closed)
    bays = stress.of_strip(index)
    assert len(bays) == len(hoop.nodes) + 1
    assert stress.bays[bays[0]].startswith("end-")
    assert stress.bays[bays[-1]].endswith("-end")
    assert (stress.end - stress.start)[bays].sum() == pytest.approx(hoop.length)
    assert stress.radius[bays].max() < np.inf


def test_a_piece_that_stops_short_of_its_nodes_is_checked_where_it_is(enneper):
    whole = enneper.structure.lamellas[0]
    a, b = whole.stations[1], whole.stations[2]
    piece = piece_of(whole, "A1.2", (1, 2), a + 40.0, b - 40.0)
    built = Structure((piece,), (), enneper.structure.profile)
    part = replace(enneper.parts[0], mark="A1.2", slots=())
    stress = bay_stress(built, (part,))
    assert stress.bays == ("end-end",)
    assert (stress.start[0], stress.end[0]) == pytest.approx((40.0, b - a - 40.0))
    s = np.linspace(a + 40.0, b - 40.0, 200)
    assert stress.twist[0] == pytest.approx(np.abs(whole.twist(s)).max(), rel=1e-3)


def test_both_strips_of_a_double_lamella_are_checked(enneper):
    washer = StarWasher(4.0, 18.0, 8.0, fab.S235)
    jointed = DoubleSlotJoint(30.0, 8.0, washer).build(enneper.structure)
    parts = parts_of(jointed)
    stress = bay_stress(jointed.strips, parts)
    assert set(stress.strip.tolist()) == set(range(len(parts)))
    assert {mark[-1] for mark in stress.marks} == {"L", "R"}
    assert max(net_sections(parts[0])[0]) < parts[0].length
    assert (stress.net_area < 0.5).all()


@pytest.mark.parametrize("level", [60.0, -35.0])
def test_strips_on_two_levels_bend_about_their_strong_axis(hypar, level):
    """A strip at d beside a straight twisted axis is a helix of curvature w^2 d / (1 + w^2 d^2)."""
    lanes = {1: (Lane("", 0.0, level),), 2: (Lane("", 0.0, -level),)}
    strips = arranged(hypar.structure, lanes, crossing=False).strips
    stress = bay_stress(strips, hypar.parts)
    profile = hypar.structure.profile
    for index, lamella in enumerate(hypar.structure.lamellas):
        rate = np.abs(lamella.twist(np.linspace(0.0, lamella.stations[-1], 200))).max()
        curvature = rate**2 * abs(level) / (1.0 + rate**2 * level**2)
        wanted = profile.material.modulus * curvature * profile.width / 2.0
        assert stress.edgewise[stress.of_strip(index)].max() == pytest.approx(wanted, rel=0.02)


def test_figures_do_not_depend_on_where_the_shell_stands(pair):
    here = bay_stress(pair.structure, pair.parts)
    turned = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    points = pair.control.vertices @ turned.T + [1e5, -2e5, 3e4]
    net = gs.diagonal_meshes(pair.control.moved(points))[0]
    structure = fab.structure(net, pair.structure.profile)
    there = bay_stress(structure, fab.flat_parts(structure, fab.SlotJoint()))
    for key in ("radius", "twist", "utilisation", "thickest"):
        np.testing.assert_allclose(getattr(there, key), getattr(here, key), rtol=1e-4)


def test_a_tube_carries_twist_as_a_closed_ring_and_stretches_away_from_its_axis():
    """Against integrals over the wall, cut into small pieces."""
    width, thickness, wall = 50.0, 20.0, 2.0
    weak, strong, twist = 2e-4, 1e-5, 3e-4
    found = section_stress(
        *(np.array([rate]) for rate in (weak, strong, twist)),
        width=width,
        thickness=thickness,
        material=fab.GRP,
        wall=wall,
    )
    e, g = fab.GRP.modulus, fab.GRP.rigidity
    z, y = (np.linspace(-a / 2, a / 2, 2001) for a in (width, thickness))
    z, y = np.meshgrid((z[1:] + z[:-1]) / 2, (y[1:] + y[:-1]) / 2, indexing="ij")
    in_wall = (np.abs(z) > width / 2 - wall) | (np.abs(y) > thickness / 2 - wall)
    gyration = float((z**2 + y**2)[in_wall].mean())
    corner = e * twist**2 / 2 * (width**2 / 4 + thickness**2 / 4 - gyration)
    middle = e * twist**2 / 2 * (gyration - thickness**2 / 4)
    ring, length = (width - wall) * (thickness - wall), 2 * (width + thickness - 2 * wall)
    assert found["helix_edge"][0] == pytest.approx(corner, rel=1e-3)
    assert found["helix_mid"][0] == pytest.approx(middle, rel=1e-3)
    assert found["shear"][0] == pytest.approx(g * twist * 2 * ring / length)
    assert found["bending"][0] == pytest.approx(e * thickness / 2 * weak)
    assert found["edgewise"][0] == pytest.approx(e * width / 2 * strong)
