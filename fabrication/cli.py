"""The command ``gridshell``: text, degrees and units stop here.

Exit codes: 0 good, 1 findings of severity error, 2 wrong usage or input. Heavy packages are
imported inside the commands that need them, so that help answers at once.
"""

from __future__ import annotations

import sys
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer

from fabrication.optimize_cli import optimize

if TYPE_CHECKING:
    from rich.console import Console

app = typer.Typer(
    name="gridshell",
    help="From a curved surface to a gridshell a shop can cut.",
    no_args_is_help=True,
    add_completion=True,
    pretty_exceptions_enable=False,
)

app.command()(optimize)

_STAGES = 9

ProjectFile = Annotated[Path, typer.Argument(metavar="PROJECT.toml", help="The project file.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print errors only.")]


def main() -> None:
    """Run the command; mistakes of input end with one message and exit code 2."""
    try:
        app()
    except Exception as error:
        from gridshell.errors import GridshellError

        if not isinstance(error, GridshellError):
            raise
        _fail(str(error), 2)


@app.callback(invoke_without_command=True)
def _root(
    show_version: Annotated[
        bool, typer.Option("--version", help="Print the version and stop.")
    ] = False,
) -> None:
    if show_version:
        typer.echo(f"gridshell {version('gridshell')}")
        raise typer.Exit


@app.command()
def run(
    project: ProjectFile,
    out: Annotated[Path, typer.Option("--out", "-o", metavar="DIR", help="Folder to write.")],
    quiet: Quiet = False,
) -> None:
    """Do the whole way: net, lamellas, sheets, STEP, lists and report."""
    from fabrication.project import read_project

    content = read_project(project)
    try:
        report = _run_with_progress(content, out, project.parent, quiet)
    except KeyboardInterrupt:
        _fail("Interrupted. Nothing was written.", 130)
    if not quiet:
        _summary(report, out)
    if any(finding["severity"] == "error" for finding in report["findings"]):
        raise typer.Exit(1)


@app.command()
def check(project: ProjectFile, quiet: Quiet = False) -> None:
    """Read a project file, name what is wrong with it, and list every setting."""
    from fabrication.project import read_project

    content = read_project(project)
    if not quiet:
        _print_settings(content.model_dump(exclude_none=True))


def _print_settings(settings: dict[str, Any]) -> None:
    for key, value in settings.items():
        if isinstance(value, dict):
            typer.echo(f"\n[{key}]")
            for name, entry in value.items():
                typer.echo(f"{name} = {entry}")
        else:
            typer.echo(f"{key} = {value}")


def _run_with_progress(project: Any, out: Path, folder: Path, quiet: bool) -> dict[str, Any]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    console = Console(stderr=True, quiet=quiet)
    columns = (TextColumn("{task.description:<12}"), BarColumn(), TimeElapsedColumn())
    silent = quiet or not console.is_terminal
    with Progress(*columns, console=console, transient=True, disable=silent) as progress:
        task = progress.add_task("loading", total=_STAGES)
        from fabrication.package import run as run_package

        def announce(stage: str) -> None:
            progress.update(task, advance=1, description=stage)

        return run_package(project, out, folder=folder, announce=announce)


def _summary(report: dict[str, Any], out: Path) -> None:
    from rich.console import Console

    console = Console(highlight=False, soft_wrap=True)
    built, net, closed = report["structure"], report["net"], report["closure"]
    console.print(f"[bold]{_plain(report['name'])}[/bold]  {net['status']}")
    angle = net["node_angle_deg"]
    console.print(
        f"  {built['lamellas']} lamellas, {built['joints']} joints, "
        f"{built['total_length_m']:.1f} m, {built['mass_kg']:.1f} kg on {built['sheets']} sheets; "
        f"node angles {angle['min']:.2f} to {angle['max']:.2f} degrees"
    )
    console.print(
        f"  files close onto the design within {closed['max_mm']:.3f} mm, volumes within "
        f"{closed['volume_ppm']:.1f} ppm; largest clash {report['fit']['clash_mm3']['max']:.1g} mm3"
    )
    _print_findings(console, report["findings"])
    console.print(f"  {sum(report['timing'].values()):.1f} s; written to {_plain(str(out))}")


def _print_findings(console: Console, findings: list[dict[str, Any]]) -> None:
    """One line for each kind of finding: the first of its kind, and how many more there are."""
    colours = {"error": "red", "warning": "yellow", "info": "cyan"}
    kinds: dict[tuple[str, str], list[dict[str, Any]]] = {}
    for finding in findings:
        kinds.setdefault((finding["severity"], finding["code"]), []).append(finding)
    for (severity, code), same in kinds.items():
        line = f"  [{colours[severity]}]{severity}[/] {code}: {_plain(same[0]['message'])}"
        more = f" And {len(same) - 1} more like this, see report.html." if len(same) > 1 else ""
        console.print(line + more)


def _plain(text: str) -> str:
    from rich.markup import escape

    return escape(text)


def _fail(message: str, code: int) -> NoReturn:
    typer.echo(f"gridshell: {message}", err=True)
    sys.exit(code)
