"""Every figure of the paper holds, and a figure that does not is told."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from typer.testing import CliRunner

from fabrication.cli import app
from fabrication.gallery import FIGURES, Condition, Figure, build
from fabrication.gallery.building import chosen
from gridshell import SettingError, SolveError

RUNNER = CliRunner()


@pytest.mark.parametrize("name", FIGURES)
def test_every_figure_holds_by_its_own_numbers(tmp_path, name):
    (row,) = build(tmp_path, [name])
    figure = row.figure
    assert figure is not None, row.fault
    assert [c for c in figure.conditions if not c.holds] == []
    stem = f"fig_{int(name):02d}"
    report = json.loads((tmp_path / f"{stem}.json").read_text())
    assert report["holds"] is True
    assert len(report["conditions"]) == len(figure.conditions)
    assert report["ours"]
    picture = tmp_path / f"{stem}.png"
    assert picture.stat().st_size < 150_000
    with Image.open(picture) as image:
        colours = image.convert("RGB").getcolors(maxcolors=1 << 20)
    assert len(colours) > 5


PICTURES = Path(__file__).parents[3] / "examples" / "gallery"


@pytest.mark.parametrize("name", FIGURES)
def test_the_readme_shows_the_picture_that_is_made(tmp_path, name):
    stem = f"fig_{int(name):02d}.png"
    assert f"(examples/gallery/{stem})" in (PICTURES.parents[1] / "README.md").read_text()
    build(tmp_path, [name])
    with Image.open(PICTURES / stem) as shown, Image.open(tmp_path / stem) as made:
        assert shown.size == made.size
        apart = np.abs(
            np.subtract(*(np.asarray(i.convert("L"), dtype=float) for i in (shown, made)))
        )
    assert apart.mean() < 1.0


def stand_in(monkeypatch, make):
    monkeypatch.setitem(FIGURES, "3", make)


def figure_with(*conditions):
    from fabrication.gallery.fig_05 import figure

    true = figure()
    return Figure("3", "a title", {"|V|": 5}, {"|V|": 4}, conditions, true.scenes, ("a remark",))


def test_a_figure_that_misses_its_own_numbers_ends_with_1(monkeypatch, tmp_path):
    made = figure_with(Condition("planarity", 2e-3, 1e-6), Condition("angle", 0.0, 1.0))
    stand_in(monkeypatch, lambda: made)
    found = RUNNER.invoke(app, ["gallery", "3", "--out", str(tmp_path)])
    assert found.exit_code == 1
    assert "planarity: 0.002 (1e-06 allowed)" in " ".join(found.output.replace("│", " ").split())
    assert json.loads((tmp_path / "gallery.json").read_text())["holds"] is False


def test_a_figure_that_cannot_be_made_is_a_row_that_fails(monkeypatch, tmp_path):
    def broken():
        raise SolveError("No net was found", advice="another angle")

    stand_in(monkeypatch, broken)
    (row,) = build(tmp_path, ["3"])
    assert not row.holds
    assert "No net was found" in row.fault
    assert json.loads((tmp_path / "fig_03.json").read_text())["fault"] == row.fault


def test_without_conditions_nothing_holds():
    assert not figure_with().holds
    assert not figure_with(Condition("angle", float("nan"), 1.0)).holds


@pytest.mark.parametrize("name", ["13", "Fig. 13", "13a", "013"])
def test_figures_are_chosen_by_the_papers_names(name):
    assert chosen([name]) == ("13",)


def test_all_are_chosen_where_none_is_named():
    assert chosen([]) == tuple(FIGURES)


@pytest.mark.parametrize("name", ["4", "x", "", "1.3"])
def test_a_figure_that_is_not_there_is_refused(name):
    with pytest.raises(SettingError, match="no such figure") as info:
        chosen([name])
    assert "13" in info.value.limit


def test_the_command_prints_the_paper_beside_ours(tmp_path):
    found = RUNNER.invoke(app, ["gallery", "5", "7", "--out", str(tmp_path)])
    assert found.exit_code == 0
    assert "|V| 800 (800)" in found.output
    assert sorted(p.name for p in tmp_path.iterdir()) == [
        *("fig_05.json", "fig_05.png", "fig_07.json", "fig_07.png", "gallery.json")
    ]


def test_a_folder_that_cannot_be_is_told(tmp_path):
    (tmp_path / "file").write_text("")
    from fabrication.errors import OutputError

    with pytest.raises(OutputError, match="cannot be written"):
        build(tmp_path / "file", ["5"])
