from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import fabrication as fab
import gridshell as gs
from fabrication.structures import SEAM

NAMES = ["catenoid", "enneper", "hypar", "pair", "ring"]


def owners(design, family):
    """(n,) number of the lamella of *family* at each node, counted from 0 within the family."""
    members = [one for one in design.structure.lamellas if one.family == family]
    owner = np.full(len(design.net.vertices), -1)
    for number, lamella in enumerate(members):
        owner[lamella.nodes] = number
    return owner


# ---- marks ----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", [*NAMES, "tube", "saddle"])
def test_marks_count_up_within_each_family(name, request):
    lamellas = request.getfixturevalue(name).structure.lamellas
    for family, letter in ((1, "A"), (2, "B")):
        marks = [one.mark for one in lamellas if one.family == family]
        assert marks == [f"{letter}{number}" for number in range(1, len(marks) + 1)]


def test_family_1_comes_first(saddle):
    families = [one.family for one in saddle.structure.lamellas]
    assert families == sorted(families)


@pytest.mark.parametrize("name", ["catenoid", "enneper", "hypar", "pair"])
@pytest.mark.parametrize("family", [1, 2])
def test_neighbours_have_consecutive_numbers(name, family, request):
    design = request.getfixturevalue(name)
    across = design.net.edges[design.net.family != family]
    a, b = owners(design, family)[across.T]
    assert (np.abs(a - b) == 1).all()


@pytest.mark.parametrize("family", [1, 2])
def test_numbers_begin_at_a_side_wherever_the_first_vertex_lies(catenoid, profile, family):
    """The vertex in the middle of the net becomes the first one."""
    control, middle = catenoid.control, catenoid.net.control_vertices[12]
    order = np.r_[middle, np.delete(np.arange(len(control.vertices)), middle)]
    mesh = gs.QuadMesh(control.vertices[order], np.argsort(order)[control.quads])
    net = gs.diagonal_meshes(gs.ControlMesh(mesh, control.colour[order]))[0]
    structure = fab.structure(net, profile)
    centre = next(node for node in structure.nodes if node.name == "N1")
    assert {structure.lamellas[c.lamella].mark for c in centre.crossings} == {"A3", "B3"}
    owner = owners(replace(catenoid, net=net, structure=structure), family)
    a, b = owner[net.edges[net.family != family].T]
    assert (np.abs(a - b) == 1).all()


@pytest.mark.parametrize("family", [1, 2])
def test_numbers_go_once_around_a_ring(ring, family):
    owner = owners(ring, family)
    count = owner.max() + 1
    across = ring.net.edges[ring.net.family != family]
    a, b = owner[across.T]
    assert set(np.abs(a - b).tolist()) == {1, count - 1}


def test_the_lamellas_a_patch_names_first_are_family_a(profile):
    patch = gs.AsymptoticPatch(p=(-0.3, 0.3), q=(-0.3, 0.3), lamellas=(3, 5))
    net = gs.diagonal_meshes(gs.control_patch(gs.Hypar(6000.0), patch))[0]
    marks = [one.mark for one in fab.structure(net, profile).lamellas]
    assert [mark for mark in marks if mark.startswith("A")] == ["A1", "A2", "A3"]


def identity(structure):
    lamellas = [(one.mark, one.nodes.tolist(), one.stations.tolist()) for one in structure.lamellas]
    nodes = [
        (node.name, node.position.tolist(), [c.lamella for c in node.crossings])
        for node in structure.nodes
    ]
    return lamellas, nodes


@pytest.mark.parametrize("name", ["enneper", "ring", "tube", "saddle"])
def test_the_same_net_gives_the_same_marks_and_names(name, request, profile):
    design = request.getfixturevalue(name)
    again = fab.structure(design.net, profile)
    assert identity(again) == identity(design.structure)


@pytest.mark.parametrize("name", ["enneper", "ring", "tube"])
def test_marks_and_names_survive_the_file_of_the_net(name, request, profile, tmp_path):
    design = request.getfixturevalue(name)
    gs.write_net(tmp_path / "net.json", design.control)
    net = gs.diagonal_meshes(gs.read_net(tmp_path / "net.json"))[0]
    assert identity(fab.structure(net, profile)) == identity(design.structure)


def test_node_names_are_the_vertex_numbers_of_the_net(enneper):
    names = [node.name for node in enneper.structure.nodes]
    assert names == [f"N{v + 1}" for v in range(len(enneper.net.vertices))]


# ---- nodes ----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", NAMES)
def test_a_node_axis_is_perpendicular_to_both_lamellas(name, request):
    structure = request.getfixturevalue(name).structure
    crossed = [node for node in structure.nodes if node.regular]
    for node in crossed:
        assert np.linalg.norm(node.axis) == pytest.approx(1.0, abs=1e-12)
        for crossing in node.crossings:
            axis = structure.lamellas[crossing.lamella].axis
            tangent = axis.tangents(np.array([crossing.station]))[0]
            assert abs(tangent @ node.axis) < 1e-12
    assert len(crossed) >= 4


@pytest.mark.parametrize("name", NAMES)
def test_both_strips_stand_along_the_node_axis(name, request):
    structure = request.getfixturevalue(name).structure
    for node in structure.nodes:
        for crossing in node.crossings if node.regular else ():
            lamella = structure.lamellas[crossing.lamella]
            upright = lamella.frames(np.array([crossing.station])).n[0]
            np.testing.assert_allclose(upright, node.axis, atol=1e-9)


@pytest.mark.parametrize("name", [*NAMES, "tube", "saddle"])
def test_crossings_lead_to_the_position_of_their_node(name, request):
    structure = request.getfixturevalue(name).structure
    for node in structure.nodes:
        for crossing in node.crossings:
            axis = structure.lamellas[crossing.lamella].axis
            np.testing.assert_allclose(axis.spline(crossing.station), node.position, atol=1e-8)


@pytest.mark.parametrize("name", [*NAMES, "tube"])
def test_node_axes_are_on_one_side_of_the_surface(name, request):
    design = request.getfixturevalue(name)
    axes = np.array([node.axis for node in design.structure.nodes])
    a, b = design.net.edges.T
    assert np.einsum("nc,nc->n", axes[a], axes[b]).min() > 0.5


@pytest.mark.parametrize(("name", "degrees"), [("catenoid", 90.0), ("enneper", 60.0)])
def test_lamellas_cross_at_the_angle_of_the_net(name, degrees, request):
    """Inside the net; at its edge a spline through five nodes is less sure of its tangent."""
    design = request.getfixturevalue(name)
    inner = design.net.stars.closed
    angles = [
        node.angle for node, inside in zip(design.structure.nodes, inner, strict=True) if inside
    ]
    np.testing.assert_allclose(np.degrees(angles), degrees, atol=0.2)


def test_angles_of_a_hypar_are_those_of_its_rulings(hypar):
    surface = gs.Hypar(6000.0)
    for node in hypar.structure.nodes:
        x, y, _ = node.position / surface.scale
        d = surface.derivatives((x + y) / 2.0, (x - y) / 2.0)
        along_p, along_q = d.xu + d.xv, d.xu - d.xv
        cosine = along_p @ along_q / np.linalg.norm(along_p) / np.linalg.norm(along_q)
        assert abs(np.cos(node.angle)) == pytest.approx(abs(cosine), abs=1e-9)


def test_the_star_tilt_of_a_planar_star_is_small(catenoid):
    inner = catenoid.net.stars.closed
    nodes = np.array(catenoid.structure.nodes, dtype=object)[inner]
    assert max(node.star_tilt for node in nodes) < np.radians(1.0)


def test_lamellas_of_family_1_are_named_first_at_a_node(enneper):
    for node in enneper.structure.nodes:
        families = [enneper.structure.lamellas[c.lamella].family for c in node.crossings]
        assert families == [1, 2]


def test_a_strip_that_ends_alone_still_stands_on_the_surface(profile):
    """D2 of a patch ends in vertices that only one lamella reaches."""
    surface = gs.Hypar(6000.0)
    patch = gs.AsymptoticPatch(p=(-0.2, 0.2), q=(-0.2, 0.2), lamellas=(3, 3))
    net = gs.diagonal_meshes(gs.control_patch(surface, patch))[1]
    nodes = [node for node in fab.structure(net, profile).nodes if len(node.crossings) == 1]
    normals = surface.closest(np.array([node.position for node in nodes])).normals
    cosines = np.abs([node.axis @ normal for node, normal in zip(nodes, normals, strict=True)])
    assert np.degrees(np.arccos(np.minimum(cosines, 1.0))).max() < 1.0


# ---- ends -----------------------------------------------------------------------------------


def test_strips_reach_half_their_width_beyond_their_end_nodes(catenoid, profile):
    for lamella in catenoid.structure.lamellas:
        assert lamella.start == -profile.width / 2.0
        assert lamella.end == pytest.approx(lamella.axis.length + profile.width / 2.0)


def test_another_overhang_can_be_asked_for(catenoid, profile):
    built = fab.structure(catenoid.net, profile, overhang=17.0)
    assert {one.start for one in built.lamellas} == {-17.0}


@pytest.mark.parametrize("overhang", [0.0, -5.0, np.nan, np.inf])
def test_an_overhang_that_is_not_positive_is_refused(catenoid, profile, overhang):
    with pytest.raises(gs.SettingError, match="beyond their end nodes") as info:
        fab.structure(catenoid.net, profile, overhang=overhang)
    assert info.value.where == "overhang"


def singular(design):
    (node,) = (node for node in design.structure.nodes if len(node.crossings) > 2)
    return node


def test_six_lamellas_end_at_a_vertex_of_valence_six(saddle):
    node = singular(saddle)
    assert len(node.crossings) == 6
    assert not node.regular
    assert node.angle is None


def test_lamellas_stop_short_of_a_singular_node(saddle):
    for crossing in singular(saddle).crossings:
        lamella = saddle.structure.lamellas[crossing.lamella]
        at_start = crossing.station == 0.0
        gap = lamella.start if at_start else lamella.axis.length - lamella.end
        assert gap > 0.0


def test_lamellas_that_end_at_a_singular_node_leave_each_other_room(saddle, profile):
    """Six bars around a point, thickness t: each must start t / 2 / tan(30 degrees) out or more."""
    corners = []
    for crossing in singular(saddle).crossings:
        lamella = saddle.structure.lamellas[crossing.lamella]
        s = lamella.start if crossing.station == 0.0 else lamella.end
        y = np.array([-0.5, 0.5]) * profile.thickness
        corners.append(lamella.place(np.full(2, s), y, np.zeros(2)))
    points = np.concatenate(corners)
    apart = np.linalg.norm(points[:, None] - points[None], axis=2)
    assert apart[np.triu_indices(12, 1)].min() > 0.5


def test_a_singular_node_is_a_finding_and_not_a_slot(saddle):
    node = singular(saddle)
    (finding,) = fab.SlotJoint().build(saddle.structure).findings
    assert (finding.code, finding.where, finding.severity) == (
        "singular-node",
        node.name,
        fab.Severity.WARNING,
    )
    assert (finding.value, finding.limit) == (6.0, 2.0)
    assert node.name not in {slot.node for part in saddle.parts for slot in part.slots}


def hoops(design):
    return [one for one in design.structure.lamellas if one.closed]


def test_hoops_of_a_tube_are_closed(tube):
    assert len(hoops(tube)) >= 2
    assert {one.family for one in hoops(tube)} in ({1}, {2})


def test_a_closed_strip_is_a_seam_shorter_than_its_loop(tube):
    for lamella in hoops(tube):
        assert tube.part(lamella.mark).length == pytest.approx(lamella.axis.length - SEAM, abs=1e-9)


def test_the_ends_of_a_closed_strip_meet_half_way_between_two_nodes(tube):
    for lamella in hoops(tube):
        last_bay = lamella.axis.length - lamella.stations[-1]
        gaps = -lamella.start, lamella.end - lamella.stations[-1]
        assert gaps == pytest.approx([(last_bay - SEAM) / 2.0] * 2, abs=1e-9)


def test_all_nodes_of_a_closed_strip_lie_on_its_flat_part(tube):
    for lamella in hoops(tube):
        part = tube.part(lamella.mark)
        assert len(part.slots) == len(lamella.nodes)
        inside = [0.0 < slot.x < part.length for slot in part.slots]
        assert all(inside)


def test_consecutive_stations_grow(tube):
    for lamella in tube.structure.lamellas:
        assert all(a < b for a, b in pairwise(lamella.stations))
