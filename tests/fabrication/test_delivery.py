from pathlib import Path

import pytest

from fabrication.delivery import draft_folder, move_in
from fabrication.errors import OutputError

OURS = ("net.json", "report.json", "sheets/sheet-01.dxf", "sheets/sheet-02.dxf", "structure.step")
STALE = ("sheets/sheet-*.dxf",)


def fill(folder, names, text):
    for name in names:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)


def tree(folder):
    """Everything below *folder*: what files say, None for folders."""
    return {
        path.relative_to(folder).as_posix(): path.read_text() if path.is_file() else None
        for path in folder.rglob("*")
    }


def deliver(out, names=OURS):
    with draft_folder(out) as draft:
        fill(draft, names, "new")
        move_in(draft, out, stale=STALE)


# ---- what is moved in -----------------------------------------------------------------------


def test_a_new_folder_holds_what_was_drafted(tmp_path):
    deliver(tmp_path / "out")
    assert tree(tmp_path / "out") == {"sheets": None, **dict.fromkeys(OURS, "new")}


def test_folders_above_are_made(tmp_path):
    deliver(tmp_path / "jobs" / "roof" / "out")
    assert (tmp_path / "jobs/roof/out/net.json").read_text() == "new"


def test_files_of_an_earlier_run_are_replaced(tmp_path):
    fill(tmp_path / "out", OURS, "old")
    deliver(tmp_path / "out")
    assert "old" not in tree(tmp_path / "out").values()


def test_sheets_this_run_did_not_make_go(tmp_path):
    fill(tmp_path / "out", ["sheets/sheet-01.dxf", "sheets/sheet-07.dxf"], "old")
    deliver(tmp_path / "out")
    assert not (tmp_path / "out/sheets/sheet-07.dxf").exists()


@pytest.mark.parametrize("name", ["order.txt", "sheets/offcuts.txt", "sheets/cut/sheet-01.nc"])
def test_what_is_not_ours_stays(tmp_path, name):
    fill(tmp_path / "out", [name], "mine")
    deliver(tmp_path / "out")
    assert (tmp_path / "out" / name).read_text() == "mine"


def test_nothing_is_left_beside_the_folder(tmp_path):
    fill(tmp_path / "out", OURS, "old")
    deliver(tmp_path / "out")
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_the_folder_the_command_is_run_in_can_be_the_target(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    deliver(Path())
    assert tree(tmp_path) == {"sheets": None, **dict.fromkeys(OURS, "new")}


# ---- what is left of a failure --------------------------------------------------------------


def fail(out, error):
    with draft_folder(out) as draft:
        fill(draft, OURS, "new")
        raise error


@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt])
@pytest.mark.parametrize("target", ["out", "jobs/roof/out"])
def test_a_run_that_fails_leaves_nothing(tmp_path, error, target):
    with pytest.raises(error):
        fail(tmp_path / target, error())
    assert tree(tmp_path) == {}


def test_a_run_that_fails_keeps_the_folder_it_found(tmp_path):
    fill(tmp_path / "out", [*OURS, "order.txt"], "old")
    before = tree(tmp_path)
    with pytest.raises(ValueError, match="failed"):
        fail(tmp_path / "out", ValueError("failed"))
    assert tree(tmp_path) == before


def test_an_empty_folder_above_that_was_there_stays(tmp_path):
    (tmp_path / "jobs").mkdir()
    with pytest.raises(ValueError, match="failed"):
        fail(tmp_path / "jobs/roof/out", ValueError("failed"))
    assert tree(tmp_path) == {"jobs": None}


@pytest.fixture
def renames(monkeypatch):
    """Let the n-th file that is renamed be refused."""

    def refuse(n, error):
        replace, calls = Path.replace, []

        def counted(self, target):
            calls.append(target)
            if len(calls) == n:
                raise error
            return replace(self, target)

        monkeypatch.setattr(Path, "replace", counted)

    return refuse


DENIED = PermissionError(13, "Permission denied")


@pytest.mark.parametrize("n", [1, 3, 6, 9])
def test_a_file_that_cannot_be_moved_leaves_the_earlier_run_as_it_was(tmp_path, renames, n):
    fill(tmp_path / "out", [*OURS, "sheets/sheet-07.dxf", "order.txt"], "old")
    before = tree(tmp_path)
    renames(n, DENIED)
    with pytest.raises(OutputError, match="Permission denied"):
        deliver(tmp_path / "out")
    assert tree(tmp_path) == before


def test_a_file_that_cannot_be_moved_leaves_no_new_folder(tmp_path, renames):
    renames(5, DENIED)
    with pytest.raises(OutputError):
        deliver(tmp_path / "jobs" / "out")
    assert tree(tmp_path) == {}


def test_a_file_that_cannot_be_moved_leaves_no_empty_folder_for_sheets(tmp_path, renames):
    fill(tmp_path / "out", ["order.txt"], "mine")
    before = tree(tmp_path)
    renames(5, DENIED)
    with pytest.raises(OutputError):
        deliver(tmp_path / "out")
    assert tree(tmp_path) == before


@pytest.mark.parametrize("n", [2, 7])
def test_an_interrupt_while_moving_leaves_the_earlier_run_as_it_was(tmp_path, renames, n):
    fill(tmp_path / "out", OURS, "old")
    before = tree(tmp_path)
    renames(n, KeyboardInterrupt())
    with pytest.raises(KeyboardInterrupt):
        deliver(tmp_path / "out")
    assert tree(tmp_path) == before


def test_a_file_where_a_folder_must_be_is_an_error_and_stays(tmp_path):
    fill(tmp_path / "out", ["net.json", "sheets"], "mine")
    before = tree(tmp_path)
    with pytest.raises(OutputError, match="a file is where a folder must be") as info:
        deliver(tmp_path / "out")
    assert info.value.where == str(tmp_path / "out" / "sheets")
    assert tree(tmp_path) == before


@pytest.mark.parametrize("name", ["structure.step", "sheets/sheet-02.dxf"])
@pytest.mark.parametrize("content", [[], ["notes.txt"]])
def test_a_folder_where_a_file_must_be_is_an_error_and_stays(tmp_path, name, content):
    (tmp_path / "out" / name).mkdir(parents=True)
    fill(tmp_path / "out" / name, content, "mine")
    before = tree(tmp_path)
    with pytest.raises(OutputError, match="a folder is where a file must be") as info:
        deliver(tmp_path / "out")
    assert info.value.where == str(tmp_path / "out" / name)
    assert tree(tmp_path) == before


def test_a_folder_named_like_an_old_sheet_stays(tmp_path):
    fill(tmp_path / "out", ["sheets/sheet-07.dxf/notes.txt"], "mine")
    deliver(tmp_path / "out")
    assert (tmp_path / "out/sheets/sheet-07.dxf/notes.txt").read_text() == "mine"


# ---- what is refused before any work --------------------------------------------------------


def test_a_file_is_no_folder(tmp_path):
    (tmp_path / "out").write_text("mine")
    with pytest.raises(OutputError, match="is a file") as info, draft_folder(tmp_path / "out"):
        pytest.fail("nothing may be drafted")
    assert info.value.where == str(tmp_path / "out")
    assert tree(tmp_path) == {"out": "mine"}


@pytest.mark.parametrize(
    ("there", "named"), [("sheets", "sheets"), ("structure.step/notes.txt", "structure.step")]
)
def test_places_of_known_files_are_looked_at_before_any_work(tmp_path, there, named):
    fill(tmp_path / "out", [there], "mine")
    with (
        pytest.raises(OutputError, match="cannot be written") as info,
        draft_folder(tmp_path / "out", names=OURS),
    ):
        pytest.fail("nothing may be drafted")
    assert info.value.where == str(tmp_path / "out" / named)


def test_a_folder_below_a_file_cannot_be_made(tmp_path):
    (tmp_path / "jobs").write_text("mine")
    with (
        pytest.raises(OutputError, match="cannot be written"),
        draft_folder(tmp_path / "jobs" / "out"),
    ):
        pytest.fail("nothing may be drafted")
    assert tree(tmp_path) == {"jobs": "mine"}


@pytest.mark.parametrize("already", [False, True])
def test_a_folder_that_may_not_be_written_is_refused_and_nothing_stays(
    tmp_path, monkeypatch, already
):
    def refuse(*args, **kwargs):
        raise DENIED

    if already:
        fill(tmp_path / "jobs/out", ["order.txt"], "mine")
    before = tree(tmp_path)
    monkeypatch.setattr("tempfile.mkdtemp", refuse)
    with (
        pytest.raises(OutputError, match="Permission denied"),
        draft_folder(tmp_path / "jobs/out"),
    ):
        pytest.fail("nothing may be drafted")
    assert tree(tmp_path) == before
