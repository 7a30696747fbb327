#!/usr/bin/env python3
"""The layers of all bodies, and of the meshes of public projects where they are, have the hashes of the table that holds
on every system, with one thread and with several."""

import csv
import os
import unittest
from pathlib import Path

from program import SOURCE, ProgramTest, main

SHARED = Path(os.environ.get("LAMELLA_SHARED", SOURCE.parent / "shared"))


def rows():
    with open(SOURCE / "tests" / "fixtures" / "layer_hashes.tsv", encoding="utf-8", newline="") as table:
        return list(csv.DictReader((line for line in table if not line.startswith("#")), delimiter="\t"))


class LayerHashes(ProgramTest):
    def expect_the_hashes(self, path, row):
        for threads in [1, 7]:
            with self.subTest(mesh=row["mesh"], rotated=row["rotated"], threads=threads):
                stats = self.succeed("slice", path, "--layer-height", row["height_mm"], "--rotate", row["rotated"],
                                     "--threads", threads, "--stats", "-").json()
                self.assertEqual((len(stats["layers"]), stats["hash"]), (int(row["layers"]), row["hash"]))

    def test_the_layers_of_all_bodies(self):
        for row in rows():
            if row["mesh"].startswith("meshes/"):
                continue
            path = row["mesh"] + ".stl"
            if not self.path(path).exists():
                self.succeed("make", row["mesh"], *row["options"].split(), "-o", path)
            self.expect_the_hashes(path, row)

    @unittest.skipUnless((SHARED / "meshes").is_dir(), f"no folder of meshes in {SHARED}")
    def test_the_layers_of_meshes_of_public_projects(self):
        for row in rows():
            path = SHARED / row["mesh"]
            if path.is_file():
                self.expect_the_hashes(path, row)


if __name__ == "__main__":
    main()
