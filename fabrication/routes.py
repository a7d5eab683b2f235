"""What every route from an optimised net to a package of files has in common.

A route turns the net into a *system*: what is built on it, which then writes its own files. The
package does the rest once for all: net, report, folder.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

import gridshell as gs
from fabrication.export.quality_series import Series
from fabrication.finding import Finding, Severity
from fabrication.kernel_job import Kernel

CLOSURE_LIMIT = 0.05
"""Largest distance between the files and the design that passes, mm."""

VOLUME_LIMIT = 20.0
"""Largest difference between flat area times thickness and the solid's volume, ppm."""

Report = dict[str, Any]
Announce = Callable[[str], None]
Shared = Callable[[float], None]


@dataclass
class Clock:
    """Announces stages and keeps their times.

    Parameters
    ----------
    announce : hears the name of every stage.
    shared : hears how much of a stage is done, 0 to 1, where that is known.
    """

    announce: Announce
    shared: Shared = lambda share: None
    seconds: dict[str, float] = field(default_factory=dict)

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Announce *name*, and keep the time until the block is left."""
        self.announce(name)
        start = time.perf_counter()
        yield
        self.seconds[name] = round(time.perf_counter() - start, 3)


@dataclass(frozen=True, eq=False)
class Written:
    """What a system says of the files it has written.

    Parameters
    ----------
    sections : of the report: structure, closure, ...
    findings : of the files; those of the design come before.
    kernel_seconds : of the CAD kernel's own process.
    """

    sections: Report
    findings: Sequence[Finding]
    kernel_seconds: dict[str, float]


class System(Protocol):
    """What is built on a net."""

    @property
    def findings(self) -> Sequence[Finding]:
        """Of the design, before a file is written."""

    def write(self, draft: Path, cad: Kernel, clock: Clock) -> Written:
        """Write sheets, cut list and solids into *draft*, and read them back.

        ``net.json`` is there already.
        """

    def write_page(
        self, path: Path, report: Report, pictures: Sequence[Report], series: Sequence[Series]
    ) -> None:
        """Write ``report.html``; *series* are the figures of the net."""

    def write_paper(self, path: Path, report: Report, series: Sequence[Series]) -> None:
        """Write ``report.pdf``; *series* are the figures of the net."""


class Route(Protocol):
    """One way from a net to what is built of it."""

    @property
    def planarity(self) -> gs.Planarity:
        """What of the net is flat."""

    @property
    def files(self) -> tuple[str, ...]:
        """Sheets that every run makes, among others."""

    def recipe(self, folder: Path) -> gs.NetRecipe:
        """The conditions on the net; what they name as files lies in *folder*."""

    def build(self, control: gs.ControlMesh, clock: Clock) -> System:
        """The system on *control*, optimised."""


def errors_at(mark: str, findings: Sequence[Finding]) -> str:
    """What the first findings of severity error say of the part *mark*, as one line."""
    found = [f for f in findings if f.severity is Severity.ERROR and mark in f.where.split()]
    return " ".join(f.message for f in found[:3]).rstrip(".")


Measure = tuple[str, str, float, float, str, str]
"""Code, where, value, limit, unit, and what the value is."""


def loop_findings(measures: Iterable[Measure]) -> list[Finding]:
    """Errors where the files do not close back onto the design, or parts do not fit."""
    return [
        Finding(
            code,
            Severity.ERROR,
            where,
            value,
            limit,
            unit,
            f"{value:.4g} {unit} {what}, {limit:g} allowed",
        )
        for code, where, value, limit, unit, what in measures
        if value > limit
    ]
