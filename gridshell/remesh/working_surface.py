"""Any surface made ready to be remeshed: triangles fine enough, their curvature, a reference."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.errors import SettingError
from gridshell.surface import (
    AnalyticSurface,
    BrepSurface,
    CurvedMesh,
    Remark,
    SmoothSurface,
    Surface,
    TriangulatedSurface,
    sound_mesh,
    tessellate,
    working_mesh,
)

FINE = 16.0
"""Triangles per quad of a tessellation made for the purpose."""

_LEAST, _MOST = 8_000, 60_000
_EQUILATERAL = np.sqrt(3.0) / 4.0

Source = TriangulatedSurface | BrepSurface | AnalyticSurface | CurvedMesh
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
        made = working_mesh(mesh, quads=quads)
        return WorkingSurface(
            made.curved, SmoothSurface(made.curved), False, (*remarks, *made.remarks)
        )
    faces = float(np.clip(FINE * quads, _LEAST, _MOST))
    if isinstance(source, BrepSurface):
        return WorkingSurface(source.curved_mesh(_edge(source.area, faces)), source, True)
    coarse = tessellate(source, edge=source.length_scale / 20.0)
    edge = _edge(float(coarse.mesh.areas.sum()), faces)
    return WorkingSurface(tessellate(source, edge=edge), source, True)


def _edge(area: float, triangles: float) -> float:
    return float(np.sqrt(area / (triangles * _EQUILATERAL)))


