"""Public names of fabrication, each by the module that holds it."""

from .checks import check as check
from .export.dxf import read_dxf as read_dxf, write_dxf as write_dxf
from .export.report import write_report as write_report
from .export.schedule import write_schedule as write_schedule
from .export.step import assembly as assembly, write_step as write_step
from .export.step_reader import read_step as read_step
from .finding import Finding as Finding, Severity as Severity
from .fitting import Fit as Fit, fit as fit
from .joints import JOINTS as JOINTS, Joint as Joint, SlotJoint as SlotJoint
from .lamella import Lamella as Lamella
from .loop import Closure as Closure, closure as closure
from .nesting import NestedSheet as NestedSheet, nest as nest
from .node import Node as Node
from .package import run as run
from .parts import FlatPart as FlatPart, flat_parts as flat_parts
from .project import Project as Project, read_project as read_project
from .solid import solids as solids
from .stock import (
    BIRCH_PLY as BIRCH_PLY,
    S235 as S235,
    STAINLESS as STAINLESS,
    Material as Material,
    Profile as Profile,
    Sheet as Sheet,
)
from .structures import Structure as Structure, structure as structure
from .unroll import Development as Development, unroll as unroll
