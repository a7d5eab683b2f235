"""The command ``gridshell optimize``: options in degrees and file units become a job."""

from __future__ import annotations

from enum import StrEnum
from math import radians
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from fabrication.optimize_job import OptimizeJob, OptimizeResult


class Net(StrEnum):
    """Kinds of nets by their name on the command line."""

    ASYMPTOTIC = "asymptotic"
    PLANAR = "planar"
    SYMMETRIC = "symmetric"


class On(StrEnum):
    """Whose stars or faces shall be planar."""

    EDGES = "edges"
    DIAGONALS = "diagonals"
    D1 = "d1"
    D2 = "d2"
    FACES = "faces"
    WHITE = "white"


class Mode(StrEnum):
    """What the input is."""

    PROJECT = "project"
    FORM = "form"


class Hold(StrEnum):
    """What holds the shape."""

    FREE = "free"
    PINNED = "boundary-pinned"
    GLIDE = "boundary-glide"


_PLANARITIES = {
    (Net.ASYMPTOTIC, On.EDGES): "EDGE_STARS",
    (Net.ASYMPTOTIC, On.DIAGONALS): "DIAGONAL_STARS",
    (Net.ASYMPTOTIC, On.D1): "FIRST_DIAGONAL_STARS",
    (Net.ASYMPTOTIC, On.D2): "SECOND_DIAGONAL_STARS",
    (Net.PLANAR, On.FACES): "FACES",
    (Net.PLANAR, On.WHITE): "WHITE_FACES",
    (Net.SYMMETRIC, On.DIAGONALS): "SPHERICAL_STARS",
}
_USUAL = {Net.ASYMPTOTIC: On.DIAGONALS, Net.PLANAR: On.WHITE, Net.SYMMETRIC: On.DIAGONALS}


def optimize(
    mesh: Annotated[
        Path,
        typer.Argument(metavar="IN", help="Any quad mesh: OBJ, .3dm of Rhino, JSON of COMPAS."),
    ],
    unit: Annotated[str, typer.Option(help="Unit of the files: mm, cm, m, inch, foot.")],
    out: Annotated[Path, typer.Option("--out", "-o", metavar="OUT.obj", help="The exact net.")],
    net: Annotated[Net, typer.Option(help="Kind of net.")] = Net.ASYMPTOTIC,
    on: Annotated[
        On | None,
        typer.Option(help="Planar stars: edges, diagonals, d1, d2. Planar quads: faces, white."),
    ] = None,
    angle: Annotated[
        str | None,
        typer.Option(
            help="Node angle in degrees; 90:60 changes it from the centre outwards; or a formula "
            "of x, y, z and r (mm from the origin), as '90 - 30 * r / 4000'."
        ),
    ] = None,
    angle_between: Annotated[
        str | None, typer.Option(help="Bounds of the node angle in degrees, as 60:90.")
    ] = None,
    near_rhombi: Annotated[
        bool, typer.Option("--near-rhombi", help="As near to rhombi as stars and angle allow.")
    ] = False,
    rhombus: Annotated[bool, typer.Option("--rhombus", help="Equal diagonals (eq. 5).")] = False,
    square: Annotated[bool, typer.Option("--square", help="Rhombi at right angles.")] = False,
    reference: Annotated[
        Path | None,
        typer.Option(
            metavar="SURFACE",
            help="Surface to stay close to, any that remesh reads, in the same unit or its own.",
        ),
    ] = None,
    mode: Annotated[
        Mode,
        typer.Option(help="project: move as little as possible. form: find a new form, fairly."),
    ] = Mode.PROJECT,
    anchor: Annotated[Hold, typer.Option(help="What holds the shape.")] = Hold.FREE,
    report: Annotated[
        Path | None, typer.Option(metavar="R.json", help="Figures and history.")
    ] = None,
    steps: Annotated[int, typer.Option(help="Factorisations at most.")] = 60,
    tolerance: Annotated[
        float | None, typer.Option(help="Largest residual at unit mean edge; 1e-9 if not given.")
    ] = None,
    paper: Annotated[bool, typer.Option("--paper", help="The paper's own formulation.")] = False,
    threads: Annotated[int | None, typer.Option(help="Of the linear solver.")] = None,
    portable: Annotated[bool, typer.Option("--portable", help="SciPy alone.")] = False,
    state: Annotated[
        Path | None, typer.Option(metavar="FILE.npz", help="Write where the solve was left.")
    ] = None,
    resume: Annotated[
        Path | None, typer.Option(metavar="FILE.npz", help="Go on from such a file.")
    ] = None,
    verbose: Annotated[bool, typer.Option("--verbose", "-v", help="A line per step.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print errors only.")] = False,
) -> None:
    """Make any quad mesh an exact net: planar stars or faces at a chosen node angle.

    Ends with 0 when the net is exact, 1 when it could not be reached, 2 when the input is unusable.
    With 1 the best net found is written, and the report says why it is not the one asked for.
    """
    import gridshell as gs
    from fabrication.optimize_job import OptimizeJob, optimize_job, write_result

    anchors: dict[Hold, gs.Anchor] = {
        Hold.FREE: gs.Free(),
        Hold.PINNED: gs.BoundaryPinned(),
        Hold.GLIDE: gs.BoundaryGlide(),
    }
    job = OptimizeJob(
        mesh=mesh,
        unit=gs.Unit.named(unit),
        planarity=gs.Planarity[_planarity(net, on or _USUAL[net])],
        angle=() if _is_formula(angle) else _angles(angle),
        formula=angle if _is_formula(angle) else None,
        between=_bounds(angle_between),
        near_rhombi=near_rhombi,
        rhombus=rhombus,
        square=square,
        reference=reference,
        project=mode is Mode.PROJECT,
        anchor=anchors[anchor],
        steps=steps,
        tolerance=tolerance,
        engine=gs.Engine(portable=portable, threads=threads),
        paper=paper,
        resume=resume,
    )
    result = _with_progress(optimize_job, job, quiet)
    write_result(result, job, out, report)
    if state is not None:
        gs.write_state(state, result.net.state)
    if not quiet:
        typer.echo(result.net.report() if verbose else _summary(result, out))
    if result.net.end is gs.End.INTERRUPTED:
        raise typer.Exit(130)
    if not result.net.converged:
        if quiet:
            typer.echo(f"gridshell: {_summary(result, out)}", err=True)
        raise typer.Exit(1)


def _planarity(net: Net, on: On) -> str:
    from gridshell.errors import SettingError

    if (net, on) not in _PLANARITIES:
        choices = ", ".join(o.value for n, o in _PLANARITIES if n is net)
        raise SettingError(
            f"A net that is {net.value} cannot be planar on its {on.value}",
            where="--on",
            limit=choices,
        )
    return _PLANARITIES[net, on]


def _is_formula(text: str | None) -> bool:
    """Whether the text names a variable: what is no number and no pair of them."""
    return text is not None and any(name in text for name in "xyzr")


def _bounds(text: str | None) -> tuple[float, float] | None:
    from gridshell.errors import SettingError

    found = _angles(text, "--angle-between")
    if len(found) == 1:
        raise SettingError(
            "Bounds of the node angle are two angles",
            where="--angle-between",
            value=repr(text),
            limit="degrees as in 60:90",
        )
    return (found[0], found[1]) if found else None


def _angles(text: str | None, option: str = "--angle") -> tuple[float, ...]:
    from gridshell.errors import SettingError

    if text is None:
        return ()
    try:
        values = tuple(float(part) for part in text.split(":"))
    except ValueError:
        values = ()
    if len(values) not in (1, 2) or not all(0.0 < value < 180.0 for value in values):
        raise SettingError(
            "The node angle cannot be used",
            where=option,
            value=repr(text),
            limit="degrees between 0 and 180, or two of them as in 90:60",
        )
    return tuple(radians(value) for value in values)


def _with_progress(work: Any, job: OptimizeJob, quiet: bool) -> OptimizeResult:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    console = Console(stderr=True, quiet=quiet)
    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    silent = quiet or not console.is_terminal
    with Progress(*columns, console=console, transient=True, disable=silent) as bar:
        task = bar.add_task("reading", total=job.steps)

        def heard(number: int, step: Any) -> None:
            worst = max(step.residuals.values(), default=0.0)
            bar.update(task, completed=number, description=f"step {number}  {worst:.1e}")

        found: OptimizeResult = work(job, heard)
        return found


def _summary(result: OptimizeResult, out: Path) -> str:
    net, found = result.report["net"], result.net
    planar = (
        found.quality.star_planarity or found.quality.face_planarity or found.quality.sphericity
    )
    figures = [f"planarity {planar.max:.1e}"] if planar else []
    if found.quality.angle_error_deg is not None:
        figures.append(f"angle error {found.quality.angle_error_deg.max:.1e} degrees")
    if found.quality.surface_distance_mm is not None:
        figures.append(f"distance {found.quality.surface_distance_mm.max:.4g} mm")
    edges = net["edge_ratio"]
    figures.append(f"edges {edges['min']:.2f} to {edges['max']:.2f} of their mean")
    lines = [found.status, "  " + ", ".join(figures) + f"; {net['seconds']:.2f} s"]
    if net["way"] != "as asked":
        lines.append(f"  Found by {net['way']}.")
    if found.verdict is not None:
        lines.append(f"  {found.verdict.message}")
    return "\n".join([*lines, *(f"  {remark}" for remark in net["remarks"]), f"  written to {out}"])
