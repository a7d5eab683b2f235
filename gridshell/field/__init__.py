"""Direction fields: which two families of lines a quad mesh shall follow on a surface.

`principal_field`, `asymptotic_field` and `conjugate_field` read the pair off the curvature, `Guide`
lines decide where curvature does not, and `directions_field` takes any other pair. `singularities`
finds where the families turn, `cleaned` makes these points ready for a quad mesh of a given edge,
and `alignment` measures afterwards how well that mesh follows.
"""

from gridshell.field.alignment import alignment, lines_at
from gridshell.field.asymptotic import asymptotic_field
from gridshell.field.checks import require_curvature, require_few_singularities
from gridshell.field.cleaning import cleaned, merge_singularities
from gridshell.field.conjugate import Hand, Infeasible, conjugate_field
from gridshell.field.directions import directions_field
from gridshell.field.frame_field import (
    FrameField,
    Matching,
    Singularities,
    matching,
    singularities,
    transport,
)
from gridshell.field.guides import Guide, confidence
from gridshell.field.principal import principal_field
from gridshell.field.refinement import Refined, split_links
from gridshell.field.report import FieldReport, field_report

__all__ = [
    "FieldReport",
    "FrameField",
    "Guide",
    "Hand",
    "Infeasible",
    "Matching",
    "Refined",
    "Singularities",
    "alignment",
    "asymptotic_field",
    "cleaned",
    "confidence",
    "conjugate_field",
    "directions_field",
    "field_report",
    "lines_at",
    "matching",
    "merge_singularities",
    "principal_field",
    "require_curvature",
    "require_few_singularities",
    "singularities",
    "split_links",
    "transport",
]
