"""Quad meshes of surfaces given by formula, judged by the formula; and what is refused.

The whole matrix of figures is in tests/benchmarks/test_remesh.py.
"""

from math import radians

import numpy as np
import pytest
from judging import (
    asymptotic_lines,
    conjugate_lines,
    face_planarity,
    faults,
    inner_strays,
    node_angles,
    principal_lines,
    star_planarity,
)
from surfaces import CASES

import gridshell.errors as errors
from gridshell.remesh import (
    Asymptotic,
    Conjugate,
    Extent,
    Given,
    Principal,
    quadrangulate,
    working_surface,
)
from gridshell.solve import Engine
from gridshell.surface import CurvedMesh, TriangleMesh, TriangulatedSurface

TRIANGLES = 4000


@pytest.fixture(scope="module")
def made():
    """Case, directions and quads to what was made of them, each once."""
    kept, meshes = {}, {}

    def make(name, directions, quads, **more):
        if name not in meshes:
            meshes[name] = CASES[name].triangles(TRIANGLES)
        key = (name, directions, quads, tuple(more.items()))
        if key not in kept:
            kept[key] = quadrangulate(meshes[name], directions, quads=quads, **more)
        return kept[key]

    make.curved = lambda name: meshes.setdefault(name, CASES[name].triangles(TRIANGLES))
    return make


def triangles_of(curved):
    return TriangulatedSurface(curved.mesh.vertices, curved.mesh.triangles)


HYPERBOLIC = {
    "enneper": [],
    "scherk": [],
    "catenoid": [],
    "hyperboloid": [],
    "helicoid": [],
    "hypar": [],
    "inner torus": [],
    "monkey": [6],
    "saddle with hole": [],
    "schwarz p": [6] * 8,
}


@pytest.mark.parametrize("name", HYPERBOLIC)
def test_asymptotic_nets_follow_the_exact_lines_without_a_fault(name, made):
    quads = 700 if name == "schwarz p" else 300
    result = made(name, Asymptotic(), quads)
    mesh, report = result.mesh, result.report
    assert report.non_quads == report.odd_valences == report.colour_conflicts == report.flips == 0
    assert faults(mesh).none
    inner = ~mesh.on_boundary
    assert sorted(mesh.valence[inner & (mesh.valence != 4)].tolist()) == HYPERBOLIC[name]
    off = inner_strays(mesh, CASES[name].shapes_at, asymptotic_lines)
    coarse = name == "schwarz p"
    assert off.mean() <= (0.6 if coarse else 0.25)
    assert np.percentile(off, 95) <= (1.2 if coarse else 0.6)
    assert report.alignment_deg.p95 <= (1.2 if coarse else 0.5)
    assert np.percentile(star_planarity(mesh), 95) <= (0.003 if coarse else 0.0025)
    low, _, high = report.edge_ratio
    assert low >= 0.5
    assert high <= 1.75
    assert report.coverage >= 0.94
    assert 0.7 * quads <= report.quads <= 1.35 * quads
    edges, angles = result.edge_points, result.edge_errors
    assert len(edges) == len(angles)
    assert np.degrees(angles.mean()) == pytest.approx(report.alignment_deg.mean)


def test_ruled_sides_of_a_hypar_are_edges_of_the_mesh(made):
    result = made("hypar", Asymptotic(), 300)
    assert result.report.coverage == pytest.approx(1.0)
    mesh = result.mesh
    rim = mesh.vertices[mesh.on_boundary]
    assert np.abs(np.abs(rim[:, :2]).max(axis=1) - 1000.0).max() < 1.0
    for extent in (Extent.INSIDE, Extent.TRIMMED):
        other = made("hypar", Asymptotic(), 300, extent=extent)
        assert len(other.mesh.quads) == len(mesh.quads)
    loose = made("hypar", Asymptotic(), 300, align_boundary=False)
    rim = loose.mesh.vertices[loose.mesh.on_boundary]
    assert np.abs(np.abs(rim[:, :2]).max(axis=1) - 1000.0).max() > 1.0


@pytest.mark.parametrize("name", ["enneper", "scherk", "freeform"])
def test_conjugate_nets_have_planar_quads_and_their_angle(name, made):
    angle = radians(60.0)
    result = made(name, Conjugate(angle), 500)
    assert faults(result.mesh).none
    off = inner_strays(result.mesh, CASES[name].shapes_at, conjugate_lines(angle, 1))
    assert off.mean() <= 0.3
    assert np.percentile(off, 95) <= 0.8
    assert np.percentile(face_planarity(result.mesh), 95) <= 0.002
    found = node_angles(result.control())
    assert np.mean(np.abs(np.minimum(found, 180.0 - found) - 60.0) <= 2.0) >= 0.9
    assert result.report.hand == "right"


def test_principal_nets_of_domes_and_closed_surfaces(made):
    dome = made("dome", Principal(), 500)
    assert [s.valence for s in dome.report.singularities] == [2, 2]
    control = dome.control()
    assert "umbilic-hole" in [r.code for r in dome.report.remarks]
    assert len(control.mesh.boundary_loops) == 3  # the rim, and a hole at either umbilic
    assert set(control.mesh.valence[~control.mesh.on_boundary]) == {4}
    off = inner_strays(dome.mesh, CASES["dome"].shapes_at, principal_lines)
    assert off.mean() <= 0.7
    assert np.percentile(off, 95) <= 2.0
    for name, valences in (("ellipsoid", [2] * 4), ("torus", [])):
        result = made(name, Principal(), 500)
        mesh = result.mesh
        assert not mesh.on_boundary.any()
        assert sorted(mesh.valence[mesh.valence != 4].tolist()) == valences
        found = faults(mesh)
        assert (found.odd, found.conflicts, found.control_conflicts) == (0, 0, 0)
        assert result.report.coverage == 1.0


@pytest.mark.parametrize("name", ["enneper", "catenoid"])
def test_the_isotropic_energy_follows_five_times_worse(name, made):
    ours = made(name, Asymptotic(), 300).report.alignment_deg.mean
    isotropic = made(name, Asymptotic(), 300, ladder=((1.0, False),)).report
    assert isotropic.lam == 1.0
    assert isotropic.alignment_deg.mean >= 5.0 * ours


@pytest.mark.parametrize("extent", list(Extent))
def test_extents_cover_as_they_say(extent, made):
    result = made("saddle with hole", Asymptotic(), 300, extent=extent)
    assert faults(result.mesh).none
    share = result.report.coverage
    rim = result.mesh.vertices[result.mesh.on_boundary]
    radius = np.hypot(rim[:, 0], rim[:, 1])
    lengths = result.mesh.edge_lengths / result.report.spacing_mm
    if extent is Extent.INSIDE:
        assert 0.6 < share < 0.95
    elif extent is Extent.COVER:
        assert share > 0.94
        assert radius.max() > 1000.0
    else:
        assert share > 0.9
        assert radius.max() < 1001.0
        assert lengths.min() > 0.2


def test_a_rerun_gives_the_same_bytes(made):
    first = made("monkey", Asymptotic(), 300)
    second = quadrangulate(made.curved("monkey"), Asymptotic(), quads=300)
    assert first.mesh.vertices.tobytes() == second.mesh.vertices.tobytes()
    assert first.mesh.quads.tobytes() == second.mesh.quads.tobytes()


def test_both_engines_give_the_same_mesh(made):
    first = made("monkey", Asymptotic(), 300)
    second = made("monkey", Asymptotic(), 300, engine=Engine(portable=True))
    assert (first.mesh.quads == second.mesh.quads).all()
    np.testing.assert_allclose(first.mesh.vertices, second.mesh.vertices, atol=0.01)


@pytest.mark.parametrize("change", ["metres", "far away", "turned"])
def test_units_place_and_pose_do_not_matter(change, made):
    points = made.curved("saddle").mesh.vertices
    turn = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    image = {
        "metres": lambda x: x / 1000.0,
        "far away": lambda x: x + np.array([1e6, -1e6, 1e6]),
        "turned": lambda x: x @ turn.T,
    }[change]
    triangles = made.curved("saddle").mesh.triangles
    one = quadrangulate(TriangulatedSurface(points, triangles), Asymptotic(), quads=200)
    two = quadrangulate(TriangulatedSurface(image(points), triangles), Asymptotic(), quads=200)
    assert (one.mesh.quads == two.mesh.quads).all()
    scale = 1e-3 if change == "metres" else 1.0
    np.testing.assert_allclose(image(one.mesh.vertices), two.mesh.vertices, atol=0.1 * scale)


@pytest.mark.parametrize("directions", [Asymptotic(), Conjugate(radians(70.0))])
def test_the_other_side_up_changes_only_labels(directions, made):
    curved = made.curved("saddle")
    mesh = TriangleMesh(curved.mesh.vertices, curved.mesh.triangles[:, [1, 0, 2]])
    shapes = curved.face_shapes * [-1.0, 1.0, -1.0]
    other = CurvedMesh(mesh, -curved.normals, -curved.shapes, shapes)
    one = made("saddle", directions, 300).mesh
    two = quadrangulate(other, directions, quads=300).mesh
    assert len(one.quads) == len(two.quads)
    a, b = (
        m.vertices[m.quads].mean(axis=1)[np.lexsort(np.round(m.vertices[m.quads].mean(axis=1)).T)]
        for m in (one, two)
    )
    np.testing.assert_allclose(a, b, atol=0.5)


def test_an_edge_length_may_be_given_instead_of_a_number(made):
    by_number = made("scherk", Asymptotic(), 300)
    by_edge = quadrangulate(made.curved("scherk"), Asymptotic(), edge=by_number.report.spacing_mm)
    assert (by_number.mesh.quads == by_edge.mesh.quads).all()


def test_given_directions_are_followed(made):
    curved = made.curved("scherk")
    normals = curved.mesh.face_normals
    first = np.cross(normals, [0.0, 1.0, 0.0])
    second = np.cross(normals, [1.0, 0.3, 0.0])
    result = quadrangulate(curved, Given(first, second), quads=200)
    assert faults(result.mesh).none
    assert result.report.alignment_deg.p95 < 1.0


def test_the_first_edge_of_every_quad_runs_along_family_one(made):
    result = made("catenoid", Asymptotic(), 300)
    mesh = result.mesh
    middle = (mesh.vertices[mesh.quads[:, 0]] + mesh.vertices[mesh.quads[:, 1]]) / 2.0
    faces, _ = TriangulatedSurface(
        result.curved.mesh.vertices, result.curved.mesh.triangles
    ).locate(middle)
    along = mesh.vertices[mesh.quads[:, 1]] - mesh.vertices[mesh.quads[:, 0]]
    first, second = (
        np.abs(np.einsum("nc,nc->n", along, d[faces]))
        for d in (result.field.first_directions, result.field.second_directions)
    )
    assert (first > second).all()


# ---- what is refused, and what is said -----------------------------------------------------------


def noisy(curved, share):
    rng = np.random.default_rng(0)
    away = rng.normal(size=curved.mesh.vertices.shape) * share * curved.mesh.mean_edge
    return TriangulatedSurface(curved.mesh.vertices + away, curved.mesh.triangles)


@pytest.mark.parametrize(
    ("name", "directions", "quads", "error", "says"),
    [
        ("flat", Principal(), 300, errors.FlatSurfaceError, "found largest.*Try: draw guide"),
        ("sphere cap", Principal(), 300, errors.UmbilicRegionError, r"\) mm.*100 %.*30 %.*Try"),
        ("sphere cap", Conjugate(1.2), 300, errors.UmbilicRegionError, "100 %"),
        ("wave", Asymptotic(), 300, errors.NotHyperbolicError, r"\) mm.*5\d.\d % of.*1 %.*Try"),
        ("paraboloid", Principal(), 500, errors.PoleSingularityError, r"\) mm.*\+1 .*hole of"),
        ("paraboloid", Conjugate(1.4), 500, errors.PoleSingularityError, r"hole of about \d+ mm"),
        ("schwarz p", Asymptotic(), 20, errors.TooManySingularitiesError, r"\) mm.*in about 20"),
        ("torus", Principal(), 10, errors.TargetTooCoarseError, r"\) mm.*three around.*Try: more"),
        ("enneper", Asymptotic(), 1, errors.TargetTooCoarseError, r"\) mm.*edges of \d.*Try: more"),
        ("narrow ring", Asymptotic(), 20, errors.TargetTooCoarseError, "No quad fits"),
    ],
)
def test_what_cannot_be_done_is_named(name, directions, quads, error, says, made):
    with pytest.raises(error, match=says):
        quadrangulate(made.curved(name), directions, quads=quads)


def test_a_hole_at_the_pole_helps(made):
    result = made("punctured", Principal(), 500)
    assert faults(result.mesh).none
    assert result.report.alignment_deg.p95 < 2.0


def test_a_little_noise_is_smoothed_and_said(made):
    result = quadrangulate(noisy(made.curved("enneper"), 0.03), Asymptotic(), quads=300)
    assert faults(result.mesh).none
    off = inner_strays(result.mesh, CASES["enneper"].shapes_at, asymptotic_lines)
    assert np.percentile(off, 95) <= 2.5
    assert [r.code for r in result.report.remarks] == ["noise"]


def test_much_noise_is_refused(made):
    with pytest.raises((errors.NoisyInputError, errors.SelfIntersectionError), match="Try"):
        quadrangulate(noisy(made.curved("enneper"), 0.6), Asymptotic(), quads=300)


def test_findings_are_in_the_report(made):
    narrow = made("narrow ring", Asymptotic(), 300)
    assert "too-coarse" in [r.code for r in narrow.report.remarks]
    assert narrow.report.control_quads == 0
    with pytest.raises(errors.MeshError):
        narrow.control()
    half = made("punctured", Conjugate(radians(80.0)), 500).report
    finding = next(r for r in half.remarks if r.code == "angle-infeasible")
    assert finding.value == pytest.approx(half.infeasible_area)
    assert "degrees" in finding.message


def test_no_singular_point_is_lost_where_directions_turn_abruptly(made):
    """The chart folds at both points until the spacing follows the directions."""
    result = made("ridge", Principal(), 300)
    inner = ~result.mesh.on_boundary
    assert result.mesh.valence[inner & (result.mesh.valence != 4)].tolist() == [6, 6]
    assert result.report.flips == 0
    assert result.report.remarks == ()
    assert result.report.alignment_deg.p95 < 2.0


def test_an_angle_that_has_no_effect_is_said(made):
    report = made("ellipsoid", Conjugate(radians(30.0)), 500).report
    assert report.infeasible_area == pytest.approx(1.0)
    assert any("no effect" in r.message for r in report.remarks)


@pytest.mark.parametrize(
    ("sizes", "says"),
    [
        ({}, "found neither"),
        ({"quads": 300, "edge": 20.0}, "found both"),
        ({"quads": 0}, "quads.*> 0"),
        ({"edge": -2.0}, "edge.*> 0"),
        ({"edge": float("nan")}, "edge.*> 0"),
        ({"edge": float("inf")}, "edge.*> 0"),
    ],
)
def test_the_size_must_make_sense(sizes, says, made):
    with pytest.raises(errors.SettingError, match=says):
        quadrangulate(triangles_of(made.curved("scherk")), Asymptotic(), **sizes)


def broken(curved, how):
    """Vertices and triangles with one fault."""
    v, t = curved.mesh.vertices.copy(), curved.mesh.triangles.copy()
    if how == "in two pieces":
        return np.concatenate([v, v + 9e3]), np.concatenate([t, t + len(v)])
    if how == "not manifold":
        inner = t[~curved.mesh.on_boundary[t].any(axis=1)][0]
        top = v[inner].mean(axis=0) + np.array([0.0, 0.0, 300.0])
        return np.concatenate([v, [top]]), np.concatenate([t, [[inner[0], inner[1], len(v)]]])
    if how == "not a number":
        v[7, 2] = np.nan
    return v, t


@pytest.mark.parametrize(
    ("how", "error", "says"),
    [
        ("in two pieces", errors.DisconnectedError, r"mm.*2 pieces.*Try"),
        ("not manifold", (errors.NonManifoldError, errors.SurfaceError), r"mm.*Try"),
        ("not a number", errors.InputError, "7"),
    ],
)
def test_broken_triangles_are_named(how, error, says, made):
    points, triangles = broken(made.curved("scherk"), how)

    def work():
        quadrangulate(TriangulatedSurface(points, triangles), Asymptotic(), quads=300)

    with pytest.raises(error, match=says):
        work()


def test_triangles_that_face_the_other_way_and_doubled_ones_are_mended(made):
    curved = made.curved("scherk")
    triangles = curved.mesh.triangles.copy()
    triangles[::3] = triangles[::3, ::-1]
    triangles = np.concatenate([triangles, triangles[:5]])
    source = TriangulatedSurface(curved.mesh.vertices, triangles)
    result = quadrangulate(source, Asymptotic(), quads=300)
    assert faults(result.mesh).none
    assert {"turned", "doubled"} & {r.code for r in result.report.remarks} or len(
        result.report.remarks
    ) >= 2


def test_a_moebius_strip_is_refused():
    n, m = 60, 8
    turn, across = np.meshgrid(
        2.0 * np.pi * np.arange(n) / n, np.linspace(-0.4, 0.4, m), indexing="ij"
    )
    radius = 1.0 + across * np.cos(turn / 2.0)
    points = np.stack(
        [radius * np.cos(turn), radius * np.sin(turn), across * np.sin(turn / 2.0)], axis=-1
    )
    quads = []
    for i in range(n):
        for j in range(m - 1):
            k, b = i * m + j, ((i + 1) % n) * m
            c, d = (b + j, b + j + 1) if i < n - 1 else (b + m - 1 - j, b + m - 2 - j)
            quads.append([k, c, d, k + 1])
    source = TriangulatedSurface.of_quads(1000.0 * points.reshape(-1, 3), np.array(quads))
    with pytest.raises(errors.OrientationError, match="Try"):
        quadrangulate(source, Asymptotic(), quads=200)


def test_slivers_are_refused():
    u, v = np.meshgrid(np.linspace(-1, 1, 9), np.linspace(-1, 1, 240), indexing="ij")
    points = 1000.0 * np.stack([u, v, 0.4 * u * u - 0.3 * v * v], axis=-1).reshape(-1, 3)
    k = (np.arange(8)[:, None] * 240 + np.arange(239)).ravel()
    source = TriangulatedSurface.of_quads(points, np.stack([k, k + 240, k + 241, k + 1], axis=1))
    with pytest.raises(errors.PoorTriangulationError, match=r"mm.*%.*Try"):
        quadrangulate(source, Asymptotic(), quads=200)


def test_a_working_surface_can_be_used_again(made):
    ready = working_surface(triangles_of(made.curved("enneper")), quads=300)
    one = quadrangulate(ready, Asymptotic(), quads=300)
    two = quadrangulate(ready, Principal(), quads=300)
    assert (one.curved.mesh.vertices == ready.curved.mesh.vertices).all()
    assert faults(one.mesh).none
    assert faults(two.mesh).none
