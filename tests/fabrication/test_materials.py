from math import sqrt
from typing import get_args

import numpy as np
import pytest

import fabrication as fab
import gridshell as gs
from fabrication.materials import MATERIALS, Material
from fabrication.section_types import SheetName


@pytest.mark.parametrize(
    "key", ["modulus", "strength", "density", "shear_modulus", "shear_strength"]
)
@pytest.mark.parametrize("value", [0.0, -1.0, np.nan, np.inf])
def test_a_material_needs_positive_numbers(key, value):
    numbers = {"modulus": 210e3, "strength": 235.0, "density": 7850.0, key: value}
    with pytest.raises(gs.SettingError, match="must be positive") as info:
        fab.Material("steel", **numbers)
    assert info.value.where == key


def test_materials_are_found_by_the_name_they_carry():
    assert all(name == material.name for name, material in MATERIALS.items())
    assert {fab.S235, fab.STAINLESS, fab.GRP} < set(MATERIALS.values())


def test_a_project_may_name_every_material():
    assert {*get_args(SheetName), "glass"} == set(MATERIALS)


def test_a_metal_without_a_shear_modulus_is_isotropic():
    assert fab.S235.rigidity == pytest.approx(210e3 / (2.0 * (1.0 + 0.3)))
    assert fab.S235.shear_limit == pytest.approx(235.0 / sqrt(3.0))


def test_wood_has_its_own_shear_values():
    assert fab.BIRCH_PLY.rigidity == 620.0 < fab.BIRCH_PLY.modulus / 10.0
    assert fab.BIRCH_PLY.shear_limit == 9.0


@pytest.mark.parametrize(
    ("material", "thickness", "metres"),
    [(fab.S235, 1.5, 0.67), (fab.STAINLESS, 2.5, 1.14), (fab.BIRCH_PLY, 4.0, 0.50)],
)
def test_known_strips_bend_as_tightly_as_shops_say(material, thickness, metres):
    radius = material.modulus * thickness / (2.0 * material.strength)
    assert radius / 1e3 == pytest.approx(metres, abs=0.005)


def test_steel_and_timber_are_told_by_their_numbers():
    steel = {name for name, material in MATERIALS.items() if material.is_steel}
    timber = {name for name, material in MATERIALS.items() if material.is_timber}
    assert steel == {"S235", "S355", "stainless"}
    assert timber == {"birch-ply", "poplar-ply"}
    assert Material("corten", 210e3, 355.0, 7850.0).is_steel
    assert Material("spruce", 11e3, 24.0, 420.0).is_timber
    for other in (Material("titanium", 110e3, 800.0, 4430.0), Material("PE", 1e3, 20.0, 950.0)):
        assert not other.is_steel
        assert not other.is_timber
