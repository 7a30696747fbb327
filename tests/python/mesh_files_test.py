"""Files of meshes."""

import io
import pickle

import numpy as np
import pytest
from conftest import box_arrays, nested_boxes

import lamella


@pytest.mark.parametrize("extension", ["stl", "ply", "obj"])
def test_meshes_are_written_and_read(tmp_path, extension):
    path = tmp_path / f"mesh.{extension}"
    lamella.write(path, lamella.Mesh(*nested_boxes()))
    back = lamella.read(path)
    assert isinstance(back, lamella.Mesh)
    assert (len(back), back.vertices.shape) == (36, (24, 3))
    assert np.isclose(back.volume, 1000 - 512 + 64)
    assert lamella.slice(path, 1) == lamella.slice(nested_boxes(), 1)


class Trimesh:
    vertices, faces = box_arrays()


class Open3d:
    vertices, triangles = box_arrays()


class Polydata:
    points = box_arrays()[0]
    regular_faces = box_arrays()[1]


class OldPolydata:
    points = box_arrays()[0]
    faces = np.insert(box_arrays()[1], 0, 3, axis=1).ravel()

    @property
    def regular_faces(self):
        raise ValueError("faces are not of one size")


@pytest.mark.parametrize("name", ["stl", "ply", "obj"])
def test_meshes_of_any_kind_are_written(tmp_path, name):
    mesh = lamella.Mesh(*box_arrays())
    lamella.write(tmp_path / f"part.{name}", mesh)
    expected = (tmp_path / f"part.{name}").read_bytes()
    for content in (mesh, box_arrays(), list(box_arrays()), Trimesh(), Open3d(), Polydata(), OldPolydata()):
        target = io.BytesIO()
        lamella.write(target, content, format=name)
        assert target.getvalue() == expected
        lamella.write(tmp_path / "out", content, format=name)
        assert (tmp_path / "out").read_bytes() == expected
        assert lamella.slice(content, 1) == lamella.slice(mesh, 1)
    triangles = io.BytesIO()
    lamella.write(triangles, box_arrays()[0][box_arrays()[1]], format=name)
    assert lamella.slice(triangles.getvalue(), 1) == lamella.slice(mesh, 1)


def test_polygons_of_more_corners_are_refused():
    class Quads(OldPolydata):
        faces = np.array([4, 0, 2, 3, 1, 3, 0, 1, 5])

    with pytest.raises(lamella.UsageError, match="part: faces: expected 3 before .* must be cut into triangles first"):
        lamella.slice(Quads())


def test_stl_files_report_what_single_precision_takes(tmp_path):
    lamella.write(tmp_path / "exact.stl", lamella.Mesh(*box_arrays()), strict=True)
    vertices, faces = box_arrays(at=(1e6, 0, 0))
    thin = lamella.Mesh(np.where(vertices == 1e6 + 20, 1e6 + 0.01, vertices), faces)
    with pytest.warns(lamella.DefectWarning, match="thin.stl: 8 triangles lose their area"):
        lamella.write(tmp_path / "thin.stl", thin)
    with pytest.raises(lamella.DefectError, match="8 triangles"):
        lamella.write(tmp_path / "strict.stl", thin, strict=True)
    with pytest.raises(lamella.OutputError, match="huge.stl: .* write it as .ply or .obj"):
        lamella.write(tmp_path / "huge.stl", lamella.Mesh(vertices * 1e33, faces))
    lamella.write(tmp_path / "huge.ply", lamella.Mesh(vertices * 1e33, faces))
    assert {path.name for path in tmp_path.iterdir()} == {"exact.stl", "thin.stl", "huge.ply"}


def test_supports_are_read_where_they_are_asked_for(tmp_path):
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    vertices = "".join("<vertex><coordinates><x>%d</x><y>%d</y><z>%d</z></coordinates></vertex>" % p for p in points)
    volume = ">" + "".join(
        "<triangle><v1>%d</v1><v2>%d</v2><v3>%d</v3></triangle>" % t
        for t in [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    )
    path = tmp_path / "part.amf"
    path.write_text(
        f"<amf><object id='0'><mesh><vertices>{vertices}</vertices><volume{volume}</volume>"
        f"<volume type='support'{volume}</volume></mesh></object></amf>"
    )
    with pytest.warns(lamella.DefectWarning, match="1 body was left out as no material: 1 support"):
        assert len(lamella.read(path)) == 4
    assert len(lamella.read(path, include="support")) == 8
    assert len(lamella.read(path, include=["modifier", "support"])) == 8
    with pytest.raises(lamella.UsageError, match="expected one of support, negative"):
        lamella.read(path, include="thing")
    with pytest.raises(TypeError, match="include: expected a word or several"):
        lamella.read(path, include=3)


def test_negative_volumes_are_subtracted_however_a_mesh_is_sliced(tmp_path):
    def tetrahedra(size, at):
        corners = [(0, 0, 0), (size, 0, 0), (0, size, 0), (0, 0, size)]
        return "".join(
            f"<vertex><coordinates><x>{x + at}</x><y>{y + at}</y><z>{z}</z></coordinates></vertex>" for x, y, z in corners
        )

    def volume(first, mark):
        faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
        return f"<volume><metadata type='slic3r.volume_type'>{mark}</metadata>" + "".join(
            f"<triangle><v1>{a + first}</v1><v2>{b + first}</v2><v3>{c + first}</v3></triangle>" for a, b, c in faces
        ) + "</volume>"

    path = tmp_path / "part.amf"
    path.write_text(
        f"<amf><object id='0'><mesh><vertices>{tetrahedra(10, 0)}{tetrahedra(4, 1)}</vertices>"
        f"{volume(0, 'ModelPart')}{volume(4, 'NegativeVolume')}</mesh></object></amf>"
    )
    mesh = lamella.read(path)
    stack = lamella.slice(mesh, 1)
    assert len(mesh) == 4
    area = stack[0].area
    assert area == pytest.approx(9.5**2 / 2 - 3.5**2 / 2)
    assert [layer.area for layer in lamella.iter_layers(mesh, 1)] == [layer.area for layer in stack]
    moved = [[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    assert lamella.slice(mesh, 1, transform=moved)[0].area == pytest.approx(area)
    with pytest.warns(lamella.DefectWarning, match="its negative volumes are not subtracted"):
        lamella.write(tmp_path / "part.obj", mesh)
    assert lamella.verify(stack, mesh).ok
    solid = lamella.read(path, include=["negative"])
    assert not lamella.verify(stack, solid).ok
    with pytest.raises(lamella.UsageError, match="cannot be pickled"):
        pickle.dumps(mesh)
