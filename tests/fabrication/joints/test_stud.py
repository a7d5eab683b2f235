from dataclasses import replace
from math import radians

import numpy as np
import pytest

import fabrication as fab
import gridshell as gs
from fabrication.finding import Severity
from fabrication.fitting import clash_volumes
from fabrication.jointed import Feature
from fabrication.joints.stud_shapes import rhombus
from fabrication.parts import parts_of

PROFILE = fab.Profile(width=60.0, thickness=4.0, material=fab.POPLAR_PLY)
LIMIT = 1e-3


def design(degrees, lamellas=4, reach=0.4):
    patch = gs.AsymptoticPatch(p=(-reach, reach), q=(-reach, reach), lamellas=(lamellas,) * 2)
    start = gs.control_patch(gs.Enneper(4000.0), patch)
    result = gs.optimize(start, gs.a_net(angle=radians(degrees)), anchor=gs.Free())
    return fab.structure(gs.diagonal_meshes(result.require().control)[0], PROFILE)


def joint(*, blocks=None, bolt=0.0, level=None, **stud):
    return fab.StudJoint(
        30.0, fab.Stud(fab.BIRCH_PLY, **stud), level=level, bolt=bolt, blocks=blocks
    )


@pytest.fixture(scope="module", params=[45, 60, 75, 90, 120])
def built(request):
    return design(request.param)


@pytest.fixture(scope="module")
def square():
    return design(90)


def sides(outline):
    """Distances between the two pairs of opposite sides of a rhombus."""
    a, b, c, _ = outline[:, :2]
    side = (b - a) / np.linalg.norm(b - a)
    return abs(side[0] * (c - a)[1] - side[1] * (c - a)[0])


def test_every_axis_has_two_strips_on_the_level_of_its_family(square):
    made = joint().build(square)
    assert len(made.strips.lamellas) == 2 * len(square.lamellas)
    for strip, carrier in zip(made.strips.lamellas, made.carriers, strict=True):
        axis = square.lamellas[carrier]
        node = axis.frames(axis.stations[1:2])
        here = strip.axis.spline(strip.stations[1:2])[0] - node.points[0]
        assert here @ node.n[0] == pytest.approx(31.0 if strip.family == 1 else -31.0)
        assert abs(here @ node.b[0]) == pytest.approx(15.0)


def test_a_rhombus_has_its_sides_as_far_apart_as_asked():
    for angle in np.radians([45.0, 60.0, 90.0, 130.0]):
        outline = rhombus(20.0, angle)
        assert sides(outline) == pytest.approx(20.0)
        edge = outline[1, :2] - outline[0, :2]
        lean = np.arctan2(abs(edge[1]), abs(edge[0]))
        assert 2.0 * lean == pytest.approx(np.pi - angle) or 2.0 * lean == pytest.approx(angle)


def test_studs_without_play_touch_nothing_and_larger_ones_clash_everywhere(built):
    made = joint(fit=0.0, step=0.0).build(built)
    parts = parts_of(made)
    (studs,) = made.connectors
    assert max(clash_volumes(made.strips, parts, [studs]).values()) < LIMIT
    larger = []
    for shape in studs.shapes:
        (x, _), (_, y) = np.abs(shape.outline[[0, 1], :2])
        grown = rhombus(sides(shape.outline) + 0.1, 2.0 * np.arctan2(y, x))
        larger.append(replace(shape, outline=grown))
    found = clash_volumes(made.strips, parts, [replace(studs, shapes=tuple(larger))])
    assert len(found) == sum(node.regular for node in built.nodes)
    assert min(found.values()) > LIMIT


def test_studs_rounded_down_are_few_and_keep_their_play(built):
    made = joint(bolt=6.0, step=0.5).build(built)
    studs = made.connectors[0]
    assert len(studs.shapes) < len(studs.bodies)
    assert max(clash_volumes(made.strips, parts_of(made), [studs]).values()) == 0.0


def test_bolts_and_blocks_fit_and_their_holes_lie_where_the_node_says(built):
    blocks = fab.ShearBlock(1, 50.0, fab.BIRCH_PLY, bolt=6.0)
    made = joint(bolt=8.0, blocks=blocks).build(built)
    parts = parts_of(made)
    assert max(clash_volumes(made.strips, parts, made.connectors).values()) < LIMIT
    strips = {strip.mark: strip for strip in made.strips.lamellas}
    assert {f.feature for f in made.fixtures} == {Feature.HOLE}
    assert len(made.fixtures) == sum(len(part.holes) for part in parts)
    for fixture in made.fixtures:
        strip = strips[fixture.mark]
        placed = strip.place(np.array([fixture.x + strip.start]), np.zeros(1), np.zeros(1))[0]
        assert np.linalg.norm(placed - fixture.position) < 0.02


def test_a_pipe_has_an_opening(square):
    studs = joint(wall=3.0).build(square).connectors[0]
    for shape in studs.shapes:
        (opening,) = shape.openings
        assert sides(shape.outline) - sides(opening) == pytest.approx(6.0)


def test_the_bill_counts_every_stud_bolt_and_block(square):
    made = joint(bolt=8.0, blocks=fab.ShearBlock(2, 40.0, fab.BIRCH_PLY)).build(square)
    count = dict.fromkeys(("stud", "bolt", "nut", "shear block"), 0.0)
    for line in made.bill:
        count[line.item] += line.quantity
    bays = sum(len(lamella.stations) - 1 for lamella in square.lamellas)
    assert count == {"stud": 16, "bolt": 32, "nut": 32, "shear block": 2 * bays}


def test_the_curvature_off_a_helicoid_is_that_of_the_formula():
    """On a hypar the rate of twist w is known: at d the curvature is w^2 d / (1 + w^2 d^2)."""
    surface, level = gs.Hypar(3000.0), 40.0
    patch = gs.AsymptoticPatch(p=(-0.4, 0.4), q=(-0.4, 0.4), lamellas=(5, 5))
    net = gs.diagonal_meshes(gs.control_patch(surface, patch))[0]
    made = joint(level=level).build(fab.structure(net, PROFILE))
    middle = [s for s in made.strips.lamellas if s.mark in ("A3L", "A3R", "B3L", "B3R")]
    rate = 1.0 / 3000.0
    expected = rate**2 * level / (1.0 + rate**2 * level**2)
    for strip in middle:
        _, strong = strip.bending(np.array([(strip.start + strip.end) / 2.0]))
        assert abs(strong[0]) == pytest.approx(expected, rel=0.01)
    (found,) = [f for f in made.findings if f.code == "level-bend"]
    stress = PROFILE.material.modulus * expected * 30.0
    assert stress * 0.99 < found.value < 1.1 * stress
    assert found.severity is Severity.INFO


@pytest.mark.parametrize(
    ("settings", "code"),
    [
        ({"length": 100.0}, None),
        ({"length": 50.0}, "stud-short"),
        ({"length": 150.0}, "stud-long"),
        ({"size": 30.0}, "stud-room"),
        ({"bolt": 26.0}, "bolt-edge"),
        ({"blocks": fab.ShearBlock(3, 300.0, fab.BIRCH_PLY)}, "block-length"),
    ],
)
def test_what_does_not_go_is_told(square, settings, code):
    found = {f.code for f in joint(**settings).build(square).findings}
    assert (found - {"stud-assembly", "level-bend"}) == ({code} if code else set())


@pytest.mark.parametrize(
    ("make", "where"),
    [
        (lambda: fab.StudJoint(3.0, fab.Stud(fab.BIRCH_PLY)), "spacing"),
        (lambda: joint(level=20.0), "level"),
    ],
)
def test_strips_that_would_lie_in_each_other_are_refused(square, make, where):
    with pytest.raises(gs.SettingError, match="lie in each other") as info:
        make().build(square)
    assert info.value.where == where


@pytest.mark.parametrize("key", ["size", "length", "wall", "fit", "step"])
def test_a_stud_of_no_size_is_refused(key):
    with pytest.raises(gs.SettingError) as info:
        fab.Stud(fab.BIRCH_PLY, **{key: -1.0})
    assert info.value.where == f"stud.{key}"


def test_rings_and_singular_nodes_have_studs_where_two_lamellas_cross(ring, tube, saddle):
    for one in (ring, tube, saddle):
        made = fab.StudJoint(
            30.0, fab.Stud(fab.S235, wall=2.0), blocks=fab.ShearBlock(1, 30.0, fab.S235)
        ).build(one.structure)
        regular = sum(node.regular for node in one.structure.nodes)
        assert len(made.connectors[0].bodies) == regular


def test_blocks_may_fill_a_bay_from_stud_to_stud(square):
    """One block in the middle of the shortest bay: all of it but half a stud at either end."""
    shortest = min(float(np.diff(lamella.stations).min()) for lamella in square.lamellas)
    size = sides(joint().build(square).connectors[0].shapes[0].outline)
    for length, codes in (
        (shortest - 1.1 * size, set()),
        (shortest - 0.8 * size, {"block-length"}),
    ):
        blocks = fab.ShearBlock(1, length, fab.BIRCH_PLY)
        found = {f.code for f in joint(blocks=blocks).build(square).findings}
        assert found - {"stud-assembly", "level-bend", "block-room"} == codes
