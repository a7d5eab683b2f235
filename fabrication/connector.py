"""Node connectors: a cylinder or a stack of star plates with one radial slot per arm.

A support plate holds its node's axis, so its slot is straight, runs along the cylinder's axis and
points at it; the slots differ in their angles about the axis only. Two neighbouring slots of width
w at an angle b, with floors at radius r, leave a web of 2 r sin(b / 2) - w cos(b / 2) between them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from fabrication.finding import Finding, Severity
from fabrication.grouping import Group, equal_groups
from fabrication.outlines import Frame
from fabrication.stock import require_positive
from gridshell import PanelMesh, SettingError
from gridshell.arrays import Floats, frozen, unit

_CROWDED = "connector-crowded"


@dataclass(frozen=True)
class ConnectorSpec:
    """How connectors are made.

    Parameters
    ----------
    radius : of the cylinder or star plate, mm.
    height : along the axis, mm.
    plate_thickness : of the plates in the slots, mm.
    clearance : added to the slot's width, mm.
    depth : of the slots from the outside, mm.
    web : least material between two slots, mm; the plate's thickness unless said otherwise.

    Raises
    ------
    SettingError
        For a size that is not positive, or slots that reach the axis.
    """

    radius: float
    height: float
    plate_thickness: float
    clearance: float
    depth: float
    web: float | None = None

    def __post_init__(self) -> None:
        for key in ("radius", "height", "plate_thickness", "depth"):
            require_positive(key, getattr(self, key))
        if self.web is not None:
            require_positive("web", self.web)
        if not (np.isfinite(self.clearance) and self.clearance >= 0.0):
            raise SettingError(
                "A distance cannot be negative", where="clearance", value=f"{self.clearance} mm"
            )
        if not self.depth < self.radius:
            raise SettingError(
                "The slots reach the axis",
                where="depth",
                value=f"{self.depth:g} mm",
                limit=f"below the radius, {self.radius:g} mm",
                advice="shorter slots or a thicker connector",
            )
        if not self.slot_width < 2.0 * self.radius:
            raise SettingError(
                "A slot is wider than the connector",
                where="plate_thickness, clearance",
                value=f"{self.slot_width:g} mm",
                limit=f"below {2.0 * self.radius:g} mm",
                advice="a thinner plate or a thicker connector",
            )

    @property
    def slot_width(self) -> float:
        """Mm."""
        return self.plate_thickness + self.clearance

    @property
    def floor(self) -> float:
        """Radius of the slots' floors, mm."""
        return self.radius - self.depth

    @property
    def least_web(self) -> float:
        """Mm."""
        return self.plate_thickness if self.web is None else self.web


@dataclass(frozen=True)
class Arm:
    """One plate or beam at a node.

    Parameters
    ----------
    edge : index of the net's edge.
    node : at its other end.
    angle : of its slot, counter-clockwise about the axis from the frame's x, in [0, 2 pi), radians.
    slope : of the edge out of the connector's plane, upwards positive, radians.
    """

    edge: int
    node: int
    angle: float
    slope: float


@dataclass(frozen=True, eq=False)
class Connector:
    """The part at one node.

    Parameters
    ----------
    mark : "N1", "N2", ...: the node's number plus one.
    node : its index.
    frame : origin at the node, x towards the first arm, the normal along the node axis.
    arms : counter-clockwise about the axis, that of the smallest edge first.
    spec : sizes.
    """

    mark: str
    node: int
    frame: Frame
    arms: tuple[Arm, ...]
    spec: ConnectorSpec

    @property
    def slot_angles(self) -> Floats:
        """(k,) radians, ascending from 0."""
        return np.array([arm.angle for arm in self.arms])

    @property
    def between(self) -> Floats:
        """(k,) angle from each slot to the next, counter-clockwise, radians."""
        angles = self.slot_angles
        return np.diff(angles, append=angles[0] + 2.0 * np.pi)

    @property
    def webs(self) -> Floats:
        """(k,) material between each slot and the next at their floors, mm; the chord."""
        half = np.minimum(self.between, np.pi) / 2.0
        spec = self.spec
        return np.asarray(2.0 * spec.floor * np.sin(half) - spec.slot_width * np.cos(half))

    def section(self) -> Floats:
        """The outline across the axis: a disc with its slots.

        Returns
        -------
        (4 k, 3) rows x, y, bulge, counter-clockwise in the connector's frame; the bulge belongs to
        the piece from its corner to the next and is tan(sweep / 4) on the rim, 0 elsewhere.
        """
        spec, half = self.spec, self.spec.slot_width / 2.0
        mouth = float(np.sqrt(spec.radius**2 - half**2))
        lip = float(np.arcsin(half / spec.radius))
        rows = []
        for arm, between in zip(self.arms, self.between, strict=True):
            c, s = np.cos(arm.angle), np.sin(arm.angle)
            for r, side in ((mouth, -half), (spec.floor, -half), (spec.floor, half)):
                rows.append([r * c - side * s, r * s + side * c, 0.0])
            bulge = np.tan((between - 2.0 * lip) / 4.0)
            rows.append([mouth * c - half * s, mouth * s + half * c, bulge])
        return frozen(rows)


def connectors(mesh: PanelMesh, spec: ConnectorSpec) -> tuple[Connector, ...]:
    """One per node of *mesh*, in the order of its nodes."""
    arms: list[list[tuple[int, int]]] = [[] for _ in range(len(mesh.vertices))]
    for edge, (i, j) in enumerate(mesh.edges.tolist()):
        arms[i].append((edge, j))
        arms[j].append((edge, i))
    return tuple(_connector(mesh, spec, node, found) for node, found in enumerate(arms))


def connector_findings(made: Sequence[Connector]) -> tuple[Finding, ...]:
    """``connector-crowded`` where two slots leave too little between them."""
    return tuple(finding for connector in made for finding in _crowded(connector))


def connector_groups(made: Sequence[Connector], tolerance: float) -> tuple[Group, ...]:
    """Connectors whose sections are equal within *tolerance* mm, turned over or not: "K1", ..."""
    sections = [connector.section()[:, :2] for connector in made]
    return equal_groups(sections, tolerance, prefix="K", mirror=True)


def connector_mark(node: int) -> str:
    """The mark of a node's connector."""
    return f"N{node + 1}"


def _connector(
    mesh: PanelMesh, spec: ConnectorSpec, node: int, found: list[tuple[int, int]]
) -> Connector:
    axis = mesh.axes[node]
    run = mesh.vertices[[other for _, other in found]] - mesh.vertices[node]
    up = run @ axis
    level = run - up[:, None] * axis
    reach = np.linalg.norm(level, axis=1)
    lost = np.flatnonzero(reach <= 1e-9 * np.linalg.norm(run, axis=1))
    if len(lost):
        raise SettingError(
            "An edge runs along its node's axis",
            where=f"connector {connector_mark(node)}",
            limit="edges across the axes",
            advice="a net without folds",
        )
    x = unit(level[0])
    frame = Frame(mesh.vertices[node], x, np.cross(axis, x))
    angle = np.arctan2(level @ frame.y, level @ frame.x) % (2.0 * np.pi)
    angle[0] = 0.0
    slope = np.arctan2(up, reach)
    arms = [
        Arm(edge, other, float(angle[k]), float(slope[k])) for k, (edge, other) in enumerate(found)
    ]
    return Connector(
        mark=connector_mark(node),
        node=node,
        frame=frame,
        arms=tuple(sorted(arms, key=lambda arm: arm.angle)),
        spec=spec,
    )


def _crowded(connector: Connector) -> Iterator[Finding]:
    spec = connector.spec
    worst = int(np.argmin(connector.webs))
    web, between = float(connector.webs[worst]), float(connector.between[worst])
    if len(connector.arms) < 2 or web >= spec.least_web:
        return
    first = connector.arms[worst].edge
    second = connector.arms[(worst + 1) % len(connector.arms)].edge
    half = min(between, np.pi) / 2.0
    if np.sin(half) > 1e-6:
        floor = (spec.least_web + spec.slot_width * np.cos(half)) / (2.0 * np.sin(half))
        advice = f"a radius of {np.ceil(10.0 * (floor + spec.depth)) / 10.0:g} mm"
    else:
        advice = "a net whose edges do not run along each other"
    yield Finding(
        _CROWDED,
        Severity.ERROR,
        connector.mark,
        web,
        spec.least_web,
        "mm",
        f"The slots of edges {first + 1} and {second + 1} meet at {np.degrees(between):.1f} "
        f"degrees in {connector.mark} and leave {max(web, 0.0):.2f} mm between them. Use {advice}, "
        "shorter slots or a thinner plate.",
    )
