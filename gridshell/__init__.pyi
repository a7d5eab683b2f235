"""Public names of gridshell, each by the module that holds it."""

from .anchors import (
    Anchor as Anchor,
)
from .anchors import (
    BoundaryGlide as BoundaryGlide,
)
from .anchors import (
    BoundaryPinned as BoundaryPinned,
)
from .anchors import (
    Free as Free,
)
from .anchors import (
    Pinned as Pinned,
)
from .angle_fields import AngleAlong as AngleAlong
from .angle_fields import FormulaAngle as FormulaAngle
from .angle_fields import RadialAngle as RadialAngle
from .angle_fields import SampledAngle as SampledAngle
from .angles import Angle as Angle
from .coarse_to_fine import coarser as coarser
from .coarse_to_fine import finer as finer
from .coarse_to_fine import optimize_coarse_to_fine as optimize_coarse_to_fine
from .conditions import AngleBetween as AngleBetween
from .conditions import Condition as Condition
from .conditions import EdgeLengths as EdgeLengths
from .conditions import FlatRim as FlatRim
from .conditions import MirrorPlane as MirrorPlane
from .conditions import NearRhombi as NearRhombi
from .curvature import (
    principal_curvatures as principal_curvatures,
)
from .curvature import (
    require_hyperbolic as require_hyperbolic,
)
from .errors import AngleInfeasibleError as AngleInfeasibleError
from .errors import (
    ColouringError as ColouringError,
)
from .errors import DegenerateSurfaceError as DegenerateSurfaceError
from .errors import DisconnectedError as DisconnectedError
from .errors import (
    FileError as FileError,
)
from .errors import FlatSurfaceError as FlatSurfaceError
from .errors import (
    GridshellError as GridshellError,
)
from .errors import (
    InputError as InputError,
)
from .errors import (
    MeshError as MeshError,
)
from .errors import NoisyInputError as NoisyInputError
from .errors import NoMinimalSurfaceError as NoMinimalSurfaceError
from .errors import (
    NonManifoldError as NonManifoldError,
)
from .errors import (
    NotHyperbolicError as NotHyperbolicError,
)
from .errors import NotOnePatchError as NotOnePatchError
from .errors import (
    OddValenceError as OddValenceError,
)
from .errors import (
    OrientationError as OrientationError,
)
from .errors import PoleSingularityError as PoleSingularityError
from .errors import PoorTriangulationError as PoorTriangulationError
from .errors import SelfIntersectionError as SelfIntersectionError
from .errors import (
    SettingError as SettingError,
)
from .errors import (
    SolveError as SolveError,
)
from .errors import (
    SurfaceError as SurfaceError,
)
from .errors import TooManySingularitiesError as TooManySingularitiesError
from .errors import UmbilicRegionError as UmbilicRegionError
from .errors import UnitError as UnitError
from .field import FrameField as FrameField
from .field import Guide as Guide
from .field import Hand as Hand
from .field import Infeasible as Infeasible
from .io import (
    Unit as Unit,
)
from .io import read_brep as read_brep
from .io import read_compas as read_compas
from .io import read_curves as read_curves
from .io import read_design as read_design
from .io import read_mesh as read_mesh
from .io import (
    read_net as read_net,
)
from .io import (
    read_obj as read_obj,
)
from .io import read_polylines as read_polylines
from .io import read_rhino as read_rhino
from .io import read_state as read_state
from .io import read_surface as read_surface
from .io import states_unit as states_unit
from .io import (
    write_net as write_net,
)
from .io import (
    write_obj as write_obj,
)
from .io import write_state as write_state
from .mechanism import Mechanism as Mechanism
from .mechanism import quads_of as quads_of
from .mesh import (
    CheckerboardPattern as CheckerboardPattern,
)
from .mesh import (
    ControlMesh as ControlMesh,
)
from .mesh import (
    DiagonalMesh as DiagonalMesh,
)
from .mesh import PanelMesh as PanelMesh
from .mesh import (
    Polyline as Polyline,
)
from .mesh import (
    QuadMesh as QuadMesh,
)
from .mesh import Skin as Skin
from .mesh import (
    Stars as Stars,
)
from .mesh import (
    as_control_mesh as as_control_mesh,
)
from .mesh import averaged_normals as averaged_normals
from .mesh import (
    checkerboard as checkerboard,
)
from .mesh import (
    control_mesh as control_mesh,
)
from .mesh import (
    diagonal_meshes as diagonal_meshes,
)
from .mesh import (
    diagonal_stars as diagonal_stars,
)
from .mesh import (
    edge_stars as edge_stars,
)
from .mesh import main_piece as main_piece
from .mesh import node_axes as node_axes
from .mesh import (
    oriented as oriented,
)
from .mesh import panel_mesh as panel_mesh
from .mesh import (
    polylines as polylines,
)
from .mesh import skin as skin
from .mesh import (
    two_colouring as two_colouring,
)
from .mesh import without_families as without_families
from .net_report import history_report as history_report
from .net_report import net_report as net_report
from .optimization import OptimizedNet as OptimizedNet
from .optimization import optimize as optimize
from .panel_families import PanelFamilies as PanelFamilies
from .panel_families import cluster_panels as cluster_panels
from .panel_families import own_variation as own_variation
from .panel_families import panel_curvatures as panel_curvatures
from .panel_families import panel_curvatures_from_mesh as panel_curvatures_from_mesh
from .patch import (
    AsymptoticPatch as AsymptoticPatch,
)
from .patch import (
    BisectingPatch as BisectingPatch,
)
from .patch import (
    ConjugatePatch as ConjugatePatch,
)
from .patch import (
    Patch as Patch,
)
from .patch import SingularPatch as SingularPatch
from .patch import (
    control_patch as control_patch,
)
from .quad_figures import (
    QuadFigures as QuadFigures,
)
from .quad_figures import (
    quad_figures as quad_figures,
)
from .quality import NetFigures as NetFigures
from .quality import (
    NetQuality as NetQuality,
)
from .quality import (
    Spread as Spread,
)
from .quality import (
    measured_against as measured_against,
)
from .quality import net_figures as net_figures
from .quality import (
    net_quality as net_quality,
)
from .quality import (
    node_angles as node_angles,
)
from .recipes import (
    NetRecipe as NetRecipe,
)
from .recipes import (
    PaperRecipe as PaperRecipe,
)
from .recipes import (
    Recipe as Recipe,
)
from .recipes import (
    a_net as a_net,
)
from .recipes import (
    paper_a_net as paper_a_net,
)
from .recipes import (
    paper_pq_net as paper_pq_net,
)
from .recipes import (
    pq_net as pq_net,
)
from .recipes import (
    principal_symmetric_net as principal_symmetric_net,
)
from .remesh import Asymptotic as Asymptotic
from .remesh import Conjugate as Conjugate
from .remesh import Directions as Directions
from .remesh import Extent as Extent
from .remesh import Given as Given
from .remesh import Principal as Principal
from .remesh import Quadrangulation as Quadrangulation
from .remesh import RemeshReport as RemeshReport
from .remesh import WorkingSurface as WorkingSurface
from .remesh import quadrangulate as quadrangulate
from .remesh import working_surface as working_surface
from .ring_layers import umbrella_of as umbrella_of
from .solve import End as End
from .solve import Engine as Engine
from .solve import Progress as Progress
from .solve import State as State
from .solve import Step as Step
from .solve import Stop as Stop
from .solve import Weight as Weight
from .solve import Workspace as Workspace
from .soundness import remarks as remarks
from .soundness import require_sound as require_sound
from .supports import stand_on as stand_on
from .surface import (
    AnalyticSurface as AnalyticSurface,
)
from .surface import BrepSurface as BrepSurface
from .surface import (
    Catenoid as Catenoid,
)
from .surface import CurvedMesh as CurvedMesh
from .surface import (
    Enneper as Enneper,
)
from .surface import (
    Foot as Foot,
)
from .surface import (
    Helicoid as Helicoid,
)
from .surface import (
    Hypar as Hypar,
)
from .surface import (
    Hyperboloid as Hyperboloid,
)
from .surface import ParameterDisk as ParameterDisk
from .surface import Remark as Remark
from .surface import (
    Scherk as Scherk,
)
from .surface import SmoothSurface as SmoothSurface
from .surface import (
    Sphere as Sphere,
)
from .surface import (
    Surface as Surface,
)
from .surface import (
    Torus as Torus,
)
from .surface import TriangleMesh as TriangleMesh
from .surface import TriangulatedSurface as TriangulatedSurface
from .surface import minimal_surface as minimal_surface
from .surface import sound_mesh as sound_mesh
from .surface import tessellate as tessellate
from .terms import (
    Planarity as Planarity,
)
from .torsion_free import TorsionFreeAxes as TorsionFreeAxes
from .torsion_free import torsion_free_axes as torsion_free_axes
from .umbrella import Cable as Cable
from .umbrella import Position as Position
from .umbrella import Umbrella as Umbrella
from .verdict import Verdict as Verdict
