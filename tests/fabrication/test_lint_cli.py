import json
import sys

import ezdxf
import pytest

import fabrication as fab
from fabrication import cli
from fabrication.shop import Layers, Process


@pytest.fixture
def command(capsys, monkeypatch, tmp_path, pair):
    """Run ``gridshell lint`` beside a good sheet and an open one: exit code, output, errors."""
    monkeypatch.chdir(tmp_path)
    nested = fab.nest(pair.parts, fab.Sheet(4000.0, 1000.0))
    (good,) = fab.write_dxf(nested, tmp_path, prefix="good")
    fab.write_dxf(nested, tmp_path, prefix="shop", process=Process(layers=Layers(cut="0_CUT")))
    document = ezdxf.readfile(good)
    for outline in document.modelspace().query("LWPOLYLINE[layer=='CUT']"):
        outline.close(False)
    document.saveas("open.dxf")
    (tmp_path / "text.dxf").write_text("hello")

    def run(*arguments):
        monkeypatch.setattr(sys, "argv", ["gridshell", "lint", *map(str, arguments)])
        with pytest.raises(SystemExit) as info:
            cli.main()
        out, err = capsys.readouterr()
        return info.value.code or 0, out, err

    return run


def test_a_good_sheet_ends_with_nought(command):
    code, out, err = command("good-01.dxf")
    assert (code, out.split("  ")[1].strip(), err) == (0, "no faults", "")


def test_errors_end_with_one_and_are_named(command):
    code, out, _ = command("good-01.dxf", "open.dxf")
    assert code == 1
    assert out.count("error open-path") == 3
    assert "and 1 more like this" in out


def test_a_quiet_run_prints_errors_only(command):
    assert command("good-01.dxf", "--quiet") == (0, "", "")
    assert "open-path" in command("open.dxf", "--quiet")[1]


@pytest.mark.parametrize("name", ["text.dxf", "nowhere.dxf"])
def test_a_file_that_is_no_dxf_ends_with_two(command, name):
    code, out, err = command(name)
    assert (code, out) == (2, "")
    assert name in err


@pytest.mark.parametrize(
    "options",
    [
        ("--process", "axe"),
        ("--thickness", "2"),
        ("--process", "laser", "--thickness", "-1"),
        ("--layer", "CUT"),
        ("--layer", "X=1"),
        ("--layer", "CUT=MARK"),
    ],
)
def test_wrong_usage_ends_with_two(command, options):
    assert command("good-01.dxf", *options)[0] == 2


def test_limits_of_a_process(command):
    assert command("good-01.dxf", "--process", "laser", "--thickness", "2.5")[0] == 0
    code, out, _ = command("good-01.dxf", "--process", "router", "--thickness", "2.5")
    assert code == 1
    assert "narrow-slot" in out


def test_a_shops_layers(command):
    assert command("shop-01.dxf")[0] == 1
    assert command("shop-01.dxf", "--layer", "CUT=0_CUT")[0] == 0


def test_the_report_holds_every_finding(command, tmp_path):
    command("good-01.dxf", "open.dxf", "--report", "r.json")
    good, bad = json.loads((tmp_path / "r.json").read_text("utf-8"))
    assert good == {"file": "good-01.dxf", "findings": []}
    assert [each["code"] for each in bad["findings"]] == ["open-path"] * 4
    assert {each["severity"] for each in bad["findings"]} == {"error"}


def test_a_report_that_cannot_be_written_ends_with_two(command):
    code, _, err = command("good-01.dxf", "--report", "no/such/r.json")
    assert code == 2
    assert "report cannot be written" in err
