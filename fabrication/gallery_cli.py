"""The command ``gridshell gallery``: every figure of the paper, its numbers beside ours."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from fabrication.gallery import Figure, Row

_LEAST_WIDTH = 110


def gallery(
    figures: Annotated[
        list[str] | None, typer.Argument(metavar="[FIGURE]...", help="As in 13; all if none.")
    ] = None,
    out: Annotated[
        Path, typer.Option("--out", "-o", metavar="DIR", help="Folder to write.")
    ] = Path("gallery"),
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print errors only.")] = False,
) -> None:
    """Build the figures of the paper: a picture and a report each, and one table.

    Ends with 0 when every figure meets its own conditions, 1 when one does not.
    """
    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    from fabrication.gallery import build

    console = Console(stderr=True, quiet=quiet)
    silent = quiet or not console.is_terminal
    columns = (SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True, disable=silent) as progress:
        task = progress.add_task("loading", total=None)

        def announce(name: str) -> None:
            if silent and not quiet:
                typer.echo(f"gridshell: figure {name}", err=True)
            progress.update(task, description=f"figure {name}")

        rows = build(out, figures or (), announce=announce)
    if not quiet:
        _print_table(rows, out)
    failed = [row.name for row in rows if not row.holds]
    if failed:
        typer.echo(f"gridshell: figure {', '.join(failed)} misses its conditions", err=True)
        raise typer.Exit(1)


def _print_table(rows: list[Row], out: Path) -> None:
    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    table = Table(show_lines=True)
    for heading in ("Fig.", "What", "Numbers (the paper's)", "Its own condition", "s", ""):
        table.add_column(heading, justify="right" if heading == "s" else "left")
    for row in rows:
        verdict = "[green]holds[/]" if row.holds else "[red]fails[/]"
        seconds, figure = f"{row.seconds:.1f}", row.figure
        told = (
            (row.fault, "", "")
            if figure is None
            else (figure.title, _numbers(figure), _own(figure))
        )
        table.add_row(row.name, *map(escape, told), seconds, verdict)
    console = Console(highlight=False, width=max(Console().width, _LEAST_WIDTH))
    console.print(table)
    for row in rows:
        for remark in row.figure.remarks if row.figure else ():
            console.print(f"  {row.name}: {escape(remark)}", soft_wrap=True)
    console.print(f"  {sum(row.seconds for row in rows):.0f} s; written to {escape(str(out))}")


def _numbers(figure: Figure) -> str:
    """Ours, with the paper's own behind those that it prints."""
    parts = []
    for key, value in figure.ours.items():
        paper = f" ({_short(figure.paper[key])})" if key in figure.paper else ""
        parts.append(f"{key} {_short(value)}{paper}")
    return "; ".join(parts)


def _short(value: float | int | str) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _own(figure: Figure) -> str:
    """The conditions that fail, or the one that comes nearest to its limit, and how many hold."""
    conditions = figure.conditions
    failing = [c for c in conditions if not c.holds]
    real = [c for c in conditions if c.limit > 0.0] or list(conditions)
    shown = failing or sorted(real, key=lambda c: c.value / (c.limit or 1.0))[-1:]
    told = [f"{c.what}: {c.value:.2g} ({c.limit:g} allowed)" for c in shown]
    return "; ".join(told) + ("" if failing else f"; {len(conditions)} hold")
