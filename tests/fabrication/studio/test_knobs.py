import numpy as np
import pytest

from fabrication.project import project_of
from fabrication.studio.disk import read
from fabrication.studio.knobs import knobs
from fabrication.studio.versions import Version


def by_key(project):
    return {knob.key: knob for knob in knobs(project)}


@pytest.fixture
def version(path):
    return Version.of(read(path).document, path)


def test_angle_density_profile_and_weights_can_be_turned(version):
    found = by_key(version.project)
    assert list(found) == [
        *("net.angle", "patch.lamellas.0", "patch.lamellas.1"),
        *("profile.width", "profile.thickness", "net.fairness"),
    ]
    assert all(knob.low <= knob.value <= knob.high for knob in found.values())


def test_every_place_of_every_slider_is_a_project(version, path):
    for knob in knobs(version.project):
        for place in (knob.low, knob.value, knob.high):
            turned = version.with_value(knob.key, knob.chosen(place), path)
            assert turned.value(knob.key) == pytest.approx(knob.chosen(place))


def test_every_step_around_a_ring_is_a_ring(version, path):
    document = dict(version.document)
    document["surface"] = {"kind": "catenoid", "radius": 2000.0}
    document["patch"] = {"layout": "bisecting", "v": [-0.8, 0.8], "cells": 24}
    ring = Version.of(document, path)
    cells = by_key(ring.project)["patch.cells"]
    assert cells.label == "Control quads around"
    for place in np.arange(cells.low, cells.high + 1.0, cells.step):
        assert ring.with_value(cells.key, cells.chosen(place), path).value(cells.key) == place


def test_the_value_of_the_project_is_a_place_of_its_slider(version):
    for knob in knobs(version.project):
        if knob.key != "net.fairness":  # unset: the slider stands where recipes begin
            assert knob.chosen(knob.value) == pytest.approx(version.value(knob.key))


def test_weights_go_by_powers_of_ten(version):
    fairness = by_key(version.project)["net.fairness"]
    assert fairness.chosen(-2.0) == 0.01
    assert fairness.chosen(1.0) == 10.0
    assert fairness.place(0.001) == pytest.approx(-3.0)
    assert fairness.place(0.0) is None


def test_a_value_beyond_the_slider_has_no_place_on_it(version):
    angle = by_key(version.project)["net.angle"]
    assert angle.place(62.35) == 62.35
    assert angle.place(170.0) is None


def test_a_net_kept_to_its_surface_has_a_weight_for_that(version, path):
    kept = version.with_value("net.keep_to_surface", True, path)
    assert "net.proximity" in by_key(kept.project)


def test_edge_lengths_of_a_mesh_over_a_surface_wait_for_the_hand(path):
    (path.parent / "roof.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    document = read(path).document
    document["surface"] = {"file": "roof.obj", "unit": "mm"}
    del document["patch"]
    document["remesh"] = {"directions": "asymptotic", "edge": 250.0}
    edge = by_key(project_of(document, path))["remesh.edge"]
    assert (edge.value, edge.live, edge.unit) == (250.0, False, " mm")
