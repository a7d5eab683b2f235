"""gridshell: from a surface to a net of curves that can be built.

The pipeline, in the paper's words (Jiang, Wang, Schling and Pottmann, AAG 2020)::

    surface  = Enneper(scale=4000.0)                            a surface S, mm
    control  = control_patch(surface, patch)                    the control mesh C on it
    recipe   = a_net(angle=radians(60))                         planar stars (7), node angle (4)
    result   = optimize(control, recipe, anchor=Free())         Levenberg-Marquardt
    net, _   = diagonal_meshes(result.require().control)        D1 and D2
    quality  = result.quality                                   what the net is judged by

A quad mesh drawn elsewhere enters through ``read_obj`` and ``as_control_mesh`` (its diagonals
become the net) or ``control_mesh`` (its edges do). Lengths are mm, angles radians, arrays frozen.
"""

from gridshell.anchors import Anchor, BoundaryGlide, BoundaryPinned, Free, Pinned
from gridshell.curvature import principal_curvatures
from gridshell.errors import (
    ColouringError,
    FileError,
    GridshellError,
    InputError,
    MeshError,
    NonManifoldError,
    NotHyperbolicError,
    OddValenceError,
    OrientationError,
    SettingError,
    SolveError,
    SurfaceError,
)
from gridshell.io import Unit, read_net, read_obj, write_net, write_obj
from gridshell.mesh import (
    CheckerboardPattern,
    ControlMesh,
    DiagonalMesh,
    Polyline,
    QuadMesh,
    Stars,
    as_control_mesh,
    checkerboard,
    control_mesh,
    diagonal_meshes,
    diagonal_stars,
    edge_stars,
    oriented,
    polylines,
    two_colouring,
)
from gridshell.optimize import OptimizedNet, optimize
from gridshell.patch import AsymptoticPatch, BisectingPatch, Patch, control_patch
from gridshell.quality import NetQuality, Spread, net_quality, node_angles
from gridshell.recipes import ANet, PaperANet, Recipe, a_net, paper_a_net
from gridshell.solve import Progress, Step
from gridshell.surface import (
    AnalyticSurface,
    Catenoid,
    Enneper,
    Foot,
    Helicoid,
    Hypar,
    Hyperboloid,
    Scherk,
    Sphere,
    Surface,
    Torus,
)

__all__ = [
    "ANet",
    "AnalyticSurface",
    "Anchor",
    "AsymptoticPatch",
    "BisectingPatch",
    "BoundaryGlide",
    "BoundaryPinned",
    "Catenoid",
    "CheckerboardPattern",
    "ColouringError",
    "ControlMesh",
    "DiagonalMesh",
    "Enneper",
    "FileError",
    "Foot",
    "Free",
    "GridshellError",
    "Helicoid",
    "Hypar",
    "Hyperboloid",
    "InputError",
    "MeshError",
    "NetQuality",
    "NonManifoldError",
    "NotHyperbolicError",
    "OddValenceError",
    "OptimizedNet",
    "OrientationError",
    "PaperANet",
    "Patch",
    "Pinned",
    "Polyline",
    "Progress",
    "QuadMesh",
    "Recipe",
    "Scherk",
    "SettingError",
    "SolveError",
    "Sphere",
    "Spread",
    "Stars",
    "Step",
    "Surface",
    "SurfaceError",
    "Torus",
    "Unit",
    "a_net",
    "as_control_mesh",
    "checkerboard",
    "control_mesh",
    "control_patch",
    "diagonal_meshes",
    "diagonal_stars",
    "edge_stars",
    "net_quality",
    "node_angles",
    "optimize",
    "oriented",
    "paper_a_net",
    "polylines",
    "principal_curvatures",
    "read_net",
    "read_obj",
    "two_colouring",
    "write_net",
    "write_obj",
]
