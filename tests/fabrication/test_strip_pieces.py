import numpy as np
import pytest

import fabrication as fab
import gridshell as gs
from fabrication.fitting import clash_volumes
from fabrication.strip_pieces import strip_pieces


def twisted(thickness):
    """A strip through the waist of a small catenoid: it turns by 2 radians a metre."""
    patch = gs.AsymptoticPatch(p=(-0.3, 0.3), q=(-0.3, 0.3), lamellas=(3, 3))
    net = gs.diagonal_meshes(gs.control_patch(gs.Catenoid(500.0), patch))[0]
    jointed = fab.HingedJoint(5.0, gap=6.0).build(
        fab.structure(net, fab.HollowProfile(50.0, thickness, fab.GRP, wall=2.0))
    )
    return jointed, fab.parts_of(jointed)


@pytest.mark.parametrize("thickness", [10.0, 20.0, 30.0])
def test_faces_of_thick_twisted_tubes_are_where_the_strip_puts_them(thickness):
    jointed, parts = twisted(thickness)
    strip, part = jointed.strips.lamellas[1], parts[1]
    middle = (part.drills[0].x + part.drills[1].x) / 2.0
    (piece,) = strip_pieces(strip, part, [(middle - 30.0, middle + 30.0)])
    mesh = piece.solid.to_mesh64()
    points = np.asarray(mesh.vert_properties)[:, :3]
    triangles = points[np.asarray(mesh.tri_verts)]
    s = np.repeat(strip.start + middle + np.linspace(-27.0, 27.0, 55), 9)
    y = np.tile(thickness * np.linspace(-0.45, 0.45, 9), 55)
    face = strip.place(s, y, np.full(len(s), part.width / 2.0))
    centres = triangles.mean(axis=1)
    near = np.argsort(np.linalg.norm(face[:, None] - centres, axis=2), axis=1)[:, :6]
    normal = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    off = np.abs(np.einsum("ptc,ptc->pt", face[:, None] - triangles[near, 0], normal[near]))
    assert off.min(axis=1).max() < 0.008


def test_a_twisted_solid_strip_is_as_large_as_its_part(enneper):
    lamella, part = enneper.structure.lamellas[0], enneper.parts[0]
    (piece,) = strip_pieces(lamella, part, [(0.0, part.length)])
    assert piece.solid.volume() == pytest.approx(part.volume, rel=1e-4)
    assert piece.nodes == {slot.node for slot in part.slots}


def test_thick_twisted_tubes_fit():
    jointed, parts = twisted(20.0)
    assert max(clash_volumes(jointed.strips, parts, jointed.connectors).values(), default=0.0) == 0
