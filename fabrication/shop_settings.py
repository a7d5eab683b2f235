"""From the section of a shop to its process at the profile's thickness."""

from __future__ import annotations

from dataclasses import replace

from fabrication.shop import Cutting, DxfVersion, FileNames, Layers, Process, preset
from fabrication.shop_sections import ShopSection
from fabrication.stock import Profile


def process_of(section: ShopSection | None, profile: Profile) -> Process:
    """The limits and files of a shop; without a section, no limits and the usual files.

    Raises
    ------
    SettingError
        For names of layers or a template of file names that cannot be used.
    """
    if section is None:
        return Process()
    usual = preset(Cutting(section.process), profile.thickness, tool=section.tool)
    keys = ("min_web", "min_hole", "min_edge", "min_slot", "kerf")
    given = {key: getattr(section, key) for key in keys}
    names = {key.lower(): name for key, name in section.layers.model_dump().items()}
    return replace(
        usual,
        **{key: value for key, value in given.items() if value is not None},
        compensate=section.compensate,
        bed=section.bed,
        layers=Layers(**names),
        files=FileNames(section.files),
        version=DxfVersion(section.version),
    )
