from dataclasses import replace

import pytest

import fabrication as fab

LIMIT = 1e-3
"""Volume two strips may share, mm3."""


@pytest.fixture(scope="module", params=["catenoid", "enneper"])
def tight(request):
    """A structure at 90 or at 60 degrees and its parts without any clearance in their slots."""
    design = request.getfixturevalue(request.param)
    return design.structure, fab.flat_parts(design.structure, fab.SlotJoint(clearance=0.0))


def changed(parts, with_slots, **change):
    """The same parts with slots narrower, shallower or moved by so many mm."""
    return tuple(
        with_slots(
            part,
            [
                replace(slot, **{key: getattr(slot, key) + by for key, by in change.items()})
                for slot in part.slots
            ],
        )
        for part in parts
    )


def only(structure, parts, node):
    """A structure's parts with the slots of a single node."""
    return tuple(
        replace(part, slots=tuple(slot for slot in part.slots if slot.node == node.name))
        for part in parts
    )


def test_strips_without_clearance_share_nothing_at_any_node(tight):
    structure, parts = tight
    result = fab.fit(structure, parts)
    assert result.nodes == len(structure.nodes)
    assert result.max_mm3 < LIMIT


def test_slots_a_twentieth_narrower_clash(tight, with_slots):
    structure, parts = tight
    result = fab.fit(structure, changed(parts, with_slots, width=-0.05))
    assert result.max_mm3 > 10.0 * LIMIT
    assert result.worst in {node.name for node in structure.nodes}


def test_slots_a_twentieth_narrower_clash_at_every_node(tight, with_slots):
    structure, parts = tight
    narrow = changed(parts, with_slots, width=-0.05)
    for node in structure.nodes[:5]:
        assert fab.fit(structure, only(structure, narrow, node)).max_mm3 > LIMIT


@pytest.mark.parametrize(("spare", "clashes"), [(0.05, False), (-0.05, True)])
def test_the_floors_of_two_slots_must_not_meet(tight, with_slots, spare, clashes):
    structure, parts = tight
    floors = changed(parts, with_slots, width=1.0, depth=spare - 0.5)
    assert (fab.fit(structure, floors).max_mm3 > LIMIT) == clashes


def test_slots_a_millimetre_off_their_node_clash(tight, with_slots):
    structure, parts = tight
    assert fab.fit(structure, changed(parts, with_slots, x=1.0)).max_mm3 > 100.0 * LIMIT


def test_the_worst_node_is_the_one_that_was_spoilt(tight, with_slots):
    structure, parts = tight
    node = structure.nodes[7]
    spoilt = tuple(
        with_slots(
            part,
            [replace(s, width=s.width - 0.05 * (s.node == node.name)) for s in part.slots],
        )
        for part in parts
    )
    assert fab.fit(structure, spoilt).worst == node.name


def test_with_the_usual_clearance_nothing_touches(tight):
    structure, _ = tight
    result = fab.fit(structure, fab.flat_parts(structure, fab.SlotJoint()))
    assert (result.max_mm3, result.worst) == (0.0, "")


def test_a_singular_node_is_not_tried(saddle):
    regular = sum(node.regular for node in saddle.structure.nodes)
    assert fab.fit(saddle.structure, saddle.parts).nodes == regular < len(saddle.structure.nodes)


def test_strips_without_slots_have_nothing_to_fit(hypar, with_slots):
    bare = tuple(with_slots(part, []) for part in hypar.parts)
    assert fab.fit(hypar.structure, bare) == fab.Fit(0.0, "", 0)


# ---- against the CAD kernel -----------------------------------------------------------------


@pytest.mark.xdist_group("kernel")
@pytest.mark.parametrize(("by", "clashes"), [(0.01, False), (-0.05, True)])
def test_the_kernel_s_own_boolean_agrees(pair, with_slots, by, clashes):
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Common

    from fabrication.solid import lamella_solid, volume

    structure, node = pair.structure, pair.structure.nodes[0]
    tight = fab.flat_parts(structure, fab.SlotJoint(clearance=0.0))
    parts = changed(tight, with_slots, width=by)
    one, other = (
        lamella_solid(structure.lamellas[c.lamella], parts[c.lamella]) for c in node.crossings
    )
    common = BRepAlgoAPI_Common(one, other)
    exact = volume(common.Shape())
    assert (exact > 100.0 * LIMIT) if clashes else (exact < LIMIT)
    found = fab.fit(structure, only(structure, parts, node)).max_mm3
    assert found == pytest.approx(exact, rel=0.02, abs=LIMIT)
