"""IFC4: strips as members, panels as plates, bolts as fasteners, each with its mark and numbers.

Geometry is tessellated, in mm. Identifiers follow from the project's name and the marks alone, so
that a second export of the same design has the same ones.
"""

from __future__ import annotations

import uuid
from pathlib import Path
from typing import Any

from fabrication.export.interchange.missing import required
from fabrication.export.interchange.model import Item, Model

_SPACE = uuid.UUID("a9f0a1c6-5b0f-4c3b-9d0e-6f1f6d2a7c11")
"""Of the identifiers."""

_CLASSES = (
    (("family",), "IfcMember", "MEMBER"),
    (("panel", "plate", "glass", "star", "washer"), "IfcPlate", "SHEET"),
    (("bolt", "heads", "nut", "pin"), "IfcMechanicalFastener", "BOLT"),
)
_OTHER = ("IfcDiscreteAccessory", "USERDEFINED")


def write_ifc(path: Path, model: Model) -> None:
    """Write a project with one site, one building and everything that is built in it.

    Raises
    ------
    SettingError
        Where ifcopenshell is not installed.
    """
    ifc = required("ifcopenshell", "ifc")
    guid = required("ifcopenshell.guid", "ifc")

    def identifier(*words: str) -> str:
        named = uuid.uuid5(_SPACE, "/".join((model.name, *words)))
        return str(guid.compress(named.hex))

    file = ifc.file(schema="IFC4")
    origin = file.create_entity("IfcCartesianPoint", (0.0, 0.0, 0.0))
    world = file.create_entity("IfcAxis2Placement3D", origin)
    context = file.create_entity(
        "IfcGeometricRepresentationContext", None, "Model", 3, 1e-5, world, None
    )
    unit = file.create_entity("IfcSIUnit", None, "LENGTHUNIT", "MILLI", "METRE")
    units = file.create_entity(
        "IfcUnitAssignment",
        (
            unit,
            file.create_entity("IfcSIUnit", None, "AREAUNIT", None, "SQUARE_METRE"),
            file.create_entity("IfcSIUnit", None, "VOLUMEUNIT", None, "CUBIC_METRE"),
            file.create_entity("IfcSIUnit", None, "PLANEANGLEUNIT", None, "RADIAN"),
            file.create_entity("IfcSIUnit", None, "MASSUNIT", "KILO", "GRAM"),
        ),
    )
    project = file.create_entity(
        "IfcProject",
        GlobalId=identifier("project"),
        Name=model.name,
        RepresentationContexts=(context,),
        UnitsInContext=units,
    )
    place = file.create_entity("IfcLocalPlacement", None, world)
    site = file.create_entity(
        "IfcSite", GlobalId=identifier("site"), Name="Site", ObjectPlacement=place
    )
    building = file.create_entity(
        "IfcBuilding", GlobalId=identifier("building"), Name=model.name, ObjectPlacement=place
    )
    for whole, part in ((project, site), (site, building)):
        file.create_entity(
            "IfcRelAggregates",
            GlobalId=identifier("aggregates", part.Name),
            RelatingObject=whole,
            RelatedObjects=(part,),
        )
    made = [_element(file, context, place, item, identifier) for item in model.items]
    if made:
        file.create_entity(
            "IfcRelContainedInSpatialStructure",
            GlobalId=identifier("contained"),
            RelatedElements=made,
            RelatingStructure=building,
        )
    file.write(str(path))


def _element(file: Any, context: Any, place: Any, item: Item, identifier: Any) -> Any:
    kind, predefined = _kind(item)
    points = file.create_entity("IfcCartesianPointList3D", item.points.round(6).tolist())
    faces = file.create_entity(
        "IfcTriangulatedFaceSet",
        Coordinates=points,
        Closed=True,
        CoordIndex=(item.triangles + 1).tolist(),
    )
    shape = file.create_entity("IfcShapeRepresentation", context, "Body", "Tessellation", (faces,))
    element = file.create_entity(
        kind,
        GlobalId=identifier(item.layer, item.mark),
        Name=item.mark,
        ObjectType=item.layer,
        ObjectPlacement=place,
        Representation=file.create_entity("IfcProductDefinitionShape", None, None, (shape,)),
        Tag=item.mark,
        PredefinedType=predefined,
    )
    if item.numbers:
        values = [
            file.create_entity("IfcPropertySingleValue", key, None, _value(file, value))
            for key, value in item.numbers.items()
        ]
        properties = file.create_entity(
            "IfcPropertySet",
            GlobalId=identifier(item.layer, item.mark, "numbers"),
            Name="Gridshell_Part",
            HasProperties=values,
        )
        file.create_entity(
            "IfcRelDefinesByProperties",
            GlobalId=identifier(item.layer, item.mark, "defines"),
            RelatedObjects=(element,),
            RelatingPropertyDefinition=properties,
        )
    return element


def _kind(item: Item) -> tuple[str, str]:
    for words, kind, predefined in _CLASSES:
        if any(word in item.layer.lower() for word in words):
            return kind, predefined
    return _OTHER


def _value(file: Any, value: str | float | int) -> Any:
    if isinstance(value, str):
        return file.create_entity("IfcLabel", value)
    if isinstance(value, int):
        return file.create_entity("IfcInteger", value)
    return file.create_entity("IfcReal", float(value))
