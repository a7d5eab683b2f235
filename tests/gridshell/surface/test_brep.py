"""B-reps against closed forms: feet, normals, curvature, tessellation and what is refused."""

import itertools

import numpy as np
import pytest

from gridshell.errors import NotOnePatchError, SettingError, SurfaceError
from gridshell.surface import BrepSurface, Derivatives, Surface
from gridshell.surface.exact_curvature import normals_and_shapes


@pytest.fixture(scope="module")
def four(brep_shapes):
    return BrepSurface.of_shape(brep_shapes.four_saddles())


@pytest.fixture(scope="module")
def cylinder(brep_shapes):
    return BrepSurface.of_shape(brep_shapes.cylinder())


@pytest.fixture(scope="module")
def plate(brep_shapes):
    return BrepSurface.of_shape(brep_shapes.plate_with_hole())


@pytest.fixture(scope="module")
def dome(brep_shapes):
    return BrepSurface.of_shape(brep_shapes.hemisphere())


def saddle_at(points, bend):
    x, y = points[:, 0], points[:, 1]
    zero, one = np.zeros_like(x), np.ones_like(x)
    return Derivatives(
        np.stack([x, y, (x * x - y * y) / (2 * bend)], 1),
        np.stack([one, zero, x / bend], 1),
        np.stack([zero, one, -y / bend], 1),
        np.stack([zero, zero, one / bend], 1),
        np.zeros_like(points),
        np.stack([zero, zero, -one / bend], 1),
    )


def well_shaped(mesh, edge):
    sides = mesh.edge_lengths.reshape(-1, 3)
    assert (sides.max(axis=1) / sides.min(axis=1)).max() < 3.0
    assert mesh.mean_edge == pytest.approx(edge, rel=0.15)


def test_four_patches_are_sewn_into_one_saddle(four, brep_shapes):
    assert isinstance(four, Surface)
    assert four.largest_crease < 1e-7
    found = four.curved_mesh(100.0)
    mesh = found.mesh
    assert mesh.euler_characteristic == 1
    assert len(mesh.boundary_loops) == 1
    well_shaped(mesh, 100.0)
    d = saddle_at(mesh.vertices, brep_shapes.BEND)
    np.testing.assert_allclose(d.x, mesh.vertices, atol=1e-9)
    normals, shapes = normals_and_shapes(d)
    np.testing.assert_allclose(found.normals, normals, atol=1e-12)
    np.testing.assert_allclose(found.shapes, shapes, atol=1e-15)
    assert np.einsum("ni,ni->n", found.normals, mesh.vertex_normals).min() > 0.99


def test_curvature_of_triangles_is_that_at_their_centroids_feet(four):
    found = four.curved_mesh(100.0)
    foot = four.closest(found.mesh.centroids)
    a, b, c = found.face_shapes.T
    np.testing.assert_allclose(a * c - b * b, foot.curvature.prod(axis=1), atol=1e-15)
    np.testing.assert_allclose((a + c) / 2, foot.curvature.mean(axis=1), atol=1e-13)


def test_feet_are_recovered_from_points_along_the_normals(four, brep_shapes):
    rng = np.random.default_rng(0)
    flat = np.column_stack([rng.uniform(-990, 990, (500, 2)), np.zeros(500)])
    d = saddle_at(flat, brep_shapes.BEND)
    normals, shapes = normals_and_shapes(d)
    foot = four.closest(d.x + rng.uniform(-300, 300, (500, 1)) * normals)
    np.testing.assert_allclose(foot.points, d.x, atol=1e-8)
    np.testing.assert_allclose(foot.normals, normals, atol=1e-11)
    kappa = np.linalg.eigvalsh(shapes)[:, [0, 2]]
    np.testing.assert_allclose(foot.curvature, kappa, atol=1e-13)


def test_no_point_of_a_fine_mesh_is_nearer_than_the_foot(four):
    points = np.random.default_rng(1).uniform(-1300, 1300, (400, 3)) * [1, 1, 0.3]
    away = np.linalg.norm(four.closest(points).points - points, axis=1)
    from scipy.spatial import cKDTree

    vertices = four.curved_mesh(15.0).mesh.vertices
    nearest = cKDTree(vertices).query(points)[0]
    assert (away <= nearest + 1e-9).all()
    assert (away > nearest - 15.0).all()


def test_a_cylinder_is_closed_along_its_seam(cylinder):
    found = cylinder.curved_mesh(80.0)
    mesh = found.mesh
    assert mesh.euler_characteristic == 0
    assert len(mesh.boundary_loops) == 2
    well_shaped(mesh, 80.0)
    np.testing.assert_allclose(np.linalg.norm(mesh.vertices[:, :2], axis=1), 1000.0, rtol=1e-9)
    a, b, c = found.face_shapes.T
    np.testing.assert_allclose(a * c - b * b, 0.0, atol=1e-15)
    np.testing.assert_allclose(np.abs(a + c), 1e-3, rtol=1e-9)


def test_feet_on_a_cylinder_and_on_its_rims(cylinder):
    rng = np.random.default_rng(2)
    angle, radius = rng.uniform(-np.pi, np.pi, 800), rng.uniform(200, 1800, 800)
    height = rng.uniform(-500, 2000, 800)
    direction = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    foot = cylinder.closest(radius[:, None] * direction + height[:, None] * [0, 0, 1])
    expected = 1000 * direction + np.clip(height, 0, 1500)[:, None] * [0, 0, 1]
    np.testing.assert_allclose(foot.points, expected, atol=1e-5)
    side = np.einsum("ni,ni->n", foot.normals, direction)
    np.testing.assert_allclose(side, side[0] * np.ones(800), atol=1e-8)


def test_a_sector_keeps_to_its_sector(brep_shapes):
    sector = BrepSurface.of_shape(brep_shapes.cylinder(120.0))
    assert sector.curved_mesh(100.0).mesh.euler_characteristic == 1
    foot = sector.closest(np.array([[900.0, -500.0, 700.0], [0.0, 1300.0, 700.0]]))
    np.testing.assert_allclose(foot.points, [[1000, 0, 700], [0, 1000, 700]], atol=1e-6)


def test_the_hole_of_a_trimmed_face_is_left_out(plate):
    mesh = plate.curved_mesh(60.0).mesh
    assert mesh.euler_characteristic == 0
    well_shaped(mesh, 60.0)
    assert np.linalg.norm(mesh.vertices[:, :2] - [300, 0], axis=1).min() > 199.999
    points = np.random.default_rng(3).uniform(-1, 1, (1000, 3)) * [1200, 700, 300]
    expected = np.clip(points, [-1000, -500, 0], [1000, 500, 0])
    offset = expected[:, :2] - [300, 0]
    radius = np.linalg.norm(offset, axis=1)
    hole = radius < 200
    assert hole.sum() > 20
    expected[hole, :2] = [300, 0] + 200 * offset[hole] / radius[hole, None]
    np.testing.assert_allclose(plate.closest(points).points, expected, atol=1e-5)


def test_a_pole_is_one_vertex(dome):
    found = dome.curved_mesh(100.0)
    assert found.mesh.euler_characteristic == 1
    well_shaped(found.mesh, 100.0)
    outside = np.sign(found.normals[0] @ found.mesh.vertices[0])
    np.testing.assert_allclose(found.normals, outside * found.mesh.vertices / 1000, atol=1e-4)
    a, b, c = found.face_shapes.T
    np.testing.assert_allclose([a, c], -outside * 1e-3, atol=1e-9)
    np.testing.assert_allclose(b, 0.0, atol=1e-9)
    top = int(np.argmax(found.mesh.vertices[:, 2]))
    np.testing.assert_allclose(found.mesh.vertices[top], [0, 0, 1000], atol=1e-6)
    assert not found.mesh.on_boundary[top]
    foot = dome.closest(np.array([[0.0, 0.0, 1300.0], [1e-3, 0.0, 700.0]]))
    np.testing.assert_allclose(foot.points, [[0, 0, 1000]] * 2, atol=5e-3)
    np.testing.assert_allclose(foot.curvature, -outside * 1e-3, rtol=1e-4)


def test_a_rigid_motion_changes_places_only(brep_shapes):
    from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
    from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec

    turn, move = gp_Trsf(), gp_Trsf()
    turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(1, 2, 3)), 0.7)
    move.SetTranslation(gp_Vec(100, 200, 300))
    motion = move.Multiplied(turn)
    shape = brep_shapes.saddle()
    still = BrepSurface.of_shape(shape)
    moved = BrepSurface.of_shape(BRepBuilderAPI_Transform(shape, motion, True).Shape())
    q = np.array([[motion.Value(i, j) for j in range(1, 5)] for i in range(1, 4)])
    points = np.random.default_rng(4).uniform(-900, 900, (200, 3)) * [1, 1, 0.2]
    a, b = still.closest(points), moved.closest(points @ q[:, :3].T + q[:, 3])
    np.testing.assert_allclose(b.points, a.points @ q[:, :3].T + q[:, 3], atol=1e-8)
    np.testing.assert_allclose(b.normals, a.normals @ q[:, :3].T, atol=1e-10)
    np.testing.assert_allclose(b.curvature, a.curvature, atol=1e-13)


def test_a_fold_is_measured(brep_shapes):
    poles = np.array([[[0, 0, 0], [0, 1000, 0]], [[1000, 0, 0], [1000, 1000, 0.0]]])
    wall = np.array([[[0, 0, 0], [0, 1000, 0]], [[0, 0, 1000], [0, 1000, 1000.0]]])
    fold = BrepSurface.of_shape(brep_shapes.compound(*map(brep_shapes.bezier, (poles, wall))))
    assert fold.largest_crease == pytest.approx(np.pi / 2)


def test_an_edge_much_shorter_than_the_triangles_leaves_no_sliver(brep_shapes):
    import build123d as bd

    shape = bd.Face(bd.Wire.make_polygon([(0, 0), (1000, 0), (1003, 3), (1000, 900), (0, 900)]))
    mesh = BrepSurface.of_shape(shape.wrapped).curved_mesh(100.0).mesh
    well_shaped(mesh, 100.0)


def test_a_gap_wider_than_the_tolerance_is_not_sewn(brep_shapes):
    shape = brep_shapes.compound(
        brep_shapes.saddle(-1000.0, -1000.0, 1000.0), brep_shapes.saddle(0.5, -1000.0, 1000.0)
    )
    with pytest.raises(NotOnePatchError, match="not one connected patch") as info:
        BrepSurface.of_shape(shape)
    assert info.value.where.startswith("face 1 (")
    assert (
        BrepSurface.of_shape(shape, tolerance=2.0).curved_mesh(100.0).mesh.euler_characteristic == 1
    )


def test_what_is_no_patch_is_named(brep_shapes):
    import build123d as bd

    with pytest.raises(NotOnePatchError, match="solid"):
        BrepSurface.of_shape(bd.Box(1, 1, 1).wrapped)
    with pytest.raises(NotOnePatchError, match="no faces"):
        BrepSurface.of_shape(bd.Edge.make_line((0, 0, 0), (1, 0, 0)).wrapped)
    flat = np.array([[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0.0]]]) * 1000
    turned = [flat @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
              for c, s in ((1.0, 0.0), (-0.5, 0.866), (-0.5, -0.866))]  # fmt: skip
    with pytest.raises(NotOnePatchError, match=r"not one connected patch|More than two"):
        BrepSurface.of_shape(brep_shapes.compound(*map(brep_shapes.bezier, turned)))


def test_a_moebius_strip_is_named(brep_shapes):
    def rail(t):
        middle = 1000 * np.array([np.cos(2 * t), np.sin(2 * t), 0])
        across = 200 * np.array([np.cos(t) * np.cos(2 * t), np.cos(t) * np.sin(2 * t), np.sin(t)])
        return middle - across, middle + across

    stops = np.linspace(0, np.pi, 7)
    faces = [brep_shapes.bezier(np.array([rail(a), rail(b)])) for a, b in itertools.pairwise(stops)]
    with pytest.raises(SurfaceError, match="one side only") as info:
        BrepSurface.of_shape(brep_shapes.compound(*faces))
    assert info.value.where.startswith("edge ")


@pytest.mark.parametrize("edge", [0.0, -5.0, 1e-3])
def test_an_edge_length_that_makes_no_sense_is_named(four, edge):
    with pytest.raises(SettingError, match="too many triangles"):
        four.curved_mesh(edge)
