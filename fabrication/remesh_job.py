"""From a surface file to the quad mesh M along two families of directions: the work of ``remesh``.

Everything is worked out before a file is written, and every file is there whole or not at all.
"""

from __future__ import annotations

import json
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

import gridshell as gs
from fabrication.delivery import draft_folder, move_in
from fabrication.errors import OutputError
from fabrication.finding import Finding, Severity
from fabrication.remesh_checks import check_quads, require_few_quads
from fabrication.whole_files import Write, require_places, text_file, write_whole
from gridshell.arrays import Points
from gridshell.remesh.working_surface import FINE

_SPANNED = 8_000.0, 30_000.0
"""Triangles of a minimal surface, at least and at most."""

_FAR = 0.05
"""Of the surface's diagonal: guide lines further away than this do not lie on it."""


@dataclass(frozen=True)
class GuideFile:
    """A file of polylines that lines of one family shall follow."""

    path: Path
    family: int = 1


@dataclass(frozen=True)
class Wish:
    """Which quad mesh is wanted.

    Parameters
    ----------
    directions : without guides.
    quads, edge : how many, or how long their edges, mm: one of the two.
    extent : how far it goes at the boundary.
    guides : files in the unit of the surface or the one they state.
    """

    directions: gs.Directions
    quads: int | None
    edge: float | None = None
    extent: gs.Extent = gs.Extent.COVER
    guides: tuple[GuideFile, ...] = ()


@dataclass(frozen=True, eq=False)
class Remeshed:
    """The quad mesh with what is to be known of it.

    Parameters
    ----------
    made : with M, its reference and its field.
    findings : errors first.
    seconds : of the stages.
    """

    made: gs.Quadrangulation
    findings: tuple[Finding, ...]
    seconds: dict[str, float]

    @property
    def good(self) -> bool:
        """Whether no finding is an error."""
        return all(finding.severity is not Severity.ERROR for finding in self.findings)

    def section(self) -> dict[str, Any]:
        """The figures, as the section ``remesh`` of a report."""
        found = self.made.report.plain()
        found["remarks"] = [_numbers(remark) for remark in found["remarks"]]
        return found

    def report(self) -> dict[str, Any]:
        """The content of ``R.json``."""
        findings = [{**asdict(f), "severity": f.severity.value} for f in self.findings]
        return {
            "remesh": {**self.section(), "findings": findings},
            "findings": findings,
            "seconds": self.seconds,
        }


def remesh(surface: Path, unit: gs.Unit | None, wish: Wish) -> Remeshed:
    """Read *surface*, in *unit* or the one it states, and find the quad mesh; writes nothing.

    Raises
    ------
    InputError
        For files that cannot be used, surfaces without such directions, contradictory settings.
    """
    seconds: dict[str, float] = {}
    with _timed(seconds, "read"):
        found = read_wished(surface, unit, wish)
    with _timed(seconds, "remesh"):
        laid = lay(found, unit, wish)
    return replace(laid, seconds=seconds)


def read_wished(
    surface: Path, unit: gs.Unit | None, wish: Wish
) -> gs.TriangulatedSurface | gs.BrepSurface:
    """Read *surface*, fine enough for the mesh that is wanted; raises as `remesh` does."""
    require_few_quads(None, wish.quads, None)
    found = gs.read_design(surface, unit=unit, triangles=_triangles(wish))
    require_few_quads(found, wish.quads, wish.edge)
    return found


def lay(
    surface: gs.TriangulatedSurface | gs.BrepSurface, unit: gs.Unit | None, wish: Wish
) -> Remeshed:
    """Lay the mesh over *surface*; guide lines are in *unit*. Raises as `remesh` does."""
    directions = _guided(wish, unit, surface)
    made = gs.quadrangulate(
        surface, directions, quads=wish.quads, edge=wish.edge, extent=wish.extent
    )
    return Remeshed(made, tuple(check_quads(made, extent=wish.extent)), {})


def write_remeshed(
    result: Remeshed,
    unit: gs.Unit,
    *,
    name: str,
    out: Path,
    report: Path | None = None,
    control: Path | None = None,
    pictures: Path | None = None,
) -> None:
    """Write M, and what else is asked for, in *unit*; all of it or nothing.

    Parameters
    ----------
    name : title of the pictures.

    Raises
    ------
    OutputError
        When a file cannot be written.
    MeshError
        When *control* is asked for and M is too small or too narrow to hold a control mesh.
    """
    mesh = result.made.mesh
    files: dict[Path, Write] = {out: lambda path: gs.write_obj(path, mesh, unit=unit)}
    if control is not None:
        inner = result.made.control().mesh
        files[control] = lambda path: gs.write_obj(path, inner, unit=unit)
    if report is not None:
        text = json.dumps(result.report(), indent=2, allow_nan=False) + "\n"
        files[report] = text_file(text)
    require_places(*files)
    if pictures is None:
        write_whole(files)
        return
    from fabrication.export.stage_page import write_stages

    with draft_folder(pictures) as draft:
        write_stages(draft, result.made, name=name)
        write_whole(files)
        move_in(draft, pictures, stale=())


def require_outputs(files: Sequence[Path | None], pictures: Path | None) -> None:
    """Refuse, before any work, places where no file can be put; raises OutputError."""
    require_places(*[path for path in files if path is not None])
    if pictures is not None and pictures.exists() and not pictures.is_dir():
        raise OutputError("A file is where a folder must be", where=str(pictures))


@contextmanager
def _timed(seconds: dict[str, float], stage: str) -> Iterator[None]:
    start = time.perf_counter()
    yield
    seconds[stage] = round(time.perf_counter() - start, 3)


def _triangles(wish: Wish) -> float:
    least, most = _SPANNED
    return least if wish.quads is None else float(np.clip(FINE * wish.quads, least, most))


# ---- guide lines -------------------------------------------------------------------------------


def _guided(
    wish: Wish, unit: gs.Unit | None, surface: gs.TriangulatedSurface | gs.BrepSurface
) -> gs.Directions:
    """The directions with their guide lines."""
    if not wish.guides:
        return wish.directions
    if not isinstance(wish.directions, gs.Principal | gs.Conjugate):
        raise gs.SettingError(
            "Guide lines lead principal and conjugate directions only",
            where="guides",
            value=str(wish.guides[0].path),
            advice="leave them out: asymptotic directions are given by the surface everywhere",
        )
    lines = [guide for file in wish.guides for guide in _lines(file, unit, surface)]
    return replace(wish.directions, guides=tuple(lines))


def _lines(
    file: GuideFile, unit: gs.Unit | None, surface: gs.TriangulatedSurface | gs.BrepSurface
) -> Iterator[gs.Guide]:
    stated = gs.states_unit(file.path)
    for points in gs.read_polylines(file.path, unit=None if stated else unit or gs.Unit.MM):
        _require_near(file.path, points, surface)
        yield gs.Guide(points, file.family)


def _require_near(
    path: Path, points: Points, surface: gs.TriangulatedSurface | gs.BrepSurface
) -> None:
    feet = surface.closest(points).points
    away = np.linalg.norm(points - feet, axis=1)
    worst = int(np.argmax(away))
    limit = _FAR * float(np.linalg.norm(np.ptp(np.concatenate([feet, points]), axis=0)))
    if away[worst] > limit:
        x, y, z = points[worst].tolist()
        raise gs.SettingError(
            "A guide line does not lie on the surface",
            where=f"{path}, point ({x:.6g}, {y:.6g}, {z:.6g}) mm",
            value=f"{away[worst]:.4g} mm away",
            limit=f"{limit:.4g} mm",
            advice="draw it on the surface, in the surface's unit",
        )


def _numbers(remark: dict[str, Any]) -> dict[str, Any]:
    """A remark as data without what JSON cannot say."""
    return {**remark, "value": remark["value"] if np.isfinite(remark["value"]) else None}
