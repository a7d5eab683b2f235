"""Analytic surfaces against difference quotients, closed forms and each other."""

from __future__ import annotations

import math
import pickle
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from gridshell.arrays import Floats
from gridshell.errors import InputError, NotHyperbolicError, SettingError
from gridshell.surface import (
    AnalyticSurface,
    Catenoid,
    Enneper,
    Foot,
    Helicoid,
    Hypar,
    Hyperboloid,
    RevolutionSurface,
    Scherk,
    Sphere,
    Surface,
    Torus,
    checked_points,
)
from gridshell.surface.forms import dot

SADDLES: list[AnalyticSurface] = [
    Enneper(1300.0),
    Catenoid(700.0),
    Helicoid(5000.0),
    Hypar(2500.0),
    Hyperboloid(900.0, 1600.0),
    Scherk(400.0),
    Torus(3000.0, 800.0),
    Torus(1000.0, 950.0),
]
MINIMAL: list[AnalyticSurface] = [s for s in SADDLES if type(s) in (Enneper, Catenoid, Helicoid)]
MINIMAL += [s for s in SADDLES if isinstance(s, Scherk)]
SURFACES: list[AnalyticSurface] = [*SADDLES, Sphere(1200.0)]
REVOLVED: list[RevolutionSurface] = [s for s in SURFACES if isinstance(s, RevolutionSurface)]


def torus_curvature(s: Torus, u: Floats, v: Floats) -> Floats:
    x, y, z = s.point(u, v).T
    cos = np.cos(np.arctan2(z, np.hypot(x, y) - s.major))
    curvature: Floats = cos / (s.minor * (s.major + s.minor * cos))
    return curvature


def scherk_curvature(s: Scherk, u: Floats, v: Floats) -> Floats:
    a, b = np.cosh(u) ** 2, np.cosh(v) ** 2
    curvature: Floats = -a * b / (s.scale * (a + b - 1)) ** 2
    return curvature


def hyperboloid_curvature(s: Hyperboloid, u: Floats, v: Floats) -> Floats:
    x, y, z = s.point(u, v).T
    a, c = s.radius, s.height
    curvature: Floats = -1.0 / (a**2 * c * ((x**2 + y**2) / a**4 + z**2 / c**4)) ** 2
    return curvature


GAUSS: dict[type, Callable[..., Floats]] = {
    Enneper: lambda s, u, v: -4 / (s.scale**2 * (1 + u**2 + v**2) ** 4),
    Catenoid: lambda s, u, v: -1 / (s.radius**2 * np.cosh(v) ** 4),
    Helicoid: lambda s, u, v: -((2 * math.pi / s.pitch) ** 2) / np.cosh(u + v) ** 4,
    Hypar: lambda s, u, v: -1 / (s.scale * (1 + 2 * u**2 + 2 * v**2)) ** 2,
    Hyperboloid: hyperboloid_curvature,
    Scherk: scherk_curvature,
    Torus: torus_curvature,
    Sphere: lambda s, u, v: np.full_like(u, s.radius**-2),
}


def named(surface: object) -> str:
    return type(surface).__name__


def on_each(surfaces: Sequence[AnalyticSurface]) -> pytest.MarkDecorator:
    return pytest.mark.parametrize("surface", surfaces, ids=named)


def sample(surface: AnalyticSurface, n: int = 200, seed: int = 1) -> tuple[Floats, Floats]:
    """Random parameters (n,) in the domain."""
    low, high = np.array(surface.domain).T
    u, v = np.random.default_rng(seed).uniform(low, high, (n, 2)).T
    return u, v


@on_each(SURFACES)
def test_derivatives_agree_with_central_differences(surface: AnalyticSurface) -> None:
    u, v = sample(surface)
    h = 1e-5
    east, west = surface.derivatives(u + h, v), surface.derivatives(u - h, v)
    north, south = surface.derivatives(u, v + h), surface.derivatives(u, v - h)
    d = surface.derivatives(u, v)
    pairs = [
        (d.xu, east.x - west.x),
        (d.xv, north.x - south.x),
        (d.xuu, east.xu - west.xu),
        (d.xuv, east.xv - west.xv),
        (d.xuv, north.xu - south.xu),
        (d.xvv, north.xv - south.xv),
    ]
    for exact, difference in pairs:
        size = np.abs(d.x).max() + np.abs(exact).max()
        np.testing.assert_allclose(difference / (2 * h), exact, rtol=0, atol=1e-8 * size)


@on_each(SURFACES)
def test_normal_is_unit_and_along_xu_cross_xv(surface: AnalyticSurface) -> None:
    u, v = sample(surface)
    d, n = surface.derivatives(u, v), surface.normal(u, v)
    np.testing.assert_allclose(np.linalg.norm(n, axis=1), 1.0, rtol=1e-14)
    for tangent in (d.xu, d.xv):
        np.testing.assert_allclose(
            dot(tangent, n) / np.linalg.norm(tangent, axis=1), 0.0, atol=1e-12
        )
    assert (dot(np.cross(d.xu, d.xv), n) > 0).all()


@on_each(SADDLES)
def test_second_form_vanishes_on_asymptotic_directions(surface: AnalyticSurface) -> None:
    u, v = sample(surface)
    d, n = surface.derivatives(u, v), surface.normal(u, v)
    curvature = np.abs(surface.principal_curvatures(u, v)).max(axis=1)
    for sign in (1.0, -1.0):
        tangent = (d.xu + sign * d.xv) / 2
        bend = dot((d.xuu + 2 * sign * d.xuv + d.xvv) / 4, n)
        normal_curvature = bend / dot(tangent, tangent)
        assert (np.abs(normal_curvature) < 1e-11 * curvature).all()


@on_each(SURFACES)
def test_gaussian_curvature_agrees_with_closed_form(surface: AnalyticSurface) -> None:
    u, v = sample(surface)
    expected = GAUSS[type(surface)](surface, u, v)
    np.testing.assert_allclose(surface.curvatures(u, v)[0], expected, rtol=1e-9)


@on_each(MINIMAL)
def test_minimal_surfaces_have_no_mean_curvature(surface: AnalyticSurface) -> None:
    k, h = surface.curvatures(*sample(surface))
    assert (np.abs(h) < 1e-12 * np.sqrt(-k)).all()


@on_each(SURFACES)
def test_principal_curvatures_belong_to_gauss_and_mean(surface: AnalyticSurface) -> None:
    u, v = sample(surface)
    (k, h), kappa = surface.curvatures(u, v), surface.principal_curvatures(u, v)
    assert (kappa[:, 0] <= kappa[:, 1]).all()
    np.testing.assert_allclose(kappa.prod(axis=1), k, rtol=1e-9)
    np.testing.assert_allclose(kappa.mean(axis=1), h, atol=1e-12 * np.abs(kappa).max())


def test_sphere_keeps_all_digits_of_its_curvature() -> None:
    sphere = Sphere(1200.0)
    kappa = sphere.principal_curvatures(*sample(sphere))
    np.testing.assert_allclose(kappa, -1 / 1200.0, rtol=1e-13)


def test_derivatives_accept_plain_numbers_and_lists() -> None:
    d = Hypar(2.0).derivatives([1, 2], 0)
    np.testing.assert_allclose(d.x, [[2, 2, 2], [4, 4, 8]])


def test_shapes_broadcast() -> None:
    surface = Catenoid(1.0)
    u, v = np.linspace(0, 1, 4)[:, None], np.linspace(0, 1, 5)
    assert surface.point(u, v).shape == (4, 5, 3)
    assert surface.point(0.0, 0.0).shape == (3,)
    assert surface.curvatures(u, v)[0].shape == (4, 5)
    assert surface.principal_curvatures(u, v).shape == (4, 5, 2)
    assert all(each.shape == (4, 5, 3) for each in surface.derivatives(u, v))


@on_each(SURFACES)
def test_asymptotic_point_halves_sum_and_difference(surface: AnalyticSurface) -> None:
    u, v = sample(surface)
    np.testing.assert_allclose(
        surface.asymptotic_point(u + v, u - v), surface.point(u, v), rtol=1e-12, atol=1e-9
    )


@on_each(REVOLVED)
def test_a_full_turn_closes(surface: AnalyticSurface) -> None:
    u, v = sample(surface)
    assert surface.period_u == 2 * math.pi
    np.testing.assert_allclose(
        surface.point(u + surface.period_u, v), surface.point(u, v), atol=1e-10 * 7000
    )


def test_other_surfaces_have_no_period() -> None:
    assert all(s.period_u is None for s in SURFACES if s not in REVOLVED)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_asymptotic_arc_length_of_the_catenoid(side: float) -> None:
    radius, v0, v1, constant = 700.0, -0.8, 1.7, 0.4
    catenoid = Catenoid(radius)

    def speed(v: float) -> float:
        d = catenoid.derivatives(constant - side * v, v)
        return float(np.linalg.norm(d.xv - side * d.xu))

    expected = radius * math.sqrt(2) * abs(math.sinh(v1) - math.sinh(v0))
    assert quad(speed, v0, v1, epsabs=1e-10)[0] == pytest.approx(expected, rel=1e-12)


@on_each([Hypar(2500.0), Hyperboloid(900.0, 1600.0)])
def test_rulings_are_straight(surface: AnalyticSurface) -> None:
    p = np.linspace(-1.0, 1.0, 9)
    for line in (surface.asymptotic_point(p, 0.3), surface.asymptotic_point(0.3, p)):
        chords = line[1:] - line[0]
        assert np.linalg.svd(chords, compute_uv=False)[1] < 1e-12 * surface.length_scale


def test_helicoid_has_straight_rulings_and_helices() -> None:
    helicoid, t = Helicoid(5000.0), np.linspace(-1.0, 1.0, 9)
    assert np.ptp(helicoid.asymptotic_point(t, 0.3)[:, 2]) < 1e-9
    helix = helicoid.asymptotic_point(0.7, t)
    radius = 5000.0 / (2 * math.pi) * math.sinh(0.7)
    np.testing.assert_allclose(np.hypot(helix[:, 0], helix[:, 1]), radius, rtol=1e-13)
    rise = helicoid.asymptotic_point(0.7, 2 * math.pi) - helicoid.asymptotic_point(0.7, 0.0)
    np.testing.assert_allclose(rise, (0.0, 0.0, 5000.0), atol=1e-9)


def test_points_satisfy_the_implicit_equations() -> None:
    x, y, z = Hypar(2500.0).point(*sample(Hypar(2500.0))).T
    np.testing.assert_allclose(z, x * y / 2500.0, atol=1e-9)
    x, y, z = Scherk(400.0).point(*sample(Scherk(400.0))).T
    np.testing.assert_allclose(z, 400.0 * np.log(np.cos(y / 400.0) / np.cos(x / 400.0)), atol=1e-9)
    x, y, z = Hyperboloid(900.0, 1600.0).point(*sample(Hyperboloid(900.0, 1600.0))).T
    np.testing.assert_allclose((x**2 + y**2) / 900.0**2 - z**2 / 1600.0**2, 1.0, atol=1e-11)


@pytest.mark.parametrize("torus", [Torus(3000.0, 800.0), Torus(1000.0, 950.0), Torus(1e4, 1.0)])
def test_torus_parameter_integrates_the_asymptotic_ratio(torus: Torus) -> None:
    v = np.linspace(-0.95, 0.95, 7) * torus.domain[1][1]
    x, y, z = torus.point(0.3, v).T
    psi = np.arctan2(-z, torus.major - np.hypot(x, y))

    def slowness(angle: float) -> float:
        cos = math.cos(angle)
        return math.sqrt(torus.minor / ((torus.major - torus.minor * cos) * cos))

    integrals = [quad(slowness, 0.0, angle, epsabs=1e-12)[0] for angle in psi]
    np.testing.assert_allclose(v, integrals, rtol=1e-9, atol=1e-12)


def test_torus_ends_at_the_parabolic_circle() -> None:
    torus = Torus(3000.0, 800.0)
    edge = torus.domain[1][1] / 0.95
    np.testing.assert_allclose(
        torus.derivatives(0.0, [-edge, edge]).x[:, [0, 2]],
        [[3000.0, 800.0], [3000.0, -800.0]],
        rtol=1e-12,
    )


def displaced(surface: AnalyticSurface, share: float) -> tuple[Floats, Floats, Floats, Floats]:
    """Parameters, feet and points at up to *share* of the curvature radius off them."""
    u, v = sample(surface, seed=2)
    reach = share / np.abs(surface.principal_curvatures(u, v)).max(axis=1)
    reach = np.minimum(reach, share * surface.length_scale)
    offset = np.random.default_rng(3).uniform(-reach, reach)
    feet = surface.point(u, v)
    return u, v, feet, feet + offset[:, None] * surface.normal(u, v)


@on_each(SURFACES)
@pytest.mark.parametrize("share", [0.0, 0.2])
def test_closest_finds_the_foot_of_displaced_points(surface: AnalyticSurface, share: float) -> None:
    u, v, feet, points = displaced(surface, share)
    foot = surface.closest(points)
    size = np.abs(feet).max()
    np.testing.assert_allclose(foot.points, feet, rtol=0, atol=1e-11 * size)
    np.testing.assert_allclose(foot.normals, surface.normal(u, v), rtol=0, atol=1e-10)
    kappa = surface.principal_curvatures(u, v)
    np.testing.assert_allclose(foot.curvature, kappa, rtol=0, atol=1e-9 * np.abs(kappa).max())


@on_each(SURFACES)
@pytest.mark.parametrize("factor", [1e-6, 1e6])
def test_closest_does_not_depend_on_the_unit_of_length(
    surface: AnalyticSurface, factor: float
) -> None:
    keys = surface.__dataclass_fields__  # type: ignore[attr-defined]
    sizes = {key: factor * getattr(surface, key) for key in keys}
    scaled: AnalyticSurface = replace(surface, **sizes)  # type: ignore[type-var]
    points = displaced(surface, 0.2)[3]
    np.testing.assert_allclose(
        scaled.closest(factor * points).points / factor,
        surface.closest(points).points,
        rtol=0,
        atol=1e-11 * np.abs(points).max(),
    )


@pytest.mark.parametrize(
    ("surface", "u", "v"),
    [
        (Enneper(1300.0), 0.3, 1.45),
        (Catenoid(700.0), 0.4, 4.5),
        (Helicoid(5000.0), 40.0, -39.5),
        (Helicoid(5000.0), 2.5, 2.0),
        (Hypar(2500.0), 5.0, -0.2),
        (Hyperboloid(900.0, 1600.0), 2.0, 1.52),
        (Scherk(400.0), 0.3, 5.0),
    ],
    ids=str,
)
def test_closest_reaches_outside_the_domain(surface: AnalyticSurface, u: float, v: float) -> None:
    foot = surface.point(u, v)
    reach = 0.1 * min(surface.length_scale, 1 / np.abs(surface.principal_curvatures(u, v)).max())
    found = surface.closest((foot + reach * surface.normal(u, v))[None]).points[0]
    np.testing.assert_allclose(found, foot, atol=1e-11 * np.abs(foot).max())


@on_each(SADDLES)
def test_closest_beats_a_dense_sample(surface: AnalyticSurface) -> None:
    """Away from the surface too, no sampled point may be closer than the foot."""
    rng = np.random.default_rng(4)
    u, v = sample(surface, 60, seed=5)
    points = surface.point(0.5 * u, 0.5 * v)
    points = points + rng.normal(scale=0.2 * surface.length_scale, size=points.shape)
    distance = np.linalg.norm(surface.closest(points).points - points, axis=1)
    others = surface.point(*sample(surface, 20_000, seed=6))
    nearest = np.linalg.norm(points[:, None] - others, axis=-1).min(axis=1)
    assert (distance <= nearest * (1 + 1e-12)).all()


def test_closest_on_the_axis_of_a_catenoid_is_a_minimum() -> None:
    foot = Catenoid(700.0).closest(np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 200.0]]))
    assert np.hypot(*foot.points[0, :2]) == pytest.approx(700.0, rel=1e-12)
    height = foot.points[1, 2] / 700.0
    slope = math.cosh(height) * math.sinh(height) + height - 200.0 / 700.0
    assert abs(slope) < 1e-9


def test_closest_stays_finite_beyond_the_singular_edges() -> None:
    scherk = Scherk(400.0).closest(np.array([[4000.0, 0.0, 1e6], [0.0, -900.0, 0.0]]))
    assert np.abs(scherk.points[:, :2]).max() <= math.pi / 2 * 400.0
    corner = Scherk(400.0).closest(400.0 * np.array([[1.65, 1.65, 0.3]])).points[0]
    np.testing.assert_allclose(corner, 400.0 * np.array([math.pi / 2, math.pi / 2, 0.3]), atol=1e-4)
    assert np.isfinite(Hyperboloid(900.0, 1600.0).closest(np.array([[0.0, 0.0, 1e8]])).points).all()


def test_closest_covers_the_outer_half_of_the_torus() -> None:
    torus = Torus(3000.0, 800.0)
    foot = torus.closest(np.array([[0.0, 5000.0, 0.0], [3000.0, 0.0, 1.0], [-2000.0, 0.0, 0.0]]))
    expected = [[0.0, 3800.0, 0.0], [3000.0, 0.0, 800.0], [-2200.0, 0.0, 0.0]]
    np.testing.assert_allclose(foot.points, expected, atol=1e-9)
    np.testing.assert_allclose(foot.normals, [[0, 1, 0], [0, 0, 1], [1, 0, 0]], atol=1e-12)
    kappa = [[-1 / 800, -1 / 3800], [-1 / 800, 0.0], [-1 / 800, 1 / 2200]]
    np.testing.assert_allclose(foot.curvature, kappa, atol=1e-12)


def test_ties_have_a_documented_foot() -> None:
    torus = Torus(3000.0, 800.0).closest(np.array([[0.0, 0.0, 0.0], [0.0, 3000.0, 0.0]]))
    np.testing.assert_allclose(torus.points, [[2200.0, 0, 0], [0, 3800.0, 0]], atol=1e-9)
    sphere = Sphere(1200.0).closest(np.zeros((1, 3)))
    np.testing.assert_allclose(sphere.points, [[0, 0, 1200.0]])


@on_each(SURFACES)
def test_closest_answers_no_points(surface: AnalyticSurface) -> None:
    foot = surface.closest(np.empty((0, 3)))
    assert foot.points.shape == (0, 3)
    assert foot.curvature.shape == (0, 2)


@on_each(SURFACES)
def test_surfaces_are_surfaces_and_survive_pickling(surface: AnalyticSurface) -> None:
    assert isinstance(surface, Surface)
    points = displaced(surface, 0.1)[3][:5]
    before = surface.closest(points)
    copy = pickle.loads(pickle.dumps(surface))
    assert copy == surface
    np.testing.assert_array_equal(copy.closest(points).points, before.points)


@on_each(SADDLES)
def test_domain_is_hyperbolic_and_inside_the_limits(surface: AnalyticSurface) -> None:
    u, v = np.meshgrid(*(np.linspace(*each, 21) for each in surface.domain))
    surface.check(u, v)
    surface.require_hyperbolic(u, v)


def test_sphere_is_never_hyperbolic() -> None:
    with pytest.raises(NotHyperbolicError, match=r"Sphere.*point 0.*K = 6\.9\S*e-07.*Try: keep"):
        Sphere(1200.0).require_hyperbolic([0.1, 0.2], [0.3, 0.4])


def test_not_hyperbolic_names_the_worst_point() -> None:
    torus = Torus(3000.0, 800.0)
    edge = torus.domain[1][1] / 0.95 * (1 - 1e-13)
    with pytest.raises(NotHyperbolicError) as caught:
        torus.require_hyperbolic([[0.1, 0.2], [0.3, 0.4]], [[0.0, 0.1], [edge, 0.2]])
    assert caught.value.where is not None
    assert caught.value.where.startswith("point (1, 0), (u, v) = (0.3, ")
    assert "position (2866.01, 886.561, -800) mm" in caught.value.where


def test_hyperbolic_threshold_is_scale_free() -> None:
    for radius in (1e-6, 1.0, 1e9):
        Catenoid(radius).require_hyperbolic(0.0, 5.8)
        with pytest.raises(NotHyperbolicError, match="point 0"):
            Catenoid(radius).require_hyperbolic(0.0, 6.0)


@pytest.mark.parametrize(
    ("surface", "u", "v", "text"),
    [
        (Catenoid(1.0), 0.0, 101.0, r"cosh v leaves.*at v, point 0; found 101.*\|v\| < 100"),
        (Helicoid(1.0), 60.0, 60.0, r"sinh p leaves.*at u \+ v"),
        (Hyperboloid(1.0, 1.0), 0.0, -1.6, r"infinity.*found -1\.6"),
        (Scherk(1.0), 18.5, 0.0, r"x reaches the vertical edge.*at u"),
        (Scherk(1.0), 0.0, -20.0, r"y reaches the vertical edge.*at v"),
        (Torus(3.0, 1.0), 0.0, 1.7, r"parabolic circles.*shrink the range of v"),
        (Sphere(1.0), 0.0, math.pi / 2, r"pole.*at v"),
        (Enneper(1.0), math.nan, 0.0, r"not finite.*at u, point 0; found nan"),
        (Hypar(1.0), 0.0, math.inf, r"not finite.*at v, point 0; found inf"),
    ],
    ids=str,
)
def test_check_refuses_singular_parameters(
    surface: AnalyticSurface, u: float, v: float, text: str
) -> None:
    calls = (
        surface.check,
        surface.point,
        surface.normal,
        surface.curvatures,
        surface.principal_curvatures,
        surface.require_hyperbolic,
    )
    for call in calls:
        with pytest.raises(SettingError, match=text):
            call(u, v)


def test_asymptotic_point_refuses_singular_parameters() -> None:
    with pytest.raises(SettingError, match=r"infinity.*at v"):
        Hyperboloid(1.0, 1.0).asymptotic_point(2.0, -2.0)


def test_check_names_the_first_bad_index() -> None:
    with pytest.raises(SettingError, match=r"at v, point \(1, 2\)"):
        Hyperboloid(1.0, 1.0).check(np.zeros((2, 3)), [[0, 0, 0], [0, 1, 2]])


NOT_A_SIZE = st.floats(max_value=0.0) | st.sampled_from([math.nan, math.inf, -math.inf])


@given(value=NOT_A_SIZE)
def test_sizes_must_be_positive_and_finite(value: float) -> None:
    cases: list[tuple[str, Callable[[], AnalyticSurface]]] = [
        ("scale", lambda: Enneper(value)),
        ("radius", lambda: Catenoid(value)),
        ("pitch", lambda: Helicoid(value)),
        ("scale", lambda: Hypar(value)),
        ("radius", lambda: Hyperboloid(value, 1.0)),
        ("height", lambda: Hyperboloid(1.0, value)),
        ("scale", lambda: Scherk(value)),
        ("major", lambda: Torus(value, 1.0)),
        ("minor", lambda: Torus(1.0, value)),
        ("radius", lambda: Sphere(value)),
    ]
    for key, build in cases:
        with pytest.raises(SettingError) as caught:
            build()
        assert caught.value.where == key
        assert caught.value.value == f"{value} mm"


@given(st.floats(1.0, 1e6), st.floats(1.0, 10.0))
def test_torus_needs_a_hole(major: float, ratio: float) -> None:
    with pytest.raises(SettingError, match="at minor"):
        Torus(major, major * ratio)


def test_abstract_surfaces_cannot_be_built() -> None:
    for kind in (AnalyticSurface, RevolutionSurface):
        with pytest.raises(TypeError, match="abstract"):
            kind()  # type: ignore[abstract]


@pytest.mark.parametrize("points", [np.zeros(3), np.zeros((2, 2)), np.zeros((1, 2, 3))])
def test_positions_must_be_rows_of_three(points: Floats) -> None:
    for surface in SURFACES:
        with pytest.raises(InputError, match="rows of x, y, z"):
            surface.closest(points)


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_positions_must_be_finite(bad: float) -> None:
    points = np.zeros((4, 3))
    points[2, 1] = bad
    with pytest.raises(InputError, match="point 2"):
        checked_points(points)


def test_foot_freezes_its_arrays_and_checks_their_shapes() -> None:
    foot = Foot(np.zeros((2, 3)), np.ones((2, 3)), np.zeros((2, 2)))
    for array in (foot.points, foot.normals, foot.curvature):
        assert not array.flags.writeable
    for shapes in [((2, 3), (2, 3), (1, 2)), ((2, 3), (3, 3), (2, 2)), ((3,), (3, 3), (3, 2))]:
        with pytest.raises(InputError, match="do not belong together"):
            Foot(*(np.zeros(shape) for shape in shapes))
