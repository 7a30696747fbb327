"""Pictures agree with PrusaSlicer's, whichever way a display is held. Skipped where it is not installed."""

import itertools
import math
import os
import shutil
import subprocess
import unittest
import zipfile

from png_image import Image
from program import ProgramTest, binary_stl, box_triangles, main


def slanted_part():
    """Two boxes that overlap, turned, with the middle of their box at (6, 4)."""
    moved = [tuple((x + 0.5, y + 0.5, z) for x, y, z in t) for t in box_triangles(2.02, 5.01, 2)]
    c, s = math.cos(0.2), math.sin(0.2)
    turned = [tuple((c * x - s * y, s * x + c * y, z) for x, y, z in t)
              for t in box_triangles(6.03, 3.07, 2) + moved]
    xs, ys = ([p[axis] for t in turned for p in t] for axis in (0, 1))
    dx, dy = 6 - (min(xs) + max(xs)) / 2, 4 - (min(ys) + max(ys)) / 2
    return [tuple((x + dx, y + dy, z) for x, y, z in t) for t in turned]


@unittest.skipUnless(shutil.which("prusa-slicer"), "prusa-slicer is not installed")
class Prusa(ProgramTest):
    def test_all_ways_to_hold_a_display_agree(self):
        self.write("part.stl", binary_stl(slanted_part()))
        for orientation, mirror_x, mirror_y in itertools.product(("landscape", "portrait"), (0, 1), (0, 1)):
            with self.subTest(orientation=orientation, mirror_x=mirror_x, mirror_y=mirror_y):
                subprocess.run(
                    ["prusa-slicer", "--export-sla", "--supports-enable=0", "--pad-enable=0",
                     "--dont-arrange", "--slice-closing-radius", "0", "--layer-height", "0.5", "--initial-layer-height", "0.5",
                     "--display-width", "12", "--display-height", "8", "--display-pixels-x", "120",
                     "--display-pixels-y", "80", "--display-orientation", orientation,
                     "--display-mirror-x" if mirror_x else "--no-display-mirror-x",
                     "--display-mirror-y" if mirror_y else "--no-display-mirror-y",
                     "-o", "theirs.sl1", "part.stl"],
                    cwd=self.folder, capture_output=True, check=True, timeout=120,
                    env={**os.environ, "HOME": str(self.folder)})
                axes = ("x" if mirror_x else "") + ("y" if mirror_y else "")
                self.succeed("slice", "part.stl", "-o", "ours.sl1", "--layer-height", "0.5",
                             "--display-size", "12,8", "--resolution", "120x80",
                             "--orientation", orientation, "--mirror", axes or "none")
                theirs = zipfile.ZipFile(self.path("theirs.sl1"))
                ours = zipfile.ZipFile(self.path("ours.sl1"))
                for layer in range(4):
                    their_image = Image(theirs.read(f"theirs{layer:05}.png"))
                    our_image = Image(ours.read(f"ours{layer:05}.png"))
                    self.assertEqual((our_image.width, our_image.height),
                                     (their_image.width, their_image.height))
                    differences = [abs(a - b) for mine, other in zip(our_image.rows, their_image.rows)
                                   for a, b in zip(mine, other)]
                    # Theirs rounds to 256ths of a pixel, ours decides corners in eighths of a row.
                    self.assertLess(max(differences), 16)
                    self.assertLess(sum(differences) / 255, 0.002 * our_image.covered())

    def test_a_job_says_what_theirs_says(self):
        self.write("part.stl", binary_stl(slanted_part()))
        # An SL1's printer profile, as far as the program without its window knows it.
        subprocess.run(["prusa-slicer", "--export-sla", "--supports-enable=0", "--pad-enable=0", "--slice-closing-radius", "0",
                        "--layer-height", "0.1", "--initial-layer-height", "0.1", "--exposure-time", "7.5",
                        "--initial-exposure-time", "35", "--faded-layers", "8", "--display-width", "120.96",
                        "--display-height", "68.04", "--display-pixels-x", "2560", "--display-pixels-y", "1440",
                        "--display-orientation", "portrait", "-o", "theirs.sl1", "part.stl"],
                       cwd=self.folder, capture_output=True, check=True, timeout=120,
                       env={**os.environ, "HOME": str(self.folder)})
        self.succeed("slice", "part.stl", "-o", "ours.sl1", "--layer-height", "0.1", "--fade-layers", "8")
        theirs, ours = (zipfile.ZipFile(self.path(name)) for name in ("theirs.sl1", "ours.sl1"))

        def settings(archive, name):
            lines = archive.read(name).decode().splitlines()
            return dict(line.split(" = ", 1) if " = " in line else (line.rstrip(" ="), "") for line in lines)

        theirs_job, our_job = settings(theirs, "config.ini"), settings(ours, "config.ini")
        self.assertEqual(our_job.keys(), theirs_job.keys())
        for key in ("action", "expTime", "expTimeFirst", "expUserProfile", "hollow", "layerHeight", "materialName",
                    "numFade", "numFast", "numSlow", "printProfile"):
            self.assertEqual(our_job[key], theirs_job[key], key)
        # Theirs counts the material of its meshes, ours that of the pictures.
        self.assertAlmostEqual(float(our_job["usedMaterial"]), float(theirs_job["usedMaterial"]), delta=0.002)
        theirs_profile, our_profile = (settings(archive, "prusaslicer.ini") for archive in (theirs, ours))
        # It keeps the name of a printer only where one of its profiles was chosen.
        self.assertEqual(our_profile.keys() - theirs_profile.keys(), {"printer_model", "printer_variant"})
        self.assertEqual([our_profile[key] for key in our_profile if key.startswith("display_p")],
                         [theirs_profile[key] for key in our_profile if key.startswith("display_p")])
        layers = [name.removeprefix("theirs") for name in theirs.namelist() if name.startswith("theirs")]
        self.assertEqual([name.removeprefix("ours") for name in ours.namelist() if name.startswith("ours")], layers)


if __name__ == "__main__":
    main()
