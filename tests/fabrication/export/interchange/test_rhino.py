import numpy as np
import pytest
import rhino3dm

import fabrication as fab
from fabrication.errors import OutputError
from fabrication.export.interchange.rhino import write_3dm


def objects(path, kind):
    """Objects of a kind, with the names of their layers."""
    file = rhino3dm.File3dm.Read(str(path))
    layers = [layer.Name for layer in file.Layers]
    found = [one for one in file.Objects if isinstance(one.Geometry, kind)]
    return [(one, layers[one.Attributes.LayerIndex]) for one in found]


def test_meshes_lie_on_their_layers_with_names(any_model, mesh_volume, tmp_path):
    write_3dm(tmp_path / "a.3dm", any_model)
    found = objects(tmp_path / "a.3dm", rhino3dm.Mesh)
    assert len(found) == len(any_model.items)
    for (one, layer), item in zip(found, sorted_by_layer(any_model), strict=True):
        assert (one.Attributes.Name, layer) == (item.mark, item.layer)
        assert one.Geometry.IsClosed
        vertices = one.Geometry.Vertices
        points = np.array([(p.X, p.Y, p.Z) for p in (vertices[i] for i in range(len(vertices)))])
        assert points == pytest.approx(item.points, abs=0.01)
        faces = one.Geometry.Faces
        triangles = np.array([faces[i][:3] for i in range(len(faces))])
        assert mesh_volume(points, triangles) > 0.0


def sorted_by_layer(model):
    return [item for items in model.layers.values() for item in items]


def test_axes_are_as_long_as_the_lists_say(model, tmp_path):
    write_3dm(tmp_path / "a.3dm", model)
    found = objects(tmp_path / "a.3dm", rhino3dm.Curve)
    assert len(found) == sum(item.axis is not None for item in model.items)
    strips = [item for item in model.items if item.axis is not None]
    lengths = {item.mark: item.numbers["length_mm"] for item in strips}
    for one, layer in found:
        curve = one.Geometry
        u = np.linspace(curve.Domain.T0, curve.Domain.T1, 500)
        places = [curve.PointAt(float(at)) for at in u]
        points = np.array([(p.X, p.Y, p.Z) for p in places])
        length = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
        assert length == pytest.approx(lengths[one.Attributes.Name], abs=0.01)
        assert layer.endswith(" axes")


def test_numbers_are_user_text(model, tmp_path):
    write_3dm(tmp_path / "a.3dm", model)
    one, _ = objects(tmp_path / "a.3dm", rhino3dm.Mesh)[0]
    strip = model.items[0]
    assert one.Attributes.GetUserString("mark") == strip.mark
    assert float(one.Attributes.GetUserString("length_mm")) == strip.numbers["length_mm"]
    assert one.Attributes.GetUserString("material") == "stainless"


def test_copies_in_segments_keep_their_mark(model, tmp_path):
    write_3dm(tmp_path / "a.3dm", model.repeated(fab.Segments(2).poses))
    found = [one.Attributes for one, _ in objects(tmp_path / "a.3dm", rhino3dm.Mesh)]
    told = {(one.Name, one.GetUserString("mark"), one.GetUserString("segment")) for one in found}
    for number in (1, 2):
        for item in model.items:
            assert (f"segment-{number} {item.mark}", item.mark, f"segment-{number}") in told


def test_nodes_are_named_points(model, tmp_path):
    write_3dm(tmp_path / "a.3dm", model)
    found = objects(tmp_path / "a.3dm", rhino3dm.Point)
    assert [one.Attributes.Name for one, _ in found] == [name for name, _ in model.nodes]
    for (one, layer), (_, place) in zip(found, model.nodes, strict=True):
        at = one.Geometry.Location
        assert pytest.approx(tuple(place), abs=1e-9) == (at.X, at.Y, at.Z)
        assert layer == "nodes"


def test_the_unit_is_the_millimetre(model, tmp_path):
    write_3dm(tmp_path / "a.3dm", model)
    file = rhino3dm.File3dm.Read(str(tmp_path / "a.3dm"))
    assert file.Settings.ModelUnitSystem == rhino3dm.UnitSystem.Millimeters


def test_a_folder_that_is_none_is_an_error(model, tmp_path):
    with pytest.raises(OutputError, match="3dm"):
        write_3dm(tmp_path / "nowhere" / "a.3dm", model)
