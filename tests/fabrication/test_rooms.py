import numpy as np
import pytest

from fabrication.arrangement import Lane, arranged
from fabrication.rooms import room_beside


@pytest.mark.parametrize("across", [20.0, -20.0])
def test_the_room_beside_a_straight_strip_is_what_its_twist_leaves(hypar, across):
    """On a hypar axes are straight: only the twist, tau s z, takes room."""
    lane = Lane("L", across)
    made = arranged(hypar.structure, {1: (lane,), 2: (lane,)}, crossing=False)
    axis, strip = hypar.structure.lamellas[1], made.strips.lamellas[1]
    s = axis.stations[1:2]
    frame = axis.frames(s)
    narrow, wide = (
        room_beside(
            strip,
            strip.stations[1:2],
            frame.points,
            np.sign(across) * frame.b,
            reach=np.array([reach]),
            width=100.0,
            thickness=2.5,
        )[0]
        for reach in (1e-6, 30.0)
    )
    assert narrow == pytest.approx(20.0 - 1.25, abs=0.01)
    taken = abs(float(axis.twist(s)[0])) * 30.0 * 50.0
    assert narrow - wide == pytest.approx(taken, rel=0.05)


def test_a_longer_body_has_less_room(catenoid):
    lane = Lane("L", 15.0)
    made = arranged(catenoid.structure, {1: (lane,), 2: (lane,)}, crossing=False)
    axis, strip = catenoid.structure.lamellas[2], made.strips.lamellas[2]
    frame = axis.frames(axis.stations[1:4])
    rooms = [
        room_beside(
            strip,
            strip.stations[1:4],
            frame.points,
            frame.b,
            reach=np.full(3, reach),
            width=100.0,
            thickness=2.5,
        )
        for reach in (5.0, 20.0, 60.0)
    ]
    assert (np.diff(np.array(rooms), axis=0) < 0.0).all()
