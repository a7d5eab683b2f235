"""From a mesh file to the exact net as a mesh file, with its report: the work of ``optimize``."""

from __future__ import annotations

import json
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

import gridshell as gs
from fabrication.whole_files import Write, text_file, write_whole

_QUADS_AT_FULL_ACCURACY = 10_000
"""Above it the default tolerance grows with the square of the number of quads: the softest motions
of a net of n quads have a stiffness that falls with n squared, and rounding shows in them."""

_TOLERANCE = 1e-9

_NEAR = 0.5
"""Mean move, in mean edges, up to which an exact net still counts as the input made exact."""


@dataclass(frozen=True)
class OptimizeJob:
    """What ``gridshell optimize`` was asked for; angles in radians.

    Parameters
    ----------
    mesh, unit : the input file, as `read_mesh` reads it, and the unit of both mesh files.
    planarity : what shall be flat.
    angle : none leaves it free; two angles make a field from the centre to the outermost quad.
    formula : of x, y, z and r in mm, in place of an angle.
    between : bounds of the angle.
    near_rhombi : as near to rhombi as stars and angle let the net be.
    rhombus, square : equal diagonals; at right angles.
    reference : surface file in the same unit, or in the one it states itself.
    project : an almost exact net moves as little as it can. False finds a new form.
    anchor : what holds the shape.
    steps, tolerance : when to stop; None adapts the tolerance to the size of the mesh.
    engine : the linear solver.
    paper : the paper's own formulation in place of the default.
    resume : state file of an earlier run.
    """

    mesh: Path
    unit: gs.Unit
    planarity: gs.Planarity
    angle: tuple[float, ...] = ()
    formula: str | None = None
    between: tuple[float, float] | None = None
    near_rhombi: bool = False
    rhombus: bool = False
    square: bool = False
    reference: Path | None = None
    project: bool = True
    anchor: gs.Anchor = gs.Free()  # noqa: RUF009 - a frozen value
    steps: int = 60
    tolerance: float | None = None
    engine: gs.Engine = gs.Engine()  # noqa: RUF009 - a frozen value
    paper: bool = False
    resume: Path | None = None


@dataclass(frozen=True, eq=False)
class OptimizeResult:
    """The net and the content of its report."""

    net: gs.OptimizedNet
    report: dict[str, Any]


def optimize_job(job: OptimizeJob, progress: gs.Progress | None = None) -> OptimizeResult:
    """Read, optimise and measure; nothing is written.

    A new form is found by way of coarser nets where the mesh has them. An almost exact net that
    cannot be reached by straightening its lines is tried once more with the fairness of its change,
    which is kept when it converges.

    Raises
    ------
    InputError
        For files that cannot be used, meshes that are torn or folded, and contradictory settings.
    """
    start = time.perf_counter()
    control = _read(job)
    read = time.perf_counter()
    recipe = _recipe(job, control)
    surface = None if job.reference is None else _reference(job.reference, job.unit)
    state = None if job.resume is None else gs.read_state(job.resume)

    def attempt(made: gs.Recipe) -> gs.OptimizedNet:
        if isinstance(made, gs.NetRecipe) and not job.project and state is None:
            return gs.optimize_coarse_to_fine(
                control,
                made,
                anchor=job.anchor,
                reference=surface,
                progress=progress and (lambda _, number, step: progress(number, step)),
            )
        return gs.optimize(
            control, made, anchor=job.anchor, reference=surface, progress=progress, resume=state
        )

    net, way = attempt(recipe), "as asked"
    if _hopeless(net) and isinstance(recipe, gs.NetRecipe) and job.project and state is None:
        other = attempt(_second_way(recipe))
        if other.converged:
            net, way = other, "keeping the shape of the lines, as straightening them failed"
    end = time.perf_counter()
    content = gs.net_report(net, job.planarity, seconds=end - read)
    move = _move(control, net.control)
    content["remarks"] += _far(move) if job.project else []
    report = {
        "net": {**content, "way": way, "move_edges": move},
        "history": gs.history_report(net),
        "timing": {"read": round(read - start, 3), "optimise": round(end - read, 3)},
    }
    return OptimizeResult(net, report)


def write_result(result: OptimizeResult, job: OptimizeJob, out: Path, report: Path | None) -> None:
    """Write the mesh in its own unit and the report, each whole or not at all.

    Raises
    ------
    OutputError
        When a file cannot be written.
    """
    mesh = result.net.control.mesh
    files: dict[Path, Write] = {out: lambda path: gs.write_obj(path, mesh, unit=job.unit)}
    if report is not None:
        files[report] = text_file(json.dumps(result.report, indent=2, allow_nan=False) + "\n")
    write_whole(files)


def _read(job: OptimizeJob) -> gs.ControlMesh:
    mesh = gs.read_mesh(job.mesh, unit=job.unit)
    own = job.planarity in (gs.Planarity.EDGE_STARS, gs.Planarity.FACES)
    angled = job.angle or job.formula is not None or job.between is not None
    if own and not angled and not job.rhombus and not job.square:
        return gs.without_families(mesh)
    return gs.as_control_mesh(mesh)


def _reference(path: Path, unit: gs.Unit) -> gs.Surface:
    return gs.read_design(path, unit=None if gs.states_unit(path) else unit)


def _recipe(job: OptimizeJob, control: gs.ControlMesh) -> gs.Recipe:
    angle = _angle(job, control)
    if job.paper:
        return gs.PaperRecipe(planarity=job.planarity, angle=angle, rhombus=job.rhombus)
    size = max(1.0, len(control.quads) / _QUADS_AT_FULL_ACCURACY)
    tolerance = _TOLERANCE * size**2 if job.tolerance is None else job.tolerance
    stop = gs.Stop(job.steps, tolerance, engine=job.engine)
    keep = not job.project
    if job.planarity.of_stars:
        recipe = gs.a_net(
            angle=angle,
            planarity=job.planarity,
            keep_shape=keep,
            conditions=_conditions(job),
        )
        recipe = replace(recipe, rhombus=job.rhombus or job.square)
    elif job.planarity is gs.Planarity.SPHERICAL_STARS:
        recipe = gs.principal_symmetric_net(angle=angle, keep_shape=keep)
    else:
        recipe = gs.pq_net(
            angle=angle,
            planarity=job.planarity,
            rhombus=job.rhombus,
            square=job.square,
            keep_shape=keep,
            conditions=_conditions(job),
        )
    return replace(recipe, stop=stop)


def _conditions(job: OptimizeJob) -> tuple[gs.AngleBetween | gs.NearRhombi, ...]:
    bounds = () if job.between is None else (gs.AngleBetween(*job.between),)
    return (*bounds, *((gs.NearRhombi(),) if job.near_rhombi else ()))


def _angle(job: OptimizeJob, control: gs.ControlMesh) -> gs.Angle | None:
    if job.formula is not None:
        return gs.FormulaAngle(job.formula)
    if len(job.angle) < 2:
        return job.angle[0] if job.angle else None
    centres = control.vertices[control.quads].mean(axis=1)
    centre = centres.mean(axis=0)
    reach = float(np.linalg.norm(centres - centre, axis=1).max())
    x, y, z = centre.tolist()
    return gs.RadialAngle((x, y, z), (0.0, reach), (job.angle[0], job.angle[1]))


def _move(before: gs.ControlMesh, after: gs.ControlMesh) -> dict[str, float]:
    """How far the vertices went, in mean edges of the input."""
    used = before.mesh.valence > 0
    away = np.linalg.norm(after.vertices[used] - before.vertices[used], axis=1)
    away /= before.mesh.mean_edge
    return {"max": float(away.max()), "mean": float(away.mean())}


def _far(move: dict[str, float]) -> list[str]:
    if move["mean"] <= _NEAR:
        return []
    return [
        f"No exact net was found near the input: this one is {move['mean']:.2f} edges away on "
        f"average, {move['max']:.2f} at most; up to {_NEAR} counts as near. The lines of the input "
        "do not run as those of such a net: draw or remesh them along its directions, or take "
        "this net as a new form."
    ]


def _hopeless(net: gs.OptimizedNet) -> bool:
    return not net.converged and net.end is not gs.End.INTERRUPTED


def _second_way(recipe: gs.NetRecipe) -> gs.NetRecipe:
    fairness, closeness = gs.Weight(0.1, 0.3), gs.Weight(1e-2, 0.1)
    return replace(recipe, keep_shape=True, fairness=fairness, closeness=closeness)
