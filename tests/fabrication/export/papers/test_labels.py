"""Labels, read back by another program."""

import subprocess
from pathlib import Path
from typing import Any

from fabrication.export.papers.labels import write_labels
from fabrication.joints.slot import SlotJoint
from fabrication.parts import flat_parts


def test_every_mark_and_length_is_on_its_label(tmp_path: Path, catenoid: Any) -> None:
    parts = flat_parts(catenoid.structure, SlotJoint())
    path = write_labels(tmp_path / "labels.pdf", parts, name="Pavilion", material="S235")
    text = subprocess.run(
        ["pdftotext", "-layout", str(path), "-"], capture_output=True, text=True, check=True
    ).stdout
    words = text.split()
    for part in parts:
        assert part.mark in words
        assert f"{part.length:.1f}" in words
    assert text.count("Pavilion") == len(parts)
    assert text.count("\f") == -(-len(parts) // 24)
    again = write_labels(tmp_path / "again.pdf", parts, name="Pavilion", material="S235")
    assert path.read_bytes() == again.read_bytes()
