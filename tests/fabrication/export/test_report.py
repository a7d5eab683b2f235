import base64
import json
import re
import zlib
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest

import gridshell as gs
from fabrication.cut import Floor, Hole, Relief
from fabrication.errors import OutputError
from fabrication.export.quality_series import net_series
from fabrication.export.report import write_report
from fabrication.export.scene.page import scripts
from fabrication.export.schedule import mass
from fabrication.export.sheet_drawing import sheet_drawings
from fabrication.export.sheet_files import sheet_files
from fabrication.jointed import BillLine
from fabrication.joints import DoubleSlotJoint, SlotJoint, StarWasher
from fabrication.nesting import nest
from fabrication.outlines import Frame
from fabrication.parts import parts_of
from fabrication.shapes import Body, Prisms, Shape, circle
from fabrication.stock import S235, STAINLESS, Profile, Sheet
from fabrication.strength import NOT_CHECKED, bay_stress
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
    jointed = SlotJoint().build(shell)
    return jointed, parts_of(jointed)


def doubled(surface, patch):
    net, _ = gs.diagonal_meshes(gs.control_patch(surface, patch))
    shell = structure(net, Profile(100.0, 1.5, S235))
    jointed = DoubleSlotJoint(30.0, 8.0, StarWasher(4.0, 18.0, 8.0, S235)).build(shell)
    return jointed, parts_of(jointed)


@pytest.fixture(scope="module")
def catenoid():
    return built(gs.Catenoid(1000.0), gs.BisectingPatch((-0.8, 0.8), 24))


@pytest.fixture
def page(tmp_path, catenoid):
    """Writes a page and returns it without the library."""

    def write(report=REPORT, name="Pavilion", design=catenoid):
        path = tmp_path / "report.html"
        write_report(path, name=name, report=report, jointed=design[0], parts=design[1])
        text = path.read_text(encoding="utf-8")
        assert text.count(scripts()) == 1
        return text.replace(scripts(), "")

    return write


def scene(text):
    return json.loads(re.search(r'id="scene">(.*?)</script>', text, re.DOTALL)[1])


def layer(text, name):
    return next(layer for layer in scene(text)["layers"] if layer["id"] == name)


def numbers(packed, width=None):
    """An array as the page unpacks it; so many columns."""
    kind = {"f4": "<f4", "u1": "u1", "u4": "<u4"}[packed["kind"]]
    found = np.frombuffer(base64.b64decode(packed["bytes"]), kind)
    found = found.astype(float if kind == "<f4" else int)
    return found if width is None else found.reshape(-1, width)


def strip_points(strips):
    """Points of strips, as the page lays them: along each column's own direction."""
    frames = numbers(strips["frames"], 9)[numbers(strips["columns"])]
    return frames[:, :3] + numbers(strips["heights"])[:, None] * frames[:, 6:]


def edges_of(text, name):
    """Points of the edges; NaN between two strips."""
    strips = layer(text, name)
    return np.vstack([strip_points(strips), np.full((1, 3), np.nan)])[numbers(strips["loops"])]


def visible(text):
    """The words between the tags; any blanks are one space."""
    body = re.sub(r"<(script|style)\b.*?</\1>", " ", text, flags=re.DOTALL)
    return re.sub(r"\s+", " ", re.sub(r"<[^>]*>", " ", body))


# ---- self-contained and safe ----------------------------------------------------------------


def test_nothing_is_fetched(page):
    text = page()
    markup = re.sub(r"<script.*?</script>", "", text, flags=re.DOTALL)
    assert not re.findall(r"\b(?:src|href|srcset|action)\s*=|@import|url\(|<link|<iframe", markup)
    own = text.replace("http://www.w3.org/2000/svg", "")  # a name, not an address
    assert not re.findall(r"https?:|//\w+\.|fetch\(|XMLHttpRequest", own)


def test_the_policy_forbids_requests(page):
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', page())[1]
    assert policy.startswith("default-src 'none'")
    assert not re.search(r"https?:|'self'|\*", policy)


def test_hostile_texts_stay_texts(page, catenoid):
    jointed, parts = catenoid
    shell = jointed.design
    marked = replace(shell.lamellas[0], mark=HOSTILE)
    shell = replace(shell, lamellas=(marked, *shell.lamellas[1:]))
    line = BillLine(HOSTILE, HOSTILE, 1.0, HOSTILE, HOSTILE, None, HOSTILE)
    ring = Shape(HOSTILE, circle(5.0), 0.0, 2.0)
    body = Body(HOSTILE, 0, Frame(np.zeros(3), np.eye(3)[0], np.eye(3)[1]))
    bad = Prisms(HOSTILE, (0.5, 0.5, 0.5), (ring,), (body,))
    jointed = replace(jointed, design=shell, strips=shell, bill=(line,), connectors=(bad,))
    parts = (replace(parts[0], mark=HOSTILE), *parts[1:])
    report = REPORT | {
        "net": REPORT["net"] | {"status": HOSTILE, "kind": HOSTILE},
        "closure": REPORT["closure"] | {"worst": HOSTILE},
        "findings": [finding("error", code=HOSTILE, where=HOSTILE, message=HOSTILE)],
        "timing": {HOSTILE: 1.0},
    }
    text, tame = page(report, HOSTILE, (jointed, parts)), page()
    assert text.count("<script") == tame.count("<script") == 4
    assert text.count("</script") == tame.count("</script") == 4
    assert "<h1>&lt;/script&gt;" in text
    assert layer(text, "marks")["texts"][0] == HOSTILE


def test_the_same_design_writes_the_same_page(page):
    assert page() == page()


def test_a_folder_that_is_missing_is_named(tmp_path, catenoid):
    path = tmp_path / "nowhere" / "report.html"
    with pytest.raises(OutputError, match="nowhere"):
        write_report(path, name="x", report=REPORT, jointed=catenoid[0], parts=catenoid[1])


def test_sixty_lamellas_of_thirty_slots_stay_below_two_megabytes(page):
    design = built(gs.Enneper(4000.0), gs.AsymptoticPatch((-1, 1), (-1, 1), (30, 30)))
    assert len(design[0].design.lamellas) == 60
    assert len(design[0].design.nodes) == 900
    assert len(page(design=design).encode()) < 2e6


# ---- the shell ------------------------------------------------------------------------------


def test_the_strips_have_the_area_of_their_parts(page, catenoid):
    text = page()
    for family, letter in ((1, "A"), (2, "B")):
        strips = layer(text, f"strips-{letter}")
        corners = strip_points(strips)[numbers(strips["faces"], 3)]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        wanted = sum(
            part.area
            for lamella, part in zip(catenoid[0].strips.lamellas, catenoid[1], strict=True)
            if lamella.family == family
        )
        assert np.linalg.norm(normals, axis=1).sum() / 2.0 == pytest.approx(wanted / 1e6, rel=2e-3)


def test_every_slot_corner_is_on_the_outline(page, catenoid):
    shell, parts = catenoid[0].design, catenoid[1]
    lamella, part = shell.lamellas[0], parts[0]
    positions = np.array([node.position for node in shell.nodes])
    centre = (positions.min(axis=0) + positions.max(axis=0)) / 2.0
    x, y = part.outline.T
    corners = lamella.place(x + lamella.start, 0.0 * x, y - part.width / 2.0) - centre
    edges = edges_of(page(), "strips-A")
    apart = np.linalg.norm(corners[:, None] / 1e3 - edges[None], axis=2)
    assert np.nanmin(apart, axis=1).max() < 2e-4


def test_one_outline_per_lamella(page):
    edges = edges_of(page(), "strips-B")
    assert np.isnan(edges).all(axis=1).sum() == 12


def test_a_strip_tells_mark_family_length_and_slots(page, catenoid):
    strips, part = layer(page(), "strips-B"), catenoid[1][12]
    first = strips["parts"][0]
    assert first["mark"] == part.mark == "B1"
    length = f"{part.length:,.1f}".replace(",", "\u202f")
    told = ["family B", f"length {length} mm", f"{len(part.slots)} slots"]
    assert first["lines"][:3] == told
    assert re.fullmatch(r"\d+ % used at N\d+-N\d+", first["lines"][3])
    assert sum(strips["sizes"]) == len(numbers(strips["faces"], 3))
    assert sum(strips["counts"]) == len(numbers(strips["x"]))


def test_nodes_tell_name_angle_and_marks(page, catenoid):
    design = catenoid[0].design
    nodes, first = layer(page(), "nodes"), design.nodes[0]
    marks = " × ".join(design.lamellas[c.lamella].mark for c in first.crossings)
    told = [f"{np.degrees(first.angle):.2f}°", marks]
    assert nodes["parts"][0] == {"mark": "N1", "lines": told}
    assert len(nodes["parts"]) == len(numbers(nodes["points"], 3)) == len(design.nodes)


def test_the_columns_of_a_strip_lie_as_far_apart_as_on_the_flat_part(page):
    """What the page bends from flat to built keeps its length."""
    strips = layer(page(), "strips-A")
    places, x = numbers(strips["frames"], 9)[:, :3], numbers(strips["x"])
    first = 0
    for count in strips["counts"]:
        own = slice(first, first + count)
        chords = np.linalg.norm(np.diff(places[own], axis=0), axis=1)
        assert chords.sum() == pytest.approx(x[own][-1] - x[own][0], rel=2e-3)
        first += count


def test_every_strip_has_its_flat_pattern(page, catenoid):
    deflated = base64.b64decode(re.search(r'id="patterns">(.*?)</script>', page(), re.DOTALL)[1])
    patterns = json.loads(zlib.decompress(deflated))
    assert list(patterns) == [part.mark for part in catenoid[1]]
    for part in catenoid[1]:
        drawn = ElementTree.fromstring(patterns[part.mark])
        texts = [node.text for node in drawn.iter("{http://www.w3.org/2000/svg}text")]
        assert f"{part.length:,.1f}".replace(",", "\u202f") in texts
        assert {slot.partner for slot in part.slots} <= set(texts)


def test_every_mark_is_in_the_view_and_in_the_cut_list(page, catenoid):
    text = page()
    marks = [lamella.mark for lamella in catenoid[0].design.lamellas]
    assert layer(text, "marks")["texts"] == marks
    for table in ("cut-list", "stress"):
        rows = text[text.index(f'id="{table}"') :]
        assert re.findall(r"</span>([AB]\d+)</td>", rows[: rows.index("</table>")]) == marks


def test_a_shell_far_from_the_origin_keeps_its_shape(page, catenoid):
    def moved(by):
        patch = gs.BisectingPatch((-0.8, 0.8), 24)
        control = gs.control_patch(gs.Catenoid(1000.0), patch)
        net, _ = gs.diagonal_meshes(control.moved(control.vertices + by))
        jointed = SlotJoint().build(structure(net, Profile(100.0, 2.5, STAINLESS)))
        return jointed, parts_of(jointed)

    here, there = (
        numbers(layer(page(design=moved(by)), "nodes")["points"], 3)
        for by in (0.0, [5e8, 5e9, 0.0])
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
    jointed, parts = catenoid
    sheets = nest(parts, Sheet(6000.0, 700.0))
    assert len(sheets) > 1
    path = tmp_path / "report.html"
    more = {"sheets": sheets, "clearance": 0.25}
    write_report(path, name="x", report=REPORT, jointed=jointed, parts=parts, **more)
    text = path.read_text(encoding="utf-8").replace(scripts(), "")
    words = visible(text)
    assert "Slots with 0.25 mm clearance." in words
    assert f"Cut from {len(sheets)} raw sheets of 6000 × 700 mm." in words
    number = {p.part.mark: sheet.number for sheet in sheets for p in sheet.placements}
    listed = text[text.index('id="cut-list"') :]
    rows = re.findall(r"<tr>\s*<td data-value.*?</tr>", listed, flags=re.DOTALL)
    for part, row in zip(parts, rows, strict=True):
        cells = re.findall(r'data-value="([^"]*)"', row)
        assert float(cells[5]) == pytest.approx(mass(part, STAINLESS))
        assert int(cells[6]) == number[part.mark]


def test_what_is_not_checked_is_said(page):
    words = visible(page())
    for thing in NOT_CHECKED:
        assert thing in words[words.index("Not checked:") :]


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
    drawing = text[text.index('<svg class="flat"') :]
    drawing = drawing[: drawing.index("</svg>")]
    for station in (0.0, *(slot.x for slot in part.slots), part.length):
        assert f">{station:,.1f}</text>".replace(",", "\u202f") in drawing
    for slot in part.slots:
        assert f">{slot.partner}</text>" in drawing
    corners = re.search(r'class="strip" d="([^"]*)"', drawing)[1]
    assert len(re.findall("[ML]", corners)) - 1 == len(part.outline)


def test_the_quality_is_shown_as_histograms(tmp_path, catenoid):
    quality = gs.net_quality(
        gs.control_patch(gs.Catenoid(1000.0), gs.BisectingPatch((-0.8, 0.8), 24)),
        angle=np.radians(90.0),
        reference=gs.Catenoid(1000.0),
    )
    path = tmp_path / "report.html"
    jointed, parts = catenoid
    series = net_series(quality.figures)
    write_report(path, name="x", report=REPORT, jointed=jointed, parts=parts, series=series)
    text = path.read_text(encoding="utf-8")
    titles = re.findall(r'<svg[^>]*class="histogram"[^>]*aria-label="([^"]*)"', text)
    assert titles == [one.title for one in series] + ["Utilisation of the strength, by bay"]


def test_times_are_listed(page):
    assert "optimise 0.83 STEP 4.10" in visible(page())


# ---- other joints ---------------------------------------------------------------------------


@pytest.fixture(scope="module")
def double():
    return doubled(gs.Catenoid(4000.0), gs.AsymptoticPatch((-0.3, 0.3), (-0.3, 0.3), (4, 4)))


def test_both_strips_of_a_double_lamella_are_drawn_and_listed(page, double):
    text, (jointed, parts) = page(design=double), double
    assert "8 lamellas, 16 nodes. 16 strips along the lamellas." in visible(text)
    assert len(layer(text, "strips-A")["parts"]) == 8
    assert layer(text, "marks")["texts"] == [one.mark for one in jointed.design.lamellas]
    assert len(layer(text, "nodes")["parts"]) == len(jointed.design.nodes)
    listed = text[text.index('id="cut-list"') :]
    assert re.findall(r"</span>([AB]\d[LR])</td>", listed) == [part.mark for part in parts]


def test_connectors_lie_where_they_are_and_weigh_what_they_do(page, double):
    """Put together as the page does it: the meshes' volumes and extents are those of the bodies."""
    text, jointed = page(design=double), double[0]
    positions = np.array([node.position for node in jointed.design.nodes])
    centre = (positions.min(axis=0) + positions.max(axis=0)) / 2.0
    for prisms in jointed.connectors:
        found = layer(text, f"connectors-{prisms.name}")
        assert [part["mark"] for part in found["parts"]] == [body.mark for body in prisms.bodies]
        frames, shape_of = numbers(found["frames"]).reshape(-1, 3, 3), numbers(found["bodies"])
        volume = 0.0
        for body, number, (origin, x, y) in zip(prisms.bodies, shape_of, frames, strict=True):
            shape = found["shapes"][number]
            points, faces = numbers(shape["points"], 3), numbers(shape["faces"], 3)
            placed = origin + points @ np.array([x, y, np.cross(x, y)])
            middle = body.frame.place(prisms.shapes[body.shape].outline[:, :2]).mean(axis=0)
            assert np.linalg.norm((middle - centre) / 1e3 - placed.mean(axis=0)) < 0.08
            a, b, c = placed[faces].swapaxes(0, 1)
            volume += np.einsum("nc,nc->n", a, np.cross(b, c)).sum() / 6.0
        wanted = sum(prisms.shapes[body.shape].volume for body in prisms.bodies) * 1e-9
        assert volume == pytest.approx(wanted, rel=0.12)


def test_the_bill_is_listed_with_its_masses(page, double):
    words, bill = visible(page(design=double)), double[0].bill
    listed = words[words.index("Bill of material") :]
    for line in bill:
        assert f"{line.item} {line.size} {line.quantity:.0f} {line.unit}" in listed


def test_a_joint_without_a_bill_shows_none(page):
    assert "Bill of material" not in visible(page())


def test_sixty_double_lamellas_with_all_their_bolts_stay_below_eight_megabytes(page):
    design = doubled(gs.Enneper(4000.0), gs.AsymptoticPatch((-1, 1), (-1, 1), (30, 30)))
    text = page(design=design)
    assert sum(len(prisms.bodies) for prisms in design[0].connectors) > 900
    assert len(text.encode()) + len(scripts().encode()) < 8e6
    assert not layer(text, "connectors-bolts")["visible"]


# ---- colours and stress ---------------------------------------------------------------------


def test_every_triangle_has_the_colour_of_its_bay(page, catenoid):
    text, (jointed, parts) = page(), catenoid
    stress = bay_stress(jointed.strips, parts)
    for colouring in scene(text)["maps"]:
        values = numbers(colouring["values"])
        assert colouring["on"] == "bays"
        assert len(values) == len(stress)
        assert 0.0 <= values.min() <= values.max() <= 1.0
    used = next(m for m in scene(text)["maps"] if m["name"] == "Utilisation")
    wanted = np.minimum(stress.utilisation, 1.0)
    np.testing.assert_allclose(numbers(used["values"]), wanted, atol=1e-6)
    for name, family in (("strips-A", 1), ("strips-B", 2)):
        strips = layer(text, name)
        faces = numbers(strips["faces"], 3)
        bays = np.repeat(strips["cells"]["numbers"], strips["cells"]["lengths"])
        assert len(bays) == len(faces)
        middles = strip_points(strips)[faces].mean(axis=1)
        lamellas = jointed.strips.lamellas
        assert {lamellas[i].family for i in stress.strip[bays]} == {family}
        positions = np.array([node.position for node in jointed.design.nodes])
        centre = (positions.min(axis=0) + positions.max(axis=0)) / 2.0
        for k in range(0, len(bays), 97):
            lamella = lamellas[stress.strip[bays[k]]]
            s = np.linspace(stress.start[bays[k]] - 60.0, stress.end[bays[k]] + 60.0, 60)
            curve = (lamella.axis.spline(s) - centre) / 1e3
            assert np.linalg.norm(curve - middles[k], axis=1).min() < 0.06


def test_the_table_tells_the_worst_bay_of_every_strip(page, catenoid):
    words, (jointed, parts) = visible(page()), catenoid
    stress = bay_stress(jointed.strips, parts)
    listed = words[words.index("Stress by strip") :]
    for index, lamella in enumerate(jointed.strips.lamellas):
        bays = stress.of_strip(index)
        worst = bays[np.argmax(stress.utilisation[bays])]
        used = 100.0 * stress.utilisation[worst]
        assert f"{lamella.mark} {stress.bays[worst]} {used:.0f} " in listed


def test_a_strip_with_rounded_floors_holes_and_bevels_is_drawn_with_them(page, catenoid):
    jointed, _ = catenoid
    cuts = {
        mark: replace(own, holes=(Hole(60.0, 50.0, 9.0, "N1", "bolt M8"),), bevels=(12.0, -7.0))
        for mark, own in jointed.cuts.items()
    }
    made = replace(jointed, cuts=cuts)
    for relief, arcs in ((Relief(Floor.ROUND), 1), (Relief(Floor.DOGBONE, 0.4), 2)):
        parts = parts_of(made, relief)
        text = page(design=(made, parts))
        drawing = text[text.index('<svg class="flat"') :]
        drawing = drawing[: drawing.index("</svg>")]
        path = re.search(r'class="strip" d="([^"]*)"', drawing)[1]
        longest = max(parts, key=lambda part: round(part.length, 1))
        assert path.count("A") == arcs * len(longest.slots)
        assert drawing.count("<circle") == 1
        assert drawing.count("stroke-dasharray") == 2
        words = visible(text)
        assert f"with {relief.floor.value} floors" in words
        assert "1 hole of 9 mm." in words
        assert "12.0 / −7.0" in words


def test_a_round_floor_is_drawn_as_large_as_it_is(page, catenoid):
    jointed = catenoid[0]
    parts = parts_of(jointed, Relief(Floor.ROUND))
    strips = layer(page(design=(jointed, parts)), "strips-A")
    corners = strip_points(strips)[numbers(strips["faces"], 3)]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    wanted = sum(p.area for p in parts if p.mark.startswith("A"))
    assert np.linalg.norm(normals, axis=1).sum() / 2.0 == pytest.approx(wanted / 1e6, rel=2e-3)


# ---- cutting sheets -------------------------------------------------------------------------


def test_sheets_are_drawn_and_open_to_be_read(tmp_path, catenoid, chromium):
    jointed, parts = catenoid
    sheets = nest(parts, Sheet(6000.0, 700.0))
    path = tmp_path / "report.html"
    drawings = sheet_drawings(sheets, sheet_files(sheets))
    write_report(path, name="x", report=REPORT, jointed=jointed, parts=parts, drawings=drawings)
    page = chromium.new_page(viewport={"width": 1200, "height": 800})
    page.goto(path.as_uri())
    files = page.locator("#sheets figcaption b").all_text_contents()
    assert files == [f"{name}.dxf" for name in sheet_files(sheets)]
    page.locator("#sheets figure button").first.click()
    large, name = page.locator("#sheet svg"), page.locator("#sheet header b")
    whole = large.get_attribute("viewBox")
    at = large.bounding_box()
    page.mouse.move(at["x"] + 0.3 * at["width"], at["y"] + 0.5 * at["height"])
    page.mouse.wheel(0, -500)
    zoomed = [float(number) for number in large.get_attribute("viewBox").split()]
    assert zoomed[2] == pytest.approx(float(whole.split()[2]) / np.e)
    page.mouse.down()
    page.mouse.move(at["x"] + 0.4 * at["width"], at["y"] + 0.5 * at["height"])
    page.mouse.up()
    moved = [float(number) for number in large.get_attribute("viewBox").split()]
    assert moved[0] == pytest.approx(zoomed[0] - 0.1 * zoomed[2], rel=0.01)
    assert moved[1:] == pytest.approx(zoomed[1:])
    page.keyboard.press("ArrowRight")
    assert name.inner_text() == files[1 % len(files)]
    assert large.get_attribute("viewBox") == whole
    page.keyboard.press("Escape")
    assert not large.is_visible()
    page.close()


def test_a_page_without_sheets_has_no_such_section(page):
    assert 'id="sheets"' not in page()
