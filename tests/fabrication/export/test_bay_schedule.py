import csv

import numpy as np
import pytest

from fabrication.errors import OutputError
from fabrication.export.bay_schedule import COLUMNS, write_bay_schedule
from fabrication.strength import bay_stress


@pytest.fixture
def stress(enneper):
    return bay_stress(enneper.structure, enneper.parts)


@pytest.fixture
def rows(stress, tmp_path):
    write_bay_schedule(tmp_path / "bays.csv", stress)
    with (tmp_path / "bays.csv").open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_there_is_one_line_per_bay_in_order(rows, stress):
    assert tuple(rows[0]) == COLUMNS
    assert [f"{row['strip']} {row['bay']}" for row in rows] == [
        stress.where(bay) for bay in range(len(stress))
    ]


def test_figures_are_those_of_the_bays(rows, stress):
    for bay, row in enumerate(rows):
        assert float(row["radius_mm"]) == pytest.approx(stress.radius[bay], rel=1e-3)
        rate = np.radians(float(row["twist_deg_per_m"])) / 1e3
        assert rate == pytest.approx(stress.twist[bay], rel=1e-3)
        assert float(row["utilisation"]) == pytest.approx(stress.utilisation[bay], abs=5e-5)
        assert float(row["thickest_mm"]) == pytest.approx(stress.thickest[bay], abs=5e-4)
        assert float(row["end_mm"]) - float(row["start_mm"]) == pytest.approx(
            stress.end[bay] - stress.start[bay], abs=0.011
        )


def test_what_has_no_end_stays_empty(hypar, tmp_path):
    flat = bay_stress(hypar.structure, hypar.parts)
    flat.thickest.setflags(write=True)
    flat.thickest[0] = np.inf
    write_bay_schedule(tmp_path / "bays.csv", flat)
    text = (tmp_path / "bays.csv").read_text()
    assert "inf" not in text
    assert next(csv.DictReader(text.splitlines()))["thickest_mm"] == ""


def test_a_folder_that_is_not_there_is_an_error(stress, tmp_path):
    with pytest.raises(OutputError, match="list of bays"):
        write_bay_schedule(tmp_path / "missing" / "bays.csv", stress)
