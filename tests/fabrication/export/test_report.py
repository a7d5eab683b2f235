import base64
import json
import re
from dataclasses import replace

import numpy as np
import pytest
from plotly.offline import get_plotlyjs

import gridshell as gs
from fabrication.errors import OutputError
from fabrication.export.report import write_report
from fabrication.export.schedule import mass
from fabrication.joints import SlotJoint
from fabrication.nesting import nest
from fabrication.parts import flat_parts
from fabrication.stock import STAINLESS, Profile, Sheet
from fabrication.structures import structure

HOSTILE = "</script><script>alert('x')</script> & \"Söhne\""

REPORT = {
    "net": {
        "kind": "asymptotic",
        "vertices": 192,
        "faces": 168,
        "iterations": 9,
        "seconds": 0.83,
        "status": "Converged.",
        "angle_error_deg": {"max": 0.125, "mean": 0.05},
        "node_angle_deg": {"min": 59.9, "max": 60.1},
        "star_planarity": {"max": 2.6e-11, "mean": 4.0e-12},
        "edge_ratio": {"min": 0.857, "max": 1.24},
        "surface_distance_mm": {"max": 1.5, "mean": 0.4},
        "curvature_ratio": -0.333,
    },
    "structure": {
        "lamellas": 24,
        "nodes": 84,
        "joints": 84,
        "total_length_m": 314.2,
        "mass_kg": 1238.4,
        "max_edgewise_mm": 0.04,
        "max_edge_strain": 0.000312,
        "sheets": 1,
    },
    "closure": {
        "max_mm": 3.1e-4,
        "node_mm": 3.1e-4,
        "outline_mm": 4.2e-6,
        "volume_ppm": 12.3,
        "strips": 24,
        "slots": 192,
        "worst": "A7 at N13",
    },
    "fit": {"clash_mm3": {"max": 0.0}, "nodes": 84},
    "findings": [],
    "timing": {"optimise": 0.83, "STEP": 4.1},
}
FIGURES = 15


def finding(severity, **changes):
    whole = {"code": "bend-radius", "severity": severity, "where": "A1", "value": 900.0}
    return whole | {"limit": 1136.4, "message": "A1 bends too tightly."} | changes


def built(surface, patch):
    net, _ = gs.diagonal_meshes(gs.control_patch(surface, patch))
    shell = structure(net, Profile(100.0, 2.5, STAINLESS))
    return shell, flat_parts(shell, SlotJoint())


@pytest.fixture(scope="module")
def catenoid():
    return built(gs.Catenoid(1000.0), gs.BisectingPatch((-0.8, 0.8), 24))


@pytest.fixture
def page(tmp_path, catenoid):
    """Writes a page and returns it without the library."""

    def write(report=REPORT, name="Pavilion", design=catenoid):
        path = tmp_path / "report.html"
        write_report(path, name=name, report=report, structure=design[0], parts=design[1])
        text = path.read_text(encoding="utf-8")
        assert text.count(get_plotlyjs()) == 1
        return text.replace(get_plotlyjs(), "")

    return write


def figure(text):
    return json.loads(re.search(r"^const shell = (.*);$", text, re.MULTILINE)[1])


def trace(text, name):
    return next(trace for trace in figure(text)["data"] if trace["name"] == name)


def array(trace, names):
    columns = [np.frombuffer(base64.b64decode(trace[n]["bdata"]), trace[n]["dtype"]) for n in names]
    return np.stack(columns, axis=1).astype(float)


def visible(text):
    """The words between the tags; any blanks are one space."""
    body = re.sub(r"<(script|style)\b.*?</\1>", " ", text, flags=re.DOTALL)
    return re.sub(r"\s+", " ", re.sub(r"<[^>]*>", " ", body))


# ---- self-contained and safe ----------------------------------------------------------------


def test_nothing_is_fetched(page):
    text = page()
    markup = re.sub(r"<script>.*?</script>", "", text, flags=re.DOTALL)
    assert not re.findall(r"\b(?:src|href|srcset|action)\s*=|@import|url\(|<link|<iframe", markup)
    assert not re.findall(r"https?:|//\w+\.|fetch\(|XMLHttpRequest|import\(", text)


def test_the_policy_forbids_requests(page):
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', page())[1]
    assert policy.startswith("default-src 'none'")
    assert not re.search(r"https?:|'self'|\*", policy)


def test_hostile_texts_stay_texts(page, catenoid):
    shell, parts = catenoid
    marked = replace(shell.lamellas[0], mark=HOSTILE)
    shell = replace(shell, lamellas=(marked, *shell.lamellas[1:]))
    parts = (replace(parts[0], mark=HOSTILE), *parts[1:])
    report = REPORT | {
        "net": REPORT["net"] | {"status": HOSTILE, "kind": HOSTILE},
        "closure": REPORT["closure"] | {"worst": HOSTILE},
        "findings": [finding("error", code=HOSTILE, where=HOSTILE, message=HOSTILE)],
        "timing": {HOSTILE: 1.0},
    }
    text, tame = page(report, HOSTILE, (shell, parts)), page()
    assert text.count("<script") == tame.count("<script") == 2
    assert text.count("</script") == tame.count("</script") == 2
    assert "<h1>&lt;/script&gt;" in text
    assert trace(text, "Marks")["text"][0] == HOSTILE


def test_the_same_design_writes_the_same_page(page):
    assert page() == page()


def test_a_folder_that_is_missing_is_named(tmp_path, catenoid):
    path = tmp_path / "nowhere" / "report.html"
    with pytest.raises(OutputError, match="nowhere"):
        write_report(path, name="x", report=REPORT, structure=catenoid[0], parts=catenoid[1])


def test_sixty_lamellas_of_thirty_slots_stay_below_two_megabytes(page):
    design = built(gs.Enneper(4000.0), gs.AsymptoticPatch((-1, 1), (-1, 1), (30, 30)))
    assert len(design[0].lamellas) == 60
    assert len(design[0].nodes) == 900
    assert len(page(design=design).encode()) < 2e6


# ---- the shell ------------------------------------------------------------------------------


def test_the_strips_have_the_area_of_their_parts(page, catenoid):
    text = page()
    for family, letter in ((1, "A"), (2, "B")):
        mesh = trace(text, f"Family {letter}")
        corners = array(mesh, "xyz")[array(mesh, "ijk").astype(int)]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        wanted = sum(
            part.area
            for lamella, part in zip(catenoid[0].lamellas, catenoid[1], strict=True)
            if lamella.family == family
        )
        assert np.linalg.norm(normals, axis=1).sum() / 2.0 == pytest.approx(wanted / 1e6, rel=2e-3)


def test_every_slot_corner_is_on_the_outline(page, catenoid):
    shell, parts = catenoid
    lamella, part = shell.lamellas[0], parts[0]
    positions = np.array([node.position for node in shell.nodes])
    centre = (positions.min(axis=0) + positions.max(axis=0)) / 2.0
    x, y = part.outline.T
    corners = lamella.place(x + lamella.start, 0.0 * x, y - part.width / 2.0) - centre
    edges = array(trace(page(), "Family A, edges"), "xyz")
    apart = np.linalg.norm(corners[:, None] / 1e3 - edges[None], axis=2)
    assert np.nanmin(apart, axis=1).max() < 2e-4


def test_one_outline_per_lamella(page):
    edges = array(trace(page(), "Family B, edges"), "xyz")
    assert np.isnan(edges).all(axis=1).sum() == 12


def test_hovering_tells_mark_family_length_and_slots(page, catenoid):
    mesh, part = trace(page(), "Family B"), catenoid[1][12]
    assert part.mark == "B1"
    length = f"{part.length:,.1f}".replace(",", "\u202f")
    told = f"<b>B1</b>, family B<br>length {length} mm<br>{len(part.slots)} slots"
    assert mesh["meta"]["texts"][0] == told
    assert sum(mesh["meta"]["counts"]) == len(array(mesh, "x"))


def test_nodes_tell_name_angle_and_marks(page, catenoid):
    nodes, first = trace(page(), "Nodes"), catenoid[0].nodes[0]
    marks = " × ".join(catenoid[0].lamellas[c.lamella].mark for c in first.crossings)
    assert nodes["text"][0] == f"<b>N1</b><br>{np.degrees(first.angle):.2f}°<br>{marks}"
    assert len(nodes["text"]) == len(catenoid[0].nodes)


def test_every_mark_is_in_the_view_and_in_the_cut_list(page, catenoid):
    text = page()
    marks = [lamella.mark for lamella in catenoid[0].lamellas]
    assert trace(text, "Marks")["text"] == marks
    assert re.findall(r"</span>([AB]\d+)</td>", text) == marks


def test_the_camera_sees_everything_and_fills_the_frame(page):
    text = page()
    data = [array(trace(text, name), "xyz") for name in ("Family A", "Family B", "Marks")]
    points = np.concatenate(data)
    low, high = points.min(axis=0), points.max(axis=0)
    points = (points - (low + high) / 2.0) / np.cbrt(np.prod(high - low))
    camera = figure(text)["layout"]["scene"]["camera"]
    eye, centre = (np.array([camera[key][c] for c in "xyz"]) for key in ("eye", "center"))
    back = (eye - centre) / np.linalg.norm(eye - centre)
    right = np.cross([0.0, 0.0, 1.0], back)
    right /= np.linalg.norm(right)
    sight = points - eye
    depth = -(sight @ back) * np.tan(np.pi / 8.0)
    across = np.abs(sight @ right / depth).max() / 1.5
    upwards = np.abs(sight @ np.cross(back, right) / depth).max()
    assert depth.min() > 0.0
    assert 0.85 < max(across, upwards) <= 1.0


def test_a_shell_far_from_the_origin_keeps_its_shape(page, catenoid):
    def moved(by):
        patch = gs.BisectingPatch((-0.8, 0.8), 24)
        control = gs.control_patch(gs.Catenoid(1000.0), patch)
        net, _ = gs.diagonal_meshes(control.moved(control.vertices + by))
        shell = structure(net, Profile(100.0, 2.5, STAINLESS))
        return shell, flat_parts(shell, SlotJoint())

    here, there = (
        array(trace(page(design=moved(by)), "Nodes"), "xyz") for by in (0.0, [5e8, 5e9, 0.0])
    )
    np.testing.assert_allclose(here, there, atol=2e-4)


# ---- words and figures ----------------------------------------------------------------------


def test_a_whole_report_leaves_nothing_out(page):
    words = visible(page())
    assert "not measured" not in words
    assert words.count(" – ") == 1  # the page's own title
    for shown in (
        "0.1250°",
        "59.90 to 60.10°",
        "2.60 × 10⁻¹¹",
        "0.857 to 1.24",
        "1.500 mm",
        "−0.3330",
        "314.2 m",
        "1 238 kg",
        "0.0312 %",
        "3.10 × 10⁻⁴ mm",
        "12.3 ppm",
        "0 mm³",
        "A7 at N13",
        "Converged.",
    ):
        assert shown in words


@pytest.mark.parametrize("key", ["angle_error_deg", "surface_distance_mm", "curvature_ratio"])
def test_a_figure_that_is_none_is_not_measured(page, key):
    words = visible(page(REPORT | {"net": REPORT["net"] | {key: None}}))
    assert words.count("not measured") == 1


def test_an_empty_report_still_shows_the_structure(page):
    words = visible(page({}))
    assert words.count("not measured") == FIGURES
    assert "Not checked" in words
    assert "No findings" not in words
    assert "24 lamellas, 84 nodes" in words


def test_figures_that_are_not_finite_are_not_measured(page):
    figures = {"max_mm": float("nan"), "volume_ppm": float("inf")}
    assert visible(page(REPORT | {"closure": figures})).count("not measured") == 2


@pytest.mark.parametrize(
    ("severities", "level", "line"),
    [
        ([], "good", "Good: no findings"),
        (["info", "info"], "good", "Good, with 2 findings (2 info)"),
        (["warning"], "warning", "1 finding (1 warning)"),
        (["info", "error", "error"], "error", "3 findings (2 errors, 1 info)"),
        (["unheard-of"], "error", "1 finding (1 error)"),
    ],
)
def test_the_verdict_counts_the_findings(page, severities, level, line):
    text = page(REPORT | {"findings": [finding(severity) for severity in severities]})
    assert f'<p class="verdict {level}">{line}</p>' in text


def test_findings_are_listed_gravest_first(page):
    words = visible(page(REPORT | {"findings": [finding("info"), finding("error", limit=None)]}))
    error = "error bend-radius 1 place A1 bends too tightly."
    info = "info bend-radius 1 place A1 bends too tightly."
    assert words.index(error) < words.index("A1 900.0 – A1 bends too tightly.") < words.index(info)
    assert words.index(info) < words.index("A1 900.0 1 136 A1 bends too tightly.")
    assert "No findings." not in words


def test_findings_of_one_code_fold_into_one_line_that_counts_them(page):
    many = [finding("error", where=f"A{i}", message=f"A{i} is tight.") for i in range(1, 8)]
    text = page(REPORT | {"findings": [*many, finding("error", code="twist")]})
    assert text.count("<summary>") == 2
    words = visible(text)
    assert "error bend-radius 7 places A1 is tight." in words
    assert "error twist 1 place" in words
    for i in range(1, 8):
        assert f"A{i} 900.0 1 136 A{i} is tight." in words
    folded = re.findall(r"<details( open)?>", text)
    assert folded == ["", " open"]
    assert 'addEventListener("beforeprint"' in text  # paper cannot be unfolded


def test_twist_is_told_in_degrees_per_metre_and_powers_are_raised(page):
    twist = finding("error", code="twist", value=0.001, limit=0.0005, unit="rad/mm")
    stress = finding("error", code="edgewise-bend", unit="N/mm2", message="250 N/mm2, 3 mm3.")
    words = visible(page(REPORT | {"findings": [twist, stress]}))
    assert "A1 57.30 28.65 degrees/m" in words
    assert "N/mm² 250 N/mm², 3 mm³." in words
    assert "rad/mm" not in words
    assert not re.search(r"mm[23]\b", words)


def test_clearance_raw_sheet_and_sheet_of_every_part_are_told(tmp_path, catenoid):
    shell, parts = catenoid
    sheets = nest(parts, Sheet(6000.0, 700.0))
    assert len(sheets) > 1
    path = tmp_path / "report.html"
    more = {"sheets": sheets, "clearance": 0.25}
    write_report(path, name="x", report=REPORT, structure=shell, parts=parts, **more)
    text = path.read_text(encoding="utf-8").replace(get_plotlyjs(), "")
    words = visible(text)
    assert "Slots with 0.25 mm clearance." in words
    assert f"Cut from {len(sheets)} raw sheets of 6000 × 700 mm." in words
    number = {p.part.mark: sheet.number for sheet in sheets for p in sheet.placements}
    rows = re.findall(r"<tr>\s*<td data-value.*?</tr>", text, flags=re.DOTALL)
    for part, row in zip(parts, rows, strict=True):
        cells = re.findall(r'data-value="([^"]*)"', row)
        assert float(cells[5]) == pytest.approx(mass(part, STAINLESS))
        assert int(cells[6]) == number[part.mark]


def test_what_is_not_checked_is_said(page):
    assert "Not checked: loads, deflections, buckling and supports" in visible(page())


def test_the_cut_list_tells_lengths_slots_and_totals(page, catenoid):
    words, parts = visible(page()), catenoid[1]
    first = parts[0]
    widths = [slot.width for slot in first.slots]
    length = f"{first.length:,.1f}".replace(",", " ")
    row = f"{first.mark} {length} {len(widths)} {min(widths):.2f} {max(widths):.2f}"
    assert row in words
    total = f"{sum(part.length for part in parts):,.1f}".replace(",", " ")
    assert f"24 strips {total} {sum(len(part.slots) for part in parts)}" in words


def test_the_longest_strip_is_drawn_with_its_stations(page, catenoid):
    text = page()
    part = max(catenoid[1], key=lambda part: round(part.length, 1))
    drawing = text[text.index("<svg") : text.index("</svg>")]
    for station in (0.0, *(slot.x for slot in part.slots), part.length):
        assert f">{station:,.1f}</text>".replace(",", "\u202f") in drawing
    for slot in part.slots:
        assert f">{slot.partner}</text>" in drawing
    corners = re.search(r'points="([^"]*)"', drawing)[1].split()
    assert len(corners) == len(part.outline)


def test_times_are_listed(page):
    assert "optimise 0.83 STEP 4.10" in visible(page())
