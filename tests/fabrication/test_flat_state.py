"""Flat segments: exact nets, an independent minimisation, slots that let an angle pass or not."""

from __future__ import annotations

import csv
from dataclasses import replace
from math import atan, degrees, pi, radians

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize

import fabrication as fab
import gridshell as gs
from fabrication.errors import OutputError
from fabrication.flat_checks import SLIP, filled, flat_findings
from fabrication.flat_grid import flat_grid
from fabrication.flat_state import FlatState, lay_flat
from fabrication.jointed import Jointed
from fabrication.lamella import axis_curve
from gridshell.arrays import Floats
from gridshell.mesh import grid_quads

LOOSE = fab.SlotJoint(clearance=8.0)


def planar(x: Floats, y: Floats, turn: float = pi / 2) -> gs.QuadMesh:
    """Points x e1 + y e2 with *turn* between the two directions."""
    x, y = np.meshgrid(x, y, indexing="ij")
    flat = [x + y * np.cos(turn), y * np.sin(turn), np.zeros_like(x)]
    points = np.stack(flat, axis=-1).reshape(-1, 3)
    return gs.QuadMesh(points, grid_quads(x.shape[0] - 1, x.shape[1] - 1))


def built(mesh: gs.QuadMesh, profile: fab.Profile, joint: fab.Joint = LOOSE) -> Jointed:
    net = gs.diagonal_meshes(gs.control_mesh(mesh))[0]
    return joint.build(fab.structure(net, profile))


def codes(state: FlatState) -> set[str]:
    return {finding.code for finding in state.findings}


# ---- nets whose flat state is known ------------------------------------------------------------


@pytest.mark.parametrize("opening", [25.0, 60.0, 90.0, 130.0])
def test_equal_rhombi_are_a_mechanism(profile, opening):
    jointed = built(planar(300.0 * np.arange(11), 300.0 * np.arange(9)), profile)
    state = lay_flat(jointed, opening=radians(opening), slip=0.0)
    assert np.abs(state.slips).max() < 1e-6
    crossed = np.isfinite(state.angles)
    assert np.degrees(state.angles[crossed]) == pytest.approx(opening, abs=1e-5)
    assert state.radius > 1e7


def test_uneven_parallelograms_lie_straight_at_any_opening(profile):
    x, y = (
        np.cumsum([0.0, *np.repeat(bays, 2)]) / 2.0 for bays in ([400, 700, 500], [900, 300, 650])
    )
    jointed = built(planar(x, y, radians(70.0)), profile)
    for opening in (40.0, 70.0, 100.0):
        state = lay_flat(jointed, opening=radians(opening), slip=0.0)
        assert np.abs(state.slips).max() < 1e-6
        assert np.degrees(state.angles[np.isfinite(state.angles)]) == pytest.approx(
            opening, abs=1e-4
        )


def test_a_curved_net_that_only_shears_lies_straight(profile):
    """Points p(u) + q(v) have equal bays in all lamellas of a family: they stretch out."""
    t = np.linspace(0.0, 1.2, 13)
    u, v = np.meshgrid(t, t, indexing="ij")
    points = 3000.0 * np.stack([np.sin(u), np.sin(v), np.cos(u) + np.cos(v)], axis=-1)
    jointed = built(gs.QuadMesh(points.reshape(-1, 3), grid_quads(12, 12)), profile)
    state = lay_flat(jointed, slip=0.0)
    assert np.abs(state.slips).max() < 1e-4
    assert state.radius > 1e6
    straight = {strip.mark: np.ptp(strip.stations) for strip in state.strips}
    for strip in state.strips:
        ends = state.positions[strip.nodes[[0, -1]]]
        assert np.linalg.norm(ends[1] - ends[0]) == pytest.approx(straight[strip.mark], abs=1e-3)


def test_hoops_lie_open_at_their_seams(tube, profile):
    state = lay_flat(LOOSE.build(tube.structure), slip=SLIP)
    hoop = next(s for s in state.strips if tube.lamella(s.mark).closed)
    assert np.abs(state.slips).max() < SLIP
    assert state.size[0] == pytest.approx(tube.lamella(hoop.mark).length, rel=0.02)


# ---- lengths and bending -----------------------------------------------------------------------


@pytest.mark.parametrize("name", ["catenoid", "enneper", "hypar", "pair", "saddle"])
def test_distances_along_the_strips_are_kept(name, request):
    structure = request.getfixturevalue(name).structure
    lengths = {lamella.mark: lamella.length for lamella in structure.lamellas}
    state = lay_flat(LOOSE.build(structure), slip=0.0)
    assert np.abs(state.slips).max() < 0.02
    for strip in state.strips:
        steps = np.linalg.norm(np.diff(strip.points(per_bay=60), axis=0), axis=1)
        assert steps.sum() == pytest.approx(lengths[strip.mark], rel=2e-5)


def test_distances_are_kept_on_another_spline_too(catenoid):
    """The curve of a lamella in space, through nodes that lie on the ground."""
    state = lay_flat(LOOSE.build(catenoid.structure), slip=0.0)
    for strip in state.strips:
        flat = np.column_stack([state.positions[strip.nodes], np.zeros(len(strip.nodes))])
        found = axis_curve(flat, closed=False).stations
        assert np.diff(found) == pytest.approx(np.diff(strip.stations), abs=0.05)


def bending(state: FlatState) -> Floats:
    """(2k, 2n) rows whose squares are the energy of one turn each."""
    rows = []
    for strip in state.strips:
        bays = np.diff(strip.stations)
        for k in range(1, len(strip.nodes) - 1):
            width = np.sqrt((bays[k - 1] + bays[k]) / 2.0)
            for side in (0, 1):
                row = np.zeros((len(state.names), 2))
                before, here, after = strip.nodes[k - 1 : k + 2]
                row[after, side] += 1.0 / bays[k]
                row[here, side] -= 1.0 / bays[k] + 1.0 / bays[k - 1]
                row[before, side] += 1.0 / bays[k - 1]
                rows.append(row.ravel() / width)
    return np.array(rows)


def mean_angle(state: FlatState, grid: object, p: Floats) -> float:
    a, b, c, d = grid.arms.T
    u, v = p[b] - p[a], p[d] - p[c]
    return float(np.arctan2(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0], (u * v).sum(axis=1)).mean())


def test_no_other_state_with_these_lengths_bends_less(catenoid):
    """SciPy's SQP from a disturbed state, with the chords and the mean angle as constraints."""
    marks = ["A1", "A2", "A3", "B1", "B2", "B3"]
    jointed = LOOSE.build(catenoid.structure)
    state = lay_flat(jointed, lamellas=marks, slip=0.0)
    grid = flat_grid(jointed.strips, marks)
    unit = 500.0
    chords = np.linalg.norm(np.diff(state.positions[state.edges], axis=1)[:, 0], axis=1)

    def kept(x: Floats) -> Floats:
        p = unit * x.reshape(-1, 2)
        found = np.linalg.norm(p[state.edges[:, 1]] - p[state.edges[:, 0]], axis=1)
        return np.r_[(found - chords) / unit, mean_angle(state, grid, p) - state.opening]

    rows = 1e4 * bending(state)
    lying = state.positions.ravel() / unit
    start = lying + 0.016 * np.sin(np.arange(len(lying)))
    best = minimize(
        lambda x: float(((rows @ x) ** 2).sum()),
        start,
        jac=lambda x: 2.0 * rows.T @ (rows @ x),
        method="SLSQP",
        constraints={"type": "eq", "fun": kept},
        options={"maxiter": 300, "ftol": 1e-13},
    )
    assert np.abs(kept(best.x)).max() < 1e-6
    assert ((rows @ start) ** 2).sum() > 2.0 * best.fun
    assert ((rows @ lying) ** 2).sum() == pytest.approx(best.fun, rel=1e-3)


def test_the_state_does_not_depend_on_where_the_net_lies(enneper):
    spin = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    spin *= np.sign(np.linalg.det(spin))
    moved = replace(enneper.net, vertices=enneper.net.vertices @ spin.T + [1e4, -2e4, 5e3])
    profile = enneper.structure.profile
    one, other = (
        lay_flat(LOOSE.build(fab.structure(net, profile)), slip=0.0) for net in (enneper.net, moved)
    )
    assert other.angles == pytest.approx(one.angles, abs=1e-5, nan_ok=True)
    assert other.size == pytest.approx(one.size, abs=0.1)


def test_angles_turn_the_same_way_as_in_the_design(catenoid):
    """A flat net with the design's distances is no mirror image of it."""
    state = lay_flat(LOOSE.build(catenoid.structure))
    crossed = np.isfinite(state.design_angles)
    assert (np.abs(state.angles - state.design_angles)[crossed] < 0.3).all()
    assert state.opening == pytest.approx(state.design_angles[crossed].mean(), abs=1e-3)


def test_strips_that_may_slip_bend_less(catenoid):
    tight = lay_flat(LOOSE.build(catenoid.structure), opening=radians(60.0), slip=0.0)
    loose = lay_flat(LOOSE.build(catenoid.structure), opening=radians(60.0), slip=3.0)
    assert loose.radius > 1.05 * tight.radius
    assert np.abs(tight.slips).max() < 1e-3 < np.abs(loose.slips).max() <= 3.0


def test_double_lamellas_lie_flat_too(catenoid):
    washer = fab.StarWasher(4.0, 18.0, 8.0, fab.S235)
    state = lay_flat(
        fab.DoubleSlotJoint(30.0, 8.0, washer, clearance=3.0).build(catenoid.structure)
    )
    single = lay_flat(LOOSE.build(catenoid.structure))
    assert len(state.strips) == 2 * len(single.strips)
    assert np.abs(state.slips).max() <= 0.3
    assert state.size == pytest.approx(single.size, abs=40.0)


# ---- segments ----------------------------------------------------------------------------------


def test_a_segment_is_chosen_by_marks(catenoid):
    state = lay_flat(LOOSE.build(catenoid.structure), lamellas=["B2", "A1", "A2", "B1"])
    assert [strip.mark for strip in state.strips] == ["A1", "A2", "B1", "B2"]


def test_one_strip_alone_lies_straight(catenoid):
    state = lay_flat(LOOSE.build(catenoid.structure), lamellas=["A2"])
    assert state.size == pytest.approx((catenoid.lamella("A2").length + 2.5, 2.5), abs=0.01)
    assert np.isnan(state.angles).all()
    assert state.section()["angle_deg"] == {"min": None, "mean": None, "max": None}


@pytest.mark.parametrize(
    ("marks", "word"),
    [(["A1", "Z9"], "Z9"), ([], "No strip"), (["A1", "A2"], "hang together")],
)
def test_segments_that_are_none_are_refused(catenoid, marks, word):
    with pytest.raises(gs.SettingError, match=word):
        lay_flat(LOOSE.build(catenoid.structure), lamellas=marks)


def test_a_net_around_a_hole_is_refused_and_a_part_of_it_is_not(ring):
    jointed = LOOSE.build(ring.structure)
    with pytest.raises(gs.SettingError, match="around a hole"):
        lay_flat(jointed)
    first = ring.lamella("A1")
    crossing = {
        ring.structure.lamellas[c.lamella].mark
        for node in ring.structure.nodes
        for c in node.crossings
        if first is ring.structure.lamellas[node.crossings[0].lamella]
    }
    state = lay_flat(jointed, lamellas=sorted(crossing | {"A2"}))
    assert np.abs(state.slips).max() < 0.3


def test_a_singular_node_is_told_and_its_sectors_stay_unfolded(saddle):
    state = lay_flat(LOOSE.build(saddle.structure))
    assert codes(state) >= {"flat-singular"}
    assert (state.angles[np.isfinite(state.angles)] > radians(30.0)).all()


def test_strips_without_slots_have_no_flat_state(pair):
    jointed = replace(LOOSE.build(pair.structure), cuts={})
    with pytest.raises(gs.SettingError, match="no flat scissor state"):
        lay_flat(jointed)


# ---- findings ----------------------------------------------------------------------------------


def test_a_partner_fills_what_two_rectangles_say():
    """At 90 degrees its thickness; at any angle the projection of both."""
    a = np.radians([90.0, 60.0, 120.0, 35.0])
    assert filled(a, 2.5) == pytest.approx(2.5 / np.sin(a) + 2.5 * np.abs(1.0 / np.tan(a)))
    assert filled(np.array([0.0, -0.2]), 2.5).tolist() == [np.inf, np.inf]


def test_tight_slots_are_found_and_the_advice_helps(catenoid):
    tight = fab.SlotJoint(clearance=0.1)
    state = lay_flat(tight.build(catenoid.structure))
    (found,) = (f for f in state.findings if f.code == "flat-angle")
    assert found.value < found.limit
    assert found.limit == pytest.approx(degrees(2.0 * atan(2.5 / 2.6)), abs=0.6)
    more = float(found.message.split("use ")[1].split(" mm more")[0])
    wider = lay_flat(fab.SlotJoint(clearance=0.1 + more).build(catenoid.structure))
    assert "flat-angle" not in codes(wider)
    assert not state.possible
    assert wider.possible


def test_too_much_bending_and_folding_are_found(profile):
    patch = gs.AsymptoticPatch(p=(-1.0, 1.0), q=(-1.0, 1.0), lamellas=(9, 9))
    net = gs.diagonal_meshes(gs.control_patch(gs.Enneper(4000.0), patch))[0]
    thick = replace(profile, thickness=12.0)
    closed = lay_flat(LOOSE.build(fab.structure(net, thick)), opening=radians(55.0))
    assert codes(closed) >= {"flat-bend", "flat-fold"}
    bent = [f for f in closed.findings if f.code == "flat-bend"]
    assert min(f.value for f in bent) == pytest.approx(closed.radius)
    assert {f.limit for f in bent} == {200_000.0 * 12.0 / (2.0 * 220.0)}
    wide = lay_flat(LOOSE.build(fab.structure(net, profile)))
    assert not codes(wide) & {"flat-bend", "flat-fold"}


def test_distances_beyond_the_play_are_found(catenoid, profile):
    grid = flat_grid(catenoid.structure)
    slips = np.zeros(len(grid.edges))
    first, second = np.flatnonzero(grid.strip == 1)[:2]
    slips[first], slips[second] = 0.9, -0.4
    (found,) = flat_findings(
        grid,
        (),
        slips=slips,
        free=np.full(len(slips), 0.3),
        angles=grid.design,
        widths=np.full((len(grid.design), 2), 3.0),
        profile=profile,
        size=(1.0, 1.0),
        ground=None,
    )
    assert (found.code, found.value, found.limit) == ("flat-slip", 0.9, 0.3)
    assert "apart" in found.message
    assert "0.60 mm more clearance" in found.message


def test_the_segment_is_as_large_as_its_points_say_and_must_fit_the_ground(catenoid):
    jointed = LOOSE.build(catenoid.structure)
    state = lay_flat(jointed)
    points = np.concatenate([strip.points() for strip in state.strips])
    thick = catenoid.structure.profile.thickness
    assert np.ptp(points, axis=0) + thick == pytest.approx(state.size)
    assert points.min(axis=0) == pytest.approx(thick / 2.0)
    assert state.size[0] >= state.size[1]
    for angle in np.linspace(0.0, pi, 61):
        turned = points @ [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
        assert np.ptp(turned, axis=0).prod() >= np.ptp(points, axis=0).prod() * (1.0 - 1e-9)
    length, width = state.size
    assert "flat-size" not in codes(lay_flat(jointed, ground=fab.Ground(width + 1, length + 1)))
    assert "flat-size" in codes(lay_flat(jointed, ground=fab.Ground(length + 1, width - 1)))


def test_closing_the_scissors_makes_it_narrow(catenoid):
    jointed = LOOSE.build(catenoid.structure)
    widths = [lay_flat(jointed, opening=radians(a)).size[1] for a in (80.0, 60.0, 40.0)]
    assert widths == sorted(widths, reverse=True)


@given(st.floats().filter(lambda a: not 0.0 < a < pi))
def test_openings_that_are_no_angle_are_refused(pair, opening):
    with pytest.raises(gs.SettingError, match="opening"):
        lay_flat(LOOSE.build(pair.structure), opening=opening)


@given(st.floats(0.2, 2.9))
def test_any_opening_is_reached(pair, opening):
    state = lay_flat(LOOSE.build(pair.structure), opening=opening)
    assert state.opening == pytest.approx(opening, abs=1e-3)


@given(st.floats(max_value=0.0))
def test_ground_without_size_is_refused(size):
    with pytest.raises(gs.SettingError):
        fab.Ground(1000.0, size)


# ---- what is told ------------------------------------------------------------------------------


def test_the_list_of_nodes_is_read_back(catenoid, tmp_path):
    state = lay_flat(LOOSE.build(catenoid.structure))
    fab.write_flat_state(tmp_path / "flat.csv", state)
    with (tmp_path / "flat.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [row["node"] for row in rows] == list(state.names)
    read = np.array([[float(row["x_mm"]), float(row["y_mm"])] for row in rows])
    assert np.abs(read - state.positions).max() <= 0.0501
    assert rows[0]["strips"].split()[0].startswith("A")


def test_a_list_that_cannot_be_written_is_told(pair, tmp_path):
    with pytest.raises(OutputError, match="flat segment"):
        fab.write_flat_state(tmp_path / "none" / "flat.csv", lay_flat(LOOSE.build(pair.structure)))


def test_report_and_drawing_get_the_same_numbers(catenoid):
    state = lay_flat(LOOSE.build(catenoid.structure))
    section = state.section()
    assert section["nodes"] == len(state.names)
    assert section["possible"] is True
    assert f"{section['length_m']:.2f} x {section['width_m']:.2f} m" in state.lines()[0]
