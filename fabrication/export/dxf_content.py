"""What a DXF file of anyone's draws, as plain data: lines by layer, and what cannot be cut at all.

Every DXF can be read: damaged ones are mended as far as they go, and what was mended is told.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from ezdxf import path as curves
from ezdxf import recover
from ezdxf.document import Drawing
from ezdxf.entities.dxfgfx import DXFGraphic
from ezdxf.entities.line import Line
from ezdxf.entities.lwpolyline import LWPolyline
from ezdxf.entities.polyline import Polyline
from ezdxf.filemanagement import readfile
from ezdxf.lldxf.const import DXFError

from fabrication.flattening import SAGITTA, flattened
from gridshell import FileError
from gridshell.arrays import Floats

APPLICATION = "GRIDSHELL"
"""Whose extended data hold the marks of parts."""

_LARGEST = 1e8
"""Coordinates beyond 100 km are no drawing, mm."""

DRAWN = {"LINE", "LWPOLYLINE", "POLYLINE", "ARC", "CIRCLE", "SPLINE", "ELLIPSE"}
"""Entities that are lines."""

_FAULTS = (
    OSError,
    DXFError,
    ValueError,
    LookupError,
    StopIteration,
    TypeError,
    AttributeError,
    AssertionError,
    ArithmeticError,
    RuntimeError,
)
"""What reading a file that is no sound DXF can end with."""


@dataclass(frozen=True, eq=False)
class Track:
    """One line of the drawing.

    Parameters
    ----------
    name : kind and handle of the entity: "LWPOLYLINE 2F".
    layer : as the file calls it.
    points : (k, 2) corners; arcs as short lines; closed ones begin again with the first, mm.
    closed : whether it ends where it begins.
    mark : of the part it belongs to; empty where the file does not say.
    diameter : of a circle, mm; 0 for all others.
    """

    name: str
    layer: str
    points: Floats
    closed: bool
    mark: str = ""
    diameter: float = 0.0


@dataclass(frozen=True, eq=False)
class Content:
    """The drawing: its lines, and all its entities for the checks that look at them.

    Parameters
    ----------
    unreadable : entities whose geometry cannot be told.
    mended : what was wrong with the file itself.
    """

    document: Drawing
    entities: tuple[DXFGraphic, ...]
    tracks: tuple[Track, ...]
    unreadable: tuple[str, ...] = ()
    mended: tuple[str, ...] = field(default=())


def read_content(path: Path | str) -> Content:
    """Read any DXF.

    Raises
    ------
    FileError
        When the file is missing or is no DXF.
    """
    document, mended = _document(path)
    entities = tuple(e for e in document.modelspace() if isinstance(e, DXFGraphic))
    tracks, unreadable = [], []
    for entity in entities:
        if entity.dxftype() in DRAWN:
            track = _track(entity)
            if track is None:
                unreadable.append(entity_name(entity))
            else:
                tracks.append(track)
    return Content(document, entities, tuple(tracks), tuple(unreadable), mended)


def _document(path: Path | str) -> tuple[Drawing, tuple[str, ...]]:
    """The document and what was mended in it."""
    try:
        document = readfile(path)
        faults = document.audit()
        return document, tuple(e.message for e in (*faults.errors, *faults.fixes))
    except OSError as error:
        raise _no_dxf(path, error) from None
    except _FAULTS as error:
        first = f"{error}"
    try:
        document, faults = recover.readfile(path)
    except _FAULTS as error:
        raise _no_dxf(path, error) from None
    told = tuple(e.message for e in (*faults.errors, *faults.fixes))
    if not len(document.modelspace()) and "SECTION" not in _head(path):
        raise _no_dxf(path, first)
    return document, (first, *told)


def _head(path: Path | str) -> str:
    return Path(path).read_bytes()[:100_000].decode("ascii", errors="replace")


def _no_dxf(path: Path | str, why: object) -> FileError:
    return FileError("The file is no DXF that can be read", where=str(path), value=f"{why}")


def entity_name(entity: DXFGraphic) -> str:
    """Kind and handle, as CAD programs list it."""
    return f"{entity.dxftype()} {entity.dxf.get('handle', '?')}"


def mark_of(entity: DXFGraphic) -> str:
    """The mark of the part that *entity* belongs to; empty where it does not say."""
    if not entity.has_xdata(APPLICATION):
        return ""
    marks = [str(tag.value) for tag in entity.get_xdata(APPLICATION) if tag.code == 1000]
    return marks[0] if marks else ""


def _track(entity: DXFGraphic) -> Track | None:
    """The line an entity draws, seen from above."""
    try:
        points, closed = _points(entity)
    except _FAULTS:
        return None
    if len(points) < 1 or not (np.abs(points) <= _LARGEST).all():
        return None
    diameter = (
        2.0 * abs(float(entity.dxf.get("radius", 0.0))) if entity.dxftype() == "CIRCLE" else 0.0
    )
    layer = str(entity.dxf.get("layer", "0"))
    return Track(entity_name(entity), layer, points, closed, mark_of(entity), diameter)


def _round(entity: Any) -> tuple[Floats, bool]:
    """A circle as two half ones, or an arc."""
    if entity.dxftype() == "CIRCLE":
        centre, radius = entity.dxf.center, float(entity.dxf.radius)
        x, y = float(centre.x), float(centre.y)
        return flattened(np.array([[x - radius, y, 1.0], [x + radius, y, 1.0]]), closed=True), True
    first, last = entity.start_point, entity.end_point
    sweep = np.radians((entity.dxf.end_angle - entity.dxf.start_angle) % 360.0)
    rows = np.array([[first.x, first.y, np.tan(sweep / 4.0)], [last.x, last.y, 0.0]])
    return flattened(rows, closed=False), False


def _points(entity: Any) -> tuple[Floats, bool]:
    turned = entity.dxf.hasattr("extrusion") and tuple(entity.dxf.extrusion) != (0.0, 0.0, 1.0)
    flat = not turned
    if isinstance(entity, Line):
        return np.array([entity.dxf.start, entity.dxf.end])[:, :2].astype(float), False
    if flat and isinstance(entity, LWPolyline):
        rows = np.array(entity.get_points("xyb"), dtype=np.float64).reshape(-1, 3)
        return flattened(rows, closed=bool(entity.closed)), bool(entity.closed)
    if flat and isinstance(entity, Polyline) and entity.is_2d_polyline:
        rows = np.array(
            [(*v.dxf.location.vec2, v.dxf.get("bulge", 0.0)) for v in entity.vertices]
        ).reshape(-1, 3)
        return flattened(rows, closed=bool(entity.is_closed)), bool(entity.is_closed)
    if flat and entity.dxftype() in ("CIRCLE", "ARC"):
        return _round(entity)
    line = curves.make_path(entity)
    corners = np.array([(p.x, p.y) for p in line.control_vertices()]).reshape(-1, 2)
    size = float(np.ptp(corners, axis=0).max(initial=0.0))
    if not size <= _LARGEST:
        return np.full((1, 2), np.nan), False
    fine = max(SAGITTA, 1e-5 * size)
    return np.array([(p.x, p.y) for p in line.flattening(fine)]).reshape(-1, 2), line.is_closed
