"""How long a run still takes: from the share of a stage that is done, and from an earlier run.

Nothing is said where nothing is known.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

_LEAST_SHARE, _LEAST_SECONDS = 0.1, 0.5
"""Of a stage that are done before its end is told from them."""


@dataclass
class TimeLeft:
    """The time left of a run whose stages are told one by one.

    Parameters
    ----------
    expected : seconds of each stage, in the order of an earlier run; empty where there was none.
    now : the clock, seconds.
    """

    expected: Mapping[str, float]
    now: Callable[[], float] = time.monotonic
    stage: str = ""
    share: float = 0.0
    _since: float = 0.0
    _done: set[str] = field(default_factory=set)

    def begin(self, stage: str) -> None:
        """The next stage begins."""
        self._done.add(self.stage)
        self.stage, self.share, self._since = stage, 0.0, self.now()

    def reach(self, share: float) -> None:
        """So much of the stage is done, 0 to 1."""
        self.share = min(max(share, self.share), 1.0)

    def seconds(self) -> float | None:
        """Until the end of the run; of this stage alone where no earlier run is known; or None."""
        here = self._of_stage()
        if not self.expected:
            return here
        if self.stage not in self.expected and here is None:
            return None
        to_come = (
            seconds
            for name, seconds in self.expected.items()
            if name != self.stage and name not in self._done
        )
        return (here or 0.0) + sum(to_come)

    def _of_stage(self) -> float | None:
        spent = self.now() - self._since
        if self.share >= _LEAST_SHARE and spent >= _LEAST_SECONDS:
            return spent * (1.0 - self.share) / self.share
        known = self.expected.get(self.stage)
        return None if known is None else max(known - spent, 0.0)

    def words(self) -> str:
        """Such as "about 12 s left"; nothing where it is not known, or less than a second."""
        found = self.seconds()
        if found is None or found < 1.0:
            return ""
        if found >= 90.0:
            return f"about {found / 60.0:.0f} min left"
        return f"about {found:.0f} s left"


def times_before(out: Path) -> dict[str, float]:
    """Seconds of each stage of the run that wrote *out*; none where there was no such run."""
    try:
        times = json.loads((out / "report.json").read_text(encoding="utf-8"))["timing"]
        return {str(name): float(seconds) for name, seconds in times.items()}
    except (OSError, ValueError, LookupError, TypeError, AttributeError):
        return {}
