from types import MappingProxyType

import numpy as np
import pytest

import gridshell as gs
from gridshell.solve import Solution


def solution(converged):
    step = gs.Step(energy=1.0, residuals=MappingProxyType({}), damping=1e-6, accepted=True)
    return Solution(np.zeros(3), converged, "Not converged after 1 steps: star 1e-2.", (step,))


def test_a_converged_solution_is_handed_through():
    found = solution(True)
    assert found.require() is found


def test_require_raises_with_the_status_sentence():
    with pytest.raises(gs.SolveError) as info:
        solution(False).require()
    assert str(info.value) == "Not converged after 1 steps: star 1e-2."


def test_the_residuals_of_a_step_cannot_be_changed():
    with pytest.raises(TypeError):
        solution(True).steps[0].residuals["star"] = 0.0
