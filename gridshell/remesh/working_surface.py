"""Any surface made ready to be remeshed: triangles fine enough, their curvature, a reference."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.errors import SettingError
from gridshell.surface import (
    BrepSurface,
    CurvatureEstimate,
    CurvedMesh,
    Remark,
    SmoothSurface,
    Surface,
    TriangulatedSurface,
    sound_mesh,
    working_mesh,
)

FINE = 16.0
"""Triangles per quad of a tessellation made for the purpose."""

_LEAST, _MOST = 8_000, 60_000
_ROUGH = 5e-3
"""Median residual over the edge, above which a cubic follows the surface poorly."""

_EQUILATERAL = np.sqrt(3.0) / 4.0

Source = TriangulatedSurface | BrepSurface | CurvedMesh
"""What can be remeshed."""


@dataclass(frozen=True, eq=False)
class WorkingSurface:
    """A surface ready to be remeshed.

    Parameters
    ----------
    curved : triangles with their curvature.
    reference : the surface itself: nets are kept close to it.
    exact : whether curvature and reference are those of a formula or of NURBS.
    remarks : what was mended on the way.
    """

    curved: CurvedMesh
    reference: Surface
    exact: bool
    remarks: tuple[Remark, ...] = ()


def working_surface(source: Source, *, quads: float) -> WorkingSurface:
    """Make *source* ready for about *quads* quads.

    Raises
    ------
    SettingError
        When *quads* is not positive.
    SurfaceError
        For triangles that do not make one sound, smooth surface; see
        :func:`gridshell.surface.sound_mesh`.
    """
    if not (np.isfinite(quads) and quads > 0.0):
        raise SettingError("The number of quads must be positive", where="quads", value=f"{quads}")
    if isinstance(source, CurvedMesh):
        return WorkingSurface(source, SmoothSurface(source), False)
    if isinstance(source, TriangulatedSurface):
        mesh, remarks = sound_mesh(source.vertices, source.triangles)
        made = working_mesh(mesh, quads=max(1, round(quads)))
        remarks = (*remarks, *_about(made))
        return WorkingSurface(made.curved, SmoothSurface(made.curved), False, remarks)
    faces = float(np.clip(FINE * quads, _LEAST, _MOST))
    return WorkingSurface(source.curved_mesh(_edge(source.area, faces)), source, True)


def area_of(source: Source) -> float:
    """Area, mm2; of B-rep faces to about a per cent."""
    if isinstance(source, BrepSurface):
        return source.area
    if isinstance(source, CurvedMesh):
        return float(source.mesh.areas.sum())
    a, b, c = np.moveaxis(source.vertices[source.triangles], 1, 0)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2.0)


def _about(made: CurvatureEstimate) -> list[Remark]:
    """What is to be known of an estimated curvature."""
    found = []
    if made.noisy:
        message = (
            f"the vertices scatter by {made.noise:.1%} of an edge; the curvature was smoothed over "
            f"{made.rings} rings, the vertices put on the fitted surface"
        )
        found.append(Remark("noise", message, made.noise))
    rough = float(np.median(made.residual))
    if not made.noisy and rough > _ROUGH:
        message = "the triangles are too coarse to tell the curvature well: use more of them"
        found.append(Remark("coarse-triangles", message, rough))
    return found


def _edge(area: float, triangles: float) -> float:
    return float(np.sqrt(area / (triangles * _EQUILATERAL)))
