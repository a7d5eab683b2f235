import numpy as np
import pytest
from shapely.affinity import rotate
from shapely.geometry import Point, Polygon, box
from shapely.ops import unary_union

import fabrication as fab
from fabrication.panel_structure import (
    PanelSystem,
    connector_mass,
    connector_span,
    panel_structure,
    section_area,
)


def test_there_is_a_part_for_every_face_edge_and_node(tower):
    mesh = tower.mesh
    assert len(tower.panels) == len(mesh.faces) == 24
    assert len(tower.plates) == len(mesh.edges) == 56
    assert len(tower.connectors) == len(mesh.vertices) == 32


def test_a_net_of_panels_alone_has_nothing_else(tower):
    built = panel_structure(tower.mesh, PanelSystem(panels=tower.system.panels))
    assert built.plates == built.connectors == built.classical_plates == ()
    assert built.findings() == []
    assert connector_span(built.system) == (0.0, 0.0)


def test_parts_of_a_storey_are_equal(tower):
    assert [len(group.members) for group in tower.panel_groups] == [8, 8, 8]
    assert sum(len(group.members) for group in tower.plate_groups) == 56
    assert len(tower.plate_groups) <= 7


def test_connectors_stand_half_way_up_the_plates(tower):
    assert connector_span(tower.system) == (-110.0, -20.0)


def test_the_section_s_area_is_that_of_the_disc_without_its_slots(tower):
    connector = tower.connectors[5]
    spec = connector.spec
    disc = Point(0, 0).buffer(spec.radius, quad_segs=2000)
    half = spec.slot_width / 2.0
    slots = [
        rotate(box(spec.floor, -half, 99.0, half), np.degrees(a), origin=(0, 0))
        for a in connector.slot_angles
    ]
    assert section_area(connector) == pytest.approx((disc - unary_union(slots)).area, rel=1e-5)
    assert isinstance(disc, Polygon)


def test_a_connector_weighs_its_volume(tower):
    connector = tower.connectors[0]
    expected = section_area(connector) * 90.0 * 7900e-9
    assert connector_mass(connector, fab.STAINLESS) == pytest.approx(expected)


def test_plates_at_90_degrees_are_flat_and_at_70_they_are_findings(tower, leaning):
    assert tower.findings() == []
    assert {f.code for f in leaning.findings()} == {"support-twist"}
    assert len(leaning.findings()) == len(leaning.plates)
