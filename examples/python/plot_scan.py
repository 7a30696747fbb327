"""Draws the scan vectors of the layer nearest to a height: each exposure in a colour, jumps faint.

usage: plot_scan.py MESH HEIGHT_MM PICTURE [STRATEGY]
"""

import sys

import matplotlib
import numpy as np

import lamella

matplotlib.use("Agg")  # draws into files, without a screen
from matplotlib.collections import LineCollection  # noqa: E402
from matplotlib.pyplot import subplots  # noqa: E402


def main(mesh, height, image, strategy=None):
    stack = lamella.slice(mesh, layer_height=0.1)
    number = int(np.abs(stack.z - float(height)).argmin())
    # Skins depend on the layers around, so all of them are scanned up to this one.
    scanned = next(layer for layer in lamella.scan(stack, strategy) if layer.index == stack[number].index)
    figure, axes = subplots(dpi=200)
    vectors = scanned.vectors
    axes.add_collection(
        LineCollection(np.stack([vectors[:-1, 1], vectors[1:, 0]], axis=1), color="silver", linewidth=0.2)
    )
    for i, exposure in enumerate(scanned.exposures):
        lines = vectors[scanned.exposure == i]
        axes.add_collection(LineCollection(lines, color=f"C{i}", linewidth=0.4, label=exposure.name))
    axes.set(xlim=stack.bounds[:, 0], ylim=stack.bounds[:, 1], aspect="equal", xlabel="x in mm", ylabel="y in mm")
    axes.set_title(f"z = {scanned.z:.2f} mm: {sum(f.build_seconds for f in scanned.figures):.1f} s")
    axes.legend()
    figure.savefig(image)
    print(f"{image}: layer {scanned.index}, {len(vectors)} lines")


if __name__ == "__main__":
    main(*sys.argv[1:])
