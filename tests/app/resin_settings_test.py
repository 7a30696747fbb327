"""Settings for resin: lamella resin, lamella printers and --resin."""

import json
import struct

from program import ProgramTest, main

GOO_HEADER = 195310


class ResinSettings(ProgramTest):
    def file(self, text):
        self.path("resin.toml").write_text(text)
        return "resin.toml"

    def exposures(self, path):
        """The exposures of the layers of a .goo file."""
        data = self.bytes_of(path)
        (count,) = struct.unpack_from(">I", data, GOO_HEADER)
        at, found = 195477, []
        for _ in range(count):
            found.append(struct.unpack_from(">f", data, at + 10)[0])
            at += 72 + struct.unpack_from(">I", data, at + 66)[0]
        return found

    def test_what_is_shown_can_be_read(self):
        shown = self.succeed("resin", "show").text
        self.assertIn("# exposure_s =", shown)
        self.assertIn("# [exposure_ranges]", shown)
        self.assertIn('# "0:0.4" = 35', shown)
        self.assertEqual(self.succeed("resin", "show", self.file(shown)).text, shown)
        self.succeed("resin", "check", "resin.toml")
        own = shown.replace("# exposure_s =", "exposure_s = 4").replace('"$"', '"EUR"') + (
            '\n[exposure_ranges]\n"11:12" = 1\n"1:2.5" = 9\n"0:1" = 8.5\n')
        again = self.succeed("resin", "show", self.file(own)).text
        self.assertIn("exposure_s = 4 ", again)
        self.assertIn('currency = "EUR"', again)
        self.assertIn('"0:1" = 8.5\n"1:2.5" = 9\n"11:12" = 1\n', again)
        self.assertEqual(self.succeed("resin", "show", self.file(again)).text, again)

    def test_errors_name_the_line(self):
        for text, pattern in [
                ("exposre_s = 3", r"resin\.toml:1: a file of settings for resin has no \"exposre_s\"; did you mean exposure_s\?"),
                ("\n[travel]\nlift = 3", r"resin\.toml:3: \[travel\] has no \"lift\""),
                ("bottom_layers = 2.5", r"resin\.toml:1: bottom_layers is 2\.5, but has to be a whole number"),
                ("travel = 3", r"resin\.toml:1: travel is 3, but has to be a table: \[travel\]"),
                ("[[ranges]]\nfrom_mm = 1", r'resin\.toml:1: a file of settings for resin has no "ranges"'),
                ("exposure_ranges = 3", r"resin\.toml:1: exposure_ranges is 3, but has to be a table: \[exposure_ranges\]"),
                ('[exposure_ranges]\n"0:1" = 3\n"2:1" = 3',
                 r'resin\.toml:3: \[exposure_ranges\] has "2:1", which ends where it begins or below; write the lower height first, such as "1:2"'),
                ('[exposure_ranges]\n"1:1" = 3', 'such as "1:2"'),
                ('[exposure_ranges]\n"0:1" = 3\n"2:4" = 3\n"0.9:2" = 3',
                 r'resin\.toml:4: \[exposure_ranges\] has "0\.9:2", which overlaps "0:1"; a height may be in one range'),
                ('[exposure_ranges]\nlow = 3', r'resin\.toml:2: .* "low", which has to be two heights in mm above the plate, such as "0:0\.4"'),
                ('[exposure_ranges]\n"0:x" = 3', r'resin\.toml:2: .* "0:x", which has to be two heights'),
                ('[exposure_ranges]\n"-1:2" = 3', r'resin\.toml:2: .* begins below the plate'),
                ('[exposure_ranges]\n"0:1" = "long"', r'resin\.toml:2: exposure_ranges\."0:1" is "long", but has to be a number'),
                ('[exposure_ranges]\n"0:1" = 0', r'resin\.toml:2: .* with an exposure of 0 s'),
                ("currency = 3", "currency is 3, but has to be a text"),
                ("density_g_ml = 0", r"resin\.toml: a density of 0 g/ml: choose a positive number"),
                ("exposure_s = ", r"resin\.toml:1: ")]:
            self.fail_with(2, pattern, "resin", "check", self.file(text))
        self.fail_with(2, "lamella resin check needs FILE", "resin", "check")

    def test_options_override_the_file(self):
        self.box(size="2,2,4")
        self.file("exposure_s = 3\nbottom_exposure_s = 40\nbottom_layers = 1\ntransition_layers = 0\n"
                  '[exposure_ranges]\n"2:3" = 7\n')
        common = ["slice", "box.stl", "--layer-height", "1", "--printer", "Mars 4 DLP", "--resin", "resin.toml"]
        self.succeed(*common, "-o", "a.goo")
        self.assertEqual(self.exposures("a.goo"), [40, 3, 7, 3])
        self.succeed(*common, "-o", "b.goo", "--exposure", "5", "--first-exposure", "21", "--fade-layers", "1")
        self.assertEqual(self.exposures("b.goo"), [21, 13, 7, 5])
        self.fail_with(2, "--resin goes with the formats sl1", "slice", "box.stl", "-o", "a.cli", "--resin", "resin.toml")

    def test_slicing_says_what_info_says_of_the_job(self):
        keys = {"resin_ml": "resin", "resin_g": "mass", "price": "price", "print_seconds": "print time"}
        self.box(size="13,7,4")
        self.file('density_g_ml = 1.13\nprice_per_litre = 4000\ncurrency = "EUR"\n[exposure_ranges]\n"1:2.5" = 4.25\n')
        found = set()
        for job, printer, resin in [("a.goo", "Mars 4 DLP", True), ("a.ctb", "LD-002R", True), ("a.pwmb", "Mono X 6K", True),
                                    ("a.sl1", "", False), ("a.cbddlp", "", True), ("a.zip", "", True)]:
            with self.subTest(job):
                options = ["--printer", printer] if printer else []
                if job == "a.cbddlp":
                    options = ["--display-size", "68,120", "--resolution", "1440x2560"]
                if job == "a.zip":
                    options = ["--display-size", "68,120", "--resolution", "1440x2560", "--format", "chitubox-zip"]
                options += ["--resin", "resin.toml"] if resin else []
                result = self.succeed("slice", "box.stl", "-o", job, "--layer-height", "0.5", "--stats", "stats.json", *options)
                stats = json.loads(self.bytes_of("stats.json"))
                info = self.succeed("info", job, "--json").json()
                lines = self.succeed("info", job).text.splitlines()
                for key, name in keys.items():
                    if key not in info:
                        continue
                    found.add((job, key))
                    self.assertAlmostEqual(stats[key] / info[key], 1, delta=0 if key == "print_seconds" else 1e-6, msg=key)
                    own = [line for line in lines if line.startswith(f"  {name} ")]
                    self.assertEqual(len(own), 1, lines)
                    said = [line for line in result.text.splitlines() if line.startswith(f"  {name} ")]
                    # Formats of Chitubox have no currency.
                    self.assertEqual([line.removesuffix(" EUR") if key == "price" and job in ("a.ctb", "a.cbddlp", "a.zip") else line for line in said], own)
        self.assertLessEqual({("a.goo", key) for key in keys}, found)
        self.assertLessEqual({("a.sl1", key) for key in ("resin_ml", "print_seconds")}, found)
        self.succeed("slice", "box.stl", "-o", "a.goo", "--layer-height", "0.5", "--printer", "Mars 4 DLP", "--report", "page.html")
        page = self.bytes_of("page.html").decode()
        for word in ("The print", "Resin", "Mass", "Print time"):
            self.assertIn(f'"{word}"', page)
        self.assertNotIn("resin_ml", self.succeed("slice", "box.stl", "-o", "a.cli", "--layer-height", "0.5", "--stats", "-").json())

    def test_printers_are_found_by_the_names_that_are_listed(self):
        self.box(size="1,1,1")
        lines = self.succeed("printers").text.splitlines()
        self.assertGreater(len(lines), 60)
        for line in lines[::10]:
            name, extension = line.split("  ")[0], line.split()[[part.startswith(".") for part in line.split()].index(True)]
            self.succeed("slice", "box.stl", "-o", "job" + extension, "--layer-height", "0.5", "--printer", name)

    def test_printers_are_listed_by_a_word(self):
        everything = self.succeed("printers").text.splitlines()
        names = [line.split("  ")[0] for line in self.succeed("printers", "SATURN").text.splitlines()]
        self.assertGreater(len(names), 1)
        self.assertEqual(names, [name for name in (line.split("  ")[0] for line in everything) if "saturn" in name.lower()])
        found = self.succeed("printers", "saturn", "--json").json()
        self.assertEqual([printer["name"] for printer in found], [name.strip() for name in names])
        self.assertEqual({printer["extension"] for printer in found} & {".goo", ".ctb"}, {printer["extension"] for printer in found})
        self.fail_with(2, "no printer has 'xyz' in its name", "printers", "xyz")

    def test_a_batch_writes_files_of_the_printer(self):
        self.path("parts").mkdir()
        self.box(size="1,1,1")
        self.path("box.stl").rename(self.path("parts/box.stl"))
        self.succeed("slice", "--batch", "parts", "-o", "jobs", "--printer", "Mono X 6K", "--layer-height", "0.5")
        self.assertEqual([path.name for path in self.path("jobs").iterdir()], ["box.pwmb"])


if __name__ == "__main__":
    main()
