import re
from itertools import pairwise

import pytest

import fabrication as fab
from fabrication.export.dxf import write_dxf
from fabrication.export.sheet_files import sheet_files, sheet_thickness
from fabrication.shop import FileNames, Process


@pytest.fixture(scope="module")
def sheets(catenoid):
    return fab.nest(catenoid.parts, fab.Sheet(6000.0, 700.0))


@pytest.mark.parametrize("template", ["{prefix}-{number}", "{name} {thickness} {number}"])
def test_files_are_written_under_these_names(sheets, template, tmp_path):
    more = {
        **{"name": "A roof", "material": "S355", "prefix": "bar"},
        "process": Process(files=FileNames(template)),
    }
    written = write_dxf(sheets, tmp_path, **more)
    assert [path.stem for path in written] == sheet_files(sheets, **more)


def test_names_sort_as_the_sheets_do_and_tell_them_apart(sheets):
    many = [type(sheets[0])(number, sheets[0].sheet, sheets[0].placements) for number in range(120)]
    names = sheet_files(many)
    assert all(a < b for a, b in pairwise(names))
    assert {len(re.search(r"\d+$", name)[0]) for name in names} == {3}


def test_the_thickness_is_that_of_the_parts(sheets, catenoid):
    assert sheet_thickness(sheets[0]) == f"{catenoid.parts[0].thickness:g} mm"
