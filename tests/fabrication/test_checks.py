from dataclasses import replace
from math import sqrt

import numpy as np
import pytest

import fabrication as fab
import gridshell as gs
from fabrication.cut import Edge, Slot
from gridshell.mesh import grid_quads

ERROR, WARNING, INFO = fab.Severity.ERROR, fab.Severity.WARNING, fab.Severity.INFO


def checked(design, profile=None, parts=None):
    """Findings of a design, made of another profile or with other parts."""
    structure = replace(design.structure, profile=profile or design.structure.profile)
    return fab.check(structure, design.parts if parts is None else parts)


def coded(findings, code):
    return [finding for finding in findings if finding.code == code]


def material(**changes):
    values = {"name": "test", "modulus": 200e3, "strength": 220.0, "density": 7900.0} | changes
    return fab.Material(**values)


def sharpest(lamella, rates):
    s = np.linspace(0.0, lamella.axis.length, 2000)
    return np.abs(rates(lamella, s)).max()


def between(values):
    """The middle of the widest gap between *values*."""
    ordered = np.sort(list(values))
    widest = np.argmax(np.diff(ordered))
    return float(ordered[widest : widest + 2].mean())


@pytest.mark.parametrize("name", ["catenoid", "enneper", "hypar"])
def test_a_good_design_has_no_findings(name, request):
    assert checked(request.getfixturevalue(name)) == ()


# ---- bending about the weak axis ------------------------------------------------------------


def test_a_strip_too_thick_for_its_radius_is_an_error(enneper):
    radii = {
        one.mark: 1.0 / sharpest(one, lambda lamella, s: lamella.bending(s)[0])
        for one in enneper.structure.lamellas
    }
    middle = between(radii.values())
    t, e = 8.0, 200e3
    profile = fab.Profile(100.0, t, material(strength=e * t / (2.0 * middle), modulus=e))
    found = coded(checked(enneper, profile), "bend-radius")
    assert {f.where for f in found} == {mark for mark, radius in radii.items() if radius < middle}
    assert 0 < len(found) < len(radii)
    for f in found:
        assert f.severity is ERROR
        assert f.value == pytest.approx(radii[f.where], rel=1e-3)
        assert f.limit == pytest.approx(middle)


def test_the_advice_names_the_thickness_that_would_do(enneper):
    weak = material(strength=50.0)
    f = coded(checked(enneper, fab.Profile(100.0, 20.0, weak)), "bend-radius")[0]
    thickest = float(f.message.split("At most ")[1].split(" mm")[0])
    better = fab.Profile(100.0, thickest - 0.02, weak)
    assert f.where not in {one.where for one in coded(checked(enneper, better), "bend-radius")}


def test_a_straight_strip_bears_any_thickness(hypar):
    profile = fab.Profile(100.0, 30.0, material(strength=1e-3))
    assert coded(checked(hypar, profile), "bend-radius") == []


# ---- twist ----------------------------------------------------------------------------------


def test_a_strip_that_twists_too_fast_is_an_error(hypar):
    rates = {
        one.mark: sharpest(one, lambda lamella, s: lamella.twist(s))
        for one in hypar.structure.lamellas
    }
    middle = between(rates.values())
    e, t = 200e3, 4.0
    strength = middle * sqrt(3.0) * (e / 2.6) * t
    found = coded(checked(hypar, fab.Profile(100.0, t, material(strength=strength))), "twist")
    assert {f.where for f in found} == {mark for mark, rate in rates.items() if rate > middle}
    assert 0 < len(found) < len(rates)
    for f in found:
        assert f.severity is ERROR
        assert f.value == pytest.approx(rates[f.where], rel=1e-3)
        assert f.limit == pytest.approx(middle)


@pytest.mark.parametrize("share", [0.98, 1.02])
def test_a_strip_whose_edges_its_twist_stretches_too_far_is_an_error(hypar, share):
    e, width = 200e3, 600.0
    rate = max(sharpest(one, lambda s, x: s.twist(x)) for one in hypar.structure.lamellas)
    assert rate == pytest.approx(1.0 / 6000.0, rel=0.05)
    strength = e * (rate * width) ** 2 / 12.0 / share
    profile = fab.Profile(width, 2.5, material(strength=strength, modulus=e))
    found = coded(checked(hypar, profile), "twist-stretch")
    assert bool(found) == (share > 1.0)
    for f in found:
        assert f.severity is ERROR
        assert f.value == pytest.approx(share * strength, rel=0.01)
        assert f.limit == strength


def test_the_stretch_is_what_is_left_of_the_edge_strain_without_its_mean(hypar):
    profile = fab.Profile(600.0, 2.5, material(strength=1.0))
    developed = {one.mark: fab.unroll(one, 600.0) for one in hypar.structure.lamellas}
    found = coded(checked(hypar, profile), "twist-stretch")
    assert len(found) == len(developed)
    for f in found:
        across = np.linspace(-1.0, 1.0, 100_001)
        strain = developed[f.where].edge_strain * (across**2 - np.mean(across**2))
        assert f.value == pytest.approx(200e3 * strain.max(), rel=1e-3)


def test_the_advice_names_the_width_that_would_do(hypar):
    weak = material(strength=2.0)
    f = coded(checked(hypar, fab.Profile(600.0, 2.5, weak)), "twist-stretch")[0]
    widest = float(f.message.split("at most ")[1].split(" mm")[0])
    for width, told in ((widest, False), (widest + 0.2, True)):
        found = coded(checked(hypar, fab.Profile(width, 2.5, weak)), "twist-stretch")
        assert (f.where in {one.where for one in found}) == told


# ---- bending about the strong axis ----------------------------------------------------------


def hoop_stress(tube, lamella, modulus, width):
    return modulus * sharpest(lamella, lambda one, s: one.bending(s)[1]) * width / 2.0


def test_a_strip_that_must_bend_edgewise_is_an_error(tube, profile):
    hoop = next(one for one in tube.structure.lamellas if one.closed)
    (found,) = [f for f in coded(checked(tube), "edgewise-bend") if f.where == hoop.mark]
    stress = hoop_stress(tube, hoop, profile.material.modulus, profile.width)
    assert found.severity is ERROR
    assert found.value == pytest.approx(stress, rel=1e-2)
    assert found.limit == profile.material.strength


@pytest.mark.parametrize(("share", "severity"), [(0.95, WARNING), (1.05, ERROR)])
def test_edgewise_bending_warns_from_half_the_strength(tube, share, severity):
    hoop = next(one for one in tube.structure.lamellas if one.closed)
    strength = hoop_stress(tube, hoop, 200e3, 100.0) / share
    profile = fab.Profile(100.0, 2.5, material(strength=strength))
    (found,) = [f for f in coded(checked(tube, profile), "edgewise-bend") if f.where == hoop.mark]
    assert found.severity is severity


def test_edgewise_bending_below_half_the_strength_is_no_finding(tube):
    strong = max(hoop_stress(tube, one, 200e3, 100.0) for one in tube.structure.lamellas)
    profile = fab.Profile(100.0, 2.5, material(strength=strong / 0.49))
    assert coded(checked(tube, profile), "edgewise-bend") == []


def test_more_lamellas_cure_edgewise_bending_as_the_advice_says():
    """Half the bay, a quarter of the stress."""
    stress = []
    for bays in (6, 12, 24):
        p = np.linspace(-0.5, 0.5, bays + 1)
        p, q = np.meshgrid(p, p, indexing="ij")
        points = gs.Catenoid(4000.0).asymptotic_point(p.ravel(), q.ravel())
        mesh = gs.QuadMesh(points, grid_quads(bays, bays)[:, ::-1])
        profile = fab.Profile(100.0, 2.5, material(strength=1e-6))
        structure = fab.structure(gs.diagonal_meshes(gs.control_mesh(mesh))[0], profile)
        found = fab.check(structure, fab.flat_parts(structure, fab.SlotJoint()))
        stress.append(max(f.value for f in coded(found, "edgewise-bend")))
        assert "Use more lamellas" in coded(found, "edgewise-bend")[0].message
    ratio = np.array(stress[:-1]) / stress[1:]
    assert (ratio > 3.0).all()


# ---- slots ----------------------------------------------------------------------------------


def slot(x, node, *, width=3.0):
    return Slot(x, width, 50.5, Edge.UPPER, node, partner=f"B{node[1:]}")


def test_slots_that_leave_less_than_a_thickness_between_them_are_an_error(hypar, with_slots):
    length = hypar.parts[0].length
    slots = [slot(500.0, "N1"), slot(505.4, "N2"), slot(511.0, "N3"), slot(length - 200.0, "N4")]
    parts = (with_slots(hypar.parts[0], slots), *hypar.parts[1:])
    (found,) = coded(checked(hypar, parts=parts), "slot-spacing")
    assert (found.where, found.severity) == ("A1 N1-N2", ERROR)
    assert (found.value, found.limit) == (pytest.approx(2.4), 2.5)


@pytest.mark.parametrize(("spare", "count"), [(2.4, 1), (2.6, 0)])
def test_a_slot_that_leaves_less_than_a_thickness_behind_it_is_an_error(
    hypar, with_slots, spare, count
):
    slots = [slot(400.0, "N1"), replace(slot(800.0, "N2"), depth=100.0 - spare)]
    parts = (with_slots(hypar.parts[0], slots), *hypar.parts[1:])
    found = coded(checked(hypar, parts=parts), "slot-depth")
    assert [(f.where, f.severity) for f in found] == count * [("A1 N2", ERROR)]
    for f in found:
        assert (f.value, f.limit) == (pytest.approx(spare), 2.5)


@pytest.mark.parametrize("near_end", [False, True])
def test_a_slot_that_leaves_less_than_a_thickness_at_an_end_is_an_error(
    hypar, with_slots, near_end
):
    length = hypar.parts[0].length
    x = [length - 800.0, length - 3.9] if near_end else [3.9, 800.0]
    parts = (with_slots(hypar.parts[0], [slot(x[0], "N1"), slot(x[1], "N2")]), *hypar.parts[1:])
    (found,) = coded(checked(hypar, parts=parts), "slot-at-end")
    assert (found.where, found.severity) == (f"A1 N{1 + near_end}", ERROR)
    assert (found.value, found.limit) == (pytest.approx(2.4), 2.5)


def test_an_end_of_just_over_a_thickness_is_enough(hypar, with_slots):
    parts = (with_slots(hypar.parts[0], [slot(4.1, "N1"), slot(800.0, "N2")]), *hypar.parts[1:])
    assert coded(checked(hypar, parts=parts), "slot-at-end") == []


def test_a_strip_with_a_single_slot_is_told_once(hypar, with_slots):
    parts = (with_slots(hypar.parts[0], [slot(2.0, "N1")]), *hypar.parts[1:])
    assert len(coded(checked(hypar, parts=parts), "slot-at-end")) == 1


def test_a_short_overhang_is_found(hypar, profile):
    structure = fab.structure(hypar.net, profile, overhang=3.0)
    found = fab.check(structure, fab.flat_parts(structure, fab.SlotJoint()))
    assert {f.code for f in found} == {"slot-at-end"}
    assert len(found) == 2 * len(structure.lamellas)


# ---- words ----------------------------------------------------------------------------------

UNITS = {
    **{"bend-radius": "mm", "twist": "rad/mm", "edgewise-bend": "N/mm2"},
    **{"twist-stretch": "N/mm2", "slot-depth": "mm", "stress": "N/mm2"},
    **{"slot-spacing": "mm", "slot-at-end": "mm", "seam": "mm", "strips-cross": "mm"},
}


def test_every_finding_carries_its_unit_and_names_its_part(tube, saddle, hypar, with_slots):
    weak = fab.Profile(100.0, 2.5, material(strength=1e-3))
    narrow = with_slots(hypar.parts[0], [slot(2.0, "N1"), slot(6.0, "N2"), slot(800.0, "N3")])
    deep = with_slots(hypar.parts[0], [replace(slot(800.0, "N1"), depth=99.0)])
    found = [
        *checked(tube, weak),
        *checked(saddle, weak),
        *checked(hypar, parts=(narrow, *hypar.parts[1:])),
        *checked(hypar, parts=(deep, *hypar.parts[1:])),
    ]
    assert {f.code: f.unit for f in found} == UNITS
    for f in found:
        assert f.where.split()[0] in f.message
        assert f.message.endswith(".")


# ---- seams ----------------------------------------------------------------------------------


def test_a_closed_strip_is_told_of_its_seam_and_no_other(tube):
    found = coded(checked(tube), "seam")
    closed = {one.mark: one for one in tube.structure.lamellas if one.closed}
    assert [f.where for f in found] == list(closed)
    for f in found:
        assert f.severity is INFO
        assert f.value == pytest.approx(closed[f.where].axis.length)
        assert f.limit == pytest.approx(f.value - 1.0)


def test_findings_come_in_the_order_of_the_lamellas(tube):
    marks = [one.mark for one in tube.structure.lamellas]
    found = checked(tube, fab.Profile(100.0, 2.5, material(strength=1.0)))
    order = [marks.index(f.where) for f in found]
    assert order == sorted(order)
    assert len(set(order)) == len(marks)
