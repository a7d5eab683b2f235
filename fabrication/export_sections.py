"""The section of a project on files for other programs."""

from __future__ import annotations

from typing import Literal

from fabrication.section_types import Section

Format = Literal["glb", "ply", "obj", "3dm", "ifc", "nc1", "btlx"]


class ExportSection(Section):
    """Files for other programs, in ``export/``."""

    formats: tuple[Format, ...]
