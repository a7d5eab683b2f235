"""From the shared surfaces to exact nets (Fig. 6): figures, lamellas, the trade-off; opt-in.

Set GRIDSHELL_CASES to the folder that holds freeform.obj, monkey.obj and enneper.obj:

GRIDSHELL_CASES=... pytest tests/benchmarks/test_rationalisation.py -m benchmark -n 0 -s
"""

import os
import time
from dataclasses import replace
from math import radians
from pathlib import Path

import numpy as np
import pytest

import gridshell as gs

CASES = Path(os.environ.get("GRIDSHELL_CASES", "../shared/cases"))
QUADS = {60: 860, 75: 940}
"""About 400 and 430 control vertices, as the paper's Fig. 6 d and f have."""

pytestmark = [
    pytest.mark.benchmark,
    pytest.mark.skipif(not CASES.is_dir(), reason="no folder of surfaces"),
]


def remeshed(name, directions, quads, extent=gs.Extent.INSIDE):
    surface = gs.read_surface(CASES / f"{name}.obj", unit=gs.Unit.M)
    return gs.quadrangulate(surface, directions, quads=quads, extent=extent)


def box(found):
    return float(np.linalg.norm(np.ptp(found.curved.mesh.vertices, axis=0)))


@pytest.mark.parametrize("extent", list(gs.Extent))
@pytest.mark.parametrize("degrees", [60, 75])
def test_the_whole_of_figure_6(degrees, extent):
    start = time.perf_counter()
    found = remeshed("freeform", gs.Conjugate(radians(degrees)), QUADS[degrees], extent)
    control = found.control()
    middle = time.perf_counter()
    recipe = gs.pq_net(angle=radians(degrees))
    net = gs.optimize(control, recipe, anchor=gs.Free(), reference=found.reference)
    end = time.perf_counter()
    quality = net.quality
    within = np.abs(np.degrees(gs.node_angles(net.control)) - degrees) < 1.0
    distance = quality.surface_distance_mm.mean / box(found)
    print(
        f"\nfreeform {degrees} {extent.value}: {len(control.vertices)} control vertices, "
        f"remeshing {middle - start:.2f} s, optimising {end - middle:.2f} s in {len(net.steps)} "
        f"steps; planarity max {quality.face_planarity.max:.1e} (1e-4), mean "
        f"{quality.face_planarity.mean:.1e} (1e-5); {within.mean():.1%} within 1 degree (95 %), "
        f"worst {quality.angle_error_deg.max:.1e}; distance {distance:.3%} of the box (0.2 %); "
        f"edges {quality.edge_ratio[0]:.2f} .. {quality.edge_ratio[1]:.2f}"
    )
    assert net.converged
    assert quality.face_planarity.max < 1e-4
    assert quality.face_planarity.mean < 1e-5
    assert within.mean() >= 0.95
    assert distance < 0.002


@pytest.mark.parametrize(("name", "singular"), [("monkey", 1), ("enneper", 0)])
def test_asymptotic_nets_and_their_lamellas(name, singular):
    found = remeshed(name, gs.Asymptotic(), 1000, gs.Extent.COVER)
    net = gs.optimize(found.control(), gs.a_net(), anchor=gs.Free(), reference=found.reference)
    control = net.require().control
    turning = np.flatnonzero((control.mesh.valence != 4) & ~control.mesh.on_boundary)
    assert len(turning) == singular
    loose = 0
    for skin in gs.diagonal_meshes(control):
        for line in gs.polylines(skin):
            if not line.closed:
                ends = line.vertices[[0, -1]]
                at_rim = ~skin.stars.closed[ends]
                loose += int(
                    np.count_nonzero(~at_rim & ~np.isin(skin.control_vertices[ends], turning))
                )
    quality = net.quality
    print(
        f"\n{name}: {len(control.vertices)} control vertices, star planarity "
        f"{quality.star_planarity.max:.1e} (1e-5) in {len(net.steps)} steps; lines that end "
        f"inside: {loose}; distance {quality.surface_distance_mm.mean / box(found):.3%} of the box"
    )
    assert quality.star_planarity.max < 1e-5
    assert loose == 0


def test_the_trade_off_between_surface_and_net():
    """A strong pull to the surface costs even edges, in the end the net; the default is between."""
    default = gs.pq_net().proximity
    reached = {}
    print("\nproximity  net            angle   planarity  distance  shortest edge  converged")
    cases = [
        ("freeform", gs.Conjugate(radians(60.0)), lambda: gs.pq_net(angle=radians(60.0))),
        ("enneper", gs.Asymptotic(), lambda: gs.a_net(angle=radians(60.0))),
    ]
    for name, directions, recipe in cases:
        found = remeshed(name, directions, 860)
        control = found.control()
        for start in (0.01, 0.1, 1.0, 10.0, 100.0):
            pulled = replace(recipe(), proximity=replace(default, start=start))
            net = gs.optimize(control, pulled, anchor=gs.Free(), reference=found.reference)
            quality = net.quality
            flat = quality.face_planarity or quality.star_planarity
            distance = quality.surface_distance_mm.mean / box(found)
            reached[name, start] = (net.converged, distance, quality.edge_ratio[0])
            print(
                f"{start:9g}  {name:<13} {quality.angle_error_deg.max:7.1e}  {flat.max:9.1e}  "
                f"{distance:8.4%}  {quality.edge_ratio[0]:13.2f}  {net.converged}"
            )
    free, asked = (reached["freeform", w] for w in (0.01, default.start))
    assert asked[0]
    assert asked[1] < free[1]
    # Enneper's own angles are 90 degrees: a net of 60 has to leave it, and must be allowed to
    assert reached["enneper", default.start][0]
    assert not reached["enneper", 100.0][0]


@pytest.mark.parametrize(
    ("name", "degrees", "directions"),
    [("freeform", 60, gs.Conjugate(radians(60.0))), ("dome", 90, gs.Principal())],
)
def test_planar_rhombi_on_a_given_surface(name, degrees, directions):
    """Planarity, angle and rhombi at once: a surface let go in time gives all, a held one none."""
    found = remeshed(name, directions, 860)
    control, size = found.control(), box(found)
    print(
        f"\n{name} {degrees}: pull  planarity  angle deg  rhombus   distance mean, max  converged"
    )
    reached = {}
    for start in (0.01, 0.1, 1.0, 10.0):
        for decay in (0.3, 1.0):
            recipe = gs.pq_net(angle=radians(degrees), rhombus=True, steps=60)
            pulled = replace(recipe, proximity=gs.Weight(start, decay))
            net = gs.optimize(control, pulled, anchor=gs.Free(), reference=found.reference)
            quality = net.quality
            distance = quality.surface_distance_mm
            reached[start, decay] = (net.converged, distance.mean / size)
            print(
                f"{'falling' if decay < 1 else 'constant':>9} {start:5g}  "
                f"{quality.face_planarity.max:9.1e}  {quality.angle_error_deg.max:9.1e}  "
                f"{quality.rhombus_error.max:7.1e}  {distance.mean / size:7.3%} "
                f"{distance.max / size:6.2%}  {net.converged}"
            )
    assert reached[0.1, 0.3][0]
    assert reached[0.1, 0.3][1] < 0.002
    assert not reached[1.0, 1.0][0]
