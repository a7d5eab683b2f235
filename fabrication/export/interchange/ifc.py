"""IFC4: strips as members, flat parts as plates, bolts and nuts as fasteners, marks and numbers.

Geometry is tessellated, in mm, each layer in its colour. Identifiers follow from the project's name
and the marks alone, so that a second export of the same design has the same ones.
"""

from __future__ import annotations

import uuid
from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np

from fabrication.export.interchange.missing import required
from fabrication.export.interchange.model import Item, Model
from fabrication.export.stamp import now, program
from fabrication.shapes import Colour

_SPACE = uuid.UUID("a9f0a1c6-5b0f-4c3b-9d0e-6f1f6d2a7c11")
"""Of the identifiers."""

_VIEW = "ViewDefinition [ReferenceView_V1.2]"

_OTHER = ("IfcDiscreteAccessory", "USERDEFINED")

_FLAT = 0.3
"""Over its extent, a body that is no thicker is a plate."""


def write_ifc(path: Path, model: Model) -> None:
    """Write a project with one site, one building and everything that is built in it.

    Raises
    ------
    SettingError
        Where ifcopenshell is not installed.
    """
    ifc = required("ifcopenshell", "ifc")
    guid = required("ifcopenshell.guid", "ifc")
    file = ifc.file(schema="IFC4")
    head = file.header
    head.file_description.description = (_VIEW,)
    head.file_name.name = path.name
    head.file_name.time_stamp = f"{now():%Y-%m-%dT%H:%M:%S}"
    head.file_name.originating_system = program()
    _Writer(file, guid, model).write()
    file.write(str(path))


class _Writer:
    """The entities of one file."""

    def __init__(self, file: Any, guid: Any, model: Model) -> None:
        self.file, self.guid, self.model = file, guid, model
        self.make = file.create_entity
        self.world = self.make(
            "IfcAxis2Placement3D", self.make("IfcCartesianPoint", (0.0, 0.0, 0.0))
        )
        self.context = self.make(
            "IfcGeometricRepresentationContext", None, "Model", 3, 1e-5, self.world, None
        )
        self.place = self.make("IfcLocalPlacement", None, self.world)
        self.styles: dict[Colour, Any] = {}

    def write(self) -> None:
        """Project, site, building, elements, what they are made of."""
        building = self._building()
        made = [(item, self._element(item)) for item in self.model.items]
        if not made:
            return
        self.make(
            "IfcRelContainedInSpatialStructure",
            GlobalId=self._identifier("contained"),
            RelatedElements=[element for _, element in made],
            RelatingStructure=building,
        )
        self._materials(made)

    def _identifier(self, *words: str) -> str:
        named = uuid.uuid5(_SPACE, "/".join((self.model.name, *words)))
        return str(self.guid.compress(named.hex))

    def _building(self) -> Any:
        units = (
            ("LENGTHUNIT", "MILLI", "METRE"),
            ("AREAUNIT", None, "SQUARE_METRE"),
            ("VOLUMEUNIT", None, "CUBIC_METRE"),
            ("PLANEANGLEUNIT", None, "RADIAN"),
            ("MASSUNIT", "KILO", "GRAM"),
        )
        project = self.make(
            "IfcProject",
            GlobalId=self._identifier("project"),
            Name=self.model.name,
            RepresentationContexts=(self.context,),
            UnitsInContext=self.make(
                "IfcUnitAssignment", [self.make("IfcSIUnit", None, *unit) for unit in units]
            ),
        )
        site, building = (
            self.make(kind, GlobalId=self._identifier(kind), Name=name, ObjectPlacement=self.place)
            for kind, name in (("IfcSite", "Site"), ("IfcBuilding", self.model.name))
        )
        for whole, part in ((project, site), (site, building)):
            self.make(
                "IfcRelAggregates",
                GlobalId=self._identifier("aggregates", part.is_a()),
                RelatingObject=whole,
                RelatedObjects=(part,),
            )
        return building

    def _element(self, item: Item) -> Any:
        faces = self.make(
            "IfcTriangulatedFaceSet",
            Coordinates=self.make("IfcCartesianPointList3D", item.points.round(6).tolist()),
            Closed=True,
            CoordIndex=(item.triangles + 1).tolist(),
        )
        self.make("IfcStyledItem", faces, (self._style(item.colour),))
        shape = self.make("IfcShapeRepresentation", self.context, "Body", "Tessellation", (faces,))
        kind, predefined = _kind(item)
        element = self.make(
            kind,
            GlobalId=self._identifier(item.layer, item.name),
            Name=item.name,
            ObjectType=_singular(item.layer),
            ObjectPlacement=self.place,
            Representation=self.make("IfcProductDefinitionShape", None, None, (shape,)),
            Tag=item.mark,
            PredefinedType=predefined,
        )
        if "diameter_mm" in item.numbers and kind == "IfcMechanicalFastener":
            element.NominalDiameter = float(item.numbers["diameter_mm"])
            element.NominalLength = float(item.numbers["length_mm"])
        if item.numbers:
            self._numbers(item, element)
        return element

    def _style(self, colour: Colour) -> Any:
        if colour not in self.styles:
            shading = self.make(
                "IfcSurfaceStyleShading", self.make("IfcColourRgb", None, *map(float, colour)), 0.0
            )
            self.styles[colour] = self.make("IfcSurfaceStyle", None, "BOTH", (shading,))
        return self.styles[colour]

    def _numbers(self, item: Item, element: Any) -> None:
        values = [
            self.make("IfcPropertySingleValue", key, None, self._value(value))
            for key, value in item.numbers.items()
        ]
        self.make(
            "IfcRelDefinesByProperties",
            GlobalId=self._identifier(item.layer, item.name, "defines"),
            RelatedObjects=(element,),
            RelatingPropertyDefinition=self.make(
                "IfcPropertySet",
                GlobalId=self._identifier(item.layer, item.name, "numbers"),
                Name="Gridshell_Part",
                HasProperties=values,
            ),
        )

    def _value(self, value: str | float | int) -> Any:
        kinds = {str: "IfcLabel", int: "IfcInteger", float: "IfcReal"}
        return self.make(kinds[type(value)], value)

    def _materials(self, made: list[tuple[Item, Any]]) -> None:
        by_name: dict[str, list[Any]] = defaultdict(list)
        for item, element in made:
            if "material" in item.numbers:
                by_name[str(item.numbers["material"])].append(element)
        for name, elements in by_name.items():
            self.make(
                "IfcRelAssociatesMaterial",
                GlobalId=self._identifier("material", name),
                RelatedObjects=elements,
                RelatingMaterial=self.make("IfcMaterial", name),
            )


def _kind(item: Item) -> tuple[str, str]:
    """Class and predefined type."""
    layer = item.layer
    if layer.startswith("family"):
        return "IfcMember", "MEMBER"
    if layer.endswith(("bolts", "pins")):
        return "IfcMechanicalFastener", "BOLT"
    if layer.endswith("nuts"):
        return "IfcMechanicalFastener", "USERDEFINED"
    thickness = float(item.numbers.get("thickness_mm", np.inf))
    extent = float(np.linalg.norm(np.ptp(item.points, axis=0)))
    return ("IfcPlate", "SHEET") if thickness < _FLAT * extent else _OTHER


def _singular(layer: str) -> str:
    """What one of the layer is: "nut", "star washer"; a family keeps its name."""
    return layer if layer.startswith("family") else layer.removesuffix("s")
