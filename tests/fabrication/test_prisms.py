import numpy as np
import pytest

from fabrication.bodies import structure_bodies
from fabrication.errors import KernelError
from fabrication.outlines import outline_area
from fabrication.prisms import prism
from fabrication.shapes import Shape
from fabrication.solid import volume

pytestmark = pytest.mark.xdist_group("kernel")


def test_panels_and_plates_have_the_volume_of_their_outlines(leaning):
    bodies = structure_bodies(leaning)
    for kind, parts in zip(bodies.kinds[:2], (leaning.panels, leaning.plates), strict=True):
        for body, part in list(zip(kind.bodies, parts, strict=True))[:6]:
            wanted = part.mass / (2500e-9 if part.mark[0] == "P" else 7850e-9)
            assert volume(prism(bodies.shapes[body.shape])) == pytest.approx(wanted, rel=1e-5)


def test_connectors_have_the_volume_of_their_section(tower):
    bodies = structure_bodies(tower)
    for body, connector in list(zip(bodies.kinds[2].bodies, tower.connectors, strict=True))[:4]:
        wanted = outline_area(connector.section()) * 90.0
        assert volume(prism(bodies.shapes[body.shape])) == pytest.approx(wanted, rel=1e-6)


@pytest.mark.parametrize(
    "outline",
    [
        [[0, 0, 0], [1, 0, 0], [1, 0, 0], [0, 1, 0]],
        [[0, 0, 0], [2, 2, 0], [2, 0, 0], [0, 2, 0]],
    ],
    ids=["double corner", "crossing"],
)
def test_an_outline_that_makes_no_solid_is_an_error_with_its_mark(outline):
    with pytest.raises(KernelError) as info:
        prism(Shape("P7", np.array(outline, dtype=float), 0.0, 1.0))
    assert info.value.where == "P7"
