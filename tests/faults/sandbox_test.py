"""The program writes nowhere but where it was told to: every call that could change a file is traced."""

import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "app"))
from program import PROGRAM, ProgramTest, binary_stl, box_triangles  # noqa: E402

CALLS = ("open,openat,openat2,creat,mkdir,mkdirat,rename,renameat,renameat2,unlink,unlinkat,rmdir,link,linkat,symlink,"
         "symlinkat,truncate,mknod,mknodat,chmod,fchmodat,chown,fchownat,lchown,utime,utimes,utimensat,setxattr,"
         "connect,socket,bind")
PLACES = re.compile(r'"((?:[^"\\]|\\.)*)"')


def can_trace():
    if shutil.which("strace") is None:
        return False
    return subprocess.run(["strace", "-o", "/dev/null", "true"], capture_output=True).returncode == 0


@unittest.skipUnless(can_trace(), "needs strace, and the permission to trace")
class Sandbox(ProgramTest):
    def setUp(self):
        super().setUp()
        self.path("in").mkdir()
        self.path("out").mkdir()
        for name in "ab":
            self.write(f"in/{name}.stl", binary_stl(box_triangles(3, 2, 1)))

    def changes(self, *arguments, stdin=b""):
        """The calls that change anything, and the paths in them."""
        trace = self.path("trace")
        result = subprocess.run(["strace", "-f", "-s", "500", "-e", f"trace={CALLS}", "-o", str(trace), PROGRAM,
                                 *arguments], cwd=self.folder, input=stdin, capture_output=True, timeout=120)
        lines = trace.read_text().splitlines()
        trace.unlink()
        found = []
        for line in lines:
            call = re.search(r"^\d+ +(\w+)\(", line)
            if call is None or (call[1].startswith("open") and not re.search("O_WRONLY|O_RDWR|O_CREAT|O_TRUNC", line)):
                continue
            found.append((call[1], PLACES.findall(line), line))
        return result, found

    def assert_only_in_out(self, found):
        self.assertTrue(found)
        for call, places, line in found:
            self.assertNotIn(call, ["connect", "bind"], line)
            if call == "socket":
                self.fail(line)
            # A file without a name gets one: the first path is only the way to it.
            for place in places[1:] if call == "linkat" else places:
                self.assertTrue((self.folder / place).resolve().is_relative_to(self.path("out").resolve()), line)

    def test_a_run_writes_only_its_outputs(self):
        for name in ["cli", "3mf", "npz", "svg-layers", "png", "sl1"]:
            with self.subTest(name):
                result, found = self.changes("slice", "in/a.stl", "-o", "out/a", "--format", name, "--stats", "out/a.json")
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assert_only_in_out(found)
                path = self.path("out/a")
                shutil.rmtree(path) if path.is_dir() else path.unlink()

    def test_a_batch_writes_only_its_outputs(self):
        result, found = self.changes("slice", "--batch", "in", "-o", "out", "--format", "cli")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assert_only_in_out(found)

    def test_from_standard_input_to_standard_output_nothing_is_written(self):
        data = self.bytes_of("in/a.stl")
        for name in ["svg", "json", "dxf", "cli-ascii"]:
            result, found = self.changes("slice", "-", "-o", "-", "--format", name, stdin=data)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(found, [])
        # These have to go back to their beginning: they wait in a temporary file without a name.
        result, found = self.changes("slice", "-", "-o", "-", "--format", "slc", stdin=data)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual([call for call, _, _ in found if not call.startswith(("open", "unlink"))], [])

    def test_checks_write_nothing(self):
        self.succeed("slice", "in/a.stl", "-o", "out/a.cli")
        for command in [["info", "in/a.stl"], ["verify", "out/a.cli", "--mesh", "in/a.stl"], ["--help"],
                        ["compare", "out/a.cli", "out/a.cli"], ["slice", "in/a.stl", "--stats", "-"]]:
            result, found = self.changes(*command)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(found, [])


if __name__ == "__main__":
    unittest.main()
