"""What a project leaves to us: keys it does not set, with what is taken for them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from fabrication.section_types import Section
from fabrication.sections import Project


def defaults_of(project: Project) -> dict[str, Any]:
    """Keys that the sections of *project* leave out, with dots, and the values taken for them.

    Keys whose default is nothing at all are left out; sections that the project does not have have
    no keys.
    """
    return dict(_unset(project, ""))


def _unset(section: Section, before: str) -> Iterator[tuple[str, Any]]:
    for name in type(section).model_fields:
        value = getattr(section, name)
        if isinstance(value, Section):
            if name in section.model_fields_set:
                yield from _unset(value, f"{before}{name}.")
        elif name not in section.model_fields_set and value not in (None, (), [], ""):
            yield f"{before}{name}", list(value) if isinstance(value, tuple) else value
