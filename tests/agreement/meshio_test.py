"""OBJ, PLY and OFF files of meshio, an independent program, and ours for it: the same meshes either way."""

import gzip
import sys
from pathlib import Path

import meshio
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "app"))
from program import ProgramTest, main


def volume(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return float(numpy.einsum("ij,ij->i", a, numpy.cross(b, c)).sum() / 6)


class Meshio(ProgramTest):
    def expect(self, name, points, triangles):
        found = self.succeed("info", name, "--json").json()
        self.assertEqual(found["triangles"], len(triangles))
        self.assertTrue(found["closed"])
        self.assertAlmostEqual(found["volume_mm3"], volume(points, triangles), delta=1e-6 * abs(found["volume_mm3"]))
        for corner, expected in zip(found["bbox"], [points.min(axis=0), points.max(axis=0)]):
            for value, other in zip(corner, expected):
                self.assertAlmostEqual(value, other, delta=1e-6)

    def test_reads_what_we_write(self):
        for body in ["rook", "torus", "calibration"]:
            for extension in ["obj", "ply"]:
                with self.subTest(body=body, extension=extension):
                    name = f"{body}.{extension}"
                    self.succeed("make", body, "-o", name)
                    mesh = meshio.read(self.folder / name)
                    self.expect(name, mesh.points.astype(float), mesh.get_cells_type("triangle"))

    def test_writes_what_we_read(self):
        self.succeed("make", "rook", "-o", "rook.ply")
        mesh = meshio.read(self.folder / "rook.ply")
        points, triangles = mesh.points.astype(float), mesh.get_cells_type("triangle")
        for name, options in [("a.obj", {}), ("a.off", {}), ("a.ply", {"binary": False}), ("b.ply", {"binary": True})]:
            with self.subTest(name):
                meshio.write(self.folder / name, meshio.Mesh(points, [("triangle", triangles)]), **options)
                self.expect(name, points, triangles)
                packed = self.folder / f"{name}.gz"
                packed.write_bytes(gzip.compress((self.folder / name).read_bytes(), 1))
                self.expect(packed.name, points, triangles)

    def test_writes_squares_that_we_read(self):
        points = numpy.array([[x, y, z] for z in (0, 3) for y in (0, 2) for x in (0, 1)], dtype=float)
        squares = numpy.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]])
        triangles = numpy.concatenate([squares[:, [0, 1, 2]], squares[:, [0, 2, 3]]])
        for name in ["box.obj", "box.ply"]:
            with self.subTest(name):
                meshio.write(self.folder / name, meshio.Mesh(points, [("quad", squares)]))
                self.expect(name, points, triangles)


if __name__ == "__main__":
    main()
