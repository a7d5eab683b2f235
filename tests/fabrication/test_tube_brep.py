import numpy as np
import pytest

import gridshell as gs
from fabrication.solid import lamella_solid, volume
from fabrication.stock import hollow_area


@pytest.fixture(scope="module")
def twisted(drilled_tubes):
    patch = gs.BisectingPatch(v=(-0.8, 0.8), cells=16)
    return drilled_tubes(gs.control_patch(gs.Catenoid(1500.0), patch))


@pytest.fixture(scope="module")
def straight(drilled_tubes):
    """The rulings of a hyperbolic paraboloid: no bending, only twist."""
    patch = gs.AsymptoticPatch(p=(-0.2, 0.2), q=(-0.2, 0.2), lamellas=(3, 3))
    return drilled_tubes(gs.control_patch(gs.Hypar(4000.0), patch))


@pytest.mark.parametrize("made", ["twisted", "straight"])
def test_the_volume_is_that_of_the_straight_tube(made, request):
    design, parts = request.getfixturevalue(made)
    for strip, part in list(zip(design.lamellas, parts, strict=True))[:4]:
        solid = lamella_solid(strip, part)  # refused if the kernel finds it invalid
        drilled = 2.0 * 2.5 * len(part.drills) * np.pi / 4.0 * 8.3**2
        expected = part.length * (50.0 * 20.0 - 45.0 * 15.0) - drilled
        assert part.volume == pytest.approx(expected, rel=1e-12)
        assert abs(volume(solid) / expected - 1.0) < 1e-6


def test_it_has_faces_around_inside_at_its_ends_and_in_its_holes(twisted):
    import build123d

    design, parts = twisted
    solid = build123d.Solid(lamella_solid(design.lamellas[0], parts[0]))
    assert len(solid.faces()) == 8 + 2 + 4 * len(parts[0].drills)
    assert solid.is_valid
    assert len(solid.shells()) == 1


def test_points_in_the_wall_are_inside_and_points_in_the_cavity_are_not(twisted):
    import build123d

    design, parts = twisted
    strip, part = design.lamellas[0], parts[0]
    solid = build123d.Solid(lamella_solid(strip, part))
    s = (strip.stations[0] + strip.stations[1]) / 2.0
    for y, z, inside in (
        (0.0, 0.0, False),
        (7.0, 20.0, False),
        (8.75, 0.0, True),
        (-8.75, 10.0, True),
        (0.0, 23.75, True),
        (0.0, -23.75, True),
        (0.0, 26.0, False),
    ):
        point = strip.place(*(np.array([v]) for v in (s, y, z)))[0]
        assert solid.is_inside(build123d.Vector(*point)) is inside, (y, z)
    at = strip.stations[1]
    for z in (23.75, -23.75):
        point = strip.place(*(np.array([v]) for v in (at, 0.0, z)))[0]
        assert not solid.is_inside(build123d.Vector(*point))


def test_the_section_of_a_tube():
    assert hollow_area(50.0, 20.0, 2.5) == 325.0
