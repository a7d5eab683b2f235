"""Unknowns of one family's coordinate: real values, integers, and how the corners depend on them.

On the surface cut open every corner of a triangle has a value. Corners around a vertex that no cut
separates share it (a wedge). Across the cut ``x' = s x + j`` with s = +-1 and one integer j per
chain of cut edges; at singular vertices and along boundaries that follow the
family the value itself is an integer. What the equations leave free are the unknowns.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix
from scipy.sparse.csgraph import connected_components

from gridshell.arrays import Indices, Mask
from gridshell.remesh.cut import Cut
from gridshell.remesh.lattice_basis import integer_solutions
from gridshell.surface import TriangleMesh
from gridshell.surface.triangle_mesh import after


@dataclass(frozen=True, eq=False)
class Charts:
    """``corner values = reals @ x + integers @ z``.

    Parameters
    ----------
    reals : (3f, n) sparse, entries +-1.
    integers : (3f, m) sparse, whole numbers.
    """

    reals: csr_matrix
    integers: csr_matrix


Affine = tuple[int, int, dict[int, int]]
"""Sign, root and integer combination: the value ``sign x_root + sum c_j j``."""


def charts(mesh: TriangleMesh, cut: Cut, singular: Mask, aligned: Mask, *, origin: int) -> Charts:
    """Work out the unknowns of one coordinate.

    A shift of the whole chart changes nothing: one singular vertex or aligned run has the value
    zero, or where there is none, the vertex *origin*.

    Parameters
    ----------
    singular : (n,) vertices whose coordinate is an integer.
    aligned : (3f,) boundary half-edges along which the coordinate is one integer.
    """
    wedge = _wedges(mesh, cut)
    forest = _Forest(int(wedge.max()) + 1)
    chain, along = _chains(mesh, cut, singular)
    first = int(chain.max(initial=-1)) + 1
    for h in np.flatnonzero(aligned).tolist():
        forest.join(int(wedge[h]), int(wedge[_next(h)]), 1, {})
    edges = np.flatnonzero(cut.on_cut & along)
    for h in edges.tolist():
        t = int(mesh.twin[h])
        sign, number = int(cut.flips[h]), {int(chain[h]): 1}
        forest.join(int(wedge[h]), int(wedge[_next(t)]), sign, number)
        forest.join(int(wedge[_next(h)]), int(wedge[t]), sign, number)
    whole = np.unique(wedge[singular[mesh.origin] | aligned])
    if len(whole) == 0:
        whole = wedge[mesh.origin == origin][:1]
    return _resolved(wedge, forest, whole, first)


def _next(h: int) -> int:
    return h - 2 if h % 3 == 2 else h + 1


def _wedges(mesh: TriangleMesh, cut: Cut) -> Indices:
    """(3f,) the wedge of every corner."""
    inner = np.flatnonzero((mesh.twin >= 0) & ~cut.on_cut)
    # the corner at the origin of h is the one after its twin on the other side
    other = after(mesh.twin[inner])
    size = len(mesh.twin)
    graph = coo_matrix((np.ones(len(inner), dtype=np.int8), (inner, other)), shape=(size, size))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)


def _chains(mesh: TriangleMesh, cut: Cut, singular: Mask) -> tuple[Indices, Mask]:
    """(3f,) number of the chain a cut half-edge belongs to, and whether it leads along it.

    A chain runs between nodes: the boundary, singular vertices, and where the cut branches. Of the
    two half-edges of an edge the one on the chain's left side carries ``x' = s x + j``.
    """
    chain = np.full(len(mesh.twin), -1, dtype=np.int64)
    along = np.zeros(len(mesh.twin), dtype=bool)
    on_cut = np.flatnonzero(cut.on_cut)
    leaving: dict[int, list[int]] = defaultdict(list)
    for h in on_cut.tolist():
        leaving[int(mesh.origin[h])].append(h)
    node = {v for v, out in leaving.items() if len(out) != 2 or mesh.on_boundary[v] or singular[v]}
    count = 0
    starts = [h for v in sorted(node) for h in leaving[v]] + on_cut.tolist()
    for start in starts:
        if chain[start] >= 0:
            continue
        h = start
        while True:
            chain[h] = chain[mesh.twin[h]] = count
            along[h] = True
            v = int(mesh.target[h])
            if v in node:
                break
            onward = [g for g in leaving[v] if g != mesh.twin[h]]
            if chain[onward[0]] >= 0:
                break
            h = onward[0]
        count += 1
    return chain, along


class _Forest:
    """Wedges joined by ``x_a = s x_b + ...``: affine union-find with the equations left over."""

    def __init__(self, count: int) -> None:
        self.parent: dict[int, Affine] = {}
        self.count = count
        self.left_over: list[tuple[int, int, dict[int, int]]] = []
        """``k x_root + sum c_j j = 0`` as (k, root, c)."""

    def find(self, wedge: int) -> Affine:
        """*wedge*'s value by its root's."""
        path = []
        while wedge in self.parent:
            path.append(wedge)
            wedge = self.parent[wedge][1]
        result: Affine = (1, wedge, {})
        for item in reversed(path):
            sign, _, combination = self.parent[item]
            result = (sign * result[0], result[1], _sum(combination, result[2], sign))
            self.parent[item] = result
        return result

    def join(self, a: int, b: int, sign: int, combination: dict[int, int]) -> None:
        """State that ``x_b = sign x_a + combination``."""
        sign_a, root_a, more_a = self.find(a)
        sign_b, root_b, more_b = self.find(b)
        # sign_b root_b + more_b = sign (sign_a root_a + more_a) + combination
        rest = _sum(_sum(combination, more_a, sign), more_b, -1)
        if root_a != root_b:
            self.parent[root_b] = (sign_b * sign * sign_a, root_a, _scaled(rest, sign_b))
            return
        factor = sign_b - sign * sign_a
        rest = _scaled(rest, -1)  # (s_b - s s_a) root = rest, brought to one side
        if factor or rest:
            self.left_over.append((factor, root_a, rest))


def _sum(a: dict[int, int], b: dict[int, int], times: int) -> dict[int, int]:
    """``a + times b`` without zeros."""
    total = dict(a)
    for key, value in b.items():
        total[key] = total.get(key, 0) + times * value
    return {key: value for key, value in total.items() if value}


def _scaled(a: dict[int, int], times: int) -> dict[int, int]:
    return {key: times * value for key, value in a.items()}


def _resolved(wedge: Indices, forest: _Forest, whole: Indices, chains: int) -> Charts:
    """Roots become real unknowns or integers; the integers are written in a basis.

    Integer candidates are the chains' j first, then the roots of whole wedges, of which the first
    is the origin. A root with ``2 x = combination`` is whole too: only half indices make such.
    """
    # an equation's root may have found another root since it was written down
    whole_roots = {forest.find(int(w))[1] for w in whole}
    left_over = [_at_root(forest, *equation) for equation in forest.left_over]
    whole_roots |= {root for factor, root, _ in left_over if factor}
    roots = {root: chains + i for i, root in enumerate(sorted(whole_roots))}
    equations = [{chains: 1}]
    for factor, root, combination in left_over:
        equation = dict(combination)
        if factor:
            equation[roots[root]] = factor
        equations.append(equation)
    basis = integer_solutions(equations, chains + len(roots))
    return _matrices(wedge, forest, roots, basis)


def _at_root(
    forest: _Forest, factor: int, wedge: int, combination: dict[int, int]
) -> tuple[int, int, dict[int, int]]:
    sign, root, more = forest.find(wedge)
    return factor * sign, root, _sum(combination, more, factor)


def _matrices(wedge: Indices, forest: _Forest, roots: dict[int, int], basis: Indices) -> Charts:
    count = forest.count
    sign, root = np.ones(count, dtype=np.int64), np.arange(count)
    rows, columns, values = [], [], []
    for w in forest.parent:
        sign[w], root[w], combination = forest.find(w)
        for j, c in combination.items():
            rows.append(w)
            columns.append(j)
            values.append(c)
    for r, column in roots.items():
        members = np.flatnonzero(root == r)
        rows.extend(members.tolist())
        columns.extend([column] * len(members))
        values.extend(sign[members].tolist())
    shape = (count, len(basis))
    combos = csr_matrix((np.array(values, dtype=float), (rows, columns)), shape=shape)
    real = ~np.isin(root, np.fromiter(roots, dtype=np.int64, count=len(roots)))
    used, number = np.unique(root[real], return_inverse=True)
    line = np.flatnonzero(real)
    reals = csr_matrix((sign[line].astype(float), (line, number)), shape=(count, len(used)))
    return Charts(reals[wedge].tocsr(), (combos @ csr_matrix(basis.astype(float)))[wedge].tocsr())
