"""The command ``gridshell lint``: faults of cutting files, of this program or any other."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fabrication.finding import Finding
    from fabrication.shop import Process


_SHOWN = 3
"""Findings of one kind that are printed one by one."""


class By(StrEnum):
    """Processes by their name on the command line."""

    LASER = "laser"
    WATERJET = "waterjet"
    ROUTER = "router"
    SAW = "saw"


def lint(
    files: Annotated[list[Path], typer.Argument(metavar="FILE.dxf...", help="Cutting files.")],
    layer: Annotated[
        list[str] | None,
        typer.Option(metavar="KEY=NAME", help="A shop's name for CUT, MARK, TEXT, SHEET or DRILL."),
    ] = None,
    process: Annotated[
        By | None, typer.Option(help="Look for what this process cannot cut, too.")
    ] = None,
    thickness: Annotated[
        float | None,
        typer.Option(
            min=0.0,
            help="Of the sheet, mm; without it only what the tool itself cannot cut is told.",
        ),
    ] = None,
    report: Annotated[
        Path | None, typer.Option(metavar="R.json", help="Write all findings to a file.")
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print errors only.")] = False,
) -> None:
    """Look for what goes wrong with cutting files: units, open or double lines, layers, webs."""
    from fabrication.finding import Severity

    if thickness is not None and process is None:
        raise typer.BadParameter("a thickness says something with --process only")
    found = _found(files, _process(process, thickness or 0.0, layer or []))
    if report is not None:
        _write(report, found)
    _print(found, quiet)
    if any(f.severity is Severity.ERROR for findings in found.values() for f in findings):
        raise typer.Exit(1)


def _process(by: By | None, thickness: float, layer: Sequence[str]) -> Process:
    from dataclasses import replace

    from fabrication.shop import Cutting, Layers, Process, preset

    names = {}
    for pair in layer:
        key, _, name = pair.partition("=")
        if key not in ("CUT", "MARK", "TEXT", "SHEET", "DRILL") or not name:
            raise typer.BadParameter(f"{pair!r} is not like CUT=0_CUT", param_hint="--layer")
        names[key.lower()] = name
    usual = Process() if by is None else preset(Cutting(by.value), thickness)
    return replace(usual, layers=Layers(**names))


def _found(files: Sequence[Path], process: Process) -> dict[Path, tuple[Finding, ...]]:
    import logging

    from fabrication.export.dxf_lint import lint_dxf

    logging.getLogger("ezdxf").addHandler(logging.NullHandler())
    return {path: lint_dxf(path, process) for path in files}


def _write(report: Path, found: Mapping[Path, tuple[Finding, ...]]) -> None:
    import json
    from dataclasses import asdict

    from fabrication.errors import OutputError

    content = [
        {
            "file": str(path),
            "findings": [asdict(each) | {"severity": each.severity.value} for each in findings],
        }
        for path, findings in found.items()
    ]
    try:
        report.write_text(json.dumps(content, indent=1, ensure_ascii=False) + "\n", "utf-8")
    except OSError as error:
        raise OutputError(
            "The report cannot be written", where=str(report), value=error.strerror or ""
        ) from None


def _print(found: Mapping[Path, tuple[Finding, ...]], quiet: bool) -> None:
    """The first findings of each kind below their file; with *quiet*, errors only."""
    from rich.console import Console
    from rich.markup import escape

    from fabrication.finding import Severity

    console = Console(highlight=False, soft_wrap=True)
    colours = {"error": "red", "warning": "yellow", "info": "cyan"}
    for path, findings in found.items():
        told = [f for f in findings if not quiet or f.severity is Severity.ERROR]
        if not quiet or told:
            errors = sum(f.severity is Severity.ERROR for f in findings)
            count = f"{errors} errors, {len(findings)} findings" if findings else "no faults"
            console.print(f"[bold]{escape(str(path))}[/bold]  {count}")
        kinds: dict[tuple[str, str], list[Finding]] = {}
        for finding in told:
            kinds.setdefault((finding.severity.value, finding.code), []).append(finding)
        for (severity, code), same in kinds.items():
            for finding in same[:_SHOWN]:
                line = f"  [{colours[severity]}]{severity}[/] {code}: {escape(finding.message)}"
                console.print(line)
            if len(same) > _SHOWN:
                console.print(f"    and {len(same) - _SHOWN} more like this; --report has them all")
