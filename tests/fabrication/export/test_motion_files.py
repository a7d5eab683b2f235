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


def test_the_page_holds_every_position_to_a_tenth_of_a_millimetre(moved, tmp_path):
    write_motion_page(tmp_path / "m.html", moved, name="a < b", opening=moved.steps[3].opening)
    page = (tmp_path / "m.html").read_text()
    assert "a &lt; b" in page
    assert 'value="3"' in page
    assert "http://" not in page.split("<script>")[0]
    data = json.loads(re.search(r"const motion = (.*);\n", page).group(1))
    low, scale = np.array(data["low"]), data["scale"]
    for text, step in zip(data["frames"], moved.steps, strict=True):
        whole = np.frombuffer(base64.b64decode(text), "<u2").reshape(-1, 3)
        expected = step.strips[:, ::2].reshape(-1, 3)
        assert np.abs(1000.0 * (whole * scale + low) - expected).max() < 0.1
    for mesh in data["meshes"]:
        faces = np.array([mesh["i"], mesh["j"], mesh["k"]])
        assert faces.max() < mesh["to"] - mesh["from"]
    assert len(data["texts"]["force"]) == 7
