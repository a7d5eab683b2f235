"""Writing text, with an error for people."""

from __future__ import annotations

from pathlib import Path

from gridshell.errors import FileError


def write_text(path: Path | str, text: str) -> None:
    """Write *text* as UTF-8.

    Raises
    ------
    FileError
        When the file cannot be written.
    """
    try:
        Path(path).write_text(text, encoding="utf-8")
    except OSError as error:
        raise FileError(
            "The file cannot be written",
            where=str(path),
            value=error.strerror or type(error).__name__,
            advice="a folder that exists and may be written",
        ) from None
