"""The studio's page: sliders on the left, the 3D view, findings on the right."""

from __future__ import annotations

from collections import defaultdict
from functools import partial
from pathlib import Path
from typing import Any

from nicegui import ui
from nicegui.client import Client

from fabrication.export.scene.page import style
from fabrication.finding import Finding, Severity
from fabrication.studio.knobs import Knob
from fabrication.studio.readings import Reading, built_readings, net_readings
from fabrication.studio.scenes import built_scene, centre_of, net_scene, residual_chart
from fabrication.studio.session import Change, Session
from fabrication.studio.shell_view import ShellView
from fabrication.words import plural, raised
from gridshell.arrays import Floats

_CSS = (Path(__file__).parent / "studio.css").read_text(encoding="utf-8") + style()

_LISTED = 200
"""Findings of a kind that are listed; the report has all."""


class _Slider(ui.slider):
    """A slider that follows the hand at once, not when the server has answered."""

    LOOPBACK = False


class Page:
    """One browser's page on a session.

    Parameters
    ----------
    session : what is shown; several pages may show one.
    """

    def __init__(self, session: Session) -> None:
        self.session = session
        self._centre: Floats | None = None
        ui.add_css(_CSS)
        self._top()
        self._banners()
        with ui.element("div").classes("gs-body"):
            with ui.element("div").classes("gs-left"):
                self._sliders()
                ui.label("Convergence").classes("gs-group")
                self._chart = ui.html("", sanitize=False)
                ui.label("Figures").classes("gs-group")
                self._figures()
            with ui.element("div").classes("gs-middle"):
                self._view = ShellView("/flat", self._show_all)
            with ui.element("div").classes("gs-right"):
                self._found = ui.element("div")
                with self._found:
                    self._findings()
        self._status()
        client = ui.context.client
        client.on_delete(session.listen(partial(self._heard, client)))

    # ---- parts of the page ------------------------------------------------------------------

    def _top(self) -> None:
        session = self.session
        with ui.element("div").classes("gs-top"):
            self._name = ui.label().classes("gs-name")
            ui.element("div").classes("gs-grow")
            self._undo = ui.button("Undo", on_click=session.undo).props(
                "flat dense no-caps color=dark"
            )
            self._redo = ui.button("Redo", on_click=session.redo).props(
                "flat dense no-caps color=dark"
            )
            ui.button("Save", on_click=lambda: session.save()).props(
                "flat dense no-caps color=dark"
            )
            ui.button("Save as project", on_click=self._ask_copy).props(
                "flat dense no-caps color=dark"
            )
            self._write = ui.button("Write the package", on_click=self._ask_package)
            self._write.props("unelevated dense no-caps color=dark")
        self._named()

    def _named(self) -> None:
        session = self.session
        star = " •" if session.unsaved else ""
        self._name.set_text(f"{session.present.project.name}{star}")
        self._undo.set_enabled(bool(session.history.past))
        self._redo.set_enabled(bool(session.history.future))

    @ui.refreshable_method
    def _banners(self) -> None:
        session = self.session
        if session.trouble:
            with ui.element("div").classes("gs-banner gs-error").props("data-mark=trouble"):
                ui.label(session.trouble)
        if session.note:
            style = "gs-note" if session.note.good else "gs-disk"
            with ui.element("div").classes(f"gs-banner {style}").props("data-mark=note"):
                ui.label(session.note.text)
        if session.differs_on_disk:
            with ui.element("div").classes("gs-banner gs-disk").props("data-mark=disk"):
                ui.label(f"{session.saved.path.name} {self._fate()} by another program.")
                ui.button("Load it", on_click=session.load).props("flat dense no-caps color=dark")
                ui.button("Keep mine", on_click=session.keep).props("flat dense no-caps color=dark")

    def _fate(self) -> str:
        return "was removed" if self.session.saved.now() is None else "was changed"

    @ui.refreshable_method
    def _sliders(self) -> None:
        groups: dict[str, list[Knob]] = defaultdict(list)
        for knob in self.session.knobs:
            groups[knob.group].append(knob)
        for name, own in groups.items():
            ui.label(name).classes("gs-group")
            for knob in own:
                self._slider(knob)

    def _slider(self, knob: Knob) -> None:
        with ui.element("div").classes("gs-line gs-knob"):
            unit = knob.unit.strip()
            ui.label(f"{knob.label}, {unit}" if unit else knob.label)
            field = ui.number(value=knob.chosen(knob.value))
            field.props(f'dense borderless hide-bottom-space data-mark="{knob.key}"')
        slider = _Slider(min=knob.low, max=knob.high, step=knob.step, value=knob.value)
        slider.props(f'dense color=dark aria-label="{knob.label}" data-mark="slider {knob.key}"')

        def turned(event: Any, *, done: bool) -> None:
            value = knob.chosen(float(event.args))
            field.set_value(value)
            if done or knob.live:
                self.session.change(knob.key, value, done=done)

        def typed() -> None:
            value = field.value
            if value is None:
                field.set_value(knob.chosen(slider.value))
                return
            value = round(value) if knob.whole else float(value)
            field.set_value(value)
            if value == self.session.present.value(knob.key):
                return
            self.session.change(knob.key, value, done=True)
            place = knob.place(value)
            if place is not None:
                slider.set_value(place)

        slider.on("update:model-value", partial(turned, done=False), throttle=0.05)
        slider.on("change", partial(turned, done=True))
        field.on("keydown.enter", typed)
        field.on("blur", typed)

    @ui.refreshable_method
    def _figures(self) -> None:
        session = self.session
        if session.net is None:
            return
        self._readings(net_readings(session.net), old=session.busy is not None)
        if session.built is not None:
            self._readings(built_readings(session.built), old=not session.up_to_date)

    @staticmethod
    def _readings(found: list[Reading], *, old: bool) -> None:
        for reading in found:
            with ui.element("div").classes("gs-line" + (" gs-old" if old else "")):
                ui.label(reading.label)
                with ui.element("b").props(f'data-mark="{reading.key}"'):
                    ui.label(reading.value)

    @ui.refreshable_method
    def _findings(self) -> None:
        built = self.session.built
        found = () if built is None else built.findings
        ui.label(plural(len(found), "finding") if found else "No findings").classes("gs-group")
        grades = [Severity.ERROR, Severity.WARNING, Severity.INFO]
        kinds: dict[tuple[Severity, str], list[Finding]] = defaultdict(list)
        for finding in sorted(found, key=lambda f: grades.index(f.severity)):
            kinds[finding.severity, finding.code].append(finding)
        for same in kinds.values():
            if len(same) == 1:
                self._finding(same[0])
            else:
                self._alike(same)

    def _alike(self, same: list[Finding]) -> None:
        """Findings of a kind: the first in words, all places to unfold."""
        first, places = same[0], plural(len(same), "place")
        with ui.element("details").classes(f"gs-find {first.severity.value}"):
            with ui.element("summary"):
                with ui.element("b"):
                    ui.label(f"{first.severity.value}: {first.code} at {places}")
                ui.label(raised(first.message)).classes("gs-first")
            for finding in same[:_LISTED]:
                self._finding(finding)
            if len(same) > _LISTED:
                ui.label(f"and {len(same) - _LISTED} more, in the report")

    def _finding(self, finding: Finding) -> None:
        line = (
            ui.element("div")
            .classes(f"gs-find {finding.severity.value}")
            .props("data-mark=finding")
        )
        line.on("click", lambda: self._view.choose(finding.where.split(" ")[0]))
        with line:
            with ui.element("b"):
                ui.label(f"{finding.severity.value}: {finding.code} at {finding.where}")
            ui.label(raised(finding.message))

    def _status(self) -> None:
        with ui.element("div").classes("gs-status"):
            self._doing = ui.label("").props("data-mark=status")
            self._bar = ui.linear_progress(0.0, show_value=False).props(
                "color=dark instant-feedback"
            )
            self._bar.classes("w-full").style("max-width: 240px")
        self._told()

    def _told(self) -> None:
        busy = self.session.busy
        ready = "Up to date" if self.session.up_to_date else ""
        self._doing.set_text(ready if busy is None else f"{busy.text} …")
        if self.session.up_to_date:
            self._found.classes(remove="gs-old")
        else:
            self._found.classes("gs-old")
        self._bar.set_visibility(busy is not None and busy.share is not None)
        if busy is not None and busy.share is not None:
            self._bar.set_value(busy.share)

    # ---- what happens -----------------------------------------------------------------------

    def _heard(self, client: Client, change: Change) -> None:
        with client:
            match change:
                case Change.STEP:
                    self._told()
                case Change.NET:
                    self._show_net()
                case Change.BUILT:
                    self._show_built()
                case Change.PROJECT:
                    self._sliders.refresh()
                    self._refresh()
                case Change.STATUS | Change.DISK:
                    self._refresh()

    def _refresh(self) -> None:
        self._named()
        self._told()
        self._banners.refresh()

    def _show_all(self) -> None:
        """When the browser is ready: whatever there is by now."""
        if self.session.net is not None:
            self._show_net()
        if self.session.up_to_date:
            self._show_built()

    def _show_net(self) -> None:
        net = self.session.net
        if net is None:
            return
        if self._centre is None:
            self._centre = centre_of(net)
        self._view.show(net_scene(net, self._centre), pending=True)
        residuals = [residual.largest for residual in net.residuals]
        self._chart.set_content(residual_chart(residuals, net.project.net.tolerance))
        self._figures.refresh()
        self._refresh()

    def _show_built(self) -> None:
        built = self.session.built
        if built is None or self._centre is None:
            return
        self._view.show(built_scene(built, self._centre))
        self._figures.refresh()
        self._findings.refresh()
        self._refresh()

    async def _ask_copy(self) -> None:
        name = await self._asked("Save as project", f"{self.session.saved.path.stem}-2.toml")
        if name is not None:
            self.session.save(name)

    async def _ask_package(self) -> None:
        name = await self._asked("Write the package", f"{self.session.saved.path.stem}-package")
        if name is None:
            return
        self._write.set_enabled(False)
        try:
            await self.session.write_package(name)
        finally:
            self._write.set_enabled(True)

    async def _asked(self, title: str, default: str) -> str | None:
        """A name in the project's folder; None where it is called off."""
        with ui.dialog() as dialog, ui.card():
            ui.label(title).classes("gs-name")
            ui.label(f"In {self.session.folder}")
            name = ui.input("Name", value=default).style("min-width: 320px").props("autofocus")
            name.on("keydown.enter", lambda: dialog.submit(name.value))
            with ui.row():
                ui.button(title, on_click=lambda: dialog.submit(name.value)).props(
                    "unelevated no-caps color=dark"
                )
                ui.button("Cancel", on_click=lambda: dialog.submit(None)).props("flat no-caps")
        found: str | None = await dialog
        if not dialog.is_deleted:  # as when the browser went away
            dialog.delete()
        return found
