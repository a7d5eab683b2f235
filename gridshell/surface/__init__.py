"""Design surfaces: the protocol a net is kept close to, and exact surfaces given by formula."""

from gridshell.surface.analytic import AnalyticSurface, Domain
from gridshell.surface.analytic_revolution import (
    Catenoid,
    Hyperboloid,
    RevolutionSurface,
    Sphere,
    Torus,
)
from gridshell.surface.analytic_shapes import Enneper, Helicoid, Hypar, Scherk
from gridshell.surface.brep import BrepSurface
from gridshell.surface.curved_mesh import CurvedMesh, face_shapes
from gridshell.surface.forms import Derivatives
from gridshell.surface.jets import CurvatureEstimate, curved_by_jets, estimated_curvature
from gridshell.surface.minimal import minimal_surface
from gridshell.surface.planar_mesher import mesh_domain
from gridshell.surface.smooth_surface import SmoothSurface, lift
from gridshell.surface.surface import Foot, Surface, checked_points
from gridshell.surface.surface_checks import Remark, aspects, sound_mesh
from gridshell.surface.tessellation import ParameterDisk, tessellate
from gridshell.surface.triangle_mesh import TriangleMesh
from gridshell.surface.triangulated import TriangulatedSurface
from gridshell.surface.working_mesh import working_mesh

__all__ = [
    "AnalyticSurface",
    "BrepSurface",
    "Catenoid",
    "CurvatureEstimate",
    "CurvedMesh",
    "Derivatives",
    "Domain",
    "Enneper",
    "Foot",
    "Helicoid",
    "Hypar",
    "Hyperboloid",
    "ParameterDisk",
    "Remark",
    "RevolutionSurface",
    "Scherk",
    "SmoothSurface",
    "Sphere",
    "Surface",
    "Torus",
    "TriangleMesh",
    "TriangulatedSurface",
    "aspects",
    "checked_points",
    "curved_by_jets",
    "estimated_curvature",
    "face_shapes",
    "lift",
    "mesh_domain",
    "minimal_surface",
    "sound_mesh",
    "tessellate",
    "working_mesh",
]
