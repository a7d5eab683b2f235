import re

import numpy as np
import pytest

from fabrication.studio.design import Starts, build, find_net
from fabrication.studio.disk import read
from fabrication.studio.scenes import built_scene, centre_of, net_scene, residual_chart
from fabrication.studio.versions import Version


@pytest.fixture
def net(path):
    return find_net(Version.of(read(path).document, path).project, path.parent, Starts())


def dots(chart):
    found = re.findall(r'<circle cx="([\d.]+)" cy="([\d.]+)"', chart)
    return np.array(found, dtype=float).reshape(-1, 2)


def goal(chart):
    return float(re.search(r"M6 ([\d.]+)H", chart)[1])


def test_the_scene_of_a_net_has_its_layers_and_figures_quad_by_quad(net):
    scene = net_scene(net, centre_of(net))
    assert {layer.name for layer in scene.layers} >= {"Control mesh", "Net D1", "Checkerboard"}
    assert all(layer.of_net for layer in scene.layers)
    quads = len(net.result.control.quads)
    assert [len(one.values) for one in scene.colourings] == [quads] * len(scene.colourings)
    assert "Angle error" in {one.name for one in scene.colourings}


def test_what_is_built_stands_where_its_net_does(net):
    centre = centre_of(net)
    built = built_scene(build(net), centre)
    strips = next(layer for layer in built.layers if layer.kind == "strips")
    lines = next(layer for layer in net_scene(net, centre).layers if layer.id == "D1-1")
    axes = strips.frames[:, :3]
    assert np.abs(axes.mean(axis=0) - lines.points.mean(axis=0)).max() < 0.5


def test_residuals_go_down_a_logarithmic_scale_to_the_line_of_the_tolerance():
    chart = residual_chart([1e-1, 1e-3, 1e-5, 1e-9], 1e-9)
    x, y = dots(chart).T
    assert (np.diff(x) > 0.0).all()
    assert np.diff(y) == pytest.approx(np.array([1.0, 1.0, 2.0]) * (y[1] - y[0]), abs=0.2)
    assert y[-1] == pytest.approx(goal(chart), abs=0.1)
    assert "1e-09 after 4 steps; 1e-09 wanted" in chart


def test_a_net_that_needs_no_step_says_so_clear_of_the_line():
    chart = residual_chart([], 1e-9)
    assert len(dots(chart)) == 0
    assert "no step needed; 1e-09 wanted" in chart
    assert goal(chart) > 60.0
