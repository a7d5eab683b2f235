import numpy as np
import pytest

import fabrication as fab
import gridshell as gs
from fabrication.sides import strip_sides

ACCURACY = 1e-3


@pytest.fixture(scope="module")
def coarse(profile):
    """Two nodes 1.43 m apart, twisted by 20 degrees between them."""
    patch = gs.AsymptoticPatch(p=(-0.25, 0.25), q=(-0.25, 0.25), lamellas=(2, 2))
    net = gs.diagonal_meshes(gs.control_patch(gs.Catenoid(4000.0), patch))[0]
    structure = fab.structure(net, profile)
    return structure.lamellas[0], fab.flat_parts(structure, fab.SlotJoint())[0]


@pytest.fixture(params=["catenoid", "enneper", "hypar", "tube", "saddle", "coarse"])
def strips(request):
    """Lamellas with their parts."""
    found = request.getfixturevalue(request.param)
    if request.param == "coarse":
        return [found]
    return list(zip(found.structure.lamellas, found.parts, strict=True))


def test_parameters_are_the_coordinates_of_the_flat_strip(strips):
    for lamella, part in strips:
        x, y = np.linspace(0.0, part.length, 301), np.linspace(0.0, part.width, 301)
        for side, across in zip(strip_sides(lamella, part), (1.0, -1.0), strict=True):
            offset = np.full_like(x, across * part.thickness / 2.0)
            expected = lamella.place(x + lamella.start, offset, y - part.width / 2.0)
            np.testing.assert_allclose(side.points(x, y), expected, atol=2.0 * ACCURACY)


def test_both_sides_share_their_knots_from_end_to_end(strips):
    for lamella, part in strips:
        near, far = strip_sides(lamella, part)
        np.testing.assert_array_equal(near.knots, far.knots)
        assert near.knots[[0, -1]] == pytest.approx([0.0, part.length], abs=1e-9)
        assert near.width == far.width == part.width


def test_a_side_is_straight_across(enneper):
    side, _ = strip_sides(enneper.structure.lamellas[0], enneper.parts[0])
    x = np.linspace(0.0, enneper.parts[0].length, 20)
    low, middle, high = (side.points(x, np.full(20, y)) for y in (0.0, 50.0, 100.0))
    np.testing.assert_allclose(middle, (low + high) / 2.0, atol=1e-9)


def test_a_strip_that_twists_more_between_its_nodes_gets_more_samples(coarse, pair):
    gentle = strip_sides(pair.structure.lamellas[0], pair.parts[0])[0]
    steep = strip_sides(*coarse)[0]
    assert len(steep.knots) > len(gentle.knots)
