import numpy as np
import pytest

import gridshell as gs
from gridshell.mesh import grid_quads
from gridshell.quality import curvature_ratio, edge_ratio, star_planarity

# ---- independent formulas -------------------------------------------------------------------


def neighbours_by_diagonals(quads, vertex):
    return [int(q[(list(q).index(vertex) + 2) % 4]) for q in quads if vertex in q]


def planarity_by_eigenvectors(centre, ends):
    """Largest distance from the plane through *centre* that fits *ends* best, over mean length."""
    spokes = ends - centre
    values, vectors = np.linalg.eigh(spokes.T @ spokes)
    lengths = np.sqrt((spokes**2).sum(axis=1))
    return np.abs(spokes @ vectors[:, np.argmin(values)]).max() / lengths.mean()


def angle_by_cosine(quad):
    a, b = quad[2] - quad[0], quad[3] - quad[1]
    return np.degrees(np.arccos(a @ b / np.sqrt((a @ a) * (b @ b))))


@pytest.fixture(scope="module", params=["stars of six", "open stars of three"])
def crumpled(request, monkey_saddle, l_shape):
    mesh = monkey_saddle if request.param == "stars of six" else l_shape(3)
    noise = np.random.default_rng(2).normal(scale=0.15, size=mesh.vertices.shape)
    return gs.as_control_mesh(mesh.moved(mesh.vertices + noise))


def test_star_planarity_agrees_with_an_independent_formula(crumpled):
    expected = [
        planarity_by_eigenvectors(crumpled.vertices[v], crumpled.vertices[around])
        for v in range(len(crumpled.vertices))
        if len(around := neighbours_by_diagonals(crumpled.quads.tolist(), v)) >= 3
    ]
    found = gs.net_quality(crumpled).star_planarity
    assert found.max == pytest.approx(max(expected), rel=1e-10)
    assert found.mean == pytest.approx(np.mean(expected), rel=1e-10)


def test_angle_errors_agree_with_an_independent_formula(crumpled):
    errors = np.abs([angle_by_cosine(q) - 75.0 for q in crumpled.vertices[crumpled.quads]])
    found = gs.net_quality(crumpled, angle=np.radians(75.0)).angle_error_deg
    assert found.max == pytest.approx(errors.max(), rel=1e-10)
    assert found.mean == pytest.approx(errors.mean(), rel=1e-10)


def test_node_angles_agree_with_an_independent_formula(crumpled):
    angles = [angle_by_cosine(q) for q in crumpled.vertices[crumpled.quads]]
    np.testing.assert_allclose(np.degrees(gs.node_angles(crumpled)), angles, rtol=1e-10)
    found = gs.net_quality(crumpled).node_angle_deg
    assert found == pytest.approx((min(angles), max(angles)), rel=1e-10)


def test_the_edge_ratio_agrees_with_an_independent_formula(crumpled):
    first, _ = gs.diagonal_meshes(crumpled)
    lengths = [
        np.sqrt(((first.vertices[a] - first.vertices[b]) ** 2).sum()) for a, b in first.edges
    ]
    expected = min(lengths) / np.mean(lengths), max(lengths) / np.mean(lengths)
    assert gs.net_quality(crumpled).edge_ratio == pytest.approx(expected, rel=1e-12)


# ---- by hand --------------------------------------------------------------------------------


def test_a_flat_square_grid_is_perfect_but_flat(grid):
    found = gs.net_quality(gs.as_control_mesh(grid(5, 5)), angle=np.radians(90.0))
    assert found.star_planarity == gs.Spread(0.0, 0.0)
    assert found.angle_error_deg == gs.Spread(0.0, 0.0)
    assert found.edge_ratio == pytest.approx((1.0, 1.0), rel=1e-15)
    assert found.curvature_ratio == 0.0


def test_without_an_angle_or_a_reference_there_is_no_error_and_no_distance(grid):
    found = gs.net_quality(gs.as_control_mesh(grid(5, 5)))
    assert found.angle_error_deg is None
    assert found.surface_distance_mm is None


@pytest.mark.parametrize("height", [0.01, 0.1, 0.3])
def test_a_star_of_alternating_heights_is_as_far_from_its_plane_as_they_are(grid, height):
    """Spokes (+-1, +-1, +-h): the best plane is z = 0."""
    control = gs.as_control_mesh(grid(2, 2, lambda x, y: height * (x - 1.0) * (y - 1.0)))
    _, second = gs.diagonal_meshes(control)
    found = star_planarity(second.vertices, second.stars)
    np.testing.assert_allclose(found, [height / np.sqrt(2.0 + height**2)], rtol=1e-12)


def test_a_lifted_centre_is_out_of_the_plane_of_its_neighbours(grid):
    """The best plane through the centre (0, 0, h) is level for a small h."""
    vertices = grid(2, 2).vertices.copy()
    vertices[4, 2] = 0.2
    _, second = gs.diagonal_meshes(gs.as_control_mesh(grid(2, 2).moved(vertices)))
    np.testing.assert_allclose(
        star_planarity(second.vertices, second.stars), [0.2 / np.sqrt(2.04)], rtol=1e-12
    )


@pytest.mark.parametrize("lifted", [0, 2, 6, 8])
def test_a_star_of_valence_six_shows_one_lifted_spoke(sectors, lifted):
    mesh = sectors(6, 1)
    vertices = mesh.vertices.copy()
    tip = gs.diagonal_stars(mesh).spokes[0][lifted % 6]
    vertices[tip, 2] = 0.3
    stars = gs.diagonal_stars(mesh)
    expected = planarity_by_eigenvectors(vertices[0], vertices[stars.spokes[0]])
    np.testing.assert_allclose(star_planarity(vertices, stars), [expected], rtol=1e-10)
    assert expected > 0.01


def test_stars_of_two_spokes_do_not_count(grid):
    mesh = grid(1, 4)
    assert len(star_planarity(mesh.vertices, gs.diagonal_stars(mesh))) == 0


@pytest.mark.parametrize("shear", [-0.5, 0.0, 0.25, 1.0])
def test_the_angle_of_a_sheared_grid_by_hand(grid, shear):
    """Edges (1, 0) and (s, 1): diagonals (1 + s, 1) and (s - 1, 1)."""
    mesh = grid(2, 3)
    x, y, z = mesh.vertices.T
    control = gs.as_control_mesh(mesh.moved(np.stack([x + shear * y, y, z], axis=1)))
    expected = np.arctan2(1.0, shear - 1.0) - np.arctan2(1.0, shear + 1.0)
    np.testing.assert_allclose(gs.node_angles(control), expected, rtol=1e-14)


def test_a_grid_of_rectangles_has_the_angle_of_its_diagonals(grid):
    mesh = grid(4, 4)
    narrow = mesh.moved(mesh.vertices * [1.0, np.tan(np.radians(30.0)), 1.0])
    found = gs.net_quality(gs.as_control_mesh(narrow), angle=np.radians(100.0))
    assert found.node_angle_deg == pytest.approx((120.0, 120.0), abs=1e-12)
    assert found.angle_error_deg.mean == pytest.approx(20.0, abs=1e-12)
    assert found.angle_error_deg.max == pytest.approx(20.0, abs=1e-12)


def test_the_edge_ratio_of_two_unequal_rows_by_hand(grid):
    """D1 of 2 x 2 quads has four edges; stretched rows give lengths 5 and sqrt(2)."""
    vertices = grid(2, 2).vertices.copy()
    vertices[:, 0] = np.repeat([0.0, 1.0, 5.0], 3)
    vertices[:, 1] = np.tile([0.0, 3.0, 6.0], 3)
    first, _ = gs.diagonal_meshes(gs.as_control_mesh(grid(2, 2).moved(vertices)))
    short, long = np.sqrt(10.0), 5.0
    mean = (short + long) / 2.0
    assert edge_ratio(first) == pytest.approx((short / mean, long / mean), rel=1e-15)


def test_the_distance_is_measured_from_the_reference():
    sphere = gs.Sphere(1000.0)
    u, v = np.meshgrid(np.linspace(0.0, 1.0, 6), np.linspace(-0.5, 0.5, 6), indexing="ij")
    points = sphere.point(u.ravel(), v.ravel())
    radius = np.where(np.arange(36) % 2 == 0, 1.003, 0.999)
    mesh = gs.QuadMesh(points * radius[:, None], grid_quads(5, 5))
    found = gs.net_quality(gs.as_control_mesh(mesh), reference=sphere).surface_distance_mm
    assert found.max == pytest.approx(3.0, rel=1e-9)
    assert found.mean == pytest.approx(2.0, rel=1e-9)


def test_an_unused_vertex_does_not_count_as_distant(grid):
    mesh = grid(5, 5)
    vertices = np.vstack([mesh.vertices + np.array([0.0, 0.0, 1.0]), [0.0, 0.0, 900.0]])
    control = gs.as_control_mesh(gs.QuadMesh(vertices, mesh.quads))
    found = gs.net_quality(control, reference=gs.Sphere(1.0)).surface_distance_mm
    assert found.max < 10.0


def test_figures_do_not_depend_on_size_or_place(crumpled):
    moved = crumpled.moved(1000.0 * crumpled.vertices + 5e4)
    here, there = (gs.net_quality(c, angle=1.0) for c in (crumpled, moved))
    assert there.star_planarity.max == pytest.approx(here.star_planarity.max, rel=1e-8)
    assert there.angle_error_deg.max == pytest.approx(here.angle_error_deg.max, rel=1e-8)
    assert there.edge_ratio == pytest.approx(here.edge_ratio, rel=1e-8)
    assert there.curvature_ratio == pytest.approx(here.curvature_ratio, rel=1e-6)


# ---- curvature ratio ------------------------------------------------------------------------


def test_a_minimal_surface_has_a_curvature_ratio_of_minus_one(enneper):
    assert gs.net_quality(enneper(18)).curvature_ratio == pytest.approx(-1.0, abs=0.01)


@pytest.mark.parametrize("ratio", [-0.25, -0.5, -0.9, 0.5])
def test_the_curvature_ratio_of_a_paraboloid_is_that_of_its_coefficients(grid, ratio):
    flat = 0.002
    mesh = grid(8, 8, lambda x, y: flat * ((x - 4.0) ** 2 + ratio * (y - 4.0) ** 2))
    assert curvature_ratio(gs.as_control_mesh(mesh)) == pytest.approx(ratio, abs=0.01)


def test_a_mesh_too_small_to_tell_has_no_curvature_ratio(grid):
    assert gs.net_quality(gs.as_control_mesh(grid(2, 2))).curvature_ratio is None


def test_figures_and_summary_are_one(crumpled):
    surface = gs.Enneper(4000.0)
    quality = gs.net_quality(crumpled, angle=np.radians(75.0), rhombus=True, reference=surface)
    found = quality.figures
    for key in ("star_planarity", "angle_error_deg", "rhombus_error", "surface_distance_mm"):
        values = getattr(found, key)
        assert (values.mean(), values.max()) == (
            getattr(quality, key).mean,
            getattr(quality, key).max,
        )
    for key in ("node_angle_deg", "edge_ratio", "corner_angle_deg"):
        values = getattr(found, key)
        assert (values.min(), values.max()) == getattr(quality, key)
    assert found.face_planarity is found.sphericity is None
    assert len(found.corner_angle_deg) == 4 * len(crumpled.quads)


def test_a_distance_that_was_not_asked_for_is_measured_later(crumpled):
    surface = gs.Enneper(4000.0)
    plain, asked = gs.net_quality(crumpled), gs.net_quality(crumpled, reference=surface)
    later = gs.measured_against(plain, crumpled, surface)
    assert plain.surface_distance_mm is plain.figures.surface_distance_mm is None
    assert later == asked
    np.testing.assert_array_equal(
        later.figures.surface_distance_mm, asked.figures.surface_distance_mm
    )
