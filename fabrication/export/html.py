"""Pages from this folder's HTML: text is escaped, numbers are written as people read them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from jinja2 import ChainableUndefined, Environment, FileSystemLoader

from fabrication.words import fixed, number, plural


def rendered(file: str, /, **values: Any) -> str:
    """The page of *file* with *values*; what is missing of them renders as nothing."""
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        undefined=ChainableUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(figure=number, fixed=fixed, plural=plural)
    page: str = environment.get_template(file).render(**values)
    return page
