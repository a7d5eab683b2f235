import numpy as np
import pytest

import gridshell as gs
from fabrication.angle_settings import angle_of
from fabrication.errors import ProjectError
from fabrication.project import project_text, read_project

PROJECT = """
name = "angles"
[surface]
kind = "enneper"
scale = 4000.0
[patch]
layout = "singular"
valence = 6
cells = 5
reach = 0.6
[net]
anchor = "free"
keep_to_surface = false
{net}
[profile]
width = 80.0
thickness = 1.5
material = "stainless"
[joint]
kind = "slot"
[sheet]
length = 12000.0
width = 1500.0
"""

RADIAL, ALONG, SAMPLES, FORMULA = (
    f'angle = {{ kind = "{kind}", ' for kind in ("radial", "along", "samples", "formula")
)


@pytest.fixture
def project(tmp_path):
    def write(net, **files):
        for name, text in files.items():
            (tmp_path / f"{name}.csv").write_text(text)
        path = tmp_path / "p.toml"
        path.write_text(PROJECT.format(net=net))
        return path

    return write


POINTS = np.array([[0.0, 0.0, 0.0], [3000.0, 0.0, 0.0], [0.0, 0.0, 1000.0]])


@pytest.mark.parametrize(
    ("net", "degrees"),
    [
        ("angle = 75.0", [75.0, 75.0, 75.0]),
        ('angle = "90 - x / 100"', [90.0, 60.0, 90.0]),
        (
            FORMULA + 'formula = "90 - r / 100", centre = [0, 0, 1000] }',
            [80.0, 90.0 - np.hypot(30, 10), 90.0],
        ),
        (RADIAL + "radii = [0, 3000], angles = [90, 60] }", [90.0, 60.0, 80.0]),
        (
            ALONG + "direction = [0, 0, 1], stations = [0, 1000], angles = [90, 60] }",
            [90.0, 90.0, 60.0],
        ),
        (SAMPLES + 'file = "s.csv", unit = "m" }', [90.0, 60.0, 80.0]),
    ],
)
def test_every_kind_of_angle(project, net, degrees, tmp_path):
    path = project(net, s="x,y,z,degrees\n0,0,0,90\n3,0,0,60\n\n0,0,1,80\n")
    angle = angle_of(read_project(path).net.angle, tmp_path)
    found = angle(POINTS) if callable(angle) else np.full(3, angle)
    np.testing.assert_allclose(np.degrees(found), degrees, rtol=1e-9)


@pytest.mark.parametrize("net", ["", "angle_between = [70.0, 95.0]", "near_rhombi = true"])
def test_what_is_printed_can_be_read(project, net):
    path = project(net or 'angle = "80 + z / 1000"')
    again = path.with_name("again.toml")
    again.write_text(project_text(read_project(path)))
    assert read_project(again) == read_project(path)


@pytest.mark.parametrize(
    ("net", "where", "told"),
    [
        ("angle = 180.0", "net.angle", "< 180"),
        ("angle = 0.0", "net.angle", "> 0"),
        ("angle = true", "net.angle", "a number"),
        ("angle = []", "net.angle", "a number"),
        ('angle = "90 +"', "net.angle.formula", "arithmetic"),
        ('angle = "90 + q"', "net.angle.formula", "x, y, z, r"),
        ("angle = \"__import__('os')\"", "net.angle.formula", "unknown function"),
        ('angle = { kind = "radail" }', "net.angle", "radial, along, samples, formula"),
        ("angle = { radii = [0, 1] }", "net.angle", "radial, along, samples, formula"),
        (RADIAL + "radius = [0, 1], angles = [60, 90] }", "net.angle.radius", "'radii'"),
        (RADIAL + "radii = [1, 0], angles = [60, 90] }", "net.angle.radii", "larger"),
        (RADIAL + "radii = [0, 1], angles = [60, 190] }", "net.angle.angles.1", "< 180"),
        (
            ALONG + "direction = [0, 0, 0], stations = [0], angles = [60] }",
            "net.angle.direction",
            "length",
        ),
        (SAMPLES + 'file = "none.csv", unit = "m" }', "net.angle.file", "folder"),
        ("angle_between = [90.0, 60.0]", "net.angle_between", "smaller first"),
        ("mirror = { normal = [0, 0, 0] }", "net.mirror.normal", "direction"),
        ("mirror = { norma = [1, 0, 0] }", "net.mirror.norma", "'normal'"),
        ("supports = [[0, 0, 0], [1, 0, 0]]", "net.supports", "anchor 'supports'"),
    ],
)
def test_angles_that_cannot_be_used_name_the_key(project, net, where, told):
    with pytest.raises(ProjectError) as info:
        read_project(project(net))
    assert f", {where}" in str(info.value)
    assert told in str(info.value)


def test_symmetry_is_kept_where_there_is_one_and_refused_where_there_is_none(project, tmp_path):
    from contextlib import nullcontext

    from fabrication.package import optimised, route_of
    from fabrication.starts import start

    def solved(normal):
        content = read_project(project(f"angle = 80.0\nmirror = {{ normal = {normal} }}"))
        begun = start(content, tmp_path, lambda name: nullcontext())
        return optimised(content, route_of(content).recipe(tmp_path), begun)

    found = solved([0, 1, 0]).require().control.vertices
    image = found * [1.0, -1.0, 1.0]
    assert np.linalg.norm(found[:, None] - image[None], axis=2).min(axis=1).max() < 1e-4
    with pytest.raises(gs.SettingError, match="no mirror image"):
        solved([1, 2, 0])


@pytest.mark.parametrize("text", ["0,0,90\n", "0,0,0,90\n1,2,x,80\n", "0,0,0,90,1\n"])
def test_samples_that_are_none_name_the_line(project, text, tmp_path):
    path = project(SAMPLES + 'file = "s.csv", unit = "m" }', s=text)
    choice = read_project(path).net.angle
    with pytest.raises(gs.FileError, match="needs x, y, z and degrees") as info:
        angle_of(choice, tmp_path)
    assert "line" in info.value.where


def test_a_file_without_samples_is_told(project, tmp_path):
    path = project(SAMPLES + 'file = "s.csv", unit = "m" }', s="x,y,z,a\n")
    with pytest.raises(gs.SettingError, match="Samples need"):
        angle_of(read_project(path).net.angle, tmp_path)
