"""What is said of a mesh that is not quite as it was asked for."""

from types import SimpleNamespace

import numpy as np
import pytest

from gridshell.mesh import QuadMesh, grid_quads
from gridshell.remesh.findings import findings
from gridshell.remesh.remesh_report import Spread
from gridshell.surface import TriangleMesh

GOOD = Spread(0.1, 0.3, 2.0)


def said(
    *,
    stray=GOOD,
    lam=100.0,
    infeasible=0.0,
    control=10,
    cones=(),
    folded=(),
    dent=0.0,
    valences=(),
):
    points = np.stack([*np.meshgrid([0.0, 1.0, 2.0], [0.0, 1.0, 2.0], indexing="ij")], axis=-1)
    points = np.concatenate([points.reshape(-1, 2), np.zeros((9, 1))], axis=1)
    points[8, :2] -= dent
    mesh = QuadMesh(points, grid_quads(2, 2))
    triangles = TriangleMesh(points[:4], np.array([[0, 3, 1], [0, 2, 3]]))
    chart = SimpleNamespace(
        lam=lam,
        mesh=triangles,
        cones=np.array(cones, dtype=np.int64),
        folded=np.array(folded, dtype=np.int64),
    )
    about = SimpleNamespace(
        infeasible_area=infeasible,
        worst=points[3] if infeasible else None,
        angles=np.radians([40, 50, 60, 70, 80.0]),
        valences=np.array(valences, dtype=np.int64),
        positions=points[: len(valences)],
    )
    found = findings(mesh, chart, about, stray, control, np.array([1], dtype=np.int64))
    return {remark.code: remark for remark in found}


def test_of_a_good_mesh_nothing_is_said():
    assert said() == {}


def test_directions_that_cannot_be_followed():
    assert set(said(lam=10.0)) == {"not-integrable"}
    found = said(stray=Spread(2.0, 5.5, 30.0))["not-integrable"]
    assert found.value == 5.5
    assert "2.0 degrees on average, 5.5" in found.message
    assert "try" in found.message


@pytest.mark.parametrize(("share", "effect"), [(0.2, False), (1.0, True)])
def test_an_angle_the_surface_does_not_have(share, effect):
    found = said(infeasible=share)["angle-infeasible"]
    assert "40.0 to 80.0 degrees" in found.message
    assert ("no effect" in found.message) == effect
    assert found.value == share
    assert found.where == "(1, 0, 0) mm"


def test_holes_of_the_control_mesh():
    assert said(valences=(6, 8)) == {}
    found = said(valences=(6, 2))["umbilic-hole"]
    assert found.value == 1.0
    assert found.where == "(0, 1, 0) mm"


def test_a_mesh_too_coarse_for_a_control_mesh():
    assert set(said(control=0)) == {"too-coarse"}


@pytest.mark.parametrize("fault", [{"cones": (1,)}, {"folded": (0,)}])
def test_a_singular_point_that_is_lost(fault):
    found = said(**fault)["singular-point-lost"]
    assert found.where == "(0, 1, 0) mm"
    assert "1 of 1" in found.message


def test_faults_elsewhere_lose_no_singular_point():
    assert said(cones=(2,), folded=(1,)) == {}


def test_concave_quads():
    found = said(dent=0.8)["concave-quads"]
    assert found.value == 1.0
    assert found.where is not None
