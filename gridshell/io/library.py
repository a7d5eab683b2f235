"""Libraries that only some files need."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from gridshell.errors import SettingError


def required(library: str, *, needs: str, where: str, value: str) -> Any:
    """The module of *library*.

    Parameters
    ----------
    needs : what cannot be had without it: "The format".
    where, value : the key or file that asks for it, and what it asks for.

    Raises
    ------
    SettingError
        Naming what needs the library, and how to install it.
    """
    try:
        return import_module(library)
    except ImportError:
        raise SettingError(
            f"{needs} needs the library {library}, which is not installed",
            where=where,
            value=value,
            advice="pip install '.[interchange]', in the folder of gridshell",
        ) from None
