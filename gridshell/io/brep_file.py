"""Design surfaces from STEP, IGES and BREP files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from gridshell.io.obj import Unit
from gridshell.io.units import require_same_unit, required_unit
from gridshell.surface import BrepSurface


def read_brep(
    path: Path | str, *, unit: Unit | None = None, tolerance: float | None = None
) -> BrepSurface:
    """Read the faces of a STEP, IGES or BREP file, sewn into one patch, mm.

    Parameters
    ----------
    unit : STEP and IGES files state their own unit; it may be repeated here, not changed. A BREP
        file states none and needs one.
    tolerance : gaps up to this, mm, are sewn; a 50,000th of the size when None.

    Raises
    ------
    FileError
        When the file is missing, cannot be read or has another extension.
    UnitError
        When a BREP file comes without a unit, or *unit* contradicts the file.
    NotOnePatchError
        No faces, a solid, several patches, or one that branches.
    SurfaceError
        A patch with one side only, or a broken outline.
    """
    return patch_of(*load_with_scale(Path(path), unit), tolerance=tolerance)


def patch_of(shape: Any, scale: float, *, tolerance: float | None = None) -> BrepSurface:
    """The faces of a loaded kernel shape whose unit is *scale* mm; raises as `read_brep` does."""
    from gridshell.surface.brep_kernel import model_of

    sewn = None if tolerance is None else tolerance / scale
    return BrepSurface(model_of(shape, tolerance=sewn).scaled(scale))


def load_with_scale(path: Path, unit: Unit | None) -> tuple[Any, float]:
    """A kernel shape and the size of its unit, mm: 1 for files that state their unit.

    Raises
    ------
    FileError, UnitError
        As `read_brep` does.
    """
    from gridshell.surface.brep_kernel import load_shape

    shape, own = load_shape(path)
    if not own:
        return shape, required_unit(path, unit, "A BREP file").value
    require_same_unit(path, unit, own)
    return shape, 1.0
