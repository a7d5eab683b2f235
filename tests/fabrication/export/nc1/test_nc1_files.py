"""NC1 files of whole packages, read back and laid over the flat parts."""

import csv

import numpy as np
import pytest

import fabrication as fab
import gridshell as gs
from fabrication.cut import Floor, Relief
from fabrication.export.cut_sets import CutSet, counted
from fabrication.export.nc1.files import INDEX, Plate, nc1_text, plate_of, write_nc1
from fabrication.sheet_parts import shape_piece


def over(found, part, nc1):
    """Everything of a file against the part, to 0.01 mm."""
    assert found.code == "B"
    assert float(found.length) == pytest.approx(part.length, abs=0.01)
    assert float(found.height) == pytest.approx(part.width, abs=0.01)
    assert float(found.thickness) == pytest.approx(part.thickness, abs=0.01)
    assert found.holes == pytest.approx(part.circles, abs=0.01)
    (outer,) = found.outer
    net = nc1.area(outer) - (np.pi / 4.0 * found.holes[:, 2] ** 2).sum()
    assert abs(net - part.area) <= 0.01 * nc1.around(outer)
    assert nc1.area(outer) > 0.0
    low, high = np.array(outer)[:, :2].min(axis=0), np.array(outer)[:, :2].max(axis=0)
    assert low == pytest.approx([0.0, 0.0], abs=0.01)
    assert high == pytest.approx([part.length, part.width], abs=0.01)
    return True


@pytest.mark.parametrize("floor", [Floor.SQUARE, Floor.ROUND, Floor.DOGBONE])
def test_strips_come_back_with_their_slots(floor, enneper, nc1, tmp_path):
    relief = Relief(floor, 0.2 if floor is Floor.DOGBONE else 0.0)
    parts = fab.parts_of(fab.SlotJoint().build(enneper.structure), relief)
    paths = write_nc1(tmp_path, "shell", [CutSet("strips", fab.S355, parts)])
    assert [path.name for path in paths] == [f"{part.mark}.nc1" for part in parts]
    for path, part in zip(paths, parts, strict=True):
        found = nc1.read(path)
        assert over(found, part, nc1)
        assert found.blocks == ["AK", "SI"]
        assert (found.order, found.mark, found.steel) == ("shell", part.mark, "S355")
        assert (found.quantity, found.profile) == ("1", f"FL{part.thickness:g}*{part.width:g}")
        reversals = sum(radius < 0.0 for *_, radius in found.outer[0])
        per_slot = {Floor.SQUARE: 0, Floor.ROUND: 2, Floor.DOGBONE: 4}
        kinds = [per_slot[slot.floor] for slot in part.slots]
        assert reversals == sum(kinds)
        assert [text for _, text in found.marks] == [label.text for label in part.labels]


def test_corners_are_those_of_the_outline(enneper, nc1, tmp_path):
    part = enneper.parts[0]
    (path,) = write_nc1(tmp_path, "shell", [CutSet("strips", fab.S235, (part,))])
    (outer,) = nc1.read(path).outer
    assert np.array(outer)[:-1, :2] == pytest.approx(part.outline[:, :2], abs=5.01e-4)


def test_masses_and_surfaces_are_a_metre_s(enneper, nc1, tmp_path):
    part = enneper.parts[0]
    (path,) = write_nc1(tmp_path, "shell", [CutSet("strips", fab.S235, (part,))])
    found = nc1.read(path)
    assert float(found.mass) == pytest.approx(part.width * part.thickness * 7.85e-3, abs=1e-3)
    assert float(found.surface) == pytest.approx(2e-3 * (part.width + part.thickness), abs=1e-3)
    ends = (found.web_start, found.web_end, found.flange_start, found.flange_end)
    assert [float(end) for end in ends] == [0.0] * 4


def test_labels_are_stamped_around_their_middle(enneper, nc1, tmp_path):
    part = enneper.parts[0]
    (path,) = write_nc1(tmp_path, "shell", [CutSet("strips", fab.S235, (part,))])
    for ((x, y, angle, height), text), label in zip(nc1.read(path).marks, part.labels, strict=True):
        assert text == label.text
        assert height == max(1, int(label.height))
        assert angle == pytest.approx(np.degrees(label.angle), abs=1e-3)
        c, s = np.cos(label.angle), np.sin(label.angle)
        along, up = fab.parts.LETTER * height * len(text) / 2.0, height / 2.0
        middle = (x + c * along - s * up, y + s * along + c * up)
        assert middle == pytest.approx((label.x, label.y), abs=0.01)


def test_bolted_strips_have_their_holes_and_washers_theirs(profile, nc1, tmp_path):
    patch = gs.AsymptoticPatch(p=(-0.2, 0.2), q=(-0.2, 0.2), lamellas=(3, 3))
    net = gs.diagonal_meshes(gs.control_patch(gs.Enneper(4000.0), patch))[0]
    joint = fab.DoubleSlotJoint(30.0, 8.0, fab.StarWasher(4.0, 18.0, 8.0, fab.S235))
    jointed = joint.build(fab.structure(net, profile))
    (washers,) = (kind for kind in jointed.connectors if kind.from_sheet)
    pieces = tuple(shape_piece(b.mark, washers.shapes[b.shape]) for b in washers.bodies)
    sets = [
        CutSet("strips", profile.material, fab.parts_of(jointed)),
        CutSet("star-washers", washers.material, pieces),
    ]
    paths = write_nc1(tmp_path, "shell", sets)
    distinct = counted(sets[1])
    assert len(paths) == len(sets[0].parts) + len(distinct)
    assert len(distinct) <= len(washers.shapes)
    assert sum(one.quantity for one in distinct) == len(washers.bodies)
    for path, one in zip(paths[len(sets[0].parts) :], distinct, strict=True):
        found = nc1.read(path)
        assert over(found, one.part, nc1)
        assert found.blocks == ["AK", "BO", "SI"]
        assert (len(found.holes), int(found.quantity)) == (1, one.quantity)
        assert found.profile.startswith("PL4*")


def test_the_index_counts_every_part_once(enneper, tmp_path):
    parts = (*enneper.parts, *enneper.parts)
    write_nc1(tmp_path, "shell", [CutSet("strips", fab.S235, parts)])
    with (tmp_path / INDEX).open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["quantity"] for row in rows} == {"2"}
    assert [row["marks"] for row in rows] == [part.mark for part in enneper.parts]
    assert all((tmp_path / row["file"]).is_file() for row in rows)
    assert {(row["kind"], row["material"]) for row in rows} == {("strips", "S235")}


# ---- shapes that no joint makes yet ----------------------------------------------------------


def plate(**changes):
    usual = {
        "mark": "P1",
        "profile": "PL10*80",
        "outline": np.array([[0.0, 0.0], [120.0, 0.0], [120.0, 80.0], [0.0, 80.0]]),
        "circles": np.zeros((0, 3)),
        "labels": (),
        "length": 120.0,
        "width": 80.0,
        "thickness": 10.0,
        "material": fab.S235,
    }
    return Plate(**{**usual, **changes})


def read_text(text, nc1, tmp_path):
    path = tmp_path / "p.nc1"
    path.write_text(text, encoding="ascii", newline="\r\n")
    return nc1.read(path)


def test_openings_are_inner_contours_clockwise_and_round_ones_are_drilled(nc1, tmp_path):
    slot = np.array([[30.0, 30.0, 0.0], [60.0, 30.0, 1.0], [60.0, 50.0, 0.0], [30.0, 50.0, 1.0]])
    around = np.array([[90.0, 40.0, 1.0], [100.0, 40.0, 1.0]])
    made = plate(openings=(slot, around), circles=np.array([[10.0, 12.0, 9.0]]))
    found = read_text(nc1_text(made, order="x"), nc1, tmp_path)
    assert found.blocks == ["AK", "IK", "BO"]
    (inner,) = found.inner
    assert nc1.area(inner) == pytest.approx(-(30.0 * 20.0 + np.pi * 100.0), abs=0.05)
    assert found.holes == pytest.approx(np.array([[10.0, 12.0, 9.0], [95.0, 40.0, 10.0]]))
    low, high = np.array(inner)[:, :2].min(axis=0), np.array(inner)[:, :2].max(axis=0)
    assert (low.tolist(), high.tolist()) == ([20.0, 30.0], [70.0, 50.0])


@pytest.mark.parametrize("bulge", [1.0, 0.4, -0.3, -1.0, 2.0])
def test_arcs_of_any_sweep_keep_their_area(bulge, nc1, tmp_path):
    outline = np.array([[0.0, 0.0, 0.0], [120.0, 0.0, bulge], [120.0, 80.0, 0.0], [0.0, 80.0, 0.0]])
    found = read_text(nc1_text(plate(outline=outline), order="x"), nc1, tmp_path)
    truth = fab.cut.area(outline)
    assert nc1.area(found.outer[0]) == pytest.approx(truth, abs=0.5)
    assert all(np.sign(radius) in (0.0, np.sign(bulge)) for *_, radius in found.outer[0])


def test_a_polygon_with_arcs_that_is_no_circle_is_not_drilled(nc1, tmp_path):
    lens = np.array([[40.0, 40.0, 0.5], [60.0, 40.0, 0.5]])
    found = read_text(nc1_text(plate(openings=(lens,)), order="x"), nc1, tmp_path)
    assert len(found.inner) == 1
    assert len(found.holes) == 0


def test_names_are_plain_ascii(nc1, tmp_path):
    found = read_text(nc1_text(plate(), order="Dach über\tEck"), nc1, tmp_path)
    assert found.order == "Dach ?ber Eck"


def test_marks_that_are_no_file_names_and_come_twice_have_files_of_their_own(tmp_path, enneper):
    part = enneper.parts[0]
    sets = [CutSet("strips", fab.S235, (part,)), CutSet("others", fab.S235, (part,))]
    names = [path.name for path in write_nc1(tmp_path, "x", sets)]
    assert names == [f"{part.mark}.nc1", f"others-{part.mark}.nc1"]


# ---- refusals --------------------------------------------------------------------------------


def test_parts_that_are_not_of_steel_are_left_out_or_refused(enneper, tmp_path):
    timber = CutSet("strips", fab.BIRCH_PLY, enneper.parts)
    with pytest.raises(gs.SettingError) as info:
        write_nc1(tmp_path / "nc1", "x", [timber])
    assert (info.value.where, info.value.value) == ("export.formats", "birch-ply")
    assert not (tmp_path / "nc1").exists()
    steel = CutSet("others", fab.S235, enneper.parts[:1])
    assert len(write_nc1(tmp_path / "nc1", "x", [timber, steel])) == 1


def test_bevelled_ends_are_refused(enneper, profile):
    part = fab.ReciprocalJoint(gap=2.0).build(enneper.structure)
    bevelled = [p for p in fab.parts_of(part) if p.bevels != (0.0, 0.0)]
    (one,) = counted(CutSet("strips", fab.S235, (bevelled[0],)))
    with pytest.raises(gs.SettingError, match="square ends") as info:
        plate_of(one, fab.S235)
    assert bevelled[0].mark in info.value.value


def test_a_folder_that_cannot_be_made_is_an_error(enneper, tmp_path):
    (tmp_path / "nc1").write_text("")
    with pytest.raises(fab.errors.OutputError):
        write_nc1(tmp_path / "nc1", "x", [CutSet("strips", fab.S235, enneper.parts)])
