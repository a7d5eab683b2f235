"""The CAD kernel at work in a process of its own: make the solids, write STEP, read it back.

The kernel takes seconds to load and most of the time of a run. It loads while the net is designed,
and works beside the sheets and the fit on the other core. A kernel that crashes takes only its own
process along.
"""

from __future__ import annotations

import pickle
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from fabrication.errors import KernelError
from fabrication.outlines import Frame
from fabrication.parts import FlatPart
from fabrication.shapes import Bodies, Prisms, joined
from fabrication.structures import Structure
from gridshell import GridshellError

Lap = Callable[[str], None]
"""Ends a stage: its time is kept by its name."""


class Work(Protocol):
    """An order that can be sent to the process: plain data with one method."""

    def do(self, step: Path, lap: Lap) -> tuple[Any, ...]:
        """Make the solids, write them to *step*, and return what the file says of its parts."""


@dataclass(frozen=True, eq=False)
class LamellaWork:
    """The bent and twisted strips with their connectors, in an assembly called *name*.

    *more* bodies, of a facade, are written beside it, by *beside*'s name. Copies of it all lie at
    *poses*.
    """

    strips: Structure
    parts: Sequence[FlatPart]
    name: str
    connectors: Sequence[Prisms] = ()
    more: Bodies | None = None
    beside: str = ""
    poses: Sequence[Frame] = ()

    def do(self, step: Path, lap: Lap) -> tuple[Any, ...]:
        """See :class:`Work`; ``StepPart``s, ``StepCopy``s, then ``StepPrism``s of the others."""
        from fabrication.export.step_bodies import SEGMENT, strip_kinds, write_assembly
        from fabrication.export.step_prism_reader import read_copies, read_prisms
        from fabrication.export.step_reader import read_step
        from fabrication.solid import solids

        kinds = strip_kinds(self.strips, solids(self.strips, self.parts))
        lap("solids")
        bodies = joined(*self.connectors)
        write_assembly(step, name=self.name, strips=kinds, bodies=bodies, poses=self.poses)
        lap("STEP")
        found = read_step(step)
        copies = read_copies(step, SEGMENT) if self.poses else ()
        placed = (*copies, *(read_prisms(step) if self.connectors else ()))
        lap("STEP read back")
        if self.more is None:
            return (*found, *placed)
        other = BodiesWork(self.more, self.name).do(step.with_name(self.beside), lap)
        return (*found, *placed, *other)


@dataclass(frozen=True, eq=False)
class BodiesWork:
    """Prisms, in an assembly called *name*."""

    bodies: Bodies
    name: str

    def do(self, step: Path, lap: Lap) -> tuple[Any, ...]:
        """See :class:`Work`; returns ``StepPrism``s."""
        from fabrication.export.step_bodies import write_bodies
        from fabrication.export.step_prism_reader import read_prisms

        write_bodies(self.bodies, step, name=self.name)
        lap("solids and STEP")
        found = read_prisms(step)
        lap("STEP read back")
        return found


@dataclass(frozen=True, eq=False)
class KernelResult:
    """What the process brings back.

    Parameters
    ----------
    parts : the parts as the written STEP file has them.
    seconds : time of each of its stages.
    """

    parts: tuple[Any, ...]
    seconds: dict[str, float]


class Kernel:
    """A process that loads the CAD kernel and waits for its one order."""

    def __init__(self, folder: Path) -> None:
        self._order, self._answer = folder / "order", folder / "answer"
        module = ("-m", "fabrication.kernel_job")
        self._process: subprocess.Popen[bytes] = subprocess.Popen(
            [sys.executable, *module, str(self._order), str(self._answer)],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
        )

    def order(self, work: Work, step: Path) -> None:
        """Have *work* done and written to *step*; does not wait."""
        self._order.write_bytes(pickle.dumps((work, step.absolute())))
        with suppress(BrokenPipeError):  # a process that has ended is told by result()
            self._tell("go")

    def result(self) -> KernelResult:
        """Wait for the order to be done.

        Raises
        ------
        KernelError
            When the kernel is missing, refuses a solid, or crashes.
        OutputError
            When the file cannot be written.
        """
        _, complaint = self._process.communicate()
        if not self._answer.exists():
            last = complaint.decode(errors="replace").strip().splitlines()[-1:]
            raise KernelError(
                "The CAD kernel stopped without an answer",
                value=f"exit code {self._process.returncode} {' '.join(last)}".strip(),
            )
        found: KernelResult | GridshellError = pickle.loads(self._answer.read_bytes())
        if isinstance(found, GridshellError):
            raise found
        return found

    def end(self) -> None:
        """End the process, whatever it does."""
        if self._process.poll() is None:
            self._process.kill()
            self._process.communicate()

    def _tell(self, word: str) -> None:
        pipe: Any = self._process.stdin
        pipe.write(f"{word}\n".encode())
        pipe.flush()


@contextmanager
def kernel() -> Iterator[Kernel]:
    """Start loading the CAD kernel; the process is ended when the block is left."""
    with tempfile.TemporaryDirectory(prefix="gridshell-") as folder:
        process = Kernel(Path(folder))
        try:
            yield process
        finally:
            process.end()


def _work(order: Path, wait: Any) -> KernelResult | GridshellError | None:
    """Load the kernel, *wait* for the word, and do the work; None when no word came."""
    seconds: dict[str, float] = {}
    start = time.perf_counter()

    def lap(stage: str) -> None:
        passed = time.perf_counter() - start - sum(seconds.values())
        seconds[stage] = round(seconds.get(stage, 0.0) + passed, 3)

    try:
        import fabrication.export.step_bodies
        import fabrication.solid  # noqa: F401 - both load the kernel

        lap("CAD kernel")
    except GridshellError as error:
        return error
    if not wait():
        return None
    try:
        work, step = pickle.loads(order.read_bytes())
        lap("waiting")
        found = work.do(step, lap)
    except GridshellError as error:
        return error
    return KernelResult(found, seconds)


if __name__ == "__main__":
    from fabrication import kernel_job as this  # pickles name the module, not __main__

    answer = this._work(Path(sys.argv[1]), sys.stdin.readline)
    if answer is not None:
        Path(sys.argv[2]).write_bytes(pickle.dumps(answer))
