import os
import pickle
import subprocess
import sys

import pytest

import fabrication as fab
import gridshell as gs
from fabrication import kernel_job as module
from fabrication.cut import Edge, Slot
from fabrication.errors import KernelError, OutputError, ProjectError, StockError
from fabrication.kernel_job import LamellaWork, kernel

pytestmark = pytest.mark.xdist_group("kernel")


@pytest.fixture
def here(monkeypatch, stand_in):
    """No process of its own: its work is done in this one."""
    monkeypatch.setattr(module, "subprocess", stand_in)


def make(design, step, parts=None):
    with kernel() as cad:
        parts = design.parts if parts is None else parts
        cad.order(LamellaWork(design.structure, parts, "shell"), step)
        return cad.result()


def test_a_process_of_its_own_writes_the_solids_and_brings_back_what_the_file_says(pair, tmp_path):
    step = tmp_path / "structure.step"
    result = make(pair, step)
    assert [part.mark for part in result.parts] == [one.mark for one in pair.structure.lamellas]
    for found, read in zip(result.parts, fab.read_step(step), strict=True):
        assert found.loop.tolist() == read.loop.tolist()
        assert found.volume() == read.volume()
    assert len(result.seconds) > 1
    assert min(result.seconds.values()) >= 0.0


# ---- what goes wrong in there ---------------------------------------------------------------


def test_a_solid_that_is_refused_is_told_in_the_same_words(pair, with_slots, tmp_path, here):
    slots = [Slot(at, 3.0, 50.0, Edge.UPPER, "N1", "B1") for at in (500.0, 501.0)]
    parts = (with_slots(pair.parts[0], slots), *pair.parts[1:])
    with pytest.raises(KernelError) as expected:
        fab.solids(pair.structure, parts)
    with pytest.raises(KernelError) as info:
        make(pair, tmp_path / "structure.step", parts)
    assert str(info.value) == str(expected.value)
    assert info.value.where == "A1"


def test_a_file_that_cannot_be_written_is_an_output_error(pair, tmp_path, here):
    step = tmp_path / "missing" / "structure.step"
    with pytest.raises(OutputError, match="cannot be written") as info:
        make(pair, step)
    assert info.value.where == str(step)


@pytest.mark.parametrize(
    "kind", [KernelError, OutputError, StockError, ProjectError, gs.FileError, gs.SolveError]
)
def test_errors_are_the_same_on_the_other_side(kind):
    error = kind("It broke", where="A1", value="3 mm", limit="2 mm", advice="a hammer")
    other = pickle.loads(pickle.dumps(error))
    assert type(other) is kind
    assert str(other) == str(error)
    assert vars(other) == vars(error)


@pytest.fixture
def program(tmp_path, monkeypatch):
    """Start a shell script in the place of Python."""

    def build(text):
        path = tmp_path / "python"
        path.write_text(f"#!/bin/sh\n{text}\n")
        path.chmod(0o755)
        monkeypatch.setattr(sys, "executable", str(path))

    return build


def test_a_process_that_crashes_is_told_with_its_last_words(pair, program, tmp_path):
    program("echo first >&2; echo last >&2; exit 3")
    with pytest.raises(KernelError) as info:
        make(pair, tmp_path / "x.step")
    assert info.value.what == "The CAD kernel stopped without an answer"
    assert info.value.value == "exit code 3 last"


def test_a_process_that_says_much_does_not_stand_still(pair, program, tmp_path):
    program("head -c 300000 /dev/zero | tr '\\0' 'x' >&2; exit 1")
    with pytest.raises(KernelError, match="exit code 1"):
        make(pair, tmp_path / "x.step")


def test_a_process_that_is_gone_before_its_order_is_told_with_its_last_words(
    pair, program, tmp_path
):
    program("echo gone >&2; exit 3")
    with kernel() as cad:
        cad._process.wait()
        cad.order(LamellaWork(pair.structure, pair.parts, "shell"), tmp_path / "x.step")
        with pytest.raises(KernelError, match="exit code 3 gone"):
            cad.result()


def test_a_kernel_that_gets_no_order_does_nothing(tmp_path):
    assert module._work(tmp_path / "order", lambda: "") is None


def test_a_kernel_that_cannot_be_loaded_is_told_before_any_order(monkeypatch, tmp_path):
    missing = KernelError("The CAD kernel cannot be loaded")

    class Broken:
        def find_spec(self, name, *_):
            if name == "fabrication.solid":
                raise missing

    monkeypatch.delitem(sys.modules, "fabrication.solid")
    monkeypatch.setattr(sys, "meta_path", [Broken(), *sys.meta_path])
    assert module._work(tmp_path / "order", lambda: pytest.fail("it waits")) is missing


def test_leaving_early_ends_the_process(program, monkeypatch):
    program("exec sleep 600")
    started = []

    class Noted(subprocess.Popen):
        def __init__(self, *args, **kwargs):
            super().__init__(*args, **kwargs)
            started.append(self)

    monkeypatch.setattr(module.subprocess, "Popen", Noted)
    with pytest.raises(KeyboardInterrupt), kernel():
        raise KeyboardInterrupt
    (process,) = started
    assert process.returncode is not None
    with pytest.raises(ProcessLookupError):
        os.kill(process.pid, 0)


def test_nothing_but_the_assembly_is_left(pair, tmp_path, monkeypatch, here):
    (tmp_path / "temporary").mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "temporary"))
    make(pair, tmp_path / "structure.step")
    assert list((tmp_path / "temporary").iterdir()) == []
    assert (tmp_path / "structure.step").is_file()
