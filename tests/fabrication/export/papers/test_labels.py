"""Labels, read back by another program."""

import pytest
from pypdf import PdfReader

from fabrication.errors import OutputError
from fabrication.export.papers.labels import write_labels
from fabrication.joints.slot import SlotJoint
from fabrication.parts import flat_parts


def test_every_mark_and_length_is_on_its_label(tmp_path, catenoid):
    parts = flat_parts(catenoid.structure, SlotJoint())
    path = write_labels(tmp_path / "labels.pdf", parts, name="Pavilion", material="S235")
    pages = PdfReader(path).pages
    text = "\n".join(page.extract_text() for page in pages)
    words = text.split()
    for part in parts:
        assert part.mark in words
        assert f"{part.length:.1f}" in words
    assert text.count("Pavilion") == len(parts)
    assert len(pages) == -(-len(parts) // 24)
    again = write_labels(tmp_path / "again.pdf", parts, name="Pavilion", material="S235")
    assert path.read_bytes() == again.read_bytes()


def test_labels_that_cannot_be_written_are_told(strip, tmp_path):
    with pytest.raises(OutputError, match="labels cannot be written"):
        write_labels(tmp_path / "no" / "labels.pdf", [strip("A1", 500.0)], name="Dach 屋")
    assert write_labels(tmp_path / "labels.pdf", [strip("A1", 500.0)], name="Dach 屋").is_file()
