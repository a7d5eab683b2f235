"""Conjugate pairs against eqs. 1-3 in all three cases of K."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gridshell.arrays import Floats
from gridshell.errors import AngleInfeasibleError, SettingError
from gridshell.field import (
    FrameField,
    Hand,
    Infeasible,
    asymptotic_field,
    conjugate_field,
    principal_field,
    singularities,
)
from gridshell.surface import Catenoid, CurvedMesh, Enneper

HANDS = pytest.mark.parametrize("hand", list(Hand))
ANGLES = st.floats(0.05, math.pi - 0.05)
Forms = Callable[[Floats], CurvedMesh]


def second_form(curved: CurvedMesh, one: Floats, two: Floats) -> Floats:
    """II(t1, t2) over the norm of II, for angles (f,)."""
    a, b, c = curved.face_shapes.T
    mixed = a * np.cos(one) * np.cos(two) + b * np.sin(one + two) + c * np.sin(one) * np.sin(two)
    return np.asarray(np.abs(mixed) / np.sqrt(a * a + 2.0 * b * b + c * c))


def residual(curved: CurvedMesh, field: FrameField) -> Floats:
    return second_form(curved, field.first, field.second)


def random_forms(seed: int, kind: str) -> Floats:
    """(512, 3) forms with K < 0, K = 0 or K > 0, none umbilic, in random frames."""
    rng = np.random.default_rng(seed)
    low = {
        "hyperbolic": lambda: -rng.uniform(0.05, 3.0, 512),
        "parabolic": lambda: np.zeros(512),
        "elliptic": lambda: rng.uniform(0.05, 0.7, 512),
    }[kind]()
    high = rng.uniform(1.0, 3.0, 512)
    sign = rng.choice([-1.0, 1.0], 512)
    turn = rng.uniform(0.0, 2.0 * math.pi, 512)
    mean, half = sign * (low + high) / 2.0, (high - low) / 2.0
    return np.stack(
        [mean - half * np.cos(turn), -half * np.sin(turn), mean + half * np.cos(turn)], axis=1
    )


@HANDS
@pytest.mark.parametrize("kind", ["hyperbolic", "parabolic", "elliptic"])
@given(angle=ANGLES, seed=st.integers(0, 10_000))
def test_directions_are_conjugate_at_the_angle(
    with_forms: Forms, kind: str, hand: Hand, angle: float, seed: int
) -> None:
    curved = with_forms(random_forms(seed, kind))
    field = conjugate_field(curved, angle, hand=hand)
    assert residual(curved, field).max() < 1e-12
    np.testing.assert_allclose(field.angle[~field.infeasible], angle, atol=1e-14)
    if kind != "elliptic":
        assert field.infeasible.mean() < 1e-2


@given(angle=ANGLES, seed=st.integers(0, 10_000))
def test_both_hands_mirror_each_other_in_the_principal_directions(
    with_forms: Forms, angle: float, seed: int
) -> None:
    curved = with_forms(random_forms(seed, "hyperbolic"))
    axis = principal_field(curved).first
    right = conjugate_field(curved, angle, hand=Hand.RIGHT)
    left = conjugate_field(curved, angle, hand=Hand.LEFT)
    np.testing.assert_allclose(right.first - axis, axis - left.second, atol=1e-12)
    np.testing.assert_allclose(right.second - axis, axis - left.first, atol=1e-12)


@given(angle=st.floats(0.2, 1.5), seed=st.integers(0, 10_000))
def test_widened_pairs_are_the_characteristic_directions(
    with_forms: Forms, angle: float, seed: int
) -> None:
    curved = with_forms(random_forms(seed, "elliptic"))
    field = conjugate_field(curved, angle)
    a, b, c = curved.face_shapes[field.infeasible].T
    mean, half = (a + c) / 2.0, np.hypot((a - c) / 2.0, b)
    k1, k2 = np.abs(mean) - half, np.abs(mean) + half
    np.testing.assert_allclose(
        np.tan(field.angle[field.infeasible] / 2.0), np.sqrt(k1 / k2), rtol=1e-7
    )
    assert (field.angle >= angle - 1e-12).all()
    supplement = conjugate_field(curved, math.pi - angle)
    np.testing.assert_allclose(supplement.angle, math.pi - field.angle, atol=1e-12)


@given(angle=st.floats(0.2, 1.5), seed=st.integers(0, 10_000))
def test_clamped_pairs_keep_the_angle_and_are_as_conjugate_as_they_can_be(
    with_forms: Forms, angle: float, seed: int
) -> None:
    curved = with_forms(random_forms(seed, "elliptic"))
    field = conjugate_field(curved, angle, where_infeasible=Infeasible.CLAMP)
    np.testing.assert_allclose(field.angle, angle, atol=1e-14)
    best = residual(curved, field)
    for turn in np.linspace(0.0, math.pi, 40):
        other = second_form(curved, field.first + turn, field.second + turn)
        assert (best <= other + 1e-12).all()


@pytest.mark.parametrize("policy", [Infeasible.WIDEN, Infeasible.CLAMP])
@HANDS
def test_pairs_are_continuous_through_parabolic_and_infeasible_points(
    with_forms: Forms, hand: Hand, policy: Infeasible
) -> None:
    k1 = np.linspace(-1.0, 0.8, 512)
    curved = with_forms(np.stack([k1, 0.0 * k1, 0.0 * k1 + 1.0], axis=1))
    field = conjugate_field(curved, 1.0, hand=hand, where_infeasible=policy)
    assert field.infeasible.any()
    assert not field.infeasible.all()
    first, second = (np.unwrap(x, period=math.pi) for x in (field.first, field.second))
    for angles in (first, second):
        # the root at the edge of what is feasible makes steps of sqrt(2 * 0.0035 * slope)
        assert np.abs(np.diff(angles)).max() < 0.12
    assert np.abs(np.diff(first))[np.abs(k1[1:]) < 0.1].max() < 0.01


@HANDS
def test_right_angle_is_principal_even_at_umbilics(with_forms: Forms, hand: Hand) -> None:
    forms = random_forms(3, "elliptic")
    forms[::50] = [1.0, 0.0, 1.0]
    curved = with_forms(forms)
    field = conjugate_field(curved, math.pi / 2.0, hand=hand, where_infeasible=Infeasible.REFUSE)
    assert residual(curved, field).max() < 1e-12
    principal = principal_field(curved)
    one, two = (field.first, field.second) if hand is Hand.RIGHT else (field.second, field.first)
    np.testing.assert_allclose(np.sin(one - principal.first), 0.0, atol=1e-12)
    np.testing.assert_allclose(np.sin(two - principal.second), 0.0, atol=1e-12)


@given(angle=ANGLES)
def test_umbilics_open_to_a_right_angle(with_forms: Forms, angle: float) -> None:
    forms = random_forms(3, "elliptic")
    forms[::50] = [-1.0, 0.0, -1.0]
    field = conjugate_field(with_forms(forms), angle)
    np.testing.assert_allclose(field.angle[: len(forms) : 50], math.pi / 2.0, atol=1e-12)


@HANDS
@pytest.mark.parametrize("angle", [0.4, 1.0, 2.0])
def test_turning_the_surface_over_swaps_the_families(
    on_ellipsoid: Callable[..., CurvedMesh],
    turned_over: Callable[[CurvedMesh], CurvedMesh],
    hand: Hand,
    angle: float,
) -> None:
    curved = on_ellipsoid((3.0, 2.0, 1.5), 3)
    field = conjugate_field(curved, angle, hand=hand)
    over = conjugate_field(turned_over(curved), angle, hand=hand)
    pairs = [
        (field.first_directions, over.second_directions),
        (field.second_directions, over.first_directions),
    ]
    for one, two in pairs:
        np.testing.assert_allclose(np.abs(np.einsum("fc,fc->f", one, two)), 1.0, atol=1e-9)


@HANDS
def test_small_angles_tend_to_the_asymptotic_line_of_that_hand(
    on_grid: Callable[..., CurvedMesh], hand: Hand
) -> None:
    curved = on_grid(Enneper(1.0), ((-0.7, 0.7), (-0.7, 0.7)))
    field = conjugate_field(curved, 1e-3, hand=hand)
    lines = asymptotic_field(curved)
    line = lines.second if hand is Hand.RIGHT else lines.first
    np.testing.assert_allclose(np.sin(field.bisector - line), 0.0, atol=1e-5)


@HANDS
def test_catenoid_carries_every_angle_without_singularities(
    on_grid: Callable[..., CurvedMesh], hand: Hand
) -> None:
    box = ((0.0, Catenoid(1.0).period_u), (-1.0, 1.0))
    curved = on_grid(Catenoid(1.0), box, (60, 20), (True, False))
    for angle in (0.3, 1.0, 2.5):
        field = conjugate_field(curved, angle, hand=hand, where_infeasible=Infeasible.REFUSE)
        np.testing.assert_allclose(field.angle, angle, atol=1e-14)
        assert len(singularities(field).vertices) == 0


def test_an_angle_the_surface_does_not_have_is_refused(
    on_ellipsoid: Callable[..., CurvedMesh],
) -> None:
    curved = on_ellipsoid((3.0, 2.0, 1.5), 3)
    with pytest.raises(AngleInfeasibleError, match="100 % of the area"):
        conjugate_field(curved, 0.5, where_infeasible=Infeasible.REFUSE)
    with pytest.raises(AngleInfeasibleError, match=r"5\.17 % of the area .* 87\.3 for all"):
        conjugate_field(curved, 1.4, where_infeasible=Infeasible.REFUSE)


@pytest.mark.parametrize("angle", [0.0, math.pi, -1.0, math.nan])
def test_an_angle_outside_half_a_turn_is_refused(with_forms: Forms, angle: float) -> None:
    with pytest.raises(SettingError, match="angle"):
        conjugate_field(with_forms(random_forms(1, "hyperbolic")), angle)
