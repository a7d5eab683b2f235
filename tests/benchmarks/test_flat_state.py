"""Figures of flat segments and orders of assembly; opt-in:

pytest tests/benchmarks -m benchmark -n 0 -s
"""

import time
from math import radians

import numpy as np
import pytest

import fabrication as fab
import gridshell as gs

pytestmark = pytest.mark.benchmark

SURFACES = [gs.Catenoid(4000.0), gs.Enneper(4000.0)]


@pytest.mark.parametrize("surface", SURFACES, ids=["catenoid", "enneper"])
@pytest.mark.parametrize("opening", [None, 75.0])
def test_nine_hundred_nodes_lie_flat_in_two_seconds(surface, opening):
    patch = gs.AsymptoticPatch(p=(-1.0, 1.0), q=(-1.0, 1.0), lamellas=(30, 30))
    net = gs.diagonal_meshes(gs.control_patch(surface, patch))[0]
    profile = fab.Profile(width=100.0, thickness=2.5, material=fab.STAINLESS)
    jointed = fab.SlotJoint().build(fab.structure(net, profile))
    start = time.perf_counter()
    state = fab.lay_flat(jointed, opening=None if opening is None else radians(opening), slip=0.0)
    flat = time.perf_counter() - start
    start = time.perf_counter()
    steps = len(fab.assembly_order(jointed).steps)
    ordered = time.perf_counter() - start
    print(
        f"\n{len(state.names)} nodes: flat in {flat:.2f} s, slips {np.abs(state.slips).max():.1e} "
        f"mm, {state.lines()[1]}; {steps} steps in {ordered:.3f} s"
    )
    assert len(state.names) == 900
    assert flat < 2.0
    assert ordered < 0.5
    assert np.abs(state.slips).max() < 0.001
