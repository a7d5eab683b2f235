"""Public names of gridshell, each by the module that holds it."""

from .anchors import (
    Anchor as Anchor,
    BoundaryGlide as BoundaryGlide,
    BoundaryPinned as BoundaryPinned,
    Free as Free,
    Pinned as Pinned,
)
from .curvature import (
    principal_curvatures as principal_curvatures,
    require_hyperbolic as require_hyperbolic,
)
from .errors import (
    ColouringError as ColouringError,
    FileError as FileError,
    GridshellError as GridshellError,
    InputError as InputError,
    MeshError as MeshError,
    NonManifoldError as NonManifoldError,
    NotHyperbolicError as NotHyperbolicError,
    OddValenceError as OddValenceError,
    OrientationError as OrientationError,
    SettingError as SettingError,
    SolveError as SolveError,
    SurfaceError as SurfaceError,
)
from .io import (
    Unit as Unit,
    read_net as read_net,
    read_obj as read_obj,
    write_net as write_net,
    write_obj as write_obj,
)
from .mesh import (
    CheckerboardPattern as CheckerboardPattern,
    ControlMesh as ControlMesh,
    DiagonalMesh as DiagonalMesh,
    Polyline as Polyline,
    QuadMesh as QuadMesh,
    Stars as Stars,
    as_control_mesh as as_control_mesh,
    checkerboard as checkerboard,
    control_mesh as control_mesh,
    diagonal_meshes as diagonal_meshes,
    diagonal_stars as diagonal_stars,
    edge_stars as edge_stars,
    oriented as oriented,
    polylines as polylines,
    two_colouring as two_colouring,
)
from .optimization import OptimizedNet as OptimizedNet, optimize as optimize
from .patch import (
    AsymptoticPatch as AsymptoticPatch,
    BisectingPatch as BisectingPatch,
    Patch as Patch,
    control_patch as control_patch,
)
from .quality import (
    NetQuality as NetQuality,
    Spread as Spread,
    net_quality as net_quality,
    node_angles as node_angles,
)
from .recipes import (
    ANet as ANet,
    PaperANet as PaperANet,
    Recipe as Recipe,
    a_net as a_net,
    paper_a_net as paper_a_net,
)
from .solve import Progress as Progress, Step as Step
from .surface import (
    AnalyticSurface as AnalyticSurface,
    Catenoid as Catenoid,
    Enneper as Enneper,
    Foot as Foot,
    Helicoid as Helicoid,
    Hypar as Hypar,
    Hyperboloid as Hyperboloid,
    Scherk as Scherk,
    Sphere as Sphere,
    Surface as Surface,
    Torus as Torus,
)
