"""Is a mesh fit to be optimised? What makes it unusable is an error, what is odd a remark."""

from __future__ import annotations

import numpy as np

from gridshell.arrays import Indices
from gridshell.errors import MeshError
from gridshell.folding import collapsed, corner_sines, folded_pairs
from gridshell.mesh import QuadMesh, position

_SAME = 1e-9
"""Distance over the mean edge below which two vertices are in one place."""

_TOUCHING = 1e-6
"""Distance over the edge below which a vertex lies on it."""


def require_sound(mesh: QuadMesh) -> None:
    """Refuse what the optimiser cannot mend.

    Raises
    ------
    MeshError
        Vertices in one place, a T-junction, a quad that is turned over, concave or a sliver,
        two quads folded onto each other. Each names the place.
    """
    if not mesh.mean_edge > 0.0:
        raise MeshError("All vertices of the mesh coincide", value="mean edge 0 mm")
    _refuse_repeated(mesh)
    _refuse_t_junctions(mesh)
    _refuse_collapsed(mesh)


def remarks(mesh: QuadMesh) -> tuple[str, ...]:
    """Sentences about what is odd but harmless: unused vertices, more than one component."""
    found = []
    unused = np.flatnonzero(mesh.valence == 0)
    if len(unused):
        v = int(unused[0])
        more = f" and {len(unused) - 1} more" if len(unused) > 1 else ""
        found.append(
            f"Vertex {v} {position(mesh.vertices[v])}{more} belongs to no quad and stays in place."
        )
    component = components(mesh)
    count = int(component.max()) + 1
    if count > 1:
        smallest = int(np.argmin(np.bincount(component)))
        f = int(np.flatnonzero(component == smallest)[0])
        place = position(mesh.vertices[mesh.quads[f]].mean(axis=0))
        found.append(
            f"The mesh has {count} separate components; the smallest, "
            f"{np.bincount(component)[smallest]} quads, begins with quad {f} at {place}."
        )
    return tuple(found)


def components(mesh: QuadMesh) -> Indices:
    """(f,) component of every quad, from 0."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    f = np.repeat(np.arange(len(mesh.quads)), 4)
    ones = np.ones(len(f), dtype=np.int8)
    incidence = coo_matrix(
        (ones, (f, mesh.quads.ravel() + len(mesh.quads))),
        shape=(len(mesh.quads) + len(mesh.vertices),) * 2,
    )
    _, label = connected_components(incidence, directed=False)
    return np.unique(label[: len(mesh.quads)], return_inverse=True)[1]


def _refuse_repeated(mesh: QuadMesh) -> None:
    from scipy.spatial import cKDTree

    used = np.flatnonzero(mesh.valence > 0)
    pairs = cKDTree(mesh.vertices[used]).query_pairs(_SAME * mesh.mean_edge, output_type="ndarray")
    if len(pairs):
        a, b = used[pairs[np.lexsort(pairs.T[::-1])[0]]].tolist()
        raise MeshError(
            "Two vertices lie in one place: the mesh is torn or a quad has no area there",
            where=f"vertices {a} and {b} {position(mesh.vertices[a])}",
            value=f"{len(pairs)} such pairs",
            limit="one vertex in each place",
            advice="weld the mesh (merge vertices by distance) before writing it",
        )


def _refuse_t_junctions(mesh: QuadMesh) -> None:
    from scipy.spatial import cKDTree

    rim = np.flatnonzero(mesh.twin < 0)
    if len(rim) == 0:
        return
    a, b = mesh.origin[rim], mesh.target[rim]
    vertices = np.unique(a)
    start, along = mesh.vertices[a], mesh.vertices[b] - mesh.vertices[a]
    square = np.maximum(np.einsum("mc,mc->m", along, along), 1e-300)
    _, near = cKDTree(mesh.vertices[vertices]).query(start + along / 2.0, k=min(8, len(vertices)))
    candidate = vertices[np.asarray(near).reshape(len(rim), -1)]
    offset = mesh.vertices[candidate] - start[:, None]
    share = np.einsum("mkc,mc->mk", offset, along) / square[:, None]
    away = np.linalg.norm(offset - share[..., None] * along[:, None], axis=2)
    on_edge = (share > 0.01) & (share < 0.99) & (away < _TOUCHING * np.sqrt(square)[:, None])
    on_edge &= (candidate != a[:, None]) & (candidate != b[:, None])
    rows, columns = np.nonzero(on_edge)
    if len(rows):
        v, h = int(candidate[rows[0], columns[0]]), int(rim[rows[0]])
        raise MeshError(
            "A vertex lies in the middle of another quad's edge: a T-junction",
            where=f"vertex {v} {position(mesh.vertices[v])}, quad {h // 4}",
            limit="edges that meet end to end",
            advice="split the quad there, or carry the row of quads on",
        )


def _refuse_collapsed(mesh: QuadMesh) -> None:
    bad = np.flatnonzero(collapsed(mesh.vertices, mesh.quads, mesh.mean_edge))
    if len(bad):
        f = int(bad[0])
        sine = float(corner_sines(mesh.vertices, mesh.quads[f : f + 1]).min())
        raise MeshError(
            "A quad is turned over, concave or a sliver",
            where=f"quad {f} {position(mesh.vertices[mesh.quads[f]].mean(axis=0))}",
            value=f"least sine of a corner {sine:.3g}; {len(bad)} such quads",
            limit="convex quads with corners of more than one degree",
            advice="relax or redraw the mesh there",
        )
    folded = folded_pairs(mesh.vertices, mesh)
    if len(folded):
        f, g = folded[0].tolist()
        raise MeshError(
            "Two neighbouring quads are folded onto each other",
            where=f"quads {f} and {g} {position(mesh.vertices[mesh.quads[f]].mean(axis=0))}",
            value=f"{len(folded)} such pairs",
            limit="normals less than 90 degrees apart",
            advice="relax or redraw the mesh there",
        )
