import numpy as np
import pytest
import trimesh

from fabrication.export.interchange.model import lamella_model


def test_every_strip_and_connector_is_an_item(slotted, model):
    jointed, parts = slotted
    connectors = sum(len(kind.bodies) for kind in jointed.connectors)
    assert len(model.items) == len(parts) + connectors
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


def test_an_assembly_of_no_parts_is_refused(slotted):
    with pytest.raises(ValueError, match="shorter"):
        lamella_model("shell", slotted[0], slotted[1][:-1])
