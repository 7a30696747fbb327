"""--max-memory and --max-triangles of the commands that read files: small files that would take much memory.

Each is read by a process that may not have the memory, so that it is refused before it is taken.
"""

import gzip
import io
import json
import zipfile

from program import ProgramTest, binary_stl, box_triangles, limited, main

MEGABYTE = 1_000_000
ALLOWED = 150 * MEGABYTE
UNPACKED = 200 * MEGABYTE
LIMIT = ("--max-memory", "20M", "--threads", "1", "--progress", "none")


def zipped(entries):
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for name, entry in entries.items():
            archive.writestr(name, entry)
    return content.getvalue()


def array_of_zeros(length):
    header = f"{{'descr': '<f8', 'fortran_order': False, 'shape': ({length // 16}, 2), }}".ljust(117) + "\n"
    return b"\x93NUMPY\x01\x00v\x00" + header.encode() + bytes(length)


SLICES = ('<model xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" '
          'xmlns:t="http://schemas.microsoft.com/3dmanufacturing/slice/2015/07"><resources>{}</resources>'
          '<build><item objectid="1"/></build></model>')


def slice_files():
    """Of each format that is read: the name of one that takes far more memory than its bytes, how to make it, and the
    text of its refusal."""
    cli = "$$HEADERSTART\n$$UNITS/1\n{}\n$$HEADEREND"
    header = '{"format": "lamella layers", "version": 1, "parts": [{"label": "a"}'

    def slices():
        stack = "".join(f'<t:slice ztop="{i}"/>' for i in range(1, 400_000))
        return SLICES.format(f'<t:slicestack id="1">{stack}</t:slicestack><object id="1" t:slicestackid="1"/>')

    return [
        ("bomb.npz", lambda: zipped({"points.npy": array_of_zeros(UNPACKED)}), "zip entry 'points.npy'"),
        ("bomb.3mf", lambda: zipped({"3D/3dmodel.model": SLICES.format(" " * UNPACKED)}), "zip entry '3D/3dmodel.model'"),
        ("slices.3mf", lambda: zipped({"3D/3dmodel.model": slices()}), "line 1"),
        ("binary.cli", lambda: cli.format("$$BINARY").encode() + b"\x80\x00\x01\x00" * 2_000_000, "byte "),
        ("text.cli", lambda: cli.format("$$ASCII") + "\n$$GEOMETRYSTART\n" + "$$LAYER/1\n" * 1_000_000 + "$$GEOMETRYEND",
         "line "),
        ("layers.slc", lambda: b"-SLCVER 2.0 -UNIT MM -TYPE PART \r\n\x1a" + bytes(256) + b"\x01" + bytes(16)
         + bytes(8 * 2_000_000), "byte "),
        ("layers.svg", lambda: "<svg>" + "<g slic3r:z='1'/>\n" * 1_000_000 + "</svg>", "line "),
        ("parts.json", lambda: header + ",{}" * 3_000_000 + "]}", "byte "),
    ]


class ReadLimits(ProgramTest):
    def refuse(self, pattern, *arguments, **keywords):
        self.fail_with(5, pattern, *arguments, *LIMIT, **limited(DATA=ALLOWED), **keywords)

    def test_every_command_refuses_every_slice_file_that_takes_too_much(self):
        self.write("one.json", json.dumps({"format": "lamella layers", "version": 1, "parts": [{}], "layers": [
            {"z": 1, "bottom": 0, "top": 2, "parts": [{"rings": [[0, 0, 1, 0, 0, 1]]}]}]}))
        for name, content, place in slice_files():
            self.write(name, content())
            self.assertLess(self.path(name).stat().st_size, 25 * MEGABYTE)
            pattern = f"{name}: (?=.*{place}).*(20000000|199\\d+) bytes"
            for arguments in [("info", name), ("verify", name), ("compare", name, "one.json"),
                              ("compare", "one.json", name), ("convert", name, "out.json"),
                              ("merge", "out.json", "one.json", name), ("view", name, "-o", "out.html")]:
                with self.subTest(arguments=arguments):
                    self.refuse(pattern, *arguments)
            self.path(name).unlink()

    def test_a_mesh_that_unpacks_to_too_much(self):
        self.write("bomb.stl.gz", gzip.compress(bytes(UNPACKED), 1))
        self.write("bomb.amf", zipped({"bomb.amf": "<amf>" + " " * UNPACKED + "</amf>"}))
        self.succeed("slice", self.box(), "-o", "box.cli")
        for name in ["bomb.stl.gz", "bomb.amf"]:
            for arguments in [("info", name), ("verify", "box.cli", "--mesh", name), ("view", name, "-o", "out.html")]:
                with self.subTest(arguments=arguments):
                    self.refuse(rf"{name}: .*(20000000|199\d+) bytes", *arguments)

    def test_small_archives_unpack_to_a_bounded_size_without_an_option(self):
        self.write("zeros.obj.gz", gzip.compress(b"\n" * 80_000_000))
        for arguments in [("info", "zeros.obj.gz"), ("slice", "zeros.obj.gz", "-o", "a.cli")]:
            self.fail_with(5, r"zeros\.obj\.gz: unpacks to more than 67108864 bytes, .*--max-memory", *arguments)

    def test_an_archive_is_not_unpacked_to_see_what_it_is(self):
        with zipfile.ZipFile(self.path("zeros.stl"), "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr("anything", bytes(UNPACKED))
        result = self.run_program("info", "zeros.stl", **limited(DATA=ALLOWED))
        self.assertEqual(result.code, 3, result.err)

    def test_too_many_triangles(self):
        self.write("box.stl", binary_stl(box_triangles(20, 30, 10)))
        self.succeed("slice", "box.stl", "-o", "box.cli")
        for arguments in [("info", "box.stl"), ("verify", "box.cli", "--mesh", "box.stl"),
                          ("view", "box.stl", "-o", "out.html")]:
            with self.subTest(arguments=arguments):
                self.fail_with(5, r"box\.stl.*more than the 11 triangles of --max-triangles", *arguments,
                               "--max-triangles", 11)
                if arguments[0] != "view":  # which needs the viewer, too
                    self.succeed(*arguments, "--max-triangles", 12, "--max-memory", "10M")

    def test_no_triangles_are_no_limit(self):
        self.fail_with(2, "--max-triangles.*there must be one at least", "info", self.box(), "--max-triangles", 0)

    def test_standard_input_that_is_too_much_waits_in_a_file(self):
        blanks = b" " * UNPACKED
        for content, found in [(b"$$HEADERSTART\n" + blanks, "must end with \\$\\$HEADEREND"), (b"solid\n" + blanks, "facet")]:
            with self.subTest(found=found):
                self.fail_with(3, f"standard input.*{found}", "info", "-", *LIMIT, stdin=content, **limited(DATA=ALLOWED))

    def test_limits_that_are_kept(self):
        self.succeed("slice", self.box(), "-o", "box.cli")
        self.succeed("slice", "box.stl", "-o", "box.npz")
        for arguments in [("info", "box.npz"), ("verify", "box.npz"), ("compare", "box.cli", "box.npz"),
                          ("convert", "box.npz", "out.svg"), ("merge", "whole.cli", "box.cli")]:
            with self.subTest(arguments=arguments):
                self.succeed(*arguments, "--max-memory", "1M")

    def test_no_amount_of_memory(self):
        self.fail_with(2, "--max-memory.*no amount of memory", "info", "box.stl", "--max-memory", "much")

    def test_help_speaks_of_ranges_where_there_are_some(self):
        for command in ["slice", "info", "verify", "compare", "convert", "merge", "view"]:
            text = " ".join(self.succeed(command, "--help").text.split())
            self.assertIn("--max-memory SIZE", text)
            self.assertEqual("sliced in ranges" in text, command == "slice")
            for option in ["--max-triangles N", "--include WHAT"]:
                self.assertEqual(option in text, command in ["slice", "info", "verify", "view"])


if __name__ == "__main__":
    main()
