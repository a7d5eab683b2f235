import re
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest

import gridshell as gs
from fabrication.errors import OutputError
from fabrication.export import stages as module
from fabrication.export.scene.page import scripts
from fabrication.export.stage_page import stage_scene, write_stages
from fabrication.export.stages import HOTTEST, heat, pictures, stages, view_of
from gridshell.mesh import grid_quads
from gridshell.painter import Dots, Faces, Lines


@pytest.fixture(scope="module")
def made():
    x, y = np.meshgrid(*[np.linspace(-1200, 1200, 33)] * 2, indexing="ij")
    points = np.stack([x, y, 3e-4 * x * x - 2e-4 * y * y], axis=-1).reshape(-1, 3)
    surface = gs.TriangulatedSurface.of_quads(points, grid_quads(32, 32))
    return gs.quadrangulate(surface, gs.Asymptotic(), quads=150)


@pytest.fixture(scope="module")
def found(made):
    return {stage.letter: stage for stage in stages(made, made.control())}


def layer(stage, kind):
    return [one for one in stage.layers if isinstance(one, kind)]


def test_every_stage_of_figure_6_is_there(found, made):
    assert "".join(found) == "abcdef"
    assert [stage.letter for stage in stages(made)] == list("abcde")


def test_a_saddle_is_blue_all_over(found):
    (faces,) = layer(found["a"], Faces)
    assert (faces.colours[:, 2] > faces.colours[:, 0]).mean() > 0.99
    assert "100% of the area is saddle-shaped" in found["a"].caption


def test_the_pair_is_drawn_on_the_surface_and_evenly(found, made):
    first, second = layer(found["b"], Lines)
    assert len(first.ends) == len(second.ends)
    assert 300 < len(first.ends) < 1400
    middles = first.ends.mean(axis=1)
    np.testing.assert_allclose(middles, second.ends.mean(axis=1), atol=1e-9)
    apart = np.linalg.norm(middles[:, None] - middles[None], axis=2) + 1e9 * np.eye(len(middles))
    assert apart.min() > 0.9 * np.sqrt(made.curved.mesh.areas.sum() / 700)


def test_the_vertices_of_m_are_red_and_blue_in_turn(found, made):
    red, blue = layer(found["c"], Dots)
    assert len(red.places) + len(blue.places) == len(made.mesh.vertices)
    assert red.colours[0, 0] > red.colours[0, 2]
    assert blue.colours[0, 2] > blue.colours[0, 0]
    reds = {tuple(place) for place in red.places.tolist()}
    for a, b in made.mesh.vertices[made.mesh.edges].tolist():
        assert (tuple(a) in reds) != (tuple(b) in reds)


def test_c_is_drawn_with_its_edges(found, made):
    faces = layer(found["d"], Faces)[0]
    assert len(faces.corners) == len(made.control().quads)


def test_a_mesh_without_a_control_mesh_has_no_picture_of_one(made):
    poor = replace(made, report=replace(made.report, control_quads=0))
    assert [stage.letter for stage in stages(poor)] == list("abce")


def test_the_colours_of_the_heat_map():
    colours = heat(np.array([0.0, HOTTEST / 2, HOTTEST, 90.0, np.nan]))
    assert colours.shape == (5, 3)
    assert colours[0, 2] > colours[0, 0]
    assert colours[2, 0] > 0.7
    np.testing.assert_array_equal(colours[2], colours[3])
    assert np.ptp(colours[4]) < 0.1


def test_edges_beyond_the_rim_are_grey_and_the_others_cool(found, made):
    (edges,) = layer(found["e"], Lines)
    assert len(edges.ends) == len(made.mesh.edges)
    grey = np.ptp(edges.colours, axis=1) < 0.06
    assert 0 < grey.sum() < 0.4 * len(grey)
    assert (edges.colours[~grey, 2] > edges.colours[~grey, 0]).mean() > 0.9


def test_singular_points_and_infeasible_places_are_marked(made):
    from gridshell.remesh import Spike

    report = replace(
        made.report, singularities=(Spike((0.0, 0.0, 0.0), -0.5, 6),), infeasible_area=0.3
    )
    field = replace(made.field, infeasible=np.arange(len(made.field.first)) % 3 == 0)
    stage = stages(replace(made, report=report, field=field))[-1]
    assert len(layer(stage, Dots)[0].places) == 1
    faces = layer(stage, Faces)[0]
    assert len(np.unique(faces.colours, axis=0)) > 1
    meanings = [meaning for _, meaning in stage.legend]
    assert {"singular point", "no such pair"} <= set(meanings)
    assert "30.0% of the area has no such pair" in stage.caption


def test_the_net_is_a_checkerboard(found, made):
    white, black = layer(found["f"], Faces)
    control = made.control()
    assert len(black.corners) == len(control.quads)
    assert len(white.corners) < len(control.vertices)
    assert white.colours.min() > 0.9
    assert black.colours.max() < 0.5


def test_pictures_are_svg_of_one_size_and_the_same_again(made):
    once, again = pictures(made, made.control()), pictures(made, made.control())
    assert once == again
    sizes = set()
    for picture in once:
        root = ET.fromstring(picture["svg"])
        sizes.add(root.get("viewBox"))
        width, height = map(float, root.get("viewBox").split()[2:])
        numbers = np.array(re.findall(r"[ML]([-\d.]+) ([-\d.]+)", picture["svg"]), dtype=float)
        assert numbers.min() >= 0.0
        assert numbers[:, 0].max() <= width
        assert numbers[:, 1].max() <= height
        assert len(picture["svg"]) < 600_000
    assert len(sizes) == 1


def test_the_eye_is_above_a_roof(made):
    frame = view_of(made).frame
    np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-12)
    assert frame[2, 2] > 0.5


def test_the_page_and_its_pictures_ask_for_nothing_outside(made, tmp_path):
    write_stages(tmp_path, made, name="roof <1>")
    page = (tmp_path / "stages.html").read_text()
    assert "roof &lt;1&gt;" in page
    assert page.count("<figure>") == 5
    ours = page.replace(scripts(), "")
    assert "http" not in ours.replace("http-equiv", "").replace("http://www.w3.org/2000/svg", "")
    assert "default-src 'none'" in ours
    assert len(list(tmp_path.glob("*.svg"))) == 5


def test_one_stage_is_shown_at_a_time_and_all_of_it_is_there(made, tmp_path, chromium):
    write_stages(tmp_path, made, name="roof")
    page = chromium.new_page(viewport={"width": 1100, "height": 900})
    page.goto((tmp_path / "stages.html").as_uri())
    page.locator(".tabs button[aria-pressed=true]").wait_for()
    tabs = page.locator(".tabs button")
    names = tabs.all_inner_texts()
    assert [name[0] for name in names] == list("abcde")
    checked = page.locator(".gv-layer:has(input:checked)")
    assert checked.all_inner_texts() == [names[2]]
    for tab, name in enumerate(names):
        tabs.nth(tab).click()
        assert checked.all_inner_texts() == [name]
    page.close()


def test_the_scene_has_every_polygon_line_and_dot_in_its_colour(made):
    found = stages(made)
    scene = stage_scene(found)
    for stage in found:
        own = [one for one in scene.layers if one.name[0] == stage.letter]
        for kind, drawn in ((Faces, "faces"), (Lines, "lines"), (Dots, "dots")):
            wanted = [one for one in stage.layers if isinstance(one, kind)]
            shown = [one for one in own if one.kind == drawn]
            count = sum(len(one.colours) for one in wanted)
            if kind is Faces:
                assert sum(len(one.sizes) for one in shown) == count
                for layer, whole in zip(wanted, shown, strict=True):
                    np.testing.assert_array_equal(whole.colours, layer.colours)
                    corners = whole.points[whole.triangles[:: whole.sizes[0], 0]]
                    size = np.ptp(layer.corners[:, 0], axis=0) / 1e3
                    np.testing.assert_allclose(np.ptp(corners, axis=0), size, atol=1e-5)
            elif kind is Lines:
                assert sum(len(one.pairs) for one in shown) == count
            else:
                assert sum(len(one.points) for one in shown) == count


def test_a_folder_that_is_not_there_is_an_error(made, tmp_path):
    with pytest.raises(OutputError):
        write_stages(tmp_path / "no", made, name="roof")


def test_large_surfaces_are_drawn_with_few_triangles(made, monkeypatch):
    monkeypatch.setattr(module, "_TRIANGLES", 400)
    (faces,) = layer(stages(made)[0], Faces)
    assert len(faces.corners) < 600


def test_fine_meshes_are_drawn_by_their_edges(made, monkeypatch):
    monkeypatch.setattr(module, "_MOST_FACES", 40)
    found = {stage.letter: stage for stage in stages(made)}
    assert layer(found["c"], Dots) == []
    assert [len(one.ends) for one in layer(found["c"], Lines)] == [len(made.mesh.edges)]
    (lines,) = layer(found["d"], Lines)
    assert len(lines.ends) == len(made.control().mesh.edges)
