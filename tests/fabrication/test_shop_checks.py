from dataclasses import replace

import numpy as np
import pytest

import fabrication as fab
from fabrication.cut import Edge, Floor, Hole, Relief, Slot, outline
from fabrication.finding import Severity
from fabrication.shop import Cutting, Process, preset
from fabrication.shop_checks import shop_findings
from fabrication.unroll import Development

LASER = preset(Cutting.LASER, 2.5)
DOGBONE = Relief(Floor.DOGBONE, 3.0)


def strip(*, width=12.0, relief=DOGBONE, gap=100.0, holes=((50.0, 50.0, 9.0),), bevels=(0.0, 0.0)):
    slots = tuple(
        Slot(200.0 + k * (gap + width), width, 50.0, Edge.LOWER, f"N{k}", f"B{k}", relief)
        for k in range(2)
    )
    return fab.FlatPart(
        "A1",
        outline(600.0, 100.0, slots),
        slots,
        (),
        100.0,
        2.5,
        Development(600.0, np.zeros(0), 0.0, 0.0),
        tuple(Hole(x, y, d, "N0", "bolt") for x, y, d in holes),
        bevels,
    )


def one(part, process):
    (finding,) = shop_findings([part], process)
    return finding


def test_a_sound_part_has_no_finding():
    for process in (LASER, preset(Cutting.ROUTER, 2.5), preset(Cutting.SAW, 2.5), Process()):
        assert shop_findings([strip()], process) == ()


def test_a_slot_the_tool_does_not_fit_into():
    router = replace(preset(Cutting.ROUTER, 2.5), relief=Relief())
    found = one(strip(width=5.0, relief=Relief()), router)
    assert (found.code, found.value, found.limit) == ("shop-slot", 5.0, 6.0)
    assert "1.00 mm more clearance" in found.message


@pytest.mark.parametrize("relief", [Relief(), Relief(Floor.DOGBONE, 2.0)])
def test_corners_a_round_tool_leaves(relief):
    found = one(strip(relief=relief), preset(Cutting.ROUTER, 2.5))
    assert (found.code, found.limit, found.severity) == ("shop-relief", 3.0, Severity.WARNING)


def test_a_round_floor_as_wide_as_the_tool_is_sound():
    assert shop_findings([strip(relief=Relief(Floor.ROUND))], preset(Cutting.ROUTER, 2.5)) == ()


def test_dogbones_that_meet_are_told():
    found = one(strip(width=8.0), preset(Cutting.ROUTER, 2.5))
    assert (found.code, found.severity) == ("shop-reliefs-meet", Severity.INFO)
    assert found.limit == pytest.approx(2.0 * np.sqrt(2.0) * 3.0)


def test_a_web_between_the_thickness_and_what_the_shop_wants():
    found = one(strip(relief=Relief(), gap=4.0), replace(LASER, min_web=5.0))
    assert (found.code, found.value, found.limit) == ("shop-web", pytest.approx(4.0), 5.0)


def test_a_web_below_the_thickness_is_left_to_the_other_checks():
    assert shop_findings([strip(relief=Relief(), gap=2.0)], LASER) == ()


def test_a_hole_too_small():
    found = one(strip(holes=[(50.0, 50.0, 2.0)]), LASER)
    assert (found.code, found.value, found.limit) == ("shop-hole", 2.0, 2.5)


@pytest.mark.parametrize(
    ("holes", "web"),
    [
        ([(50.0, 94.0, 9.0)], 1.5),
        ([(190.0, 30.0, 6.0)], 1.0),
        ([(50.0, 50.0, 9.0), (61.0, 50.0, 9.0)], 2.0),
    ],
    ids=["edge", "slot", "hole"],
)
def test_a_hole_too_near_to_another_cut(holes, web):
    found = one(strip(relief=Relief(), holes=holes), LASER)
    assert (found.code, found.limit) == ("shop-edge", 2.5)
    assert found.value == pytest.approx(web, abs=1e-6)


def test_a_bevel_is_ground_after_a_laser_and_cut_by_a_waterjet():
    part = strip(bevels=(0.0, -2.5))
    found = one(part, LASER)
    assert (found.code, found.severity, found.unit) == ("shop-bevel", Severity.INFO, "deg")
    assert found.value == pytest.approx(45.0)
    assert shop_findings([part], preset(Cutting.WATERJET, 2.5)) == ()


def test_a_part_larger_than_the_machine_however_it_is_turned():
    assert shop_findings([strip()], replace(LASER, bed=(100.0, 600.0))) == ()
    found = one(strip(), replace(LASER, bed=(1500.0, 90.0)))
    assert (found.code, found.value, found.limit) == ("shop-bed", 100.0, 90.0)


def test_panels_and_plates_are_looked_at_too(tower):
    pieces = [fab.panel_piece(panel) for panel in tower.panels]
    found = shop_findings(pieces, replace(LASER, bed=(300.0, 300.0)))
    assert {finding.code for finding in found} == {"shop-bed"}
