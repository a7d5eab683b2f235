from pathlib import Path

import pytest

PROJECT = """\
# A small net to try things on.
name = "pavilion"

[surface]
kind = "enneper"
scale = 4000.0

[patch]
layout = "asymptotic"
p = [-0.8, 0.8]
q = [-0.8, 0.8]
lamellas = [6, 5]   # of either family

[net]
angle = 70.0        # degrees
anchor = "free"
keep_to_surface = false

[profile]
width = 80.0
thickness = 2.0
material = "stainless"

[joint]
kind = "slot"

[sheet]
length = 9000.0
width = 1500.0
"""


@pytest.fixture
def text() -> str:
    """The project's text."""
    return PROJECT


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A project file in a folder of its own."""
    found = tmp_path / "pavilion.toml"
    found.write_text(PROJECT, encoding="utf-8")
    return found
