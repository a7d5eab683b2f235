"""The job of 01_enneper_60.toml as a script: surface, net, lamellas, sheets and solids."""

import sys
from math import radians
from pathlib import Path

import fabrication as fab
import gridshell as gs

out = Path(sys.argv[1] if len(sys.argv) > 1 else "out")

surface = gs.Enneper(scale=4000.0)
patch = gs.AsymptoticPatch(p=(-1.0, 1.0), q=(-1.0, 1.0), lamellas=(15, 15))
control = gs.control_patch(surface, patch)
result = gs.optimize(control, gs.a_net(angle=radians(60)), anchor=gs.Free()).require()
net = gs.diagonal_meshes(result.control)[0]

structure = fab.structure(net, fab.Profile(width=100.0, thickness=2.5, material=fab.STAINLESS))
parts = fab.flat_parts(structure, fab.SlotJoint(clearance=0.3))
sheets = fab.nest(parts, fab.Sheet(12000.0, 1500.0))
files = fab.write_dxf(sheets, out / "sheets")
solids = fab.solids(structure, parts)
fab.write_step(fab.assembly(solids, structure, name="enneper-60"), out / "structure.step")

print(result.status)
print(f"{len(parts)} lamellas, longest {max(part.length for part in parts):.1f} mm")
print(f"{len(files)} sheets and structure.step in {out}")
