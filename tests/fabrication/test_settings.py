from pathlib import Path

import pytest

import fabrication as fab
import gridshell as gs
from fabrication.errors import ProjectError
from fabrication.settings import patch_of, profile_of, require_makeable, surface_of

HYPAR = {
    "name": "hypar",
    "surface": {"kind": "hypar", "scale": 6000.0},
    "patch": {"layout": "asymptotic", "p": (-0.6, 0.6), "q": (-0.6, 0.6), "lamellas": (9, 9)},
    "net": {"anchor": "free"},
    "profile": {"width": 80.0, "thickness": 2.0, "material": "S235"},
    "joint": {"kind": "slot"},
    "sheet": {"length": 8000.0, "width": 1500.0},
}
RING = {"layout": "bisecting", "v": (-0.5, 0.5), "cells": 24}
OPEN = {**RING, "u": (0.0, 1.0)}
CATENOID = {"kind": "catenoid", "radius": 4000.0}


def project(**sections):
    """HYPAR with some keys of its sections changed; a section with a kind is another one."""
    merged = {**HYPAR}
    for name, section in sections.items():
        whole = section is None or "kind" in section or "layout" in section or name == "mesh"
        merged[name] = section if whole else {**HYPAR[name], **section}
    return fab.Project.model_validate(merged)


@pytest.fixture
def refused(tmp_path):
    """The error of a project that cannot be made."""

    def build(**sections):
        with pytest.raises(ProjectError) as info:
            require_makeable(project(**sections), tmp_path / "roof.toml")
        where = info.value.where
        assert where.startswith(f"{tmp_path / 'roof.toml'}, ")
        return info.value, where.split("roof.toml, ")[1]

    return build


# ---- what sections stand for ----------------------------------------------------------------


def test_a_surface_has_its_sizes():
    assert surface_of(project().surface) == gs.Hypar(6000.0)
    torus = {"kind": "torus", "major": 3.0, "minor": 1.0}
    assert surface_of(project(surface=torus).surface) == gs.Torus(3.0, 1.0)


@pytest.mark.parametrize(
    ("section", "patch"),
    [
        (HYPAR["patch"], gs.AsymptoticPatch((-0.6, 0.6), (-0.6, 0.6), (9, 9))),
        (RING, gs.BisectingPatch((-0.5, 0.5), 24)),
        (OPEN, gs.BisectingPatch((-0.5, 0.5), 24, (0.0, 1.0))),
    ],
)
def test_a_patch_has_its_layout(section, patch):
    assert patch_of(project(patch=section).patch) == patch


def test_a_profile_has_a_known_material_or_its_own():
    assert profile_of(project().profile) == fab.Profile(80.0, 2.0, fab.S235)
    own = {"name": "corten", "modulus": 210e3, "strength": 355.0, "density": 7850.0}
    assert profile_of(project(profile={"material": own}).profile).material == fab.Material(**own)


# ---- what is refused ------------------------------------------------------------------------

WRONG = {
    "patch.p": {"patch": {"p": (0.6, -0.6)}},
    "patch.q": {"patch": {"q": (0.6, 0.6)}},
    "patch.v": {"patch": {**OPEN, "v": (1.0, 0.0)}},
    "patch.u": {"patch": {**OPEN, "u": (1.0, 0.0)}},
    "patch.cells": {"surface": CATENOID, "patch": {**RING, "cells": 25}},
    "profile.thickness": {"profile": {"thickness": 30.0}},
    "profile.width": {"profile": {"width": 1490.0}},
    "joint.depth_clearance": {"joint": {"kind": "slot", "depth_clearance": 40.0}},
    "sheet.margin": {"sheet": {"margin": 750.0}},
    "surface.minor": {"surface": {"kind": "torus", "major": 1.0, "minor": 2.0}},
}


@pytest.mark.parametrize("key", WRONG)
def test_settings_that_do_not_go_together_are_named_with_their_section(refused, key):
    error, where = refused(**WRONG[key])
    assert where == key
    assert error.value


def test_a_ring_of_an_open_surface_is_refused(refused):
    error, where = refused(patch=RING)
    assert (where, error.value) == ("patch.u", "Hypar")


def test_a_sphere_has_no_asymptotic_net(refused):
    error, where = refused(surface={"kind": "sphere", "radius": 5000.0}, patch=OPEN)
    assert "Gaussian curvature" in error.what
    assert where.startswith("patch: ")


def test_a_patch_beyond_the_formula_is_refused(refused):
    scherk = {"kind": "scherk", "scale": 1000.0}
    error, where = refused(surface=scherk, patch={"p": (-40.0, 40.0)})
    assert "edge of the tile" in error.what
    assert where.startswith("patch: u")


def test_a_patch_of_ten_kilometres_is_refused(refused):
    error, where = refused(surface={"kind": "enneper", "scale": 1e6}, patch={"p": (-6.0, 6.0)})
    assert (error.what, where) == ("The patch is too large", "patch")


def test_a_mesh_that_is_not_there_is_refused(refused, tmp_path):
    mesh = {"file": "roof.obj", "unit": "m", "lamellas_along": "edges"}
    error, where = refused(mesh=mesh, surface=None, patch=None)
    assert (where, error.value) == ("mesh.file", str(tmp_path / "roof.obj"))


@pytest.mark.parametrize("name", ["roof.obj", "roof.json"])
def test_a_mesh_whose_file_states_no_unit_needs_one(refused, name, tmp_path):
    (tmp_path / name).write_text("")
    mesh = {"file": name, "lamellas_along": "edges"}
    error, where = refused(mesh=mesh, surface=None, patch=None)
    assert (where, error.what) == ("mesh.unit", "A key is missing")


def test_a_mesh_of_an_unknown_kind_is_refused(refused, tmp_path):
    (tmp_path / "roof.skp").write_text("")
    mesh = {"file": "roof.skp", "unit": "m", "lamellas_along": "edges"}
    error, where = refused(mesh=mesh, surface=None, patch=None)
    assert (where, error.value) == ("mesh.file", "'.skp'")


@pytest.mark.parametrize(
    ("sections", "key"),
    [
        ({"patch": {"lamellas": (3000, 3000)}}, "patch.lamellas"),
        ({"patch": {"lamellas": (2, 60_000)}}, "patch.lamellas"),
        ({"patch": {**OPEN, "cells": 1000}}, "patch.cells"),
        ({"patch": {**OPEN, "cells": 10, "u": (0.0, 1e-6)}}, "patch.cells"),
        ({"surface": CATENOID, "patch": {**RING, "cells": 2000}}, "patch.cells"),
    ],
)
def test_a_net_of_too_many_nodes_is_refused(refused, sections, key):
    error, where = refused(**sections)
    assert (error.what, where) == ("The net has too many nodes", key)


@pytest.mark.parametrize("patch", [RING, OPEN, {**HYPAR["patch"], "lamellas": (9, 20)}])
@pytest.mark.parametrize(("share", "accepted"), [(0.9, False), (1.1, True)])
def test_the_nodes_are_counted_as_they_are_made(refused, monkeypatch, patch, share, accepted):
    asked = project(surface=CATENOID, patch=patch)
    made = gs.control_patch(surface_of(asked.surface), patch_of(asked.patch))
    nodes = len(gs.diagonal_meshes(made)[0].vertices)
    monkeypatch.setattr("fabrication.settings.MOST_NODES", share * nodes)
    if accepted:
        require_makeable(asked, Path("roof.toml"))
    else:
        refused(surface=CATENOID, patch=patch)


def test_a_torus_is_left_to_the_run():
    torus = {"kind": "torus", "major": 3000.0, "minor": 1000.0}
    require_makeable(project(surface=torus, patch={"p": (-9.0, 9.0)}), Path("roof.toml"))
