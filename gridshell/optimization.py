"""From a control mesh to an exact net: check, normalise, pose, solve, scale back, judge."""

from __future__ import annotations

from dataclasses import dataclass

from gridshell.anchors import Anchor
from gridshell.arrays import Points
from gridshell.errors import SolveError
from gridshell.mesh import ControlMesh
from gridshell.picture import card, sketch
from gridshell.pose import pose
from gridshell.quality import NetQuality, net_quality
from gridshell.recipes import Recipe
from gridshell.solve import End, Progress, State, Step, Workspace, history, solve
from gridshell.soundness import remarks, require_sound
from gridshell.surface import Surface
from gridshell.verdict import Verdict, verdict


@dataclass(frozen=True, eq=False)
class OptimizedNet:
    """The end of an optimisation.

    Parameters
    ----------
    control : the control mesh after the last step taken, in mm.
    end : why the solver stopped.
    status : one sentence.
    steps : the history, one entry per factorisation.
    quality : what the net is judged by.
    verdict : why this is not the net that was asked for; None when it is.
    remarks : sentences about what is odd about the mesh but harmless.
    state : to go on from with ``optimize(..., resume=state)``.
    memory : largest memory of a factorisation, MiB.
    """

    control: ControlMesh
    end: End
    status: str
    steps: tuple[Step, ...]
    quality: NetQuality
    verdict: Verdict | None
    remarks: tuple[str, ...]
    state: State
    memory: float

    @property
    def converged(self) -> bool:
        """Whether every goal reached the tolerance and the net kept its shape."""
        return self.end is End.CONVERGED and self.verdict is None

    def require(self) -> OptimizedNet:
        """Itself, or SolveError with status and verdict."""
        if not self.converged:
            what = self.status if self.verdict is None else f"{self.status} {self.verdict.message}"
            raise SolveError(
                what.rstrip("."),
                advice="another angle, a start closer to the net, a freer anchor, or more steps",
            )
        return self

    def report(self) -> str:
        """Status, verdict, remarks and the full history, for a terminal."""
        lines = [history(self.status, self.steps)]
        if self.verdict is not None:
            lines.append(self.verdict.message)
        return "\n".join([*lines, *self.remarks])

    def _repr_html_(self) -> str:
        """For notebooks."""
        from gridshell.mesh.showing import control_figures, control_layers

        layers, notes = control_layers(self.control)
        verdict = () if self.verdict is None else (self.verdict.message,)
        return card(
            "Optimised net" if self.converged else "Optimised net, not converged",
            [
                ("Status", self.status),
                ("Steps", f"{len(self.steps)}"),
                *control_figures(self.control),
                *_figures(self.quality),
            ],
            picture=sketch(layers, label="The net after its last step"),
            notes=(*verdict, *self.remarks, *notes),
        )


def optimize(
    control: ControlMesh,
    recipe: Recipe,
    *,
    anchor: Anchor,
    reference: Surface | None = None,
    progress: Progress | None = None,
    start: Points | None = None,
    resume: State | None = None,
    workspace: Workspace | None = None,
) -> OptimizedNet:
    """Move the vertices of *control* until they meet the recipe.

    The mesh is scaled to mean edge 1 around its centroid, so the result does not depend on units
    or on the distance from the origin. No step turns a quad over. Ctrl-C ends it after the last
    step taken.

    Parameters
    ----------
    control : the start.
    recipe : the conditions, e.g. ``a_net(angle=radians(60))``.
    anchor : what holds the shape: Free(), Pinned(...), BoundaryPinned() or BoundaryGlide().
    reference : surface to stay close to, mm.
    progress : called after every step with its number and the step.
    start : (n, 3) where to begin when not at *control* itself, whose places the anchor and
        closeness go on to mean, mm.
    resume : where an earlier call with the same control mesh and recipe was left.
    workspace : given to several calls one after the other, it spares what they have in common.

    Raises
    ------
    MeshError
        When the mesh is torn, folded or has quads without area; the place is named.
    SettingError
        When the anchor or a condition names what does not exist.
    SolveError
        When the linear system cannot be factored.
    """
    require_sound(control.mesh)
    posed = pose(control, anchor, reference, start=start)
    problem, x0 = recipe.problem(posed)
    solution = solve(problem, x0, recipe.stop, progress, resume=resume, workspace=workspace)
    moved = posed.outside(solution.x[: control.vertices.size].reshape(-1, 3))
    result = control.moved(moved)
    return OptimizedNet(
        result,
        solution.end,
        solution.status,
        solution.steps,
        net_quality(
            result,
            planarity=recipe.planarity,
            angle=recipe.angle,
            rhombus=recipe.rhombus,
            reference=reference,
        ),
        verdict(problem, solution, control, result, recipe.stop.tolerance),
        remarks(control.mesh),
        solution.state,
        solution.memory,
    )


def _figures(quality: NetQuality) -> list[tuple[str, str]]:
    """What should be nought, the largest of each; those that were not asked for are empty."""
    spreads = (
        ("Star planarity", quality.star_planarity, ""),
        ("Face planarity", quality.face_planarity, ""),
        ("Sphericity", quality.sphericity, ""),
        ("Angle error", quality.angle_error_deg, " degrees"),
        ("Rhombus error", quality.rhombus_error, ""),
        ("Distance to surface", quality.surface_distance_mm, " mm"),
    )
    low, high = quality.edge_ratio
    return [
        *(
            (f"{name}, largest", "" if spread is None else f"{spread.max:.3g}{unit}")
            for name, spread, unit in spreads
        ),
        ("Edges over their mean", f"{low:.2f} to {high:.2f}"),
    ]
