"""Direction fields: which two families of lines a quad mesh shall follow on a surface.

``principal_field``, ``asymptotic_field`` and ``conjugate_field`` read the pair off the curvature;
any other pair enters as a `FrameField`. `singularities` counts where the families turn.
"""

from gridshell.field.asymptotic import asymptotic_field
from gridshell.field.conjugate import Hand, Infeasible, conjugate_field
from gridshell.field.frame_field import (
    FrameField,
    Matching,
    Singularities,
    matching,
    singularities,
    transport,
)
from gridshell.field.principal import principal_field

__all__ = [
    "FrameField",
    "Hand",
    "Infeasible",
    "Matching",
    "Singularities",
    "asymptotic_field",
    "conjugate_field",
    "matching",
    "principal_field",
    "singularities",
    "transport",
]
