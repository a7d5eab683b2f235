"""Quad meshes that Rhino and COMPAS write, read back beside the OBJ of the same mesh."""

import json
import sys

import compas
import numpy as np
import pytest
import rhino3dm
from compas.datastructures import Mesh

import gridshell as gs
from gridshell.mesh import grid_quads

MILLIMETRES = rhino3dm.UnitSystem.Millimeters


@pytest.fixture(scope="module")
def mesh():
    """A saddle with places that no short decimal or single-precision number holds."""
    x, y = np.meshgrid(np.linspace(-1200, 1300, 6), np.linspace(-700, 900, 5), indexing="ij")
    points = np.stack([x, y, (x * x - y * y) / 7000.0 + np.pi], axis=-1).reshape(-1, 3)
    return gs.QuadMesh(points, grid_quads(5, 4))


def rhino_mesh(vertices, faces):
    made = rhino3dm.Mesh()
    made.Vertices.UseDoublePrecisionVertices = True
    for row in np.asarray(vertices, dtype=float).tolist():
        made.Vertices.AddPoint3d(*row)
    for face in np.asarray(faces).tolist():
        made.Faces.AddFace(*face)
    return made


def write_rhino(path, *meshes, unit=MILLIMETRES, names=()):
    file = rhino3dm.File3dm()
    file.Settings.ModelUnitSystem = unit
    for i, one in enumerate(meshes):
        attributes = rhino3dm.ObjectAttributes()
        attributes.Name = names[i] if i < len(names) else ""
        file.Objects.AddMesh(one, attributes)
    assert file.Write(str(path), 7)
    return path


def write_compas(path, mesh):
    Mesh.from_vertices_and_faces(mesh.vertices.tolist(), mesh.quads.tolist()).to_json(str(path))
    return path


def same(found, mesh, scale=1.0):
    assert np.abs(found.vertices - scale * mesh.vertices).max() <= 1e-9 * scale
    assert found.quads.tolist() == mesh.quads.tolist()
    return True


# ---- the same mesh ---------------------------------------------------------------------------


def test_rhino_gives_the_mesh_of_the_obj(mesh, tmp_path):
    gs.write_obj(tmp_path / "a.obj", mesh, unit=gs.Unit.MM)
    write_rhino(tmp_path / "a.3dm", rhino_mesh(mesh.vertices, mesh.quads))
    truth = gs.read_mesh(tmp_path / "a.obj", unit=gs.Unit.MM)
    assert same(gs.read_mesh(tmp_path / "a.3dm"), truth)
    assert same(gs.read_mesh(tmp_path / "a.3dm", unit=gs.Unit.MM), truth)


def test_compas_gives_the_mesh_of_the_obj(mesh, tmp_path):
    gs.write_obj(tmp_path / "a.obj", mesh, unit=gs.Unit.MM)
    write_compas(tmp_path / "a.json", mesh)
    truth = gs.read_mesh(tmp_path / "a.obj", unit=gs.Unit.MM)
    assert same(gs.read_mesh(tmp_path / "a.json", unit=gs.Unit.MM), truth)


@pytest.mark.parametrize(
    ("stated", "mm"),
    [
        ("Millimeters", 1.0),
        ("Centimeters", 10.0),
        ("Meters", 1000.0),
        ("Inches", 25.4),
        ("Feet", 304.8),
        ("Yards", 914.4),
    ],
)
def test_a_3dm_file_is_scaled_by_its_own_unit(mesh, stated, mm, tmp_path):
    unit = getattr(rhino3dm.UnitSystem, stated)
    write_rhino(tmp_path / "a.3dm", rhino_mesh(mesh.vertices, mesh.quads), unit=unit)
    assert same(gs.read_mesh(tmp_path / "a.3dm"), mesh, mm)


def test_a_compas_file_is_scaled_by_the_unit_given(mesh, tmp_path):
    write_compas(tmp_path / "a.JSON", mesh)
    assert same(gs.read_mesh(tmp_path / "a.JSON", unit=gs.Unit.INCH), mesh, 25.4)


def test_faces_are_turned_to_one_orientation(mesh, tmp_path):
    quads = np.array(mesh.quads)
    quads[3] = quads[3][::-1]
    for path in (
        write_rhino(tmp_path / "a.3dm", rhino_mesh(mesh.vertices, quads)),
        tmp_path / "a.json",
    ):
        if path.suffix == ".json":
            Mesh.from_vertices_and_faces(mesh.vertices.tolist(), quads.tolist()).to_json(str(path))
        found = gs.read_mesh(path, unit=gs.Unit.MM)
        assert sorted(found.quads[3].tolist()) == sorted(mesh.quads[3].tolist())
        assert len(found.boundary_loops) == 1


# ---- vertices that are doubled or unused -----------------------------------------------------


def test_corners_that_rhino_keeps_apart_in_one_place_are_one_vertex(mesh, tmp_path):
    apart = mesh.vertices[mesh.quads].reshape(-1, 3)  # four corners of its own for every face
    faces = np.arange(len(apart)).reshape(-1, 4)
    write_rhino(tmp_path / "a.3dm", rhino_mesh(apart, faces))
    found = gs.read_mesh(tmp_path / "a.3dm")
    assert len(found.vertices) == len(mesh.vertices)
    assert np.abs(found.vertices[found.quads] - mesh.vertices[mesh.quads]).max() <= 1e-9
    gs.require_sound(found)


def test_noughts_of_either_sign_are_one_place(tmp_path):
    places = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [-1, 0, 0], [-0.0, -0.0, -0.0]]
    faces = [[0, 1, 2, 3], [4, 5, 3, 6]]
    made = rhino_mesh([*places, [-1, 1, 0]], faces)
    assert len(gs.read_mesh(write_rhino(tmp_path / "a.3dm", made)).vertices) == 6


def test_meshes_inside_blocks_do_not_count(mesh, tmp_path):
    file = rhino3dm.File3dm()
    one = rhino_mesh(mesh.vertices, mesh.quads)
    attributes = rhino3dm.ObjectAttributes()
    origin = rhino3dm.Point3d(0, 0, 0)
    file.InstanceDefinitions.Add("block", "", "", "", origin, (one,), (attributes,))
    file.Objects.AddMesh(one, attributes)
    file.Write(str(tmp_path / "a.3dm"), 7)
    assert same(gs.read_mesh(tmp_path / "a.3dm"), mesh)


@pytest.mark.parametrize("corner", range(0, 80, 7))
def test_corners_that_are_only_near_are_not_welded_but_refused(corner, mesh, tmp_path):
    apart = mesh.vertices[mesh.quads].reshape(-1, 3).copy()
    inside = np.bincount(mesh.quads.ravel())[mesh.quads.ravel()[corner]] > 1
    apart[corner] += 1e-8
    write_rhino(tmp_path / "a.3dm", rhino_mesh(apart, np.arange(len(apart)).reshape(-1, 4)))
    if not inside:
        assert len(gs.read_mesh(tmp_path / "a.3dm").vertices) == len(mesh.vertices)
        return
    with pytest.raises(gs.MeshError, match="weld"):
        gs.require_sound(gs.read_mesh(tmp_path / "a.3dm"))


def test_vertices_in_one_place_of_a_compas_mesh_are_refused(mesh, tmp_path):
    apart = mesh.vertices[mesh.quads].reshape(-1, 3)
    faces = np.arange(len(apart)).reshape(-1, 4)
    Mesh.from_vertices_and_faces(apart.tolist(), faces.tolist()).to_json(str(tmp_path / "a.json"))
    found = gs.read_mesh(tmp_path / "a.json", unit=gs.Unit.MM)
    with pytest.raises(gs.MeshError, match="weld"):
        gs.require_sound(found)


def test_unused_vertices_stay_as_in_an_obj(mesh, tmp_path):
    points = np.vstack([[[9.0, 9.0, 9.0]], mesh.vertices])
    more = gs.QuadMesh(points, mesh.quads + 1)
    gs.write_obj(tmp_path / "a.obj", more, unit=gs.Unit.MM)
    truth = gs.read_mesh(tmp_path / "a.obj", unit=gs.Unit.MM)
    write_compas(tmp_path / "a.json", more)
    write_rhino(tmp_path / "a.3dm", rhino_mesh(points, mesh.quads + 1))
    for name in ("a.json", "a.3dm"):
        assert same(gs.read_mesh(tmp_path / name, unit=gs.Unit.MM), truth)


# ---- COMPAS ----------------------------------------------------------------------------------


def test_keys_need_not_count_from_nought(tmp_path):
    made = Mesh()
    a, b, c, d = (made.add_vertex(key=k, x=x, y=y) for k, x, y in
                  [(7, 0, 0), (3, 1, 0), (12, 1, 1), (5, 0, 1)])  # fmt: skip
    made.add_face([a, b, c, d], fkey=40)
    made.to_json(str(tmp_path / "a.json"))
    found = gs.read_mesh(tmp_path / "a.json", unit=gs.Unit.MM)
    corners = found.vertices[found.quads[0]].tolist()
    assert corners == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]


@pytest.mark.parametrize("wrap", [lambda m: [m], lambda m: {"roof": m, "count": 3}])
def test_a_mesh_among_other_things_is_found(wrap, mesh, tmp_path):
    made = Mesh.from_vertices_and_faces(mesh.vertices.tolist(), mesh.quads.tolist())
    compas.json_dump(wrap(made), str(tmp_path / "a.json"))
    assert same(gs.read_mesh(tmp_path / "a.json", unit=gs.Unit.MM), mesh)


def test_compas_need_not_be_installed(mesh, tmp_path, monkeypatch):
    write_compas(tmp_path / "a.json", mesh)
    monkeypatch.setitem(sys.modules, "compas", None)
    assert same(gs.read_mesh(tmp_path / "a.json", unit=gs.Unit.MM), mesh)


@pytest.fixture
def content(mesh, tmp_path):
    return json.loads(write_compas(tmp_path / "a.json", mesh).read_text("utf-8"))


@pytest.fixture
def refused(tmp_path):
    """The error that reading a text or a table ends with."""

    def reader(content, kind=gs.FileError):
        path = tmp_path / "b.json"
        path.write_text(content if isinstance(content, str) else json.dumps(content), "utf-8")
        with pytest.raises(kind) as info:
            gs.read_mesh(path, unit=gs.Unit.MM)
        assert str(path) in str(info.value)
        return info.value

    return reader


@pytest.mark.parametrize("text", ["", "v 0 0 0", "{", "[" * 100_000])
def test_what_is_not_json_is_refused(refused, text):
    assert refused(text).what == "The mesh file is not JSON"


@pytest.mark.parametrize("other", [[], {}, 3, {"dtype": "a/Point", "data": [0, 0, 0]}, {"a": 1}])
def test_json_without_a_mesh_is_refused(refused, other):
    assert "no mesh" in refused(other).what


def test_the_net_of_a_package_is_told_from_a_mesh(refused):
    assert "net.obj" in refused({"format": "gridshell-net", "vertices": []}).advice


def test_several_compas_meshes_are_named(refused, content):
    error = refused([{**content, "name": "roof"}, {**content, "name": "wall"}])
    assert (error.what, error.value) == (
        "The COMPAS file holds several meshes",
        "2: 'roof', 'wall'",
    )


@pytest.mark.parametrize("count", [0, 3, 5])
def test_a_face_that_is_no_quad_names_itself(refused, content, count):
    content["data"]["face"]["2"] = list(range(count))
    error = refused(content)
    assert (error.what, error.value) == ("A face is not a quad", f"{count} corners")
    assert error.where.endswith(", face 2")


@pytest.mark.parametrize("face", [[0, 1, 2, 99], [0, 1, 2, None], [0, 1, 2, [3]]])
def test_a_face_with_an_unknown_vertex_names_itself(refused, content, face):
    content["data"]["face"]["2"] = face
    assert refused(content).where.endswith(", face 2")


@pytest.mark.parametrize("vertex", [{"x": 1.0}, {"x": "1", "y": 0, "z": 0}, None, {"x": None}])
def test_a_vertex_without_a_place_names_itself(refused, content, vertex):
    content["data"]["default_vertex_attributes"] = {}
    content["data"]["vertex"]["4"] = vertex
    assert refused(content).where.endswith(", vertex 4")


def test_usual_coordinates_count_where_a_vertex_has_none(content, tmp_path, mesh):
    del content["data"]["vertex"]["0"]["z"]
    (tmp_path / "b.json").write_text(json.dumps(content), "utf-8")
    found = gs.read_mesh(tmp_path / "b.json", unit=gs.Unit.MM)
    assert found.vertices[0].tolist() == [*mesh.vertices[0, :2], 0.0]


@pytest.mark.parametrize(("key", "value"), [("face", {}), ("face", []), ("vertex", 3)])
def test_tables_that_are_none_are_refused(refused, content, key, value):
    content["data"][key] = value
    refused(content)


def test_places_that_are_not_finite_are_refused(content, tmp_path):
    content["data"]["vertex"]["0"]["z"] = float("nan")
    (tmp_path / "b.json").write_text(json.dumps(content), "utf-8")
    with pytest.raises(gs.MeshError):
        gs.read_mesh(tmp_path / "b.json", unit=gs.Unit.MM)


# ---- Rhino -----------------------------------------------------------------------------------


def fails(path, kind=gs.FileError, unit=None):
    with pytest.raises(kind) as info:
        gs.read_mesh(path, unit=unit)
    return info.value


def test_a_3dm_file_that_is_missing_or_none_is_refused(tmp_path):
    assert "missing" in fails(tmp_path / "a.3dm").what
    (tmp_path / "a.3dm").write_text("v 0 0 0")
    assert "no .3dm" in fails(tmp_path / "a.3dm").what


def test_a_3dm_file_without_a_mesh_says_what_it_holds(tmp_path):
    file = rhino3dm.File3dm()
    file.Objects.AddPoint(rhino3dm.Point3d(0, 0, 0))
    file.Objects.AddPoint(rhino3dm.Point3d(1, 0, 0))
    file.Objects.AddSphere(rhino3dm.Sphere(rhino3dm.Point3d(0, 0, 0), 1.0))
    file.Write(str(tmp_path / "a.3dm"), 7)
    assert fails(tmp_path / "a.3dm").value == "2 Point, 1 Surface"
    write_rhino(tmp_path / "b.3dm")
    assert fails(tmp_path / "b.3dm").value == "no objects"


def test_several_rhino_meshes_are_named_with_their_layers(mesh, tmp_path):
    one = rhino_mesh(mesh.vertices, mesh.quads)
    error = fails(write_rhino(tmp_path / "a.3dm", one, one, names=("roof",)))
    assert error.value.startswith("2: mesh 'roof'")
    assert "object 1" in error.value


def test_triangles_are_counted_and_their_object_named(mesh, tmp_path):
    made = rhino_mesh(mesh.vertices, mesh.quads)
    made.Faces.AddFace(0, 1, 2)
    error = fails(write_rhino(tmp_path / "a.3dm", made, names=("roof",)))
    assert error.value == "3 corners; 1 of 21 faces are triangles"
    assert "mesh 'roof'" in error.where
    assert error.where.endswith(", face 20")


def test_a_rhino_mesh_without_faces_is_refused(tmp_path):
    empty = rhino_mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0]], np.zeros((0, 4), dtype=int))
    path = write_rhino(tmp_path / "a.3dm", empty)
    assert "no faces" in fails(path).what or "no mesh" in fails(path).what


def test_a_unit_that_contradicts_the_3dm_file_is_refused(mesh, tmp_path):
    path = write_rhino(tmp_path / "a.3dm", rhino_mesh(mesh.vertices, mesh.quads))
    error = fails(path, gs.UnitError, gs.Unit.M)
    assert error.value == "m; the file says mm"


@pytest.mark.parametrize("stated", ["None", "Unset"])
def test_a_3dm_file_without_a_unit_needs_one(mesh, stated, tmp_path):
    unit = getattr(rhino3dm.UnitSystem, stated)
    path = write_rhino(tmp_path / "a.3dm", rhino_mesh(mesh.vertices, mesh.quads), unit=unit)
    assert "no unit" in fails(path, gs.UnitError).what
    assert same(gs.read_mesh(path, unit=gs.Unit.CM), mesh, 10.0)


def test_a_3dm_file_without_rhino3dm_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "rhino3dm", None)
    error = fails(tmp_path / "a.3dm", gs.SettingError)
    assert "rhino3dm" in error.what
    assert "interchange" in error.advice


# ---- the door --------------------------------------------------------------------------------


def test_other_endings_are_refused(tmp_path):
    assert fails(tmp_path / "a.ply", unit=gs.Unit.M).value == "'.ply'"


@pytest.mark.parametrize("name", ["a.obj", "a.json"])
def test_files_that_state_no_unit_need_one(name, tmp_path):
    assert "no unit" in fails(tmp_path / name, gs.UnitError).what
