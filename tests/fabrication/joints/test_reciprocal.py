from dataclasses import replace
from functools import cache
from itertools import pairwise
from math import cos, pi, radians, sin, tan

import manifold3d
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import fabrication as fab
import gridshell as gs
from fabrication.joints.piece_ends import face_end
from fabrication.outlines import outline_area

T = 2.5
ANGLES = (45, 60, 75, 90, 120)
CLEAT = fab.Cleat(leg=30.0, thickness=3.0, height=60.0, material=fab.S235, play=0.6)


@cache
def oblique(degrees: int, thickness: float = T) -> fab.Structure:
    """Three twisted lamellas each way at about the angle, on an optimised piece of Enneper's."""
    patch = gs.AsymptoticPatch(p=(-0.4, 0.4), q=(-0.4, 0.4), lamellas=(3, 3))
    start = gs.control_patch(gs.Enneper(4000.0), patch)
    best = gs.optimize(start, gs.a_net(angle=radians(degrees)), anchor=gs.Free()).require()
    profile = fab.Profile(width=100.0, thickness=thickness, material=fab.S235)
    return fab.structure(gs.diagonal_meshes(best.control)[0], profile)


# ---- solids, meshed without the joint's own formulas ------------------------------------------


def block(corners: np.ndarray) -> manifold3d.Manifold:
    """The solid of a lattice of points (i, 2, k, 3)."""
    i, j, k = corners.shape[:3]
    number = np.arange(i * j * k).reshape(i, j, k)
    faces = []
    for axis in range(3):
        for side in (0, -1):
            sheet = np.take(number, side, axis=axis)
            a, b, c, d = sheet[:-1, :-1], sheet[1:, :-1], sheet[1:, 1:], sheet[:-1, 1:]
            quads = np.stack([a, b, c, d], axis=-1).reshape(-1, 4)
            faces.append(quads[:, ::-1] if (side == 0) != (axis == 1) else quads)
    quads = np.concatenate(faces)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    points = np.ascontiguousarray(corners.reshape(-1, 3))
    solid = manifold3d.Manifold(
        manifold3d.Mesh64(vert_properties=points, tri_verts=triangles.astype(np.uint64))
    )
    assert solid.volume() > 0.0
    return solid


def length_of(lamella, near, far, *, thickness, height, slices=16):
    """A length of a strip; *near*, *far* are the stations of its two faces' ends."""
    share = np.linspace(0.0, 1.0, slices + 1)
    s = np.stack([a + share * (b - a) for a, b in (far, near)], axis=1)
    z = np.linspace(-height / 2.0, height / 2.0, 9)
    s, z = np.repeat(s[..., None], 9, 2), np.broadcast_to(z, (slices + 1, 2, 9))
    y = np.broadcast_to(np.array([-thickness / 2, thickness / 2])[None, :, None], z.shape)
    placed = lamella.place(s.ravel(), y.ravel(), z.ravel())
    return block(placed.reshape(*s.shape, 3))


def ends_at_nodes(jointed):
    """Solids of every cut end, of what runs through there, and where: all from parts and maps."""
    parts = {part.mark: part for part in fab.parts_of(jointed)}
    profile = jointed.strips.profile
    size = {"thickness": profile.thickness, "height": profile.width}
    strips = {lamella.mark: lamella for lamella in jointed.strips.lamellas}
    for fixture in jointed.fixtures:
        piece, part = strips[fixture.mark], parts[fixture.mark]
        (node,) = (n for n in jointed.strips.nodes if n.name == fixture.node)
        regular = {n.name for n in jointed.design.nodes if n.regular}
        near = np.linalg.norm(fixture.position - node.position) < 10.0 * profile.thickness
        if near and node.name in regular:
            yield piece, part, fixture, node, size


def piece_end(piece, part, fixture, size, longer=0.0):
    at_start = fixture.feature is fab.Feature.START
    near, far = (np.array([f[:, 0].min(), f[:, 0].max()]) + piece.start for f in part.faces)
    length = 12.0 * size["thickness"]
    ways = []
    for face in (near, far):
        tip = face[0] - longer if at_start else face[1] + longer
        ways.append((tip, tip + length) if at_start else (tip - length, tip))
    return length_of(piece, ways[0], ways[1], **size)


def through_strip(jointed, piece, node, size):
    others = [
        (jointed.strips.lamellas[c.lamella], c.station)
        for c in node.crossings
        if jointed.strips.lamellas[c.lamella].family != piece.family
    ]
    ((lamella, station),) = others
    reach = 12.0 * size["thickness"]
    span = (station - reach, station + reach)
    return length_of(lamella, span, span, **size)


def clashes(jointed, longer):
    return [
        (
            through_strip(jointed, piece, node, size)
            ^ piece_end(piece, part, fixture, size, longer)
        ).volume()
        for piece, part, fixture, node, size in ends_at_nodes(jointed)
    ]


SETTINGS = [
    {},
    {"through": 2},
    {"pinwheel": True},
    {"square_ends": True},
]


@pytest.mark.parametrize("degrees", ANGLES)
@pytest.mark.parametrize("setting", SETTINGS)
def test_no_piece_touches_what_runs_through_and_every_one_does_at_a_twentieth_more(
    degrees, setting
):
    design = oblique(degrees)
    drawn = clashes(fab.ReciprocalJoint(gap=0.2, **setting).build(design), 0.0)
    more = clashes(fab.ReciprocalJoint(gap=0.0, **setting).build(design), 0.05)
    assert len(drawn) == len(more) >= 12
    assert max(drawn) < 1e-3
    assert min(more) > 1e-3


@pytest.mark.parametrize("degrees", ANGLES)
def test_without_a_gap_ends_touch_within_a_hundredth(degrees):
    joint = fab.ReciprocalJoint(gap=0.0)
    shorter = clashes(joint.build(oblique(degrees)), -0.01)
    longer = clashes(joint.build(oblique(degrees)), 0.01)
    assert max(shorter) < 1e-3
    assert min(longer) > 0.0


# ---- lengths and bevels of flat strips: FABRICATION's formulas by plane geometry -------------


@given(st.floats(0.3, 2.8), st.floats(0.5, 10.0), st.floats(0.5, 10.0), st.floats(-50.0, 50.0))
def test_flat_strips_end_half_a_thickness_over_the_sine_from_the_node(angle, t1, t2, z):
    at = {
        y: float(
            face_end(
                angle=angle,
                twist=0.0,
                through_twist=0.0,
                y=y,
                through_thickness=t1,
                heights=np.array(z),
            )
        )
        for y in (-t2 / 2.0, 0.0, t2 / 2.0)
    }
    assert at[0.0] == pytest.approx(t1 / (2.0 * sin(angle)))
    longest = max(at.values())
    assert longest - at[0.0] == pytest.approx(t2 / (2.0 * abs(tan(angle))), abs=1e-9)
    for y, s in at.items():
        left = np.array([cos(angle) * s - sin(angle) * y, sin(angle) * s + cos(angle) * y])
        assert left[1] == pytest.approx(t1 / 2.0)


def middle_lengths(jointed):
    """Length of the middle line of every piece, by its mark."""
    return {
        part.mark: part.length - sum(abs(b) for b in part.bevels) / 2.0
        for part in fab.parts_of(jointed)
    }


def test_on_a_hypar_pieces_are_bays_less_what_the_through_strips_take(hypar):
    """Straight lamellas: chords between nodes are bays, angles are those between chords."""
    gap = 0.4
    jointed = fab.ReciprocalJoint(gap=gap).build(hypar.structure)
    position = {i: node.position for i, node in enumerate(hypar.structure.nodes)}
    lengths, count = middle_lengths(jointed), 0
    for lamella in hypar.structure.lamellas:
        if lamella.family == 1:
            continue
        cut = [i for i in lamella.nodes.tolist() if hypar.structure.nodes[i].regular]
        firsts = [m for m in lengths if m.startswith(lamella.mark + ".")]
        free = int(lamella.nodes[0] != cut[0])
        for number, (a, b) in enumerate(pairwise(cut)):
            bay = np.linalg.norm(position[b] - position[a])
            sines = [sin(hypar.structure.nodes[i].angle) for i in (a, b)]
            expected = bay - sum(T / (2.0 * s) for s in sines) - gap
            assert 0.0 <= expected - lengths[firsts[number + free]] < 0.05
            count += 1
    assert count >= 6


@pytest.mark.parametrize("degrees", ANGLES)
def test_the_end_of_the_near_face_is_cut_at_the_node_angle(degrees):
    design = oblique(degrees)
    jointed = fab.ReciprocalJoint().build(design)
    found = 0
    for lamella in jointed.strips.lamellas:
        for side, bevel in enumerate(jointed.cuts[lamella.mark].bevels):
            node = design.nodes[int(lamella.nodes[-side])]
            if lamella.family == 2 and node.regular:
                assert abs(bevel) == pytest.approx(T / abs(tan(node.angle)), abs=0.1)
                found += 1
    assert found >= 12


def test_square_ends_are_shorter_by_half_of_each_bevel():
    design = oblique(60)
    bevelled, square = (
        fab.ReciprocalJoint(square_ends=square).build(design) for square in (False, True)
    )
    assert {cuts.bevels for cuts in square.cuts.values()} == {(0.0, 0.0)}
    for mark, length in middle_lengths(square).items():
        trimmed = sum(abs(b) for b in bevelled.cuts[mark].bevels) / 2.0
        assert middle_lengths(bevelled)[mark] - length == pytest.approx(trimmed, abs=1e-6)


# ---- pieces ------------------------------------------------------------------------------------


@pytest.mark.parametrize("degrees", ANGLES)
@pytest.mark.parametrize("setting", SETTINGS)
def test_ends_come_to_lie_where_net_and_partner_say(degrees, setting):
    """Both edges, too; the places are taken from the nodes, not from the pieces' maps."""
    jointed = fab.ReciprocalJoint(**setting).build(oblique(degrees))
    assert_closed(jointed)


def assert_closed(jointed):
    strips = {lamella.mark: lamella for lamella in jointed.strips.lamellas}
    assert len(jointed.fixtures) == 2 * len(strips)
    for fixture in jointed.fixtures:
        strip = strips[fixture.mark]
        for z in (-50.0, 0.0, 50.0):
            s = np.array([fixture.x + strip.start])
            (placed,) = strip.place(s, np.zeros(1), np.array([z]))
            assert np.linalg.norm(placed - fixture.position - z * fixture.axis) < 0.02


@pytest.mark.parametrize("name", ["ring", "tube", "saddle", "catenoid"])
@pytest.mark.parametrize("through", [1, 2])
def test_rings_and_singular_nodes_close_too(name, through, request):
    design = request.getfixturevalue(name).structure
    jointed = fab.ReciprocalJoint(through=through).build(design)
    assert_closed(jointed)
    assert max(clashes(jointed, 0.0)) < 1e-3
    lamellas = [lamella for lamella in design.lamellas if lamella.family == through]
    whole = {lamella.mark for lamella in jointed.strips.lamellas if "." not in lamella.mark}
    assert {lamella.mark for lamella in lamellas} <= whole


def test_a_closed_lamella_that_is_cut_has_as_many_pieces_as_nodes(tube):
    closed = [lamella for lamella in tube.structure.lamellas if lamella.closed]
    jointed = fab.ReciprocalJoint(through=3 - closed[0].family).build(tube.structure)
    for lamella in closed:
        pieces = [p for p in jointed.strips.lamellas if p.mark.startswith(lamella.mark + ".")]
        assert len(pieces) == len(lamella.nodes)
        assert not any(piece.closed for piece in pieces)
        bays = lamella.axis.length
        takes = len(pieces) * (T + 0.5)
        assert sum(piece.length for piece in pieces) == pytest.approx(bays - takes, rel=1e-3)


@pytest.mark.parametrize("name", ["catenoid", "enneper", "tube"])
@pytest.mark.parametrize("through", [1, 2])
def test_in_a_pinwheel_every_piece_crosses_one_node_and_ends_at_its_neighbours(
    name, through, request
):
    design = request.getfixturevalue(name).structure
    jointed = fab.ReciprocalJoint(pinwheel=True, through=through).build(design)
    passing = {node.name: 0 for node in design.nodes}
    for piece in jointed.strips.lamellas:
        inner = [
            design.nodes[i]
            for i, s in zip(piece.nodes.tolist(), piece.stations.tolist(), strict=True)
            if piece.start < s < piece.end
        ]
        regular = [node.name for node in inner if node.regular]
        assert len(regular) <= 1
        for node_name in regular:
            passing[node_name] += 1
    assert {passing[node.name] for node in design.nodes if node.regular} == {1}
    assert_closed(jointed)


def test_a_pinwheel_around_an_odd_ring_is_refused(profile):
    """A helical seam: nine quads around lead from one row to the next."""
    around, rows, step = 9, 4, 500.0
    i, j = np.meshgrid(np.arange(around), np.arange(rows + 1), indexing="ij")
    angle, z = 2.0 * np.pi * i / around, step * (j + i / around - rows / 2.0)
    radius = 1500.0 * np.hypot(1.0, z / 3000.0)
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), z], axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(around), np.arange(rows), indexing="ij")
    here, seam = i * (rows + 1) + j, i == around - 1
    beside = np.where(seam, j + 1, here + rows + 1)
    quads = np.stack([here, beside, beside + 1, here + 1], axis=-1)
    kept = ~seam | (j < rows - 1)
    net = gs.as_control_mesh(gs.QuadMesh(points, quads[kept]))
    design = fab.structure(gs.diagonal_meshes(net)[0], profile)
    with pytest.raises(gs.SettingError, match="does not close around a ring"):
        fab.ReciprocalJoint(pinwheel=True).build(design)


def test_pieces_are_numbered_along_their_lamella(enneper):
    jointed = fab.ReciprocalJoint().build(enneper.structure)
    for number, lamella in enumerate(enneper.structure.lamellas):
        pieces = [
            piece
            for piece, carrier in zip(jointed.strips.lamellas, jointed.carriers, strict=True)
            if carrier == number
        ]
        if lamella.family == 1:
            assert [p.mark for p in pieces] == [lamella.mark]
            continue
        assert [p.mark for p in pieces] == [f"{lamella.mark}.{i + 1}" for i in range(len(pieces))]
        along = lamella.axis.tangents(np.array([lamella.length / 2.0]))[0]
        middles = [p.place(np.array([p.length / 2]), np.zeros(1), np.zeros(1))[0] for p in pieces]
        assert (np.diff(np.array(middles) @ along) > 0.0).all()


# ---- cleats, welds -----------------------------------------------------------------------------


@pytest.mark.parametrize("degrees", ANGLES)
@pytest.mark.parametrize("pinwheel", [False, True])
def test_cleats_touch_neither_strip_nor_each_other(degrees, pinwheel):
    jointed = fab.ReciprocalJoint(cleat=CLEAT, pinwheel=pinwheel).build(oblique(degrees))
    assert "cleat-play" not in {f.code for f in jointed.findings}
    (prisms,) = jointed.connectors
    ends = list(ends_at_nodes(jointed))
    assert len(prisms.bodies) == 2 * len(ends)
    placed = {body.mark: prism(prisms.shapes[body.shape], body.frame) for body in prisms.bodies}
    for piece, part, fixture, node, size in ends:
        own = [placed[f"{piece.mark}-{node.name}{side}"] for side in "ab"]
        long = {**size, "thickness": size["thickness"]}
        for solid in (
            through_strip(jointed, piece, node, long),
            piece_end(piece, part, fixture, long),
        ):
            assert max((cleat ^ solid).volume() for cleat in own) < 1e-3
    everything = list(placed.values())
    for i, one in enumerate(everything):
        for other in everything[i + 1 :]:
            assert (one ^ other).volume() < 1e-3


def prism(shape, frame):
    section = manifold3d.CrossSection([shape.outline[:, :2]])
    solid = manifold3d.Manifold.extrude(section, shape.high - shape.low)
    solid = solid.translate([0.0, 0.0, shape.low])
    matrix = np.column_stack([frame.x, frame.y, frame.normal, frame.origin])
    placed = solid.transform(matrix)
    assert placed.volume() == pytest.approx(shape.volume)
    return placed


def test_a_cleat_without_play_cuts_into_strips_that_twist_and_says_so():
    tight = replace(CLEAT, play=0.0)
    jointed = fab.ReciprocalJoint(cleat=tight).build(oblique(90))
    assert "cleat-play" in {f.code for f in jointed.findings}


@pytest.mark.parametrize("angle", [40.0, 60.0, 90.0, 150.0])
def test_the_outline_of_a_cleat_is_two_legs_of_plate(angle):
    outline = CLEAT.outline(radians(angle))
    overlap = CLEAT.thickness**2 / tan(radians(angle) / 2.0)
    assert outline_area(outline) == pytest.approx(2.0 * 30.0 * 3.0 - overlap)


def test_a_corner_too_sharp_for_a_cleat_is_told_with_the_leg_that_fits():
    thick = fab.Cleat(leg=20.0, thickness=12.0, height=60.0, material=fab.S235)
    jointed = fab.ReciprocalJoint(cleat=thick).build(oblique(45))
    found = [f for f in jointed.findings if f.code == "cleat-sharp"]
    assert found
    assert found[0].limit == pytest.approx(12.0 / tan(radians(46.0) / 2.0), rel=0.05)
    assert len(jointed.connectors[0].bodies) == len(list(ends_at_nodes(jointed)))


def test_the_bill_counts_seams_and_cleats():
    jointed = fab.ReciprocalJoint(cleat=CLEAT).build(oblique(60))
    ends = len(list(ends_at_nodes(jointed)))
    (weld,) = (line for line in jointed.bill if line.item == "weld")
    assert (weld.quantity, weld.unit) == (ends * 200.0, "mm")
    angles = [line for line in jointed.bill if line.item == "angle cleat"]
    assert sum(line.quantity for line in angles) == 2 * ends
    assert fab.ReciprocalJoint(weld=0.0).build(oblique(60)).bill == ()
    (weld,) = fab.ReciprocalJoint(weld=80.0).build(oblique(60)).bill
    assert weld.quantity == ends * 80.0


# ---- findings and errors -----------------------------------------------------------------------


def test_a_good_net_gives_no_findings():
    assert fab.ReciprocalJoint().build(oblique(60)).findings == ()


def test_short_pieces_are_told_and_none_that_is_longer(enneper):
    whole = fab.ReciprocalJoint().build(enneper.structure)
    limit = float(np.median([p.length for p in whole.strips.lamellas if "." in p.mark]))
    jointed = fab.ReciprocalJoint(shortest=limit).build(enneper.structure)
    pieces = {p.mark: p.length for p in jointed.strips.lamellas if "." in p.mark}
    found = {f.where: f.value for f in jointed.findings if f.code == "short-piece"}
    assert found == {mark: length for mark, length in pieces.items() if length < limit}
    assert len(found) > 0


def test_an_angle_below_the_bevel_s_limit_is_an_error_unless_ends_are_square():
    limit = radians(50.0)
    found = fab.ReciprocalJoint(sharpest=limit).build(oblique(45)).findings
    assert {f.code for f in found} == {"sharp-bevel"}
    assert all(f.value < f.limit == pytest.approx(50.0) for f in found)
    assert fab.ReciprocalJoint(sharpest=limit, square_ends=True).build(oblique(45)).findings == ()


def test_a_singular_node_is_told(saddle):
    found = fab.ReciprocalJoint().build(saddle.structure).findings
    assert [f.value for f in found if f.code == "singular-node"] == [6.0]


def test_a_piece_of_which_nothing_is_left_is_refused():
    with pytest.raises(gs.SettingError, match="Nothing is left") as info:
        fab.ReciprocalJoint(gap=5000.0).build(oblique(90))
    assert info.value.where == "B1.1"


def test_cleats_higher_than_the_strips_are_refused():
    with pytest.raises(gs.SettingError, match="higher than the strips"):
        fab.ReciprocalJoint(cleat=replace(CLEAT, height=101.0)).build(oblique(90))


@given(st.sampled_from(["gap", "weld"]), st.one_of(st.floats(max_value=-1e-9), st.just(np.nan)))
def test_negative_lengths_are_refused(key, value):
    with pytest.raises(gs.SettingError) as info:
        fab.ReciprocalJoint(**{key: value})
    assert info.value.where == key


@pytest.mark.parametrize("setting", [{"through": 3}, {"sharpest": 0.0}, {"sharpest": pi / 2}])
def test_settings_out_of_range_are_refused(setting):
    with pytest.raises(gs.SettingError) as info:
        fab.ReciprocalJoint(**setting)
    assert info.value.where == next(iter(setting))


@pytest.mark.parametrize("key", ["leg", "thickness", "height"])
def test_cleats_without_a_size_are_refused(key):
    with pytest.raises(gs.SettingError) as info:
        replace(CLEAT, **{key: 0.0})
    assert info.value.where == key
