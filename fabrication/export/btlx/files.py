"""A BTLx 2.0.0 file: a part per strip with what is done to it."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from pathlib import Path
from xml.etree.ElementTree import Element, ElementTree, SubElement, indent

from fabrication.errors import OutputError
from fabrication.export.btlx.processings import number, processings
from fabrication.export.cut_sets import Counted, CutSet, counted
from fabrication.parts import FlatPart
from fabrication.stock import Material
from gridshell import SettingError

VERSION = "2.0.0"
NAMESPACE = "https://www.design2machine.com"
_SCHEMA = f"{NAMESPACE} {NAMESPACE}/btlx/btlx_2_0_0.xsd"
_GUIDS = uuid.UUID("4f0c2c3e-8a3b-4c55-9a0e-0d6f1a0a7d42")
_APART = 50.0
"""Between two strips that are shown side by side, mm."""


def write_btlx(path: Path, name: str, sets: Sequence[CutSet]) -> None:
    """Write the timber strips of *sets*, each in its flat state, as one file.

    Parameters
    ----------
    name : of the project. Identifiers follow from it and from the marks alone.

    Raises
    ------
    SettingError
        Where there are no timber strips, or they are hollow.
    OutputError
        When the file cannot be written.
    """
    tree = ElementTree(_document(name, sets))
    indent(tree)
    try:
        tree.write(path, encoding="utf-8", xml_declaration=True)
    except OSError as error:
        raise OutputError(
            "The BTLx file cannot be written", where=str(path), value=error.strerror or ""
        ) from None


def _document(name: str, sets: Sequence[CutSet]) -> Element:
    strips = [
        (one, one.part, cut.material)
        for cut in sets
        if cut.material.is_timber
        for one in counted(cut)
        if isinstance(one.part, FlatPart)
    ]
    if not strips:
        raise SettingError(
            "BTLx files are of timber strips, and there are none",
            where="export.formats",
            value=", ".join(sorted({cut.material.name for cut in sets})),
            advice="leave btlx out; the DXF sheets hold these parts",
        )
    root = Element("BTLx", {"xmlns": NAMESPACE, "Version": VERSION, "Language": "en"})
    root.set("xmlns:xsi", "http://www.w3.org/2001/XMLSchema-instance")
    root.set("xsi:schemaLocation", _SCHEMA)
    history = SubElement(root, "FileHistory")
    SubElement(history, "InitialExportProgram", {"ProgramName": "gridshell", "Comment": name})
    project = SubElement(root, "Project", {"Name": name, "GUID": _guid(name)})
    parts = SubElement(project, "Parts")
    place = 0.0
    for count, (one, part, material) in enumerate(strips, start=1):
        parts.append(_part(count, one, part, material, name, place))
        place += one.quantity * (part.width + _APART)
    return root


def _part(
    count: int, one: Counted, part: FlatPart, material: Material, name: str, place: float
) -> Element:
    if part.wall:
        raise SettingError(
            "BTLx strips are solid",
            where="export.formats",
            value=f"{one.mark}, a hollow section",
            advice="leave btlx out",
        )
    element = Element(
        "Part",
        {
            "Count": f"{one.quantity}",
            "Length": number(part.length),
            "Width": number(part.thickness),
            "Height": number(part.width),
            "SingleMemberNumber": f"{count}",
            "AssemblyNumber": one.mark,
            "OrderNumber": f"{count}",
            "Designation": one.mark,
            "Material": material.name,
            "Weight": number(part.volume * material.density * 1e-9),
        },
    )
    transformations = SubElement(element, "Transformations")
    for copy in range(one.quantity):
        _placed(
            transformations,
            _guid(name, one.mark, f"{copy}"),
            place + copy * (part.width + _APART),
        )
    SubElement(element, "GrainDirection", {"X": "1", "Y": "0", "Z": "0", "Align": "no"})
    SubElement(element, "Processings").extend(processings(part))
    return element


def _placed(parent: Element, guid: str, y: float) -> None:
    """Where a copy lies: flat, along x, its engraved face up."""
    position = SubElement(SubElement(parent, "Transformation", {"GUID": guid}), "Position")
    for key, at in (
        ("ReferencePoint", (0.0, y, 0.0)),
        ("XVector", (1.0, 0.0, 0.0)),
        ("YVector", (0.0, 1.0, 0.0)),
    ):
        SubElement(position, key, {axis: number(v) for axis, v in zip("XYZ", at, strict=True)})


def _guid(*words: str) -> str:
    return f"{{{uuid.uuid5(_GUIDS, '/'.join(words))}}}"
