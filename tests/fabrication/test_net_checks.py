from types import SimpleNamespace

import numpy as np
import pytest

import gridshell as gs
from fabrication.finding import Severity
from fabrication.net_checks import check_net
from gridshell.mesh import grid_quads


def judged(distance, kept, remarks=()):
    """Of a net of 3 x 4 m, diagonal 5 m."""
    points = np.array([[0.0, 0, 0], [3000, 0, 0], [0, 4000, 0], [3000, 4000, 0]])
    control = gs.as_control_mesh(gs.QuadMesh(points, grid_quads(1, 1)))
    quality = SimpleNamespace(surface_distance_mm=distance and gs.Spread(distance / 2.0, distance))
    return check_net(SimpleNamespace(control=control, remarks=remarks), quality, kept=kept)


def test_a_net_that_leaves_its_surface_is_a_warning():
    (found,) = judged(60.0, kept=True)
    assert (found.code, found.severity) == ("off-surface", Severity.WARNING)
    assert (found.value, found.limit) == (60.0, pytest.approx(50.0))
    assert "60 mm, 30 mm on average" in found.message


@pytest.mark.parametrize(("distance", "kept"), [(49.0, True), (60.0, False), (None, True)])
def test_a_net_that_stays_or_may_leave_it_is_none(distance, kept):
    assert judged(distance, kept=kept) == []


def test_what_is_odd_about_the_mesh_is_told():
    (found,) = judged(None, kept=False, remarks=("The mesh has 2 separate components.",))
    assert (found.code, found.severity) == ("mesh", Severity.INFO)
    assert found.message == "The mesh has 2 separate components."
