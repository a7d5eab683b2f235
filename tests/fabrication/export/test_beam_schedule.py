import csv
from math import degrees

import pytest

from fabrication.beam_layout import BeamSection, beams
from fabrication.errors import OutputError
from fabrication.export.beam_schedule import COLUMNS, write_beam_schedule


@pytest.fixture
def made(tower):
    return beams(tower.mesh, BeamSection(width=40.0, height=80.0))


def test_one_line_per_beam_with_both_ends(made, tmp_path):
    write_beam_schedule(tmp_path / "beams.csv", made)
    with (tmp_path / "beams.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert tuple(rows[0]) == COLUMNS
    assert [row["mark"] for row in rows] == [beam.mark for beam in made]
    for row, beam in zip(rows, made, strict=True):
        assert float(row["length_mm"]) == pytest.approx(beam.length, abs=5e-4)
        for name, end in (("start", beam.start), ("end", beam.end)):
            assert row[f"{name}_node"] == f"N{end.node + 1}"
            assert float(row[f"{name}_slope_deg"]) == pytest.approx(degrees(end.slope), abs=5e-4)
            for side in ("left", "right"):
                mitre, cell = getattr(end, side), row[f"{name}_mitre_{side}_deg"]
                assert (cell == "") == (mitre is None)
                if mitre is not None:
                    assert float(cell) == pytest.approx(degrees(mitre), abs=5e-4)


def test_a_folder_that_is_not_there_is_named(made, tmp_path):
    with pytest.raises(OutputError, match="beams cannot be written"):
        write_beam_schedule(tmp_path / "no" / "beams.csv", made)
