import re
import time
from math import radians
from xml.etree import ElementTree

import numpy as np
import pytest

import gridshell as gs
from gridshell.mesh import grid_quads
from gridshell.painter import Dots, Faces, Lines, padded, painted
from gridshell.picture import card, limits, pale, size, sketch, straight


def grid(rows, columns, rise=0.0, side=500.0):
    x, y = np.meshgrid(np.arange(rows + 1.0), np.arange(columns + 1.0), indexing="ij")
    z = rise * (x - rows / 2.0) * (y - columns / 2.0)
    vertices = side * np.stack([x, y, z], axis=-1).reshape(-1, 3)
    return gs.QuadMesh(vertices, grid_quads(rows, columns))


def shown(thing):
    """The HTML as XML: its figures by name, all faces and all lines drawn (k, 2), its notes."""
    root = ElementTree.fromstring(thing._repr_html_())
    figures = {row[0].text: row[1].text for row in root.iter("tr")}
    faces, lines = [], {}
    for path in root.iter("{http://www.w3.org/2000/svg}path"):
        moves = [
            np.array([pair.split() for pair in re.split("[LZ]", move) if pair], dtype=float)
            for move in path.get("d").split("M")[1:]
        ]
        if path.get("class") == "lines":
            lines.setdefault(path.get("color"), []).extend(moves)
        else:
            faces += moves
    return figures, faces, lines, [note.text for note in root.iter("p")]


FAMILIES = ("#cc8540", "#5c7894")


def test_a_control_mesh_shows_its_quads_and_d1_by_family():
    control = gs.as_control_mesh(grid(6, 4, rise=0.05))
    net = gs.diagonal_meshes(control)[0]
    figures, faces, lines, notes = shown(control)
    assert len(faces) == len(control.quads)
    for number, colour in enumerate(FAMILIES, start=1):
        assert len(lines[colour]) == np.count_nonzero(net.family == number)
    assert figures["Faces"] == "24"
    assert figures["Vertices"] == "35"
    assert figures["Spans"] == "3.00 x 2.00 x 0.30 m"
    assert notes == []


def test_node_angles_are_those_of_the_net():
    control = gs.as_control_mesh(grid(6, 4, rise=0.05))
    angles = np.degrees(gs.node_angles(control))
    expected = f"{angles.min():.2f} to {angles.max():.2f} degrees"
    assert shown(control)[0]["Node angle"] == expected
    net = gs.diagonal_meshes(control)[0]
    centre = np.flatnonzero(net.stars.closed & (net.stars.count == 4))
    found = []
    for v in centre:
        ways = {}
        for spoke, edge in zip(net.stars.spokes[v, :4], net.spoke_edges[v, :4], strict=True):
            ways.setdefault(int(net.family[edge]), []).append(net.vertices[spoke])
        first, second = (ends[1] - ends[0] for ends in (ways[1], ways[2]))
        cosine = abs(first @ second) / np.linalg.norm(first) / np.linalg.norm(second)
        found.append(np.degrees(np.arccos(cosine)))
    low, high = (float(x) for x in re.findall(r"[\d.]+", shown(net)[0]["Node angle"])[:2])
    assert min(low, 180.0 - high) == pytest.approx(min(found), abs=0.006)


def test_a_quad_mesh_shows_every_edge():
    mesh = grid(5, 3, rise=0.05)
    figures, faces, lines, _ = shown(mesh)
    assert len(faces) == len(mesh.quads)
    assert [len(own) for own in lines.values()] == [len(mesh.edges)]
    assert figures["Mean edge"] == f"{mesh.mean_edge:.1f} mm"


def test_an_optimised_net_says_how_well_it_is_met():
    patch = gs.AsymptoticPatch(p=(-0.5, 0.5), q=(-0.5, 0.5), lamellas=(5, 5))
    start = gs.control_patch(gs.Enneper(4000.0), patch)
    result = gs.optimize(start, gs.a_net(angle=radians(60)), anchor=gs.Free())
    figures, faces, _, _ = shown(result)
    assert figures["Status"] == result.status
    assert figures["Node angle"] == "60.00 degrees"
    worst = result.quality.angle_error_deg.max
    assert figures["Angle error, largest"] == f"{worst:.3g} degrees"
    assert "Rhombus error, largest" not in figures
    assert len(faces) == len(start.quads)


def test_a_mesh_without_families_shows_its_own_edges():
    control = gs.as_control_mesh(grid(3, 3))
    loose = type(control)(control.mesh, np.full(len(control.vertices), -1))
    figures, faces, lines, _ = shown(loose)
    assert len(faces) == 9
    assert not set(FAMILIES) & set(lines)
    assert "Node angle" not in figures


def test_the_picture_does_not_move_with_the_net_nor_grow_with_it():
    mesh = grid(6, 4, rise=0.05)
    pictures = [
        shown(gs.as_control_mesh(mesh.moved(scale * mesh.vertices + shift)))
        for scale, shift in ((1.0, 0.0), (1.0, np.array([4096.0, -8192.0, 512.0])), (16.0, 0.0))
    ]
    for _, faces, lines, _ in pictures[1:]:
        for drawn, first in (
            (faces, pictures[0][1]),
            *((lines[c], pictures[0][2][c]) for c in lines),
        ):
            middles = [sorted(one.mean(axis=0).tolist() for one in rows) for rows in (drawn, first)]
            np.testing.assert_allclose(*middles, atol=0.2)


def test_what_is_nearer_is_drawn_later():
    square = np.array([[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]], dtype=float) * 1000.0
    lower = Faces(square, painted((1.0, 0.0, 0.0), 1))
    upper = Faces(square + np.array([0.0, 0.0, 500.0]), painted((0.0, 0.0, 1.0), 1))
    for layers in ((lower, upper), (upper, lower)):
        colours = re.findall(r'color="#(..)..(..)"', sketch(layers, label=""))
        assert [colour[1] != "00" for colour in colours] == [False, True]


def test_overlapping_faces_of_one_path_turn_alike():
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
    both = np.stack([square, square[::-1]])
    text = sketch([pale(both)], label="")
    areas = []
    for move in re.findall(r"M([^M]*)Z", text):
        x, y = np.array([pair.split() for pair in move.split("L")], dtype=float).T
        areas.append((x * np.roll(y, -1) - y * np.roll(x, -1)).sum())
    assert len(areas) == 2
    assert np.prod(np.sign(areas)) > 0.0


@pytest.mark.parametrize("rows", [20, 38])
def test_a_picture_is_light_and_quick(rows):
    control = gs.as_control_mesh(grid(rows, rows, rise=0.02))
    control._repr_html_()  # modules are loaded
    begun = time.perf_counter()
    for thing in (control, control.mesh, gs.diagonal_meshes(control)[0]):
        assert len(thing._repr_html_()) < 200_000
    assert time.perf_counter() - begun < 0.9


def test_of_a_large_net_some_lines_are_drawn_and_it_says_so():
    mesh = grid(120, 120, rise=0.01)
    for thing in (mesh, gs.as_control_mesh(mesh), gs.diagonal_meshes(gs.as_control_mesh(mesh))[0]):
        _, faces, lines, notes = shown(thing)
        assert faces == []
        assert 500 < sum(map(len, lines.values())) < 4_000
        assert "large net" in notes[0]


def test_one_quad_and_half_a_net_are_drawn():
    one = gs.as_control_mesh(grid(1, 1))
    assert len(shown(one)[1]) == 1
    for net, colour in zip(gs.diagonal_meshes(one), FAMILIES, strict=True):
        figures, faces, lines, _ = shown(net)
        assert faces == []
        assert list(lines) == [colour]
        assert "Node angle" not in figures


def test_nothing_to_draw_is_no_fault():
    empty = [pale(np.zeros((0, 4, 3))), straight(np.zeros((0, 3)), np.zeros((0, 2), dtype=int))]
    for layers in ([], empty, [Dots(np.zeros((1, 3)), painted((0.0, 0.0, 0.0), 1), 1.0)]):
        ElementTree.fromstring(sketch(layers, label="nothing"))
    point = Lines(np.zeros((1, 2, 3)), painted((0.0, 0.0, 0.0), 1), 1.0)
    assert "nan" not in sketch([point], label="a point")
    assert size(np.zeros((0, 3))) == ""
    assert limits(np.array([np.nan]), "mm") == ""
    assert padded([]).shape == (0, 3, 3)


def test_all_text_is_escaped():
    hostile = "<script>alert('x')</script> & \"é\""
    picture = sketch([], label=hostile)
    root = ElementTree.fromstring(
        card(hostile, [(hostile, hostile)], picture=picture, notes=[hostile])
    )
    assert root.find(".//script") is None
    assert root[0].text == hostile
    assert root[1].get("aria-label") == hostile
    assert [cell.text for cell in root.iter("td")] == [hostile]
    assert [note.text for note in root.iter("p")] == [hostile]


def test_a_skin_shows_its_panels():
    skin = gs.skin(gs.as_control_mesh(grid(6, 4, rise=0.05)), gs.Skin.D1)
    figures, faces, lines, _ = shown(skin)
    assert len(faces) == len(skin.faces) == int(figures["Panels"])
    assert sum(map(len, lines.values())) == len(skin.edges)
