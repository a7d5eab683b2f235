"""What can go wrong between a net and a shop's files.

::

    gridshell.InputError
    ├── StockError        a part that no sheet or bar can hold
    ├── ProjectError      a key of the project file that is wrong, missing or unknown
    └── OutputError       a folder that cannot be written (also an OSError)
    gridshell.GridshellError
    └── KernelError       the CAD kernel is missing, or made or read a solid that is not valid
"""

from __future__ import annotations

from gridshell import GridshellError, InputError


class StockError(InputError):
    """A part that no sheet can hold."""


class ProjectError(InputError):
    """A key of the project file is wrong, missing or unknown."""


class OutputError(InputError, OSError):
    """A folder or file that cannot be written."""


class KernelError(GridshellError):
    """The CAD kernel is missing, or a solid is not valid."""


def no_kernel(error: ImportError) -> KernelError:
    """What is told where the CAD kernel cannot be loaded."""
    return KernelError(
        "The CAD kernel cannot be loaded",
        value=str(error),
        advice="install the project again; a bare Linux also needs libgl1 and libxrender1",
    )
