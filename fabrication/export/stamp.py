"""Who writes a file, and when."""

from __future__ import annotations

import os
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version


def program() -> str:
    """Name and version of the program."""
    try:
        return f"gridshell {version('gridshell')}"
    except PackageNotFoundError:  # run from a source tree
        return "gridshell"


def now() -> datetime:
    """The moment of ``SOURCE_DATE_EPOCH`` (seconds since 1970) where that is set, else now."""
    epoch = os.environ.get("SOURCE_DATE_EPOCH", "")
    return datetime.fromtimestamp(int(epoch), UTC) if epoch.isdecimal() else datetime.now(UTC)
