"""Slices every mesh of a folder on a local cluster of processes, and prints their volumes.

usage: batch_with_dask.py FOLDER LAYER_HEIGHT_MM [PROCESSES]
"""

import sys
from pathlib import Path

from dask.distributed import Client, LocalCluster

import lamella


def sliced(path, layer_height):
    """One thread for each: the cluster has a process for each processor."""
    return lamella.slice(path, layer_height, threads=1)


def main(folder, layer_height, processes="2"):
    meshes = sorted(str(path) for path in Path(folder).glob("*.stl"))
    with LocalCluster(n_workers=int(processes), threads_per_worker=1, dashboard_address=None) as cluster:
        with Client(cluster) as client:
            stacks = client.gather(client.map(sliced, meshes, layer_height=float(layer_height)))
    for path, stack in zip(meshes, stacks):
        lamella.write(Path(path).with_suffix(".cli"), stack)
        print(f"{Path(path).name}: {len(stack)} layers, {stack.volume:.3f} mm3")


if __name__ == "__main__":
    main(*sys.argv[1:])
