from types import MappingProxyType

import numpy as np
import pytest

import gridshell as gs
from gridshell.solve import Solution, history

STEP = gs.Step(
    energy=1.0,
    residuals=MappingProxyType({"star": 1e-2}),
    unmet=1e-2,
    damping=1e-6,
    accepted=True,
    energies=MappingProxyType({"star": 0.75, "fairness": 0.25}),
    length=1.0,
    seconds=0.012,
)


def solution(end):
    status = "Not converged after 1 steps: star 1e-2."
    state = gs.State(np.zeros(3), 1, 1e-6, 2.0)
    return Solution(np.zeros(3), end, status, (STEP,), state, np.empty(0, dtype=np.int64))


def test_a_converged_solution_is_handed_through():
    found = solution(gs.End.CONVERGED)
    assert found.converged
    assert found.require() is found


@pytest.mark.parametrize("end", [end for end in gs.End if end is not gs.End.CONVERGED])
def test_require_raises_with_the_status_sentence(end):
    assert not solution(end).converged
    with pytest.raises(gs.SolveError) as info:
        solution(end).require()
    assert str(info.value) == "Not converged after 1 steps: star 1e-2."


def test_the_residuals_of_a_step_cannot_be_changed():
    with pytest.raises(TypeError):
        STEP.residuals["star"] = 0.0


def test_the_full_report_has_a_line_per_step_with_every_term():
    lines = solution(gs.End.STEPS).report().splitlines()
    assert lines[0] == "Not converged after 1 steps: star 1e-2."
    assert lines[1].split() == ["step", "energy", "star", "fairness", "damping", "length", "s"]
    assert lines[2].split() == [
        "1", "1.000e+00", "7.500e-01", "2.500e-01", "1.0e-06", "1", "0.012"
    ]  # fmt: skip


def test_a_refused_step_says_so():
    refused = gs.Step(1.0, STEP.residuals, STEP.unmet, 1e-6, False, STEP.energies, 0.0625, 0.1)
    line = history("Stalled.", (refused,)).splitlines()[-1]
    assert "1 refused" in line
    assert "0.0625" in line


def test_without_a_step_the_report_is_the_status():
    assert history("Converged in 0 steps.", ()) == "Converged in 0 steps."
