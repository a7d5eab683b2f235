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


class By(StrEnum):
    """Processes by their name on the command line."""

    LASER = "laser"
    WATERJET = "waterjet"
    ROUTER = "router"
    SAW = "saw"


def lint(
    files: Annotated[list[Path], typer.Argument(metavar="FILE.dxf...", help="Cutting files.")],
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
    found = _found(files, process, thickness or 0.0)
    if report is not None:
        _write(report, found)
    _print(found, quiet)
    if any(f.severity is Severity.ERROR for findings in found.values() for f in findings):
        raise typer.Exit(1)


def _found(
    files: Sequence[Path], by: By | None, thickness: float
) -> dict[Path, tuple[Finding, ...]]:
    from fabrication.export.dxf_lint import lint_dxf
    from fabrication.shop import Cutting, preset

    process: Process | None = None if by is None else preset(Cutting(by.value), thickness)
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
    """One line per finding below its file; with *quiet*, errors only."""
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
        for finding in told:
            severity = finding.severity.value
            colour = colours[severity]
            console.print(
                f"  [{colour}]{severity}[/] {finding.code}: {escape(finding.message)}"
            )
