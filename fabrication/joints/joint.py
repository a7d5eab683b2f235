"""What a joint answers: everything that it makes of a design."""

from __future__ import annotations

from abc import ABC, abstractmethod

from fabrication.jointed import Jointed
from fabrication.structures import Structure


class Joint(ABC):
    """A way to connect lamellas at the nodes."""

    @abstractmethod
    def build(self, design: Structure) -> Jointed:
        """Strips, cuts, connectors, bill and findings on *design*.

        Raises
        ------
        SettingError
            When the joint's sizes cannot be made on the design's profile at all.
        """
