"""Every kind of fault is put into a sheet of our own, and exactly this one must be found."""

from contextlib import suppress
from dataclasses import dataclass, field
from time import perf_counter

import ezdxf
import numpy as np
import pytest
from ezdxf import units
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import fabrication as fab
import gridshell as gs
from fabrication.cut import Edge, Floor, Hole, Relief, Slot, outline
from fabrication.export.dxf_lint import lint_dxf
from fabrication.finding import Severity
from fabrication.parts import Label
from fabrication.shop import Cutting, Process, preset
from fabrication.unroll import Development

LASER = preset(Cutting.LASER, 2.5)


SQUARE = Relief()


def strip(mark, relief=SQUARE, *, slots=3, holes=True):
    """A strip with slots, holes between them and its mark."""
    length = 200.0 * slots
    cut = tuple(
        Slot(100.0 + 200.0 * k, 5.0, 50.5, Edge.LOWER, f"N{k}", f"B{k}", relief)
        for k in range(slots)
    )
    bolts = tuple(Hole(200.0 + 200.0 * k, 50.0, 9.0, f"N{k}", "bolt") for k in range(slots - 1))
    labels = (
        Label(mark, 150.0, 50.0, 10.0),
        *(Label(slot.partner, slot.x, 80.0, 8.0) for slot in cut),
    )
    development = Development(length, np.zeros(0), 0.0, 0.0)
    return fab.FlatPart(
        mark,
        outline(length, 100.0, cut),
        cut,
        labels,
        100.0,
        2.5,
        development,
        bolts if holes else (),
    )


@dataclass
class Sheet:
    """A written sheet that can be broken."""

    document: ezdxf.document.Drawing
    space: ezdxf.layouts.Modelspace = field(init=False)

    def __post_init__(self):
        self.space = self.document.modelspace()

    def on(self, layer, kind="LWPOLYLINE"):
        return [e for e in self.space.query(kind) if e.dxf.layer == layer]

    @property
    def outline(self):
        return self.on("CUT")[0]

    @property
    def hole(self):
        return self.on("CUT", "CIRCLE")[0]

    def add(self, how, *args, layer="CUT", **attributes):
        return getattr(self.space, f"add_{how}")(*args, dxfattribs={"layer": layer, **attributes})

    def moved(self, entity, dx, dy):
        entity.translate(dx, dy, 0.0)

    def corner(self, k, dx=0.0, dy=0.0):
        """Move a corner of the first outline."""
        rows = [list(row) for row in self.outline.get_points("xyb")]
        rows[k][0] += dx
        rows[k][1] += dy
        self.outline.set_points(rows, format="xyb")

    def lines(self, skip=(), shift=0.0):
        """The first outline as single lines, without some."""
        points = [row[:2] for row in self.outline.get_points("xyb")]
        for k, (a, b) in enumerate(zip(points, points[1:] + points[:1], strict=True)):
            if k not in skip:
                self.add("line", (a[0] + shift * (k == 0), a[1]), b)
        mark = self.outline.get_xdata("GRIDSHELL")
        self.space.delete_entity(self.outline)
        self.on("CUT", "LINE")[0].set_xdata("GRIDSHELL", mark)


PARTS = (strip("A1"), strip("A2", Relief(Floor.ROUND)), strip("A3", Relief(Floor.DOGBONE, 1.0)))


@pytest.fixture(scope="module")
def ours(tmp_path_factory):
    nested = fab.nest(PARTS, fab.Sheet(700.0, 400.0))
    (path,) = fab.write_dxf(nested, tmp_path_factory.mktemp("ours"))
    return path


@pytest.fixture
def codes(ours, tmp_path):
    """Codes that are found in our sheet after something was done to it."""

    def run(spoil, process=None, parts=None):
        sheet = Sheet(ezdxf.readfile(ours))
        spoil(sheet)
        path = tmp_path / "spoiled.dxf"
        sheet.document.saveas(path)
        return [finding.code for finding in lint_dxf(path, process, parts)]

    return run


def unit(value):
    return lambda sheet: setattr(sheet.document, "units", value)


def two(sheet, entity, **how):
    double = entity.copy()
    sheet.space.add_entity(double)
    return double


def far_circle(sheet):
    two(sheet, sheet.hole).translate(0.0, -20000.0, 0.0)


def loop(sheet):
    """A corner of the first slot's floor lies beyond the other wall."""
    rows = sheet.outline.get_points("xyb")
    k = next(k for k, row in enumerate(rows) if row[2] or row[1] not in (rows[0][1], rows[-1][1]))
    sheet.corner(k, dx=8.0)


def layer(name, how):
    return lambda sheet: getattr(sheet.document.layers.get(name), how)()


def onto_strange_layer(sheet):
    sheet.document.layers.add("OUTLINE")
    sheet.add("line", (900, 0), (950, 0), layer="OUTLINE")


def dimension(sheet):
    drawn = sheet.space.add_linear_dim(
        base=(0, 600), p1=(0, 0), p2=(100, 0), dxfattribs={"layer": "CUT"}
    )
    drawn.render()


def hatch(sheet):
    sheet.add("hatch").paths.add_polyline_path([(0, 0), (5, 0), (5, 5)])


def block(sheet):
    sheet.document.blocks.new("B").add_line((0, 0), (1, 0))
    sheet.add("blockref", "B", (0, 0))


def closed_spline(sheet):
    around = np.linspace(0.0, 2.0 * np.pi, 9)
    x, y = sheet.outline.get_points("xy")[0]
    points = [(x + 40 + 10 * np.cos(a), y + 30 + 10 * np.sin(a)) for a in around]
    sheet.add("spline", points)


def mesh(sheet):
    sheet.add("3dface", [(0, 0, 0), (10, 0, 0), (10, 10, 5)])


def polyline_in_space(sheet):
    sheet.add("polyline3d", [(900, 0, 0), (950, 0, 0), (950, 50, 0)], layer="CUT").close()


def turned_over(sheet):
    (hole,) = sheet.on("CUT", "CIRCLE")[:1]
    x, y, _ = hole.dxf.center
    hole.dxf.extrusion = (0, 0, -1)
    hole.dxf.center = (-x, y, 0)


def notch(sheet, width):
    """A rectangular opening in the first part, *width* wide."""
    x, y = sheet.outline.get_points("xy")[0]
    corners = [(20, 60), (20 + width, 60), (20 + width, 80), (20, 80)]
    sheet.space.add_lwpolyline(
        [(x + a, y + b) for a, b in corners], close=True, dxfattribs={"layer": "CUT"}
    )


def opening_at(sheet, left):
    x, y = sheet.outline.get_points("xy")[0]
    corners = [(left, 60), (left + 20, 60), (left + 20, 80), (left, 80)]
    sheet.space.add_lwpolyline(
        [(x + a, y + b) for a, b in corners], close=True, dxfattribs={"layer": "CUT"}
    )


def stroke(dx, dy):
    """A stroke of the first mark elsewhere."""

    def move(sheet):
        x, y = sheet.outline.get_points("xy")[0]
        sheet.add("lwpolyline", [(x + dx, y + dy), (x + dx + 6, y + dy + 6)], layer="MARK")

    return move


def no_marks(sheet):
    for entity in sheet.on("MARK"):
        sheet.space.delete_entity(entity)


def no_mark_on_first(sheet):
    _, y = sheet.outline.get_points("xy")[0]
    for entity in sheet.on("MARK"):
        if y < entity.get_points("xy")[0][1] < y + 100.0:
            sheet.space.delete_entity(entity)


def tiny_step(sheet):
    rows = [list(row) for row in sheet.outline.get_points("xyb")]
    x, y, _ = rows[0]
    sheet.outline.set_points([*rows, [x, y + 0.02, 0.0]], format="xyb")


def twin_corner(sheet):
    rows = [list(row) for row in sheet.outline.get_points("xyb")]
    sheet.outline.set_points([rows[0], *rows], format="xyb")


def pen(sheet):
    sheet.outline.dxf.const_width = 0.5


def scaled(factor):
    from ezdxf.math import Matrix44

    def run(sheet):
        for entity in list(sheet.space):
            entity.transform(Matrix44.scale(factor, factor, factor))

    return run


def drop(sheet):
    mark = sheet.outline.get_xdata("GRIDSHELL")
    for entity in [sheet.outline, *sheet.on("CUT", "CIRCLE")]:
        if entity.get_xdata("GRIDSHELL") == mark:
            sheet.space.delete_entity(entity)
    y = {e.get_points("xy")[0][1] for e in sheet.on("CUT")}
    for entity in sheet.on("MARK"):
        if not any(low < entity.get_points("xy")[0][1] < low + 100.0 for low in y):
            sheet.space.delete_entity(entity)


def renamed(sheet):
    name = sheet.outline.get_xdata("GRIDSHELL")[0].value
    for entity in [sheet.outline, *sheet.on("CUT", "CIRCLE")]:
        if entity.get_xdata("GRIDSHELL")[0].value == name:
            entity.set_xdata("GRIDSHELL", [(1000, "Z9")])


def same_name(sheet):
    first, second = sheet.on("CUT")[:2]
    first.set_xdata("GRIDSHELL", list(second.get_xdata("GRIDSHELL")))


def on_paper(sheet):
    sheet.document.layout("Layout1").add_line((0, 0), (10, 0))


def to_layer_0(sheet):
    for entity in sheet.on("CUT") + sheet.on("CUT", "CIRCLE"):
        entity.dxf.layer = "OUTLINE"
    sheet.document.layers.add("OUTLINE")


FAULTS = {
    "units-wrong": unit(units.IN),
    "units-missing": unit(0),
    "unknown-layer": onto_strange_layer,
    "layer-0": lambda s: s.add("line", (900, 0), (950, 0), layer="0"),
    "layer-off": layer("MARK", "off"),
    "layer-frozen": layer("CUT", "freeze"),
    "paper-space": on_paper,
    "text-on-cut": lambda s: s.add("text", "A1"),
    "dimension-on-cut": dimension,
    "hatch-on-cut": hatch,
    "block-on-cut": block,
    "curve-on-cut": closed_spline,
    "three-d": mesh,
    "no-line": lambda s: s.add("point", (5, 5)),
    "wide-line": pen,
    "height": lambda s: setattr(s.outline.dxf, "elevation", 3.0),
    "extrusion": turned_over,
    "open-path": lambda s: s.outline.close(False),
    "micro-gap": lambda s: s.lines(shift=0.1),
    "duplicate-line": lambda s: two(s, s.outline),
    "overlapping-lines": None,
    "self-crossing": loop,
    "crossing-cuts": None,
    "zero-length": twin_corner,
    "tiny-line": tiny_step,
    "outside-sheet": None,
    "stray-hole": None,
    "mark-on-cut": stroke(-3.0, 50.0),
    "mark-outside": stroke(5.0, 340.0),
    "duplicate-mark": lambda s: two(s, s.on("MARK")[0]),
    "missing-mark": no_marks,
    "duplicate-part": same_name,
}


def move_hole_out(sheet):
    sheet.hole.translate(0.0, 1000.0, 0.0)


def toward_next(corners, by):
    """Corners at the side of the first part that another lies beyond, moved over to it."""

    def run(sheet):
        rows = [list(row) for row in sheet.outline.get_points("xyb")]
        low, high = (f(row[1] for row in rows) for f in (min, max))
        up = any(e.get_points("xy")[0][1] > low for e in sheet.on("CUT"))
        side = [row for row in rows if row[1] == (high if up else low)]
        for row in side[:corners]:
            row[1] += by if up else -by
            if corners == 1:
                row[0] += 9.0 if row[0] < 100.0 else -9.0
        sheet.outline.set_points(rows, format="xyb")

    return run


def beyond_sheet(sheet):
    (frame,) = sheet.on("SHEET")
    frame.set_points([(50, 0), (700, 0), (700, 400), (50, 400)], format="xy")


FAULTS["overlapping-lines"] = toward_next(None, 10.0)
FAULTS["crossing-cuts"] = toward_next(1, 15.0)
FAULTS["outside-sheet"] = beyond_sheet
FAULTS["stray-hole"] = move_hole_out

LIMITS = {
    "small-hole": lambda s: setattr(s.hole.dxf, "radius", 1.0),
    "narrow-slot": lambda s: notch(s, 1.0),
    "thin-web": lambda s: opening_at(s, 1.5),
    "near-edge": lambda s: s.moved(s.hole, 0.0, 44.0),
}

AGAINST_PARTS = {
    "part-missing": drop,
    "part-differs": lambda s: [s.corner(k, dx=-3.0) for k in (0, -1)],
    "scale": scaled(1.0 / 25.4),
}


def test_there_are_many_kinds_of_faults():
    assert len(FAULTS) + len(LIMITS) + len(AGAINST_PARTS) > 35


@pytest.mark.parametrize("code", FAULTS)
def test_a_fault_is_found_and_nothing_else(codes, code):
    assert set(codes(FAULTS[code])) == {code}


@pytest.mark.parametrize("code", LIMITS)
def test_what_the_laser_cannot_cut_is_found_and_nothing_else(codes, code):
    assert set(codes(LIMITS[code], LASER)) == {code}
    assert codes(LIMITS[code]) == []


@pytest.mark.parametrize("code", AGAINST_PARTS)
def test_what_differs_from_the_parts_is_found_and_nothing_else(codes, code):
    assert set(codes(AGAINST_PARTS[code], parts=PARTS)) == {code}


def test_a_part_with_another_name_is_missing_and_unknown(codes):
    assert codes(renamed, parts=PARTS) == ["part-missing", "part-unknown"]


def test_outlines_on_a_layer_nobody_knows_are_looked_at_all_the_same(codes):
    def spoil(sheet):
        two(sheet, sheet.outline)
        to_layer_0(sheet)

    assert codes(spoil) == ["unknown-layer", "nothing-to-cut", "duplicate-line"]


def test_single_lines_that_meet_are_an_outline(codes):
    assert codes(lambda sheet: sheet.lines(), LASER, PARTS) == []


def test_parts_without_marks_are_counted_and_compared_by_their_size(codes):
    def strip_names(sheet):
        for entity in sheet.space:
            entity.discard_xdata("GRIDSHELL")

    def one_less(sheet):
        strip_names(sheet)
        sheet.space.delete_entity(sheet.outline)

    assert codes(strip_names, parts=PARTS) == []
    assert "part-count" in codes(one_less, parts=PARTS)


@pytest.mark.parametrize("process", [None, LASER])
def test_our_own_sheet_has_no_fault(ours, process):
    assert lint_dxf(ours, process, PARTS) == ()


@pytest.mark.parametrize("name", ["catenoid", "enneper", "tube", "saddle"])
def test_sheets_of_whole_structures_have_no_fault(request, tmp_path, name):
    parts = request.getfixturevalue(name).parts
    nested = fab.nest(parts, fab.Sheet(12000.0, 1500.0))
    for sheet, path in zip(nested, fab.write_dxf(nested, tmp_path), strict=True):
        assert lint_dxf(path, None, [p.part for p in sheet.placements]) == ()


def test_sheets_of_panels_plates_and_stars_have_no_fault(tower, tmp_path):
    pieces = [fab.panel_piece(panel) for panel in tower.panels]
    nested = fab.nest(pieces, fab.Sheet(6000.0, 2000.0))
    for sheet, path in zip(nested, fab.write_dxf(nested, tmp_path), strict=True):
        assert lint_dxf(path, None, [p.part for p in sheet.placements]) == ()


def test_values_say_how_far_off_it_is(ours, tmp_path):
    sheet = Sheet(ezdxf.readfile(ours))
    sheet.hole.dxf.radius = 1.0
    sheet.document.saveas(tmp_path / "x.dxf")
    (finding,) = lint_dxf(tmp_path / "x.dxf", LASER)
    assert (finding.value, finding.limit, finding.unit) == (pytest.approx(2.0), 2.5, "mm")
    assert finding.severity is Severity.ERROR


# ---- files of others --------------------------------------------------------------------------


@pytest.mark.parametrize(
    "content", [b"", b"hello\n", b"\x89PNG\r\n\x1a\n" + bytes(range(256)), b"AutoCAD Binary DXF"]
)
def test_a_file_that_is_no_dxf_is_refused(tmp_path, content):
    (tmp_path / "x.dxf").write_bytes(content)
    with pytest.raises(gs.FileError, match="no DXF"):
        lint_dxf(tmp_path / "x.dxf")


def test_a_missing_file_is_refused(tmp_path):
    with pytest.raises(gs.FileError, match="no DXF"):
        lint_dxf(tmp_path / "nowhere.dxf")


@settings(max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_damaged_files_give_findings_or_a_refusal(ours, tmp_path, data):
    lines = ours.read_text().splitlines()
    first = next(k for k, line in enumerate(lines) if line == "ENTITIES")
    for _ in range(data.draw(st.integers(1, 4))):
        k = data.draw(st.integers(first, len(lines) - 1))
        lines[k] = data.draw(st.sampled_from(["", "nan", "1e400", "-1", "LINE", "x", "70", "10"]))
    cut = data.draw(st.sampled_from([len(lines), len(lines) - 3, len(lines) * 9 // 10]))
    (tmp_path / "x.dxf").write_text("\n".join(lines[:cut]) + "\n")
    with suppress(gs.FileError):
        assert isinstance(lint_dxf(tmp_path / "x.dxf", LASER, PARTS), tuple)


@pytest.mark.parametrize("version", ["R12", "R2000", "R2018"])
def test_any_entity_anywhere_gives_findings(tmp_path, version):
    document = ezdxf.new(version)
    space = document.modelspace()
    for kind in ("LINE", "CIRCLE", "ARC", "POLYLINE", "TEXT", "POINT", "SOLID", "TRACE", "3DFACE"):
        space.new_entity(kind, {"layer": "CUT"})
    if version != "R12":
        for kind in ("LWPOLYLINE", "SPLINE", "ELLIPSE", "MTEXT", "HATCH", "MESH", "RAY", "XLINE"):
            space.new_entity(kind, {"layer": "CUT"})
    document.saveas(tmp_path / "x.dxf")
    found = {finding.code for finding in lint_dxf(tmp_path / "x.dxf", LASER, PARTS)}
    unit = "units-missing" if version == "R12" else "units-wrong"
    assert {unit, "text-on-cut", "no-line", "three-d"} <= found


def test_sixty_strips_take_seconds_at_most(tmp_path):
    parts = [strip(f"A{k}", slots=30, holes=False) for k in range(60)]
    (path,) = fab.write_dxf(fab.nest(parts, fab.Sheet(6100.0, 6700.0)), tmp_path)
    start = perf_counter()
    assert lint_dxf(path, Process(), parts) == ()
    assert perf_counter() - start < 6.0
