"""What the comparison of readers of meshes can be asked for."""

import unittest

from bench.read_meshes.__main__ import parse


class Options(unittest.TestCase):
    def test_a_body_has_options_of_its_own(self):
        options = parse(["--formats", "obj", "ply", "--rounds", "9", "--body", "sphere", "--detail", "400"])
        self.assertEqual(options.body, ["sphere", "--detail", "400"])
        self.assertEqual(options.formats, ["obj", "ply"])
        self.assertEqual(options.rounds, 9)

    def test_a_sheet_is_the_body_unless_another_is_named(self):
        self.assertEqual(parse([]).body, ["sheet", "--holes", "484"])


if __name__ == "__main__":
    unittest.main()
