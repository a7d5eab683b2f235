"""Read the parts of our own cutting sheets back."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from ezdxf import units
from ezdxf.entities.circle import Circle
from ezdxf.entities.dxfentity import DXFEntity
from ezdxf.entities.lwpolyline import LWPolyline
from ezdxf.entities.polyline import Polyline
from ezdxf.filemanagement import readfile
from ezdxf.lldxf.const import DXFError

from fabrication.export.dxf_content import APPLICATION
from fabrication.kerf import moved_out
from fabrication.shop import Process
from gridshell import FileError
from gridshell.arrays import Floats


@dataclass(frozen=True, eq=False)
class DxfPart:
    """What a sheet says of one part.

    Parameters
    ----------
    mark : from the outline's extended data.
    outline : (k, 2), or (k, 3) with bulges where it has arcs, mm, moved so that its first corner
        is (0, 0).
    circles : (m, 3) rows x, y, diameter of its round holes, in order of x, moved alike, mm.
    """

    mark: str
    outline: Floats
    circles: Floats = field(default_factory=lambda: np.zeros((0, 3)))


def read_dxf(path: Path | str, process: Process | None = None) -> tuple[DxfPart, ...]:
    """Read the parts of a sheet back from the file; equal parts may share a mark.

    Parameters
    ----------
    process : the one it was written for; outlines that were drawn half a kerf outside are moved
        back.

    Raises
    ------
    FileError
        When the file is missing, is no DXF, is not in mm, or its cutting layer holds something
        that is not a closed outline with a mark.
    """
    process = Process() if process is None else process
    try:
        document = readfile(path)
    except (OSError, DXFError, ValueError, LookupError, StopIteration) as error:
        raise FileError("The sheet cannot be read", where=str(path), value=str(error)) from None
    if document.dxfversion > "AC1009" and document.units != units.MM:
        raise FileError("The sheet is not in mm", where=str(path), value=f"{document.units}")
    contours: list[tuple[str, Floats]] = []
    circles: list[tuple[str, tuple[float, float, float]]] = []
    for entity in document.modelspace():
        if process.layers.key(entity.dxf.layer) not in ("cut", "drill"):
            continue
        mark = _mark(path, entity)
        if isinstance(entity, Circle):
            x, y, _ = entity.dxf.center
            circles.append((mark, (x, y, 2.0 * (entity.dxf.radius + process.offset))))
        else:
            contours.append((mark, moved_out(_contour(path, entity), -process.offset)))
    holes: list[list[tuple[float, float, float]]] = [[] for _ in contours]
    for mark, circle in circles:
        around = [
            k for k, (name, rows) in enumerate(contours) if name == mark and _holds(rows, circle)
        ]
        if not around:
            raise FileError("A hole lies in no part", where=f"{path}, {mark}")
        holes[around[0]].append(circle)
    return tuple(_part(*named, own) for named, own in zip(contours, holes, strict=True))


def _holds(contour: Floats, circle: tuple[float, float, float]) -> bool:
    """Whether a circle's middle lies in the box of an outline: parts of one mark lie apart."""
    low, high = contour[:, :2].min(axis=0), contour[:, :2].max(axis=0)
    middle = np.array(circle[:2])
    return bool((low <= middle).all() and (middle <= high).all())


def _part(mark: str, contour: Floats, holes: Sequence[tuple[float, float, float]]) -> DxfPart:
    origin = np.r_[contour[0, :2], 0.0]
    circles = np.array(sorted(holes)).reshape(-1, 3) - origin
    outline = contour - origin
    return DxfPart(mark, outline if outline[:, 2].any() else outline[:, :2], circles)


def _mark(path: Path | str, entity: DXFEntity) -> str:
    """The mark of the part that *entity* belongs to."""
    closed = (
        isinstance(entity, Circle)
        or (isinstance(entity, LWPolyline) and entity.closed)
        or (isinstance(entity, Polyline) and entity.is_2d_polyline and entity.is_closed)
    )
    if not (closed and entity.has_xdata(APPLICATION)):
        raise FileError(
            "Something on the cutting layer is no closed outline with a mark",
            where=f"{path}, {entity}",
        )
    marks = [str(tag.value) for tag in entity.get_xdata(APPLICATION) if tag.code == 1000]
    if not marks:
        raise FileError("An outline is incomplete", where=f"{path}, {entity}")
    return marks[0]


def _contour(path: Path | str, entity: Any) -> Floats:
    """(k, 3) corners with bulges."""
    if isinstance(entity, Polyline):
        rows = [(*v.dxf.location.vec2, v.dxf.get("bulge", 0.0)) for v in entity.vertices]
    else:
        rows = entity.get_points("xyb")
    points = np.array(rows, dtype=np.float64)
    if len(points) < 3:
        raise FileError("An outline is incomplete", where=f"{path}, {entity}")
    return points
