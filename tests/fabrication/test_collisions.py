from time import perf_counter

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import fabrication as fab
import gridshell as gs
from fabrication.collisions import collisions
from fabrication.cut import Edge, Slot
from fabrication.lamella import axis_curve

LENGTH, WIDTH = 2000.0, 100.0


def lamella(mark, points, *, closed=False):
    """A strip along *points*, standing upright everywhere."""
    points = np.array(points, dtype=float)
    axis = axis_curve(points, closed=closed)
    upright = np.tile([0.0, 0.0, 1.0], (len(axis.stations), 1))
    normals = CubicSpline(axis.stations, upright, bc_type="periodic" if closed else "not-a-knot")
    end = axis.length - closed
    nodes = np.arange(len(points))
    return fab.Lamella(mark, "AB".index(mark[0]) + 1, nodes, axis, normals, 0.0, end)


def straight(mark, start, end, nodes=3):
    return lamella(mark, np.linspace(start, end, nodes))


def crossed(at=(300.0, -200.0), height=0.0, reach=LENGTH / 2.0):
    """A strip along x and one along y that crosses it at x, y = *at*, so much higher."""
    x, y = at
    return (
        straight("A1", (-LENGTH / 2.0, y, 0.0), (LENGTH / 2.0, y, 0.0), nodes=4),
        straight("B1", (x, y - reach, height), (x, y + LENGTH / 2.0, height)),
    )


def slot(at, node):
    return Slot(at, 3.0, WIDTH / 2.0, Edge.UPPER, node, partner="B1")


@pytest.fixture
def found(strip, profile):
    """Findings about strips, with slots by mark."""

    def build(lamellas, widths=(WIDTH, WIDTH), **slots):
        parts = [
            strip(one.mark, one.length, slots.get(one.mark, ()), width)
            for one, width in zip(lamellas, widths, strict=False)
        ]
        return collisions(fab.Structure(tuple(lamellas), (), profile), parts)

    return build


# ---- two strips -----------------------------------------------------------------------------


def test_strips_that_pass_through_each_other_are_named_with_the_place(found):
    (one,) = found(crossed())
    assert (one.code, one.severity, one.where) == ("strips-cross", fab.Severity.ERROR, "A1 B1")
    assert (one.value, one.limit, one.unit) == (0.0, 2.5, "mm")
    assert "A1 passes through B1 at (300, -200, " in one.message


@pytest.mark.parametrize(("height", "count"), [(99.0, 1), (-99.0, 1), (101.0, 0), (-101.0, 0)])
def test_strips_above_each_other_do_not_meet(found, height, count):
    assert len(found(crossed(height=height))) == count


@pytest.mark.parametrize(("reach", "count"), [(1.0, 1), (-1.0, 0)])
def test_a_strip_that_stops_short_of_another_does_not_meet_it(found, reach, count):
    assert len(found(crossed(reach=reach))) == count


@pytest.mark.parametrize("widths", [(WIDTH, 3.0 * WIDTH), (3.0 * WIDTH, WIDTH)])
def test_a_strip_through_the_middle_of_a_wider_one_is_found(found, widths):
    """Only the narrow strip's edges meet the other, near a cell's start, off its diagonal."""
    cell = LENGTH / 24.0
    strips = crossed(at=(15.05 * cell - LENGTH / 2.0, 0.0), reach=1.01 * LENGTH / 2.0)
    assert len(found(strips, widths)) == 1


def test_parallel_strips_do_not_meet(found):
    ends = ((0.0, 0.0, 0.0), (LENGTH, 0.0, 0.0))
    beside = [(x, y + 3.0, z) for x, y, z in ends]
    assert found([straight("A1", *ends), straight("A2", *beside)]) == ()


# ---- slots ----------------------------------------------------------------------------------


def test_strips_that_meet_at_the_slots_of_their_node_are_left_to_the_fit(found):
    assert found(crossed(), A1=[slot(1300.0, "N1")], B1=[slot(1000.0, "N1")]) == ()


@pytest.mark.parametrize(
    ("a", "b"),
    [
        ([slot(1300.0, "N1")], [slot(1000.0, "N2")]),
        ([slot(1300.0, "N1")], []),
        ([slot(1300.0, "N1")], [slot(900.0, "N1")]),
        ([slot(1200.0, "N1")], [slot(1000.0, "N1")]),
    ],
    ids=["another node", "none", "far on the one", "far on the other"],
)
def test_slots_elsewhere_or_of_other_nodes_do_not_excuse(found, a, b):
    assert len(found(crossed(), A1=a, B1=b)) == 1


def test_strips_that_meet_at_their_node_and_once_more_are_found(found):
    bow = [(x, 400.0 - (x / 50.0) ** 2, 0.0) for x in np.linspace(-1500.0, 1500.0, 31)]
    a, b = straight("A1", (-1500.0, 0.0, 0.0), (1500.0, 0.0, 0.0)), lamella("B1", bow)
    at = float(b.stations[25])
    (one,) = found([a, b], A1=[slot(2500.0, "N1")], B1=[slot(at, "N1")])
    assert "(-1000, 0, " in one.message


# ---- one strip ------------------------------------------------------------------------------


def test_a_strip_that_passes_through_itself_is_found(found):
    t = np.linspace(-0.25 * np.pi, 1.25 * np.pi, 12)
    loop = 1000.0 * np.stack([np.sin(t), np.sin(2.0 * t), 0.0 * t], axis=1)
    (one,) = found([lamella("A1", loop)])
    assert one.where == "A1 A1"
    assert "A1 passes through itself" in one.message


def test_a_hoop_does_not_meet_itself_at_its_seam(found):
    t = 2.0 * np.pi * np.arange(12) / 12
    hoop = 1000.0 * np.stack([np.cos(t), np.sin(t), 0.0 * t], axis=1)
    assert found([lamella("A1", hoop, closed=True)]) == ()


# ---- whole nets -----------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["catenoid", "enneper", "hypar", "pair", "ring", "tube"])
def test_a_net_on_a_surface_without_self_intersections_has_none(name, request):
    design = request.getfixturevalue(name)
    assert collisions(design.structure, design.parts) == ()


def test_strips_that_meet_beside_a_singular_node_are_a_warning(saddle):
    found = collisions(saddle.structure, saddle.parts)
    singular = next(node for node in saddle.structure.nodes if len(node.crossings) > 2)
    there = {saddle.structure.lamellas[c.lamella].mark for c in singular.crossings}
    assert found
    for one in found:
        assert one.severity is fab.Severity.WARNING
        assert set(one.where.split()) <= there
        assert f"beside {singular.name}" in one.message


def built(limit, lamellas, width):
    patch = gs.AsymptoticPatch((-limit, limit), (-limit, limit), (lamellas, lamellas))
    net = gs.diagonal_meshes(gs.control_patch(gs.Enneper(4000.0), patch))[0]
    structure = fab.structure(net, fab.Profile(width, 2.5, fab.STAINLESS))
    return structure, fab.flat_parts(structure, fab.SlotJoint())


def test_enneper_s_surface_cuts_through_itself_in_its_planes_of_symmetry():
    structure, parts = built(2.4, 11, 60.0)
    found = fab.check(structure, parts)
    found = [one for one in found if one.code == "strips-cross"]
    assert "A1 B1" in {one.where for one in found}
    for one in found:
        place = one.message.split("(")[1].split(")")[0].split(", ")
        x, y, _ = (abs(float(value)) for value in place)
        assert min(x, y) < 60.0


def test_nine_hundred_nodes_take_less_than_a_second():
    structure, parts = built(1.0, 30, 100.0)
    start = perf_counter()
    assert collisions(structure, parts) == ()
    assert perf_counter() - start < 1.0
