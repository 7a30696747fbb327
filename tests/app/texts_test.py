"""What leaves the program is text: whatever bytes names, labels and lines of files have, a terminal is shown
escapes and programs get valid JSON, and what errors quote of a file is short. Errors name the file."""

import json
import os
import re
import unittest

from program import ProgramTest, binary_stl, box_triangles, limited, main, needs_posix

ODD = b"b\xe4r\x1b[31m\x7f\xc2\x85"
ESCAPED = "b\\xe4r\\x1b[31m\\x7f\\xc2\\x85"


def cli(label=b"part", units="0.001", geometry=""):
    square = "$$POLYLINE/1,1,5,0,0,5000,0,5000,5000,0,5000,0,0\n"
    return (f"$$HEADERSTART\n$$ASCII\n$$UNITS/{units}\n$$LABEL/1,".encode() + label +
            f"\n$$HEADEREND\n$$GEOMETRYSTART\n$$LAYER/0\n$$LAYER/100\n{geometry or square}$$GEOMETRYEND\n".encode())


class Texts(ProgramTest):
    def assert_clean(self, data, json_too=False):
        text = data.decode("utf-8")  # strictly
        controls = "".join(sorted(set(re.findall(r"[\x00-\x08\x0b-\x1f\x7f\x80-\x9f]", text))))
        self.assertEqual(controls, "", ascii(text[:500]))
        if json_too:
            return [json.loads(line) for line in text.splitlines()]
        return text

    def test_labels_that_are_no_text(self):
        self.write("odd.cli", cli(ODD))
        info = self.run_program("info", "odd.cli", "--json")
        self.assert_clean(info.out)
        self.assertEqual(info.json()["label"], ESCAPED)
        self.assertIn(ESCAPED, self.assert_clean(self.run_program("info", "odd.cli").out))
        self.assertRegex(self.assert_clean(info.err_bytes), "1 label has bytes that are no text")
        for name in ["odd.json", "odd.npz", "odd.3mf", "odd.svg"]:
            with self.subTest(name):
                self.succeed("convert", "odd.cli", name)
                self.assertEqual(self.run_program("info", name, "--json").json()["label"], ESCAPED)

    def test_labels_with_control_characters_in_json(self):
        self.succeed("convert", self.write("part.cli", cli()), "part.json")
        text = self.bytes_of("part.json").decode().replace('"part"', '"a\\u0000b\\u001b\\u007f\\u0085"', 1)
        self.write("odd.json", text)
        self.assertEqual(self.run_program("info", "odd.json", "--json").json()["label"],
                         "a\\x00b\\x1b\\x7f\\xc2\\x85")

    @needs_posix("names of files of any bytes")
    def test_names_of_files_that_are_no_text(self):
        name = self.folder.as_posix().encode() + b"/" + ODD + b".stl"
        with open(name, "wb") as file:
            file.write(binary_stl(box_triangles(1, 1, 1)))
        for arguments in [["info"], ["info", "--json"], ["slice", "-o", "-", "--format", "json"]]:
            result = self.run_program(*arguments, ODD.decode("utf-8", "surrogateescape") + ".stl")
            self.assertEqual(result.code, 0)
            self.assert_clean(result.out)
            self.assert_clean(result.err_bytes)
        result = self.run_program("slice", ODD.decode("utf-8", "surrogateescape"), "-o", "a.cli")
        self.assertIn(ESCAPED + ": ", self.assert_clean(result.err_bytes))
        result = self.run_program("slice", ODD.decode("utf-8", "surrogateescape"), "-o", "a.cli", "--progress", "json")
        self.assert_clean(result.err_bytes, json_too=True)

    def test_lines_of_a_list_of_heights(self):
        self.write("box.stl", binary_stl(box_triangles(1, 1, 1)))
        self.write("z.txt", b"0.1\n\x91" + b"9" * 70_000 + b"\n")
        for progress in ["none", "json"]:
            result = self.run_program("slice", "box.stl", "--z-list", "z.txt", "-o", "a.cli", "--progress", progress)
            self.assertEqual(result.code, 2)
            text = self.assert_clean(result.err_bytes)
            self.assertIn("x9199", text)
            self.assertLess(len(text), 600)

    def test_values_of_options_are_quoted_up_to_200_characters(self):
        long = "x" * 5000
        for arguments in [[long], ["view", "a", long], ["slice", "a.stl", "--layer-height", long],
                          ["slice", "a.stl", "--format", long, "-o", "b"], ["slice", "a.stl", "--max-memory", long],
                          ["slice", "a.stl", "--translate", long], ["slice", "a.stl", "--heights", long],
                          ["slice", "a.stl", "--progress=" + long], ["slice", "a.stl", "--direction", long]]:
            with self.subTest(arguments[:3]):
                result = self.run_program(*arguments)
                self.assertEqual(result.code, 2, result.err)
                self.assertLess(len(result.err), 1000)

    def test_types_of_arrays_that_are_no_text(self):
        self.succeed("convert", self.write("part.cli", cli()), "part.npz")
        data = self.bytes_of("part.npz")
        at = data.index(b"'<f8'")
        self.write("odd.npz", data[:at] + b"'\x1b\xe4" + b"8'" + data[at + 5:])
        for arguments in [["info", "odd.npz"], ["info", "odd.npz", "--progress", "json"]]:
            result = self.run_program(*arguments)
            self.assertEqual(result.code, 3)
            self.assert_clean(result.err_bytes)

    def test_what_is_wrong_with_a_file_is_one_object_for_programs(self):
        self.write("box.stl", binary_stl(box_triangles(1, 1, 1)))
        self.write("broken.cli", cli(geometry="$$POLYLINE/1,1,5,0,0\n"))
        self.write("broken.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n")
        self.write("turned.cli", cli(geometry="$$POLYLINE/1,0,5,0,0,5000,0,5000,5000,0,5000,0,0\n"))
        for arguments in [["slice", "broken.stl", "-o", "a.cli"], ["slice", "box.stl", "-o", "nowhere/a.cli"],
                          ["info", "broken.cli"], ["convert", "broken.cli", "a.svg"], ["verify", "broken.cli"],
                          ["verify", "turned.cli"], ["view", "broken.cli", "-o", "a.html"],
                          ["scan", "broken.cli", "-o", "a.cli"], ["compare", "broken.cli", "broken.cli"],
                          ["slice", "box.stl", "--layer-height", "9", "-o", "a.cli"],
                          ["slice", "box.stl", "--layer-height", "much", "-o", "a.cli"], ["slice", "--bogus"]]:
            with self.subTest(arguments):
                result = self.run_program(*arguments, "--progress", "json")
                self.assertNotEqual(result.code, 0)
                objects = self.assert_clean(result.err_bytes, json_too=True)
                errors = [one for one in objects if "error" in one]
                self.assertEqual(len(errors), 1, objects)
                self.assertEqual(errors[0]["exit_code"], result.code)

    @unittest.skipIf("LAMELLA_SANITIZED" in os.environ, "a sanitizer needs more address space")
    def test_copies_that_exhaust_memory_are_named_as_what_to_reduce(self):
        self.write("box.stl", binary_stl(box_triangles(1, 1, 1)))
        limit = 200 << 20
        self.fail_with(5, "error: box.stl: memory ran out; free some, or work on less at once: fewer parts, copies, layers or files", "slice", "box.stl", "--copies", "400000",
                       "--layer-height", "0.5", "--threads", "1", "-o", "a.3mf",
                       **limited(DATA=limit))

    def test_errors_of_limits_name_the_file_and_the_part(self):
        self.write("far.cli", cli(units="1000", geometry="$$POLYLINE/1,1,5,0,0,5e6,0,5e6,5e6,0,5e6,0,0\n"))
        self.fail_with(5, r"error: far\.cli: layer 0 at z = 50000 mm: ", "scan", "far.cli", "-o", "a.json", "--hatch-distance", "0.01")
        self.write("box.stl", binary_stl(box_triangles(1, 1, 1)))
        self.fail_with(2, r"error: box\.stl: a layer height of 1e-12", "slice", "box.stl", "--layer-height", "1e-12",
                       "-o", "a.cli")
        self.write("large.stl", binary_stl(box_triangles(1e9, 1e9, 1)))
        self.fail_with(5, r"error: large\.stl: layer [01] at z", "slice", "large.stl", "box.stl",
                       "--layer-height", "0.5", "--scan", "--hatch-distance", "0.1", "-o", "a.cli")


if __name__ == "__main__":
    main()
