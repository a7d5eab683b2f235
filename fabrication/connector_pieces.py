"""What connectors are made of: a cylinder each, or star plates at even distances on the axis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from fabrication.connector import Connector
from fabrication.outlines import Frame, outline_area
from fabrication.stock import require_positive
from gridshell import SettingError


@dataclass(frozen=True)
class StarSpec:
    """Star plates in place of a cylinder.

    Parameters
    ----------
    thickness : of a plate, mm.
    layers : plates per connector, the outer two flush with its ends.

    Raises
    ------
    SettingError
        For a thickness that is not positive, or fewer than two layers.
    """

    thickness: float
    layers: int = 2

    def __post_init__(self) -> None:
        require_positive("thickness", self.thickness)
        if self.layers < 2:
            raise SettingError(
                "A plate is held at two places at least",
                where="layers",
                value=f"{self.layers}",
                limit=">= 2",
            )


@dataclass(frozen=True, eq=False)
class ConnectorPiece:
    """A cylinder, or one star plate.

    Parameters
    ----------
    mark : the connector's; of star plates with "-1", "-2", ... from below.
    frame : the connector's, at the piece's lower side.
    height : along the axis, mm.
    """

    mark: str
    connector: Connector
    frame: Frame
    height: float

    @property
    def area(self) -> float:
        """Across the axis, mm2."""
        return outline_area(self.connector.section())


def connector_pieces(
    made: Sequence[Connector], middle: float, star: StarSpec | None
) -> tuple[ConnectorPiece, ...]:
    """The pieces of all connectors, in their order.

    Parameters
    ----------
    middle : place of the connectors' middle along the axes, mm from the net.
    """
    return tuple(piece for connector in made for piece in _pieces(connector, middle, star))


def _pieces(connector: Connector, middle: float, star: StarSpec | None) -> list[ConnectorPiece]:
    height = connector.spec.height
    low = middle - height / 2.0
    if star is None:
        return [ConnectorPiece(connector.mark, connector, _moved(connector.frame, low), height)]
    step = (height - star.thickness) / (star.layers - 1)
    return [
        ConnectorPiece(
            f"{connector.mark}-{layer + 1}",
            connector,
            _moved(connector.frame, low + layer * step),
            star.thickness,
        )
        for layer in range(star.layers)
    ]


def _moved(frame: Frame, distance: float) -> Frame:
    return Frame(frame.origin + distance * frame.normal, frame.x, frame.y)
