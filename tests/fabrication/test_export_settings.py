"""Formats that cannot hold what a project builds are refused before anything is made."""

import pytest

import fabrication as fab
import gridshell as gs
from fabrication.errors import ProjectError
from fabrication.export_settings import require_export, require_formats_fit

STRIPS = {
    "name": "small",
    "surface": {"kind": "hypar", "scale": 6000.0},
    "patch": {"layout": "asymptotic", "p": (-0.2, 0.2), "q": (-0.2, 0.2), "lamellas": (3, 3)},
    "net": {"anchor": "free"},
    "profile": {"width": 100.0, "thickness": 2.5, "material": "stainless"},
    "joint": {"kind": "slot"},
    "sheet": {"length": 4000.0, "width": 350.0},
}
PANELS = {
    "name": "tower",
    "surface": {"kind": "catenoid", "radius": 2500.0},
    "patch": {"layout": "conjugate", "v": (-0.5, 0.5), "panels": (12, 6), "u": (0.0, 1.0)},
    "net": {"kind": "planar", "anchor": "free"},
    "panels": {"gap": 10.0, "thickness": 8.0, "material": "glass"},
    "sheet": {"length": 3000.0, "width": 1500.0},
}
SUPPORTS = {"below": -60.0, "above": 0.0, "thickness": 4.0, "material": "S235"}
TUBE = {"width": 40.0, "thickness": 14.0, "wall": 2.0, "material": "S235"}
SPRUCE = {"name": "spruce", "modulus": 11e3, "strength": 24.0, "density": 420.0}


def project(form, base=STRIPS, profile=None, **changes):
    content = {**base, "export": {"formats": ["obj", form]}, **changes}
    if profile is not None:
        content["profile"] = {**base["profile"], **profile}
    return fab.Project.model_validate(content)


@pytest.mark.parametrize(
    ("form", "profile"),
    [
        *(("nc1", {"material": name}) for name in ("S235", "S355", "stainless")),
        *(("btlx", {"material": name}) for name in ("birch-ply", "poplar-ply", SPRUCE)),
        ("nc1", {"material": {**SPRUCE, "name": "corten", "modulus": 210e3, "density": 7850.0}}),
        ("ifc", {"material": "GRP"}),
    ],
)
def test_steel_goes_with_nc1_and_timber_with_btlx(form, profile):
    require_formats_fit(project(form, profile=profile))


@pytest.mark.parametrize(
    ("form", "changes", "value"),
    [
        ("nc1", {"profile": {"material": "birch-ply"}}, "strips of birch-ply"),
        ("nc1", {"profile": {"material": SPRUCE}}, "strips of spruce"),
        ("nc1", {"profile": {"material": "GRP"}}, "strips of GRP"),
        ("nc1", {"profile": TUBE, "joint": {"kind": "hinged", "pin": 6.0}}, "a hollow section"),
        ("nc1", {"joint": {"kind": "reciprocal", "weld": 20.0}}, "bevelled ends"),
        ("btlx", {}, "strips of stainless"),
        ("btlx", {"profile": {"material": "GRP"}}, "strips of GRP"),
        ("btlx", {"base": PANELS}, "panels"),
        ("nc1", {"base": PANELS}, "glass"),
    ],
)
def test_what_a_format_cannot_hold_is_named(form, changes, value, tmp_path):
    asked = project(form, **changes)
    with pytest.raises(gs.SettingError) as info:
        require_formats_fit(asked)
    assert (info.value.where, info.value.value) == ("formats", value)
    assert form in info.value.advice
    with pytest.raises(ProjectError) as info:
        require_export(asked, tmp_path / "p.toml")
    assert info.value.where == f"{tmp_path / 'p.toml'}, export.formats"
    with pytest.raises(gs.SettingError) as info:
        fab.run(asked, tmp_path / "out", folder=tmp_path)
    assert info.value.where == "export.formats"
    assert not (tmp_path / "out").exists()


def test_square_ends_and_steel_plates_beside_glass_go_with_nc1():
    square = {"kind": "reciprocal", "weld": 20.0, "square_ends": True}
    require_formats_fit(project("nc1", joint=square))
    require_formats_fit(project("nc1", base=PANELS, supports=SUPPORTS))


def test_nothing_is_asked_of_projects_without_exports():
    require_formats_fit(fab.Project.model_validate(STRIPS))
