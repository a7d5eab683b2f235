import numpy as np
import pytest

import gridshell as gs
from fabrication.export.step_prism_reader import read_prisms

pytestmark = pytest.mark.xdist_group("kernel")


def nearest(first, second):
    apart = np.linalg.norm(first[:, None] - second[None], axis=2)
    return max(apart.min(axis=0).max(), apart.min(axis=1).max())


@pytest.mark.parametrize("which", ["tower", "leaning"])
def test_every_part_is_read_where_it_was_designed(which, request, bodies_file):
    built = request.getfixturevalue(which)
    found = {prism.mark: prism for prism in read_prisms(bodies_file(built))}
    assert len(found) == len(built.panels) + len(built.plates) + len(built.connectors)
    for panel in built.panels:
        prism = found[panel.mark]
        assert nearest(prism.low, panel.in_space()) < 1e-3
        assert nearest(prism.high, panel.in_space() + 8.0 * panel.frame.normal) < 1e-3
        assert prism.height == pytest.approx(8.0)
        assert prism.volume() == pytest.approx(panel.area * 8.0, rel=1e-6)
    for plate in built.plates:
        assert nearest(found[plate.mark].middle, plate.in_space()) < 1e-3
    for connector in built.connectors:
        frame = connector.frame
        low = frame.place(connector.section()[:, :2]) - 110.0 * frame.normal
        assert nearest(found[connector.mark].low, low) < 1e-3


def test_the_product_says_how_many_are_alike(bodies_file, tower):
    assert {p.product for p in read_prisms(bodies_file(tower)) if p.mark in ("P1", "P4")} == {
        "P1, 8 alike"
    }


def test_what_is_no_step_file_of_prisms_is_refused(tmp_path, bodies_file, tower):
    path = tmp_path / "x.step"
    with pytest.raises(gs.FileError, match="cannot be read"):
        read_prisms(path)
    path.write_text("hello")
    with pytest.raises(gs.FileError, match="something else"):
        read_prisms(path)
    whole = bodies_file(tower).read_text()
    path.write_text(whole[: len(whole) // 2])
    with pytest.raises(gs.FileError, match="something else"):
        read_prisms(path)
