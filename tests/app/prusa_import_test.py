"""PrusaSlicer takes our SL1 archives back: its window imports one, on a screen in memory, and what it then saves is the part.
Only the window can import. Skipped where one of the programs is not installed."""

import json
import os
import shutil
import subprocess
import time
import unittest
from pathlib import Path

from program import ProgramTest, binary_stl, box_triangles, main

NEEDED = ("prusa-slicer", "Xvfb", "openbox", "xdotool", "localedef")
SETTINGS = """version = 2.5.0
version_check = 0
version_system_info_sent = 2.5.0
preset_update = 0
notify_release = none
show_splash_screen = 0
show_hints = 0

[presets]
printer = resin
"""


def moved(triangles, by):
    return [tuple(tuple(c + d for c, d in zip(corner, by)) for corner in triangle) for triangle in triangles]


def installed():
    return all(map(shutil.which, NEEDED)) and Path("/usr/share/i18n/locales/en_US").exists()


class Window:
    """PrusaSlicer on a screen of its own. Everything is typed, so that neither fonts nor sizes matter."""

    def __init__(self, test, folder):
        self.test = test
        home = folder / "home"
        (home / "printer").mkdir(parents=True)
        (home / "PrusaSlicer.ini").write_text(SETTINGS)
        # Some printer for resins: without one the program asks for it first.
        subprocess.run(["prusa-slicer", "--datadir", folder / "other", "--printer-technology", "SLA", "--save",
                        home / "printer" / "resin.ini"], check=True, capture_output=True, timeout=120)
        subprocess.run(["localedef", "-i", "en_US", "-f", "UTF-8", folder / "en_US.UTF-8"], check=True, capture_output=True,
                       timeout=120)
        screen, write = os.pipe()
        self.start("Xvfb", "-displayfd", str(write), "-screen", "0", "1400x1000x24", "+extension", "GLX", pass_fds=(write,))
        os.close(write)
        with os.fdopen(screen) as number:
            display = ":" + number.readline().strip()
        self.environment = {**os.environ, "DISPLAY": display, "HOME": str(folder), "LANG": "en_US.UTF-8",
                            "LOCPATH": str(folder), "LIBGL_ALWAYS_SOFTWARE": "1"}
        self.environment.pop("LC_ALL", None)
        self.start("openbox", env=self.environment)
        self.start("prusa-slicer", "--datadir", str(home), env=self.environment)

    def start(self, *command, **keywords):
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **keywords)
        self.test.addCleanup(process.wait)
        self.test.addCleanup(process.kill)

    def send(self, *words):
        return subprocess.run(["xdotool", *words], env=self.environment, capture_output=True, timeout=60).returncode == 0

    def shows(self, title):
        return self.send("search", "--onlyvisible", "--name", title)

    def wait(self, what, until, again=lambda: None, seconds=120):
        """Until it is so; `again` is done every few seconds, as a window may not listen yet."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            again()
            for _ in range(20):
                if until():
                    time.sleep(1)  # what is shown is not yet ready for keys
                    return
                time.sleep(0.25)
        self.test.fail(f"PrusaSlicer: {what} in {seconds} s")

    def open_import(self):
        self.send("key", "Escape", "key", "Escape", "key", "alt+f", "sleep", "1", "key", "i", "sleep", "1", "key", "Down", "key",
                  "Down", "key", "Return")

    def open_save(self):
        # A plate on which nothing has arrived yet makes it ask whether to save that.
        self.send("key", "Escape", "mousemove", "700", "900", "sleep", "0.5", "click", "1", "sleep", "0.5", "key", "ctrl+s")

    def import_archive(self, path):
        self.wait("no main window", lambda: self.shows("PrusaSlicer-2"))
        self.wait("no way to import", lambda: self.shows("Import SLA archive"), self.open_import)
        self.wait("no choice of a file", lambda: self.shows("Choose SLA archive"), lambda: self.send("key", "space"))
        self.send("type", "--delay", "30", str(path))
        self.send("sleep", "1", "key", "Return")
        self.wait("the choice stays", lambda: not self.shows("Choose SLA archive"))
        self.send("key", "shift+Tab", "sleep", "0.5", "key", "space")
        self.wait("the import does not begin", lambda: not self.shows("Import SLA archive"))

    def save(self, path):
        self.wait("no way to save", lambda: self.shows("Save file as"), self.open_save)
        self.send("key", "ctrl+a")
        self.send("type", "--delay", "30", str(path))
        self.send("sleep", "1", "key", "Return")
        self.wait("nothing is saved", path.exists)


@unittest.skipUnless(installed(), "one of " + ", ".join(NEEDED) + " or the package locales is not installed")
class PrusaImport(ProgramTest):
    def import_and_save(self, archive):
        window = Window(self, self.path("window"))
        window.import_archive(self.path(archive))
        window.save(self.path("taken.3mf"))
        return self.succeed("info", "taken.3mf", "--json").json()

    def centre(self, layers, layer):
        rings = json.loads(self.bytes_of(layers))["layers"][layer]["parts"][0]["rings"]
        twice_area = x = y = 0
        for ring in rings:
            corners = list(zip(ring[::2], ring[1::2]))
            for (px, py), (qx, qy) in zip(corners, corners[1:] + corners[:1]):
                cross = px * qy - qx * py
                twice_area, x, y = twice_area + cross, x + (px + qx) * cross, y + (py + qy) * cross
        return x / (3 * twice_area), y / (3 * twice_area), twice_area / 2

    def test_an_archive_is_taken_for_the_part_that_it_was(self):
        # No two of its sides are alike: a small box on the corner of a large one.
        self.path("window").mkdir()
        self.write("part.stl", binary_stl(box_triangles(24, 14, 4) + moved(box_triangles(6, 5, 4), (1, 2, 4))))
        self.succeed("slice", "part.stl", "-o", "part.sl1", "--layer-height", "0.5")
        taken = self.import_and_save("part.sl1")
        pixel = 0.0473
        (x, y, z), (to_x, to_y, to_z) = taken["bbox"]
        self.assertTrue(taken["closed"])
        for found, expected in ((to_x - x, 24), (to_y - y, 14), (to_z - z, 8)):
            self.assertAlmostEqual(found, expected, delta=1.5 * pixel)
        self.assertAlmostEqual(taken["volume_mm3"], 24 * 14 * 4 + 6 * 5 * 4, delta=pixel * (76 * 4 + 22 * 4) / 2)
        # It stands on the display as ours does: in the middle, and not mirrored.
        self.assertAlmostEqual((x + to_x) / 2, 120.96 / 2, delta=pixel)
        self.assertAlmostEqual((y + to_y) / 2, 68.04 / 2, delta=pixel)
        self.succeed("slice", "taken.3mf", "-o", "taken.json", "--layer-height", "1")
        found_x, found_y, area = self.centre("taken.json", 6)
        self.assertAlmostEqual(area, 30, delta=pixel * 22 / 2)
        self.assertAlmostEqual(found_x - x, 1 + 3, delta=pixel)
        self.assertAlmostEqual(found_y - y, 2 + 2.5, delta=pixel)


if __name__ == "__main__":
    main()
