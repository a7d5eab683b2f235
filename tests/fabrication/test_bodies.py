import numpy as np
import pytest

from fabrication.bodies import structure_bodies
from fabrication.shapes import with_bulges


def in_space(body, shapes, z):
    shape = shapes[body.shape]
    return body.frame.place(shape.outline[:, :2]) + z * body.frame.normal


def nearest(first, second):
    apart = np.linalg.norm(first[:, None] - second[None], axis=2)
    return max(apart.min(axis=0).max(), apart.min(axis=1).max())


@pytest.mark.parametrize("which", ["tower", "leaning"])
def test_every_body_lies_where_its_part_does_whatever_shape_it_shares(which, request):
    built = request.getfixturevalue(which)
    bodies = structure_bodies(built)
    panels, plates, connectors = (kind.bodies for kind in bodies.kinds)
    for body, panel in zip(panels, built.panels, strict=True):
        assert body.mark == panel.mark
        assert nearest(in_space(body, bodies.shapes, 0.0), panel.in_space()) < 1e-3
        assert body.frame.normal @ panel.frame.normal == pytest.approx(1.0)
    for body, plate in zip(plates, built.plates, strict=True):
        assert nearest(in_space(body, bodies.shapes, 0.0), plate.in_space()) < 1e-3
    for body, connector in zip(connectors, built.connectors, strict=True):
        wanted = connector.frame.place(connector.section()[:, :2]) - 110.0 * connector.frame.normal
        assert nearest(in_space(body, bodies.shapes, 0.0), wanted) < 1e-3


def test_equal_parts_share_a_shape(tower):
    bodies = structure_bodies(tower)
    panels = bodies.kinds[0].bodies
    assert len({body.shape for body in panels}) == 3
    assert bodies.shapes[panels[0].shape].mark == "P1"


def test_panels_lie_above_the_net_and_plates_on_both_sides_of_their_plane(tower):
    bodies = structure_bodies(tower)
    spans = [
        {(bodies.shapes[body.shape].low, bodies.shapes[body.shape].high) for body in kind.bodies}
        for kind in bodies.kinds
    ]
    assert spans == [{(0.0, 8.0)}, {(-3.0, 3.0)}, {(0.0, 90.0)}]


def test_straight_outlines_have_no_bulge():
    assert with_bulges(np.ones((4, 2)))[:, 2].tolist() == [0.0] * 4
    assert with_bulges(np.ones((4, 3))).tolist() == np.ones((4, 3)).tolist()
