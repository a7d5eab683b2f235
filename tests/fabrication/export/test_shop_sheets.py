"""Sheets written for a shop: layers, names, formats, half a kerf; all of it read back."""

from dataclasses import replace

import ezdxf
import numpy as np
import pytest
from shapely import Polygon

import fabrication as fab
import gridshell as gs
from fabrication.cut import Edge, Floor, Hole, Relief, Slot, outline
from fabrication.export.dxf import read_dxf, write_dxf
from fabrication.export.dxf_lint import lint_dxf
from fabrication.parts import Label
from fabrication.shop import Cutting, DxfVersion, FileNames, Layers, Process, preset
from fabrication.unroll import Development

NAMED = Layers(cut="0_CUT", mark="ENGRAVE", text="NOTES", sheet="STOCK", drill="DRILL")


def strip(mark, relief, diameter=9.0):
    slots = tuple(
        Slot(90.0 + 160.0 * k, 5.0, 50.5, Edge.LOWER, f"N{k}", f"B{k}", relief) for k in range(2)
    )
    return fab.FlatPart(
        mark,
        outline(340.0, 100.0, slots),
        slots,
        (Label(mark, 170.0, 80.0, 10.0),),
        100.0,
        2.5,
        Development(340.0, np.zeros(0), 0.0, 0.0),
        (Hole(170.0, 50.0, diameter, "N0", "bolt"), Hole(30.0, 40.0, 12.0, "N0", "bolt")),
    )


PARTS = (
    strip("A1", Relief()),
    strip("A2", Relief(Floor.ROUND)),
    strip("A3", Relief(Floor.DOGBONE, 1.0)),
)


@pytest.fixture(scope="module")
def nested():
    return fab.nest(PARTS, fab.Sheet(400.0, 400.0))


PROCESSES = {
    version.value + kind: replace(base, version=version)
    for version in DxfVersion
    for kind, base in {
        "": Process(),
        " named": Process(layers=NAMED, files=FileNames("{name}_{material}_{thickness}_{number}")),
        " compensated": Process(layers=NAMED, kerf=0.3, compensate=True),
        " laser": preset(Cutting.LASER, 2.5),
    }.items()
}


@pytest.fixture(params=PROCESSES)
def written(request, nested, tmp_path):
    process = PROCESSES[request.param]
    (path,) = write_dxf(nested, tmp_path, name="Dach 1", material="S235", process=process)
    return process, path


def test_what_is_written_is_read_back(written):
    process, path = written
    for found, part in zip(read_dxf(path, process), PARTS, strict=True):
        assert found.mark == part.mark
        np.testing.assert_allclose(found.outline, part.outline, atol=1e-6)
        expected = part.circles[np.lexsort(part.circles.T[1::-1])]
        np.testing.assert_allclose(found.circles, expected, atol=1e-6)


def test_no_fault_is_found_in_it(written):
    process, path = written
    assert lint_dxf(path, process, PARTS) == ()


def test_the_audit_finds_nothing(written):
    audit = ezdxf.readfile(written[1]).audit()
    assert (audit.errors, audit.fixes) == ([], [])


def test_the_file_has_the_format_and_lines_of_that_time(written):
    process, path = written
    document = ezdxf.readfile(path)
    assert document.acad_release == process.version.value
    kinds = {entity.dxftype() for entity in document.modelspace()}
    line = "POLYLINE" if process.version is DxfVersion.R12 else "LWPOLYLINE"
    assert kinds == {line, "CIRCLE", "TEXT"}


def test_everything_lies_on_layers_with_the_shops_names(written):
    process, path = written
    found = {
        (entity.dxf.layer, entity.dxftype()[-4:])
        for entity in ezdxf.readfile(path).modelspace()
        if entity.dxftype() != "TEXT"
    }
    named = process.layers.named
    lines = {(named[key], "LINE") for key in ("cut", "mark", "sheet")}
    assert found == lines | {(named["drill"], "RCLE")}


def test_the_oldest_format_says_mm_in_the_title(nested, tmp_path):
    (path,) = write_dxf(nested, tmp_path, process=Process(version=DxfVersion.R12))
    title = ezdxf.readfile(path).modelspace().query("TEXT")[0]
    assert title.dxf.text.endswith("all lengths in mm")


def test_the_file_is_named_by_the_template(nested, tmp_path):
    process = Process(files=FileNames("{name}_{material}_{thickness}_{number}"))
    (path,) = write_dxf(nested, tmp_path, name="Dach / 1", material="S235", process=process)
    assert path.name == "Dach_1_S235_2.5_mm_01.dxf"


def test_lines_lie_half_a_kerf_outside(nested, tmp_path):
    process = Process(kerf=0.4, compensate=True)
    (path,) = write_dxf(nested, tmp_path, process=process)
    for drawn, part in zip(read_dxf(path), PARTS, strict=True):
        low, high = drawn.outline[:, :2].min(axis=0), drawn.outline[:, :2].max(axis=0)
        np.testing.assert_allclose(high - low, (part.length + 0.4, part.width + 0.4), atol=1e-9)
        np.testing.assert_allclose(sorted(drawn.circles[:, 2]), [8.6, 11.6])
    first = Polygon(read_dxf(path)[0].outline[:, :2])
    assert (
        first.symmetric_difference(Polygon(PARTS[0].outline).buffer(0.2, join_style="mitre")).area
        == pytest.approx(0.0, abs=1.0)
        or first.area > PARTS[0].area
    )


def test_a_kerf_alone_changes_nothing(nested, tmp_path):
    (plain,) = write_dxf(nested, tmp_path / "a")
    (laser,) = write_dxf(nested, tmp_path / "b", process=Process(kerf=0.4))
    for a, b in zip(read_dxf(plain), read_dxf(laser), strict=True):
        np.testing.assert_array_equal(a.outline, b.outline)


def test_a_hole_smaller_than_the_kerf_is_refused(tmp_path):
    nested = fab.nest([strip("A1", Relief(), diameter=0.5)], fab.Sheet(400.0, 400.0))
    with pytest.raises(gs.SettingError, match="kerf leaves nothing of a hole"):
        write_dxf(nested, tmp_path, process=Process(kerf=1.0, compensate=True))


def test_a_sheet_of_another_shop_has_nothing_to_cut(nested, tmp_path):
    (path,) = write_dxf(nested, tmp_path, process=Process(layers=NAMED))
    assert "nothing-to-cut" in {finding.code for finding in lint_dxf(path)}
