"""The command ``gridshell remesh``: options in degrees and file units become a wish."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from enum import StrEnum
from math import isfinite, radians
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    import gridshell as gs
    from fabrication.remesh_job import GuideFile, Remeshed, Wish

_USUAL_QUADS = 500


class Along(StrEnum):
    """Kinds of directions by their name on the command line."""

    ASYMPTOTIC = "asymptotic"
    PRINCIPAL = "principal"
    CONJUGATE = "conjugate"


class Side(StrEnum):
    """Which of the two mirror-symmetric pairs."""

    LEFT = "left"
    RIGHT = "right"


class Otherwise(StrEnum):
    """What to do where the surface has no such pair."""

    WIDEN = "widen"
    CLAMP = "clamp"
    REFUSE = "refuse"


class Reach(StrEnum):
    """How far the mesh goes at the boundary."""

    COVER = "cover"
    INSIDE = "inside"
    TRIMMED = "trimmed"


def remesh(
    surface: Annotated[
        Path,
        typer.Argument(
            metavar="SURFACE",
            help="OBJ, PLY, STL, GLB; STEP, IGES, BREP; or boundary curves alone (OBJ, CSV, STEP).",
        ),
    ],
    directions: Annotated[Along, typer.Option(help="What the edges shall follow.")],
    out: Annotated[Path, typer.Option("--out", "-o", metavar="M.obj", help="The quad mesh.")],
    unit: Annotated[
        str | None,
        typer.Option(help="Unit of the files: mm, cm, m, inch, foot. STEP and IGES state theirs."),
    ] = None,
    angle: Annotated[
        float | None,
        typer.Option(help="Degrees between conjugate directions; 90 gives the principal ones."),
    ] = None,
    hand: Annotated[
        Side | None, typer.Option(help="Which of the two conjugate pairs; right if not given.")
    ] = None,
    infeasible: Annotated[
        Otherwise | None,
        typer.Option(
            help="Where no conjugate pair has the angle: widen it (if not given), clamp, refuse."
        ),
    ] = None,
    quads: Annotated[
        int | None, typer.Option(metavar="N", help=f"How many quads, about; {_USUAL_QUADS}.")
    ] = None,
    edge: Annotated[
        float | None,
        typer.Option(metavar="LENGTH", help="Or the length of their edges, in the file's unit."),
    ] = None,
    extent: Annotated[
        Reach, typer.Option(help="Quads over the rim, inside only, or ending on the rim.")
    ] = Reach.COVER,
    guide: Annotated[
        list[str] | None,
        typer.Option(
            metavar="FILE[:FAMILY]",
            help="Polylines to follow where curvature leaves it open; family 1 or 2. Repeatable.",
        ),
    ] = None,
    report: Annotated[
        Path | None, typer.Option(metavar="R.json", help="Figures and findings.")
    ] = None,
    control: Annotated[
        Path | None, typer.Option(metavar="C.obj", help="The control mesh C too.")
    ] = None,
    pictures: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="A page to turn and one picture of every stage."),
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print errors only.")] = False,
) -> None:
    """Lay a quad mesh over any surface, its edges along two families of directions.

    Ends with 0 when the mesh is good, 1 when a finding is an error, 2 when the input is unusable.
    With 1 the mesh is written, and the report says what is wrong with it, and where.
    """
    import gridshell as gs
    from fabrication import remesh_job

    known = None if unit is None else gs.Unit.named(unit)
    drawn = known or gs.Unit.MM
    wish = remesh_job.Wish(
        directions=_directions(directions, angle, hand, infeasible),
        quads=_quads(quads, edge),
        edge=_edge(edge, drawn),
        extent=gs.Extent[extent.name],
        guides=tuple(_guide(text) for text in guide or ()),
    )
    remesh_job.require_outputs((out, report, control), pictures)
    try:
        with _busy(quiet):
            result = _found(surface, known, wish)
        remesh_job.write_remeshed(
            result,
            drawn,
            name=surface.name,
            out=out,
            report=report,
            control=control,
            pictures=pictures,
        )
    except KeyboardInterrupt:
        typer.echo("gridshell: Interrupted. Nothing was written.", err=True)
        raise typer.Exit(130) from None
    if not quiet:
        typer.echo(_summary(result, out))
    if not result.good:
        if quiet:
            typer.echo(f"gridshell: {_summary(result, out)}", err=True)
        raise typer.Exit(1)


@contextmanager
def _busy(quiet: bool) -> Iterator[None]:
    """Something that moves on a terminal."""
    from rich.console import Console

    console = Console(stderr=True)
    if quiet or not console.is_terminal:
        yield
        return
    with console.status("remeshing"):
        yield


def _found(surface: Path, unit: gs.Unit | None, wish: Wish) -> Remeshed:
    """The work; errors of settings name the option that was given."""
    import gridshell as gs
    from fabrication.remesh_job import remesh as work

    options = {"quads": "--quads", "edge": "--edge", "guides": "--guide", "unit": "--unit"}
    try:
        return work(surface, unit, wish)
    except gs.UnitError as error:
        advice = "add --unit, in which the file was drawn" if unit is None else error.advice
        raise gs.UnitError(
            error.what, where=error.where, value=error.value, limit=error.limit, advice=advice
        ) from None
    except gs.SettingError as error:
        raise gs.SettingError(
            error.what,
            where=options.get(error.where or "", error.where),
            value=error.value,
            limit=error.limit,
            advice=error.advice,
        ) from None


def _directions(
    along: Along, angle: float | None, hand: Side | None, infeasible: Otherwise | None
) -> gs.Directions:
    """Options that only conjugate directions have are refused with the others."""
    import gridshell as gs

    if along is Along.CONJUGATE:
        if angle is None:
            raise gs.SettingError(
                "Conjugate directions need an angle",
                where="--angle",
                limit="degrees between 0 and 180; 90 gives the principal directions",
                advice="add --angle",
            )
        if not 0.0 < angle < 180.0:
            raise gs.SettingError(
                "The angle cannot be used",
                where="--angle",
                value=f"{angle:g}",
                limit="degrees between 0 and 180",
            )
        return gs.Conjugate(
            radians(angle),
            gs.Hand[(hand or Side.RIGHT).name],
            gs.Infeasible[(infeasible or Otherwise.WIDEN).name],
        )
    for option, given in (("--angle", angle), ("--hand", hand), ("--infeasible", infeasible)):
        if given is not None:
            raise gs.SettingError(
                f"Only conjugate directions take {option}",
                where=option,
                value=f"{given} with --directions {along.value}",
                advice=f"leave it out, or --directions {Along.CONJUGATE.value}",
            )
    return gs.Asymptotic() if along is Along.ASYMPTOTIC else gs.Principal()


def _quads(quads: int | None, edge: float | None) -> int | None:
    from gridshell.errors import SettingError

    if quads is not None and edge is not None:
        raise SettingError(
            "The size of the quads must be given once", where="--quads, --edge", value="both"
        )
    if quads is not None and quads < 1:
        raise SettingError("The mesh needs quads", where="--quads", value=f"{quads}", limit=">= 1")
    return _USUAL_QUADS if quads is None and edge is None else quads


def _edge(edge: float | None, unit: gs.Unit) -> float | None:
    """*edge* in mm."""
    from gridshell.errors import SettingError

    if edge is None:
        return None
    if not (isfinite(edge) and edge > 0.0):
        raise SettingError(
            "The edges of the quads need a length", where="--edge", value=f"{edge:g}", limit="> 0"
        )
    return edge * unit.value


def _guide(text: str) -> GuideFile:
    """``FILE``, ``FILE:1`` or ``FILE:2``."""
    from fabrication.remesh_job import GuideFile

    name, colon, family = text.rpartition(":")
    if colon and family in ("1", "2"):
        return GuideFile(Path(name), int(family))
    return GuideFile(Path(text))


def _summary(result: Remeshed, out: Path) -> str:
    from fabrication.words import plural

    found, stray = result.made.report, result.made.report.alignment_deg
    low, _, high = found.edge_ratio
    angle = "{:.1f} to {:.1f}".format(*found.angle_deg[::2])
    lines = [
        f"{plural(found.quads, 'quad')}, {plural(len(found.singularities), 'singular point')}; "
        f"edges off the directions by {stray.mean:.2f} degrees on average, {stray.max:.1f} at most",
        f"  {found.coverage:.1%} of the surface covered, edges {low:.2f} to {high:.2f} of "
        f"{found.spacing_mm:.4g} mm, angles {angle} degrees; "
        f"{sum(result.seconds.values()):.2f} s",
    ]
    lines += [f"  {f.severity.value} {f.code}: {f.message} [{f.where}]" for f in result.findings]
    return "\n".join([*lines, f"  written to {out}"])
