import shutil
from dataclasses import replace

import ezdxf
import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import fabrication as fab
import gridshell as gs
from fabrication.loop import slot_centres

pytestmark = pytest.mark.xdist_group("kernel")


@pytest.fixture(scope="module", params=["catenoid", "enneper", "hypar"])
def sound(request, files):
    """A design and how its written files close onto it."""
    design = request.getfixturevalue(request.param)
    return design, closed(design, files(design))


@pytest.fixture(scope="module")
def four(pair, files):
    """The smallest design and its written files, to spoil one by one."""
    return pair, files(pair)


def closed(design, files, *, sheets=None, step=None, net=None):
    reference = fab.SlotJoint().build(fab.structure(net or files.net, design.structure.profile))
    return fab.closure(reference, design.parts, sheets or files.sheets, step or files.step)


def on_sheets(parts, folder):
    return fab.write_dxf(fab.nest(parts, fab.Sheet(12000.0, 1500.0)), folder)


def as_step(solids, design, folder):
    path = folder / "structure.step"
    fab.write_step(fab.assembly(solids, design.structure, name="shell"), path)
    return path


# ---- sound files ----------------------------------------------------------------------------


def test_files_close_onto_the_design(sound):
    _, result = sound
    assert result.max_mm < 0.05
    assert result.volume_ppm < 20.0


def test_every_strip_and_every_slot_is_compared(sound):
    design, result = sound
    assert result.strips == len(design.structure.lamellas)
    assert result.slots == 2 * sum(node.regular for node in design.structure.nodes)


def test_the_figure_is_the_larger_of_nodes_and_outlines(sound):
    _, result = sound
    assert result.max_mm == max(result.node_mm, result.outline_mm)


def test_the_worst_place_is_a_lamella_at_a_node(sound):
    design, result = sound
    mark, node = result.worst.split(" at ")
    assert node in {slot.node for slot in design.part(mark).slots}


# ---- faults that must be seen ---------------------------------------------------------------


def test_a_slot_a_fifth_of_a_millimetre_off_is_seen_where_it_is(four, with_slots, tmp_path):
    design, files = four
    first, *rest = design.parts
    off = [replace(first.slots[0], x=first.slots[0].x + 0.2), *first.slots[1:]]
    sheets = on_sheets([with_slots(first, off), *rest], tmp_path)
    result = closed(design, files, sheets=sheets)
    assert result.node_mm == pytest.approx(0.2, abs=0.01)
    assert result.outline_mm == pytest.approx(0.2, abs=0.01)
    assert result.worst == f"{first.mark} at {first.slots[0].node}"


def test_a_slot_a_fifth_of_a_millimetre_too_wide_is_seen(four, with_slots, tmp_path):
    design, files = four
    first, *rest = design.parts
    wide = [replace(slot, width=slot.width + 0.2) for slot in first.slots]
    result = closed(design, files, sheets=on_sheets([with_slots(first, wide), *rest], tmp_path))
    assert result.outline_mm == pytest.approx(0.1, abs=0.01)


def test_a_part_turned_upside_down_is_seen(four, tmp_path):
    design, files = four
    first, *rest = design.parts
    turned = replace(first, outline=(first.outline * [1, -1] + [0, first.width])[::-1])
    result = closed(design, files, sheets=on_sheets([turned, *rest], tmp_path))
    assert result.outline_mm > 0.5


def test_a_strip_a_fifth_of_a_millimetre_too_long_is_seen(four, tmp_path):
    design, files = four
    first, *rest = design.parts
    longer = first.outline.copy()
    longer[longer[:, 0] == first.length, 0] += 0.2
    sheets = on_sheets([replace(first, outline=longer), *rest], tmp_path)
    assert closed(design, files, sheets=sheets).outline_mm == pytest.approx(0.2, abs=0.01)


def test_two_parts_with_each_other_s_marks_are_seen(four, tmp_path):
    design, files = four
    a, b, *rest = design.parts[1:] + design.parts[:1]
    swapped = [replace(a, mark=b.mark), replace(b, mark=a.mark), *rest]
    assert closed(design, files, sheets=on_sheets(swapped, tmp_path)).max_mm > 0.05


def test_a_scaled_solid_is_seen(four, tmp_path):
    design, files = four
    grown = [body.scale(1.001) for body in files.solids]
    result = closed(design, files, step=as_step(grown, design, tmp_path))
    assert result.volume_ppm > 1000.0
    assert result.max_mm > 0.5


def test_a_solid_a_percent_too_thick_is_seen(four, tmp_path):
    design, files = four
    thick = [replace(part, thickness=1.01 * part.thickness) for part in design.parts]
    step = as_step(fab.solids(design.structure, thick), design, tmp_path)
    assert closed(design, files, step=step).volume_ppm == pytest.approx(1e4, rel=0.02)


def test_a_solid_moved_by_a_tenth_is_seen(four, tmp_path):
    import build123d

    design, files = four
    moved = [body.moved(build123d.Location((0.1, 0.0, 0.0))) for body in files.solids]
    result = closed(design, files, step=as_step(moved, design, tmp_path))
    assert result.node_mm == pytest.approx(0.1, abs=0.01)


def test_a_strip_that_leans_is_seen_at_its_edges(four, tmp_path):
    """Turned about its axis: the axis stays, the edges move by a fifth of a millimetre."""
    design, files = four
    first, *rest = design.structure.lamellas
    f = first.frames(first.stations)
    leaning = CubicSpline(first.stations, f.n + 0.2 / 50.0 * f.b)
    structure = replace(design.structure, lamellas=(replace(first, normals=leaning), *rest))
    step = as_step(fab.solids(structure, design.parts), design, tmp_path)
    result = closed(design, files, step=step)
    assert result.node_mm == pytest.approx(0.2, abs=0.01)
    assert result.worst.startswith(first.mark)


def test_a_tooth_in_an_edge_is_seen(four, tmp_path):
    design, files = four
    first, *rest = design.parts
    corner = first.outline[0]
    tooth = corner + np.array([[20.0, 0.0], [20.5, 3.0], [21.0, 0.0]])
    toothed = np.vstack([first.outline[:1], tooth, first.outline[1:]])
    sheets = on_sheets([replace(first, outline=toothed), *rest], tmp_path)
    assert closed(design, files, sheets=sheets).outline_mm > 0.5


def test_a_node_of_another_net_is_seen(four):
    design, files = four
    vertices = files.net.vertices.copy()
    vertices[2] += [0.0, 0.0, 0.3]
    result = closed(design, files, net=replace(files.net, vertices=vertices))
    assert result.node_mm == pytest.approx(0.3, abs=0.01)
    assert result.worst.endswith(design.structure.nodes[2].name)


def test_a_part_missing_from_the_sheets_is_named(four, tmp_path):
    design, files = four
    sheets = on_sheets([part for part in design.parts if part.mark != "B1"], tmp_path)
    with pytest.raises(gs.FileError, match="missing from the files") as info:
        closed(design, files, sheets=sheets)
    assert info.value.where == "B1"


def test_a_solid_missing_from_the_assembly_is_named(four, tmp_path):
    design, files = four
    few = replace(design.structure, lamellas=design.structure.lamellas[:-1])
    path = tmp_path / "structure.step"
    fab.write_step(fab.assembly(files.solids[:-1], few, name="shell"), path)
    with pytest.raises(gs.FileError, match="missing from the files") as info:
        closed(design, files, step=path)
    assert info.value.where == "B2"


def test_a_slot_that_was_not_drawn_is_named_with_its_part(four, with_slots, tmp_path):
    design, files = four
    first, *rest = design.parts
    sheets = on_sheets([with_slots(first, first.slots[1:]), *rest], tmp_path)
    with pytest.raises(gs.FileError, match="another number of slots") as info:
        closed(design, files, sheets=sheets)
    assert (info.value.where, info.value.value, info.value.limit) == ("A1", "1 slots", "2")


def test_a_sheet_spoilt_on_disk_is_refused(four, tmp_path):
    design, files = four
    path = tmp_path / files.sheets[0].name
    shutil.copy(files.sheets[0], path)
    document = ezdxf.readfile(path)
    document.modelspace().query('LWPOLYLINE[layer=="CUT"]')[0].close(False)
    document.saveas(path)
    with pytest.raises(gs.FileError, match="no closed outline"):
        closed(design, files, sheets=[path, *files.sheets[1:]])


# ---- slots of a drawn outline ---------------------------------------------------------------


def test_slot_centres_are_read_off_the_outline_alone(enneper):
    for part in enneper.parts:
        found = slot_centres(part.outline)
        np.testing.assert_allclose(found, [slot.x for slot in part.slots], atol=1e-9)


def test_a_strip_without_slots_has_no_slot_centres(strip):
    assert len(slot_centres(strip("A1", 500.0).outline)) == 0
