"""Slices a mesh and draws the layer nearest to a height.

usage: plot_layer.py MESH HEIGHT_MM PICTURE
"""

import sys

import matplotlib
import numpy as np

import lamella

matplotlib.use("Agg")  # draws into files, without a screen
from matplotlib.patches import PathPatch  # noqa: E402
from matplotlib.path import Path  # noqa: E402
from matplotlib.pyplot import subplots  # noqa: E402


def filled(layer):
    """All rings as one path: matplotlib leaves holes out, since they run in the opposite direction."""
    rings = [Path(np.vstack([ring, ring[:1]]), closed=True) for ring, closed in zip(layer, layer.closed) if closed]
    return Path.make_compound_path(*rings)


def main(mesh, height, image):
    stack = lamella.slice(mesh, layer_height=0.1)
    layer = stack[int(np.abs(stack.z - float(height)).argmin())]
    figure, axes = subplots()
    axes.add_patch(PathPatch(filled(layer), facecolor="lightsteelblue", edgecolor="navy", linewidth=0.5))
    axes.set(xlim=stack.bounds[:, 0], ylim=stack.bounds[:, 1], aspect="equal", xlabel="x in mm", ylabel="y in mm")
    axes.set_title(f"z = {layer.z:.2f} mm: {layer.area:.1f} mm²")
    figure.savefig(image)
    print(f"{image}: layer {layer.index} of {len(stack)}, {layer.area:.3f} mm2")


if __name__ == "__main__":
    main(*sys.argv[1:])
