"""Files that are there whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path

from fabrication.errors import OutputError
from gridshell import FileError

Write = Callable[[Path], None]


def require_places(*paths: Path) -> None:
    """Refuse, before any work, places where no file can be put.

    Raises
    ------
    OutputError
        When a folder stands in the place of a file, or the folder around it is missing, or two of
        *paths* are one.
    """
    for number, path in enumerate(paths):
        if path.is_dir() or not path.name:
            raise OutputError("A folder is where a file must be", where=str(path))
        if not path.absolute().parent.is_dir():
            raise OutputError(
                "The file cannot be written",
                where=str(path),
                value="no such folder",
                advice="a folder that exists and may be written",
            )
        if path.absolute() in [other.absolute() for other in paths[:number]]:
            raise OutputError("Two files have one name", where=str(path))


def write_whole(files: Mapping[Path, Write]) -> None:
    """Have every file written beside its place; move them there when all are complete.

    Raises
    ------
    OutputError
        When a file cannot be written; no draft is left then.
    """
    drafts = {path: path.with_name(f".{path.name}.{os.getpid()}") for path in files}
    path = Path()
    try:
        for path, write in files.items():
            write(drafts[path])
        for path, draft in drafts.items():
            draft.replace(path)
    except (FileError, OSError) as error:
        raise OutputError(
            "The file cannot be written",
            where=str(path),
            value=getattr(error, "value", None) or getattr(error, "strerror", None),
            advice="a folder that exists and may be written",
        ) from None
    finally:
        for draft in drafts.values():
            draft.unlink(missing_ok=True)


def text_file(text: str) -> Write:
    """Writes *text* as UTF-8."""

    def write(path: Path) -> None:
        path.write_text(text, encoding="utf-8")

    return write
