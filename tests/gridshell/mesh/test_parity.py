import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from gridshell.mesh.parity import alternating_labels


@st.composite
def labelled_pairs(draw):
    n = draw(st.integers(1, 12))
    labels = np.array(draw(st.lists(st.integers(0, 1), min_size=n, max_size=n)))
    item = st.integers(0, n - 1)
    pairs = draw(st.lists(st.tuples(item, item), max_size=30))
    a, b = np.array(pairs, dtype=np.int64).reshape(-1, 2).T
    return labels, a, b


def components(n, a, b):
    home = list(range(n))
    for _ in range(n):
        for i, j in zip(a, b, strict=True):
            home[i] = home[j] = min(home[i], home[j])
    return home


@given(labelled_pairs())
def test_labels_are_found_again_from_what_the_pairs_say(case):
    labels, a, b = case
    differ = labels[a] != labels[b]
    found = alternating_labels(len(labels), a, b, differ)
    np.testing.assert_array_equal(found[a] != found[b], differ)


@given(labelled_pairs())
def test_the_smallest_item_of_every_component_gets_zero(case):
    labels, a, b = case
    found = alternating_labels(len(labels), a, b, labels[a] != labels[b])
    smallest = np.unique(components(len(labels), a, b))
    assert (found[smallest] == 0).all()


def test_items_without_a_pair_get_zero():
    none = np.empty(0, dtype=np.int64)
    assert alternating_labels(3, none, none, none.astype(bool)).tolist() == [0, 0, 0]


def test_a_contradiction_leaves_a_pair_violated():
    a, b = np.array([0, 1, 2]), np.array([1, 2, 0])
    differ = np.ones(3, dtype=bool)
    found = alternating_labels(3, a, b, differ)
    assert ((found[a] != found[b]) != differ).any()


def test_a_contradiction_in_one_component_leaves_the_other_alone():
    a, b = np.array([0, 1, 2, 3]), np.array([1, 2, 0, 4])
    found = alternating_labels(5, a, b, np.ones(4, dtype=bool))
    assert found[3:].tolist() == [0, 1]
