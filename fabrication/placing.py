"""Where a setting stands in a project file, for errors."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import gridshell as gs
from fabrication.errors import ProjectError


@contextmanager
def placed(path: Path, section: str) -> Iterator[None]:
    """Add the file and the section to the place an error names."""
    try:
        yield
    except gs.InputError as error:
        at = error.where or ""
        joint = "." if at.replace(".", "").isidentifier() else ": "
        raise ProjectError(
            error.what,
            where=f"{path}, {section}{joint}{at}",
            value=error.value,
            limit=error.limit,
            advice=error.advice,
        ) from None


@contextmanager
def keyed(section: str) -> Iterator[None]:
    """Add the section of the project to the key that an error of a setting names."""
    try:
        yield
    except gs.SettingError as error:
        at = error.where or ""
        if not at.replace(".", "").isidentifier():
            raise
        raise gs.SettingError(
            error.what,
            where=f"{section}.{at}",
            value=error.value,
            limit=error.limit,
            advice=error.advice,
        ) from None
