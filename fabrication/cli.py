"""The command ``gridshell``: text, degrees and units stop here.

Exit codes: 0 good, 1 findings of severity error, 2 wrong usage or input, 70 a fault of the program,
130 interrupted, 143 terminated. Heavy packages are imported inside the commands that need them, so
that help answers at once.
"""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer

from fabrication.gallery_cli import gallery
from fabrication.lint_cli import lint
from fabrication.new_cli import new
from fabrication.optimize_cli import optimize
from fabrication.remesh_cli import remesh
from fabrication.view_cli import view

if TYPE_CHECKING:
    from rich.console import Console

app = typer.Typer(
    name="gridshell",
    help="From a curved surface to a gridshell a shop can cut.",
    no_args_is_help=True,
    add_completion=True,
    pretty_exceptions_enable=False,
)

app.command()(remesh)
app.command()(optimize)
app.command()(lint)
app.command()(gallery)
app.command()(new)
app.command()(view)

_STAGES = 11


def _folder(text: str) -> Path:
    if not text.strip():
        raise typer.BadParameter("the name of the folder is empty")
    return Path(text)


ProjectFile = Annotated[Path, typer.Argument(metavar="PROJECT.toml", help="The project file.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print errors only.")]


def _set_debug(debug: bool) -> None:
    if debug:
        os.environ["GRIDSHELL_DEBUG"] = "1"


Debug = Annotated[
    bool,
    typer.Option(
        "--debug",
        callback=_set_debug,
        help="Show where a fault of the program happened, as GRIDSHELL_DEBUG=1 does.",
    ),
]


class _TerminatedError(BaseException):
    """The system asked the command to end."""


def main() -> None:
    """Run the command; whatever goes wrong ends with one message and an exit code."""
    with _interrupts_noted() as interrupts:
        _run_app(interrupts)


def _run_app(interrupts: list[int]) -> None:
    try:
        app()
    except SystemExit as end:
        left = end.__context__
        if left is not None and isinstance(left.__cause__, KeyboardInterrupt):
            _fail("Interrupted.", 130)
        raise
    except Exception as error:
        from gridshell.errors import GridshellError

        if isinstance(error, GridshellError):
            _fail(str(error), 2)
        if isinstance(error, MemoryError):
            _fail("The net is too large for the memory. Try: fewer lamellas.", 2)
        if isinstance(error, OSError):
            _fail(f"The system refused a file or folder ({error}).", 2)
        if interrupts:  # a library that was being loaded may turn one into an error of its own
            _fail("Interrupted.", 130)
        if os.environ.get("GRIDSHELL_DEBUG", "") not in ("", "0"):
            raise
        said = " ".join(f"{type(error).__name__}: {error}".split())
        _fail(
            f"This is a fault of the program, not of the project ({said}). Please report it to the "
            "developers of gridshell, with the project file and what --debug prints.",
            70,
        )


@contextmanager
def _interrupts_noted() -> Iterator[list[int]]:
    """Ctrl-C as ever, and a note of each."""
    noted: list[int] = []

    def note(number: int, frame: FrameType | None) -> NoReturn:
        noted.append(number)
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGINT, note)
    try:
        yield noted
    finally:
        signal.signal(signal.SIGINT, before)


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
    out: Annotated[
        Path,
        typer.Option("--out", "-o", metavar="DIR", parser=_folder, help="Folder to write."),
    ],
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Do the whole way: net, lamellas or panels, sheets, STEP, lists and report."""
    from fabrication.project import read_project

    content = read_project(project)
    try:
        with _ending_in_order():
            report = _run_with_progress(content, out, project.parent, quiet)
    except KeyboardInterrupt:
        _fail("Interrupted. Nothing was written.", 130)
    except _TerminatedError:
        _fail("Terminated. Nothing was written.", 143)
    if not quiet:
        _summary(report, out)
    if any(finding["severity"] == "error" for finding in report["findings"]):
        raise typer.Exit(1)


@app.command()
def check(
    project: ProjectFile,
    findings: Annotated[
        bool,
        typer.Option("--findings", help="Design it, too, and list every finding; writes nothing."),
    ] = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Read a project file, name what is wrong, and print every setting with what it means.

    With --findings the net and its parts are made, but no file: ends with 1 where a finding is an
    error.
    """
    from fabrication.project import project_text, read_project

    content = read_project(project)
    if not quiet:
        typer.echo(project_text(content, explained=True), nl=False)
    if not findings:
        return
    from fabrication.package import found_by

    found = found_by(content, folder=project.parent)
    if not quiet:
        _print_all(found)
    if any(finding["severity"] == "error" for finding in found):
        raise typer.Exit(1)


def _print_all(found: list[dict[str, Any]]) -> None:
    """Every finding, a line each."""
    typer.echo(f"\n# {len(found)} findings" if found else "\n# no findings")
    for finding in found:
        typer.echo(
            f"# {finding['severity']} {finding['code']} [{finding['where']}] {finding['message']}"
        )


@contextmanager
def _ending_in_order() -> Iterator[None]:
    """Let SIGTERM end the block as Ctrl-C does, so that it can clean up."""

    def end(number: int, frame: object) -> NoReturn:
        signal.signal(number, signal.SIG_IGN)
        raise _TerminatedError

    before = signal.signal(signal.SIGTERM, end)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _run_with_progress(project: Any, out: Path, folder: Path, quiet: bool) -> dict[str, Any]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    from fabrication.time_left import TimeLeft, times_before

    console = Console(stderr=True, quiet=quiet)
    left = TimeLeft(times_before(out))
    columns = (
        TextColumn("{task.description:<12}"),
        BarColumn(),
        TimeElapsedColumn(),
        TextColumn("{task.fields[left]}"),
    )
    silent = quiet or not console.is_terminal
    with Progress(*columns, console=console, transient=True, disable=silent) as progress:
        task = progress.add_task("loading", total=_STAGES, left="")
        from fabrication.package import run as run_package

        begun: list[str] = []

        def announce(stage: str) -> None:
            left.begin(stage)
            if silent and not quiet:
                words = left.words()
                typer.echo(f"gridshell: {stage}{f', {words}' if words else ''}", err=True)
            begun.append(stage)
            progress.update(
                task, completed=len(begun), description=stage, left=left.words(), refresh=True
            )

        def shared(share: float) -> None:
            left.reach(share)
            progress.update(task, completed=len(begun) + share, left=left.words())

        return run_package(project, out, folder=folder, announce=announce, shared=shared)


def _summary(report: dict[str, Any], out: Path) -> None:
    from rich.console import Console

    from fabrication.summary import defaults_line, summary_lines

    console = Console(highlight=False, soft_wrap=True)
    console.print(f"[bold]{_plain(report['name'])}[/bold]  {report['net']['status']}")
    for line in summary_lines(report):
        console.print(f"  {line}")
    _print_findings(console, report["findings"])
    if report.get("defaults"):
        console.print(f"  [dim]{_plain(defaults_line(report['defaults']))}[/]")
    console.print(f"  {sum(report['timing'].values()):.1f} s; written to {_plain(str(out))}")


def _print_findings(console: Console, findings: list[dict[str, Any]]) -> None:
    """One line for each kind of finding: the worst of its kind, and how many more there are."""
    colours = {"error": "red", "warning": "yellow", "info": "cyan"}
    kinds: dict[tuple[str, str], list[dict[str, Any]]] = {}
    for finding in findings:
        kinds.setdefault((finding["severity"], finding["code"]), []).append(finding)
    for (severity, code), same in kinds.items():
        worst = max(same, key=_excess)
        line = f"  [{colours[severity]}]{severity}[/] {code}: {_plain(worst['message'])}"
        more = f" And {len(same) - 1} more like this, see report.html." if len(same) > 1 else ""
        console.print(line + more)


def _excess(finding: dict[str, Any]) -> float:
    """How many times a value is over its limit, or under it where it is too small."""
    low, high = sorted((float(finding["value"]), float(finding["limit"])))
    return high / low if low > 0.0 else float("inf")


def _plain(text: str) -> str:
    from rich.markup import escape

    return escape(text)


def _fail(message: str, code: int) -> NoReturn:
    typer.echo(f"gridshell: {message}", err=True)
    sys.exit(code)
