"""The drawing of one flat strip as an SVG that stands alone, for pages and notebooks."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader

from fabrication.colours import FAMILY_COLOURS, css
from fabrication.strip_drawing import Strip, strip_drawing
from fabrication.words import fixed


def strip_svg(part: Strip, family: int) -> str:
    """The drawing of *part* in the colour of its *family*, 1 or 2."""
    drawn: str = _macros().strip(strip_drawing(part), css(FAMILY_COLOURS[family]))
    return re.sub(r"[ \n]+", " ", drawn).strip()


@cache
def _macros() -> Any:
    environment = Environment(loader=FileSystemLoader(Path(__file__).parent), autoescape=True)
    environment.filters.update(fixed=fixed)
    return environment.get_template("strip.html").module
