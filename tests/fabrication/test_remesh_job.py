import json
from dataclasses import replace
from math import radians

import numpy as np
import pytest

import gridshell as gs
from fabrication.errors import OutputError
from fabrication.finding import Severity
from fabrication.remesh_checks import MOST_QUADS, check_quads, require_few_quads
from fabrication.remesh_job import GuideFile, Wish, lay, remesh, require_outputs, write_remeshed
from fabrication.section_types import MOST_NODES
from gridshell.mesh import grid_quads


def saddle(size=2400.0, count=24):
    x, y = np.meshgrid(*[np.linspace(-size / 2, size / 2, count + 1)] * 2, indexing="ij")
    points = np.stack([x, y, 3e-4 * x * x - 2e-4 * y * y], axis=-1).reshape(-1, 3)
    return gs.TriangulatedSurface.of_quads(points, grid_quads(count, count))


@pytest.fixture(scope="module")
def laid():
    return lay(saddle(), None, Wish(gs.Asymptotic(), quads=150))


def test_the_report_is_data_that_json_can_say(laid):
    report = json.loads(json.dumps(laid.report(), allow_nan=False))
    assert report["remesh"]["quads"] == len(laid.made.mesh.quads)
    assert laid.good
    assert report["findings"] == []


def test_what_is_not_finite_is_left_out_of_the_report(laid):
    remark = gs.Remark("crossings-unknown", "too uneven to ask", float("nan"))
    made = replace(laid.made, report=replace(laid.made.report, remarks=(remark,)))
    found = replace(
        laid, made=made, findings=tuple(check_quads(made, extent=gs.Extent.COVER))
    ).report()
    assert found["remesh"]["remarks"][0]["value"] is None
    json.dumps(found, allow_nan=False)


@pytest.mark.parametrize(
    ("changes", "code", "severity"),
    [
        ({"non_quads": 2}, "non-quads", Severity.ERROR),
        ({"colour_conflicts": 1}, "colour-conflict", Severity.ERROR),
        ({"coverage": 0.5}, "uncovered", Severity.WARNING),
        ({"remarks": (gs.Remark("welded", "3 welded", 3.0),)}, "welded", Severity.INFO),
        ({"remarks": (gs.Remark("noise", "rough", 0.1),)}, "noise", Severity.WARNING),
        (
            {"remarks": (gs.Remark("not-integrable", "cannot", 7.0),)},
            "not-integrable",
            Severity.WARNING,
        ),
    ],
)
def test_faults_become_findings_with_a_severity(laid, changes, code, severity):
    made = replace(laid.made, report=replace(laid.made.report, **changes))
    (found,) = check_quads(made, extent=gs.Extent.COVER)
    assert (found.code, found.severity) == (code, severity)
    assert found.where
    assert found.message.endswith(".")


def test_turned_triangles_of_the_chart_are_warnings_with_their_place(laid):
    chart = replace(laid.made.chart, folded=np.array([5]), cones=np.array([7]))
    found = check_quads(replace(laid.made, chart=chart), extent=gs.Extent.COVER)
    assert [f.code for f in found] == ["chart-flips", "chart-cones"]
    assert found[0].where.startswith("triangle 5 (")
    assert found[1].where.startswith("vertex 7 (")
    assert {f.severity for f in found} == {Severity.WARNING}


def test_a_mesh_inside_only_need_not_cover_the_surface(laid):
    made = replace(laid.made, report=replace(laid.made.report, coverage=0.5))
    assert check_quads(made, extent=gs.Extent.INSIDE) == []


def test_the_most_quads_are_the_most_nodes():
    assert MOST_QUADS == MOST_NODES
    surface = saddle()
    require_few_quads(surface, None, 10.0)
    with pytest.raises(gs.SettingError, match="edges of") as info:
        require_few_quads(surface, None, 1.0)
    assert info.value.where == "edge"


def test_directions_are_led_by_the_lines_of_a_file(tmp_path):
    (tmp_path / "g.csv").write_text("-1000,0,300\n1000,0,300\n")
    wish = Wish(gs.Principal(), quads=100, guides=(GuideFile(tmp_path / "g.csv", 2),))
    assert lay(saddle(), gs.Unit.MM, wish).good


def test_a_file_is_read_and_remeshed_with_its_times(tmp_path):
    surface = saddle()
    rows = ["v {} {} {}".format(*p) for p in surface.vertices]
    rows += ["f {} {} {}".format(*t) for t in surface.triangles + 1]
    (tmp_path / "s.obj").write_text("\n".join(rows))
    wish = Wish(gs.Conjugate(radians(80)), quads=None, edge=250.0)
    found = remesh(tmp_path / "s.obj", gs.Unit.MM, wish)
    assert set(found.seconds) == {"read", "remesh"}
    assert found.made.report.spacing_mm == 250.0
    with pytest.raises(gs.UnitError):
        remesh(tmp_path / "s.obj", None, wish)


def test_pictures_and_files_come_together_or_not_at_all(laid, tmp_path, monkeypatch):
    (tmp_path / "pics").write_text("mine")
    with pytest.raises(OutputError):
        write_remeshed(
            laid, gs.Unit.MM, name="s", out=tmp_path / "m.obj", pictures=tmp_path / "pics"
        )
    assert [path.name for path in tmp_path.iterdir()] == ["pics"]
    with pytest.raises(OutputError):
        require_outputs([tmp_path / "m.obj", None], tmp_path / "pics")


def test_a_mesh_too_small_for_a_control_mesh_writes_nothing(tmp_path):
    wish = Wish(gs.Principal(), quads=6, extent=gs.Extent.INSIDE)
    small = lay(saddle(), None, wish)
    assert small.made.report.control_quads == 0
    assert "too-coarse" in {finding.code for finding in small.findings}
    with pytest.raises(gs.MeshError):
        write_remeshed(
            small, gs.Unit.MM, name="s", out=tmp_path / "m.obj", control=tmp_path / "c.obj"
        )
    assert list(tmp_path.iterdir()) == []
