"""Libraries that only some formats need."""

from __future__ import annotations

from typing import Any

from gridshell.io.library import required as _required


def required(library: str, form: str) -> Any:
    """The module of *library*.

    Raises
    ------
    SettingError
        Naming the format that needs it, and how to install it.
    """
    return _required(library, needs="The format", where="export.formats", value=form)
