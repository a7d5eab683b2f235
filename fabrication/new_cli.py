"""The command ``gridshell new``: a commented project file to begin with."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def new(
    start: Annotated[
        str | None, typer.Argument(metavar="START", help="Leave it out to see what there is.")
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", metavar="FILE.toml", help="START.toml if not given."),
    ] = None,
) -> None:
    """Write a commented project file from one of a few starting points; never over another file."""
    from fabrication.errors import OutputError
    from fabrication.starting_points import STARTING_POINTS, starting_point

    if start is None:
        width = max(map(len, STARTING_POINTS))
        for name, about in STARTING_POINTS.items():
            typer.echo(f"{name:<{width}}  {about}")
        typer.echo("\ngridshell new strips --out roof.toml")
        return
    path = Path(f"{start}.toml") if out is None else out
    text = starting_point(start, title=path.stem[:80] or start)
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError:
        raise OutputError(
            "The file is there already",
            where=str(path),
            advice="another name: gridshell new ... --out FILE.toml",
        ) from None
    except OSError as error:
        raise OutputError(
            "The file cannot be written", where=str(path), value=error.strerror or ""
        ) from None
    typer.echo(f"{path}\ngridshell check {path}\ngridshell run {path} --out out/")
