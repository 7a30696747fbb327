"""Writes the same solid in every format that is read."""

import struct
import subprocess
import zipfile
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
    Format("3mf", "3MF", "solid.3mf"),
    Format("amf", "AMF, plain", "solid.amf"),
]


def make(lamella, body, folder):
    """Writes all files: STL and binary PLY by the program, texts with six decimals, as many programs write them.
    Returns the number of triangles."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for name, options in [("solid.stl", []), ("solid-ascii.stl", ["--ascii"]), ("solid.ply", [])]:
        subprocess.run([str(lamella), "make", *body, *options, "-o", str(folder / name)], check=True,
                       capture_output=True)
    vertices, triangles = read_ply(folder / "solid.ply")
    points = [f"{x:.6f} {y:.6f} {z:.6f}\n" for x, y, z in vertices]
    faces = [f"3 {a} {b} {c}\n" for a, b, c in triangles]
    header = (f"ply\nformat ascii 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\n"
            f"property float z\nelement face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
    write(folder / "solid-ascii.ply", [header], points, faces)
    write(folder / "solid.off", [f"OFF\n{len(points)} {len(faces)} 0\n"], points, faces)
    write(folder / "solid.obj", ["o solid\n"], [f"v {point}" for point in points],
          [f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in triangles])
    write_3mf(folder / "solid.3mf", vertices, triangles)
    write(folder / "solid.amf", ['<?xml version="1.0" encoding="UTF-8"?>\n<amf unit="millimeter">\n<object id="0">\n<mesh>\n<vertices>\n'],
          [f"<vertex><coordinates><x>{x:.6f}</x><y>{y:.6f}</y><z>{z:.6f}</z></coordinates></vertex>\n" for x, y, z in vertices],
          ["</vertices>\n<volume>\n"],
          [f"<triangle><v1>{a}</v1><v2>{b}</v2><v3>{c}</v3></triangle>\n" for a, b, c in triangles],
          ["</volume>\n</mesh>\n</object>\n</amf>\n"])
    return len(faces)


def write_3mf(path, vertices, triangles):
    model = "".join(
        ['<?xml version="1.0" encoding="UTF-8"?>\n<model unit="millimeter" xml:lang="en-US" '
         'xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">\n<resources>\n'
         '<object id="1" type="model">\n<mesh>\n<vertices>\n']
        + [f'<vertex x="{x:.6f}" y="{y:.6f}" z="{z:.6f}" />\n' for x, y, z in vertices] + ["</vertices>\n<triangles>\n"]
        + [f'<triangle v1="{a}" v2="{b}" v3="{c}" />\n' for a, b, c in triangles]
        + ['</triangles>\n</mesh>\n</object>\n</resources>\n<build>\n<item objectid="1" />\n</build>\n</model>\n'])
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as package:
        package.writestr("[Content_Types].xml",
                         '<?xml version="1.0" encoding="UTF-8"?>\n'
                         '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
                         '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
                         '<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>'
                         "</Types>")
        package.writestr("_rels/.rels",
                         '<?xml version="1.0" encoding="UTF-8"?>\n'
                         '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
                         '<Relationship Target="/3D/3dmodel.model" Id="rel0" '
                         'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>')
        package.writestr("3D/3dmodel.model", model)


def write(path, *parts):
    with open(path, "w", encoding="ascii", newline="\n") as file:
        for part in parts:
            file.writelines(part)


def read_ply(path):
    """Reads vertices and triangles of a binary PLY file as the program writes it in single precision."""
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:end].decode("ascii").splitlines()
    counts = [int(line.split()[2]) for line in header if line.startswith("element ")]
    if "property float x" not in header:
        raise SystemExit(f"{path}: expected single precision")
    vertex, face = struct.Struct("<3f"), struct.Struct("<B3I")
    faces_at = end + counts[0] * vertex.size
    return (list(vertex.iter_unpack(data[end:faces_at])),
            [row[1:] for row in face.iter_unpack(data[faces_at:faces_at + counts[1] * face.size])])
