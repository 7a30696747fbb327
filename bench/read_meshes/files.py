"""The same solid in every format that is read."""

import struct
import subprocess
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Format:
    name: str
    title: str
    file: str


FORMATS = [
    Format("stl", "STL, binary", "solid.stl"),
    Format("stl-ascii", "STL, ASCII", "solid-ascii.stl"),
    Format("ply", "PLY, binary", "solid.ply"),
    Format("ply-ascii", "PLY, ASCII", "solid-ascii.ply"),
    Format("obj", "OBJ", "solid.obj"),
    Format("off", "OFF", "solid.off"),
]


def make(lamella, body, folder):
    """Writes all files: STL and binary PLY by the program, texts with six digits after the point, as many programs
    write them. Returns the number of triangles."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for name, options in [("solid.stl", []), ("solid-ascii.stl", ["--ascii"]), ("solid.ply", [])]:
        subprocess.run([str(lamella), "make", *body, *options, "-o", str(folder / name)], check=True,
                       capture_output=True)
    vertices, triangles = read_ply(folder / "solid.ply")
    points = [f"{x:.6f} {y:.6f} {z:.6f}\n" for x, y, z in vertices]
    faces = [f"3 {a} {b} {c}\n" for a, b, c in triangles]
    head = (f"ply\nformat ascii 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\n"
            f"property float z\nelement face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
    write(folder / "solid-ascii.ply", [head], points, faces)
    write(folder / "solid.off", [f"OFF\n{len(points)} {len(faces)} 0\n"], points, faces)
    write(folder / "solid.obj", ["o solid\n"], [f"v {point}" for point in points],
          [f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in triangles])
    return len(faces)


def write(path, *parts):
    with open(path, "w", encoding="ascii", newline="\n") as file:
        for part in parts:
            file.writelines(part)


def read_ply(path):
    """Vertices and triangles of a binary PLY file as the program writes it in single precision."""
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    head = data[:end].decode("ascii").splitlines()
    counts = [int(line.split()[2]) for line in head if line.startswith("element ")]
    if "property float x" not in head:
        raise SystemExit(f"{path}: expected single precision")
    vertex, face = struct.Struct("<3f"), struct.Struct("<B3I")
    faces_at = end + counts[0] * vertex.size
    return (list(vertex.iter_unpack(data[end:faces_at])),
            [row[1:] for row in face.iter_unpack(data[faces_at:faces_at + counts[1] * face.size])])
