"""The command as people run it: exit codes, and what is said where."""

import json
import os
import signal
import subprocess
import sys
import time
import tomllib
from importlib.metadata import version

import pytest

from fabrication import cli

pytestmark = [pytest.mark.xdist_group("kernel"), pytest.mark.usefixtures("kernel_here")]

SMALL = """
name = "small"
[surface]
kind = "hypar"
scale = 6000.0
[patch]
layout = "asymptotic"
p = [-0.2, 0.2]
q = [-0.2, 0.2]
lamellas = [3, 3]
[net]
anchor = "free"
[profile]
width = 100.0
thickness = 2.5
material = "stainless"
[joint]
kind = "slot"
[sheet]
length = 4000.0
width = 1000.0
"""
WEAK = '{ name = "weak", modulus = 2e5, strength = 1.0, density = 7900.0 }'


@pytest.fixture
def write(tmp_path):
    """Write a project and return its path."""

    def build(old="", new=""):
        path = tmp_path / "small.toml"
        path.write_text(SMALL.replace(old, new) if old else SMALL)
        return path

    return build


@pytest.fixture
def command(monkeypatch, capsys):
    """Run the command; its exit code, output and errors."""

    def run(*words):
        monkeypatch.setattr(sys, "argv", ["gridshell", *map(str, words)])
        with pytest.raises(SystemExit) as info:
            cli.main()
        said = capsys.readouterr()
        return info.value.code or 0, said.out, said.err

    return run


def fresh(code, *words, env=None):
    """Run *code* in a new interpreter with *words* as the command's arguments."""
    return subprocess.run(
        [sys.executable, "-c", code, *map(str, words)],
        capture_output=True,
        text=True,
        check=False,
        env=env,
    )


# ---- good -----------------------------------------------------------------------------------


def test_a_good_project_ends_with_0_and_tells_what_was_made(command, write, tmp_path):
    code, out, _ = command("run", write(), "--out", tmp_path / "out")
    assert code == 0
    for said in (
        "small",
        "Converged",
        "6 lamellas",
        "9 joints",
        "15.2 m",
        "on 1 sheet;",
        "node angles",
    ):
        assert said in out
    assert "error" not in out.replace("error:", "")
    assert json.loads((tmp_path / "out" / "report.json").read_text())["findings"] == []


def test_quiet_says_nothing_at_all_even_from_the_kernel(write, tmp_path):
    """In a new interpreter, where the kernel still has its own ways to print."""
    done = fresh(
        "from fabrication.cli import main; main()",
        *["run", write(), "--out", tmp_path / "out", "--quiet"],
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert (tmp_path / "out" / "structure.step").is_file()


def test_check_lists_every_setting_with_its_value(command, write):
    code, out, err = command("check", write())
    assert (code, err) == (0, "")
    assert tomllib.loads(out)["net"]["steps"] == 30
    own, more = out.split("# Sections that it could have, too:")
    assert "# [bars]" in more
    lines = set(own.splitlines())
    bare = {line.split("  # ")[0] for line in lines}
    assert {'name = "small"', "[net]", "[joint]", "clearance = 0.3", "p = [-0.2, 0.2]"} <= bare
    assert all("  # " in line for line in lines if " = " in line and not line.startswith("name"))
    unset = {line.split()[1] for line in lines if line.startswith("#")}
    assert unset == {
        *("angle", "angle_between", "fairness", "mirror", "overhang", "proximity"),
        *("supports", "wall"),
    }


def test_what_check_says_is_a_project_that_says_the_same(command, write, tmp_path):
    _, out, _ = command("check", write('"stainless"', WEAK))
    (tmp_path / "again.toml").write_text(out, encoding="utf-8")
    assert command("check", tmp_path / "again.toml") == (0, out, "")


def test_check_lists_findings_without_writing(command, write, tmp_path):
    path = write('"stainless"', WEAK)
    code, out, _ = command("check", path, "--findings")
    assert code == 1
    assert "# error " in out
    assert list(tmp_path.iterdir()) == [path]


def test_check_says_when_there_are_no_findings(command, write):
    code, out, _ = command("check", write(), "--findings")
    assert code == 0
    assert out.rstrip().endswith("# no findings")


def test_a_quiet_check_says_nothing(command, write):
    assert command("check", write(), "--quiet") == (0, "", "")


def test_check_does_not_write(command, write, tmp_path):
    path = write()
    command("check", path)
    assert list(tmp_path.iterdir()) == [path]


def test_the_version_is_that_of_the_package(command):
    assert command("--version") == (0, f"gridshell {version('gridshell')}\n", "")


def test_help_names_the_commands(command):
    code, out, _ = command("--help")
    assert code == 0
    assert "run" in out
    assert "check" in out


# ---- findings -------------------------------------------------------------------------------


def test_findings_of_severity_error_end_with_1_and_are_told(command, write, tmp_path):
    code, out, _ = command("run", write('"stainless"', WEAK), "--out", tmp_path / "out")
    assert code == 1
    assert out.count("error twist: ") == 1
    assert "And 5 more like this" in out
    assert (tmp_path / "out" / "structure.step").is_file()


def finding(severity, number=0, **changes):
    return {
        "code": "seam",
        "severity": severity,
        "where": "A1",
        "value": 1.0,
        "limit": 1.0,
        "message": f"[A{number}] is closed",
        **changes,
    }


@pytest.fixture
def pretend(monkeypatch):
    """Let a run return a report with given findings, without making anything."""

    def build(*findings, **built):
        report = {
            "name": "[bold]small[/bold]",
            "net": {"status": "Converged.", "node_angle_deg": {"min": 90.0, "max": 90.0}},
            "stress": {"utilisation": {"max": 0.25, "where": "A1 N1-N2"}},
            "stock": {"sheet": {"sheets": 1, "bound": 1, "used": 0.5}},
            "structure": {
                **{"lamellas": 6, "strips": 6, "joints": 9},
                **{"total_length_m": 1.0, "mass_kg": 1.0},
                "sheets": 1,
                **built,
            },
            "closure": {"max_mm": 0.0, "volume_ppm": 0.0},
            "fit": {"clash_mm3": {"max": 0.0}},
            "findings": list(findings),
            "timing": {"fit": 1.0},
        }
        monkeypatch.setattr("fabrication.package.run", lambda *args, **kwargs: report)

    return build


@pytest.mark.parametrize("severity", ["info", "warning"])
def test_findings_that_are_no_errors_end_with_0_and_are_told(command, write, pretend, severity):
    pretend(finding(severity))
    code, out, _ = command("run", write(), "--out", "out")
    assert code == 0
    assert f"{severity} seam: [A0] is closed" in out


def test_a_name_in_brackets_is_printed_as_it_is(command, write, pretend):
    pretend()
    assert "[bold]small[/bold]" in command("run", write(), "--out", "out")[1]


def test_findings_of_one_kind_share_a_line_with_their_count(command, write, pretend):
    pretend(*(finding("warning", number) for number in range(25)), finding("error"))
    _, out, _ = command("run", write(), "--out", "out")
    assert out.count("warning seam") == 1
    assert "And 24 more like this" in out
    assert out.count("error seam") == 1


@pytest.mark.parametrize("values", [[2.0, 9.0, 3.0], [0.5, 0.1, 0.2], [0.5, 0.0, 2.0]])
def test_the_worst_of_a_kind_is_the_one_that_is_told(command, write, pretend, values):
    pretend(*(finding("error", i, value=value) for i, value in enumerate(values)))
    assert "[A1] is closed And 2 more" in command("run", write(), "--out", "out")[1]


def test_quiet_errors_still_end_with_1(command, write, pretend):
    pretend(finding("error"))
    assert command("run", write(), "--out", "out", "--quiet") == (1, "", "")


# ---- mistakes -------------------------------------------------------------------------------

MISTAKES = [
    ("thickness = 2.5", "thickness = -2.5", "profile.thickness"),
    ("thickness = 2.5", "thickness = 50.0", "much wider than thick"),
    ("length = 4000.0", "length = 400.0", "too long for the stock (at A1;"),
    ('kind = "hypar"\nscale', 'kind = "sphere"\nradius', "Gaussian curvature"),
    ("p = [-0.2, 0.2]", "p = [0.2, -0.2]", "smaller first (at small.toml, patch.p;"),
    ("lamellas = [3, 3]", "lamellas = [3000, 3000]", "too many nodes"),
    ("lamellas = [3, 3]", "lamellas = [3, 100000000000000000000]", "patch.lamellas.1"),
    ("scale = 6000.0", "scale = 1e300", "surface.scale"),
    ("scale = 6000.0", "scale = 1e-300", "surface.scale"),
    ('kind = "slot"', 'kind = "slot"\ndepth_clearance = 60.0', "cut the strips through"),
    ("[net]", "[net", "not TOML"),
]


@pytest.mark.parametrize(("old", "new", "said"), MISTAKES, ids=[new for _, new, _ in MISTAKES])
def test_a_mistake_ends_with_2_and_one_message_that_names_it(
    command, write, tmp_path, old, new, said
):
    path = write(old, new)
    code, out, err = command("run", path, "--out", tmp_path / "out")
    assert (code, out) == (2, "")
    assert err.startswith("gridshell: ")
    *stages, message = err.replace(f"{tmp_path}/", "").splitlines()
    assert {line.split(": ")[0] for line in stages} <= {"gridshell"}
    assert said in message
    assert "Traceback" not in err
    assert list(tmp_path.iterdir()) == [path]


def test_a_missing_project_ends_with_2(command, tmp_path):
    code, _, err = command("run", tmp_path / "none.toml", "--out", tmp_path / "out")
    assert code == 2
    assert "none.toml" in err


def test_an_output_that_is_a_file_ends_with_2(command, write, tmp_path):
    (tmp_path / "out").write_text("mine")
    code, _, err = command("run", write(), "--out", tmp_path / "out")
    assert code == 2
    assert "is a file" in err


@pytest.mark.parametrize("words", [["run", "small.toml"], ["rum"], ["check"], ["run", "--outt"]])
def test_wrong_usage_ends_with_2_on_stderr(command, words):
    code, out, err = command(*words)
    assert (code, out) == (2, "")
    assert "gridshell" in err
    assert "Traceback" not in err


@pytest.mark.parametrize("name", ["", " "])
def test_an_output_without_a_name_is_refused(command, write, name):
    code, out, err = command("run", write(), "--out", name)
    assert (code, out) == (2, "")
    assert "--out" in err
    assert "empty" in err


# ---- faults of the program ------------------------------------------------------------------


@pytest.fixture
def broken(monkeypatch, command, write):
    """Let a run end with an error."""

    def build(error, *words):
        def fail(*args, **kwargs):
            raise error

        monkeypatch.setattr("fabrication.package.run", fail)
        monkeypatch.setenv("GRIDSHELL_DEBUG", "")
        return command("run", write(), "--out", "out", "--quiet", *words)

    return build


def test_a_fault_of_the_program_is_told_in_one_line_and_ends_with_70(broken):
    code, out, err = broken(ZeroDivisionError("float\ndivision"))
    assert (code, out, err.count("\n")) == (70, "", 1)
    for said in (
        "fault of the program",
        "(ZeroDivisionError: float division)",
        "--debug",
        "report",
    ):
        assert said in err


def test_debug_shows_where_a_fault_happened(broken):
    with pytest.raises(ZeroDivisionError):
        broken(ZeroDivisionError("where"), "--debug")


def test_a_setting_of_the_shell_shows_where_a_fault_happened(write):
    code = (
        "import fabrication.package as package; package.run = None\n"
        "from fabrication.cli import main; main()"
    )
    words = ["run", write(), "--out", "out", "--quiet"]
    for value, shown in (("1", True), ("0", False)):
        done = fresh(code, *words, env={**os.environ, "GRIDSHELL_DEBUG": value})
        assert ("Traceback" in done.stderr) == shown


def test_a_net_too_large_for_the_memory_ends_with_2(broken):
    code, _, err = broken(MemoryError())
    assert code == 2
    assert "too large for the memory" in err


def test_a_full_disk_is_no_fault_of_the_program(broken):
    code, _, err = broken(OSError(28, "No space left on device"))
    assert code == 2
    assert "No space left on device" in err


# ---- progress and figures -------------------------------------------------------------------


@pytest.mark.parametrize(("words", "lines"), [([], 2), (["--quiet"], 0)])
def test_stages_are_lines_where_there_is_no_terminal(
    command, write, pretend, monkeypatch, words, lines
):
    pretend()
    from fabrication import package

    report = package.run()

    def run(*args, announce, **kwargs):
        announce("optimise")
        announce("fit")
        return report

    monkeypatch.setattr(package, "run", run)
    err = command("run", write(), "--out", "out", *words)[2]
    assert err.splitlines() == ["gridshell: optimise", "gridshell: fit"][:lines]


@pytest.mark.parametrize(
    ("kilograms", "said"), [(62.41, "62.4 kg"), (1.0, "1.0 kg"), (0.00597, "5.97 g")]
)
def test_small_masses_are_told_in_grams(command, write, pretend, kilograms, said):
    pretend(mass_kg=kilograms, joints=1)
    out = command("run", write(), "--out", "out")[1]
    assert f", {said} on 1 sheet;" in out
    assert " 1 joint," in out


def test_short_lengths_are_told_in_mm(command, write, pretend):
    pretend(total_length_m=0.62)
    assert ", 620 mm, " in command("run", write(), "--out", "out")[1]


# ---- interrupted ----------------------------------------------------------------------------


@pytest.fixture
def interrupted(command, write, tmp_path, monkeypatch):
    """A run stopped by Ctrl-C while the fit is tried."""

    def stop(*args):
        raise KeyboardInterrupt

    monkeypatch.setattr("fabrication.lamella_system.fit", stop)
    path = write()
    return path, command("run", path, "--out", tmp_path / "out")


def test_an_interrupted_run_leaves_nothing(interrupted, tmp_path):
    path, (code, _, _) = interrupted
    assert code == 130
    assert list(tmp_path.iterdir()) == [path]


def test_an_interrupted_run_says_so(interrupted):
    _, (_, out, err) = interrupted
    assert out == ""
    assert "Interrupted. Nothing was written." in err


def test_ctrl_c_is_told_by_commands_that_write_nothing_first(command, tmp_path, monkeypatch):
    def stop(*args, **more):
        raise KeyboardInterrupt

    monkeypatch.setattr("fabrication.gallery.build", stop)
    code, out, err = command("gallery", "-o", tmp_path / "g")
    assert (code, out, err) == (130, "", "gridshell: Interrupted.\n")
    assert list(tmp_path.iterdir()) == []


def test_ctrl_c_while_a_library_is_loaded_is_no_fault_of_the_program(
    command, write, tmp_path, monkeypatch
):
    """A compiled module that is interrupted raises an ImportError of its own."""

    def stop(*args, **more):
        try:
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(5.0)
        except KeyboardInterrupt:
            raise ImportError("initialization failed") from None

    monkeypatch.setattr("fabrication.lamella_system.fit", stop)
    path = write()
    code, _, err = command("run", path, "--out", tmp_path / "out", "--quiet")
    assert (code, err) == (130, "gridshell: Interrupted.\n")
    assert list(tmp_path.iterdir()) == [path]


TERMINATED = """
import os, signal
import fabrication.lamella_system as route
fit = route.fit
def stop(*args):
    os.kill(os.getpid(), signal.SIGTERM)
    return fit(*args)
route.fit = stop
from fabrication.cli import main
main()
"""


def test_a_terminated_run_leaves_nothing_and_ends_with_143(write, tmp_path):
    path = write()
    done = fresh(TERMINATED, "run", path, "--out", tmp_path / "jobs" / "out", "--quiet")
    assert (done.returncode, done.stdout) == (143, "")
    assert done.stderr == "gridshell: Terminated. Nothing was written.\n"
    assert list(tmp_path.iterdir()) == [path]


def test_what_sigterm_does_is_as_before_after_a_run(command, write, pretend):
    pretend()
    before = signal.getsignal(signal.SIGTERM)
    command("run", write(), "--out", "out")
    assert signal.getsignal(signal.SIGTERM) is before


# ---- what is loaded -------------------------------------------------------------------------

LOADED = """
import sys
from fabrication.cli import main
try:
    main()
except SystemExit as stopped:
    assert not stopped.code, stopped.code
heavy = {"OCP", "cadquery", "build123d", "scipy", "ezdxf"} & set(sys.modules)
print("loaded:", sorted(heavy))
"""


@pytest.mark.parametrize("words", [["--help"], ["run", "--help"], ["--version"]])
def test_asking_for_help_loads_nothing_heavy(words):
    assert fresh(LOADED, *words).stdout.splitlines()[-1] == "loaded: []"


def test_checking_a_project_loads_nothing_heavy(write):
    done = fresh(LOADED, "check", write())
    assert done.stdout.splitlines()[-1] == "loaded: []", done.stderr
