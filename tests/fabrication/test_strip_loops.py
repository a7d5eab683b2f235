from dataclasses import replace

import numpy as np
import pytest

import fabrication as fab
from fabrication.cut import Floor, Hole, Relief
from fabrication.parts import parts_of
from fabrication.sides import strip_sides
from fabrication.strip_loops import Run, arc_images, strip_loops


@pytest.fixture(scope="module")
def part(enneper):
    cut = parts_of(fab.SlotJoint().build(enneper.structure), Relief(Floor.DOGBONE, 0.3))[0]
    return replace(cut, holes=(Hole(20.0, 50.0, 8.0, "N1", "bolt"),), bevels=(1.0, -0.5))


def test_a_strip_has_its_outline_and_one_loop_a_hole(part):
    outline, hole = strip_loops(part)
    assert outline.rows.shape == (2, len(part.outline), 3)
    assert hole.rows.shape == (2, 2, 3)
    assert [piece.run for piece in hole.pieces] == [Run.ARC, Run.ARC]
    assert not any(piece.forward for piece in hole.pieces)


def test_every_arc_is_where_its_corners_are(part):
    for loop in strip_loops(part):
        for i, piece in enumerate(loop.pieces):
            if piece.run is not Run.ARC:
                continue
            ends = [
                np.array(piece.centre) + piece.at[0] * np.array([np.cos(turn), np.sin(turn)])
                for turn in (piece.low[0], piece.high[0])
            ]
            for end, number in zip(ends, (piece.first, piece.last), strict=True):
                np.testing.assert_allclose(end, loop.rows[0, number, :2], atol=1e-9)
            assert {piece.first, piece.last} == {i, (i + 1) % len(loop.pieces)}
            assert piece.high[0] > piece.low[0]


def test_bevels_part_the_ends_of_the_two_sides(part):
    near, far = strip_loops(part)[0].rows
    assert (near[:, 0].min(), far[:, 0].min()) == (0.0, 1.0)
    assert near[:, 0].max() == pytest.approx(part.length - 0.5)
    assert far[:, 0].max() == pytest.approx(part.length)


def test_images_of_arcs_lie_on_both_sides(enneper, part):
    sides = strip_sides(enneper.structure.lamellas[0], part)
    arcs = [p for loop in strip_loops(part) for p in loop.pieces if p.run is Run.ARC]
    images = arc_images(sides, arcs)
    assert images.poles.shape[:2] == (len(arcs), 2)
    assert images.off < 5e-5
