import re

import numpy as np
import pytest

import fabrication as fab
from fabrication.errors import OutputError
from fabrication.export.panel_report import write_panel_report
from fabrication.export.panel_schedule import COLUMNS, schedule_rows, write_panel_schedule
from fabrication.export.scene.panels import group_colours
from fabrication.export.scene.whole import panel_scene
from fabrication.sheet_parts import panel_piece, plate_piece


def sheets(built):
    sheet = fab.Sheet(3000.0, 2000.0)
    panels = fab.nest([panel_piece(p) for p in built.panels], sheet)
    return panels, fab.nest([plate_piece(p) for p in built.plates], sheet)


REPORT = {
    "net": {
        "kind": "planar",
        "face_planarity": {"mean": 1e-10, "max": 2e-10},
        "angle_error_deg": None,
        "node_angle_deg": {"min": 70.0, "max": 70.0},
        "edge_ratio": {"min": 0.9, "max": 1.1},
        "surface_distance_mm": None,
        "curvature_ratio": -0.5,
        "status": "Converged.",
    },
    "structure": {
        **{"panels": 12, "plates": 31, "connectors": 20, "panel_groups": 12, "plate_groups": 31},
        **{"connector_groups": 20, "distinct_solids": 63, "panel_area_m2": 7.5, "mass_kg": 300.0},
        **{"panel_planarity_mm": {"max": 1e-7}, "corner_angle_deg": {"min": 66.0, "max": 114.0}},
        **{"sheets": 9, "panel_sheets": 6, "plate_sheets": 3},
    },
    "supports": {
        "out_of_plane_mm": {"max": 1.25},
        "twist_deg": {"max": 3.5},
        "classical_out_of_plane_mm": {"max": 1.5},
        "classical_twist_deg": {"max": 4.5},
        **{"flat": 0, "plates": 31},
    },
    "closure": {"max_mm": 1e-7, "sheet_mm": 1e-8, "solid_mm": 1e-7, "worst": "P3"}
    | {"volume_ppm": 0.1},
    "findings": [],
    "timing": {"sheets": 1.0},
}


@pytest.fixture(scope="module")
def page(leaning, tmp_path_factory):
    path = tmp_path_factory.mktemp("page") / "report.html"
    panels, plates = sheets(leaning)
    write_panel_report(
        path,
        name="A <shell>",
        report=REPORT,
        built=leaning,
        panel_sheets=panels,
        plate_sheets=plates,
    )
    return path.read_text()


def test_the_page_shows_the_figures_and_asks_nothing_of_the_network(page):
    assert "A &lt;shell&gt;" in page
    for figure in ("1.250", "3.500°", "66.0 to 114.0", "12 groups within 0.5 mm"):
        assert figure in page
    own = re.sub(r"<script.*?</script>", "", page, flags=re.DOTALL)
    assert not re.search(r"""(src|href)=["']http""", own)
    assert "default-src 'none'" in page


def test_the_sheets_of_the_page_are_those_of_panels_and_plates(page, leaning):
    panels, plates = sheets(leaning)
    drawn = re.findall(r"<b class=\"code\">([^<]+)</b>", page)
    assert drawn == [
        *(f"panels-{sheet.number:02d}.dxf" for sheet in panels),
        *(f"plates-{sheet.number:02d}.dxf" for sheet in plates),
    ]


def test_the_cut_list_of_the_page_has_every_part(page, leaning):
    parts = [*leaning.panels, *leaning.plates, *leaning.connectors]
    for part in parts:
        assert f"</span>{part.mark}</td>" in page


def test_a_page_that_cannot_be_written_is_an_output_error(leaning, tmp_path):
    panels, plates = sheets(leaning)
    with pytest.raises(OutputError):
        write_panel_report(
            tmp_path / "none" / "x.html",
            name="x",
            report=REPORT,
            built=leaning,
            panel_sheets=panels,
            plate_sheets=plates,
        )


def test_rows_are_parts_in_their_order(leaning):
    rows = schedule_rows(leaning, *sheets(leaning))
    parts = [*leaning.panels, *leaning.plates, *leaning.connectors]
    assert [row.mark for row in rows] == [part.mark for part in parts]
    assert rows[0].angles == pytest.approx(np.degrees(leaning.panels[0].corner_angles))
    assert sum(rows[12].angles) == pytest.approx(360.0)
    assert rows[-1].sheet == ""


def test_the_csv_has_a_line_for_every_row(leaning, tmp_path):
    path = tmp_path / "parts.csv"
    write_panel_schedule(path, leaning, *sheets(leaning))
    lines = path.read_text().splitlines()
    assert lines[0] == ",".join(COLUMNS)
    assert len(lines) == 1 + 12 + 31 + 20
    with pytest.raises(OutputError):
        write_panel_schedule(tmp_path / "none" / "parts.csv", leaning, *sheets(leaning))


def test_the_view_has_every_panel_plate_and_connector_to_point_at(leaning):
    scene = panel_scene(leaning).packed()
    named = {layer["id"]: layer for layer in scene["layers"]}
    for name, parts in (("panels", leaning.panels), ("plates", leaning.plates)):
        assert [about["mark"] for about in named[name]["parts"]] == [part.mark for part in parts]
        assert len(named[name]["sizes"]) == len(parts)
    assert any("N20" in about["mark"] for about in named["connectors"]["parts"])
    (off,) = scene["maps"]
    top = max(plate.out_of_plane for plate in leaning.plates)
    assert off["name"] == "Plates out of plane"
    assert float(off["high"].removesuffix(" mm")) == pytest.approx(top, rel=5e-3)


def test_flat_plates_are_of_one_colour(tower):
    assert panel_scene(tower).packed()["maps"] == []


def test_groups_of_several_have_colours_of_their_own(tower, leaning):
    assert len({tuple(colour) for colour in group_colours(tower.panel_groups).tolist()}) == 3
    singles = [g for g in leaning.panel_groups if len(g.members) == 1]
    assert len({tuple(c) for c in group_colours(singles).tolist()}) == min(1, len(singles))
