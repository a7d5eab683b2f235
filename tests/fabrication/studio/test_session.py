"""A session without a browser: solves, undo, the file on disk, what goes wrong."""

import asyncio
import json
from contextlib import asynccontextmanager, suppress

import numpy as np
import pytest

import gridshell as gs
from fabrication.errors import OutputError
from fabrication.package import run
from fabrication.project import read_project
from fabrication.studio import session as module
from fabrication.studio.readings import built_readings, net_readings
from fabrication.studio.session import Change, Session


@asynccontextmanager
async def working(path):
    session = Session(path)
    task = asyncio.create_task(session.work())
    try:
        await until(lambda: session.up_to_date)
        yield session
    finally:
        task.cancel()
        with suppress(asyncio.CancelledError):
            await task


async def until(true, seconds=30.0):
    async with asyncio.timeout(seconds):
        while not true():
            await asyncio.sleep(0.01)


def test_a_slider_finds_the_net_that_run_finds(path, tmp_path):
    async def turn():
        async with working(path) as session:
            for angle in (71.0, 66.0, 62.0):
                session.change("net.angle", angle, done=False)
                await asyncio.sleep(0.02)
            session.change("net.angle", 62.0, done=True)
            await until(lambda: session.up_to_date)
            session.save()
            return session

    session = asyncio.run(turn())
    report = run(read_project(path), tmp_path / "out")
    alone = gs.read_net(tmp_path / "out" / "net.json")
    np.testing.assert_allclose(session.net.result.control.vertices, alone.vertices, atol=1e-9)
    told = {reading.key: reading.value for reading in net_readings(session.net)}
    low, high = (report["net"]["node_angle_deg"][end] for end in ("min", "max"))
    assert told["node_angle_deg"] == f"{low:.2f} to {high:.2f}°"
    built = {reading.key: reading.value for reading in built_readings(session.built)}
    assert built["lamellas"] == str(report["structure"]["lamellas"])
    assert built["total_length_m"] == f"{report['structure']['total_length_m']:.1f} m"


def test_only_the_end_of_a_drag_is_remembered(path):
    async def turn():
        async with working(path) as session:
            for angle in (71.0, 72.0, 73.0):
                session.change("net.angle", angle, done=False)
            session.change("net.angle", 73.0, done=True)
            session.change("profile.width", 90.0, done=True)
            assert len(session.history.past) == 2
            session.undo()
            assert session.present.value("profile.width") == 80.0
            session.undo()
            assert session.present.value("net.angle") == 70.0
            session.redo()
            await until(lambda: session.up_to_date)
            assert np.degrees(gs.node_angles(session.net.result.control)).max() == pytest.approx(73)

    asyncio.run(turn())


def test_a_solve_that_fails_says_why_and_leaves_the_net_before(path):
    async def turn():
        async with working(path) as session:
            before = session.net
            session.change("net.steps", 1, done=True)
            await until(lambda: session.trouble)
            assert "Not converged" in session.trouble or "step" in session.trouble
            assert session.net is before
            assert session.busy is None
            assert not session.up_to_date
            session.undo()
            assert session.trouble == ""
            await until(lambda: session.up_to_date)

    asyncio.run(turn())


def test_a_value_out_of_its_limits_changes_nothing(path):
    async def turn():
        async with working(path) as session:
            session.change("net.angle", 190.0, done=True)
            assert "net.angle" in session.trouble
            assert session.present.value("net.angle") == 70.0
            assert session.up_to_date

    asyncio.run(turn())


def test_a_slider_that_is_let_go_at_a_refused_place_stays_at_the_last_good_one(path):
    async def turn():
        async with working(path) as session:
            session.change("net.angle", 65.0, done=False)
            session.change("net.angle", 190.0, done=False)
            assert session.trouble == ""  # the hand may go on
            session.change("net.angle", 190.0, done=True)
            assert "net.angle" in session.trouble
            assert session.present is session.history.present
            assert session.present.value("net.angle") == 65.0
            session.save()
            assert read_project(path).net.angle == 65.0
            await until(lambda: session.up_to_date)

    asyncio.run(turn())


def test_a_package_with_errors_is_no_good_news(path, text):
    path.write_text(text.replace("thickness = 2.0", "thickness = 9.0"))

    async def turn():
        async with working(path) as session:
            assert await session.write_package("package")
            assert not session.note.good
            assert "of severity error" in session.note.text

    asyncio.run(turn())


def test_what_was_wrong_with_a_file_is_forgotten_when_it_is_mended(path, monkeypatch, text):
    monkeypatch.setattr(module, "_LOOK", 0.05)

    async def turn():
        async with working(path) as session:
            path.write_text("name = ")
            await until(lambda: session.differs_on_disk)
            session.load()
            assert "not TOML" in session.trouble
            path.write_text(text)
            await until(lambda: not session.differs_on_disk)
            assert session.trouble == ""

    asyncio.run(turn())


def test_keeping_mine_and_good_news_take_old_troubles_away(path, text):
    async def turn():
        async with working(path) as session:
            path.write_text(text.replace("70.0", "71.0"))
            session.save()
            assert "another program" in session.trouble
            session.keep()
            assert session.trouble == ""
            session.save("other")
            assert session.note.text == "Saved a copy as other.toml."
            session.change("net.angle", 500.0, done=True)
            assert session.note is None

    asyncio.run(turn())


def test_a_fault_of_the_program_does_not_end_the_session(path, monkeypatch):
    async def turn():
        async with working(path) as session:
            with monkeypatch.context() as broken:
                broken.setattr(module, "find_net", lambda *a, **k: 1 / 0)
                session.change("net.angle", 65.0, done=True)
                await until(lambda: session.trouble)
                assert "fault of the program" in session.trouble
            session.change("net.angle", 66.0, done=True)
            await until(lambda: session.up_to_date)

    asyncio.run(turn())


def test_what_another_program_wrote_is_noticed_loaded_and_undone(path, monkeypatch, text):
    monkeypatch.setattr(module, "_LOOK", 0.05)

    async def turn():
        async with working(path) as session:
            told = []
            session.listen(told.append)
            path.write_text(text.replace("70.0", "64.0"))
            await until(lambda: session.differs_on_disk)
            assert Change.DISK in told
            session.change("net.angle", 75.0, done=True)
            session.save()
            assert "another program" in session.trouble
            assert "64.0" in path.read_text()
            session.load()
            assert session.present.value("net.angle") == 64.0
            assert not session.differs_on_disk
            session.undo()
            assert session.present.value("net.angle") == 75.0

    asyncio.run(turn())


def test_one_may_keep_what_is_shown(path, monkeypatch, text):
    monkeypatch.setattr(module, "_LOOK", 0.05)

    async def turn():
        async with working(path) as session:
            session.change("net.angle", 75.0, done=True)
            path.write_text(text.replace("width = 80.0", "width = 85.0"))
            await until(lambda: session.differs_on_disk)
            session.keep()
            session.save()
            assert session.trouble == ""
            document = read_project(path)
            assert (document.net.angle, document.profile.width) == (75.0, 80.0)

    asyncio.run(turn())


def test_what_another_program_removed_can_be_saved_again(path):
    async def turn():
        async with working(path) as session:
            path.unlink()
            session.save()
            assert "another program" in session.trouble
            session.keep()
            session.save()
            assert session.trouble == ""
            assert not session.saved.changed

    asyncio.run(turn())
    assert read_project(path).net.angle == 70.0


def test_keeping_mine_leaves_nothing_of_theirs(path, text):
    async def turn():
        async with working(path) as session:
            path.write_text(text.replace("width = 80.0", "width = 80.0\noverhang = 60.0"))
            session.keep()
            session.save()

    asyncio.run(turn())
    assert read_project(path).profile.overhang is None


def test_a_broken_file_on_disk_is_told_and_loses_nothing(path):
    async def turn():
        async with working(path) as session:
            path.write_text("name = ")
            session.load()
            assert "not TOML" in session.trouble
            assert session.present.value("net.angle") == 70.0

    asyncio.run(turn())


def test_two_sessions_on_one_project_do_not_overwrite_each_other(path):
    async def turn():
        async with working(path) as one, working(path) as other:
            one.change("net.angle", 61.0, done=True)
            one.save()
            other.change("net.angle", 62.0, done=True)
            other.save()
            assert "another program" in other.trouble
            assert read_project(path).net.angle == 61.0

    asyncio.run(turn())


def test_a_project_that_names_files_elsewhere_is_refused(path, text):
    text = text.replace(text[text.index("[surface]") : text.index("[net]")], "")
    text += '\n[mesh]\nfile = "../net.obj"\nunit = "mm"\nlamellas_along = "edges"\n'
    path.write_text(text)
    with pytest.raises(gs.SettingError, match=r"mesh\.file = '\.\./net\.obj'"):
        Session(path)


def test_the_package_is_what_run_writes(path, tmp_path, text):
    async def turn():
        async with working(path) as session:
            session.change("net.angle", 62.0, done=True)
            assert await session.write_package("package")
            assert "package/" in session.note.text
            assert session.note.good
            await until(lambda: session.up_to_date)

    asyncio.run(turn())
    written = json.loads((path.parent / "package" / "report.json").read_text())
    assert written["net"]["node_angle_deg"]["max"] == pytest.approx(62.0)
    assert (path.parent / "package" / "structure.step").exists()
    assert path.read_text() == text


@pytest.mark.parametrize("name", ["", "..", "../out", "/out", "a/b", ".hidden"])
def test_a_package_stays_in_the_folder(path, name):
    async def turn():
        async with working(path) as session:
            assert not await session.write_package(name)
            assert "beside the project" in session.trouble

    asyncio.run(turn())


def test_a_package_that_fails_leaves_nothing(path, monkeypatch):
    def failing(*args, **kwargs):
        raise OutputError("The disk is full", where="package")

    monkeypatch.setattr(module, "run", failing)

    async def turn():
        async with working(path) as session:
            assert not await session.write_package("package")
            assert "disk is full" in session.trouble
            assert session.busy is None

    asyncio.run(turn())
    assert not (path.parent / "package").exists()


def test_what_was_not_saved_is_kept_as_a_copy(path):
    async def turn():
        async with working(path) as session:
            assert session.rescue() == ""
            session.change("net.angle", 62.0, done=True)
            assert session.rescue() == "pavilion-unsaved.toml"
            assert session.rescue() == "pavilion-unsaved-2.toml"

    asyncio.run(turn())
    assert read_project(path.parent / "pavilion-unsaved-2.toml").net.angle == 62.0
    assert read_project(path).net.angle == 70.0
