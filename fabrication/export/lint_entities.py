"""Faults of a DXF file and its entities: units, layers, kinds, heights."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np
from ezdxf import units
from ezdxf.document import Drawing
from ezdxf.entities.dxfgfx import DXFGraphic

from fabrication.export.dxf_content import DRAWN, Content, entity_name
from fabrication.finding import Finding, Severity
from fabrication.shop import Layers

_UP = (0.0, 0.0, 1.0)
_FLAT = 1e-6
"""Height above the sheet that is none, mm."""

_OWN_LAYERS = {"defpoints"}
"""Layers that programs make for themselves and that are never cut."""

Kind = tuple[str, str]

_KINDS: Mapping[str, Kind] = {
    **dict.fromkeys(
        ("TEXT", "MTEXT", "ATTRIB", "ATTDEF"),
        ("text-on-cut", "is a text. Move it to {text}, or engrave it as strokes on {mark}."),
    ),
    **dict.fromkeys(
        ("DIMENSION", "ARC_DIMENSION", "LEADER", "MULTILEADER", "MLEADER", "TOLERANCE"),
        ("dimension-on-cut", "is a dimension. Delete it: a drawing says it better."),
    ),
    **dict.fromkeys(("HATCH", "MPOLYGON"), ("hatch-on-cut", "is a hatch. Delete it.")),
    "INSERT": ("block-on-cut", "is a block. Explode it, so that its lines can be cut."),
    **dict.fromkeys(
        ("SPLINE", "ELLIPSE", "HELIX"),
        ("curve-on-cut", "is no line or arc. Convert it to arcs and lines."),
    ),
    **dict.fromkeys(
        ("3DFACE", "3DSOLID", "BODY", "REGION", "SURFACE", "MESH", "EXTRUDEDSURFACE"),
        ("three-d", "is a body or face in space. Draw its outline instead."),
    ),
}


def file_findings(content: Content) -> Iterator[Finding]:
    """Damage, units, paper space, entities whose numbers cannot be used."""
    document = content.document
    if content.mended:
        yield _found(
            "damaged-file",
            Severity.WARNING,
            "file",
            f"The file is damaged and was mended to be read: {content.mended[0]} Write it again.",
            value=float(len(content.mended)),
        )
    yield from _unit_findings(content)
    for layout in document.layouts:
        many = sum(e.dxftype() != "VIEWPORT" for e in layout) if layout.name != "Model" else 0
        if many:
            yield _found(
                "paper-space",
                Severity.WARNING,
                layout.name,
                f"{many} entities lie in the paper space {layout.name!r} and are not cut. Move "
                "them to the model or delete them.",
                value=float(many),
            )
    for name in content.unreadable:
        yield _found(
            "bad-number", Severity.ERROR, name, f"{name} has no usable coordinates. Draw it again."
        )


def _unit_findings(content: Content) -> Iterator[Finding]:
    document = content.document
    unit = document.units if "$INSUNITS" in document.header else 0
    if unit == units.MM:
        return
    if unit:
        name = units.decode(unit) or f"unit {unit}"
        yield _found(
            "units-wrong",
            Severity.ERROR,
            "file",
            f"The file is in {name}, shops cut in mm. Scale it and set the unit to mm.",
            value=float(unit),
            limit=float(units.MM),
        )
    elif not (document.dxfversion <= "AC1009" and _says_mm(document)):
        yield _found(
            "units-missing",
            Severity.WARNING,
            "file",
            "The file does not say its unit: a shop may take it for inches. Set it to mm.",
            limit=float(units.MM),
        )


def _says_mm(document: Drawing) -> bool:
    """Whether a text names the unit, as the oldest format cannot."""
    return any("mm" in str(e.dxf.text).split() for e in document.modelspace().query("TEXT"))


def layer_findings(content: Content, layers: Layers) -> Iterator[Finding]:
    """Layers that are unknown, "0", frozen or off, and a cutting layer that is empty."""
    counts = Counter(str(entity.dxf.get("layer", "0")) for entity in content.entities)
    known = ", ".join(dict.fromkeys(layers.named.values()))
    for name, count in counts.items():
        many = "1 entity lies" if count == 1 else f"{count} entities lie"
        if layers.key(name) is None and name == "0":
            yield _found(
                "layer-0",
                Severity.WARNING,
                name,
                f"{many} on layer 0. Move them to one of {known}.",
                value=float(count),
            )
        elif layers.key(name) is None and name.casefold() not in _OWN_LAYERS:
            yield _found(
                "unknown-layer",
                Severity.WARNING,
                name,
                f"{many} on the layer {name!r}, which the shop does not know. Rename it to one of "
                f"{known}.",
                value=float(count),
            )
        yield from _hidden(content.document, name, many)
    if not any(layers.key(name) in ("cut", "drill") for name in counts):
        yield _found(
            "nothing-to-cut",
            Severity.ERROR,
            layers.cut,
            f"Nothing lies on the layer {layers.cut}. Move the outlines there.",
        )


def _hidden(document: Drawing, name: str, many: str) -> Iterator[Finding]:
    if not document.layers.has_entry(name):
        return
    layer = document.layers.get(name)
    if layer.is_frozen() or layer.is_off():
        state = "frozen" if layer.is_frozen() else "off"
        yield _found(
            "layer-frozen" if layer.is_frozen() else "layer-off",
            Severity.WARNING,
            name,
            f"{many} on the layer {name}, which is {state}: shops may not see them. Switch it on "
            "or delete them.",
        )


def entity_findings(
    content: Content, layers: Layers, key: Callable[[str], str | None]
) -> Iterator[Finding]:
    """Entities on the cutting layer that are no flat lines.

    Parameters
    ----------
    key : what lies on a layer, by its name.
    """
    for entity in content.entities:
        layer = key(str(entity.dxf.get("layer", "0")))
        if layer not in ("cut", "drill", "mark"):
            continue
        kind, name = entity.dxftype(), entity_name(entity)
        if layer != "mark":
            yield from _kind_findings(entity, kind, name, layers)
        if kind in DRAWN:
            yield from _height_findings(entity, name)


def _kind_findings(entity: Any, kind: str, name: str, layers: Layers) -> Iterator[Finding]:
    if kind in _KINDS:
        code, advice = _KINDS[kind]
        severity = Severity.WARNING if code == "curve-on-cut" else Severity.ERROR
        yield _found(code, severity, name, f"{name} {advice.format_map(layers.named)}")
    elif kind == "POLYLINE" and not entity.is_2d_polyline:
        yield _found(
            "three-d",
            Severity.ERROR,
            name,
            f"{name} is a line or mesh in space. Draw its outline flat instead.",
        )
    elif kind not in DRAWN:
        yield _found(
            "no-line",
            Severity.ERROR,
            name,
            f"{name} cannot be cut: only lines, arcs, circles and polylines can. Delete it.",
        )
    elif width := _pen(entity):
        yield _found(
            "wide-line",
            Severity.WARNING,
            name,
            f"{name} is drawn {width:g} mm wide: a machine cuts its middle or both its sides. Set "
            "the width to 0.",
            value=width,
        )


def _pen(entity: Any) -> float:
    """Width of a polyline, mm."""
    if entity.dxftype() == "LWPOLYLINE":
        own = np.abs(np.array([row[2:4] for row in entity.get_points("xyse")])).max(initial=0.0)
        return max(float(own), abs(float(entity.dxf.get("const_width", 0.0))))
    if entity.dxftype() == "POLYLINE":
        return abs(float(entity.dxf.get("default_start_width", 0.0)))
    return 0.0


def _height_findings(entity: DXFGraphic, name: str) -> Iterator[Finding]:
    extrusion = tuple(entity.dxf.extrusion) if entity.dxf.hasattr("extrusion") else _UP
    if extrusion != _UP and np.abs(np.subtract(extrusion, _UP)).max() > _FLAT:
        yield _found(
            "extrusion",
            Severity.ERROR,
            name,
            f"{name} lies in a turned plane (extrusion {', '.join(f'{c:g}' for c in extrusion)}): "
            "machines mirror or refuse it. Flatten it.",
        )
        return
    height = _height(entity)
    if height > _FLAT:
        yield _found(
            "height",
            Severity.ERROR,
            name,
            f"{name} lies up to {height:g} mm above or below the sheet. Flatten it to z = 0.",
            value=height,
        )


def _height(entity: Any) -> float:
    """How far an entity leaves z = 0, mm."""
    kind, dxf = entity.dxftype(), entity.dxf
    if kind == "LWPOLYLINE":
        return abs(float(dxf.get("elevation", 0.0)))
    if kind == "POLYLINE":
        own = abs(float(dxf.elevation.z)) if dxf.hasattr("elevation") else 0.0
        return max([own, *(abs(float(v.dxf.location.z)) for v in entity.vertices)])
    if kind == "SPLINE":
        return max((abs(float(p[2])) for p in entity.control_points), default=0.0)
    points = [dxf.get(key) for key in ("start", "end", "center") if dxf.hasattr(key)]
    return max((abs(float(p[2])) for p in points), default=0.0)


def _found(
    code: str,
    severity: Severity,
    where: str,
    message: str,
    *,
    value: float = 0.0,
    limit: float = 0.0,
) -> Finding:
    return Finding(code, severity, where, value, limit, "", message)
