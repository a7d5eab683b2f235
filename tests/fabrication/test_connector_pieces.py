import numpy as np
import pytest

import fabrication as fab
import gridshell as gs
from fabrication.connector_pieces import StarSpec, connector_pieces
from fabrication.sheet_parts import star_piece

STAR = StarSpec(thickness=6.0, layers=3)


def test_a_cylinder_is_one_piece_with_the_connector_s_mark(tower):
    (piece,) = connector_pieces(tower.connectors[:1], -65.0, None)
    assert (piece.mark, piece.height) == ("N1", 90.0)


def test_star_plates_lie_at_even_distances_and_flush_with_the_ends(tower):
    pieces = connector_pieces(tower.connectors[:1], -65.0, STAR)
    assert [piece.mark for piece in pieces] == ["N1-1", "N1-2", "N1-3"]
    axis, node = tower.connectors[0].frame.normal, tower.connectors[0].frame.origin
    low = [(piece.frame.origin - node) @ axis for piece in pieces]
    assert low == pytest.approx([-110.0, -68.0, -26.0])
    assert {piece.height for piece in pieces} == {6.0}


def test_a_star_plate_on_its_sheet_is_the_section_with_marks_inside(tower):
    (piece, *_) = connector_pieces(tower.connectors[5:6], -65.0, STAR)
    flat = star_piece(piece)
    assert flat.length == flat.width == 60.0
    assert flat.area == pytest.approx(piece.area)
    assert [label.text for label in flat.labels[1:]] == [
        f"S{arm.edge + 1}" for arm in piece.connector.arms
    ]
    for label in flat.labels:
        assert np.hypot(label.x - 30.0, label.y - 30.0) < 30.0


@pytest.mark.parametrize(("thickness", "layers"), [(0.0, 2), (6.0, 1)])
def test_a_star_that_is_none_is_refused(thickness, layers):
    with pytest.raises(gs.SettingError):
        StarSpec(thickness, layers)


@pytest.mark.xdist_group("kernel")
@pytest.mark.usefixtures("kernel_here")
def test_a_project_with_stars_cuts_them_from_sheets(tmp_path):
    project = fab.Project.model_validate(
        {
            "name": "stars",
            "surface": {"kind": "hyperboloid", "radius": 2000.0, "height": 3000.0},
            "patch": {"layout": "conjugate", "v": (-0.4, 0.5), "panels": (8, 3)},
            "net": {"kind": "planar", "angle": 90.0, "anchor": "free"},
            "panels": {"thickness": 8.0},
            "supports": {"below": -100.0, "thickness": 6.0},
            "connector": {"kind": "star", "radius": 30.0, "thickness": 5.0, "layers": 2},
            "sheet": {"length": 3000.0, "width": 2000.0},
        }
    )
    out = tmp_path / "out"
    report = fab.run(project, out)
    assert report["structure"]["star_plates"] == 64
    assert report["closure"]["max_mm"] < 1e-3
    assert report["findings"] == []
    drawn = [p for path in (out / "sheets").glob("stars-*") for p in fab.read_dxf(path)]
    assert len(drawn) == 64
    lines = (out / "parts.csv").read_text().splitlines()
    assert sum(",star plate," in line and line.endswith(",stars-01") for line in lines) == 64
