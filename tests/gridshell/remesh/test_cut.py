"""Surfaces cut open: signs agree off the cut, and what is left is a disk."""

import numpy as np
import pytest
from surfaces import CASES

from gridshell.field import asymptotic_field, cleaned, matching, principal_field, singularities
from gridshell.remesh.charts import _wedges
from gridshell.remesh.cut import cut_open

NAMES = ["enneper", "catenoid", "saddle with hole", "monkey", "schwarz p", "ellipsoid", "torus"]


def opened(name):
    curved = CASES[name].triangles(1500)
    make = principal_field if name in ("ellipsoid", "torus") else asymptotic_field
    field = cleaned(curved, make(curved), 100.0).field
    sign, rotation = matching(field)
    turns = singularities(field)
    half = np.zeros(len(field.mesh.vertices), dtype=bool)
    half[turns.vertices] = np.rint(2.0 * turns.indices) % 2 != 0
    return field.mesh, sign, half, cut_open(field.mesh, sign, rotation, half)


@pytest.mark.parametrize("name", NAMES)
def test_signs_agree_wherever_the_surface_is_not_cut(name):
    mesh, sign, _, cut = opened(name)
    inner = np.flatnonzero(mesh.twin >= 0)
    other = mesh.twin[inner]
    between = cut.signs[inner // 3] * sign[inner] * cut.signs[other // 3]
    assert (between == cut.flips[inner]).all()
    assert (cut.flips[inner][~cut.on_cut[inner]] == 1).all()
    assert (cut.on_cut[inner] == cut.on_cut[other]).all()
    assert not cut.on_cut[mesh.twin < 0].any()


@pytest.mark.parametrize("name", NAMES)
def test_what_is_left_is_a_disk(name):
    mesh, _, half, cut = opened(name)
    open_sides = np.count_nonzero(cut.on_cut | (mesh.twin < 0))
    edges = (len(mesh.twin) + open_sides) // 2
    corners = int(_wedges(mesh, cut).max()) + 1
    assert corners - edges + len(mesh.triangles) == 1
    reached = np.zeros(len(mesh.vertices), dtype=bool)
    reached[mesh.origin[cut.on_cut]] = True
    assert reached[half].all()


def test_a_disk_without_half_turns_is_not_cut_at_all():
    assert not opened("enneper")[3].on_cut.any()


def test_no_free_end_is_left_in_the_cut():
    for name in NAMES:
        mesh, _, half, cut = opened(name)
        degree = np.bincount(mesh.origin[cut.on_cut], minlength=len(mesh.vertices))
        ends = degree == 1
        assert (mesh.on_boundary | half)[ends].all()
