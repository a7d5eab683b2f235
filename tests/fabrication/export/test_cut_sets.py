import numpy as np
import pytest

import fabrication as fab
from fabrication.export.cut_sets import CutSet, counted
from fabrication.parts import Label
from fabrication.shapes import circle
from fabrication.sheet_parts import SheetPiece

PLATE = np.array([[0.0, 0.0], [300.0, 0.0], [320.0, 180.0], [40.0, 210.0]])
STAR = np.array([[0.0, 0.0, 0.0], [100.0, 0.0, 0.4], [100.0, 60.0, 0.0], [0.0, 50.0, 0.0]])


def piece(mark, outline, circles=(), thickness=8.0):
    length, width = np.ptp(outline[:, :2], axis=0)
    label = Label(mark, 50.0, 50.0, 8.0)
    holes = np.array(circles).reshape(-1, 3)
    return SheetPiece(mark, outline, (label,), float(length), float(width), thickness, holes)


def turned(outline, angle, first):
    c, s = np.cos(angle), np.sin(angle)
    points = outline[:, :2] @ np.array([[c, s], [-s, c]])
    points -= points.min(axis=0)
    return np.roll(np.column_stack([points, outline[:, 2:]]), first, axis=0)


def marks(*pieces):
    return [one.marks for one in counted(CutSet("panels", fab.S235, tuple(pieces)))]


@pytest.mark.parametrize("outline", [PLATE, STAR], ids=["plate", "star"])
def test_plates_that_are_equal_once_turned_are_told_once(outline):
    pieces = [piece("P1", outline), *(piece(f"P{k}", turned(outline, 0.7 * k, k)) for k in (2, 3))]
    assert marks(*pieces) == [("P1", "P2", "P3")]
    (one,) = counted(CutSet("panels", fab.S235, tuple(pieces)))
    assert (one.quantity, one.mark, one.alike) == (3, "P1", False)


def test_mirrored_thicker_and_other_plates_are_others():
    mirrored = (PLATE * [-1.0, 1.0] + [320.0, 0.0])[::-1]
    longer = PLATE + np.array([[0.0, 0.0], [0.1, 0.0], [0.0, 0.0], [0.0, 0.0]])
    others = [piece("P2", mirrored), piece("P3", PLATE, thickness=10.0), piece("P4", longer)]
    assert marks(piece("P1", PLATE), *others) == [("P1",), ("P2",), ("P3",), ("P4",)]


def test_an_arc_is_not_its_chord():
    straight = STAR * [1.0, 1.0, 0.0]
    assert marks(piece("N1", STAR), piece("N2", straight)) == [("N1",), ("N2",)]


def test_plates_with_holes_are_equal_only_as_they_lie():
    hole = [[150.0, 90.0, 13.0]]
    same, moved = piece("W2", PLATE, hole), piece("W3", PLATE, [[151.0, 90.0, 13.0]])
    assert marks(piece("W1", PLATE, hole), same, moved) == [("W1", "W2"), ("W3",)]
    ring = piece("R1", circle(20.0), [[0.0, 0.0, 9.0]])
    assert marks(ring, piece("R2", circle(20.0))) == [("R1",), ("R2",)]


def test_strips_are_told_by_their_marks(enneper):
    found = counted(CutSet("strips", fab.S235, enneper.parts))
    assert [one.mark for one in found] == [part.mark for part in enneper.parts]
