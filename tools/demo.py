#!/usr/bin/env python3
"""Makes two parts, slices them, verifies the slices against the meshes, and draws one of them.

usage: tools/demo.py PROGRAM FOLDER
"""

import json
import shutil
import subprocess
import sys
from pathlib import Path

PARTS = [
    ("sheet", "a sheet with 100 holes", ["make", "sheet", "--holes", "100"]),
    ("rook", "a chess rook", ["make", "rook"]),
]


def main(program, folder):
    folder.mkdir(parents=True, exist_ok=True)
    for name, title, make in PARTS:
        mesh, cli, svg, stats = (folder / f"{name}.{end}" for end in ("stl", "cli", "svg", "json"))
        run(program, *make, "-o", mesh)
        run(program, "slice", mesh, "-o", cli, "--layer-height", "0.1", "--stats", stats)
        run(program, "slice", mesh, "-o", svg, "--layer-height", "0.1")
        report(title, json.loads(stats.read_text(encoding="utf-8")),
               *(json.loads(run(program, "verify", file, "--mesh", mesh, "--json")) for file in (cli, svg)))

    image = folder / "rook_layers.svg"
    run(sys.executable, Path(__file__).with_name("draw_layers.py"), folder / "rook.svg", image)
    if shutil.which("rsvg-convert"):
        run("rsvg-convert", "--zoom", "2", "--output", image.with_suffix(".png"), image)
        image = image.with_suffix(".png")
    print(f"The slice files are in {folder}/; for an image open {image}.")
    page = folder / "rook.html"
    if view(program, folder / "rook.stl", page):
        print(f"To look at all layers, open {page} with a browser.")


def report(title, stats, *checks):
    print(f"{title}: {stats['input']['triangles']:,} triangles")
    print(f"    sliced    {len(stats['layers'])} layers, {stats['contours']:,} contours, {stats['points']:,} points "
          f"in {stats['seconds']['total']:.2f} s, file to file")
    error = max(check["max_area_error_mm2"] for check in checks)
    print(f"    verified  every contour closed and oriented, none crossing; each layer's area within\n"
          f"              {error:.2g} mm2 of the section of the mesh; volume {checks[0]['volume_mm3']:,.1f} mm3\n")


def view(program, mesh, page):
    """Writes a page of the layers. If the program was built without the viewer, prints that and returns False."""
    result = subprocess.run([program, "view", mesh, "-o", page], capture_output=True, text=True, check=False)
    if result.returncode == 2 and "no viewer" in result.stderr:
        print(f"The page is left out: {result.stderr.strip().removeprefix('lamella: error: ')}")
        return False
    if result.returncode != 0:
        sys.exit(f"demo: lamella view {mesh}\n{result.stdout}{result.stderr}exit code {result.returncode}")
    return True


def run(*command):
    """Returns the output of the command. If it fails, prints its output and exits."""
    result = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)
    if result.returncode != 0:
        sys.exit(f"demo: {' '.join(str(part) for part in command)}\n{result.stdout}{result.stderr}"
                 f"exit code {result.returncode}")
    return result.stdout


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__.strip())
    main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]))
