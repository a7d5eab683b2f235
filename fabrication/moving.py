"""A net that moves, as part of a package: its files and its section of the report."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from fabrication.motion import Motion
from fabrication.motion_checks import motion_section


@dataclass(frozen=True, eq=False)
class Moving:
    """A net that moves.

    Parameters
    ----------
    motion : from one lock to the other.
    opening : of the position that is built.
    """

    motion: Motion
    opening: float

    def write(self, draft: Path, name: str) -> None:
        """A list, an animation, and a page with a slider."""
        from fabrication.export.motion_glb import write_motion_glb
        from fabrication.export.motion_page import write_motion_page
        from fabrication.export.motion_schedule import write_motion

        write_motion(draft / "motion.csv", self.motion)
        write_motion_glb(draft / "motion.glb", self.motion)
        write_motion_page(draft / "motion.html", self.motion, name=name, opening=self.opening)

    def sections(self) -> dict[str, object]:
        """For the report."""
        return {"motion": motion_section(self.motion)}
