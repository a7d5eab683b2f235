import numpy as np
import pytest

import fabrication as fab
import gridshell as gs
from fabrication.export.interchange.model import bodies_model, lamella_model


@pytest.fixture(scope="session")
def slotted(profile):
    """Double slots with star washers, bolts and nuts: strips and connectors, with their parts."""
    patch = gs.AsymptoticPatch(p=(-0.2, 0.2), q=(-0.2, 0.2), lamellas=(3, 3))
    net = gs.diagonal_meshes(gs.control_patch(gs.Enneper(4000.0), patch))[0]
    joint = fab.DoubleSlotJoint(30.0, 8.0, fab.StarWasher(4.0, 18.0, 8.0, fab.S235))
    jointed = joint.build(fab.structure(net, profile))
    return jointed, fab.parts_of(jointed)


@pytest.fixture(scope="session")
def model(slotted):
    return lamella_model("shell", *slotted)


@pytest.fixture(scope="session")
def panels(tower):
    from fabrication.bodies import structure_bodies

    return bodies_model("tower", structure_bodies(tower))


@pytest.fixture(params=["model", "panels"])
def any_model(request):
    return request.getfixturevalue(request.param)


def volume(points, triangles):
    """What a closed mesh holds, by the divergence theorem."""
    a, b, c = np.moveaxis(np.asarray(points)[np.asarray(triangles)], 1, 0)
    return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6.0


@pytest.fixture(scope="session")
def mesh_volume():
    return volume
