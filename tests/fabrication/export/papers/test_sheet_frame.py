from datetime import date

import pytest
from pypdf import PdfReader

import gridshell as gs
from fabrication.errors import OutputError
from fabrication.export.papers.sheet_frame import (
    SIZES,
    Page,
    Titles,
    page_area,
    printable,
    text_width,
    today,
    write_pages,
)

TITLES = Titles("Käfig über Hof", "S235", "B", date(2026, 3, 1))


def pages(count=2):
    return [Page(f"Drawing {k}", "1:5", lambda pen, area: None) for k in range(1, count + 1)]


@pytest.mark.parametrize("paper", list(SIZES))
def test_pages_have_the_size_that_is_asked_for(tmp_path, paper):
    path = write_pages(tmp_path / "a.pdf", pages(), TITLES, paper=paper)
    box = PdfReader(path).pages[0].mediabox
    found = (float(box.width) * 25.4 / 72.0, float(box.height) * 25.4 / 72.0)
    assert found == pytest.approx(SIZES[paper], abs=0.01)


def test_the_title_block_names_everything(tmp_path):
    path = write_pages(tmp_path / "a.pdf", pages(3), TITLES)
    texts = [page.extract_text() for page in PdfReader(path).pages]
    assert len(texts) == 3
    for number, text in enumerate(texts, start=1):
        for word in ("Käfig über Hof", "S235", "2026-03-01", "B", "1:5", "All dimensions in mm"):
            assert word in text
        assert f"Drawing {number}" in text
        assert f"{number} / 3" in text
        assert "Not checked: loads" in text


def test_the_same_pages_give_the_same_bytes(tmp_path):
    first, second = (
        write_pages(tmp_path / name, pages(), TITLES).read_bytes() for name in ("a.pdf", "b.pdf")
    )
    assert first == second


def test_the_area_lies_within_the_frame():
    area = page_area("A3")
    assert area.x >= 10.0
    assert area.x + area.width <= 410.0
    assert area.y >= 32.0
    assert area.y + area.height <= 287.0


def test_an_unknown_size_is_refused_with_those_that_are_known():
    with pytest.raises(gs.SettingError, match="No such size of paper") as info:
        page_area("A7")
    assert "A3" in info.value.limit


def test_a_file_that_cannot_be_written_is_told(tmp_path):
    with pytest.raises(OutputError, match="cannot be written"):
        write_pages(tmp_path / "none" / "a.pdf", pages(), TITLES)


def test_text_the_fonts_do_not_have_becomes_question_marks():
    assert printable("Dach 屋根 ü") == "Dach ?? ü"
    assert text_width("mm", 5.0) == pytest.approx(2.0 * text_width("mm", 2.5))


def test_the_date_follows_the_environment(monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    assert today() == date(1970, 1, 1)


@pytest.mark.parametrize("align", ["left", "middle", "right"])
def test_powers_are_raised_and_smaller_and_keep_to_the_alignment(tmp_path, align):
    drawn = []

    def draw(pen, area):
        pen.text(100.0, 100.0, "4 × 10⁻¹² mm²", height=3.58, align=align)

    path = write_pages(tmp_path / "a.pdf", [Page("Powers", "1:1", draw)], TITLES)

    def seen(text, matrix, place, font, size):
        x, y = 25.4 / 72.0 * (place[4] + matrix[4]), 25.4 / 72.0 * (place[5] + matrix[5])
        if text.strip() and y > 90.0:
            drawn.append((text.strip("\n"), x, y, size * 25.4 / 72.0))

    PdfReader(path).pages[0].extract_text(visitor_text=seen)
    (base, x, y, size), (power, _, up, small), (unit, _, back, _) = drawn
    assert (base, power, unit.strip()) == ("4 × 10", "-12", "mm²")
    assert y == back == pytest.approx(100.0)
    assert y < up < y + size
    assert size == pytest.approx(5.0)
    assert 0.5 * size < small < size
    width = text_width("4 × 10⁻¹² mm²", 3.58)
    share = {"left": 0.0, "middle": 0.5, "right": 1.0}[align]
    assert x == pytest.approx(100.0 - share * width, abs=1e-3)
    assert width < text_width("4 × 10-12 mm²", 3.58)
