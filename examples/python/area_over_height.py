"""The area of a part over its height: what a layer costs, and where it changes fastest.

Layers are taken one by one, so that parts of any size fit into memory.

usage: area_over_height.py MESH LAYER_HEIGHT_MM PICTURE
"""

import sys

import matplotlib
import numpy as np

import lamella

matplotlib.use("Agg")  # draws into files, without a screen
from matplotlib.pyplot import subplots  # noqa: E402


def main(mesh, layer_height, image):
    measured = [(layer.z, layer.area, layer.thickness) for layer in lamella.iter_layers(mesh, float(layer_height))]
    z, area, thickness = np.array(measured).T
    steepest = np.abs(np.diff(area, append=area[-1])).argmax()
    figure, axes = subplots()
    axes.step(z, area, where="mid")
    axes.set(xlabel="z in mm", ylabel="area in mm²", title=f"volume {(area * thickness).sum():.1f} mm³")
    figure.savefig(image)
    print(f"{len(z)} layers, {(area * thickness).sum():.3f} mm3, largest step at z = {z[steepest]:.3f} mm")


if __name__ == "__main__":
    main(*sys.argv[1:])
