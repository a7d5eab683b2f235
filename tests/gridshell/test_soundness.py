import numpy as np
import pytest

import gridshell as gs
from gridshell.soundness import components, remarks, require_sound


def test_a_sound_mesh_passes_without_a_remark(grid, annulus, sectors, cube):
    for mesh in (grid(4, 4), annulus(8), sectors(6, 3), cube):
        require_sound(mesh)
        assert remarks(mesh) == ()


def test_a_torn_mesh_names_two_vertices_in_one_place(grid):
    left, right = grid(2, 2), grid(2, 2)
    vertices = np.vstack([left.vertices, right.vertices + np.array([2.0, 0.0, 0.0])])
    mesh = gs.QuadMesh(vertices, np.vstack([left.quads, right.quads + 9]))
    with pytest.raises(gs.MeshError, match="one place") as info:
        require_sound(mesh)
    assert info.value.where.startswith("vertices 6 and 9 (2, 0, 0) mm")
    assert "weld" in info.value.advice


def test_a_t_junction_names_the_vertex_and_the_quad():
    """Beside one large quad lie two small ones: their middle vertex is on its edge."""
    large = [[0, 0, 0], [2, 0, 0], [2, 4, 0], [0, 4, 0]]
    small = [[2.0 + x, y, 0] for y in (-1, 1, 5) for x in (0, 1)]
    vertices = np.array([*large, *small], dtype=float)
    mesh = gs.QuadMesh(vertices, np.array([[0, 1, 2, 3], [4, 5, 7, 6], [6, 7, 9, 8]]))
    with pytest.raises(gs.MeshError, match="T-junction") as info:
        require_sound(mesh)
    assert info.value.where == "vertex 6 (2, 1, 0) mm, quad 0"


def test_a_concave_quad_is_named_with_its_sine(grid):
    vertices = grid(3, 3).vertices.copy()
    vertices[5] += [0.7, 0.7, 0.0]
    with pytest.raises(gs.MeshError, match="concave") as info:
        require_sound(grid(3, 3).moved(vertices))
    assert info.value.where.startswith("quad 4 ")
    assert "least sine of a corner -" in info.value.value


def test_a_sliver_is_named(grid):
    narrow = grid(1, 3).vertices * [1.0, 1.0, 1.0]
    narrow[[1, 5], 1] = 0.005
    with pytest.raises(gs.MeshError, match="sliver") as info:
        require_sound(grid(1, 3).moved(narrow))
    assert info.value.where.startswith("quad 0 ")


def test_two_quads_folded_onto_each_other_are_named(grid):
    folded = grid(1, 2).vertices.copy()
    folded[[2, 5]] = [[0.0, 0.1, 0.05], [1.0, 0.1, 0.05]]
    with pytest.raises(gs.MeshError, match="folded") as info:
        require_sound(grid(1, 2).moved(folded))
    assert info.value.where.startswith("quads 0 and 1 ")


def test_an_isolated_vertex_is_remarked_with_its_place(grid):
    mesh = grid(2, 2)
    stray = gs.QuadMesh(np.vstack([mesh.vertices, [[7.0, 8.0, 9.0], [1.0, 1.0, 5.0]]]), mesh.quads)
    require_sound(stray)
    (remark,) = remarks(stray)
    assert remark.startswith("Vertex 9 (7, 8, 9) mm and 1 more belongs to no quad")


def test_two_components_are_remarked_with_the_smaller_one(grid):
    large, small = grid(3, 3), grid(1, 2)
    vertices = np.vstack([large.vertices, small.vertices + 10.0])
    mesh = gs.QuadMesh(vertices, np.vstack([large.quads, small.quads + 16]))
    assert components(mesh).tolist() == [0] * 9 + [1] * 2
    (remark,) = remarks(mesh)
    assert "2 separate components" in remark
    assert "2 quads, begins with quad 9 at (10.5, 10.5, 10) mm" in remark
