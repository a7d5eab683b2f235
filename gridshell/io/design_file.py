"""The one door for design surfaces: triangles, B-rep faces, or boundary curves alone."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from gridshell.arrays import Indices, Points
from gridshell.errors import InputError
from gridshell.io.brep_file import load_with_scale, patch_of
from gridshell.io.curve_file import KERNEL, loops_of, read_curves
from gridshell.io.obj import Unit
from gridshell.io.surface_file import read_triangles
from gridshell.io.units import required_unit
from gridshell.surface import BrepSurface, TriangulatedSurface, minimal_surface, sound_mesh

_STATE_UNIT = (".step", ".stp", ".iges", ".igs")

TRIANGLES = 8_000
"""Of a minimal surface, when nothing else is asked for."""

_TEXT = (".csv", ".txt", ".xyz")
_FIRST = 40.0
"""Edges along the shortest curve of the surface that tells how large the area is."""

_EQUILATERAL = np.sqrt(3.0) / 4.0


def read_design(
    path: Path | str, *, unit: Unit | None = None, triangles: float = TRIANGLES
) -> TriangulatedSurface | BrepSurface:
    """Read a design surface from any file that holds one, mm.

    Meshes (OBJ with faces, PLY, STL, GLB) come as triangles, faces of STEP, IGES and BREP files
    exactly. Closed curves without a face (``l`` lines of an OBJ file, CSV, TXT, XYZ, edges of a
    B-rep) bound a minimal surface, which comes as triangles.

    Parameters
    ----------
    unit : STEP and IGES files state their own unit; it may be repeated here, not changed. Every
        other file needs one.
    triangles : about how many a minimal surface gets.

    Raises
    ------
    UnitError
        When a unit is needed and missing, or contradicts the file.
    FileError
        When the file cannot be read, or a boundary curve is not closed.
    SurfaceError
        One of its kinds: several patches, a solid, no area, no minimal surface.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix in KERNEL:
        from gridshell.surface.brep_kernel import has_faces

        shape, scale = load_with_scale(path, unit)
        if has_faces(shape):
            return patch_of(shape, scale)
        return _spanned(loops_of(path, shape, scale), triangles)
    unit = required_unit(path, unit, "The surface file")
    if suffix in _TEXT or (suffix == ".obj" and _only_lines(path)):
        return _spanned(read_curves(path, unit=unit), triangles)
    return _triangulated(*read_triangles(path, unit=unit))


def _triangulated(vertices: Points, triangles: Indices) -> TriangulatedSurface:
    """The triangles as they are or, where they make no surface so, mended."""
    try:
        return TriangulatedSurface(vertices, triangles)
    except InputError:
        mesh, _ = sound_mesh(vertices, triangles)  # the error by its own name and place
        return TriangulatedSurface(mesh.vertices, mesh.triangles)


def states_unit(path: Path | str) -> bool:
    """Whether files of this ending say themselves which unit they were drawn in."""
    return Path(path).suffix.lower() in _STATE_UNIT


def _only_lines(path: Path) -> bool:
    """Whether an OBJ file has line elements and no faces; False for one that cannot be read."""
    try:
        text = path.read_text(encoding="utf-8-sig", errors="replace")
    except OSError:
        return False
    faces, lines = (re.search(rf"^\s*{kind}\s", text, re.MULTILINE) for kind in "fl")
    return faces is None and lines is not None


def _spanned(loops: list[Points], triangles: float) -> TriangulatedSurface:
    """The minimal surface of *loops*; a coarse one first tells the area, and so the edge."""
    around = min(np.linalg.norm(x - np.roll(x, -1, axis=0), axis=1).sum() for x in loops)
    area = minimal_surface(loops, edge=float(around) / _FIRST).areas.sum()
    mesh = minimal_surface(loops, edge=float(np.sqrt(area / (triangles * _EQUILATERAL))))
    return TriangulatedSurface(mesh.vertices, mesh.triangles)
