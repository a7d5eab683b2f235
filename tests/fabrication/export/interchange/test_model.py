import numpy as np
import pytest
import trimesh

import fabrication as fab
from fabrication.bodies import structure_bodies
from fabrication.export.interchange.model import lamella_model
from fabrication.materials import MATERIALS


def test_every_strip_and_connector_is_an_item(slotted, model):
    jointed, parts = slotted
    connectors = sum(len(kind.bodies) for kind in jointed.connectors)
    bolts = sum(item.layer == "bolts" for item in model.items)
    assert bolts > 0
    assert len(model.items) == len(parts) + connectors - bolts  # each in one piece with its head
    assert [item.mark for item in model.items[: len(parts)]] == [part.mark for part in parts]
    assert len(model.nodes) == len(jointed.design.nodes)


def test_marks_are_unique_and_bodies_closed(any_model):
    marks = [item.mark for item in any_model.items]
    assert len(set(marks)) == len(marks)
    for item in any_model.items:
        mesh = trimesh.Trimesh(item.points, item.triangles, process=False)
        assert mesh.is_watertight, item.mark
        assert mesh.volume > 0.0, item.mark


def test_axes_are_as_long_as_the_lists_say(slotted, model):
    for item, part in zip(model.items, slotted[1], strict=False):
        length = np.linalg.norm(np.diff(item.axis, axis=0), axis=1).sum()
        assert length == pytest.approx(part.length, rel=1e-4)
        assert item.numbers["length_mm"] == pytest.approx(part.length, abs=1e-3)
        assert item.numbers["slots"] == len(part.slots)


def test_masses_are_those_of_the_material(slotted, model):
    density = slotted[0].design.profile.material.density
    for item, part in zip(model.items, slotted[1], strict=False):
        assert item.numbers["mass_kg"] == pytest.approx(part.volume * density * 1e-9, abs=1e-5)


def test_layers_keep_the_order_of_lists(model):
    layers = model.layers
    assert list(layers)[:2] == ["family A", "family B"]
    assert sum(map(len, layers.values())) == len(model.items)


def test_more_bodies_stand_on_layers_of_their_own(slotted, model, tower):
    more = structure_bodies(tower)
    both = lamella_model("glazed", *slotted, more)
    added = both.items[len(model.items) :]
    assert len(added) == sum(len(kind.bodies) for kind in more.kinds) > 0
    assert {item.layer for item in added} == {kind.name for kind in more.kinds if kind.bodies}


def test_segments_are_copies_by_their_poses(model):
    segments = fab.Segments(4, centre=(500.0, -200.0))
    whole = model.repeated(segments.poses)
    assert len(whole.items) == 4 * len(model.items)
    assert len({item.name for item in whole.items}) == len(whole.items)
    for number in range(4):
        item, copy = model.items[0], whole.items[number * len(model.items)]
        assert (copy.mark, copy.name) == (item.mark, f"segment-{number + 1} {item.mark}")
        assert copy.points == pytest.approx(segments.placed(item.points, number), abs=1e-9)
        assert copy.axis == pytest.approx(segments.placed(item.axis, number), abs=1e-9)
        assert copy.numbers == {**item.numbers, "quantity": 1}  # each stands for itself
    assert whole.nodes[-1][1] == pytest.approx(
        segments.placed(model.nodes[-1][1][None], 3)[0], abs=1e-9
    )


def test_an_assembly_of_no_parts_is_refused(slotted):
    with pytest.raises(ValueError, match="shorter"):
        lamella_model("shell", slotted[0], slotted[1][:-1])


def test_bodies_say_their_size_and_what_they_are_of(slotted, model, panels, tower):
    by_layer = model.layers
    washer = by_layer["star washers"][0].numbers
    assert (washer["thickness_mm"], washer["material"]) == (4.0, "S235")
    bolt = by_layer["bolts"][0].numbers
    assert bolt["diameter_mm"] == 8.0
    assert bolt["length_mm"] % 5.0 == 0.0
    masses = {panel.mark: panel.mass for panel in (*tower.panels, *tower.plates)}
    for item in panels.items:
        if item.mark in masses:
            assert item.numbers["mass_kg"] == pytest.approx(masses[item.mark], abs=1e-3)


def test_meshes_have_the_volume_that_masses_are_of(slotted, model, panels, tower):
    densities = {m.name: m.density for m in MATERIALS.values()}
    weighed = [item for item in (*model.items, *panels.items) if "mass_kg" in item.numbers]
    assert len(weighed) > len(slotted[1])
    for item in weighed:
        volume = trimesh.Trimesh(item.points, item.triangles, process=False).volume
        mass = volume * densities[item.numbers["material"]] * 1e-9
        assert mass == pytest.approx(item.numbers["mass_kg"], rel=2e-3, abs=1e-5)
