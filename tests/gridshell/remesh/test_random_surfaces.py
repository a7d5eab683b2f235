"""Random smooth graphs with holes: a sound mesh or a named error, nothing else."""

import numpy as np
import pytest
from judging import faults
from surfaces import Graph, ParameterDisk, _formula

from gridshell.errors import GridshellError
from gridshell.remesh import Asymptotic, Conjugate, Extent, Principal, quadrangulate


def surface(rng):
    a, b, c, d, w = rng.normal(size=5) * [0.35, 0.35, 0.2, 0.1, 2.0]

    def height(x, y):
        s, k = np.sin(w * x), np.cos(w * x)
        return (
            a * x * x + b * y * y + c * x * y + d * s * y,
            2 * a * x + c * y + d * w * k * y,
            2 * b * y + c * x + d * s,
            2 * a - d * w * w * s * y,
            c + d * w * k,
            2 * b + 0 * x,
        )

    hole = ParameterDisk(*rng.uniform(-0.5, 0.5, 2), rng.uniform(0.15, 0.3))
    over = ParameterDisk(0.0, 0.0, 1.0) if rng.random() < 0.5 else None
    return _formula(Graph(height), over, (hole,) if rng.random() < 0.5 else ())


@pytest.mark.parametrize("seed", range(12))
def test_a_sound_mesh_or_a_named_error(seed):
    rng = np.random.default_rng(seed)
    curved = surface(rng).build(900)
    wishes = [Principal(), Asymptotic(), Conjugate(rng.uniform(0.5, 2.5))]
    try:
        result = quadrangulate(
            curved,
            wishes[seed % 3],
            quads=int(rng.choice([20, 100, 300])),
            extent=list(Extent)[rng.integers(3)],
        )
    except GridshellError as error:
        made, told = None, bool(error.value and error.advice)
    else:
        made, told = result, True
    assert told
    if made is not None:
        found = faults(made.mesh)
        assert (found.odd, found.conflicts, made.report.non_quads, found.folded) == (0, 0, 0, 0)
        said = {r.code for r in made.report.remarks}
        assert not found.collapsed or "concave-quads" in said
