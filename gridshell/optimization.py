"""From a control mesh to an exact net: normalise, pose, solve, scale back."""

from __future__ import annotations

from dataclasses import dataclass

from gridshell.anchors import Anchor
from gridshell.arrays import Points
from gridshell.errors import MeshError, SolveError
from gridshell.mesh import ControlMesh
from gridshell.quality import NetQuality, net_quality
from gridshell.recipes import Recipe
from gridshell.solve import Progress, Step, solve
from gridshell.surface import Foot, Surface


@dataclass(frozen=True, eq=False)
class OptimizedNet:
    """The end of an optimisation.

    Parameters
    ----------
    control : the control mesh where the solver stopped, in the units it came in.
    converged : whether every goal reached the tolerance.
    status : one sentence.
    steps : the history, one entry per factorisation.
    quality : what the net is judged by.
    """

    control: ControlMesh
    converged: bool
    status: str
    steps: tuple[Step, ...]
    quality: NetQuality

    def require(self) -> OptimizedNet:
        """Itself, or SolveError with the status sentence."""
        if not self.converged:
            raise SolveError(
                self.status.rstrip("."),
                advice="another angle, a start closer to the net, or a freer anchor",
            )
        return self


def optimize(
    control: ControlMesh,
    recipe: Recipe,
    *,
    anchor: Anchor,
    reference: Surface | None = None,
    progress: Progress | None = None,
) -> OptimizedNet:
    """Move the vertices of *control* until its diagonal meshes meet the recipe.

    The mesh is scaled to mean edge 1 around its centroid, so the result does not depend on units
    or on the distance from the origin.

    Parameters
    ----------
    control : the start.
    recipe : the conditions, e.g. ``a_net(angle=radians(60))``.
    anchor : what holds the shape: Free(), Pinned(...), BoundaryPinned() or BoundaryGlide().
    reference : surface to stay close to, same units as the mesh.
    progress : called after every step with its number and the step.

    Raises
    ------
    MeshError
        When all vertices coincide.
    SettingError
        When the anchor names a vertex that does not exist.
    SolveError
        When the linear system cannot be factored.
    """
    used = control.mesh.valence > 0
    centre, scale = control.vertices[used].mean(axis=0), control.mesh.mean_edge
    if not scale > 0.0:
        raise MeshError("All vertices of the mesh coincide", value="mean edge 0 mm")
    x = (control.vertices - centre) / scale
    posed = control.moved(x)
    surface = None if reference is None else _Scaled(reference, centre, scale)
    problem, start = recipe.problem(posed, x, anchor.hold(posed, x), surface)
    solution = solve(problem, start, recipe.stop, progress)
    moved = solution.x[: x.size].reshape(-1, 3) * scale + centre
    result = control.moved(moved)
    quality = net_quality(result, angle=recipe.angle, reference=reference)
    return OptimizedNet(result, solution.converged, solution.status, solution.steps, quality)


@dataclass(frozen=True, eq=False)
class _Scaled:
    """A surface seen in the solver's units."""

    surface: Surface
    centre: Points
    scale: float

    def closest(self, points: Points) -> Foot:
        foot = self.surface.closest(points * self.scale + self.centre)
        return Foot(
            (foot.points - self.centre) / self.scale, foot.normals, foot.curvature * self.scale
        )
