"""CurvedMesh: triangles with the normal and the shape operator of the surface they stand for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gridshell.arrays import Floats, Vectors, frozen, unit
from gridshell.errors import SurfaceError
from gridshell.surface.triangle_mesh import TriangleMesh


@dataclass(frozen=True, eq=False)
class CurvedMesh:
    """A triangle mesh whose curvature is known.

    Parameters
    ----------
    mesh : the triangles.
    normals : (n, 3) unit normals of the surface at the vertices, on the mesh's positive side.
    shapes : (n, 3, 3) symmetric shape operators at the vertices, 1/mm, zero along the normal:
        ``t . S t`` is the normal curvature in the unit tangent direction t, positive where the
        surface bends towards the normal.
    face_shapes : (f, 3) components 11, 12, 22 of the shape operator of every triangle in the first
        two rows of ``mesh.face_frames``, 1/mm.

    Raises
    ------
    SurfaceError
        When the four do not belong together.
    """

    mesh: TriangleMesh
    normals: Vectors
    shapes: Floats
    face_shapes: Floats

    def __post_init__(self) -> None:
        n, f = len(self.mesh.vertices), len(self.mesh.triangles)
        expected = {"normals": (n, 3), "shapes": (n, 3, 3), "face_shapes": (f, 3)}
        for key, shape in expected.items():
            object.__setattr__(self, key, frozen(getattr(self, key)))
            found = getattr(self, key)
            if found.shape != shape or not np.isfinite(found).all():
                raise SurfaceError(
                    "The curvature does not belong to the mesh",
                    where=key,
                    value=f"shape {found.shape}",
                    limit=f"{shape}, finite",
                )

    @classmethod
    def of_vertices(cls, mesh: TriangleMesh, normals: Vectors, shapes: Floats) -> CurvedMesh:
        """The shape of a triangle is the mean of its corners', each turned into its plane."""
        return cls(mesh, normals, shapes, face_shapes(mesh, normals, shapes))

    @property
    def largest_curvature(self) -> float:
        """Largest principal curvature by amount over the triangles, 1/mm."""
        a, b, c = self.face_shapes.T
        return float((np.abs((a + c) / 2.0) + np.hypot((a - c) / 2.0, b)).max())


def face_shapes(mesh: TriangleMesh, normals: Vectors, shapes: Floats) -> Floats:
    """(f, 3) components 11, 12, 22 of vertex operators (n, 3, 3) carried onto the triangles.

    The normal of each corner is turned onto the triangle's by the smallest rotation.
    """
    face_normals, tangents = mesh.face_normals, mesh.face_frames[:, :2]
    total = np.zeros((len(mesh.triangles), 3))
    for k in range(3):
        v = mesh.triangles[:, k]
        axis = np.cross(face_normals, normals[v])
        turn = np.einsum("fc,fc->f", face_normals, normals[v])
        # Rodrigues' rotation of the tangents from the triangle's plane into the vertex's
        carried = (
            tangents * turn[:, None, None]
            + np.cross(axis[:, None], tangents)
            + axis[:, None]
            * (np.einsum("fc,fic->fi", axis, tangents) / (1.0 + turn)[:, None])[..., None]
        )
        e1, e2 = unit(carried[:, 0]), unit(carried[:, 1])
        s1 = np.einsum("fij,fj->fi", shapes[v], e1)
        s2 = np.einsum("fij,fj->fi", shapes[v], e2)
        total[:, 0] += np.einsum("fi,fi->f", e1, s1)
        total[:, 1] += np.einsum("fi,fi->f", e1, s2)
        total[:, 2] += np.einsum("fi,fi->f", e2, s2)
    return total / 3.0
