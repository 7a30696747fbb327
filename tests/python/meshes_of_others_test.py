"""Meshes of other packages, whose objects have arrays of other names."""

import numpy as np
import pytest
from conftest import box_arrays

import lamella


class Cells:
    """As a meshio.Mesh, which also has a method `read` that takes a path."""

    def __init__(self, points, cells_dict):
        self.points = points
        self.cells_dict = cells_dict

    @classmethod
    def read(cls, path):
        raise AssertionError(path)


class Vectors:
    """As a stl.mesh.Mesh of numpy-stl, whose points are rows of nine numbers."""

    def __init__(self, vectors):
        self.vectors = vectors
        self.points = vectors.reshape(-1, 9)


def expect_box(mesh):
    expected = lamella.slice(box_arrays(), 1)
    assert lamella.slice(mesh, 1) == expected
    assert lamella.inspect(mesh).volume == lamella.inspect(box_arrays()).volume
    assert lamella.slice([lamella.Part(mesh)], 1).volume == expected.volume


def test_meshes_with_cells_by_type_are_taken():
    vertices, faces = box_arrays()
    expect_box(Cells(vertices, {"triangle": faces}))
    expect_box(Cells(vertices, {"line": np.array([[0, 1]]), "triangle": faces, "vertex": np.array([[0]])}))
    for cells, found in ({"quad": np.zeros((1, 4), int)}, "quad"), ({"triangle": faces, "tetra": np.zeros((1, 4), int)}, "tetra"):
        with pytest.raises(lamella.UsageError, match=f"cells: expected triangles, found {found}"):
            lamella.slice(Cells(vertices, cells), 1)
    with pytest.raises(lamella.UsageError, match="cells: expected triangles, found none"):
        lamella.slice(Cells(vertices, {}), 1)


def test_meshes_with_corners_of_triangles_are_taken():
    vertices, faces = (np.asarray(array) for array in box_arrays())
    expect_box(Vectors(vertices[faces]))


def test_meshes_of_meshio_are_taken():
    meshio = pytest.importorskip("meshio")
    vertices, faces = box_arrays()
    expect_box(meshio.Mesh(np.asarray(vertices, float), [("triangle", np.asarray(faces))]))


def test_poly_data_of_vtk_is_taken():
    data = pytest.importorskip("vtkmodules.vtkCommonDataModel")
    core = pytest.importorskip("vtkmodules.vtkCommonCore")
    vertices, faces = box_arrays()
    points, polygons, mesh = core.vtkPoints(), data.vtkCellArray(), data.vtkPolyData()
    points.SetDataTypeToDouble()
    for vertex in vertices:
        points.InsertNextPoint(vertex)
    for face in faces:
        polygons.InsertNextCell(3, [int(corner) for corner in face])
    mesh.SetPoints(points)
    mesh.SetPolys(polygons)
    expect_box(mesh)
