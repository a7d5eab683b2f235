import numpy as np
import pytest

import fabrication as fab
import gridshell as gs
from fabrication.export.scene.motion import motion_layers
from fabrication.motion import motion


@pytest.fixture(scope="module")
def found():
    umbrella = gs.Umbrella(8, 600.0, (500.0, 480.0, 460.0, 440.0))
    position = umbrella.position(0.3)
    return motion(position, fab.Profile(30.0, 3.0, fab.STAINLESS), count=5)


def test_every_position_is_a_frame_that_lies_where_the_strips_do(found):
    centre = np.array([10.0, -20.0, 300.0])
    first, second = motion_layers(found, centre, opening=0.3)
    assert len(first.frames) == len(second.frames) == len(found.steps)
    for number, step in enumerate(found.steps):
        wanted = (step.strips[: found.first, ::2].reshape(-1, 3) - centre) / 1e3
        placed = first.frames[number] * first.scale + first.low
        np.testing.assert_allclose(placed, wanted, atol=2.0 * first.scale)


def test_triangles_are_of_points_that_are_there(found):
    for layer in motion_layers(found, np.zeros(3), opening=1.0):
        assert layer.triangles.max() == len(layer.frames[0]) - 1


def test_the_position_nearest_to_the_opening_is_first(found):
    openings = [step.opening for step in found.steps]
    for number, opening in enumerate(openings):
        assert motion_layers(found, np.zeros(3), opening)[0].begin == number
