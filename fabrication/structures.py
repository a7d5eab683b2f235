"""From a net to a structure: lamellas of both families and their nodes.

The axis of a node is the direction perpendicular to the two lamella axes that cross there. It
tends to the normal of the vertex star under refinement; the star's own plane holds the chords of
the next bays, which a smooth strip leaves at second order, and slots cut along the star normal
would not match in depth.

Numbers are stable: they follow from the net's vertex numbers and connectivity alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from fabrication.lamella import AxisCurve, Lamella, axis_curve
from fabrication.node import Crossing, Node, node_angles
from fabrication.ribbons import ribbons
from fabrication.stock import Profile, section_area
from gridshell import DiagonalMesh, Polyline, SettingError, polylines
from gridshell.arrays import Floats, Mask, Vectors, unit
from gridshell.painter import Faces
from gridshell.picture import card, limits, size, sketch

SEAM = 1.0
"""Gap left between the two ends of a closed lamella, mm."""

_MOST_BAYS = 3_000
"""Quads of strips in a picture for notebooks."""


@dataclass(frozen=True, eq=False)
class Structure:
    """What is built.

    Parameters
    ----------
    lamellas : family 1 ("A...") first.
    nodes : one per vertex of the net.
    profile : the section of all lamellas.
    """

    lamellas: tuple[Lamella, ...]
    nodes: tuple[Node, ...]
    profile: Profile

    def _repr_html_(self) -> str:
        """For notebooks."""
        layers, notes = _shown(self)
        picture = sketch(layers, label="Strips, bent and twisted")
        return card("Structure", _figures(self), picture=picture, notes=notes)


def structure(net: DiagonalMesh, profile: Profile, *, overhang: float | None = None) -> Structure:
    """Turn every polyline of *net* into a lamella.

    Parameters
    ----------
    net : one of the two diagonal meshes.
    profile : the section.
    overhang : length beyond the end nodes, mm; half the strip's width unless said otherwise.

    Raises
    ------
    SettingError
        For an overhang that is not positive, or a net without a single edge.
    """
    overhang = profile.width / 2.0 if overhang is None else overhang
    if not (np.isfinite(overhang) and overhang > 0.0):
        raise SettingError(
            "Lamellas must reach beyond their end nodes",
            where="overhang",
            value=f"{overhang:g} mm",
            limit="> 0",
            advice=f"{profile.width / 2.0:g} mm, half the strip's width",
        )
    lines = _in_order(net, polylines(net))
    axes = [
        axis_curve(net.vertices[line.vertices], closed=line.closed, reach=overhang)
        for line in lines
    ]
    node_axes, tangents = _node_axes(net, lines, axes)
    crossed = np.asarray(np.isfinite(tangents).all(axis=(1, 2)))
    lamellas = _lamellas(net, lines, axes, node_axes, crossed, profile, overhang)
    return Structure(lamellas, _nodes(net, lamellas, node_axes, tangents), profile)


def _in_order(net: DiagonalMesh, lines: tuple[Polyline, ...]) -> list[Polyline]:
    """Each family from one side of the net to the other, so that neighbours have next numbers."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components, depth_first_order

    ordered: list[Polyline] = []
    for family in (1, 2):
        members = [line for line in lines if line.family == family]
        count = len(members)
        owner = np.full(len(net.vertices), -1, dtype=np.int64)
        for i, line in enumerate(members):
            owner[line.vertices] = i
        a, b = owner[net.edges[net.family != family].T]
        apart = (a >= 0) & (b >= 0) & (a != b)
        ones = np.ones(int(apart.sum()))
        graph = coo_matrix((ones, (a[apart], b[apart])), shape=(count, count)).tocsr()
        graph = graph + graph.T
        degree = np.diff(graph.indptr)
        smallest = np.array([int(line.vertices.min()) for line in members])
        pieces, piece = connected_components(graph, directed=False)
        for p in range(pieces):
            inside = np.flatnonzero(piece == p)
            start = inside[np.lexsort((smallest[inside], degree[inside] > 1))[0]]
            walk = depth_first_order(graph, start, directed=False, return_predecessors=False)
            ordered.extend(members[i] for i in walk)
    return ordered


def _node_axes(
    net: DiagonalMesh, lines: list[Polyline], axes: list[AxisCurve]
) -> tuple[Vectors, Floats]:
    """(n, 3) node axes and (n, 2, 3) tangents per family, NaN where none passes or several end."""
    tangents = np.full((len(net.vertices), 2, 3), np.nan)
    for line, axis in zip(lines, axes, strict=True):
        at_nodes = axis.tangents(axis.stations[: len(line.vertices)])
        tangents[line.vertices, line.family - 1] = at_nodes
    tangents[net.stars.count > 4] = np.nan
    star = _star_normals(net)
    crossed = np.isfinite(tangents).all(axis=(1, 2))
    normal = np.cross(tangents[:, 0], tangents[:, 1])
    side = np.sign(np.einsum("nc,nc->n", normal, star))[:, None]
    return np.where(crossed[:, None], unit(np.nan_to_num(normal)) * side, star), tangents


def _star_normals(net: DiagonalMesh) -> Vectors:
    """(n, 3) normals on the counter-clockwise side, from the spokes taken in turn.

    A vertex with fewer than two spokes takes the normal of its neighbour.
    """
    spokes, count = net.stars.spokes, net.stars.count
    arms = np.where((spokes >= 0)[..., None], net.vertices[spokes] - net.vertices[:, None], 0.0)
    following = np.roll(arms, -1, axis=1)
    last = np.maximum(count - 1, 0)
    rows = np.arange(len(spokes))
    following[rows, last] = np.where(net.stars.closed[:, None], arms[:, 0], 0.0)
    normal = unit(np.cross(arms, following).sum(axis=1))
    alone = np.flatnonzero(count == 1)
    normal[alone] = normal[spokes[alone, 0]]
    return normal


def _lamellas(
    net: DiagonalMesh,
    lines: list[Polyline],
    axes: list[AxisCurve],
    node_axes: Vectors,
    crossed: Mask,
    profile: Profile,
    overhang: float,
) -> tuple[Lamella, ...]:
    number = {1: 0, 2: 0}
    lamellas = []
    for line, axis in zip(lines, axes, strict=True):
        number[line.family] += 1
        start, end = _ends(net, line, axis, profile, overhang)
        lamellas.append(
            Lamella(
                mark=f"{'AB'[line.family - 1]}{number[line.family]}",
                family=line.family,
                nodes=line.vertices,
                axis=axis,
                normals=_normal_spline(axis, node_axes[line.vertices], crossed[line.vertices]),
                start=start,
                end=end,
            )
        )
    return tuple(lamellas)


def _normal_spline(axis: AxisCurve, normals: Vectors, crossed: Mask) -> CubicSpline:
    """Through the axes of the nodes where the strip is held; beyond them its twist goes on."""
    if axis.closed:
        return CubicSpline(axis.stations, np.vstack([normals, normals[:1]]), bc_type="periodic")
    held = crossed if np.count_nonzero(crossed) > 1 else np.ones_like(crossed)
    return CubicSpline(axis.stations[held], normals[held])


def _ends(
    net: DiagonalMesh, line: Polyline, axis: AxisCurve, profile: Profile, overhang: float
) -> tuple[float, float]:
    """Stations of the cut ends: beyond the end nodes, short of singular ones, or at a seam."""
    if line.closed:
        half_bay = (axis.stations[-1] - axis.stations[-2]) / 2.0
        return -half_bay + SEAM / 2.0, axis.length - half_bay - SEAM / 2.0
    reach = [overhang, overhang]
    for side, vertex in enumerate((line.vertices[0], line.vertices[-1])):
        count = int(net.stars.count[vertex])
        if net.stars.closed[vertex] and count > 4:
            reach[side] = -(SEAM + profile.thickness / (2.0 * np.tan(np.pi / count)))
    return -reach[0], axis.length + reach[1]


def _nodes(
    net: DiagonalMesh, lamellas: tuple[Lamella, ...], node_axes: Vectors, tangents: Floats
) -> tuple[Node, ...]:
    crossings: list[list[Crossing]] = [[] for _ in range(len(net.vertices))]
    for i, lamella in enumerate(lamellas):
        for vertex, station in zip(lamella.nodes.tolist(), lamella.stations.tolist(), strict=True):
            crossings[vertex].append(Crossing(i, station))
    star = _star_normals(net)
    tilt = np.arccos(np.clip(np.abs(np.einsum("nc,nc->n", node_axes, star)), 0.0, 1.0))
    angle = node_angles(tangents[:, 0], tangents[:, 1], node_axes)
    return tuple(
        Node(
            name=f"N{v + 1}",
            position=net.vertices[v],
            axis=_axis(node_axes[v], crossings[v], lamellas),
            angle=None if np.isnan(angle[v]) else float(angle[v]),
            crossings=tuple(crossings[v]),
            star_tilt=float(tilt[v]),
        )
        for v in range(len(net.vertices))
    )


def _axis(axis: Floats, crossings: list[Crossing], lamellas: tuple[Lamella, ...]) -> Floats:
    """The node axis, or where one lamella passes alone, the direction of its width."""
    if len(crossings) != 1:
        return axis
    (alone,) = crossings
    return np.asarray(lamellas[alone.lamella].frames(np.array([alone.station])).n[0])


# ---- for notebooks -------------------------------------------------------------------------------


def _figures(built: Structure) -> list[tuple[str, str]]:
    profile, lengths = built.profile, np.array([one.length for one in built.lamellas])
    counts = " + ".join(str(sum(one.family == f for one in built.lamellas)) for f in (1, 2))
    angles = np.array([node.angle for node in built.nodes if node.angle is not None], dtype=float)
    mass = lengths.sum() * section_area(profile) * profile.material.density * 1e-9
    return [
        ("Lamellas A, B", counts),
        ("Nodes", f"{len(built.nodes)}"),
        ("Node angle", limits(np.degrees(angles), "degrees")),
        ("Spans", size(np.array([node.position for node in built.nodes]).reshape(-1, 3))),
        ("Section", f"{profile.size} mm, {profile.material.name}"),
        ("Lengths", limits(lengths / 1e3, "m", 3)),
        ("In all", f"{lengths.sum() / 1e3:.1f} m, {mass:.1f} kg before cutting"),
    ]


def _shown(built: Structure) -> tuple[tuple[Faces, ...], tuple[str, ...]]:
    """All strips as ribbons, coarser where they are many; of very many every so many."""
    bays = sum(len(one.stations) for one in built.lamellas)
    step = -(-bays // _MOST_BAYS) or 1
    per_bay = 2 if 2 * bays <= _MOST_BAYS else 1
    faces = ribbons(built.lamellas[::step], built.profile.width, per_bay=per_bay)
    notes = () if step == 1 else (f"One strip of {step} is drawn.",)
    return faces, notes
