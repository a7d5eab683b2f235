import json

import numpy as np
import pytest

import gridshell as gs


@pytest.fixture(scope="module")
def net(enneper):
    return gs.optimize(enneper(10), gs.a_net(angle=np.radians(80.0)), anchor=gs.Free())


def test_an_asymptotic_net_has_the_figures_programs_rely_on(net):
    report = gs.net_report(net, gs.Planarity.DIAGONAL_STARS, seconds=1.23456)
    assert report["kind"] == "asymptotic"
    assert report["faces"] == len(net.control.quads)
    assert report["iterations"] == len(net.steps)
    assert report["seconds"] == 1.235
    assert set(report["angle_error_deg"]) == {"mean", "max"}
    assert set(report["star_planarity"]) == {"mean", "max"}
    assert set(report["edge_ratio"]) == {"min", "max"}
    assert "face_planarity" not in report
    assert report["verdict"] is None
    json.dumps(report, allow_nan=False)


def test_a_planar_net_has_face_planarity_instead(grid):
    control = gs.as_control_mesh(grid(4, 4, lambda x, y: 0.1 * x * x + 0.05 * y * y))
    found = gs.optimize(control, gs.pq_net(rhombus=True), anchor=gs.Free())
    report = gs.net_report(found, gs.Planarity.WHITE_FACES, seconds=0.0)
    assert report["kind"] == "planar"
    assert "star_planarity" not in report
    assert set(report["face_planarity"]) == {"mean", "max"}
    assert report["rhombus_error"]["max"] < 1e-8


def test_the_history_has_an_entry_per_step_with_every_term(net):
    entries = gs.history_report(net)
    assert [entry["step"] for entry in entries] == list(range(1, len(net.steps) + 1))
    assert set(entries[0]["energies"]) == {"star planarity", "node angle", "fairness"}
    assert sum(entries[0]["energies"].values()) == pytest.approx(entries[0]["energy"], rel=1e-12)
    json.dumps(entries, allow_nan=False)


def test_a_verdict_is_part_of_the_report(enneper):
    found = gs.optimize(enneper(10), gs.a_net(angle=np.radians(60.0), steps=1), anchor=gs.Free())
    report = gs.net_report(found, gs.Planarity.DIAGONAL_STARS, seconds=0.0)
    assert not report["converged"]
    assert report["verdict"]["message"] == found.verdict.message
    json.dumps(report, allow_nan=False)
