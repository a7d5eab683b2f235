"""Charts of whole surfaces: exact transitions, right cones, no folds."""

import numpy as np
import pytest
from surfaces import CASES

from gridshell.field import asymptotic_field, cleaned, principal_field, singularities
from gridshell.remesh.lattice import ExactChart
from gridshell.remesh.parametrization import GRAIN, LATTICE, winding
from gridshell.remesh.seamless import LADDER, seamless
from gridshell.surface.triangle_mesh import after


@pytest.fixture(scope="module")
def chart_of():
    kept = {}

    def make(name, spacing=150.0, **more):
        key = (name, spacing, tuple(more.items()))
        if key not in kept:
            curved = CASES[name].triangles(1500)
            make_field = principal_field if name in ("torus", "ellipsoid") else asymptotic_field
            field = cleaned(curved, make_field(curved), spacing).field
            turns = singularities(field)
            kept[key] = field, turns, seamless(field, turns, spacing, **more)
        return kept[key]

    return make


@pytest.mark.parametrize("name", ["enneper", "catenoid", "monkey", "schwarz p", "torus", "hypar"])
def test_transitions_are_whole_even_numbers_exactly(name, chart_of):
    _, _, found = chart_of(name, 400.0 if name == "schwarz p" else 150.0)
    mesh, flat = found.mesh, found.corners.reshape(-1, 2)
    assert (flat / GRAIN == np.rint(flat / GRAIN)).all()
    inner = np.flatnonzero(mesh.twin >= 0)
    other, flip = mesh.twin[inner], found.flips[inner][:, None]
    jump = flat[after(other)] - flip * flat[inner]
    assert (jump == flat[other] - flip * flat[after(inner)]).all()
    assert (jump % LATTICE == 0).all()
    exact = ExactChart.of(mesh, found.corners, found.flips)
    assert (exact.corners == np.rint(found.corners / GRAIN)).all()


@pytest.mark.parametrize("name", ["monkey", "schwarz p", "ellipsoid"])
def test_cones_have_the_angle_of_their_index_and_lie_on_even_points(name, chart_of):
    _, turns, found = chart_of(name, 400.0 if name == "schwarz p" else 100.0)
    area, total = winding(found.mesh, found.corners)
    assert len(found.folded) == len(found.cones) == 0
    assert (area > 0.0).all()
    wanted = np.full(len(total), 2.0 * np.pi)
    wanted[turns.vertices] *= 1.0 - turns.indices
    inner = ~found.mesh.on_boundary
    np.testing.assert_allclose(total[inner], wanted[inner], atol=1e-5)
    at = found.corners.reshape(-1, 2)[np.isin(found.mesh.origin, turns.vertices)]
    assert (at % LATTICE == 0).all()


def test_both_coordinates_rise_by_one_per_spacing_on_average(chart_of):
    field, _, found = chart_of("scherk")
    area, _ = winding(found.mesh, found.corners)
    cells = (field.mesh.areas / np.sin(field.angle)).sum() / 150.0**2
    assert area.sum() / 2.0 == pytest.approx(cells, rel=0.05)
    assert found.lam == LADDER[0][0]


def test_the_signed_frames_point_to_growing_coordinates(chart_of):
    for name in ("catenoid", "monkey"):
        field, _, found = chart_of(name)
        mesh = found.mesh
        step = np.stack([np.cos(field.first), np.sin(field.first)], axis=1)
        edge = mesh.flat_corners[:, 1:] - mesh.flat_corners[:, :1]
        share = np.linalg.solve(edge.transpose(0, 2, 1), step[..., None])[..., 0]
        rise = np.einsum("fk,fkc->fc", share, found.corners[:, 1:] - found.corners[:, :1])
        assert (rise[:, 0] * found.field_signs > 0.0).mean() > 0.99
        assert np.abs(rise[:, 1]).mean() < 0.1 * np.abs(rise[:, 0]).mean()


def test_a_boundary_along_a_family_is_a_lattice_line(chart_of):
    _, _, found = chart_of("hypar")
    mesh = found.mesh
    for h in np.flatnonzero(mesh.twin < 0).tolist():
        a, b = found.corners.reshape(-1, 2)[[h, int(after(np.array([h]))[0])]]
        assert ((a == b) & (a % LATTICE == 0)).any()
    _, _, loose = chart_of("hypar", align_boundary=False)
    rim = loose.corners.reshape(-1, 2)[np.flatnonzero(mesh.twin < 0)]
    assert not (rim % LATTICE == 0).any(axis=1).all()


def test_the_last_rung_is_kept_when_none_is_free_of_folds(chart_of):
    _, _, found = chart_of("enneper", ladder=((1.0, False),))
    assert found.lam == 1.0
