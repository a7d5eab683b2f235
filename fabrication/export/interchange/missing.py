"""Libraries that only some formats need."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from gridshell import SettingError


def required(library: str, form: str) -> Any:
    """The module of *library*.

    Raises
    ------
    SettingError
        Naming the format that needs it, and how to install it.
    """
    try:
        return import_module(library)
    except ImportError:
        raise SettingError(
            f"The format needs the library {library}, which is not installed",
            where="export.formats",
            value=form,
            advice="pip install '.[interchange]', in the folder of gridshell",
        ) from None
