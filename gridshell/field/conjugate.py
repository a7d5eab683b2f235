"""Conjugate directions with a given angle between them: eqs. 1-3, one choice for all K."""

from __future__ import annotations

import enum
from collections.abc import Sequence

import numpy as np

from gridshell.arrays import Floats, Mask
from gridshell.errors import AngleInfeasibleError, SettingError
from gridshell.field.frame_field import FrameField
from gridshell.field.guides import Guide, guided, require_directions
from gridshell.field.principal_frames import PrincipalFrames, principal_frames
from gridshell.surface.curved_mesh import CurvedMesh
from gridshell.surface.triangle_mesh import TriangleMesh, place

_RIGHT_ANGLE = 1e-12
"""Cosines below this are rounding: the angle is 90 degrees, possible at umbilics too."""


class Hand(enum.Enum):
    """Which of the two mirror-symmetric pairs of eq. 3; the same over the whole surface.

    It does not depend on the side the normals point to; a mirrored surface has the other one.
    Where K < 0, both directions of the pair tend to the asymptotic line of that torsion as the
    angle tends to 0.
    """

    LEFT = -1
    RIGHT = 1


class Infeasible(enum.Enum):
    """What to do where the surface has no conjugate pair of the angle asked for (K > 0)."""

    WIDEN = "conjugate"
    """Keep the pair conjugate: open the angle to the nearest one there is."""
    CLAMP = "angle"
    """Keep the angle, as close to conjugate as it can be."""
    REFUSE = "refuse"
    """Raise AngleInfeasibleError."""


def conjugate_field(
    curved: CurvedMesh,
    angle: float,
    *,
    hand: Hand = Hand.RIGHT,
    where_infeasible: Infeasible = Infeasible.WIDEN,
    guides: Sequence[Guide] = (),
) -> FrameField:
    """Conjugate directions that form *angle*, rad, from family 1 to family 2.

    Eq. 3 with kappa1 <= kappa2 signed: cos(2 phi + angle) = (H / D) cos(angle); the directions are
    at phi and phi + angle from e1, mirrored in e1 for the left hand. Continuous through K = 0, and
    turning the surface inside out gives the same lines with the families swapped.

    Parameters
    ----------
    hand : one of the two mirror-symmetric solutions.
    where_infeasible : what stands in where K > 0 allows no such pair, always so at umbilics unless
        the angle is 90 degrees. The triangles are marked in the field.
    guides : lines that decide where curvature does not.

    Raises
    ------
    SettingError
        When *angle* is not inside (0, pi).
    FlatSurfaceError, UmbilicRegionError
        As for principal directions.
    AngleInfeasibleError
        With ``Infeasible.REFUSE``, where a triangle has no such pair.
    """
    if not 0.0 < angle < np.pi:
        raise SettingError(
            "The angle of a conjugate net must lie between 0 and 180 degrees",
            where="angle",
            value=f"{np.degrees(angle):.6g} degrees",
            limit="more than 0 and less than 180 degrees",
        )
    require_directions(curved, guides)
    frames = principal_frames(curved)
    cosine = 0.0 if abs(np.cos(angle)) < _RIGHT_ANGLE else float(np.cos(angle))
    infeasible = np.abs(frames.mean * cosine) > frames.half
    if where_infeasible is Infeasible.REFUSE and infeasible.any():
        raise _refusal(curved.mesh, frames, angle, infeasible)
    opening = np.full(len(infeasible), angle)
    if where_infeasible is Infeasible.WIDEN:
        least = smallest_angle(frames)[infeasible]
        opening[infeasible] = least if angle < np.pi / 2.0 else np.pi - least
    wanted = np.clip(frames.mean * cosine, -frames.half, frames.half)
    fallback = np.sign(frames.mean * cosine)
    ratio = np.where(frames.half > 0.0, wanted / np.where(frames.half > 0.0, frames.half, 1.0), 0.0)
    ratio = np.where(infeasible, fallback, ratio)
    phi = (np.arccos(ratio) - opening) / 2.0
    first = frames.axis + (phi if hand is Hand.RIGHT else -phi - opening)
    return guided(curved, FrameField(curved.mesh, first, first + opening, infeasible), guides)


def smallest_angle(frames: PrincipalFrames) -> Floats:
    """(f,) smallest angle of a conjugate pair, rad: 2 gamma = arccos(D / |H|), 0 where K <= 0.

    The pair that has it are the characteristic directions.
    """
    mean = np.abs(frames.mean)
    elliptic = mean > frames.half
    return np.asarray(np.arccos(np.where(elliptic, frames.half / np.where(elliptic, mean, 1.0), 1)))


def _refusal(
    mesh: TriangleMesh, frames: PrincipalFrames, angle: float, infeasible: Mask
) -> AngleInfeasibleError:
    least = smallest_angle(frames)
    worst = int(np.argmax(np.where(infeasible, least, -1.0)))
    fraction = mesh.areas[infeasible].sum() / mesh.areas.sum()
    half, most, whole = np.degrees(np.percentile(least, [50, 95, 100]))
    return AngleInfeasibleError(
        f"The surface has no conjugate directions at {np.degrees(angle):.4g} degrees",
        where=f"triangle {worst} {place(mesh.centroids[worst])}, where the angle must be largest",
        value=f"{100.0 * fraction:.3g} % of the area is affected; the smallest possible angle is "
        f"{half:.1f} degrees for half of the triangles, {most:.1f} for 95 % and {whole:.1f} for "
        "all",
        limit="0 % of the area",
        advice="take an angle nearer to 90 degrees, or let the angle open there (Infeasible.WIDEN)",
    )
