"""From a surface and two families of directions to a quad mesh that follows them.

::

    directions.field(curved)          a frame field                         (gridshell.field)
    cleaned(...)                      singular points apart, refined         (gridshell.field)
    cut_open -> charts                signs, cuts, unknowns of u and v
    seamless                          the chart: anisotropic energy, exact integers
    ports -> trace -> extract         crossings of its integer lines, cells
    cells                             inside, covering or trimmed at the boundary
    quadrangulate                     all of it, with the vertices lifted and a report
"""

from gridshell.remesh.directions import Asymptotic, Conjugate, Directions, Given, Principal
from gridshell.remesh.extent import Extent
from gridshell.remesh.quadrangulation import Quadrangulation, quadrangulate
from gridshell.remesh.remesh_report import RemeshReport, Spike
from gridshell.remesh.seamless import LADDER
from gridshell.remesh.working_surface import Source, WorkingSurface, working_surface

__all__ = [
    "LADDER",
    "Asymptotic",
    "Conjugate",
    "Directions",
    "Extent",
    "Given",
    "Principal",
    "Quadrangulation",
    "RemeshReport",
    "Source",
    "Spike",
    "WorkingSurface",
    "quadrangulate",
    "working_surface",
]
