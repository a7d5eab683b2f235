"""What the files of the cutting sheets are called."""

from __future__ import annotations

from collections.abc import Sequence

from fabrication.nesting import NestedSheet
from fabrication.shop import Process


def sheet_files(
    sheets: Sequence[NestedSheet],
    *,
    name: str = "",
    material: str = "",
    prefix: str = "sheet",
    process: Process | None = None,
) -> list[str]:
    """The name of every sheet's file, without its ending: as a shop's *process* wants it.

    Parameters
    ----------
    name, material : of the project and of the sheets, for templates that tell them.
    prefix : what the sheets hold.
    """
    files = (Process() if process is None else process).files
    digits = max(2, len(str(len(sheets))))
    return [
        files.named(
            name=name,
            material=material,
            thickness=sheet_thickness(sheet),
            prefix=prefix,
            number=f"{sheet.number:0{digits}d}",
        )
        for sheet in sheets
    ]


def sheet_thickness(sheet: NestedSheet) -> str:
    """Of the sheet's parts: "2.5 mm"."""
    sizes = sorted({placement.part.thickness for placement in sheet.placements})
    return " / ".join(f"{size:g} mm" for size in sizes)
