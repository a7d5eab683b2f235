import numpy as np
import pytest

import gridshell as gs
from fabrication.moulds import moulds


@pytest.fixture(scope="module")
def control():
    """Node angles of 60 degrees on a net from Enneper's surface: a constant curvature ratio."""
    patch = gs.BisectingPatch(v=(-0.6, 0.6), cells=20, u=(-0.6, 0.6))
    start = gs.control_patch(gs.Enneper(4000.0), patch)
    recipe = gs.a_net(angle=np.radians(60.0))
    return gs.optimize(start, recipe, anchor=gs.Free()).require().control


def test_a_wider_tolerance_needs_fewer_moulds_and_none_more_than_the_panels(control):
    found = [moulds(control, gs.Skin.D1, tolerance) for tolerance in (0.1, 1.0, 10.0, 1000.0)]
    counts = [f["moulds"] for f in found]
    assert counts == sorted(counts, reverse=True)
    assert counts[0] <= found[0]["panels"]
    assert counts[-1] == 1
    assert all(f["deviation_mm"]["max"] <= f["tolerance_mm"] * (1 + 1e-9) for f in found)


def test_about_the_root_of_the_panels_at_their_own_variation(control):
    own = moulds(control, gs.Skin.D1, 1.0)["own_variation_mm"]
    found = moulds(control, gs.Skin.D1, own)
    assert found["moulds"] <= 2.0 * np.sqrt(found["panels"])


def test_a_net_too_small_is_told():
    mesh = gs.control_patch(
        gs.Enneper(4000.0), gs.BisectingPatch(v=(-0.2, 0.2), cells=2, u=(-0.2, 0.2))
    )
    with pytest.raises(gs.SettingError, match="too small"):
        moulds(mesh, gs.Skin.D1, 1.0)
