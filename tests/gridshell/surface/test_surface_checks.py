import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gridshell import errors
from gridshell.surface import aspects, sound_mesh
from gridshell.surface.self_intersection import crossing_triangles


def codes(remarks):
    return [r.code for r in remarks]


@pytest.fixture
def patch(exact):
    mesh = exact("enneper", 8).mesh
    return mesh.vertices.copy(), mesh.triangles.copy()


def strip(n, half_twist):
    """A closed band of n quads cut in two; joined to its own other side for a Moebius strip."""
    t = np.arange(n) * 2.0 * np.pi / n
    lean = t / 2.0 * half_twist
    arm = np.stack([np.cos(lean) * np.cos(t), np.cos(lean) * np.sin(t), np.sin(lean)], axis=1)
    middle = np.stack([np.cos(t), np.sin(t), 0.0 * t], axis=1)
    vertices = 1000.0 * np.concatenate([middle + 0.3 * arm, middle - 0.3 * arm])
    a, b = np.arange(n), np.roll(np.arange(n), -1)
    c, d = b + n, a + n
    if half_twist:
        b[-1], c[-1] = n, 0
    return vertices, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def test_a_sound_surface_comes_back_as_it_is(patch):
    mesh, remarks = sound_mesh(*patch)
    np.testing.assert_array_equal(mesh.vertices, patch[0])
    np.testing.assert_array_equal(mesh.triangles, patch[1])
    assert remarks == ()


@given(
    seed=st.integers(0, 100), scale=st.sampled_from([1.0, 1e3]), away=st.sampled_from([0.0, 1e6])
)
def test_triangles_of_an_stl_file_are_welded(exact, seed, scale, away):
    """Single precision, every corner a vertex of its own, in any order."""
    mesh = exact("hypar", 8).mesh
    vertices = scale * mesh.vertices + away
    order = np.random.default_rng(seed).permutation(len(mesh.triangles))
    soup = vertices[mesh.triangles[order]].reshape(-1, 3)
    if away == 0.0:
        soup = soup.astype(np.float32)
    found, remarks = sound_mesh(soup, np.arange(len(soup)).reshape(-1, 3))
    assert len(found.vertices) == len(vertices)
    assert found.euler_characteristic == 1
    corners = vertices[mesh.triangles[order]]
    np.testing.assert_allclose(found.corners, corners, rtol=1e-6, atol=1e-4)
    assert codes(remarks)[0] == "welded"
    assert remarks[0].value == len(soup) - len(vertices)


def test_vertices_a_rounding_apart_are_one(patch):
    vertices, triangles = patch
    soup = vertices[triangles].reshape(-1, 3)
    soup += np.random.default_rng(0).uniform(-1e-6, 1e-6, soup.shape)
    found, _ = sound_mesh(soup, np.arange(len(soup)).reshape(-1, 3))
    assert len(found.vertices) == len(vertices)


def test_loose_vertices_doubled_and_collapsed_triangles_are_removed(patch):
    vertices, triangles = patch
    worse = np.concatenate([triangles[:3, [1, 2, 0]], triangles, [[5, 5, 6]]])
    found, remarks = sound_mesh(np.vstack([[[9.0, 9.0, 9.0]], vertices]), worse + 1)
    assert len(found.triangles) == len(triangles)
    assert len(found.vertices) == len(vertices)
    assert codes(remarks) == ["collapsed-triangles", "doubled-triangles", "loose-vertices"]
    assert [r.value for r in remarks] == [1, 3, 1]


def test_triangles_that_face_the_other_way_are_turned(patch):
    vertices, triangles = patch
    mixed = triangles.copy()
    some = np.random.default_rng(1).choice(len(triangles), 40, replace=False)
    mixed[some] = mixed[some, ::-1]
    found, (remark,) = sound_mesh(vertices, mixed)
    assert remark.code == "turned-triangles"
    assert remark.value == 40
    np.testing.assert_array_equal(np.sort(found.triangles, 1), np.sort(triangles, 1))
    before = np.cross(*np.moveaxis(np.diff(vertices[triangles], axis=1), 1, 0))
    assert (np.einsum("fc,fc->f", before, found.face_normals) > 0.0).all()


def test_a_band_is_taken_and_a_moebius_strip_refused():
    mesh, _ = sound_mesh(*strip(24, half_twist=False))
    assert mesh.euler_characteristic == 0
    with pytest.raises(errors.OrientationError, match="Moebius"):
        sound_mesh(*strip(24, half_twist=True))


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_a_vertex_that_is_no_place_is_named(patch, value):
    patch[0][17, 1] = value
    with pytest.raises(errors.DegenerateSurfaceError, match="vertex 17"):
        sound_mesh(*patch)


def test_a_triangle_without_area_is_named():
    vertices = np.array([[0.0, 0, 0], [500, 0, 0], [1000, 0, 0], [500, 400, 0]])
    with pytest.raises(errors.DegenerateSurfaceError, match=r"triangle \[0, 1, 2\] \(500, 0, 0\)"):
        sound_mesh(vertices, [[0, 1, 2], [0, 2, 3]])


def test_nothing_but_collapsed_triangles_is_no_surface():
    with pytest.raises(errors.DegenerateSurfaceError, match="No triangle"):
        sound_mesh([[0.0, 0, 0], [500, 0, 0]], [[0, 1, 1]])


@pytest.mark.parametrize(("scale", "away"), [(0.0, 0.0), (1e-15, 0.0), (1e20, 0.0), (1.0, 1e15)])
def test_an_absurd_size_or_place_is_refused(patch, scale, away):
    with pytest.raises(errors.DegenerateSurfaceError, match="mm"):
        sound_mesh(scale * patch[0] + away, patch[1])


def test_a_suspect_unit_is_remarked(patch):
    _, (remark,) = sound_mesh(1e-3 * patch[0], patch[1])
    assert remark.code == "unusual-size"
    assert "unit" in remark.message


def test_a_fin_is_refused(patch):
    vertices, triangles = patch
    fin = np.vstack([vertices, np.add(vertices[triangles[60]].mean(axis=0), [0.0, 0.0, 300.0])])
    more = np.vstack([triangles, [triangles[60, 0], triangles[60, 1], len(vertices)]])
    with pytest.raises(errors.NonManifoldError, match="3 triangles"):
        sound_mesh(fin, more)


def test_a_waist_of_one_vertex_is_refused(patch):
    """Two corners of a disk drawn together: one piece, an edge path joins them, two fans."""
    vertices, triangles = strip(24, half_twist=False)
    open_band = np.delete(triangles, [0, 24], axis=0)
    merged = np.where(open_band == 13, 4, open_band)
    with pytest.raises(errors.NonManifoldError, match="2 fans"):
        sound_mesh(vertices, merged)


def test_pieces_are_counted(patch):
    vertices, triangles = patch
    both = np.vstack([vertices, np.add(vertices, [5000.0, 0.0, 0.0])])
    more = np.vstack([triangles, triangles[:20] + len(vertices)])
    with pytest.raises(errors.DisconnectedError, match=r"pieces of 128, "):
        sound_mesh(both, more)


@pytest.mark.parametrize(
    ("vertices", "triangles"),
    [
        (np.zeros((3, 2)), [[0, 1, 2]]),
        (np.zeros((3, 3)), [[0, 1, 2, 2]]),
        (np.zeros((3, 3)), np.zeros((0, 3), dtype=int)),
        (np.zeros((3, 3)), [[0.0, 1.0, 2.0]]),
        (np.eye(3), [[0, 1, 3]]),
        (np.eye(3), [[0, 1, -1]]),
    ],
)
def test_arrays_that_are_no_triangles_are_refused(vertices, triangles):
    with pytest.raises(errors.SurfaceError):
        sound_mesh(vertices, triangles)


def test_a_strip_that_runs_through_itself_is_refused():
    """A ribbon bent to a loop whose end passes through its beginning."""
    t = np.linspace(0.0, 2.2 * np.pi, 60)
    r = 1000.0 + 100.0 * (np.pi - t)
    r[-10:] = np.linspace(r[-10], 1500.0, 10)
    side = np.stack([r * np.cos(t), r * np.sin(t), 0.0 * t], axis=1)
    vertices = np.concatenate([side, np.add(side, [0.0, 0.0, 200.0])])
    a = np.arange(59)
    triangles = np.concatenate([np.stack([a, a + 1, a + 61], 1), np.stack([a, a + 61, a + 60], 1)])
    with pytest.raises(errors.SelfIntersectionError, match="pairs of triangles"):
        sound_mesh(vertices, triangles)
    apart = vertices * [1.0, 1.0, 1.0]
    apart[:, 2] += np.tile(np.linspace(0.0, 3000.0, 60), 2)
    sound_mesh(apart, triangles)


def segments_cross(a, b):
    """Whether an edge of triangle a passes through triangle b: an independent, slow answer."""
    for p, q in zip(a, np.roll(a, -1, axis=0), strict=True):
        matrix = np.stack([q - p, b[0] - b[1], b[0] - b[2]], axis=1)
        if abs(np.linalg.det(matrix)) < 1e-12:
            continue
        t, u, v = np.linalg.solve(matrix, b[0] - p)
        if 0 < t < 1 and u > 0 and v > 0 and u + v < 1:
            return True
    return False


@pytest.mark.parametrize("size", [0.05, 0.3, 2.0])
def test_crossings_are_those_of_the_definition(size):
    rng = np.random.default_rng(3)
    own = size * 10.0 ** rng.uniform(-1.0, 0.5, (60, 1, 1))
    corners = rng.uniform(size=(60, 1, 3)) + own * rng.normal(size=(60, 3, 3))
    triangles = np.arange(180).reshape(-1, 3)
    found = {tuple(sorted(p)) for p in crossing_triangles(corners.reshape(-1, 3), triangles)}
    expected = {
        (i, j)
        for i in range(60)
        for j in range(i + 1, 60)
        if segments_cross(corners[i], corners[j]) or segments_cross(corners[j], corners[i])
    }
    assert found == expected
    assert expected


@pytest.mark.parametrize(("shift", "expected"), [(0.5, 1), (1.0, 0), (1.2, 0)])
def test_triangles_in_one_plane_cross_where_they_overlap(shift, expected):
    one = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    vertices = np.vstack([one, np.add(one, [shift, 0.0, 0.0])])
    assert len(crossing_triangles(vertices, np.arange(6).reshape(2, 3))) == expected


def test_slivers_are_remarked():
    from gridshell.mesh import grid_quads

    i, j = (a.ravel() for a in np.mgrid[0:21, 0:21].astype(float))
    quads = grid_quads(20, 20)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    mesh, (remark,) = sound_mesh(np.stack([200.0 * i, 10.0 * j, i * i], axis=1), triangles)
    assert remark.code == "slivers"
    assert remark.value == pytest.approx(1.0)
    assert aspects(mesh).min() > 15.0


def test_an_equilateral_triangle_has_aspect_one():
    mesh, _ = sound_mesh([[0.0, 0, 0], [200, 0, 0], [100, 100 * np.sqrt(3.0), 0]], [[0, 1, 2]])
    assert aspects(mesh) == pytest.approx([1.0])
