"""The files of a motion, read back by other programs' libraries."""

import base64
import csv
import json
import re
from math import radians

import numpy as np
import pygltflib
import pytest
import trimesh

import fabrication as fab
import gridshell as gs
from fabrication.export.motion_glb import SECONDS, write_motion_glb
from fabrication.export.motion_page import write_motion_page
from fabrication.export.motion_schedule import COLUMNS, write_motion
from fabrication.export.scene.page import scripts
from fabrication.motion import motion


@pytest.fixture(scope="module")
def moved():
    umbrella = gs.Umbrella(10, 1000.0, (600.0,) * 4)
    limits = (radians(20.0), radians(160.0))
    profile = fab.Profile(50.0, 4.0, fab.GRP)
    return motion(umbrella.position(0.4), profile, count=7, limits=limits)


def test_the_list_has_a_line_per_position(moved, tmp_path):
    write_motion(tmp_path / "motion.csv", moved)
    rows = list(csv.DictReader((tmp_path / "motion.csv").open()))
    assert tuple(rows[0]) == COLUMNS
    assert [int(row["position"]) for row in rows] == list(range(1, 8))
    for row, step in zip(rows, moved.steps, strict=True):
        assert float(row["cable_mm"]) == pytest.approx(step.cable, abs=1e-3)
        assert float(row["smallest_angle_deg"]) == pytest.approx(
            np.degrees(step.angles[0]), abs=1e-4
        )


def points_of(file, accessor):
    found = file.accessors[accessor]
    view = file.bufferViews[found.bufferView]
    data = file.binary_blob()[view.byteOffset : view.byteOffset + view.byteLength]
    return np.frombuffer(data, "<f4").reshape(found.count, -1)


def test_the_animation_goes_through_every_position(moved, tmp_path):
    path = tmp_path / "motion.glb"
    write_motion_glb(path, moved)
    file = pygltflib.GLTF2().load_binary(str(path))
    (animation,) = file.animations
    times = points_of(file, animation.samplers[0].input)[:, 0]
    weights = points_of(file, animation.samplers[0].output).reshape(7, 6)
    assert (times[0], times[-1]) == (0.0, SECONDS)
    for node, mesh in enumerate(file.meshes):
        chosen = slice(None, moved.first) if node == 0 else slice(moved.first, None)
        (primitive,) = mesh.primitives
        base = points_of(file, primitive.attributes.POSITION)
        targets = [points_of(file, target["POSITION"]) for target in primitive.targets]
        for number, step in enumerate(moved.steps):
            shown = base + sum(w * t for w, t in zip(weights[number], targets, strict=True))
            x, y, z = shown.T * 1000.0
            expected = step.strips[chosen].reshape(-1, 3)
            np.testing.assert_allclose(np.stack([x, -z, y], axis=1), expected, atol=2e-3)


def test_another_library_reads_the_first_position(moved, tmp_path):
    write_motion_glb(tmp_path / "motion.glb", moved)
    scene = trimesh.load(tmp_path / "motion.glb")
    assert len(scene.geometry) == 2
    low, high = scene.bounds * 1000.0
    expected = moved.steps[0].strips.reshape(-1, 3)
    assert high[1] == pytest.approx(expected[:, 2].max(), abs=0.01)
    assert low[1] == pytest.approx(expected[:, 2].min(), abs=0.01)


def test_every_accessor_lies_on_its_boundary_and_says_its_bounds(moved, tmp_path):
    write_motion_glb(tmp_path / "motion.glb", moved)
    file = pygltflib.GLTF2().load_binary(str(tmp_path / "motion.glb"))
    assert all(view.byteOffset % 4 == 0 for view in file.bufferViews)
    for accessor in file.accessors:
        if accessor.type == "VEC3":
            points = points_of(file, file.accessors.index(accessor))
            np.testing.assert_allclose(accessor.min, points.min(axis=0))
            np.testing.assert_allclose(accessor.max, points.max(axis=0))


@pytest.fixture(scope="module")
def page_path(moved, tmp_path_factory):
    path = tmp_path_factory.mktemp("page") / "m.html"
    write_motion_page(path, moved, name="a < b", opening=moved.steps[3].opening)
    return path


def test_the_page_holds_every_position_to_a_tenth_of_a_millimetre(moved, page_path):
    page = page_path.read_text()
    assert "a &lt; b" in page
    own = page.replace(scripts(), "")
    assert "http" not in own.replace("http-equiv", "").replace("http://www.w3.org/2000/svg", "")
    scene = json.loads(re.search(r'id="scene">(.*?)</script>', page)[1])
    middle = [step.strips.reshape(-1, 3) for step in moved.steps]
    low, high = (getattr(np.concatenate(middle), end)(axis=0) for end in ("min", "max"))
    families = (slice(None, moved.first), slice(moved.first, None))
    for layer, chosen in zip(scene["layers"], families, strict=True):
        assert (layer["kind"], layer["begin"]) == ("positions", 3)
        corner, scale = np.array(layer["low"]), layer["scale"]
        for packed, step in zip(layer["frames"], moved.steps, strict=True):
            whole = np.frombuffer(base64.b64decode(packed["bytes"]), "<u2").reshape(-1, 3)
            shown = 1000.0 * (whole * scale + corner) + (low + high) / 2.0
            assert np.abs(shown - step.strips[chosen, ::2].reshape(-1, 3)).max() < 0.1
        faces = np.frombuffer(base64.b64decode(layer["faces"]["bytes"]), "<u4")
        assert faces.max() < len(whole)


def test_the_page_tells_the_figures_of_the_position_it_shows(moved, page_path, chromium):
    page = chromium.new_page(viewport={"width": 1100, "height": 900})
    page.goto(page_path.as_uri())
    page.locator("#play:not([disabled])").wait_for()
    slider = page.locator(".gv-open input")
    assert slider.input_value() == "3"
    for number in (3, 6, 0):
        slider.evaluate(
            "(box, to) => { box.value = to; box.dispatchEvent(new Event('input')); }", number
        )
        step = moved.steps[number]
        told = page.locator("dd[data-key=height]").inner_text()
        assert told == f"{step.height / 1000.0:.2f} m"
        moved_by = page.locator(".chart .now").first.get_attribute("transform")
        span = float(page.locator(".chart .now").first.get_attribute("data-span"))
        ends = moved.steps[0].opening, moved.steps[-1].opening
        share = (step.opening - ends[0]) / (ends[1] - ends[0])
        assert float(re.search(r"[\d.]+", moved_by)[0]) == pytest.approx(share * span, abs=0.1)
    page.locator("#play").click()
    page.wait_for_timeout(400)
    assert page.evaluate("view.state.opened") > 0
    assert page.get_by_role("button", name="As built").count() == 0
    page.close()
