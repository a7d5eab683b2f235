from dataclasses import replace

import numpy as np
import pytest

import gridshell as gs
from fabrication.export.dxf import DxfPart
from fabrication.export.step_prism_reader import read_prisms
from fabrication.panel_loop import panel_closure
from fabrication.sheet_parts import panel_piece, plate_piece

pytestmark = pytest.mark.xdist_group("kernel")


def drawn(built):
    pieces = [*map(panel_piece, built.panels), *map(plate_piece, built.plates)]
    return [DxfPart(p.mark, p.outline - p.outline[0]) for p in pieces]


@pytest.fixture
def read(bodies_file):
    return lambda built: read_prisms(bodies_file(built))


@pytest.mark.parametrize("which", ["tower", "leaning"])
def test_files_close_onto_the_net(which, request, read):
    built = request.getfixturevalue(which)
    closed = panel_closure(built.mesh, built.system, drawn(built), read(built))
    assert closed.max_mm < 1e-3
    assert closed.volume_ppm < 1.0
    counts = (len(built.panels), len(built.plates), len(built.connectors))
    assert (closed.panels, closed.plates, closed.connectors) == counts


def test_an_outline_that_is_off_is_found_at_its_part(leaning, read):
    parts = drawn(leaning)
    grown = parts[3].outline * (1.0 + 1e-3)
    parts[3] = DxfPart(parts[3].mark, grown)
    closed = panel_closure(leaning.mesh, leaning.system, parts, read(leaning))
    assert closed.worst == "P4"
    assert 0.1 < closed.sheet_mm < 5.0
    assert closed.volume_ppm == pytest.approx(2001.0, rel=1e-2)


@pytest.mark.parametrize("mark", ["P3", "S3", "N3"])
def test_a_solid_that_is_moved_is_found_at_its_part(leaning, read, mark):
    prisms = [
        replace(p, low=p.low + 0.2, high=p.high + 0.2) if p.mark == mark else p
        for p in read(leaning)
    ]
    closed = panel_closure(leaning.mesh, leaning.system, drawn(leaning), prisms)
    assert closed.worst == mark
    assert closed.solid_mm == pytest.approx(0.2 * np.sqrt(3.0), abs=1e-3)
    assert closed.sheet_mm < 1e-3


def test_a_net_that_is_another_one_is_found(leaning, read):
    other = gs.panel_mesh(leaning.mesh.vertices * 1.001, leaning.mesh.faces, leaning.mesh.axes)
    closed = panel_closure(other, leaning.system, drawn(leaning), read(leaning))
    assert closed.sheet_mm > 0.3


@pytest.mark.parametrize("mark", ["P3", "S3", "N3"])
def test_a_part_that_is_missing_is_named(leaning, read, mark):
    prisms = [p for p in read(leaning) if p.mark != mark]
    with pytest.raises(gs.FileError) as info:
        panel_closure(leaning.mesh, leaning.system, drawn(leaning), prisms)
    assert info.value.where == mark


def test_an_outline_with_other_corners_is_refused(leaning, read):
    parts = drawn(leaning)
    parts[0] = DxfPart("P1", parts[0].outline[:3])
    with pytest.raises(gs.FileError, match="not the one"):
        panel_closure(leaning.mesh, leaning.system, parts, read(leaning))
