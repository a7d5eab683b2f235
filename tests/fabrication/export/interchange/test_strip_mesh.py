import numpy as np
import pytest
import trimesh

import fabrication as fab
import gridshell as gs
from fabrication.cut import Edge, Floor, Hole, Relief, Slot, outline
from fabrication.export.interchange.strip_mesh import strip_mesh
from fabrication.sides import strip_sides
from fabrication.solid import lamella_solid


@pytest.fixture(scope="module")
def tubes(drilled_tubes):
    patch = gs.BisectingPatch(v=(-0.8, 0.8), cells=16)
    design, parts = drilled_tubes(gs.control_patch(gs.Catenoid(1500.0), patch))
    return list(zip(design.lamellas, parts, strict=True))


def whole(design):
    return list(zip(design.structure.lamellas, design.parts, strict=True))


def rich(design, bevels=(0.0, 0.0)):
    """The first strip with a slot of every floor, holes between, and bevelled ends."""
    lamella, part = whole(design)[0]
    places = np.linspace(0.15, 0.85, 4) * part.length
    floors = [Relief(), Relief(Floor.ROUND), Relief(Floor.DOGBONE, 1.5), Relief()]
    slots = tuple(
        Slot(x, 6.0, 55.0, Edge.UPPER if k % 2 else Edge.LOWER, f"N{k}", f"B{k}", floor)
        for k, (x, floor) in enumerate(zip(places.tolist(), floors, strict=True))
    )
    between = (places[1:] + places[:-1]) / 2.0
    holes = tuple(
        Hole(x, 30.0 + 20.0 * k, 9.0, f"N{k}", "bolt") for k, x in enumerate(between.tolist())
    )
    made = fab.FlatPart(
        mark=part.mark,
        outline=outline(part.length, part.width, slots),
        slots=slots,
        labels=(),
        width=part.width,
        thickness=part.thickness,
        development=part.development,
        holes=holes,
        bevels=bevels,
    )
    return lamella, made


def body(lamella, part):
    return trimesh.Trimesh(*strip_mesh(lamella, part), process=False)


def openings(part):
    return 2 * len(part.drills) + 1 if part.wall else len(part.holes)


@pytest.mark.parametrize("name", ["enneper", "catenoid", "hypar", "tube", "saddle"])
def test_strips_are_closed_bodies_of_their_volume(name, request):
    for lamella, part in whole(request.getfixturevalue(name)):
        mesh = body(lamella, part)
        assert mesh.is_watertight
        assert mesh.is_winding_consistent
        assert mesh.volume == pytest.approx(part.volume, rel=2e-3)


@pytest.mark.parametrize("bevels", [(0.0, 0.0), (3.0, -2.0), (-4.0, 4.0), (40.0, 0.0)])
def test_slots_holes_and_bevels_are_those_of_the_part(enneper, bevels):
    lamella, part = rich(enneper, bevels)
    mesh = body(lamella, part)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.euler_number == 2 - 2 * openings(part)
    assert mesh.volume == pytest.approx(part.volume, rel=2e-3)


@pytest.mark.parametrize("bevels", [(0.0, 0.0), (3.0, -2.0)])
def test_the_mesh_lies_on_the_solid_of_the_step_file(enneper, bevels):
    """Its points on the solid's skin, and the boxes alike: measured by the CAD kernel."""
    import build123d

    lamella, part = rich(enneper, bevels)
    mesh, solid = body(lamella, part), build123d.Solid(lamella_solid(lamella, part))
    box = solid.bounding_box(optimal=True)
    low, high = (np.array(tuple(end)) for end in (box.min, box.max))
    assert mesh.bounds == pytest.approx(np.stack([low, high]), abs=0.01)
    skin = solid.shell()
    for point in mesh.vertices[:: len(mesh.vertices) // 60]:
        assert skin.distance_to(build123d.Vertex(*point)) < 2e-3
    assert mesh.volume == pytest.approx(solid.volume, rel=2e-3)


def test_slots_are_open(slotted):
    jointed, parts = slotted
    for lamella, part in zip(jointed.strips.lamellas, parts, strict=True):
        cut = part.width * part.thickness * part.length - part.volume
        left = part.width * part.thickness * part.length - body(lamella, part).volume
        assert left == pytest.approx(cut, rel=0.05)


def test_both_sides_lie_half_a_thickness_from_the_axis_surface(pair, profile):
    lamella, part = pair.structure.lamellas[0], pair.parts[0]
    points, _ = strip_mesh(lamella, part)
    near, far = np.split(points, 2)
    assert np.linalg.norm(near - far, axis=1) == pytest.approx(profile.thickness, abs=1e-3)


def test_bends_are_divided_until_their_chords_are_near(catenoid):
    lamella, part = whole(catenoid)[0]
    mesh, side = body(lamella, part), strip_sides(lamella, part)[0]
    u = np.linspace(0.0, part.length, 97)
    below = [s.x for s in part.slots if s.edge is Edge.LOWER]
    u = u[np.abs(u[:, None] - below).min(axis=1, initial=np.inf) > 10.0]
    away = [
        np.linalg.norm(
            trimesh.triangles.closest_point(mesh.triangles, np.tile(point, (len(mesh.faces), 1)))
            - point,
            axis=1,
        ).min()
        for point in side.points(u, np.zeros_like(u))
    ]
    assert max(away) < 0.021
    assert max(away) > 1e-4  # they are chords


def test_tubes_are_hollow_and_drilled(tubes):
    for lamella, part in tubes[:4]:
        mesh = body(lamella, part)
        assert mesh.is_watertight
        assert mesh.is_winding_consistent
        assert mesh.euler_number == 2 - 2 * openings(part)
        assert mesh.volume == pytest.approx(part.volume, rel=1e-3)
