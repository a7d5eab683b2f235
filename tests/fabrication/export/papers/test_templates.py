import re

import numpy as np
import pytest
from pypdf import PdfReader

import fabrication as fab
import gridshell as gs
from fabrication.cut import Floor, Hole, Relief, outline
from fabrication.errors import OutputError
from fabrication.export.papers.templates import FLAP
from fabrication.parts import parts_of

MM = 72.0 / 25.4


def lines(page):
    """All straight strokes of a page, mm: rows x, y, x, y."""
    found, at = [], None
    content = page.get_contents().get_data().decode("latin-1")
    for x, y, what in re.findall(r"(-?[\d.]+) (-?[\d.]+) ([ml])\b", content):
        here = (float(x) / MM, float(y) / MM)
        if what == "l" and at is not None:
            found.append((*at, *here))
        at = here
    return np.array(found)


@pytest.fixture(scope="module")
def printed(enneper, tmp_path_factory):
    parts = parts_of(fab.SlotJoint().build(enneper.structure), Relief(Floor.DOGBONE, 0.5))[:2]
    path = tmp_path_factory.mktemp("paper") / "templates.pdf"
    fab.write_templates(path, parts, name="workshop", paper="A4")
    return parts, PdfReader(path)


def test_every_page_has_a_check_of_100_mm(printed):
    _, reader = printed
    for page in reader.pages:
        rows = lines(page)
        flat = rows[np.abs(rows[:, 1] - rows[:, 3]) < 1e-3]
        assert np.isclose(np.abs(flat[:, 2] - flat[:, 0]), 100.0, atol=0.01).any()
        assert "100 mm" in page.extract_text()


def test_strips_are_drawn_at_full_size(printed):
    parts, reader = printed
    rows = lines(reader.pages[0])
    high = np.abs(rows[:, 3] - rows[:, 1])
    assert np.isclose(high, parts[0].width, atol=0.01).any()
    slot = parts[0].slots[0]
    walls = rows[(np.abs(rows[:, 2] - rows[:, 0]) < 1e-3) & (high > 30.0) & (high < 60.0)]
    x = np.unique(np.round(walls[:, 0], 2))
    gaps = (x[:, None] - x[None]).ravel()
    assert np.isclose(gaps, slot.width, atol=0.03).any()


def test_tiles_cover_a_strip_with_their_flaps(printed):
    parts, reader = printed
    text = "\n".join(page.extract_text() for page in reader.pages)
    for part in parts:
        tiles = re.findall(rf"{part.mark} +(\d+) / (\d+) +from (\d+) mm", text)
        count = int(tiles[0][1])
        assert [int(t[0]) for t in tiles] == list(range(1, count + 1))
        starts = np.array([float(t[2]) for t in tiles])
        step = 297.0 - 16.0 - FLAP
        np.testing.assert_allclose(np.diff(starts), step, atol=1.0)
        assert starts[-1] + step + FLAP >= part.length


def test_partners_stand_behind_their_slots(printed):
    parts, reader = printed
    text = "\n".join(page.extract_text() for page in reader.pages)
    assert all(slot.partner in text for part in parts for slot in part.slots)


def test_narrow_strips_share_a_page(strip, tmp_path):
    several = [strip(f"A{k}", 200.0, width=40.0) for k in range(1, 5)]
    fab.write_templates(tmp_path / "a.pdf", several, name="w")
    assert len(PdfReader(tmp_path / "a.pdf").pages) == 2


def test_a_strip_wider_than_the_paper_is_refused_by_its_mark(strip, tmp_path):
    with pytest.raises(gs.SettingError, match="wider than the paper") as info:
        fab.write_templates(tmp_path / "a.pdf", [strip("A7", 500.0, width=250.0)], name="w")
    assert info.value.where == "A7"
    assert not (tmp_path / "a.pdf").exists()


def test_paper_that_is_not_known_and_folders_that_are_not_there(strip, tmp_path):
    with pytest.raises(gs.SettingError, match="No such size"):
        fab.write_templates(tmp_path / "a.pdf", [strip("A1", 100.0)], name="w", paper="Z")
    with pytest.raises(OutputError):
        fab.write_templates(tmp_path / "no" / "a.pdf", [strip("A1", 100.0)], name="w")


def test_holes_are_circles_with_a_cross(strip, tmp_path):
    from dataclasses import replace

    bare = strip("A1", 200.0)
    part = replace(bare, holes=(Hole(100.0, 50.0, 12.0, "N1", "bolt"),))
    assert (part.outline == outline(200.0, 100.0, ())).all()
    fab.write_templates(tmp_path / "a.pdf", [part], name="w")
    content = PdfReader(tmp_path / "a.pdf").pages[0].get_contents().get_data()
    assert content.count(b" c\n") + content.count(b" c ") >= 4
