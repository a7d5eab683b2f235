"""The command ``gridshell view``: a project in the browser, to look at and to change."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def view(
    project: Annotated[Path, typer.Argument(metavar="PROJECT.toml", help="The project file.")],
    port: Annotated[
        int | None,
        typer.Option(min=1, max=65535, help="Of the address; a free one if not given."),
    ] = None,
    browser: Annotated[
        bool, typer.Option("--browser/--no-browser", help="Open the address in the browser.")
    ] = True,
) -> None:
    """Show a project in the browser, change it with sliders, save it, write its package.

    On this machine only; the address holds a token, and no file outside the project's folder is
    opened. Ctrl-C ends it.
    """
    from fabrication.studio.serve import serve

    serve(project, port=port, browser=browser, told=typer.echo)
