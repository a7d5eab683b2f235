"""What a joint answers: the cuts it makes in every lamella, and its findings."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping

from fabrication.cut import Slot
from fabrication.finding import Finding
from fabrication.structures import Structure


class Joint(ABC):
    """A way to connect two lamellas at a node."""

    @abstractmethod
    def cuts(self, structure: Structure) -> Mapping[str, tuple[Slot, ...]]:
        """The slots of every lamella by its mark, in order along the strip."""

    @abstractmethod
    def findings(self, structure: Structure) -> tuple[Finding, ...]:
        """What a person should know about these joints."""
