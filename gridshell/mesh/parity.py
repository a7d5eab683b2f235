"""Two labels over a graph whose edges say "same" or "different": the core of every colouring."""

from __future__ import annotations

import numpy as np

from gridshell.arrays import Indices, Mask


def alternating_labels(n: int, a: Indices, b: Indices, differ: Mask) -> Indices:
    """Labels 0 or 1 with ``label[a] != label[b]`` exactly where *differ* holds.

    Every item is doubled (itself, itself with the other label); the pairs join the copies, and
    the labels are read off the connected components. One vectorised call whatever the size.

    Parameters
    ----------
    n : number of items.
    a, b : (m,) pairs of items.
    differ : (m,) whether the pair has different labels.

    Returns
    -------
    (n,) labels; the smallest item of every component gets 0. Where the pairs contradict each
    other some pair stays violated: the caller looks for it and names it.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    differ = np.asarray(differ, dtype=np.int64)
    rows, columns = np.r_[a, a + n], np.r_[b + n * differ, b + n * (1 - differ)]
    ones = np.ones(len(rows), dtype=np.int8)
    doubled = coo_matrix((ones, (rows, columns)), shape=(2 * n, 2 * n))
    plain = coo_matrix((ones[: len(a)], (a, b)), shape=(n, n))
    _, copy_component = connected_components(doubled, directed=False)
    _, component = connected_components(plain, directed=False)
    _, smallest = np.unique(component, return_index=True)
    home = copy_component[:n][smallest][component]
    return np.where(copy_component[:n] == home, 0, 1).astype(np.int64)
