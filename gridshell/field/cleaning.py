"""Singular points made ready for a quad mesh: clusters merged, cones regular, triangles refined.

Singular points closer than two edges of the quad mesh cannot both be its vertices. Each cluster
becomes one vertex that carries the sum of the indices: opposite ones vanish, twice -1/2 is one
vertex of valence 8.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gridshell.arrays import Floats, Indices, Mask
from gridshell.errors import PoleSingularityError
from gridshell.field.checks import require_few_singularities
from gridshell.field.frame_field import FrameField, Singularities, singularities, wrapped
from gridshell.field.refinement import Refined, rotated, split_links
from gridshell.surface.curved_mesh import CurvedMesh
from gridshell.surface.triangle_mesh import TriangleMesh, place

_ROUNDS = 4
"""Merging moves singular points; new pairs can come close a few times."""

_STEEP = 0.3
"""A disc ends where its normals leave the centre's by more than this cosine."""


def cleaned(curved: CurvedMesh, field: FrameField, spacing: float) -> Refined:
    """Merge singular points closer than two edges, regularise and refine around what is left.

    Parameters
    ----------
    spacing : mean edge of the quad mesh, mm.

    Returns
    -------
    The refined mesh with its curvature and field; see `Refined`.

    Raises
    ------
    PoleSingularityError
        When a cluster adds up to a whole turn: lines run into it from all sides or around it.
    TooManySingularitiesError
        When the singular points left are too many or too close for this spacing.
    """
    merged = merge_singularities(field, spacing)
    require_few_singularities(merged, spacing)
    return split_links(curved, merged, singularities(merged).vertices)


def merge_singularities(field: FrameField, spacing: float) -> FrameField:
    """One vertex per cluster of singular points closer than twice *spacing*, mm; the same mesh.

    In a disc around it the directions become those of the disc's rim at the same polar angle.

    Raises
    ------
    PoleSingularityError
        When the indices of a cluster add up to +1 or more.
    """
    for turn in range(_ROUNDS):
        found = singularities(field)
        clusters = _clusters(field.mesh, found, 2.0 * spacing)
        alone = all(len(c.members) == 1 for c in clusters)
        if turn and alone:
            break
        for cluster in clusters:
            if turn == 0 or len(cluster.members) > 1:
                _require_no_pole(field.mesh, cluster, spacing)
                field = _with_cone(field, found, cluster, spacing)
    return field


class _Cluster(NamedTuple):
    members: Indices
    """(k,) singular vertices."""
    total: float
    """Sum of their indices."""
    centre: int
    """The interior vertex nearest to their mean."""
    radius: float
    """Largest distance of a member from the centre, mm."""


def _clusters(mesh: TriangleMesh, found: Singularities, closer: float) -> list[_Cluster]:
    """Single linkage, in the order of the smallest member."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    count = len(found.vertices)
    if count == 0:
        return []
    positions = found.positions(mesh)
    pairs = cKDTree(positions).query_pairs(closer, output_type="ndarray").reshape(-1, 2)
    links = coo_matrix((np.ones(len(pairs)), pairs.T), shape=(count, count))
    label = connected_components(links, directed=False)[1]
    inner = np.flatnonzero(~mesh.on_boundary)
    clusters = []
    for part in range(label.max() + 1):
        rows = np.flatnonzero(label == part)
        mean = positions[rows].mean(axis=0)
        away = np.linalg.norm(mesh.vertices[inner] - mean, axis=1)
        centre = int(found.vertices[rows[0]]) if len(rows) == 1 else int(inner[np.argmin(away)])
        radius = float(np.linalg.norm(positions[rows] - mesh.vertices[centre], axis=1).max())
        index = float(found.indices[rows].sum())
        clusters.append(_Cluster(found.vertices[rows], index, centre, radius))
    return clusters


def _require_no_pole(mesh: TriangleMesh, cluster: _Cluster, spacing: float) -> None:
    if cluster.total >= 1.0:
        raise PoleSingularityError(
            "The lines of one family all run into one point, or around it",
            where=f"vertex {cluster.centre} {place(mesh.vertices[cluster.centre])}",
            value=f"index {cluster.total:+g} from {len(cluster.members)} singular points",
            limit="index +1/2",
            advice=f"cut a hole of about {1.5 * spacing:.3g} mm radius there, or make the quads "
            "smaller if it is two points",
        )


def _with_cone(
    field: FrameField, found: Singularities, cluster: _Cluster, spacing: float
) -> FrameField:
    """The field with a regular cone over the disc of one cluster; unchanged if it has no rim."""
    mesh = field.mesh
    centre = mesh.vertices[cluster.centre]
    others = np.setdiff1d(found.vertices, cluster.members)
    gap = np.linalg.norm(mesh.vertices[others] - centre, axis=1).min(initial=np.inf)
    spokes = mesh.edge_lengths[mesh.origin == cluster.centre]
    wanted = cluster.radius + max(0.3 * spacing, 2.0 * float(spokes.mean()))
    radius = min(wanted, max(cluster.radius + float(spokes.mean()), gap / 2.0))
    disc = _disc(mesh, cluster.centre, radius)
    corners = np.zeros(len(mesh.vertices), dtype=bool)
    corners[mesh.triangles[disc]] = True
    rim = corners[mesh.triangles].any(axis=1) & ~disc
    if not rim.any():
        return field
    whole = not mesh.on_boundary[corners].any()
    plane = _TangentPlane(mesh, cluster.centre, np.flatnonzero(disc | rim))
    samples = _rim(field, plane, rim, cluster.total)
    if whole and abs(samples.closing) > np.pi:
        return field  # the rim does not turn as often as the cluster: not a simple disc
    return _replaced(field, plane, disc, samples, cluster.total, radius)


def _disc(mesh: TriangleMesh, centre: int, radius: float) -> Mask:
    """(f,) triangles around the vertex, connected, within *radius* and not turned away."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    fan = (mesh.triangles == centre).any(axis=1)
    near = np.linalg.norm(mesh.centroids - mesh.vertices[centre], axis=1) <= radius
    near &= mesh.face_normals @ mesh.vertex_normals[centre] > _STEEP
    near |= fan
    faces = np.flatnonzero(near)
    slot = np.full(len(near), -1)
    slot[faces] = np.arange(len(faces))
    twins = mesh.twin.reshape(-1, 3)[faces].ravel()
    here, there = np.repeat(np.arange(len(faces)), 3)[twins >= 0], slot[twins[twins >= 0] // 3]
    here, there = here[there >= 0], there[there >= 0]
    links = coo_matrix((np.ones(len(here)), (here, there)), shape=(len(faces), len(faces)))
    part = connected_components(links, directed=False)[1]
    disc = np.zeros(len(near), dtype=bool)
    disc[faces[part == part[slot[np.flatnonzero(fan)[0]]]]] = True
    return disc


class _TangentPlane:
    """Triangles around a vertex seen in its tangent plane."""

    def __init__(self, mesh: TriangleMesh, centre: int, faces: Indices) -> None:
        normal = mesh.vertex_normals[centre]
        spoke = mesh.first_spoke[centre]
        along = mesh.vertices[mesh.target[spoke]] - mesh.vertices[centre]
        e1 = along - (along @ normal) * normal
        e1 /= np.linalg.norm(e1)
        axes = np.stack([e1, np.cross(normal, e1)])
        offset = (mesh.centroids[faces] - mesh.vertices[centre]) @ axes.T
        frame = mesh.face_frames[faces]
        carried = rotated(frame[:, 0], frame[:, 2], np.broadcast_to(normal, (len(faces), 3)))
        row = carried @ axes.T
        self.polar = np.full(len(mesh.triangles), np.nan)
        """(f,) polar angle of the centroids, rad."""
        self.distance = np.full(len(mesh.triangles), np.nan)
        """(f,) distance of the centroids, mm."""
        self.turn = np.full(len(mesh.triangles), np.nan)
        """(f,) angle of row 0 of the triangle's frame in the plane, rad."""
        self.polar[faces] = np.arctan2(offset[:, 1], offset[:, 0])
        self.distance[faces] = np.linalg.norm(offset, axis=1)
        self.turn[faces] = np.arctan2(row[:, 1], row[:, 0])


class _Rim(NamedTuple):
    """The field along the rim of a disc, once around."""

    polar: Floats
    """(m + 1,) ascending over one turn, rad; the last repeats the first."""
    bisector: Floats
    """(m + 1,) angle of the bisector in the plane, unwrapped, rad."""
    opening: Floats
    """(m + 1,) angle between the lines, rad."""
    closing: float
    """How far twice the bisector jumps where the turn closes, rad."""


def _rim(field: FrameField, plane: _TangentPlane, rim: Mask, index: float) -> _Rim:
    """Sample the rim, starting after its largest gap, so that the turns add up to *index*."""
    faces = np.flatnonzero(rim)
    faces = faces[np.argsort(plane.polar[faces], kind="stable")]
    polar = plane.polar[faces]
    gaps = np.diff(np.append(polar, polar[0] + 2.0 * np.pi))
    start = (int(np.argmax(gaps)) + 1) % len(faces)
    faces, polar = np.roll(faces, -start), np.roll(polar, -start)
    polar = polar + np.where(polar < polar[0], 2.0 * np.pi, 0.0)
    twice = np.unwrap(2.0 * (field.bisector[faces] + plane.turn[faces]))
    last = twice[0] + 4.0 * np.pi * index
    opening = field.angle[faces]
    return _Rim(
        np.append(polar, polar[0] + 2.0 * np.pi),
        np.append(twice, last) / 2.0,
        np.append(opening, opening[0]),
        float(last - twice[-1]),
    )


def _replaced(
    field: FrameField, plane: _TangentPlane, disc: Mask, rim: _Rim, index: float, radius: float
) -> FrameField:
    """Directions of the rim at equal polar angle; without an index they fade to their mean."""
    faces = np.flatnonzero(disc)
    bisector, opening = _at(rim, plane.polar[faces])
    if index == 0.0:
        middle, width = (x.mean() for x in _at(rim, np.linspace(0.0, 2.0 * np.pi, 360)))
        share = np.minimum(plane.distance[faces] / radius, 1.0)
        bisector = middle + share * (bisector - middle)
        opening = width + share * (opening - width)
    bisector = bisector - plane.turn[faces]
    first, second = field.first.copy(), field.second.copy()
    first[faces] = wrapped(bisector - opening / 2.0)
    second[faces] = first[faces] + opening
    return FrameField(field.mesh, first, second, field.infeasible)


def _at(rim: _Rim, polar: Floats) -> tuple[Floats, Floats]:
    """Bisector and opening (n,) at polar angles (n,), rad; the bisector up to half turns.

    Angles are brought into the rim's own turn, so a bisector without index is continuous.
    """
    inside = rim.polar[0] + np.mod(polar - rim.polar[0], 2.0 * np.pi)
    return (
        np.asarray(np.interp(inside, rim.polar, rim.bisector)),
        np.asarray(np.interp(inside, rim.polar, rim.opening)),
    )
