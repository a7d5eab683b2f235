"""Meshes: quad mesh, colouring, control mesh, diagonal meshes, checkerboard, stars, polylines."""

from gridshell.mesh.checkerboard import CheckerboardPattern, checkerboard
from gridshell.mesh.coloring import corner_parity, two_colouring
from gridshell.mesh.control_mesh import (
    ControlMesh,
    as_control_mesh,
    control_mesh,
    without_families,
)
from gridshell.mesh.crossings import crossing_angles
from gridshell.mesh.diagonals import DiagonalMesh, diagonal_meshes
from gridshell.mesh.grid import grid_quads
from gridshell.mesh.panel_mesh import PanelMesh, averaged_normals, panel_mesh
from gridshell.mesh.parity import alternating_labels
from gridshell.mesh.pieces import main_piece
from gridshell.mesh.polylines import Polyline, polylines
from gridshell.mesh.quad_mesh import QuadMesh, oriented, position
from gridshell.mesh.skins import Skin, node_axes, skin
from gridshell.mesh.stars import Stars, diagonal_stars, edge_stars

__all__ = [
    "CheckerboardPattern",
    "ControlMesh",
    "DiagonalMesh",
    "PanelMesh",
    "Polyline",
    "QuadMesh",
    "Skin",
    "Stars",
    "alternating_labels",
    "as_control_mesh",
    "averaged_normals",
    "checkerboard",
    "control_mesh",
    "corner_parity",
    "crossing_angles",
    "diagonal_meshes",
    "diagonal_stars",
    "edge_stars",
    "grid_quads",
    "main_piece",
    "node_axes",
    "oriented",
    "panel_mesh",
    "polylines",
    "position",
    "skin",
    "two_colouring",
    "without_families",
]
