import re
import time
from dataclasses import replace

import numpy as np
import pytest
from pypdf import PdfReader

import fabrication as fab
import gridshell as gs
from fabrication.errors import OutputError
from fabrication.export.papers.lamella_paper import write_lamella_paper
from fabrication.export.papers.panel_paper import write_panel_paper
from fabrication.export.papers.sheet_frame import printable
from fabrication.export.quality_series import net_series
from fabrication.export.schedule import mass
from fabrication.jointed import BillLine
from fabrication.nesting import nest
from fabrication.outlines import Frame
from fabrication.sheet_parts import panel_piece, plate_piece
from fabrication.strength import NOT_CHECKED, bay_stress
from fabrication.words import fixed, number

REPORT = {
    "net": {
        "angle_error_deg": {"max": 1.25e-9, "mean": 5.5e-10},
        "node_angle_deg": {"min": 59.9, "max": 60.1},
        "star_planarity": {"max": 2.6e-11, "mean": 4.0e-12},
        "edge_ratio": {"min": 0.857, "max": 1.24},
        "surface_distance_mm": {"max": 1543.2, "mean": 412.3},
        "curvature_ratio": -0.3333,
    },
    "structure": {
        "lamellas": 10,
        "strips": 10,
        "nodes": 25,
        "joints": 25,
        "total_length_m": 314.2,
        "mass_kg": 1238.4,
        "max_edgewise_mm": 0.04,
        "max_edge_strain": 0.000312,
        "sheets": 1,
    },
    "closure": {"max_mm": 3.1e-4, "worst": "A1 at N3", "volume_ppm": 12.3},
    "fit": {"clash_mm3": {"max": 0.0}, "worst": "", "nodes": 25},
    "findings": [],
}
FINDING = {
    "code": "bend-radius",
    "severity": "error",
    "where": "A1",
    "value": 612.0,
    "limit": 700.0,
    "unit": "mm",
    "message": "A1 N5-N6 bends to a radius of 612 mm; S235 of 2.5 mm needs 700 mm.",
}
HOSTILE = "</script><b>&amp; (unbalanced \\ 屋根 " + "W" * 60


@pytest.fixture(scope="module")
def material(enneper):
    """Everything a report on lamellas needs."""
    jointed = fab.SlotJoint().build(enneper.structure)
    quality = gs.net_quality(enneper.control, angle=np.radians(60.0), reference=gs.Enneper(4000.0))
    return {
        "jointed": jointed,
        "parts": enneper.parts,
        "stress": bay_stress(jointed.strips, enneper.parts),
        "series": net_series(quality.figures),
        "sheets": nest(enneper.parts, fab.Sheet(6000.0, 1500.0)),
    }


def text_of(path):
    return [page.extract_text() for page in PdfReader(path).pages]


def written(path, material, *, name="roof", report=REPORT, **more):
    return write_lamella_paper(path, name=name, report=report, **{**material, **more})


def words(value):
    """A number as it is read off paper."""
    return printable(value).replace("\xa0", " ").replace("^", "\n")  # powers are runs of their own


def test_the_paper_holds_the_figures_of_the_report(tmp_path, material):
    text = "\n".join(text_of(written(tmp_path / "a.pdf", material)))
    net, built, closed = (REPORT[key] for key in ("net", "structure", "closure"))
    for value in (
        number(net["angle_error_deg"]["max"]),
        f"{fixed(59.9, 2)} to {fixed(60.1, 2)}",
        number(net["star_planarity"]["max"]),
        number(net["surface_distance_mm"]["max"]),
        number(net["curvature_ratio"]),
        f"{fixed(built['total_length_m'], 1)} m",
        f"{number(built['mass_kg'])} kg",
        number(closed["max_mm"]),
        closed["worst"],
        "Good: no findings",
    ):
        assert words(value) in text
    for line in NOT_CHECKED:
        assert line.split()[0] in text
    stress = material["stress"]
    worst = int(np.argmax(stress.utilisation))
    assert f"{fixed(100.0 * stress.utilisation[worst], 0)} %" in text
    assert stress.where(worst) in text


def test_every_strip_stands_in_both_tables_with_its_figures(tmp_path, material):
    text = "\n".join(text_of(written(tmp_path / "a.pdf", material)))
    for part in material["parts"]:
        assert len(re.findall(rf"^{part.mark}$", text, re.MULTILINE)) == 2
        assert words(fixed(part.length, 1)) in text
        weight = mass(part, material["jointed"].strips.profile.material)
        assert words(number(weight)) in text


def test_pages_are_numbered_and_portrait(tmp_path, material):
    reader = PdfReader(written(tmp_path / "a.pdf", material))
    count = len(reader.pages)
    assert 2 <= count <= 4
    for k, page in enumerate(reader.pages, start=1):
        assert page.mediabox.width < page.mediabox.height
        assert f"{k} / {count}" in page.extract_text()


def test_findings_are_told_by_their_kind(tmp_path, material):
    several = [FINDING, {**FINDING, "where": "A2"}, {**FINDING, "severity": "warning"}]
    report = {**REPORT, "findings": several}
    text = "\n".join(text_of(written(tmp_path / "a.pdf", material, report=report)))
    assert "3 findings (2 errors, 1 warning)" in text
    assert "bends to a radius of 612 mm" in " ".join(text.split())
    unchecked = {key: value for key, value in REPORT.items() if key != "findings"}
    text = "\n".join(text_of(written(tmp_path / "b.pdf", material, report=unchecked)))
    assert "Not checked" in text


def test_the_bill_is_there_where_something_is_bought(tmp_path, material):
    jointed = replace(material["jointed"], bill=(BillLine("bolt", "M8 x 40", 25, note="nodes"),))
    plain, bought = (
        "\n".join(text_of(written(tmp_path / "a.pdf", material, jointed=one)))
        for one in (material["jointed"], jointed)
    )
    assert "Bill of material" not in plain
    assert "M8 x 40" in bought


def test_a_report_without_figures_is_written(tmp_path, material):
    text = "\n".join(text_of(written(tmp_path / "a.pdf", material, report={}, series=())))
    assert "not measured" in text
    assert "Not checked" in text


def test_a_hostile_name_is_text(tmp_path, material):
    texts = text_of(written(tmp_path / "a.pdf", material, name=HOSTILE))
    joined = texts[0].replace("\n", "").replace(" ", "")
    assert printable(HOSTILE).replace(" ", "") in joined
    title = PdfReader(tmp_path / "a.pdf").metadata.title
    assert title == f"{printable(HOSTILE)}: report"


def test_the_same_design_gives_the_same_bytes(tmp_path, material, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    one, other = (written(tmp_path / name, material).read_bytes() for name in ("a.pdf", "b.pdf"))
    assert one == other
    assert "2023-11-14" in text_of(tmp_path / "a.pdf")[0]


def test_copies_are_drawn(tmp_path, material):
    pose = Frame(
        np.array([9000.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]), np.array([-1.0, 0.0, 0.0])
    )
    one, two = (
        len(
            PdfReader(written(tmp_path / "a.pdf", material, copies=copies))
            .pages[0]
            .get_contents()
            .get_data()
        )
        for copies in ((), (pose,))
    )
    assert two > 1.5 * one


def test_sixty_strips_take_less_than_a_second_and_little_room(tmp_path, profile):
    patch = gs.AsymptoticPatch(p=(-1.0, 1.0), q=(-1.0, 1.0), lamellas=(30, 30))
    net = gs.diagonal_meshes(gs.control_patch(gs.Enneper(8000.0), patch))[0]
    jointed = fab.SlotJoint().build(fab.structure(net, profile))
    parts = fab.parts_of(jointed)
    stress = bay_stress(jointed.strips, parts)
    begun = time.perf_counter()
    path = write_lamella_paper(
        tmp_path / "a.pdf",
        name="n",
        report=REPORT,
        series=(),
        jointed=jointed,
        parts=parts,
        stress=stress,
    )
    assert time.perf_counter() - begun < 1.0
    assert path.stat().st_size < 1_500_000


def test_a_paper_that_cannot_be_written_is_told(tmp_path, material):
    with pytest.raises(OutputError, match="report"):
        written(tmp_path / "none" / "a.pdf", material)


def test_panels_have_a_paper_likewise(tmp_path, tower):
    sheet = fab.Sheet(6000.0, 3000.0)
    panels = nest([panel_piece(panel) for panel in tower.panels], sheet)
    plates = nest([plate_piece(plate) for plate in tower.plates], sheet)
    report = {
        "net": {"face_planarity": {"max": 1.5e-10, "mean": 2e-11}, "curvature_ratio": -1.0},
        "structure": {"panels": 24, "panel_area_m2": 12.34, "mass_kg": 456.7, "panel_groups": 3},
        "supports": {"out_of_plane_mm": {"max": 0.0123}, "flat": 56, "plates": 56},
        "findings": [],
    }
    one, other = (
        write_panel_paper(
            tmp_path / name,
            name="tower",
            report=report,
            series=(),
            built=tower,
            panel_sheets=panels,
            plate_sheets=plates,
        )
        for name in ("a.pdf", "b.pdf")
    )
    assert one.read_bytes() == other.read_bytes()
    text = "\n".join(text_of(one))
    for value in ("24", "12.34 m²", "456.7 kg", "0.01230 mm", "56 of 56 plates flat"):
        assert value in text
    for part in (*tower.panels, *tower.plates):
        assert re.search(rf"^{part.mark}$", text, re.MULTILINE)
