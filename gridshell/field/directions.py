"""Any two line fields as a frame field: the families are told apart by following them around."""

from __future__ import annotations

import numpy as np

from gridshell.arrays import Floats, Indices, Mask, Vectors
from gridshell.errors import InputError, OddValenceError
from gridshell.field.frame_field import FrameField, transport
from gridshell.surface.triangle_mesh import TriangleMesh, place

_PARALLEL = 1e-6
"""A direction counts as along the normal when this little of it lies in the triangle."""


def directions_field(mesh: TriangleMesh, first: Vectors, second: Vectors) -> FrameField:
    """Two lines per triangle, drawn or computed elsewhere, in any order and with any sign.

    The lines are projected onto the triangles. Triangle 0 keeps its order; every other one takes
    the order in which its lines continue those of its neighbours with the least turn.

    Parameters
    ----------
    first, second : (f, 3) directions, of any length but not zero.

    Raises
    ------
    InputError
        For arrays of another shape, or a direction that is not in its triangle's plane at all.
    OddValenceError
        When the families change places on a way around a vertex or a hole: a quad mesh along such
        lines has a vertex of odd valence.
    SurfaceError
        When the two lines of a triangle coincide.
    """
    one, two = _angles(mesh, first, "first"), _angles(mesh, second, "second")
    here = np.flatnonzero(mesh.twin > np.arange(len(mesh.twin)))
    swapped = _swaps(mesh, one, two, here)
    label = _labels(mesh, here, swapped)
    f, g = here // 3, mesh.twin[here] // 3
    broken = (label[f] ^ label[g]) != swapped
    if broken.any():
        raise _odd(mesh, here, swapped, here[np.argmax(broken)])
    return FrameField.of_lines(mesh, np.where(label, two, one), np.where(label, one, two))


def _angles(mesh: TriangleMesh, vectors: Vectors, key: str) -> Floats:
    """(f,) angles of *vectors* (f, 3) in the frames of the triangles, rad."""
    array = np.asarray(vectors, dtype=np.float64)
    if array.shape != (len(mesh.triangles), 3):
        raise InputError(
            "Directions must come one per triangle",
            where=key,
            value=f"shape {array.shape}",
            limit=f"({len(mesh.triangles)}, 3)",
        )
    local = np.einsum("fic,fc->fi", mesh.face_frames[:, :2], array)
    length = np.linalg.norm(array, axis=1)
    bad = np.flatnonzero(~((np.linalg.norm(local, axis=1) > _PARALLEL * length) & (length > 0.0)))
    if len(bad):
        raise InputError(
            "A direction does not lie along the surface",
            where=f"{key}, triangle {bad[0]} {place(mesh.centroids[bad[0]])}",
            value=str(array[bad[0]]),
            limit="finite, not zero, not along the normal",
        )
    return np.asarray(np.arctan2(local[:, 1], local[:, 0]))


def _swaps(mesh: TriangleMesh, one: Floats, two: Floats, here: Indices) -> Mask:
    """(e,) whether lines continue across half-edges *here* with exchanged names."""
    f, g = here // 3, mesh.twin[here] // 3
    turn = transport(mesh)[here]
    cos = {
        (i, j): np.cos(b[g] - a[f] - turn) ** 2
        for i, a in enumerate((one, two))
        for j, b in enumerate((one, two))
    }
    return np.asarray(cos[0, 1] + cos[1, 0] > cos[0, 0] + cos[1, 1])


def _labels(mesh: TriangleMesh, here: Indices, swapped: Mask) -> Mask:
    """(f,) whether a triangle exchanges its names: breadth first from the first triangle."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import breadth_first_order, connected_components

    count = len(mesh.triangles)
    f, g = here // 3, mesh.twin[here] // 3
    # 1 keeps the names, 2 exchanges them
    links = coo_matrix((1 + swapped.astype(np.int64), (f, g)), shape=(count, count))
    graph = (links + links.T).tocsr()
    label = np.zeros(count, dtype=bool)
    _, part = connected_components(graph, directed=False)
    for root in np.unique(part, return_index=True)[1]:
        order, before = breadth_first_order(graph, root, directed=False)
        flips = np.asarray(graph[order[1:], before[order[1:]]]).ravel() == 2
        for face, parent, flip in zip(order[1:], before[order[1:]], flips, strict=True):
            label[face] = label[parent] ^ flip
    return label


def _odd(mesh: TriangleMesh, here: Indices, swapped: Mask, broken: int) -> OddValenceError:
    count = np.bincount(mesh.origin[here], swapped, len(mesh.vertices))
    count += np.bincount(mesh.target[here], swapped, len(mesh.vertices))
    odd = np.flatnonzero((count % 2 == 1) & ~mesh.on_boundary)
    if len(odd):
        where = f"vertex {odd[0]} {place(mesh.vertices[odd[0]])}"
        what = "The two families change places on the way around a vertex"
    else:
        face = int(broken) // 3
        where = f"a loop through triangle {face} {place(mesh.centroids[face])}"
        what = "The two families change places on the way around a hole or a handle"
    return OddValenceError(
        what,
        where=where,
        value=f"{len(odd)} vertices of odd valence",
        limit="0",
        advice="move two such points together, or turn the directions there by a quarter more",
    )
