from math import radians

import numpy as np
import pytest

import gridshell as gs
from fabrication.export.scene.net import net_colourings, net_layers


@pytest.fixture(scope="module")
def net():
    surface = gs.Enneper(4000.0)
    patch = gs.AsymptoticPatch((-0.5, 0.5), (-0.5, 0.5), (6, 5))
    return gs.control_patch(surface, patch), surface


def test_every_edge_and_quad_of_the_control_mesh_and_of_both_diagonal_meshes_is_drawn(net):
    control, _ = net
    layers = {layer.id: layer for layer in net_layers(control, np.zeros(3))}
    first, second = gs.diagonal_meshes(control)
    assert len(layers["control-edges"].pairs) == len(control.mesh.edges)
    assert len(layers["control-faces"].sizes) == len(control.quads)
    assert len(layers["D2"].pairs) == len(second.edges)
    by_family = [len(layers[f"D1-{family}"].pairs) for family in (1, 2)]
    assert by_family == [int((first.family == family).sum()) for family in (1, 2)]
    assert len(layers["checkerboard"].sizes) == len(control.quads)


def test_points_are_metres_from_the_centre(net):
    control, _ = net
    centre = np.array([1000.0, 2000.0, -500.0])
    layers = {layer.id: layer for layer in net_layers(control, centre)}
    wanted = (control.vertices - centre) / 1e3
    np.testing.assert_allclose(layers["control-faces"].points, wanted, atol=1e-6)


def test_the_legend_tells_the_largest_error_in_units(net):
    control, surface = net
    angle = radians(89.0)  # Enneper's asymptotic net has right angles
    found = gs.quad_figures(control, angle=angle, reference=surface)
    named = {colouring.name: colouring for colouring in net_colourings(found)}
    error = named["Angle error"]
    assert error.low == "0°"
    assert float(error.high.removesuffix("°")) == pytest.approx(1.0, abs=0.2)
    assert np.asarray(error.values).max() == pytest.approx(1.0)
    assert named["Distance to surface"].high.endswith(" mm")
    assert {"Planarity", "Curvature ratio"} <= set(named)


def test_no_angle_no_colouring_by_it(net):
    control, _ = net
    names = [colouring.name for colouring in net_colourings(gs.quad_figures(control))]
    assert "Angle error" not in names
    assert "Distance to surface" not in names
