"""Moved by the optimiser, judged by the exact recursion."""

import numpy as np
import pytest

import gridshell as gs

UMBRELLA = gs.Umbrella(16, 1000.0, (400.0,) * 8)
CABLE = gs.Cable(0, 8)


def nodes(position):
    return gs.diagonal_meshes(position.control())[0].vertices


def cable_length(position):
    return float(CABLE.lengths(position.radii[None], position.heights[None])[0])


@pytest.fixture(scope="module")
def mechanism():
    rest = UMBRELLA.position(0.05)
    mesh = gs.quads_of(gs.diagonal_meshes(rest.control())[0])
    x = mesh.vertices
    base = np.flatnonzero(np.abs(x[:, 2]) < 1e-9)
    top = np.flatnonzero(np.abs(x[:, 2] - rest.heights[8]) < 1e-9)
    turn = np.exp(1j * np.arctan2(x[:, 1], x[:, 0]))
    above = top[np.argmin(np.abs(turn[base][:, None] - turn[top][None]), axis=1)]
    return gs.Mechanism(mesh, base, np.stack([base, above], axis=1))


def test_60_positions_follow_the_recursion(mechanism):
    positions = [UMBRELLA.position(o) for o in np.linspace(0.05, 0.97, 60)]
    found = mechanism.motion([np.full(16, cable_length(p)) for p in positions])
    assert len(found) == 60
    rest = mechanism.mesh.edge_lengths
    for moved, position in zip(found, positions, strict=True):
        assert np.abs(moved - nodes(position)).max() < 1e-3
        lengths = mechanism.mesh.moved(moved).edge_lengths
        assert np.abs(lengths / rest - 1.0).max() < 1e-6
        stars = gs.net_quality(
            gs.without_families(mechanism.mesh.moved(moved)), planarity=gs.Planarity.EDGE_STARS
        ).star_planarity
        assert stars.max < 1e-6


def test_beyond_the_lock_the_motion_ends_and_the_verdict_says_so(mechanism):
    """No position has a longer cable than the longest one of the recursion."""
    tried = UMBRELLA.rings(np.linspace(*(lock.first for lock in UMBRELLA.locks), 999))
    longest = CABLE.lengths(*tried).max()
    targets = [np.full(16, share * longest) for share in (0.95, 0.98, 1.01)]
    found = mechanism.motion(targets)
    assert len(found) == 2
    net = mechanism.pulled(targets[-1], found[-1])
    assert not net.converged
    assert net.verdict is not None


def test_a_net_that_is_no_mechanism_is_told(enneper):
    """A patch of Enneper's surface, held along one edge, does not move."""
    exact = gs.optimize(enneper(12), gs.a_net(), anchor=gs.Free()).require().control
    mesh = gs.quads_of(gs.diagonal_meshes(exact)[0])
    run = np.flatnonzero(mesh.valence == 1)[:3]
    mechanism = gs.Mechanism(mesh, np.arange(12), run[[0, 2]][None])
    length = mechanism.cable_lengths(mesh.vertices)
    assert not mechanism.pulled(0.8 * length).converged


def test_cables_name_nodes_that_are_there(mechanism):
    with pytest.raises(gs.SettingError, match="does not exist") as info:
        gs.Mechanism(mechanism.mesh, mechanism.held, np.array([[0, 10**6]]))
    assert info.value.where == "cables"
    with pytest.raises(gs.SettingError, match="drives"):
        gs.Mechanism(mechanism.mesh, mechanism.held, np.empty((0, 2)))
