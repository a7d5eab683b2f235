from itertools import combinations

import ezdxf
import numpy as np
import pytest
from ezdxf import bbox, units
from ezdxf.enums import TextEntityAlignment
from shapely import Polygon, box

import fabrication as fab
import gridshell as gs
from fabrication.errors import OutputError

NAMES = ["catenoid", "enneper", "tube"]


@pytest.fixture(scope="module")
def sheets(request, tmp_path_factory):
    """Sheets of a design: how they were nested, and their files."""
    cache = {}

    def write(name):
        if name not in cache:
            design = request.getfixturevalue(name)
            nested = fab.nest(design.parts, fab.Sheet(12000.0, 350.0))
            cache[name] = nested, fab.write_dxf(nested, tmp_path_factory.mktemp(name))
        return cache[name]

    return write


@pytest.fixture(scope="module", params=NAMES)
def pairs(request, sheets):
    """(nested sheet, document read back from disk) for every sheet of a design."""
    nested, paths = sheets(request.param)
    return [(sheet, ezdxf.readfile(path)) for sheet, path in zip(nested, paths, strict=True)]


def on(document, layer):
    return [entity for entity in document.modelspace() if entity.dxf.layer == layer]


def corners(entity):
    return np.array(entity.get_points("xy"))


def outlines(document):
    return [Polygon(corners(entity)) for entity in on(document, "CUT")]


def mark(entity):
    return next(tag.value for tag in entity.get_xdata("GRIDSHELL") if tag.code == 1000)


# ---- what a shop's machine reads ------------------------------------------------------------


def test_the_format_is_r2010_in_millimetres(pairs):
    for _, document in pairs:
        assert document.acad_release == "R2010"
        assert document.units == units.MM
        assert document.header["$INSUNITS"] == 4


def test_the_audit_finds_nothing_to_complain_or_to_mend(pairs):
    for _, document in pairs:
        audit = document.audit()
        assert (audit.errors, audit.fixes) == ([], [])


def test_every_entity_lies_on_one_of_the_four_layers(pairs):
    for _, document in pairs:
        assert {e.dxf.layer for e in document.modelspace()} == {"CUT", "MARK", "TEXT", "SHEET"}


def test_every_layer_is_defined_with_its_own_colour(pairs):
    for _, document in pairs:
        colours = [document.layers.get(name).color for name in ("CUT", "MARK", "TEXT", "SHEET")]
        assert len(set(colours)) == 4


def test_the_cut_layer_holds_one_closed_polyline_per_part_and_nothing_else(pairs):
    for sheet, document in pairs:
        entities = on(document, "CUT")
        assert {entity.dxftype() for entity in entities} == {"LWPOLYLINE"}
        assert all(entity.closed for entity in entities)
        assert len(entities) == len(sheet.placements)


def test_outlines_are_straight_lines(pairs):
    for _, document in pairs:
        assert not any(entity.has_arc for entity in on(document, "CUT"))


def test_outlines_are_axis_parallel(pairs):
    for _, document in pairs:
        for entity in on(document, "CUT"):
            points = corners(entity)
            steps = np.abs(np.roll(points, -1, axis=0) - points)
            assert (steps.min(axis=1) == 0.0).all()
            assert (steps.max(axis=1) > 0.5).all()


def test_no_line_is_drawn_twice(pairs):
    for _, document in pairs:
        segments = []
        for entity in on(document, "CUT"):
            points = [tuple(point) for point in corners(entity).round(6).tolist()]
            ends = zip(points, points[1:] + points[:1], strict=True)
            segments += [tuple(sorted(pair)) for pair in ends]
        assert len(set(segments)) == len(segments)


def test_outlines_are_valid_polygons_of_the_area_of_their_parts(pairs):
    for sheet, document in pairs:
        areas = [placement.part.area for placement in sheet.placements]
        shapes = outlines(document)
        assert all(shape.is_valid for shape in shapes)
        assert [shape.area for shape in shapes] == pytest.approx(areas, rel=1e-9)


def test_parts_on_a_sheet_do_not_touch(pairs):
    for _, document in pairs:
        for a, b in combinations(outlines(document), 2):
            assert a.distance(b) > 10.0 - 1e-6


def test_everything_to_cut_and_to_engrave_lies_inside_the_margins(pairs):
    for _, document in pairs:
        room = box(10.0, 10.0, 12000.0 - 10.0, 350.0 - 10.0).buffer(1e-6)
        drawn = [corners(entity) for layer in ("CUT", "MARK") for entity in on(document, layer)]
        assert room.contains(Polygon(np.concatenate(drawn)).convex_hull)


def test_the_raw_sheet_is_drawn_and_seen_on_paper(pairs):
    for _, document in pairs:
        (frame,) = on(document, "SHEET")
        assert Polygon(corners(frame)).equals(box(0.0, 0.0, 12000.0, 350.0))
        layer = document.layers.get("SHEET")
        assert layer.dxf.get("plot", 1) == 1
        assert layer.is_on()


def test_the_extents_are_those_of_the_drawing(pairs):
    for _, document in pairs:
        low, high = (document.header[key] for key in ("$EXTMIN", "$EXTMAX"))
        everything = bbox.extents(document.modelspace())
        np.testing.assert_allclose(low, everything.extmin, atol=1e-6)
        np.testing.assert_allclose(high, everything.extmax, atol=1e-6)
        assert low[0] < 0.0 < 12000.0 <= high[0]
        assert 350.0 < high[1] < 400.0


# ---- marks ----------------------------------------------------------------------------------


def test_every_outline_carries_the_mark_of_its_part(pairs):
    for sheet, document in pairs:
        marks = [mark(entity) for entity in on(document, "CUT")]
        assert marks == [placement.part.mark for placement in sheet.placements]


def test_marks_are_engraved_as_open_strokes_inside_their_part(pairs):
    for _, document in pairs:
        strokes, shapes = on(document, "MARK"), outlines(document)
        assert {stroke.dxftype() for stroke in strokes} == {"LWPOLYLINE"}
        assert not any(stroke.closed for stroke in strokes)
        for stroke in strokes:
            line = corners(stroke)
            assert len(line) >= 2
            assert any(shape.contains(Polygon([*line, line[0]]).convex_hull) for shape in shapes)


def test_texts_lie_outside_the_raw_sheet(pairs):
    sheet = box(0.0, 0.0, 12000.0, 350.0)
    for _, document in pairs:
        for text in on(document, "TEXT"):
            extents = bbox.extents([text])
            low, high = extents.extmin, extents.extmax
            assert sheet.distance(box(low.x, low.y, high.x, high.y)) > 1.0


def test_the_marks_of_a_row_stand_left_of_it_in_their_order(pairs):
    for sheet, document in pairs:
        expected = {}
        for p in sorted(sheet.placements, key=lambda p: p.x):
            expected.setdefault(p.y + p.part.width / 2.0, []).append(p.part.mark)
        found = {}
        for text in on(document, "TEXT")[1:]:
            align, point, _ = text.get_placement()
            assert align is TextEntityAlignment.MIDDLE_RIGHT
            found[point.y] = text.dxf.text.split(", ")
        assert found == expected


def test_the_title_says_project_sheet_material_thickness_and_size(enneper, tmp_path):
    nested = fab.nest(enneper.parts, fab.Sheet(12000.0, 350.0))
    paths = fab.write_dxf(nested, tmp_path, name="Dächle\nno. 1", material="stainless")
    title, *_ = on(ezdxf.readfile(paths[1]), "TEXT")
    assert title.dxf.text.split("  |  ") == [
        "Dächle no. 1",
        f"sheet 2 of {len(nested)}",
        "stainless 2.5 mm",
        "raw sheet 12000 x 350 mm",
        f"{len(nested[1].placements)} parts",
    ]


def test_a_title_without_a_name_or_a_material_leaves_them_out(sheets):
    nested, paths = sheets("enneper")
    title, *_ = on(ezdxf.readfile(paths[0]), "TEXT")
    assert title.dxf.text.startswith(f"sheet 1 of {len(nested)}  |  2.5 mm  |  raw sheet")


def test_a_mark_is_engraved_as_high_as_its_label_says(sheets):
    nested, paths = sheets("catenoid")
    placement = nested[0].placements[0]
    own = placement.part.labels[0]
    centre = np.array([own.x + placement.x, own.y + placement.y])
    strokes = [corners(entity) for entity in on(ezdxf.readfile(paths[0]), "MARK")]
    near = np.concatenate([s for s in strokes if np.abs(s - centre).max() < 2.0 * own.height])
    low, high = near.min(axis=0), near.max(axis=0)
    np.testing.assert_allclose((low + high) / 2.0, centre, atol=1e-6)
    assert 0.5 * own.height < high[1] - low[1] < 1.2 * own.height


# ---- files ----------------------------------------------------------------------------------


def test_files_are_named_by_the_number_of_the_sheet(sheets):
    nested, paths = sheets("enneper")
    assert [path.name for path in paths] == [f"sheet-{s.number:02d}.dxf" for s in nested]
    assert len(paths) > 1


def test_more_than_99_sheets_still_sort_by_name(strip, tmp_path):
    nested = fab.nest([strip(f"A{i}", 300.0) for i in range(101)], fab.Sheet(400.0, 130.0))
    paths = fab.write_dxf(nested, tmp_path)
    names = [path.name for path in paths]
    assert len(names) == 101
    assert names == sorted(names)


def test_a_file_of_that_name_in_the_way_of_the_folder_is_an_error(sheets, tmp_path):
    (tmp_path / "sheets").write_text("mine")
    with pytest.raises(OutputError, match="sheets cannot be written"):
        fab.write_dxf(sheets("catenoid")[0], tmp_path / "sheets")


def test_reading_a_sheet_back_gives_marks_and_outlines_from_their_first_corner(sheets):
    for nested, path in zip(*sheets("enneper"), strict=True):
        for found, placement in zip(fab.read_dxf(path), nested.placements, strict=True):
            assert found.mark == placement.part.mark
            np.testing.assert_allclose(found.outline, placement.part.outline, atol=1e-9)


@pytest.mark.xdist_group("kernel")
def test_cadquery_reads_the_same_areas_from_the_cut_layer(pair, tmp_path):
    from cadquery import importers

    (path,) = fab.write_dxf(fab.nest(pair.parts, fab.Sheet(4000.0, 1000.0)), tmp_path)
    faces = importers.importDXF(str(path), include=["CUT"]).faces().vals()
    expected = sorted(part.area for part in pair.parts)
    assert sorted(face.Area() for face in faces) == pytest.approx(expected, rel=1e-6)


# ---- files that are not ours ----------------------------------------------------------------


def test_a_missing_sheet_is_named(tmp_path):
    with pytest.raises(gs.FileError, match="cannot be read") as info:
        fab.read_dxf(tmp_path / "sheet-07.dxf")
    assert "sheet-07.dxf" in info.value.where


@pytest.mark.parametrize(
    "content", [b"", b"hello\n", b"\x89PNG\r\n\x1a\n" + bytes(range(256)), b"AutoCAD Binary DXF"]
)
def test_a_file_that_is_no_dxf_is_refused(tmp_path, content):
    path = tmp_path / "sheet-01.dxf"
    path.write_bytes(content)
    with pytest.raises(gs.FileError, match="cannot be read"):
        fab.read_dxf(path)


def test_a_sheet_that_was_cut_off_is_refused_wherever_it_ends(sheets, tmp_path):
    whole = sheets("catenoid")[1][0].read_bytes()
    path = tmp_path / "sheet-01.dxf"
    for size in [*range(0, 5000, 230), len(whole) // 2, len(whole) - 10]:
        path.write_bytes(whole[:size])
        with pytest.raises(gs.FileError, match="cannot be read"):
            fab.read_dxf(path)


def changed(sheets, tmp_path, change):
    """A sheet after *change* was done to its document."""
    document = ezdxf.readfile(sheets("catenoid")[1][0])
    change(document)
    document.saveas(tmp_path / "changed.dxf")
    return tmp_path / "changed.dxf"


def test_a_sheet_in_inches_is_refused(sheets, tmp_path):
    path = changed(sheets, tmp_path, lambda document: setattr(document, "units", units.IN))
    with pytest.raises(gs.FileError, match="not in mm"):
        fab.read_dxf(path)


def test_an_open_outline_is_refused(sheets, tmp_path):
    path = changed(sheets, tmp_path, lambda document: on(document, "CUT")[1].close(False))
    with pytest.raises(gs.FileError, match="no closed outline with a mark"):
        fab.read_dxf(path)


def test_an_outline_without_a_mark_is_refused(sheets, tmp_path):
    path = changed(
        sheets, tmp_path, lambda document: on(document, "CUT")[1].discard_xdata("GRIDSHELL")
    )
    with pytest.raises(gs.FileError, match="no closed outline with a mark"):
        fab.read_dxf(path)


@pytest.mark.parametrize(
    "spoil",
    [
        lambda outline: outline.set_xdata("GRIDSHELL", [(1040, 1.0)]),
        lambda outline: outline.set_points([(0.0, 0.0), (10.0, 0.0)]),
    ],
    ids=["a number for a mark", "two corners"],
)
def test_an_incomplete_outline_is_refused(sheets, tmp_path, spoil):
    path = changed(sheets, tmp_path, lambda document: spoil(on(document, "CUT")[1]))
    with pytest.raises(gs.FileError, match="outline is incomplete"):
        fab.read_dxf(path)


def test_a_sheet_with_a_garbled_number_is_refused(sheets, tmp_path):
    text = sheets("catenoid")[1][0].read_text()
    path = tmp_path / "sheet-01.dxf"
    path.write_text(text.replace("12000.0", "@2000.0"))
    with pytest.raises(gs.FileError, match="cannot be read"):
        fab.read_dxf(path)


def test_a_stray_line_on_the_cut_layer_is_refused(sheets, tmp_path):
    def draw(document):
        document.modelspace().add_line((0, 0), (10, 0), dxfattribs={"layer": "CUT"})

    with pytest.raises(gs.FileError, match="no closed outline with a mark"):
        fab.read_dxf(changed(sheets, tmp_path, draw))
