"""Files of nets and meshes."""

from gridshell.io.brep_file import read_brep
from gridshell.io.compas_file import read_compas
from gridshell.io.curve_file import read_curves, read_polylines
from gridshell.io.design_file import read_design, states_unit
from gridshell.io.mesh_file import read_mesh
from gridshell.io.net_json import read_net, write_net
from gridshell.io.obj import Unit, read_obj, write_obj
from gridshell.io.rhino_file import read_rhino
from gridshell.io.state_file import read_state, write_state
from gridshell.io.surface_file import read_surface

__all__ = [
    "Unit",
    "read_brep",
    "read_compas",
    "read_curves",
    "read_design",
    "read_mesh",
    "read_net",
    "read_obj",
    "read_polylines",
    "read_rhino",
    "read_state",
    "read_surface",
    "states_unit",
    "write_net",
    "write_obj",
    "write_state",
]
