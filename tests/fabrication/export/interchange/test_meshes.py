import numpy as np
import pytest
import trimesh

from fabrication.export.interchange.meshes import write_glb, write_obj_groups, write_ply


def test_a_glb_has_a_node_per_part_under_its_layer(any_model, tmp_path):
    write_glb(tmp_path / "a.glb", any_model)
    scene = trimesh.load(tmp_path / "a.glb")
    assert set(scene.geometry) == {item.mark for item in any_model.items}
    parents = scene.graph.transforms.parents
    for item in any_model.items:
        assert parents[item.mark] == item.layer
        mesh = scene.geometry[item.mark]
        x, y, z = (1000.0 * mesh.vertices).T  # y is up in a GLB
        back = np.stack([x, -z, y], axis=1)
        assert back == pytest.approx(item.points, abs=0.01)
        assert len(mesh.faces) == len(item.triangles)
        assert mesh.volume > 0.0


def test_a_glb_carries_the_numbers_of_each_part(model, tmp_path):
    write_glb(tmp_path / "a.glb", model)
    scene = trimesh.load(tmp_path / "a.glb")
    strip = model.items[0]
    extras = scene.geometry[strip.mark].metadata
    assert extras["length_mm"] == pytest.approx(strip.numbers["length_mm"])
    assert extras["material"] == "stainless"


def test_a_ply_holds_every_part_in_its_colour(any_model, tmp_path):
    write_ply(tmp_path / "a.ply", any_model)
    mesh = trimesh.load(tmp_path / "a.ply", process=False)
    assert len(mesh.faces) == sum(len(item.triangles) for item in any_model.items)
    points = np.concatenate([item.points for item in any_model.items])
    assert mesh.vertices == pytest.approx(points, abs=0.01)
    colours = {tuple(colour) for colour in np.unique(mesh.visual.vertex_colors[:, :3], axis=0)}
    assert colours == {tuple(round(255 * c) for c in item.colour) for item in any_model.items}


def test_an_obj_has_an_object_per_part(any_model, tmp_path):
    write_obj_groups(tmp_path / "a.obj", any_model)
    assert (tmp_path / "a.obj").read_text("utf-8").startswith("# unit: mm\n")
    lines = (tmp_path / "a.obj").read_text("utf-8").splitlines()
    names = [line[2:] for line in lines if line.startswith("o ")]
    assert names == [item.mark for items in any_model.layers.values() for item in items]
    mesh = trimesh.load(tmp_path / "a.obj", process=False)
    assert len(mesh.faces) == sum(len(item.triangles) for item in any_model.items)
    whole = mesh.volume
    truth = sum(
        trimesh.Trimesh(item.points, item.triangles, process=False).volume
        for item in any_model.items
    )
    assert whole == pytest.approx(truth, rel=1e-6)
