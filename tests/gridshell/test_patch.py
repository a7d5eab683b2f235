import numpy as np
import pytest

import gridshell as gs
from gridshell.curvature import vertex_normals

HYPAR = gs.Hypar(2000.0)
WIDE = gs.AsymptoticPatch(p=(-1.0, 1.0), q=(-0.5, 0.8), lamellas=(4, 6))

PATCHES = {
    "hypar": (HYPAR, WIDE),
    "Enneper": (gs.Enneper(4000.0), gs.BisectingPatch(u=(-0.7, 0.7), v=(-0.7, 0.7), cells=14)),
    "catenoid, open": (gs.Catenoid(900.0), gs.BisectingPatch(u=(0.0, 2.0), v=(-1, 1), cells=12)),
    "catenoid, ring": (gs.Catenoid(900.0), gs.BisectingPatch(v=(-1.0, 1.0), cells=20)),
    "helicoid": (gs.Helicoid(5000.0), gs.AsymptoticPatch((-1.0, 1.0), (0.0, 3.0), (5, 5))),
}


@pytest.fixture(params=PATCHES)
def surface_and_control(request):
    surface, patch = PATCHES[request.param]
    return surface, gs.control_patch(surface, patch)


def test_all_vertices_lie_on_the_surface(surface_and_control):
    surface, control = surface_and_control
    distance = np.linalg.norm(surface.closest(control.vertices).points - control.vertices, axis=1)
    assert distance.max() < 1e-6


def test_quads_face_the_side_of_the_normal(surface_and_control):
    surface, control = surface_and_control
    normals = surface.closest(control.vertices).normals
    assert np.einsum("nc,nc->n", normals, vertex_normals(control.mesh)).min() > 0.5


# ---- asymptotic patches ---------------------------------------------------------------------


@pytest.fixture(scope="module")
def asymptotic_net():
    return gs.diagonal_meshes(gs.control_patch(HYPAR, WIDE))[0]


def test_the_nodes_lie_at_equal_steps_of_the_asymptotic_parameters(asymptotic_net):
    p, q = np.meshgrid(np.linspace(-1.0, 1.0, 6), np.linspace(-0.5, 0.8, 4))
    expected = HYPAR.asymptotic_point(p.ravel(), q.ravel())
    found = asymptotic_net.vertices
    gaps = np.linalg.norm(found[:, None] - expected[None], axis=2)
    assert len(found) == len(expected)
    assert gaps.min(axis=1).max() < 1e-9


def test_every_lamella_runs_from_edge_to_edge(asymptotic_net):
    """Four along p meet six nodes each, six along q meet four."""
    lengths = sorted(len(line.vertices) for line in gs.polylines(asymptotic_net))
    assert lengths == [4] * 6 + [6] * 4


def test_family_one_runs_along_p(asymptotic_net):
    """On the hyperbolic paraboloid p = x / scale and q = y / scale."""
    for line in gs.polylines(asymptotic_net):
        x, y, _ = asymptotic_net.vertices[line.vertices].T
        across = y if line.family == 1 else x
        np.testing.assert_allclose(across, across[0], atol=1e-9)


# ---- bisecting patches ----------------------------------------------------------------------


def test_the_paper_sized_patch_has_1440_quads(enneper):
    assert len(enneper(36).quads) == 36 * 40


def test_the_number_across_follows_from_the_number_along():
    """Steps of 1.4 / 14 = 0.1: a width of 0.96 is widened to ten steps, 0.92 narrowed to nine."""
    for width, across in ((0.96, 10), (0.92, 9)):
        patch = gs.BisectingPatch(u=(-0.7, 0.7), v=(0.0, width), cells=14)
        assert len(gs.control_patch(gs.Enneper(4000.0), patch).quads) == 14 * across


def test_the_width_is_changed_evenly_on_both_sides():
    patch = gs.BisectingPatch(u=(-0.7, 0.7), v=(0.1, 0.5 + 0.03), cells=14)
    control = gs.control_patch(gs.Enneper(4000.0), patch)
    v = 0.315 + 0.1 * np.array([-2, -1, 0, 1, 2])
    expected = gs.Enneper(4000.0).point(np.full(5, -0.7), v)
    np.testing.assert_allclose(control.vertices[:5], expected, rtol=1e-12)


def test_a_narrow_patch_is_at_least_two_quads_wide():
    patch = gs.BisectingPatch(u=(-0.7, 0.7), v=(0.0, 0.01), cells=14)
    assert len(gs.control_patch(gs.Enneper(4000.0), patch).quads) == 14 * 2


def test_without_u_the_patch_closes_into_a_ring():
    control = gs.control_patch(*PATCHES["catenoid, ring"])
    assert control.mesh.euler_characteristic == 0
    assert len(control.mesh.boundary_loops[0]) == 20


# ---- what is refused ------------------------------------------------------------------------


@pytest.mark.parametrize(
    "limits", [(1.0, 1.0), (1.0, 0.0), (np.nan, 1.0), (0.0, np.nan), (0.0, np.inf), (-np.inf, 0.0)]
)
@pytest.mark.parametrize("key", ["p", "q", "u", "v"])
def test_an_empty_or_endless_range_is_refused_by_its_key(key, limits):
    layout, count = (
        (gs.AsymptoticPatch, {"lamellas": (3, 3)})
        if key in "pq"
        else (gs.BisectingPatch, {"cells": 4})
    )
    other = {"p": "q", "q": "p", "u": "v", "v": "u"}[key]
    with pytest.raises(gs.SettingError, match="smaller first") as info:
        layout(**{key: limits, other: (0.0, 1.0)}, **count)
    assert info.value.where == key
    assert info.value.value == str(list(limits))


@pytest.mark.parametrize("lamellas", [(1, 3), (3, 1), (0, 0), (-2, 5)])
def test_fewer_than_two_lamellas_are_refused(lamellas):
    with pytest.raises(gs.SettingError, match="Too few") as info:
        gs.AsymptoticPatch(p=(0.0, 1.0), q=(0.0, 1.0), lamellas=lamellas)
    assert (info.value.where, info.value.limit) == ("lamellas", ">= 2")


@pytest.mark.parametrize("cells", [1, 0, -3])
def test_fewer_than_two_cells_are_refused(cells):
    with pytest.raises(gs.SettingError, match="Too few") as info:
        gs.BisectingPatch(u=(0.0, 1.0), v=(0.0, 1.0), cells=cells)
    assert info.value.where == "cells"


@pytest.mark.parametrize(("cells", "advice"), [(2, "4 cells"), (3, "4 cells"), (7, "8 cells")])
def test_a_ring_of_an_odd_or_too_small_number_is_refused_with_the_next_one(cells, advice):
    with pytest.raises(gs.SettingError, match="even number of cells") as info:
        gs.BisectingPatch(v=(0.0, 1.0), cells=cells)
    assert (info.value.value, info.value.advice) == (str(cells), advice)


def test_an_odd_number_is_fine_where_the_patch_is_open():
    assert gs.BisectingPatch(u=(0.0, 1.0), v=(0.0, 1.0), cells=7).cells == 7


@pytest.mark.parametrize("surface", [gs.Enneper(4000.0), HYPAR, gs.Helicoid(5000.0)])
def test_a_ring_on_an_open_surface_is_refused_by_its_name(surface):
    with pytest.raises(gs.SettingError, match="does not close") as info:
        gs.control_patch(surface, gs.BisectingPatch(v=(-0.5, 0.5), cells=8))
    assert (info.value.where, info.value.value) == ("u", type(surface).__name__)


@pytest.mark.parametrize(
    "patch",
    [
        gs.AsymptoticPatch(p=(-0.5, 0.5), q=(-0.5, 0.5), lamellas=(3, 3)),
        gs.BisectingPatch(v=(-0.5, 0.5), cells=8),
    ],
)
def test_a_sphere_has_no_asymptotic_directions(patch):
    with pytest.raises(gs.NotHyperbolicError):
        gs.control_patch(gs.Sphere(1000.0), patch)


def test_a_patch_beyond_the_formula_is_refused():
    with pytest.raises(gs.SettingError, match="infinity"):
        gs.control_patch(gs.Hyperboloid(900.0, 900.0), gs.BisectingPatch(v=(-2.0, 2.0), cells=20))


def test_the_rim_of_half_a_bay_must_lie_on_the_surface_too():
    """Nodes reach v = 1.5; the teeth around them reach pi / 2, where the rulings are endless."""
    patch = gs.AsymptoticPatch(p=(0.0, 1.5), q=(-1.5, 0.0), lamellas=(4, 4))
    with pytest.raises(gs.SettingError, match="infinity"):
        gs.control_patch(gs.Hyperboloid(900.0, 900.0), patch)


# ---- panels along conjugate lines -------------------------------------------------------------


def white_planarity(control):
    return gs.net_quality(control, planarity=gs.Planarity.WHITE_FACES).face_planarity.max


@pytest.mark.parametrize(
    ("surface", "ring"),
    [(gs.Catenoid(900.0), True), (gs.Hyperboloid(900.0, 1200.0), True), (gs.Sphere(900.0), False)],
)
def test_panels_along_the_circles_of_a_surface_of_revolution_are_flat(surface, ring):
    control = gs.control_patch(
        surface, gs.ConjugatePatch(v=(-0.5, 0.6), panels=(9, 4), u=None if ring else (0.0, 1.5))
    )
    assert white_planarity(control) < 1e-12
    assert gs.node_angles(control) == pytest.approx(np.pi / 2.0, abs=1e-9)
    assert len(gs.skin(control, gs.Skin.D1).faces) == 36
    foot = surface.closest(control.vertices)
    assert np.linalg.norm(foot.points - control.vertices, axis=1).max() < 1e-6


def test_finer_panels_along_conjugate_lines_are_flatter():
    coarse, fine = (
        white_planarity(
            gs.control_patch(
                gs.Enneper(900.0), gs.ConjugatePatch(v=(-0.5, 0.4), panels=(n, n), u=(-0.5, 0.6))
            )
        )
        for n in (4, 8)
    )
    assert fine < 0.3 * coarse


def test_panels_face_the_surface_s_positive_side():
    surface = gs.Sphere(900.0)
    patch = gs.ConjugatePatch(v=(-0.5, 0.6), panels=(5, 4), u=(0.0, 1.5))
    mesh = gs.skin(gs.control_patch(surface, patch), gs.Skin.D1)
    normals = surface.closest(mesh.vertices).normals
    assert (np.einsum("nc,nc->n", mesh.axes, normals) > 0.9).all()


@pytest.mark.parametrize(
    ("patch", "key"),
    [
        (lambda: gs.ConjugatePatch(v=(0.5, -0.5), panels=(4, 4)), "v"),
        (lambda: gs.ConjugatePatch(v=(-0.5, 0.5), panels=(2, 4)), "panels"),
        (lambda: gs.ConjugatePatch(v=(-0.5, 0.5), panels=(1, 4), u=(0.0, 1.0)), "panels"),
    ],
)
def test_a_conjugate_patch_that_is_none_is_refused_by_its_key(patch, key):
    with pytest.raises(gs.SettingError) as info:
        patch()
    assert info.value.where == key


# ---- a central singularity ------------------------------------------------------------------


@pytest.mark.parametrize("valence", [4, 6, 8])
def test_sectors_meet_in_a_vertex_of_even_valence(valence):
    control = gs.control_patch(gs.Enneper(3000.0), gs.SingularPatch(valence, 5, 0.6))
    mesh = control.mesh
    inner = ~mesh.on_boundary
    singular = np.flatnonzero(inner & (mesh.valence != 4))
    assert len(control.quads) == 25 * valence
    assert len(singular) == (valence != 4)
    assert (control.colour[singular] == 0).all()  # D1 holds it
    assert len(mesh.boundary_loops) == 1


def test_the_net_of_fig_13_has_its_numbers():
    control = gs.control_patch(gs.Enneper(3000.0), gs.SingularPatch(6, 11, 0.8, cut=1))
    assert (len(control.vertices), len(control.quads)) == (787, 720)


def test_valence_four_is_the_regular_patch_of_the_same_surface():
    reach = 0.6
    control = gs.control_patch(gs.Enneper(3000.0), gs.SingularPatch(4, 6, reach))
    line = reach * np.linspace(-1.0, 1.0, 13)
    u, v = (a.ravel() for a in np.meshgrid(line, line))
    expected = gs.Enneper(3000.0).point(u, v)
    gaps = np.linalg.norm(control.vertices[:, None] - expected[None], axis=2)
    assert len(control.vertices) == len(expected)
    assert gaps.min(axis=1).max() < 1e-9


def test_around_a_singularity_the_net_tends_to_an_asymptotic_one_at_right_angles():
    errors = []
    for cells in (8, 16):
        control = gs.control_patch(gs.Enneper(3000.0), gs.SingularPatch(6, cells, 0.8))
        quality = gs.net_quality(control, angle=np.pi / 2.0)
        errors.append((quality.star_planarity.mean, quality.angle_error_deg.mean))
    assert np.divide(*errors).min() > 2.5


@pytest.mark.parametrize(
    ("patch", "key", "advice"),
    [
        ({"valence": 5}, "valence", "6"),
        ({"valence": 2}, "valence", "4"),
        ({"reach": 1.6}, "reach", "1"),
        ({"reach": 0.0}, "reach", "1"),
        ({"cut": 6}, "cut", None),
        ({"cells": 1}, "cells", None),
    ],
)
def test_a_singular_patch_that_cannot_be_is_refused(patch, key, advice):
    with pytest.raises(gs.SettingError) as info:
        gs.SingularPatch(**{"valence": 6, "cells": 6, "reach": 0.8, **patch})
    assert info.value.where == key
    assert info.value.advice == advice


def test_a_central_singularity_is_not_asked_of_a_surface_that_has_none():
    with pytest.raises(gs.SettingError, match="no family") as info:
        gs.control_patch(HYPAR, gs.SingularPatch(6, 5, 0.6))
    assert "Hypar" in info.value.value


@pytest.mark.parametrize("valence", [4, 6, 8])
def test_the_surface_meets_itself_in_its_axis_at_the_farthest_reach(valence):
    """The nearest points of the rim come down to the axis as the reach grows to the limit."""
    from gridshell.patch import farthest_reach

    limit = farthest_reach(valence)
    near = []
    for share in (0.8, 0.9999):
        control = gs.control_patch(gs.Enneper(1.0), gs.SingularPatch(valence, 12, share * limit))
        x, y, _ = control.vertices[control.mesh.on_boundary].T
        near.append(np.hypot(x, y).min())
    assert near[0] > 0.1
    assert near[1] < 1e-3
