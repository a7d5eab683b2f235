"""Where a solve was left, as a NumPy archive."""

from __future__ import annotations

from pathlib import Path
from zipfile import BadZipFile

import numpy as np

from gridshell.errors import FileError
from gridshell.solve import State


def write_state(path: Path | str, state: State) -> None:
    """Write *state* in full double precision.

    Raises
    ------
    FileError
        When the file cannot be written.
    """
    try:
        with Path(path).open("wb") as file:
            np.savez_compressed(
                file, x=state.x, steps=state.steps, damping=state.damping, growth=state.growth
            )
    except OSError as error:
        raise FileError(
            "The state cannot be written", where=str(path), value=error.strerror or ""
        ) from None


def read_state(path: Path | str) -> State:
    """Read a state back, bit for bit.

    Raises
    ------
    FileError
        When the file is missing or is not a state.
    """
    try:
        with np.load(path, allow_pickle=False) as found:
            return State(
                np.array(found["x"], dtype=np.float64).ravel(),
                int(found["steps"]),
                float(found["damping"]),
                float(found["growth"]),
            )
    except OSError as error:
        raise FileError(
            "The state cannot be read", where=str(path), value=error.strerror or ""
        ) from None
    except (KeyError, ValueError, TypeError, AttributeError, EOFError, BadZipFile) as error:
        raise FileError(
            "The file is not a saved state", where=str(path), value=type(error).__name__
        ) from None
