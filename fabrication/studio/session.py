"""One project in the studio, whoever looks: its versions, its net, what is built, what went wrong.

Everything here happens on one event loop; solves and builds run in threads and come back to it. Of
several changes the last one counts: a solve that is no longer wanted ends at its next step. A solve
or a build that fails leaves what was there before, and says why.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Coroutine
from contextlib import suppress
from dataclasses import dataclass, replace
from enum import Enum
from functools import partial
from pathlib import Path
from typing import Any, Final

from fabrication.errors import OutputError
from fabrication.package import run
from fabrication.studio.design import Built, NetDesign, Residual, Starts, build, find_net
from fabrication.studio.disk import Saved, outside, read, write, write_copy
from fabrication.studio.knobs import Knob, knobs
from fabrication.studio.versions import History, Version
from fabrication.words import plural
from gridshell import GridshellError, SettingError

_TELL = 0.25
"""Seconds between two words on a solve that goes on."""

_LOOK = 1.0
"""Seconds between two looks at the project's file."""


class Change(Enum):
    """What is new, for those who show it."""

    STATUS = "status"
    STEP = "step"
    NET = "net"
    BUILT = "built"
    PROJECT = "project"
    DISK = "disk"


class _NotWantedError(Exception):
    """Another version is asked for meanwhile."""


@dataclass(frozen=True)
class Busy:
    """What is being done; *share* of it, 0 to 1, where that is known."""

    text: str
    share: float | None = None


@dataclass(frozen=True)
class Note:
    """What was done; not *good* where it needs a second look."""

    text: str
    good: bool = True


class Session:
    """A project that is looked at and changed.

    Parameters
    ----------
    path : of the project file; everything the project names must lie in its folder.

    Raises
    ------
    ProjectError, SettingError
        When the file cannot be used, or names files outside its folder.
    """

    def __init__(self, path: Path) -> None:
        self.saved: Saved = read(path)
        self.folder: Final = path.resolve().parent
        self.history = History(self._version(self.saved))
        self.net: NetDesign | None = None
        self.built: Built | None = None
        self.busy: Busy | None = None
        self.trouble = ""
        self.note: Note | None = None
        self.residuals: list[Residual] = []
        self.differs_on_disk = False
        self._unread: str | None = None
        self._shown = self.history.present
        self._wanted: Version | None = None
        self._asked: Version | None = None
        self._awake = asyncio.Event()
        self._starts = Starts()
        self._listeners: list[Callable[[Change], None]] = []
        self._tasks: set[asyncio.Task[None]] = set()
        self._packing = False

    # ---- who listens ------------------------------------------------------------------------

    def listen(self, listener: Callable[[Change], None]) -> Callable[[], None]:
        """Call *listener* on every change; what is returned ends that."""
        self._listeners.append(listener)
        return partial(self._forget, listener)

    def _forget(self, listener: Callable[[Change], None]) -> None:
        with suppress(ValueError):
            self._listeners.remove(listener)

    def _tell(self, change: Change) -> None:
        for listener in list(self._listeners):
            listener(change)

    # ---- what there is ----------------------------------------------------------------------

    @property
    def present(self) -> Version:
        """The version that is shown, while a slider moves, too."""
        return self._shown

    @property
    def knobs(self) -> list[Knob]:
        """The sliders."""
        return knobs(self._shown.project)

    @property
    def up_to_date(self) -> bool:
        """Whether the net and what is built are those of the present version."""
        project = self._shown.project
        return (
            self.net is not None
            and self.built is not None
            and self.net.project is project
            and self.built.net is self.net
        )

    @property
    def unsaved(self) -> bool:
        """Whether the file does not hold the present version."""
        return dict(self.history.present.document) != self.saved.document

    # ---- changes ----------------------------------------------------------------------------

    def change(self, key: str, value: Any, *, done: bool) -> None:
        """Set *key*; while a slider is not *done*, nothing is remembered for undo.

        A value that cannot be is told when the hand lets go of it: what is shown then stays.
        """
        try:
            version = self._shown.with_value(key, value, self.saved.path)
        except GridshellError as error:
            if done:
                self._remember(self._shown)
                self._tell(Change.PROJECT)
                self._fail(error)
            return
        if dict(version.document) == dict(self._shown.document):
            version = self._shown  # its net is there, or on its way
        if done:
            self._remember(version)
        if version is not self._shown or done:
            self._show(version)

    def _remember(self, version: Version) -> None:
        if dict(version.document) != dict(self.history.present.document):
            self.history = self.history.to(version)

    def undo(self) -> None:
        """Back to the version before."""
        self.history = self.history.undone()
        self._show(self.history.present)
        self._tell(Change.PROJECT)

    def redo(self) -> None:
        """On to the version that was undone."""
        self.history = self.history.redone()
        self._show(self.history.present)
        self._tell(Change.PROJECT)

    def _show(self, version: Version) -> None:
        asked, self._shown = self._shown, version
        self.trouble, self.note = "", None
        if self._asked is not version or asked is not version:
            self._asked = self._wanted = version
            self._awake.set()
        self._tell(Change.STATUS)

    def _fail(self, error: GridshellError) -> None:
        self.trouble, self.note = str(error), None
        self._tell(Change.STATUS)

    def _version(self, saved: Saved) -> Version:
        document = saved.document
        found = outside(document, self.folder)
        if found is not None:
            raise SettingError(
                "The studio opens no file outside the project's folder",
                where=f"{saved.path}, {found}",
                advice="copy the file beside the project",
            )
        return Version.of(document, saved.path)

    # ---- the file ---------------------------------------------------------------------------

    def load(self) -> None:
        """Take what the file says now as a new version; undo brings back what was there."""
        try:
            saved = read(self.saved.path)
            version = self._version(saved)
        except GridshellError as error:
            self._unread = self.saved.now()
            self._fail(error)
            return
        self.saved, self.differs_on_disk = saved, False
        self._remember(version)
        self._show(self.history.present)
        self._tell(Change.PROJECT)
        self._tell(Change.DISK)

    def keep(self) -> None:
        """Go on with what is shown, and save over what another program wrote."""
        self.saved = replace(self.saved, seen=self.saved.now())
        self.differs_on_disk, self.trouble = False, ""
        self._tell(Change.DISK)

    def save(self, name: str | None = None) -> None:
        """Write the present version over the project's file, or as a copy called *name*."""
        document = self.history.present.document
        try:
            if name is None:
                self.saved = write(self.saved, document)
                self.note = Note(f"Saved {self.saved.path.name}.")
            else:
                made = write_copy(self.saved, _with_ending(name), document)
                self.note = Note(f"Saved a copy as {made.path.name}.")
        except GridshellError as error:
            self._fail(error)
            return
        self.trouble = ""
        self._tell(Change.STATUS)

    def rescue(self) -> str:
        """Write what was not saved as a copy, where the studio ends; its name, "" for none."""
        if not self.unsaved:
            return ""
        stem = f"{self.saved.path.stem}-unsaved"
        names = (f"{stem}{number}.toml" for number in ("", *(f"-{n}" for n in range(2, 100))))
        name = next((n for n in names if not (self.folder / n).exists()), None)
        if name is None:
            return ""
        try:
            return write_copy(self.saved, name, self.history.present.document).path.name
        except GridshellError as error:
            self._fail(error)
            return ""

    # ---- the package ------------------------------------------------------------------------

    async def write_package(self, name: str) -> bool:
        """What ``gridshell run`` does with the present version, into the folder *name*; whether."""
        if self._packing:
            self._fail(OutputError("A package is being written already", where=name))
            return False
        out = self.folder / name
        if not name or Path(name).name != name or name.startswith("."):
            self._fail(
                OutputError(
                    "A package is written into a folder beside the project",
                    where=str(self.folder),
                    value=name or "no name",
                    advice="a name such as package",
                )
            )
            return False
        self._packing, self.trouble = True, ""
        project, loop = self.history.present.project, asyncio.get_running_loop()
        try:
            report = await asyncio.to_thread(
                run, project, out, folder=self.folder, announce=self._announcer(loop, "package: ")
            )
        except GridshellError as error:
            self._fail(error)
            return False
        finally:
            self._packing, self.busy = False, None
            self._tell(Change.STATUS)
        errors = sum(finding["severity"] == "error" for finding in report["findings"])
        more = f"; {plural(errors, 'finding')} of severity error, see report.html" if errors else ""
        self.note = Note(f"The package is in {name}/{more}.", good=not errors)
        self._tell(Change.STATUS)
        return True

    # ---- work -------------------------------------------------------------------------------

    async def work(self) -> None:
        """Solve and build what is asked for, and watch the file, until cancelled."""
        self._asked = self._wanted = self._shown
        self._awake.set()
        watching = asyncio.create_task(self._watch())
        try:
            while True:
                await self._awake.wait()
                self._awake.clear()
                version, self._wanted = self._wanted, None
                if version is not None:
                    await self._guarded(self._solve(version))
        finally:
            watching.cancel()

    async def _guarded(self, work: Coroutine[Any, Any, None]) -> None:
        """A fault in *work* is told, and the studio goes on."""
        try:
            await work
        except Exception as error:  # noqa: BLE001
            self.busy = None
            said = " ".join(f"{type(error).__name__}: {error}".split())
            self.trouble = f"This is a fault of the program, not of the project ({said})."
            self._tell(Change.STATUS)

    async def _watch(self) -> None:
        while True:
            await asyncio.sleep(_LOOK)
            now = await asyncio.to_thread(self.saved.now)
            differs = now != self.saved.seen
            if self._unread is not None and now != self._unread:
                self._unread, self.trouble = None, ""  # what could not be read is mended, or gone
                self._tell(Change.DISK)
            if differs != self.differs_on_disk:
                self.differs_on_disk = differs
                self._tell(Change.DISK)

    async def _solve(self, version: Version) -> None:
        loop = asyncio.get_running_loop()
        self.residuals = []
        self.busy = Busy("solving")
        self._tell(Change.STATUS)
        most, told_at = version.project.net.steps, [time.monotonic()]

        def stepped(residual: Residual) -> None:
            if self._wanted is not None:
                raise _NotWantedError
            if time.monotonic() - told_at[0] > _TELL:
                told_at[0] = time.monotonic()
                loop.call_soon_threadsafe(self._step, residual, most)

        try:
            self.net = await asyncio.to_thread(
                find_net,
                version.project,
                self.folder,
                self._starts,
                told=self._announcer(loop),
                stepped=stepped,
            )
        except _NotWantedError:
            return
        except GridshellError as error:
            if self._wanted is None:
                self.busy = None
                self._fail(error)
            return
        self.busy = Busy("building")
        self._tell(Change.NET)
        if self._wanted is None:
            task = asyncio.create_task(self._guarded(self._build(self.net)))
            self._tasks.add(task)
            task.add_done_callback(self._tasks.discard)

    async def _build(self, net: NetDesign) -> None:
        try:
            built = await asyncio.to_thread(build, net)
        except GridshellError as error:
            if self.net is net and self._wanted is None:
                self.busy = None
                self._fail(error)
            return
        if self.net is not net or self._wanted is not None:
            return  # another net is on its way
        self.built, self.busy = built, None
        self._tell(Change.BUILT)

    def _step(self, residual: Residual, most: int) -> None:
        self.residuals.append(residual)
        self.busy = Busy(f"solving, step {residual.step}", min(1.0, residual.step / most))
        self._tell(Change.STEP)

    def _announcer(
        self, loop: asyncio.AbstractEventLoop, before: str = ""
    ) -> Callable[[str], None]:
        def announce(stage: str) -> None:
            loop.call_soon_threadsafe(self._doing, f"{before}{stage}")

        return announce

    def _doing(self, text: str) -> None:
        self.busy = Busy(text)
        self._tell(Change.STATUS)


def _with_ending(name: str) -> str:
    return f"{name}.toml" if name and not Path(name).suffix else name
