"""The check of the levels passes sound sources and finds each kind of planted violation."""

import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
sys.dont_write_bytecode = True

import check_levels  # noqa: E402

SOUND = {
    "include/lamella/formats.hpp": '#include "lamella/core/point.hpp"\n',
    "include/lamella/core/point.hpp": "#include <limits>\n",
    "include/lamella/mesh/soup.hpp": '#include "lamella/core/point.hpp"\n',
    "include/lamella/slicing/slice.hpp": '#include "lamella/mesh/soup.hpp"\n',
    "src/core/executor.hpp": "#include <thread>\n",
    "src/system/files.hpp": '#include <sys/mman.h>\n#include "core/executor.hpp"\n',
    "src/container/xml.hpp": "",
    "parts/shapes.hpp": "",
    "src/contour/normal_form.cpp": "#include <xxhash.h>\n#include <fmt/format.h>\n",
    "src/slicing/sweep.hpp": '#include "core/executor.hpp"\n',
    "src/slicing/sweep.cpp": '#include "sweep.hpp"\n',
    "src/slicing/engines.cpp": '#include "slicing/sweep.hpp"\n',
    "src/slicing/cut_graph.hpp": "",
    "src/slicing/sweep/walk.hpp": "",
    "src/slicing/sweep/walk.cpp": '#include "slicing/sweep/walk.hpp"\n',
    "src/polygon/grid.hpp": "",
    "app/main.cpp": "#include <lamella/formats.hpp>\n#include <CLI/CLI.hpp>\n",
    "bench/kernels.cpp": '#include "slicing/sweep.hpp"\n',
    "tests/fixtures/solids.hpp": "#include <lamella/formats.hpp>\n",
    "tests/slicing/sweep_test.cpp": '#include "slicing/sweep.hpp"\n#include "fixtures/solids.hpp"\n',
}


class CheckFloors(unittest.TestCase):
    def findings(self, changes):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in {**SOUND, **changes}.items():
                path = Path(folder) / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, encoding="utf-8")
            return check_levels.Architecture(folder).check()

    def assert_found(self, changes, place, words):
        findings = self.findings(changes)
        self.assertEqual(len(findings), 1, findings)
        self.assertTrue(findings[0].startswith(place), findings[0])
        self.assertIn(words, findings[0])

    def test_passes_sound_sources(self):
        self.assertEqual(self.findings({}), [])

    def test_passes_what_is_only_mentioned_in_a_comment(self):
        self.assertEqual(self.findings({"src/core/a.cpp": '// #include "slicing/sweep.hpp"\n/*\n#include <zlib.h>\n*/\n'}),
                         [])

    def test_finds_types_of_one_name(self):
        for other in ("struct Grid {", "class Grid final {", "template <class T>\nclass Grid : public Base {",
                      "enum class Grid {"):
            self.assert_found({"src/polygon/grid.hpp": "namespace lamella {\nclass Grid {\n};\n}\n",
                               "src/slicing/cut_graph.hpp": f"namespace lamella {{\n{other}\n}};\n}}\n"},
                              "src/slicing/cut_graph.hpp", "Grid is the name of a type in src/polygon/grid.hpp")
        # Members and what is only announced are something else.
        self.assertEqual(self.findings({"src/polygon/grid.hpp": "class Grid {\n};\n",
                                        "src/slicing/cut_graph.hpp": "class Grid;\nclass Other {\n    struct Grid {\n    };\n};\n"}),
                         [])

    def test_finds_public_declarations_that_are_not_exported(self):
        inner = "namespace lamella {\nvoid f();\n} // namespace lamella\n"
        header = "include/lamella/mesh/soup.hpp"
        include = '#include "lamella/core/point.hpp"\n\n'
        self.assertEqual(self.findings({header: f"{include}LAMELLA_API_BEGIN\n{inner}LAMELLA_API_END\n"}), [])
        for text in [inner, f"LAMELLA_API_BEGIN\n{inner}", f"{inner}LAMELLA_API_END\n"]:
            self.assert_found({header: include + text}, header, "between LAMELLA_API_BEGIN and LAMELLA_API_END")

    def test_finds_a_module_that_includes_a_level_above(self):
        self.assert_found({"src/mesh/a.cpp": '\n#include "slicing/cut_graph.hpp"\n'}, "src/mesh/a.cpp:2:",
                          "slicing is not below it")

    def test_finds_a_module_that_includes_its_neighbour(self):
        self.assert_found({"src/slicing/a.cpp": '#include "polygon/grid.hpp"\n'}, "src/slicing/a.cpp:1:",
                          "polygon is not below it")

    def test_finds_a_module_that_includes_a_lower_module_it_has_no_business_with(self):
        self.assert_found({"src/slicing/a.cpp": '#include "container/xml.hpp"\n'}, "src/slicing/a.cpp:1:",
                          "container is not below it")

    def test_finds_a_public_header_that_climbs(self):
        self.assert_found({"include/lamella/mesh/a.hpp": '#include "lamella/slicing/slice.hpp"\n'},
                          "include/lamella/mesh/a.hpp:1:", "slicing is not below it")

    def test_finds_a_public_header_that_shows_a_private_one(self):
        self.assert_found({"include/lamella/slicing/a.hpp": '#include "core/executor.hpp"\n'},
                          "include/lamella/slicing/a.hpp:1:", "private")

    def test_finds_a_public_header_with_a_foreign_or_system_header(self):
        for header in ("fmt/format.h", "sys/mman.h", "expat.h"):
            self.assert_found({"include/lamella/core/a.hpp": f"#include <{header}>\n"},
                              "include/lamella/core/a.hpp:1:", "standard library")

    def test_finds_a_foreign_header_outside_its_one_source(self):
        self.assert_found({"src/contour/a.cpp": "#include <xxhash.h>\n"}, "src/contour/a.cpp:1:",
                          "src/contour/normal_form.cpp only")

    def test_finds_a_foreign_header_that_nobody_declared(self):
        self.assert_found({"src/polygon/a.cpp": "#include <clipper2/clipper.h>\n"}, "src/polygon/a.cpp:1:",
                          "no library")

    def test_finds_an_engine_that_includes_files(self):
        self.assert_found({"src/slicing/a.cpp": '#include "system/files.hpp"\n'}, "src/slicing/a.cpp:1:",
                          "slicing may not include")

    def test_finds_the_operating_system_outside_its_module(self):
        self.assert_found({"src/polygon/a.cpp": "#include <unistd.h>\n"}, "src/polygon/a.cpp:1:", "only src/system/")

    def test_finds_test_bodies_in_the_library(self):
        self.assert_found({"src/mesh/a.cpp": '#include "parts/shapes.hpp"\n'}, "src/mesh/a.cpp:1:", "no test bodies")
        self.assertEqual(self.findings({"app/a.cpp": '#include "parts/shapes.hpp"\n'}), [])

    def test_finds_a_source_that_looks_into_a_folder_of_its_module(self):
        for name in ("src/slicing/paper/eecc.cpp", "src/slicing/engines.cpp"):
            self.assert_found({name: '#include "slicing/sweep/walk.hpp"\n'}, f"{name}:1:",
                              "only sources of src/slicing/sweep may include")

    def test_passes_a_test_that_opens_a_folder_of_its_module(self):
        self.assertEqual(self.findings({"tests/slicing/sweep/walk_test.cpp": '#include "slicing/sweep/walk.hpp"\n'}), [])

    def test_finds_a_module_that_includes_a_main_header(self):
        self.assert_found({"src/slicing/a.cpp": '#include "lamella/formats.hpp"\n'}, "src/slicing/a.cpp:1:", "main header")

    def test_finds_a_consumer_that_opens_a_private_header(self):
        for name in ("app/a.cpp", "bench/a.cpp", "examples/a.cpp", "tests/app/a.cpp"):
            self.assert_found({name: '#include "slicing/sweep.hpp"\n'}, f"{name}:1:", "only public headers")

    def test_finds_a_test_that_opens_a_module_above_its_own(self):
        self.assert_found({"tests/core/a_test.cpp": '#include "slicing/sweep.hpp"\n'}, "tests/core/a_test.cpp:1:",
                          "tests of core")

    def test_finds_a_library_source_that_includes_from_the_tests(self):
        self.assert_found({"src/core/a.cpp": '#include "fixtures/solids.hpp"\n'}, "src/core/a.cpp:1:", "only tests")

    def test_finds_an_include_that_leads_nowhere(self):
        self.assert_found({"src/core/a.cpp": '#include "core/gone.hpp"\n'}, "src/core/a.cpp:1:", "no file")


if __name__ == "__main__":
    unittest.main()
