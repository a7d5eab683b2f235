"""BTLx files read back and laid over the flat parts; their form by a schema.

``strips.xsd`` says of the elements that are written here what the published schema does, which is
not part of this repository.
"""

from collections import Counter
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
import xmlschema

import fabrication as fab
import gridshell as gs
from fabrication.cut import Edge, Floor, Relief
from fabrication.export.btlx.files import write_btlx
from fabrication.export.cut_sets import CutSet

SPACE = "{https://www.design2machine.com}"
SCHEMA = xmlschema.XMLSchema(Path(__file__).with_name("strips.xsd"))


def names(element):
    return [child.tag.removeprefix(SPACE) for child in element]


def numbers(element):
    """Children of a processing, as numbers where they are."""
    found = {}
    for child in element:
        try:
            found[child.tag.removeprefix(SPACE)] = float(child.text)
        except (TypeError, ValueError):
            found[child.tag.removeprefix(SPACE)] = child.text
    return found


def of_kind(part, name):
    return part.findall(f"{SPACE}Processings/{SPACE}{name}")


@pytest.fixture
def written(tmp_path):
    """The root and the parts of a file of some strips."""

    def build(parts, material=fab.BIRCH_PLY):
        write_btlx(tmp_path / "a.btlx", "Hütte & Co", [CutSet("strips", material, tuple(parts))])
        root = ElementTree.parse(tmp_path / "a.btlx").getroot()
        SCHEMA.validate(tmp_path / "a.btlx")
        assert all(int(p.get("Count")) == len(p[0]) for p in root.iter(f"{SPACE}Part"))
        return root, root.findall(f"{SPACE}Project/{SPACE}Parts/{SPACE}Part")

    return build


def require_sizes(element, part):
    sizes = [float(element.get(key)) for key in ("Length", "Height", "Width")]
    assert sizes == pytest.approx([part.length, part.width, part.thickness], abs=0.01)
    assert element.get("AssemblyNumber") == part.mark


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('ReferencePlaneID="4"', 'ReferencePlaneID="7"'),
        ("<Orientation>start<", "<Orientation>middle<"),
        ("<StartDepth>0.0000</StartDepth>", ""),
        ("<Angle>90.0000</Angle>", "<Angle>180.0000</Angle>"),
        ('ProcessID="2"', 'ProcessID="1"'),
        ('Version="2.0.0"', 'Version="2.1.0"'),
        ('GUID="{', 'GUID="'),
        (' Length="', ' Span="'),
    ],
)
def test_the_schema_minds_what_is_wrong(pair, written, tmp_path, old, new):
    written(pair.parts)
    text = (tmp_path / "a.btlx").read_text(encoding="utf-8")
    assert old in text
    (tmp_path / "b.btlx").write_text(text.replace(old, new, 1), encoding="utf-8")
    assert not SCHEMA.is_valid(tmp_path / "b.btlx")


def test_every_strip_is_a_part_of_its_size(enneper, written):
    root, found = written(enneper.parts)
    assert root[1].get("Name") == "Hütte & Co"
    assert len(found) == len(enneper.parts)
    for element, part in zip(found, enneper.parts, strict=True):
        require_sizes(element, part)
        assert element.get("Material") == "birch-ply"
        mass = part.volume * fab.BIRCH_PLY.density * 1e-9
        assert float(element.get("Weight")) == pytest.approx(mass, abs=1e-3)


def test_slots_are_laps_from_the_edge_they_open_to(enneper, written):
    for element, part in zip(written(enneper.parts)[1], enneper.parts, strict=True):
        laps = of_kind(element, "Lap")
        assert len(laps) == len(part.slots)
        for lap, slot in zip(laps, part.slots, strict=True):
            assert lap.get("ReferencePlaneID") == {Edge.LOWER: "1", Edge.UPPER: "3"}[slot.edge]
            assert lap.get("Comment") == f"{slot.node}, {slot.partner}"
            have = numbers(lap)
            assert have["StartX"] + have["Length"] / 2.0 == pytest.approx(slot.x, abs=0.01)
            assert have["Length"] == pytest.approx(slot.width, abs=0.01)
            assert have["Depth"] == pytest.approx(slot.depth, abs=0.01)
            assert have["Width"] == pytest.approx(part.thickness, abs=0.01)
            assert (have["Orientation"], have["Angle"], have["Slope"]) == ("start", 90.0, 0.0)


def test_laps_leave_the_area_of_the_outline(enneper, written):
    for element, part in zip(written(enneper.parts)[1], enneper.parts, strict=True):
        away = sum(
            numbers(lap)["Length"] * numbers(lap)["Depth"] for lap in of_kind(element, "Lap")
        )
        assert part.length * part.width - away == pytest.approx(part.area, abs=0.01 * part.length)


@pytest.mark.parametrize("floor", [Floor.ROUND, Floor.DOGBONE])
def test_rounded_floors_are_contours_with_the_same_area(floor, enneper, written):
    relief = Relief(floor, 0.2 if floor is Floor.DOGBONE else 0.0)
    parts = fab.parts_of(fab.SlotJoint().build(enneper.structure), relief)
    for element, part in zip(written(parts)[1], parts, strict=True):
        contours = of_kind(element, "FreeContour")
        assert (len(contours), of_kind(element, "Lap")) == (len(part.slots), [])
        away = 0.0
        for free, slot in zip(contours, part.slots, strict=True):
            edge = 0.0 if slot.edge is Edge.LOWER else part.width
            points, notch = contour(free[0])
            assert points[0] == pytest.approx([slot.x - slot.width / 2.0, edge], abs=0.01)
            assert points[-1] == pytest.approx([slot.x + slot.width / 2.0, edge], abs=0.01)
            # around a notch from the lower edge clockwise, the tool inside it
            assert free.get("ToolPosition") == ("right" if notch < 0.0 else "left")
            assert np.abs(points[:, 1] - edge).max() == pytest.approx(slot.depth, abs=0.01)
            assert float(free[0].get("Depth")) == pytest.approx(part.thickness, abs=0.01)
            away += abs(notch)
        assert part.length * part.width - away == pytest.approx(part.area, abs=0.01 * part.length)


def contour(element):
    """Corners of a contour, and the signed area between it and the chord from end to end."""
    place = lambda one: np.array([float(one.get("X")), float(one.get("Y"))])  # noqa: E731
    points, bulged = [place(element[0])], 0.0
    for step in element[1:]:
        a, b = points[-1], place(step[0])
        if step.tag == f"{SPACE}Arc":
            middle = place(step[1]) - (a + b) / 2.0
            chord = b - a
            rise = (chord[1] * middle[0] - chord[0] * middle[1]) / np.linalg.norm(chord)
            sweep = 4.0 * np.arctan(2.0 * rise / np.linalg.norm(chord))
            radius = np.linalg.norm(chord) / (2.0 * np.sin(sweep / 2.0))
            bulged += radius**2 / 2.0 * (sweep - np.sin(sweep))
        points.append(b)
    x, y = (np.array(points) - points[0]).T
    flat = (np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2.0
    return np.array(points), flat + bulged


def test_ends_are_square_cuts_at_either_end(enneper, written):
    for element, part in zip(written(enneper.parts)[1], enneper.parts, strict=True):
        start, end = map(numbers, of_kind(element, "JackRafterCut"))
        assert (start["Orientation"], end["Orientation"]) == ("start", "end")
        assert start["StartX"] == 0.0
        assert end["StartX"] == pytest.approx(part.length, abs=0.01)
        for cut in (start, end):
            assert (cut["Angle"], cut["Inclination"]) == (90.0, 90.0)


def test_bevelled_ends_meet_both_faces_where_the_flat_part_does(enneper, written):
    jointed = fab.ReciprocalJoint(gap=2.0).build(enneper.structure)
    parts = fab.parts_of(jointed)
    assert any(bevel > 0.1 for part in parts for bevel in part.bevels)
    assert any(bevel < -0.1 for part in parts for bevel in part.bevels)
    for element, part in zip(written(parts)[1], parts, strict=True):
        start, end = map(numbers, of_kind(element, "JackRafterCut"))
        near, far = part.faces
        for cut, low in ((start, True), (end, False)):
            # side 4 is the far face; the other lies a thickness behind it
            behind = part.thickness / np.tan(np.radians(cut["Inclination"]))
            x = cut["StartX"], cut["StartX"] + (behind if low else -behind)
            reach = np.min if low else np.max
            assert x == pytest.approx((reach(far[:, 0]), reach(near[:, 0])), abs=0.01)


def test_holes_are_drilled_through_the_face(profile, written):
    patch = gs.AsymptoticPatch(p=(-0.2, 0.2), q=(-0.2, 0.2), lamellas=(3, 3))
    net = gs.diagonal_meshes(gs.control_patch(gs.Enneper(4000.0), patch))[0]
    joint = fab.StudJoint(30.0, fab.Stud(fab.BIRCH_PLY), bolt=6.0)
    parts = fab.parts_of(joint.build(fab.structure(net, profile)))
    assert sum(len(part.holes) for part in parts) > 0
    for element, part in zip(written(parts)[1], parts, strict=True):
        drilled = [numbers(one) for one in of_kind(element, "Drilling")]
        rows = [[one["StartX"], one["StartY"], one["Diameter"]] for one in drilled]
        assert np.array(rows).reshape(-1, 3) == pytest.approx(part.circles, abs=0.01)
        assert all(one["DepthLimited"] == "no" for one in drilled)
        assert {one.get("ReferencePlaneID") for one in of_kind(element, "Drilling")} <= {"4"}


def test_marks_are_texts_where_the_sheets_have_them(enneper, written):
    for element, part in zip(written(enneper.parts)[1], enneper.parts, strict=True):
        texts = [numbers(one) for one in of_kind(element, "Text")]
        assert [one["Text"] for one in texts] == [label.text for label in part.labels]
        for one, label in zip(texts, part.labels, strict=True):
            have = (one["StartX"], one["StartY"], one["TextHeight"])
            assert have == pytest.approx((label.x, label.y, label.height), abs=0.01)
            assert one["Angle"] == pytest.approx(np.degrees(label.angle), abs=1e-3)


def test_copies_are_counted_and_placed_apart(pair, written):
    _, found = written([*pair.parts, *pair.parts])
    assert len(found) == len(pair.parts)
    y = []
    for element in found:
        assert element.get("Count") == "2"
        y += [float(point.get("Y")) for point in element.iter(f"{SPACE}ReferencePoint")]
    assert np.diff(y).min() > pair.parts[0].width
    assert Counter(y).most_common(1)[0][1] == 1


def test_a_second_file_is_the_same(pair, tmp_path):
    sets = [CutSet("strips", fab.BIRCH_PLY, pair.parts)]
    for name in ("a.btlx", "b.btlx"):
        write_btlx(tmp_path / name, "x", sets)
    assert (tmp_path / "a.btlx").read_bytes() == (tmp_path / "b.btlx").read_bytes()


# ---- refusals --------------------------------------------------------------------------------


def test_strips_of_steel_are_refused(pair, tmp_path):
    with pytest.raises(gs.SettingError, match="timber") as info:
        write_btlx(tmp_path / "a.btlx", "x", [CutSet("strips", fab.S235, pair.parts)])
    assert (info.value.where, info.value.value) == ("export.formats", "S235")


def test_hollow_strips_are_refused(pair, tmp_path):
    hollow = replace(pair.parts[0], wall=1.0)
    with pytest.raises(gs.SettingError, match="solid"):
        write_btlx(tmp_path / "a.btlx", "x", [CutSet("strips", fab.BIRCH_PLY, (hollow,))])


def test_a_file_that_cannot_be_written_is_an_error(pair, tmp_path):
    with pytest.raises(fab.errors.OutputError):
        write_btlx(tmp_path / "no" / "a.btlx", "x", [CutSet("s", fab.BIRCH_PLY, pair.parts)])
