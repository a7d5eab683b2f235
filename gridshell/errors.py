"""Every error a person can meet, drawn once.

::

    GridshellError                      base of everything this project raises on purpose
    ├── InputError (ValueError)         what was handed in cannot be used
    │   ├── MeshError                   the mesh is not a manifold, oriented quad mesh
    │   │   ├── NonManifoldError        an edge with three faces, a vertex with two fans
    │   │   ├── OrientationError        faces that cannot be oriented consistently (Moebius strip)
    │   │   ├── OddValenceError         a singularity of odd valence (Fig. 4 of the paper)
    │   │   └── ColouringError          a closed strip of odd length: D1 and D2 cannot be told apart
    │   ├── SurfaceError                the surface does not carry what is asked of it
    │   │   ├── NotHyperbolicError      an asymptotic net where Gaussian curvature is not negative
    │   │   ├── FlatSurfaceError        no curvature that could tell directions apart
    │   │   ├── UmbilicRegionError      curvature that is the same in all directions, over an area
    │   │   ├── AngleInfeasibleError    no conjugate directions with the angle asked for
    │   │   ├── PoleSingularityError    lines that all run into, or around, one point
    │   │   ├── TooManySingularitiesError   noise, or quads larger than the shape
    │   │   ├── TargetTooCoarseError    quads larger than the surface, or than one of its necks
    │   │   ├── DegenerateSurfaceError  triangles without area, vertices that are not numbers
    │   │   ├── DisconnectedError       a surface in several pieces
    │   │   ├── SelfIntersectionError   a surface that cuts through itself
    │   │   ├── PoorTriangulationError  slivers whose curvature cannot be told
    │   │   ├── NoisyInputError         vertices that scatter too far about any smooth surface
    │   │   ├── NotOnePatchError        faces that are a solid, several patches, or none
    │   │   └── NoMinimalSurfaceError   boundary curves that no minimal surface of that kind spans
    │   ├── SettingError                a number or a choice outside its limits
    │   └── FileError (OSError)         a file that is missing, unreadable or malformed
    │       └── UnitError               a unit that is not stated, or contradicts the file's own
    └── SolveError (RuntimeError)       the optimisation ended without a usable net

Each carries *what* went wrong, *where* (key, index, position), the *value* found, the *limit* it
broke and what to *try*; the message is these five in one or two sentences.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial


class GridshellError(Exception):
    """Base of all errors raised on purpose.

    Parameters
    ----------
    what : one clause, no full stop.
    where : key, face or vertex index, position.
    value, limit : what was found and what is allowed, already formatted with units.
    advice : what to try, in the imperative.
    """

    def __init__(
        self,
        what: str,
        *,
        where: str | None = None,
        value: str | None = None,
        limit: str | None = None,
        advice: str | None = None,
    ) -> None:
        self.what, self.where, self.value = what, where, value
        self.limit, self.advice = limit, advice
        details = [
            f"{label}{text}"
            for label, text in (("at ", where), ("found ", value), ("allowed: ", limit))
            if text is not None
        ]
        message = what + (f" ({'; '.join(details)})" if details else "") + "."
        super().__init__(message + (f" Try: {advice}." if advice else ""))

    def __reduce__(self) -> tuple[Callable[..., GridshellError], tuple[str]]:
        """Pickle by the five parts, so that an error survives the way from another process."""
        parts = {key: getattr(self, key) for key in ("where", "value", "limit", "advice")}
        return partial(type(self), **parts), (self.what,)

    def __str__(self) -> str:
        return str(self.args[0])


class InputError(GridshellError, ValueError):
    """What was handed in cannot be used."""


class MeshError(InputError):
    """The mesh is not a manifold, oriented quad mesh."""


class NonManifoldError(MeshError):
    """An edge with more than two faces, or a vertex where two fans of faces meet."""


class OrientationError(MeshError):
    """Faces that cannot be oriented consistently."""


class OddValenceError(MeshError):
    """An interior vertex of odd valence: families cannot be continued (Fig. 4)."""


class ColouringError(MeshError):
    """A closed strip of odd length: the vertices cannot be coloured alternately."""


class SurfaceError(InputError):
    """The surface does not carry what is asked of it."""


class NotHyperbolicError(SurfaceError):
    """Asymptotic directions asked for where the Gaussian curvature is not negative."""


class FlatSurfaceError(SurfaceError):
    """A surface without curvature: nothing on it tells one direction from another."""


class UmbilicRegionError(SurfaceError):
    """A region that bends alike in all directions, as a sphere does: no principal directions."""


class AngleInfeasibleError(SurfaceError):
    """An elliptic region has no conjugate directions with the angle asked for."""


class PoleSingularityError(SurfaceError):
    """A point that lines of one family all run into, or around: no quad mesh follows them."""


class TooManySingularitiesError(SurfaceError):
    """Singular points too close together for the size of the quads: noise, or quads too large."""


class TargetTooCoarseError(SurfaceError):
    """Quads too large for the surface, or to go around one of its holes or necks."""


class DegenerateSurfaceError(SurfaceError):
    """Triangles without area, vertices that are not finite, no surface at all."""


class DisconnectedError(SurfaceError):
    """A surface in several pieces."""


class SelfIntersectionError(SurfaceError):
    """A surface that cuts through itself."""


class PoorTriangulationError(SurfaceError):
    """Slivers whose curvature cannot be told from their corners."""


class NoisyInputError(SurfaceError):
    """Vertices that scatter too far about any smooth surface."""


class NotOnePatchError(SurfaceError):
    """Faces that are a solid, several patches apart or branching, or no faces at all."""


class NoMinimalSurfaceError(SurfaceError):
    """Boundary curves that no minimal surface of the kind asked for spans."""


class SettingError(InputError):
    """A number or a choice outside its limits."""


class FileError(InputError, OSError):
    """A file that is missing, unreadable or malformed."""


class UnitError(FileError):
    """A unit that is not stated, or contradicts the one the file states."""


class SolveError(GridshellError, RuntimeError):
    """The optimisation ended without a usable net."""
