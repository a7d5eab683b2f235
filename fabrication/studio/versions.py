"""Projects as documents that a slider can change, one after the other, with their undo.

A document is what the project's file says, so that what nobody touched stays unset. Keys have dots:
``net.angle``, ``patch.lamellas.0``.
"""

from __future__ import annotations

import copy
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from fabrication.project import project_of
from fabrication.sections import Project

Document = Mapping[str, Any]


@dataclass(frozen=True, eq=False)
class Version:
    """A document and the project it describes."""

    document: Document
    project: Project

    @staticmethod
    def of(document: Document, path: Path) -> Version:
        """Validate *document* as the content of *path*.

        Raises
        ------
        InputError
            As ``project_of``.
        """
        return Version(document, project_of(document, path))

    def with_value(self, key: str, value: Any, path: Path) -> Version:
        """The same with another value of *key*; sections on the way there are made.

        Raises
        ------
        InputError
            When the project cannot have that value.
        """
        document = copy.deepcopy(dict(self.document))
        set_value(document, key, value)
        return Version.of(document, path)

    def value(self, key: str) -> Any:
        """What the project says of *key*, by default too; None where it says nothing."""
        found: Any = self.project
        for word in key.split("."):
            if found is None:
                return None
            found = found[int(word)] if word.isdigit() else getattr(found, word, None)
        return found


def set_value(document: Any, key: str, value: Any) -> None:
    """Set *key* of nested tables and arrays in place; tables that are missing are made."""
    *way, last = key.split(".")
    for word in way:
        document = document[int(word)] if word.isdigit() else document.setdefault(word, {})
    if last.isdigit():
        document[int(last)] = value
    else:
        document[last] = value


def differences(before: Document, after: Document) -> dict[str, Any]:
    """Values of *after* that *before* does not have, by their keys with dots."""
    found: dict[str, Any] = {}
    for name, value in after.items():
        old = before.get(name)
        if isinstance(value, Mapping) and isinstance(old, Mapping):
            found |= {f"{name}.{key}": more for key, more in differences(old, value).items()}
        elif value != old or type(value) is not type(old):
            found[name] = value
    return found


@dataclass(frozen=True, eq=False)
class History:
    """The versions before and after the present one."""

    present: Version
    past: tuple[Version, ...] = ()
    future: tuple[Version, ...] = field(default=())

    def to(self, version: Version) -> History:
        """Go on to *version*; what had been undone is gone."""
        return History(version, (*self.past, self.present))

    def undone(self) -> History:
        """One back; itself where there is none."""
        if not self.past:
            return self
        return History(self.past[-1], self.past[:-1], (self.present, *self.future))

    def redone(self) -> History:
        """One on again; itself where there is none."""
        if not self.future:
            return self
        first, *rest = self.future
        return replace(self, present=first, past=(*self.past, self.present), future=tuple(rest))
