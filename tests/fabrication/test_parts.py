import numpy as np
import pytest

import fabrication as fab
import gridshell as gs
from fabrication.cut import Edge, area


@pytest.mark.parametrize("name", ["catenoid", "ring", "saddle"])
def test_there_is_one_part_per_lamella_in_the_same_order(name, request):
    design = request.getfixturevalue(name)
    marks = [lamella.mark for lamella in design.structure.lamellas]
    assert [part.mark for part in design.parts] == marks


def test_a_part_is_as_long_as_its_lamella_and_as_wide_as_its_profile(enneper, profile):
    for lamella, part in zip(enneper.structure.lamellas, enneper.parts, strict=True):
        assert part.length == lamella.length
        low, high = part.outline.min(axis=0), part.outline.max(axis=0)
        np.testing.assert_allclose([*low, *high], [0.0, 0.0, lamella.length, profile.width])
        assert (part.width, part.thickness) == (profile.width, profile.thickness)


def test_the_area_of_a_part_is_the_strip_less_its_slots(enneper):
    for part in enneper.parts:
        removed = sum(slot.width * slot.depth for slot in part.slots)
        assert part.area == pytest.approx(part.length * part.width - removed, rel=1e-12)
        assert part.area == area(part.outline)


def test_slots_come_in_order_along_the_strip(ring):
    for part in ring.parts:
        x = [slot.x for slot in part.slots]
        assert x == sorted(x)


def test_a_part_carries_its_own_mark_once_and_each_partner_at_its_slot(enneper):
    for part in enneper.parts:
        own, *partners = part.labels
        assert own.text == part.mark
        assert [label.text for label in partners] == [slot.partner for slot in part.slots]
        assert [label.x for label in partners] == [slot.x for slot in part.slots]


def test_partner_marks_are_engraved_in_the_uncut_half(enneper):
    for part in enneper.parts:
        for slot, label in zip(part.slots, part.labels[1:], strict=True):
            low, high = label.y - label.height / 2.0, label.y + label.height / 2.0
            if slot.edge is Edge.UPPER:
                assert 0.0 < low < high < part.width - slot.depth
            else:
                assert slot.depth < low < high < part.width


@pytest.mark.parametrize("name", ["enneper", "tube", "saddle"])
def test_the_own_mark_lies_between_two_slots(name, request):
    for part in request.getfixturevalue(name).parts:
        own = part.labels[0]
        assert 0.0 < own.x < part.length
        reach = own.height * len(own.text)
        assert all(abs(slot.x - own.x) > reach + slot.width for slot in part.slots)


def test_a_looser_joint_makes_lighter_parts(enneper):
    tight, loose = (
        fab.flat_parts(enneper.structure, fab.SlotJoint(clearance=c)) for c in (0.0, 0.5)
    )
    for a, b in zip(tight, loose, strict=True):
        assert a.area - b.area == pytest.approx(0.5 * sum(slot.depth for slot in a.slots))


def test_slots_that_run_into_each_other_are_refused_with_both_nodes(profile):
    patch = gs.AsymptoticPatch(p=(-4e-4, 4e-4), q=(-0.3, 0.3), lamellas=(3, 3))
    net = gs.diagonal_meshes(gs.control_patch(gs.Hypar(6000.0), patch))[0]
    with pytest.raises(gs.SettingError, match="runs into the next") as info:
        fab.flat_parts(fab.structure(net, profile), fab.SlotJoint())
    mark, nodes = info.value.where.split(", ")
    assert mark.startswith(("A", "B"))
    assert len(nodes.split(" and ")) == 2


def test_slots_that_run_out_of_their_strip_are_refused_with_their_node(hypar, profile):
    structure = fab.structure(hypar.net, profile, overhang=1.0)
    with pytest.raises(gs.SettingError, match="out of its strip") as info:
        fab.flat_parts(structure, fab.SlotJoint())
    assert info.value.where == f"A1, N{structure.lamellas[0].nodes[0] + 1}"
