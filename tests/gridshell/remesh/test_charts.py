"""Unknowns of a coordinate: whatever their values, the chart is seamless."""

import numpy as np
import pytest
from surfaces import CASES
from test_cut import NAMES, opened

from gridshell.field import asymptotic_field, cleaned, matching, principal_field, singularities
from gridshell.remesh.charts import charts
from gridshell.remesh.cut import cut_open
from gridshell.surface.triangle_mesh import after


def unknowns_of(name, aligned=None):
    curved = CASES[name].triangles(1500)
    make = principal_field if name in ("ellipsoid", "torus") else asymptotic_field
    field = cleaned(curved, make(curved), 100.0).field
    mesh = field.mesh
    sign, rotation = matching(field)
    turns = singularities(field)
    singular = np.zeros(len(mesh.vertices), dtype=bool)
    singular[turns.vertices] = True
    cut = cut_open(mesh, sign, rotation, singular)
    runs = np.zeros(len(mesh.twin), dtype=bool)
    if aligned is not None:
        runs[mesh.boundary_loops[aligned]] = True
    return mesh, cut, singular, runs, charts(mesh, cut, singular, runs, origin=0)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("aligned", [None, 0])
def test_any_values_make_a_seamless_coordinate(name, aligned):
    if aligned is not None and name in ("ellipsoid", "torus"):
        pytest.skip("has no boundary")
    mesh, cut, singular, runs, made = unknowns_of(name, aligned)
    rng = np.random.default_rng(0)
    x = rng.normal(size=made.reals.shape[1])
    z = rng.integers(-5, 6, size=made.integers.shape[1])
    corner = made.reals @ x + made.integers @ z
    inner = np.flatnonzero(mesh.twin >= 0)
    other = mesh.twin[inner]
    # the jump at the origin and at the target of every half-edge
    at_origin = corner[after(other)] - cut.flips[inner] * corner[inner]
    at_target = corner[other] - cut.flips[inner] * corner[after(inner)]
    np.testing.assert_allclose(at_origin, at_target, atol=1e-12)
    np.testing.assert_allclose(at_origin, np.rint(at_origin), atol=1e-12)
    assert np.abs(at_origin[~cut.on_cut[inner]]).max() < 1e-12
    fixed = singular[mesh.origin] | runs
    np.testing.assert_allclose(corner[fixed], np.rint(corner[fixed]), atol=1e-12)
    if aligned is not None:
        loop = mesh.boundary_loops[0]
        np.testing.assert_allclose(corner[loop], corner[after(loop)], atol=1e-12)


def test_the_number_of_integers_is_that_of_the_topology():
    count = {name: unknowns_of(name)[4].integers.shape[1] for name in NAMES}
    assert count["enneper"] == 0
    assert count["catenoid"] == 1  # once around
    assert count["monkey"] == 0  # the one singular vertex is the origin
    assert count["torus"] == 2
    assert count["ellipsoid"] == 2  # four points of half index, one the origin; the sphere closes
    assert count["schwarz p"] == 12


def test_a_shift_of_the_whole_chart_is_fixed():
    mesh, _, _, _, made = unknowns_of("enneper")
    at_origin = mesh.origin == 0
    assert made.reals[at_origin].nnz == 0
    assert made.integers[at_origin].nnz == 0
    assert made.reals[~at_origin].nnz == np.count_nonzero(~at_origin)


def test_both_cuts_are_the_same():
    assert (opened("monkey")[3].signs == unknowns_of("monkey")[1].signs).all()
