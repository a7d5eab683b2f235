"""The order of assembly against every order there is."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import permutations

from hypothesis import given
from hypothesis import strategies as st

from fabrication.contacts import Bearing, Contacts, Lap, order_of


def woven(rows: int, columns: int, mask: int) -> Contacts:
    """A grid; bit k of *mask* puts the row under the column at crossing k."""
    laps = []
    for k in range(rows * columns):
        row, column = k // columns, rows + k % columns
        below, above = (row, column) if mask >> k & 1 else (column, row)
        laps.append(Lap(below, above, f"N{k}"))
    return Contacts(rows + columns, tuple(laps))


def goes_together(contacts: Contacts, order: Sequence[int]) -> bool:
    """Add strip after strip: all slots shared with those present must open to one edge."""
    present: set[int] = set()
    for strip in order:
        from_above = any(lap.above == strip and lap.below in present for lap in contacts.laps)
        from_below = any(lap.below == strip and lap.above in present for lap in contacts.laps)
        if from_above and from_below:
            return False
        if any(b.strip == strip and b.on not in present for b in contacts.bearings):
            return False
        present.add(strip)
    return True


def any_order(contacts: Contacts) -> bool:
    """Whether some order exists: every set of strips that can stand, grown one by one."""
    count = contacts.count
    over, under = [0] * count, [0] * count
    for lap in contacts.laps:
        over[lap.below] |= 1 << lap.above
        under[lap.above] |= 1 << lap.below
    standing = {0}
    for _ in range(count):
        standing |= {
            held | 1 << s
            for held in standing
            for s in range(count)
            if not (held & over[s] and held & under[s])
        }
    return (1 << count) - 1 in standing


def test_every_way_to_slot_three_by_three():
    possible = 0
    for mask in range(2**9):
        contacts = woven(3, 3, mask)
        order = order_of(contacts, range(6))
        exists = any_order(contacts)
        possible += exists
        assert exists == (not order.locked)
        if exists:
            assert sorted(order.strips) == list(range(6))
            assert goes_together(contacts, order.strips)
    assert possible == 230


def test_every_order_of_two_by_three_by_the_letter():
    for mask in range(2**6):
        contacts = woven(2, 3, mask)
        exists = any(goes_together(contacts, order) for order in permutations(range(5)))
        assert exists == (not order_of(contacts, range(5)).locked)


@given(st.integers(2, 7), st.integers(2, 7), st.integers(0, 2**49 - 1), st.randoms())
def test_orders_of_larger_grids_hold_and_locked_strips_hold_each_other(rows, columns, mask, random):
    contacts = woven(rows, columns, mask)
    wish = list(range(contacts.count))
    random.shuffle(wish)
    order = order_of(contacts, wish)
    locked = set(order.locked)
    if not locked:
        assert sorted(order.strips) == sorted(wish)
        assert goes_together(contacts, order.strips)
    for strip in locked:
        assert any(lap.above == strip and lap.below in locked for lap in contacts.laps)
        assert any(lap.below == strip and lap.above in locked for lap in contacts.laps)


@given(st.lists(st.integers(0, 9), max_size=30), st.integers(0, 2**49 - 1))
def test_the_wish_changes_the_order_and_not_whether_there_is_one(swaps, mask):
    contacts = woven(5, 5, mask)
    wish = list(range(10))
    for a, b in zip(swaps[::2], swaps[1::2], strict=False):
        wish[a], wish[b] = wish[b], wish[a]
    assert order_of(contacts, wish).locked == order_of(contacts, range(10)).locked


def test_a_grid_slotted_from_one_side_follows_the_wish():
    wish = (5, 0, 3, 2, 4, 1)
    assert order_of(woven(3, 3, 2**9 - 1), wish).strips == wish


def test_a_weave_is_locked_and_a_loose_strip_beside_it_is_not():
    weave = woven(2, 2, 0b1001)
    contacts = Contacts(5, weave.laps)
    order = order_of(contacts, range(5))
    assert order.locked == (0, 1, 2, 3)
    assert order.strips == (4,)


def test_what_bears_goes_in_after_what_it_bears_on():
    bearings = (Bearing(0, 1, "N1"), Bearing(1, 2, "N2"), Bearing(0, 2, "N3"))
    order = order_of(Contacts(3, bearings=bearings), range(3))
    assert order.strips == (2, 1, 0)
    assert not order.rings


@given(st.integers(3, 40))
def test_a_ring_is_told_and_opened_at_one_place(count):
    bearings = tuple(Bearing(k, (k + 1) % count, f"N{k}") for k in range(count))
    order = order_of(Contacts(count, bearings=bearings), range(count))
    (ring,) = order.rings
    assert sorted(ring) == sorted(order.strips) == list(range(count))
    assert all(b == (a + 1) % count for a, b in zip(ring, ring[1:] + ring[:1], strict=True))
    assert order.strips[-1] == ring[0]
    place = {strip: k for k, strip in enumerate(order.strips)}
    assert sum(place[b.on] > place[b.strip] for b in bearings) == 1


def test_a_ring_of_strips_that_are_woven_too_stays_locked():
    weave = woven(2, 2, 0b1001)
    bearings = tuple(Bearing(a, b, "N") for a, b in ((0, 2), (2, 1), (1, 3), (3, 0)))
    order = order_of(Contacts(4, weave.laps, bearings), range(4))
    assert order.locked == (0, 1, 2, 3)
    assert not order.strips
