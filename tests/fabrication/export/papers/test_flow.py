import re

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pypdf import PdfReader

from fabrication.errors import OutputError
from fabrication.export.papers.flow import (
    BOTTOM,
    HEIGHT,
    LINE,
    TOP,
    Block,
    heading,
    paragraph,
    placed,
    table,
    wrapped,
    write_flow,
)
from fabrication.export.papers.sheet_frame import printable, text_width
from fabrication.export.papers.tables import Column

COLUMNS = (Column("mark", 1.0), Column("what it says", 3.0), Column("value", 1.0, "right"))


def drawn(path):
    return [page.extract_text() for page in PdfReader(path).pages]


@given(st.lists(st.tuples(st.floats(1.0, 120.0), st.booleans()), min_size=1, max_size=40))
def test_blocks_are_placed_in_order_within_the_page_and_do_not_overlap(sizes):
    blocks = [Block(height, lambda pen, area: None, joined) for height, joined in sizes]
    pages = placed(blocks)
    assert [block for page in pages for block, _ in page] == blocks
    for page in pages:
        edge = HEIGHT - TOP
        for block, top in page:
            assert top == pytest.approx(edge)
            edge = top - block.height
            assert edge >= BOTTOM - 1e-9


def test_a_heading_stays_with_what_follows():
    filler = Block(HEIGHT - TOP - BOTTOM - 20.0, lambda pen, area: None)
    pages = placed([filler, heading("Next"), Block(15.0, lambda pen, area: None)])
    assert [len(page) for page in pages] == [1, 2]


def test_a_table_repeats_its_headings_and_its_first_rows_stay_together(tmp_path):
    rows = [(f"A{k}", "text", f"{k}") for k in range(150)]
    path = write_flow(tmp_path / "a.pdf", list(table(COLUMNS, rows)), title="t", foot="f")
    texts = drawn(path)
    assert len(texts) == 3
    assert all("what it says" in text for text in texts)
    assert [mark for text in texts for mark in re.findall(r"^A\d+$", text, re.MULTILINE)] == [
        row[0] for row in rows
    ]
    for number, text in enumerate(texts, start=1):
        assert f"{number} / 3" in text


def test_an_empty_table_says_so(tmp_path):
    path = write_flow(tmp_path / "a.pdf", list(table(COLUMNS, [])), title="t", foot="f")
    assert "none" in drawn(path)[0]


@given(
    st.text(st.characters(codec="cp1252", categories=("L", "N", "P", "Zs")), max_size=200),
    st.floats(5.0, 170.0),
)
def test_wrapped_lines_are_no_longer_than_they_may_be(text, width):
    lines = wrapped(text, width, 2.0)
    assert all(text_width(line, 2.0) <= width or len(line) == 1 for line in lines)
    squeezed = "".join(lines).replace(" ", "")
    assert squeezed == printable(text).replace(" ", "")


def test_a_long_cell_goes_on_below_and_stays_in_its_column(tmp_path):
    long = "N/mm2 " * 60 + "x" * 300
    path = write_flow(
        tmp_path / "a.pdf", list(table(COLUMNS, [("A1", long, "7")])), title="t", foot="f"
    )
    places = []

    def visit(text, cm, tm, font, size):
        if "N/mm2" in text or "xxxx" in text:
            places.append(tm[4] if tm[4] else cm[4])

    PdfReader(path).pages[0].extract_text(visitor_text=visit)
    assert len(places) > 5
    assert len({round(x, 1) for x in places}) == 1


def test_a_paragraph_is_as_wide_as_the_page(tmp_path):
    text = "word " * 100
    blocks = list(paragraph(text))
    assert len(blocks) > 3
    assert all(text_width(line, 2.0) <= LINE for line in wrapped(text, LINE, 2.0))
    assert "word word" in drawn(write_flow(tmp_path / "a.pdf", blocks, title="t", foot="f"))[0]


def test_the_same_blocks_give_the_same_bytes(tmp_path):
    one, other = (
        write_flow(tmp_path / name, list(paragraph("text")), title="t", foot="f").read_bytes()
        for name in ("a.pdf", "b.pdf")
    )
    assert one == other


def test_a_file_that_cannot_be_written_is_told(tmp_path):
    with pytest.raises(OutputError, match="report"):
        write_flow(tmp_path / "none" / "a.pdf", list(paragraph("x")), title="t", foot="f")


def test_powers_and_signs_are_written_in_the_letters_there_are():
    assert printable("−1.2 × 10⁻⁹ mm² 10¹²⁰") == "-1.2 × 10^-9 mm² 10^120"
    assert printable("a\nb\x00屋") == "a b ?"
