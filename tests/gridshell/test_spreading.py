import numpy as np

import gridshell as gs
from gridshell.spreading import spread


def test_linear_values_are_carried_exactly(grid):
    control = gs.as_control_mesh(grid(4, 5))
    wanted = control.vertices @ np.array([[1.0, 0.0, 2.0], [0.5, -1.0, 0.0], [0.0, 0.0, 0.0]]).T
    corners = np.flatnonzero(control.mesh.valence == 1)
    np.testing.assert_allclose(spread(control, wanted, corners), wanted, atol=1e-9)


def test_nothing_known_but_nought_stays_nought(grid):
    control = gs.as_control_mesh(grid(3, 3))
    assert np.abs(spread(control, np.zeros((16, 3)), np.array([0, 5]))).max() == 0.0
