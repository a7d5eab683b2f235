"""Figures of the first slice, beside the paper's; opt-in:

pytest tests/benchmarks -m benchmark -n 0 -s
"""

import json
import os
import resource
import subprocess
import sys
import time
from math import radians
from pathlib import Path
from statistics import median

import pytest

import gridshell as gs

pytestmark = pytest.mark.benchmark

PAPER_STEP_SECONDS = 0.25  # Table 1, Fig. 9: 1,440 quads, 10 steps, 2.5 s (C++, 2020)
LARGE = """
name = "large"
[surface]
kind = "enneper"
scale = 6000.0
[patch]
layout = "asymptotic"
p = [-1.0, 1.0]
q = [-1.0, 1.0]
lamellas = [30, 30]
[net]
angle = 60.0
anchor = "free"
keep_to_surface = false
[profile]
width = 100.0
thickness = 2.5
material = "stainless"
[joint]
kind = "slot"
[sheet]
length = 16000.0
width = 1500.0
"""


@pytest.mark.parametrize("degrees", [60, 75, 90])
def test_1440_quads_from_an_enneper_start(degrees):
    patch = gs.BisectingPatch(v=(-0.7778, 0.7778), cells=36, u=(-0.7, 0.7))
    control = gs.control_patch(gs.Enneper(4000.0), patch)
    assert len(control.quads) == 1440
    seconds = []
    for _ in range(5):
        start = time.perf_counter()
        result = gs.optimize(control, gs.a_net(angle=radians(degrees)), anchor=gs.Free())
        seconds.append(time.perf_counter() - start)
    quality, steps = result.quality, len(result.steps)
    per_step = median(seconds) / steps
    print(
        f"\n{degrees} degrees: {median(seconds):.2f} s in {steps} steps, "
        f"{per_step:.3f} s a step, paper/ours {PAPER_STEP_SECONDS / per_step:.1f}; "
        f"angle {quality.angle_error_deg.max:.1e} deg, star {quality.star_planarity.max:.1e}, "
        f"edges {quality.edge_ratio[0]:.2f} .. {quality.edge_ratio[1]:.2f}, "
        f"curvature ratio {quality.curvature_ratio:.5f}"
    )
    assert quality.angle_error_deg.max < 0.01
    assert quality.star_planarity.max < 1e-5
    assert quality.edge_ratio[0] > 0.5
    assert quality.edge_ratio[1] < 2.0
    assert steps <= 30
    assert median(seconds) < 1.0


def test_60_lamellas_with_900_nodes_mesh_to_files(tmp_path):
    project, out = tmp_path / "large.toml", tmp_path / "out"
    project.write_text(LARGE)
    start = time.perf_counter()
    command = [str(Path(sys.executable).with_name("gridshell")), "run", str(project)]
    subprocess.run([*command, "--out", str(out), "--quiet"], check=True, env=os.environ)
    seconds = time.perf_counter() - start
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    report = json.loads((out / "report.json").read_text())
    print(f"\n60 lamellas, 900 nodes: {seconds:.1f} s, {peak:.0f} MiB, {report['timing']}")
    print(f"closure {report['closure']}, fit {report['fit']}")
    assert report["structure"]["lamellas"] == 60
    assert report["fit"]["nodes"] == 900
    assert seconds < 30.0
    assert peak < 1024
