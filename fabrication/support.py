"""Support plates: between neighbouring nodes, from axis to axis (Fig. 3 of the paper).

A plate is flat when its edge and the axes at its two ends lie in one plane. Where they do not, the
plate must be twisted into its place, and what that takes is in the plate: with height h, thickness
t, length L, rate r = twist / L and G = E / 2.6,

* shear (St Venant)          G t r
* moment at the ends         G h t^3 / 3 r
* stretch of the long edges  r^2 (h / 2)^2 / 2
* stress of that stretch     E r^2 h^2 / 12, after the plate has shortened (see ``checks``)
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from fabrication.finding import Finding, Severity
from fabrication.grouping import Group, equal_groups
from fabrication.outlines import Frame, best_frame, inset, polygon_area
from fabrication.stock import Material, require_positive
from gridshell import PanelMesh, SettingError
from gridshell.arrays import Floats, Points, frozen

FLATNESS = 5e-5
"""A plate counts as flat up to this distance from its plane over its length: 0.05 mm on 1 m."""

_SHEAR_RATIO = 2.6
_MM3_KG_PER_M3 = 1e-9


@dataclass(frozen=True)
class PlateSection:
    """How support plates are made.

    Parameters
    ----------
    below, above : the long edges' places along the node axes, mm from the net; below < above.
    thickness : mm.
    material : what they are made of.
    setback : from the node axis to the plate's end, mm: the radius at which the connector's slots
        have their floors, or of what the plates are welded to.

    Raises
    ------
    SettingError
        For an empty height, a thickness that is not positive, or a negative setback.
    """

    below: float
    above: float
    thickness: float
    material: Material
    setback: float = 0.0

    def __post_init__(self) -> None:
        require_positive("thickness", self.thickness)
        if not (np.isfinite([self.below, self.above]).all() and self.below < self.above):
            raise SettingError(
                "A plate needs a height",
                where="below, above",
                value=f"{self.below:g}, {self.above:g} mm",
                limit="below < above",
                advice="below = -200, above = 0",
            )
        if not (np.isfinite(self.setback) and self.setback >= 0.0):
            raise SettingError(
                "A distance cannot be negative", where="setback", value=f"{self.setback} mm"
            )

    @property
    def height(self) -> float:
        """Between the long edges, along the axes, mm."""
        return self.above - self.below


@dataclass(frozen=True, eq=False)
class SupportPlate:
    """One plate.

    Parameters
    ----------
    mark : "S1", "S2", ...: the number of the edge plus one.
    edge : index of the net's edge.
    nodes : its ends i and j.
    corners : (4, 3) below i, below j, above j, above i, on the node axes, mm.
    frame : the corners' best plane; x along the edge, y towards the positive side.
    face : (4, 2) the corners in it.
    outline : (4, 2) what is cut: the face, its two ends set back from the axes, mm.
    length : between the nodes, mm.
    axis_angle : between the two axes, radians.
    twist : turn about the edge, right-handed, from the plane of edge and axis at i to that at j.
    out_of_plane : distance of every corner from the best plane, mm; no plane makes the largest
        one smaller.
    partial : an end's axis comes from an incomplete ring, at the rim.
    thickness : mm.
    mass : kg.
    """

    mark: str
    edge: int
    nodes: tuple[int, int]
    corners: Points
    frame: Frame
    face: Floats
    outline: Floats
    length: float
    axis_angle: float
    twist: float
    out_of_plane: float
    partial: bool
    thickness: float
    mass: float

    @property
    def flat(self) -> bool:
        """Whether it is flat to :data:`FLATNESS`."""
        return self.out_of_plane <= FLATNESS * self.length

    def in_space(self) -> Points:
        """(4, 3) the outline at its place, mm."""
        return self.frame.place(self.outline)


@dataclass(frozen=True)
class TwistCost:
    """What it takes to twist a plate into its place.

    Parameters
    ----------
    rate : rad/mm.
    shear, stretch : stresses, N/mm2.
    edge_strain : of the long edges over the middle.
    moment : at either end, N mm.
    """

    rate: float
    shear: float
    stretch: float
    edge_strain: float
    moment: float


def supports(mesh: PanelMesh, section: PlateSection) -> tuple[SupportPlate, ...]:
    """One plate per edge of *mesh*, in the order of its edges.

    Raises
    ------
    SettingError
        Naming the first plate whose setbacks or leaning axes leave nothing of it.
    """
    i, j = mesh.edges.T
    run = mesh.vertices[j] - mesh.vertices[i]
    first, second = np.cross(run, mesh.axes[i]), np.cross(run, mesh.axes[j])
    length = mesh.edge_lengths
    about = np.einsum("mc,mc->m", np.cross(first, second), run) / length
    twist = np.arctan2(about, np.einsum("mc,mc->m", first, second))
    apart = np.linalg.norm(np.cross(mesh.axes[i], mesh.axes[j]), axis=1)
    angle = np.arctan2(apart, np.einsum("mc,mc->m", mesh.axes[i], mesh.axes[j]))
    return tuple(
        _plate(mesh, section, edge, float(twist[edge]), float(angle[edge]))
        for edge in range(len(mesh.edges))
    )


def plate_groups(
    plates: Sequence[SupportPlate], tolerance: float, *, mirror: bool = True
) -> tuple[Group, ...]:
    """Plates that are equal within *tolerance* mm at every corner: "H1", "H2", ..."""
    return equal_groups([p.outline for p in plates], tolerance, prefix="H", mirror=mirror)


def twist_cost(plate: SupportPlate, section: PlateSection) -> TwistCost:
    """The formulas at the head of this module."""
    rate = abs(plate.twist) / plate.length
    shear_modulus = section.material.modulus / _SHEAR_RATIO
    height, thickness = section.height, section.thickness
    return TwistCost(
        rate=rate,
        shear=shear_modulus * thickness * rate,
        stretch=section.material.modulus * rate**2 * height**2 / 12.0,
        edge_strain=rate**2 * (height / 2.0) ** 2 / 2.0,
        moment=shear_modulus * height * thickness**3 / 3.0 * rate,
    )


def support_findings(plates: Sequence[SupportPlate], section: PlateSection) -> tuple[Finding, ...]:
    """``support-twist`` for every plate that is not flat, and what it takes to put it there.

    An error where the material does not bear the twist, a warning where it takes more than half of
    its strength, a note otherwise.
    """
    return tuple(finding for plate in plates for finding in _twisted(plate, section))


def plate_mark(edge: int) -> str:
    """The mark of an edge's plate."""
    return f"S{edge + 1}"


def _plate(
    mesh: PanelMesh, section: PlateSection, edge: int, twist: float, angle: float
) -> SupportPlate:
    i, j = mesh.edges[edge].tolist()
    p, q, up, on = mesh.vertices[i], mesh.vertices[j], mesh.axes[i], mesh.axes[j]
    below, above = section.below, section.above
    corners = np.stack([p + below * up, q + below * on, q + above * on, p + above * up])
    frame = best_frame(corners, q - p)
    face = frame.flat(corners)
    outline = inset(face, np.array([0.0, section.setback, 0.0, section.setback]))
    length = float(np.linalg.norm(q - p))
    if outline is None:
        raise SettingError(
            "A support plate has nothing sound left between its nodes",
            where=f"plate {plate_mark(edge)}, nodes {i} and {j}, {length:.1f} mm apart",
            value=f"{section.setback:g} mm set back at either end",
            limit="two ends that do not meet within the plate's height",
            advice="a smaller setback, a lower plate, or a coarser net",
        )
    return SupportPlate(
        mark=plate_mark(edge),
        edge=edge,
        nodes=(i, j),
        corners=frozen(corners),
        frame=frame,
        face=frozen(face),
        outline=frozen(outline),
        length=length,
        axis_angle=angle,
        twist=twist,
        out_of_plane=float(np.abs(frame.distance(corners)).max()),
        partial=bool(mesh.partial[i] or mesh.partial[j]),
        thickness=section.thickness,
        mass=polygon_area(outline) * section.thickness * section.material.density * _MM3_KG_PER_M3,
    )


def _twisted(plate: SupportPlate, section: PlateSection) -> Iterator[Finding]:
    if plate.flat:
        return
    cost = twist_cost(plate, section)
    strength = section.material.strength
    # von Mises, both at their worst: the long edge
    stress = float(np.sqrt(cost.stretch**2 + 3.0 * cost.shear**2))
    bears = stress <= strength
    mild = Severity.INFO if stress <= strength / 2.0 else Severity.WARNING
    advice = "A" if bears else "Use a thinner plate, or a"
    rim = " At the rim the net must be free to move, too." if plate.partial else ""
    yield Finding(
        "support-twist",
        mild if bears else Severity.ERROR,
        plate.mark,
        plate.out_of_plane,
        FLATNESS * plate.length,
        "mm",
        f"{plate.mark} is not flat: its corners lie {plate.out_of_plane:.3g} mm off their plane, a "
        f"twist of {np.degrees(abs(plate.twist)):.3g} degrees over {plate.length:.0f} mm. Twisting "
        f"it in takes {cost.moment / 1000.0:.3g} N m at either end, {stress:.3g} N/mm2 and "
        f"{cost.edge_strain:.1e} of edge strain; {section.material.name} "
        f"{'bears' if bears else 'does not bear'} that ({strength:g} N/mm2). "
        f"{advice} node angle of 90 degrees makes plates flat; torsion-free axes do, too, "
        f"but lean.{rim}",
    )
