"""The archives that `make macos` makes hold programs that macOS can load, as far as their bytes show.

usage: macos_test.py [ARCHIVE...] [unittest arguments]; without archives, only the reading of programs is tested
"""

import hashlib
import struct
import sys
import tarfile
import unittest
from pathlib import Path

ARCHIVES = [Path(argument) for argument in sys.argv[1:] if argument.endswith(".tar.gz")]

PROCESSORS = {"x86_64": 0x01000007, "arm64": 0x0100000C}
MAGIC = 0xFEEDFACF
PROGRAM, POSITION_INDEPENDENT = 2, 0x200000
LOAD_LIBRARY, CODE_SIGNATURE, BUILD_VERSION = 0xC, 0x1D, 0x32
MACOS = 1


class Program:
    """The load commands of a program for macOS (Mach-O, 64 bits)."""

    def __init__(self, data):
        self.data = data
        magic, self.processor, _, self.kind, count, _, self.flags, _ = struct.unpack_from("<8I", data)
        if magic != MAGIC:
            raise ValueError(f"the magic is {magic:#x}, not that of a Mach-O file")
        self.libraries, self.signature, self.oldest_system, self.platform = [], None, None, None
        at = 32
        for _ in range(count):
            command, size = struct.unpack_from("<2I", data, at)
            if command == LOAD_LIBRARY:
                name = at + struct.unpack_from("<I", data, at + 8)[0]
                self.libraries.append(data[name:data.index(0, name)].decode())
            elif command == CODE_SIGNATURE:
                offset, length = struct.unpack_from("<2I", data, at + 8)
                self.signature = data[offset:offset + length]
            elif command == BUILD_VERSION:
                self.platform, version = struct.unpack_from("<2I", data, at + 8)
                self.oldest_system = (version >> 16, version >> 8 & 255)
            at += size

    def signature_fits(self):
        """Compares the hashes of the signature, which are those of the pages before it, as the system does."""
        magic, _, count = struct.unpack_from(">3I", self.signature)
        if magic != 0xFADE0CC0:
            return False
        for i in range(count):
            _, at = struct.unpack_from(">2I", self.signature, 12 + 8 * i)
            if struct.unpack_from(">I", self.signature, at)[0] != 0xFADE0C02:
                continue
            hashes, _, _, slots, limit, size, _, _, page = struct.unpack_from(">5I4B", self.signature, at + 16)
            page = 1 << page
            pages = [self.data[start:min(start + page, limit)] for start in range(0, limit, page)]
            found = [self.signature[at + hashes + size * k:at + hashes + size * (k + 1)] for k in range(slots)]
            return found == [hashlib.sha256(bytes_).digest() for bytes_ in pages]
        return False


class Reading(unittest.TestCase):
    def test_a_program_for_another_system_is_refused(self):
        with self.assertRaisesRegex(ValueError, "not that of a Mach-O file"):
            Program(Path(sys.executable).read_bytes())


class Archives(unittest.TestCase):
    def setUp(self):
        if not ARCHIVES:
            self.skipTest("no archive was given; `make macos` makes them")

    def each(self):
        """The processors of the archives, and the archives."""
        for path in ARCHIVES:
            archive = tarfile.open(path)
            self.addCleanup(archive.close)
            yield path.name.removesuffix(".tar.gz").split("-")[-1], archive

    def test_the_program_is_for_this_processor_and_for_macos_11(self):
        for processor, archive in self.each():
            program = Program(archive.extractfile("./bin/lamella").read())
            self.assertEqual(program.processor, PROCESSORS[processor])
            self.assertEqual((program.kind, program.flags & POSITION_INDEPENDENT), (PROGRAM, POSITION_INDEPENDENT))
            self.assertEqual((program.platform, program.oldest_system), (MACOS, (11, 0)))

    def test_the_program_needs_only_the_library_of_the_system(self):
        for _, archive in self.each():
            self.assertEqual(Program(archive.extractfile("./bin/lamella").read()).libraries, ["/usr/lib/libSystem.B.dylib"])

    def test_the_program_has_the_signature_that_arm64_demands_and_it_fits(self):
        for processor, archive in self.each():
            program = Program(archive.extractfile("./bin/lamella").read())
            if processor == "arm64":
                self.assertIsNotNone(program.signature)
                self.assertTrue(program.signature_fits())
                program.data = program.data[:4096] + bytes([program.data[4096] ^ 1]) + program.data[4097:]
                self.assertFalse(program.signature_fits(), "a changed byte is noticed")

    def test_the_archive_has_the_libraries_with_headers_packages_and_licences(self):
        for _, archive in self.each():
            names = set(archive.getnames())
            for name in ("lib/liblamella.a", "lib/liblamella-io.a", "lib/libexpat.a", "lib/cmake/lamella/lamella-config.cmake",
                         "include/lamella/core/version.hpp", "share/licences/expat.txt", "share/man/man1/lamella.1",
                         "share/doc/lamella/LICENSE", "share/doc/lamella/LICENSES-third-party.txt"):
                self.assertIn("./" + name, names)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + [argument for argument in sys.argv[1:] if not argument.endswith(".tar.gz")])
