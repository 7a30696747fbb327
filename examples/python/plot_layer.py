"""Slices a mesh and draws the layer at a height.

usage: plot_layer.py MESH HEIGHT_MM IMAGE
"""

import sys

import matplotlib

import lamella

matplotlib.use("Agg")  # draws into files, without a screen


def main(mesh, height, image):
    stack = lamella.slice(mesh, layer_height=0.1)
    layer = stack.at(float(height))
    axes = layer.plot()
    axes.set(xlim=stack.bounds[:, 0], ylim=stack.bounds[:, 1])
    axes.set_title(f"z = {layer.z:.2f} mm: {layer.area:.1f} mm²")
    axes.figure.savefig(image)
    print(f"{image}: layer {layer.index} of {len(stack)}, {layer.area:.3f} mm2")


if __name__ == "__main__":
    main(*sys.argv[1:])
