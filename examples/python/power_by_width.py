"""Less power where material is narrow: heat of one line is still there when the next one comes.

usage: power_by_width.py MESH LAYER_HEIGHT_MM WIDTH_MM

Lines at least WIDTH_MM long have the power of the strategy, shorter ones less, down to 60 % of it.
"""

import sys

import numpy as np

import lamella


def powers(scanned, width):
    """A power for each line of a layer, in watts. Contours keep theirs."""
    power = np.array([exposure.parameters.power_w for exposure in scanned.exposures])[scanned.exposure]
    hatch = np.array([exposure.kind == "hatch" for exposure in scanned.exposures])[scanned.exposure]
    lengths = np.linalg.norm(scanned.vectors[:, 1] - scanned.vectors[:, 0], axis=1)
    return np.where(hatch, power * np.clip(0.6 + 0.4 * lengths / width, 0.6, 1), power), lengths


def main(mesh, layer_height, width):
    lines = reduced = 0
    length = before = after = 0.0
    for scanned in lamella.scan(lamella.iter_layers(mesh, float(layer_height))):
        power, lengths = powers(scanned, float(width))
        full = np.array([exposure.parameters.power_w for exposure in scanned.exposures])[scanned.exposure]
        speed = np.array([exposure.parameters.speed_mm_s for exposure in scanned.exposures])[scanned.exposure]
        lines += len(lengths)
        reduced += int((power < full).sum())
        length += lengths.sum()
        before += (full * lengths / speed).sum()
        after += (power * lengths / speed).sum()
    print(f"{lines} lines, {length:.3f} mm; {reduced} of them with less power: {before:.3f} J become {after:.3f} J")


if __name__ == "__main__":
    main(*sys.argv[1:])
