"""Closed curves, the boundary of a surface to be found, as polylines in mm.

Three kinds of file: Wavefront OBJ with ``l`` elements; text with one point per line and one loop
per block, blocks apart by an empty line (CSV, XYZ, TXT); the edges of a STEP, IGES or BREP file
without faces. A loop may repeat its first point at the end or not, except that pieces that make a
loop together (OBJ lines, B-rep edges) are joined where their ends meet.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from gridshell.arrays import Floats, Points, frozen
from gridshell.errors import FileError, NotOnePatchError, SettingError, UnitError
from gridshell.io.brep_file import load_with_scale
from gridshell.io.obj import Unit

KERNEL = (".step", ".stp", ".iges", ".igs", ".brep", ".brp")
"""Endings of the files that the CAD kernel reads."""

_SAME = 1e-6
"""Points closer than this times the size of all curves are one."""


def read_curves(
    path: Path | str, *, unit: Unit | None = None, tolerance: float = 0.1
) -> list[Points]:
    """Read closed polylines, each (k, 3) in mm without the first point repeated.

    Parameters
    ----------
    unit : needed for OBJ, text and BREP; STEP and IGES state their own.
    tolerance : of chords from the curves of a B-rep, mm.

    Raises
    ------
    FileError
        When the file is missing or cannot be read, holds no curves, or a curve is not closed or
        has fewer than three points.
    UnitError
        When a unit is needed and missing, or contradicts the file.
    NotOnePatchError
        When a STEP, IGES or BREP file holds faces: that is a surface already.
    SettingError
        When *tolerance* is not positive.
    """
    path = Path(path)
    pieces = _pieces(path, unit, tolerance)
    if path.suffix.lower() in (".obj", *KERNEL):
        pieces = _joined(path, pieces)
    return [_closed(path, number, piece) for number, piece in enumerate(pieces)]


def loops_of(path: Path, shape: Any, scale: float, *, tolerance: float = 0.1) -> list[Points]:
    """The closed curves of a loaded kernel shape whose unit is *scale* mm, as `read_curves`."""
    pieces = _joined(path, _require_some(path, _of_shape(path, shape, scale, tolerance)))
    return [_closed(path, number, piece) for number, piece in enumerate(pieces)]


def read_polylines(
    path: Path | str, *, unit: Unit | None = None, tolerance: float = 0.1
) -> list[Points]:
    """Read polylines, open or closed, as they are drawn: (k, 3) each, mm.

    The same files as for `read_curves`; a closed one repeats its first point at the end.

    Raises
    ------
    FileError, UnitError, NotOnePatchError, SettingError
        As `read_curves` does, except for curves that are not closed.
    """
    return [frozen(piece) for piece in _pieces(Path(path), unit, tolerance)]


def _pieces(path: Path, unit: Unit | None, tolerance: float) -> list[Floats]:
    """What the file draws, mm."""
    suffix = path.suffix.lower()
    if suffix in KERNEL:
        return _require_some(path, _of_shape(path, *load_with_scale(path, unit), tolerance))
    if unit is None:
        raise UnitError(
            "A file of points states no unit",
            where=str(path),
            limit=", ".join(u.name.lower() for u in Unit),
            advice="give the unit the file was drawn in",
        )
    text = _text(path)
    found = _of_obj(path, text) if suffix == ".obj" else _of_text(path, text)
    return _require_some(path, [piece * unit.value for piece in found])


def _require_some(path: Path, pieces: list[Floats]) -> list[Floats]:
    if not pieces:
        raise FileError(
            "The file holds no curves", where=str(path), advice="export closed polylines"
        )
    return pieces


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8-sig", errors="replace")
    except OSError as error:
        raise FileError(
            "The curve file cannot be read",
            where=str(path),
            value=error.strerror or type(error).__name__,
            advice="check the path",
        ) from None


def _of_text(path: Path, text: str) -> list[Floats]:
    """One loop per block of lines ``x y z`` or ``x,y,z``; ``#`` starts a comment."""
    blocks: list[list[list[float]]] = [[]]
    for number, line in enumerate(text.splitlines(), start=1):
        if line.lstrip().startswith("#"):
            continue
        fields = line.partition("#")[0].replace(",", " ").replace(";", " ").split()
        if not fields:
            if blocks[-1]:
                blocks.append([])
            continue
        blocks[-1].append(_numbers(path, number, line, fields))
    return [np.array(block) for block in blocks if block]


def _of_obj(path: Path, text: str) -> list[Floats]:
    """The points of every ``l`` element."""
    vertices: list[list[float]] = []
    lines: list[tuple[int, list[int]]] = []
    for number, line in enumerate(text.replace("\\\n", " ").splitlines(), start=1):
        fields = line.partition("#")[0].split()
        if fields[:1] == ["v"]:
            vertices.append(_numbers(path, number, line, fields[1:4]))
        elif fields[:1] == ["l"]:
            try:
                indices = [int(field.split("/")[0]) for field in fields[1:]]
            except ValueError:
                raise _unreadable(path, number, line) from None
            lines.append((number, [i - 1 if i > 0 else len(vertices) + i for i in indices]))
    for number, indices in lines:
        wrong = [i for i in indices if not 0 <= i < len(vertices)]
        if wrong:
            raise FileError(
                "A line names a vertex that does not exist",
                where=f"{path}, line {number}",
                value=f"vertex {wrong[0] + 1}",
                limit=f"1 .. {len(vertices)}",
            )
    return [np.array(vertices)[indices] for _, indices in lines if len(indices) > 1]


def _of_shape(path: Path, shape: Any, scale: float, tolerance: float) -> list[Floats]:
    from gridshell.surface.brep_kernel import curves_of, has_faces

    if not tolerance > 0.0:
        raise SettingError(
            "A tolerance must be positive",
            where="tolerance",
            value=f"{tolerance} mm",
            limit="> 0 mm",
        )
    if has_faces(shape):
        raise NotOnePatchError(
            "The file holds faces, not only curves",
            where=str(path),
            advice="read it as a surface, or export the boundary curves alone",
        )
    return [_chords(curve.point, tolerance / scale) * scale for curve in curves_of(shape)]


def _chords(point: Callable[[Floats], Floats], tolerance: float) -> Floats:
    """Points of a curve over t in 0 .. 1 whose chords stay within *tolerance* of it."""
    count = 8
    while count < 4096:
        t = np.linspace(0.0, 1.0, 2 * count + 1)
        x = point(t)
        off = np.linalg.norm(x[1::2] - (x[:-1:2] + x[2::2]) / 2.0, axis=1).max()
        if off <= tolerance:
            break
        count *= 2
    return x[::2]


def _joined(path: Path, pieces: list[Floats]) -> list[Floats]:
    """Pieces put end to end, each turned round where needed, until every one is a loop."""
    everything = np.concatenate(pieces)
    near = _SAME * float(np.linalg.norm(np.ptp(everything, axis=0)))
    loops, waiting = [], list(pieces)
    while waiting:
        chain = waiting.pop(0)
        while np.linalg.norm(chain[0] - chain[-1]) > near:
            for number, piece in enumerate(waiting):
                if np.linalg.norm(piece[0] - chain[-1]) <= near:
                    following = piece
                elif np.linalg.norm(piece[-1] - chain[-1]) <= near:
                    following = piece[::-1]
                else:
                    continue
                chain = np.concatenate([chain, following[1:]])
                del waiting[number]
                break
            else:
                raise FileError(
                    "A curve is not closed",
                    where="{}, end ({:.6g}, {:.6g}, {:.6g}) mm".format(path, *chain[-1]),
                    value=f"{np.linalg.norm(chain[0] - chain[-1]):.6g} mm from its start",
                    limit=f"{near:.3g} mm",
                    advice="close the boundary in the modeller",
                )
        loops.append(chain)
    return loops


def _closed(path: Path, number: int, points: Floats) -> Points:
    """A loop without doubled neighbours, the first point not repeated."""
    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    gaps = np.linalg.norm(points - np.roll(points, -1, axis=0), axis=1)
    points = points[gaps > _SAME * size]
    if len(points) < 3:
        raise FileError(
            "A loop needs three points or more",
            where=f"{path}, loop {number}",
            value=f"{len(points)} points",
            advice="leave an empty line between loops only",
        )
    return frozen(points)


def _numbers(path: Path, number: int, line: str, fields: list[str]) -> list[float]:
    try:
        x, y, z = (float(field) for field in fields)
    except ValueError:
        raise _unreadable(path, number, line) from None
    if not np.isfinite((x, y, z)).all():
        raise _unreadable(path, number, line)
    return [x, y, z]


def _unreadable(path: Path, number: int, line: str) -> FileError:
    return FileError(
        "A line cannot be read",
        where=f"{path}, line {number}",
        value=repr(line[:60]),
        limit="x y z",
    )
