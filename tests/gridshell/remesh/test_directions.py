"""Frozen wishes make the fields of their names."""

import numpy as np
import pytest
from surfaces import CASES

from gridshell.errors import AngleInfeasibleError, OddValenceError
from gridshell.field import (
    Hand,
    Infeasible,
    asymptotic_field,
    conjugate_field,
    directions_field,
    principal_field,
)
from gridshell.remesh import Asymptotic, Conjugate, Given, Principal


@pytest.fixture(scope="module")
def curved():
    return CASES["enneper"].triangles(500)


def test_wishes_make_their_fields(curved):
    first = curved.mesh.corners[:, 1] - curved.mesh.corners[:, 0]
    pairs = [
        (Asymptotic(), asymptotic_field(curved)),
        (Principal(), principal_field(curved)),
        (Conjugate(1.1), conjugate_field(curved, 1.1)),
        (Conjugate(1.1, hand=Hand.LEFT), conjugate_field(curved, 1.1, hand=Hand.LEFT)),
    ]
    for wish, field in pairs:
        found = wish.field(curved)
        assert (found.first == field.first).all()
        assert (found.second == field.second).all()
    assert (Conjugate(1.1).field(curved).first != pairs[3][1].first).any()
    second = np.cross(curved.mesh.face_normals, first)
    with pytest.raises(OddValenceError):  # edges of triangles are no field
        Given(first, second).field(curved)


def test_given_directions_are_kept(curved):
    base = asymptotic_field(curved)
    found = Given(base.first_directions, base.second_directions).field(curved)
    same = directions_field(curved.mesh, base.first_directions, base.second_directions)
    assert (found.first == same.first).all()
    np.testing.assert_allclose(np.sin(found.angle), np.sin(base.angle), atol=1e-12)


def test_what_is_infeasible_is_as_wished():
    dome = CASES["dome"].triangles(500)
    with pytest.raises(AngleInfeasibleError):
        Conjugate(0.5, where_infeasible=Infeasible.REFUSE).field(dome)
    kept = Conjugate(0.5, where_infeasible=Infeasible.CLAMP).field(dome)
    np.testing.assert_allclose(kept.angle, 0.5)
    assert (Conjugate(0.5).field(dome).angle > 0.5).any()


def test_wishes_can_be_compared():
    assert Conjugate(1.1) == Conjugate(1.1)
    assert hash(Asymptotic()) == hash(Asymptotic())
