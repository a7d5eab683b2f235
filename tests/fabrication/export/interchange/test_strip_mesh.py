import numpy as np
import pytest
import trimesh

import fabrication as fab
from fabrication.export.interchange.strip_mesh import strip_mesh


def body(lamella, part):
    return trimesh.Trimesh(*strip_mesh(lamella, part), process=False)


@pytest.mark.parametrize("name", ["enneper", "catenoid", "hypar", "tube", "saddle"])
def test_strips_are_closed_bodies_of_nearly_their_volume(name, request):
    design = request.getfixturevalue(name)
    for lamella, part in zip(design.structure.lamellas, design.parts, strict=True):
        mesh = body(lamella, part)
        assert mesh.is_watertight
        assert mesh.is_winding_consistent
        assert mesh.volume == pytest.approx(part.volume, rel=5e-3)


def test_slots_are_open(slotted):
    jointed, parts = slotted
    for lamella, part in zip(jointed.strips.lamellas, parts, strict=True):
        cut = part.width * part.thickness * part.length - part.volume
        left = part.width * part.thickness * part.length - body(lamella, part).volume
        assert left == pytest.approx(cut, rel=0.1)


def test_both_sides_lie_half_a_thickness_from_the_axis_surface(pair, profile):
    lamella, part = pair.structure.lamellas[0], pair.parts[0]
    points, _ = strip_mesh(lamella, part)
    near, far = np.split(points, 2)
    assert np.linalg.norm(near - far, axis=1) == pytest.approx(profile.thickness, abs=1e-9)


def test_a_strip_without_slots_has_two_triangles_a_column_and_side(pair):
    part = pair.parts[0]
    plain = fab.FlatPart(
        mark=part.mark,
        outline=fab.cut.outline(part.length, part.width, ()),
        slots=(),
        labels=(),
        width=part.width,
        thickness=part.thickness,
        development=part.development,
    )
    points, triangles = strip_mesh(pair.structure.lamellas[0], plain)
    columns = len(points) // 4 - 1
    assert len(triangles) == 2 * 2 * columns + 2 * (2 * columns + 2)
