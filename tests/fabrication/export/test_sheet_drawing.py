import re
from dataclasses import replace

import ezdxf
import numpy as np
import pytest

import fabrication as fab
from fabrication.cut import Hole
from fabrication.export.dxf import write_dxf
from fabrication.export.sheet_drawing import sheet_drawings, sheet_svg
from fabrication.export.sheet_files import sheet_files
from fabrication.parts import Label
from fabrication.sheet_parts import panel_piece


@pytest.fixture(scope="module")
def sheets(catenoid):
    first, *others = catenoid.parts
    holed = replace(first, holes=(*first.holes, Hole(30.0, first.width / 2.0, 9.0, "N0", "bolt")))
    return fab.nest([holed, *others], fab.Sheet(6000.0, 700.0))


@pytest.fixture(scope="module")
def panels(leaning):
    return fab.nest([panel_piece(p) for p in leaning.panels], fab.Sheet(3000.0, 2000.0))


@pytest.fixture(params=["sheets", "panels"])
def nested(request):
    return request.getfixturevalue(request.param)


def corners(svg):
    """Of all closed lines of a drawing, mm; arcs are skipped to their ends."""
    path = re.search(r'<path d="([^"]*)"', svg)[1]
    for ring in path.split("Z")[:-1]:
        steps = re.findall("[MLA][^MLA]*", ring)[:-1]  # the last one ends where the first begins
        yield np.array([[float(n) for n in re.findall(r"-?[\d.]+", step)[-2:]] for step in steps])


def test_parts_and_holes_are_drawn_where_the_dxf_file_has_them(nested, tmp_path):
    for sheet, path in zip(nested, write_dxf(nested, tmp_path), strict=True):
        up = np.array([0.0, sheet.sheet.width])
        drawn = [(up - ring) * [-1.0, 1.0] for ring in corners(sheet_svg(sheet))]
        space = ezdxf.readfile(path).modelspace()
        cut = [np.array(line.get_points("xy")) for line in space.query('LWPOLYLINE[layer=="CUT"]')]
        circles = [(c.dxf.center.vec2, c.dxf.radius) for c in space.query('CIRCLE[layer=="CUT"]')]
        cut += [np.array([[x - r, y], [x + r, y]]) for (x, y), r in circles]
        assert len(cut) == len(drawn)
        for ring in cut:
            near = [np.abs(other - ring).max() for other in drawn if other.shape == ring.shape]
            assert min(near) < 0.051


def test_marks_are_drawn_where_they_are_engraved(nested):
    for sheet in nested:
        labels = [(p, label) for p in sheet.placements for label in p.part.labels]
        svg = sheet_svg(sheet)
        assert re.findall(r"<text[^>]*>([^<]*)</text>", svg) == [label.text for _, label in labels]
        places = [[p.x + label.x, p.y + label.y] for p, label in labels]
        drawn = re.findall(r"translate\((\S+) (\S+)\)", svg)
        flipped = np.array(drawn, dtype=float) * [1.0, -1.0] + [0.0, sheet.sheet.width]
        assert flipped == pytest.approx(np.array(places), abs=0.051)


def test_every_sheet_has_a_drawing_with_its_file_and_what_lies_on_it(nested):
    drawings = sheet_drawings(nested, sheet_files(nested, prefix="roof"))
    assert drawings[0].file == "roof-01.dxf"
    for sheet, drawing in zip(nested, drawings, strict=True):
        size = f"{sheet.sheet.length:g} × {sheet.sheet.width:g} mm"
        assert drawing.words.startswith(f"{size}, {len(sheet.placements)} part")
        assert drawing.words.endswith(f"{100 * sheet.used:.0f} % used")


def test_names_are_text(sheets):
    placement = sheets[0].placements[0]
    label = Label("<b>&", 10.0, 10.0, 5.0)
    odd = replace(placement, part=replace(placement.part, labels=(label,)))
    assert "&lt;b&gt;&amp;" in sheet_svg(replace(sheets[0], placements=(odd,)))
