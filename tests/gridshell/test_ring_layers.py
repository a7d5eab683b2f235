import numpy as np
import pytest

import gridshell as gs

UMBRELLA = gs.Umbrella(12, 1000.0, (480.0, 450.0, 470.0, 460.0))


@pytest.mark.parametrize("opening", [0.1, 0.5, 0.85])
def test_an_umbrella_is_found_again_wherever_it_stands(opening):
    position = UMBRELLA.position(opening)
    control = position.control()
    turn = np.array([[np.cos(0.7), -np.sin(0.7), 0], [np.sin(0.7), np.cos(0.7), 0], [0, 0, 1]])
    found = gs.umbrella_of(control.moved(control.vertices @ turn.T + [5e3, -2e3, 700.0]))
    assert found.umbrella.ribs == 12
    np.testing.assert_allclose(found.umbrella.bays, UMBRELLA.bays, rtol=1e-9)
    np.testing.assert_allclose(found.radii, position.radii, rtol=1e-9)
    np.testing.assert_allclose(found.heights, position.heights, atol=1e-6)
    assert found.opening == pytest.approx(opening, abs=1e-6)


def test_a_catenoid_ring_is_an_umbrella():
    control = gs.control_patch(gs.Catenoid(900.0), gs.BisectingPatch(v=(-0.7, 0.7), cells=24))
    exact = gs.optimize(control, gs.a_net(), anchor=gs.Free()).require().control
    position = gs.umbrella_of(exact)
    assert position.umbrella.ribs == 12
    again = position.umbrella.position(position.opening)
    np.testing.assert_allclose(again.radii, position.radii, rtol=1e-6)


def test_a_patch_is_no_ring(enneper):
    with pytest.raises(gs.SettingError, match="not symmetric") as info:
        gs.umbrella_of(enneper(8))
    assert info.value.where == "boundary loops"


def test_a_ring_that_is_out_of_round_names_its_worst_node():
    control = UMBRELLA.position(0.4).control()
    net = gs.diagonal_meshes(control)[0]
    moved = control.vertices.copy()
    moved[net.control_vertices[7], 0] += 3.0
    with pytest.raises(gs.SettingError, match="not symmetric") as info:
        gs.umbrella_of(control.moved(moved))
    assert "node 7 of ring" in info.value.where
    assert "Mechanism" in info.value.advice


def test_a_twisted_ring_is_not_symmetric():
    control = UMBRELLA.position(0.4).control()
    x, y, z = control.vertices.T
    turn = 1e-3 * z / 1000.0
    twisted = [x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn), z]
    with pytest.raises(gs.SettingError, match="not symmetric"):
        gs.umbrella_of(control.moved(np.stack(twisted, axis=1)))
