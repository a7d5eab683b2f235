"""The CAD kernel at work in a process of its own: make the solids, write STEP, read it back.

The kernel takes seconds to load and most of the time of a run; beside it the sheets are written
and the fit is tried on the other core. A kernel that crashes takes only its own process along.
"""

from __future__ import annotations

import pickle
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from fabrication.errors import KernelError
from fabrication.export.step_reader import StepPart
from fabrication.parts import FlatPart
from fabrication.structures import Structure
from gridshell import GridshellError


@dataclass(frozen=True, eq=False)
class KernelResult:
    """What the process brings back.

    Parameters
    ----------
    parts : the lamellas as the written STEP file has them.
    seconds : time of each of its stages.
    """

    parts: tuple[StepPart, ...]
    seconds: dict[str, float]


@contextmanager
def kernel_job(
    structure: Structure, parts: Sequence[FlatPart], *, name: str, step: Path
) -> Iterator[Callable[[], KernelResult]]:
    """Start making *step*; the function handed out waits for the result.

    The process is ended when the block is left before it is done.

    Raises
    ------
    KernelError
        From the function: when the kernel is missing, refuses a solid, or crashes.
    OutputError
        From the function: when the file cannot be written.
    """
    with tempfile.TemporaryDirectory(prefix="gridshell-") as folder:
        order, answer = Path(folder, "order"), Path(folder, "answer")
        order.write_bytes(pickle.dumps((structure, tuple(parts), name, step.absolute())))
        command = [sys.executable, "-m", "fabrication.kernel_job", str(order), str(answer)]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)

        def result() -> KernelResult:
            _, complaint = process.communicate()
            if not answer.exists():
                last = complaint.decode(errors="replace").strip().splitlines()[-1:]
                raise KernelError(
                    "The CAD kernel stopped without an answer",
                    value=f"exit code {process.returncode} {' '.join(last)}".strip(),
                )
            found: KernelResult | GridshellError = pickle.loads(answer.read_bytes())
            if isinstance(found, GridshellError):
                raise found
            return found

        try:
            yield result
        finally:
            if process.poll() is None:
                process.kill()
                process.communicate()


def _work(order: Path) -> KernelResult | GridshellError:
    structure, parts, name, step = pickle.loads(order.read_bytes())
    seconds: dict[str, float] = {}
    start = time.perf_counter()

    def lap(stage: str) -> None:
        seconds[stage] = round(time.perf_counter() - start - sum(seconds.values()), 3)

    try:
        from fabrication.export.step import assembly, write_step
        from fabrication.export.step_reader import read_step
        from fabrication.solid import solids

        lap("CAD kernel")
        bodies = solids(structure, parts)
        lap("solids")
        write_step(assembly(bodies, structure, name=name), step)
        lap("STEP")
        found = read_step(step)
        lap("STEP read back")
    except GridshellError as error:
        return error
    return KernelResult(found, seconds)


if __name__ == "__main__":
    from fabrication import kernel_job as this  # pickles name the module, not __main__

    Path(sys.argv[2]).write_bytes(pickle.dumps(this._work(Path(sys.argv[1]))))
