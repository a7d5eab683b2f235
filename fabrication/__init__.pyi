"""Public names of fabrication, each by the module that holds it."""

from .beam_layout import Beam as Beam
from .beam_layout import BeamEnd as BeamEnd
from .beam_layout import BeamSection as BeamSection
from .beam_layout import beams as beams
from .bodies import structure_bodies as structure_bodies
from .checks import check as check
from .connector import Arm as Arm
from .connector import Connector as Connector
from .connector import ConnectorSpec as ConnectorSpec
from .connector import connector_findings as connector_findings
from .connector import connector_groups as connector_groups
from .connector import connectors as connectors
from .connector_pieces import StarSpec as StarSpec
from .cut import Relief as Relief
from .export.dxf import read_dxf as read_dxf
from .export.dxf import write_dxf as write_dxf
from .export.report import write_report as write_report
from .export.schedule import write_schedule as write_schedule
from .export.step import assembly as assembly
from .export.step import write_step as write_step
from .export.step_bodies import write_bodies as write_bodies
from .export.step_prism_reader import read_prisms as read_prisms
from .export.step_reader import read_step as read_step
from .facade import DiagonalRule as DiagonalRule
from .facade import Facade as Facade
from .facade import triangulated_facade as triangulated_facade
from .finding import Finding as Finding
from .finding import Severity as Severity
from .fitting import Fit as Fit
from .fitting import fit as fit
from .grouping import Group as Group
from .grouping import Member as Member
from .grouping import instance_frame as instance_frame
from .jointed import BillLine as BillLine
from .jointed import Feature as Feature
from .jointed import Fixture as Fixture
from .jointed import Jointed as Jointed
from .joints import JOINTS as JOINTS
from .joints import AnglePlay as AnglePlay
from .joints import Cleat as Cleat
from .joints import DoubleSlotJoint as DoubleSlotJoint
from .joints import Joint as Joint
from .joints import ReciprocalJoint as ReciprocalJoint
from .joints import ScissorJoint as ScissorJoint
from .joints import SlotJoint as SlotJoint
from .joints import StarWasher as StarWasher
from .joints import angle_play as angle_play
from .lamella import Lamella as Lamella
from .loop import Closure as Closure
from .loop import closure as closure
from .nesting import NestedSheet as NestedSheet
from .nesting import nest as nest
from .node import Node as Node
from .outlines import Frame as Frame
from .package import run as run
from .panel import Panel as Panel
from .panel import PanelSpec as PanelSpec
from .panel import panel_findings as panel_findings
from .panel import panel_groups as panel_groups
from .panel import panels as panels
from .panel_loop import PanelClosure as PanelClosure
from .panel_loop import panel_closure as panel_closure
from .panel_structure import PanelStructure as PanelStructure
from .panel_structure import PanelSystem as PanelSystem
from .panel_structure import panelled as panelled
from .parts import FlatPart as FlatPart
from .parts import flat_parts as flat_parts
from .parts import parts_of as parts_of
from .project import project_text as project_text
from .project import read_project as read_project
from .sections import Project as Project
from .shapes import Bodies as Bodies
from .sheet_parts import panel_piece as panel_piece
from .sheet_parts import plate_piece as plate_piece
from .sheet_parts import star_piece as star_piece
from .solid import solids as solids
from .stock import (
    BIRCH_PLY as BIRCH_PLY,
)
from .stock import GLASS as GLASS
from .stock import (
    S235 as S235,
)
from .stock import (
    STAINLESS as STAINLESS,
)
from .stock import (
    Material as Material,
)
from .stock import (
    Profile as Profile,
)
from .stock import (
    Sheet as Sheet,
)
from .structures import Structure as Structure
from .structures import structure as structure
from .support import PlateSection as PlateSection
from .support import SupportPlate as SupportPlate
from .support import TwistCost as TwistCost
from .support import plate_groups as plate_groups
from .support import support_findings as support_findings
from .support import supports as supports
from .support import twist_cost as twist_cost
from .unroll import Development as Development
from .unroll import unroll as unroll
