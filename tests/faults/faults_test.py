"""Calls of the system that go wrong, one after the other: the result is whole or as it was, and an error says why.

Each run has one fault: an operation (such as the third write), and what happens to it. Lean: the first, a middle and the
last call of each operation, in some formats; at length: the other calls, and the other formats. A table of what came out is
printed at the end.
"""

import collections
import gzip
import os
import shutil
import sys
import unittest
import zipfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "app"))
from program import ProgramTest, binary_stl, box_triangles  # noqa: E402

INJECTOR = os.environ.get("LAMELLA_FAULT_INJECTOR", "")
AT_LENGTH = "LAMELLA_FAULTS_AT_LENGTH" in os.environ
FORMATS = ["cli", "cli-ascii", "svg", "slc", "3mf", "dxf", "geojson", "ilt", "json", "npz", "ovf",
           "svg-layers", "png", "png-zip", "sl1", "sl1s"]
LEAN_FORMATS = ["cli", "3mf", "npz", "svg-layers", "sl1"]
# What can befall an operation on an output, and whether the program has to get over it.
OUTPUT_FAULTS = {
    "write": {"EIO": False, "ENOSPC": False, "EDQUOT": False, "short": True, "EINTR": True},
    "create": {"EACCES": False, "ENOSPC": False, "EROFS": False, "EMFILE": False, "EINTR": True},
    "mkdir": {"EACCES": False, "ENOSPC": False},
    "link": {"EIO": False, "ENOSPC": False, "EACCES": False, "EINTR": True},
    "rename": {"EIO": False, "ENOSPC": False, "EACCES": False},
    "exchange": {"EIO": True},
    "close": {"EIO": False, "ENOSPC": False, "EINTR": True},
    "unlink": {"EIO": True},
}
KILLS = ["kill", "killed"]
same_at_length = unittest.skipIf(AT_LENGTH, "the lean run does the same")

table = collections.Counter()


def tearDownModule():
    outcomes = sorted({key[2] for key in table})
    rows = sorted({key[:2] for key in table})
    print(f"\n{'operation':10} {'fault':8} " + " ".join(f"{o:>12}" for o in outcomes), file=sys.stderr)
    for row in rows:
        print(f"{row[0]:10} {row[1]:8} " + " ".join(f"{table[(*row, o)]:12}" for o in outcomes), file=sys.stderr)
    print(f"{sum(table.values())} faults", file=sys.stderr)


def moments(count, actions, lean=True):
    """Which of the calls of an operation go wrong, and in which ways: the first, the middle and the last one in all
    of them; at length the others, in one way each, and these where the lean run leaves them out."""
    chosen = {1, (count + 1) // 2, count} & set(range(1, count + 1))
    for number in range(1, count + 1):
        if number in chosen:
            if lean != AT_LENGTH:
                yield from ((number, action) for action in actions)
        elif AT_LENGTH and count <= 60:
            yield number, actions[number % len(actions)]


def content(path):
    """All bytes of a file or of the files in a folder; None where there is nothing."""
    if path.is_dir():
        return {p.name: p.read_bytes() for p in path.iterdir()}
    return path.read_bytes() if path.exists() else None


@unittest.skipUnless(INJECTOR, "run by ctest, which knows where the library that makes faults is")
class FaultTest(ProgramTest):
    def faulty(self, fault, *arguments, log=None, pipes=False, **keywords):
        environment = dict(os.environ, LD_PRELOAD=INJECTOR, LAMELLA_FAULT=fault)
        if log:
            environment["LAMELLA_FAULT_LOG"] = str(log)
        if pipes:
            environment["LAMELLA_FAULT_PIPES"] = "1"
        return self.run_program(*arguments, env=environment, **keywords)

    def calls(self, *arguments, **keywords):
        """How often each operation is called when nothing goes wrong."""
        log = self.path("calls.log")
        self.assertEqual(self.faulty("none:0:none", *arguments, log=log, **keywords).code, 0)
        counted = collections.Counter(log.read_text().split())
        log.unlink()
        return counted

    def assert_one_error(self, result, pattern):
        self.assertRegex(result.err, pattern)
        self.assertRegex(result.err.splitlines()[-1], "^lamella: error: ")


class Outputs(FaultTest):
    def setUp(self):
        super().setUp()
        self.succeed("make", "torus", "--segments", "16")

    def put_back(self, old, name):
        path = self.path(name)
        shutil.rmtree(path, ignore_errors=True)
        path.unlink(missing_ok=True) if not path.is_dir() else None
        if old is None:
            return
        source = self.path("old") / name
        shutil.copytree(source, path) if source.is_dir() else shutil.copy(source, path)

    def check(self, name, fault, harmless, command, old, new):
        operation, number, action = fault
        result = self.faulty(f"{operation}:{number}:{action}", *command)
        now = content(self.path(name))
        left = [p for p in self.listing() if ".tmp" in p or ".part" in p]
        where = f"{fault}: {result.code} {result.err}"
        if action in KILLS:
            outcome = "killed"
            self.assertIn(result.code, [-9, 0], where)
            self.assertIn(now, [old, new], where)
            # Whatever it left behind, the next run does.
            self.succeed(*command)
            self.assertEqual(content(self.path(name)), new, where)
            for path in left:
                left_over = self.path(path)
                shutil.rmtree(left_over) if left_over.is_dir() else left_over.unlink(missing_ok=True)
        elif result.code == 0:
            outcome = "well"
            self.assertEqual(now, new, where)
            self.assertEqual(left, [] if operation != "unlink" else left, where)
        else:
            outcome = "refused"
            self.assertFalse(harmless, where)
            self.assertIn(result.code, [3, 6], where)
            self.assert_one_error(result, "cannot (be read|write)|no permission")
            self.assertEqual(now, old, where)
            self.assertEqual(left, [], where)
        table[(operation, action, outcome)] += 1

    def test_every_operation_of_every_format(self):
        for name in FORMATS if AT_LENGTH else LEAN_FORMATS:
            command = ["slice", "torus.stl", "-o", "out", "--format", name, "--layer-height", "0.5", "--threads", "2"]
            self.path("old").mkdir(exist_ok=True)
            self.succeed(*command[:3], "old/out", *command[4:], "--translate", "1,0,0")
            self.put_back(None, "out")
            self.succeed(*command)
            new = content(self.path("out"))
            for old in [None, content(self.path("old/out"))]:
                self.put_back(old, "out")
                calls = self.calls(*command)
                for operation, actions in OUTPUT_FAULTS.items():
                    for number, action in moments(calls[operation], [*actions, *KILLS], name in LEAN_FORMATS):
                        with self.subTest(name, fault=(operation, number, action), over=old is not None):
                            self.put_back(old, "out")
                            self.check("out", (operation, number, action), actions.get(action, False), command, old,
                                       new)
            shutil.rmtree(self.path("old"))

    def test_writes_of_large_layers_by_several_threads(self):
        self.succeed("make", "sheet", "--holes", "100", "--segments", "400")
        for name in ["cli", "ilt", "npz", "svg"]:
            command = ["slice", "sheet.stl", "-o", "out", "--format", name, "--layer-height", "0.5", "--threads", "3"]
            self.put_back(None, "out")
            self.succeed(*command)
            new = content(self.path("out"))
            writes = self.calls(*command)["write"]
            self.assertGreater(writes, len(new) // 2**20)
            for number, action in moments(writes, [*OUTPUT_FAULTS["write"], "kill"]):
                with self.subTest(name, fault=("write", number, action)):
                    self.put_back(None, "out")
                    self.check("out", ("write", number, action), OUTPUT_FAULTS["write"].get(action, False), command,
                               None, new)

    @same_at_length
    def test_a_disk_that_stays_full(self):
        for name in FORMATS:
            command = ["slice", "torus.stl", "-o", "out", "--format", name, "--layer-height", "0.5"]
            with self.subTest(name):
                result = self.faulty("write:0:ENOSPC", *command)
                self.assertEqual(result.code, 6, result.err)
                self.assert_one_error(result, "cannot write .*the disk is full; free some space")
                self.assertEqual(self.listing(), ["torus.stl"])
                table[("write*", "ENOSPC", "refused")] += 1

    @same_at_length
    def test_every_call_is_interrupted_or_cut_short(self):
        for name in FORMATS:
            command = ["slice", "torus.stl", "--format", name, "--layer-height", "0.5", "-o"]
            self.path(name).mkdir()
            self.succeed(*command, f"{name}/out")
            expected = content(self.path(f"{name}/out"))
            for fault in ["write:0:EINTR", "write:0:short", "create:0:EINTR", "clock:0:jump"]:
                with self.subTest(name, fault=fault):
                    result = self.faulty(fault, *command, f"{name}/out")
                    self.assertEqual(result.code, 0, result.err)
                    self.assertEqual(content(self.path(f"{name}/out")), expected)
                    table[(fault.split(":")[0] + "*", fault.split(":")[2], "well")] += 1

    @same_at_length
    def test_clocks_that_jump_end_no_run_early(self):
        self.succeed("slice", "torus.stl", "-o", "a.cli")
        result = self.faulty("clock:0:jump", "slice", "torus.stl", "-o", "b.cli", "--timeout", "100")
        self.assertEqual(result.code, 0, result.err)
        self.assertEqual(self.bytes_of("a.cli"), self.bytes_of("b.cli"))
        result = self.faulty("clock:0:jump", "slice", "torus.stl", "-o", "b.cli", "--timeout", "0.2", "--layer-height",
                             "0.00001")
        self.assertEqual(result.code, 5, result.err)


class Inputs(FaultTest):
    def meshes(self):
        """So large that they are read in chunks; what is smaller is read at once."""
        for name in ["torus.stl", "torus.obj", "torus.ply"]:
            self.succeed("make", "torus", "--segments", "72", "-o", name)
        self.succeed("make", "torus", "--segments", "72", "--ascii", "-o", "ascii.stl")
        padding = 70_000 * "x"
        self.write("torus.stl.gz", gzip.compress(self.bytes_of("torus.stl")))
        corners = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
        faces = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6),
                 (0, 6, 2), (1, 3, 7), (1, 7, 5)]
        self.write("box.off", f"OFF\n# {padding}\n8 12 0\n" + "".join("%d %d %d\n" % c for c in corners)
                   + "".join("3 %d %d %d\n" % f for f in faces))
        with zipfile.ZipFile(self.path("box.3mf"), "w") as archive:
            archive.writestr("[Content_Types].xml", '<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/'
                             'package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.'
                             'openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/'
                             'vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>')
            archive.writestr("_rels/.rels", '<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/'
                             'package/2006/relationships"><Relationship Target="/3D/3dmodel.model" Id="r" Type="http://'
                             'schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>')
            archive.writestr(
                "3D/3dmodel.model", '<?xml version="1.0"?><model unit="millimeter" xmlns="http://schemas.microsoft.com/'
                f'3dmanufacturing/core/2015/02"><!-- {padding} --><resources><object id="1" type="model"><mesh><vertices>'
                + "".join('<vertex x="%d" y="%d" z="%d"/>' % c for c in corners) + "</vertices><triangles>"
                + "".join('<triangle v1="%d" v2="%d" v3="%d"/>' % f for f in faces)
                + '</triangles></mesh></object></resources><build><item objectid="1"/></build></model>')
        return ["torus.stl", "torus.obj", "torus.ply", "ascii.stl", "torus.stl.gz", "box.off", "box.3mf"]

    def expect(self, result, expected, well, fault):
        if well:
            self.assertEqual(result.code, 0, result.err)
            self.assertEqual(self.bytes_of("out.cli"), expected)
        else:
            self.assertEqual(result.code, 3, result.err)
            self.assert_one_error(result, "cannot be read|no permission|is empty|was cut off while it was read: it had .* bytes, and ends after 0 now")
            self.assertFalse(self.path("out.cli").exists())
        operation, _, action = fault.split(":")
        table[(operation, action, "well" if well else "refused")] += 1
        self.path("out.cli").unlink(missing_ok=True)

    @same_at_length
    def test_every_reader(self):
        for name in self.meshes():
            command = ["slice", name, "-o", "out.cli"]
            self.succeed(*command)
            expected = self.bytes_of("out.cli")
            self.path("out.cli").unlink()
            kept = self.bytes_of(name)
            for fault in ["open:1:EACCES", "open:1:EIO", "open:1:EMFILE"]:
                with self.subTest(name, fault=fault):
                    self.expect(self.faulty(fault, *command), expected, False, fault)
            refused = collections.Counter()
            for number in range(1, self.calls(*command)["read"] + 1):
                for action in ["EIO", "short", "EINTR", "shrink"]:
                    with self.subTest(name, number=number, action=action):
                        fault = f"read:{number}:{action}"
                        result = self.faulty(fault, *command)
                        refused[action] += result.code != 0
                        # Other reads are of what the system says of its memory.
                        self.expect(result, expected, result.code == 0, fault)
                        self.write(name, kept)
                        self.path("out.cli").unlink(missing_ok=True)
            self.assertGreaterEqual(refused["EIO"], 2)  # its beginning, and all of it
            self.assertEqual(refused["shrink"], refused["EIO"])
            self.assertEqual((refused["short"], refused["EINTR"]), (0, 0))

    def test_small_files(self):
        self.write("box.stl", binary_stl(box_triangles(1, 1, 1)))
        command = ["slice", "box.stl", "-o", "out.cli"]
        self.succeed(*command)
        expected = self.bytes_of("out.cli")
        # Other reads are of what the system says of its memory.
        refused = 0
        for number in range(1, self.calls(*command)["read"] + 1):
            for action in ["EIO", "short", "EINTR"]:
                with self.subTest(number=number, action=action):
                    result = self.faulty(f"read:{number}:{action}", *command)
                    refused += result.code != 0
                    self.expect(result, expected, result.code == 0 or action != "EIO", f"read:{number}:{action}")
        self.assertEqual(refused, 1)

    def test_standard_input(self):
        self.meshes()
        data = self.bytes_of("torus.stl")
        command = ["slice", "-", "-o", "out.cli"]
        self.succeed(*command, stdin=data)
        expected = self.bytes_of("out.cli")
        reads = self.calls(*command, stdin=data, pipes=True)["read"]
        self.path("out.cli").unlink()
        self.assertGreaterEqual(reads, 2)
        log = self.path("calls.log")
        for number, action in moments(reads, ["EIO", "short", "EINTR"]):
            fault = f"read:{number}:{action}"
            with self.subTest(fault):
                result = self.faulty(fault, *command, stdin=data, pipes=True, log=log)
                # How much a read finds in the pipe is a matter of time: a later run may do with fewer of them.
                made = log.read_text().split().count("read") >= number
                log.unlink()
                self.expect(result, expected, action != "EIO" or not made, fault)
        for action in ["short", "EINTR"]:
            fault = f"read:0:{action}"
            self.expect(self.faulty(fault, *command, stdin=data, pipes=True), expected, True, fault)

    @same_at_length
    def test_a_batch_goes_on_after_a_file_that_shrinks(self):
        self.path("in").mkdir()
        self.meshes()
        for name in "abcd":
            self.write(f"in/{name}.stl", self.bytes_of("torus.stl"))
        size = len(self.bytes_of("torus.stl"))
        # The second file of the only worker shrinks.
        reads = self.calls("slice", "in/a.stl", "-o", "a.cli")["read"]
        result = self.faulty(f"read:{reads + 2}:shrink", "slice", "--batch", "in", "-o", "out", "--format", "cli",
                             "--jobs", "1")
        self.assertEqual(result.code, 7, result.err)
        self.assertEqual(result.err.splitlines()[:2], [
            f"lamella: error: in/b.stl: was cut off while it was read: it had {size} bytes, and ends after 0 now",
            "batch    4 files: 3 sliced, 1 failed (1 input)"])
        self.assertEqual(sorted(p.name for p in self.path("out").iterdir()), ["a.cli", "c.cli", "d.cli"])


if __name__ == "__main__":
    unittest.main()
