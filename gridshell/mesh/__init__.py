"""Meshes: quad mesh, colouring, control mesh, diagonal meshes, checkerboard, stars, polylines."""

from gridshell.mesh.checkerboard import CheckerboardPattern, checkerboard
from gridshell.mesh.coloring import corner_parity, two_colouring
from gridshell.mesh.control_mesh import (
    ControlMesh,
    as_control_mesh,
    control_mesh,
    without_families,
)
from gridshell.mesh.diagonals import DiagonalMesh, diagonal_meshes
from gridshell.mesh.grid import grid_quads
from gridshell.mesh.pieces import main_piece
from gridshell.mesh.polylines import Polyline, polylines
from gridshell.mesh.quad_mesh import QuadMesh, oriented, position
from gridshell.mesh.stars import Stars, diagonal_stars, edge_stars

__all__ = [
    "CheckerboardPattern",
    "ControlMesh",
    "DiagonalMesh",
    "Polyline",
    "QuadMesh",
    "Stars",
    "as_control_mesh",
    "checkerboard",
    "control_mesh",
    "corner_parity",
    "diagonal_meshes",
    "diagonal_stars",
    "edge_stars",
    "grid_quads",
    "main_piece",
    "oriented",
    "polylines",
    "position",
    "two_colouring",
    "without_families",
]
