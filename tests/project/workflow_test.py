"""The workflow of .github names targets and archives that exist, and pins the versions of what it runs.

Nothing else runs the workflow before it is pushed.
"""

import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
WORKFLOW = (ROOT / ".github/workflows/ci.yml").read_text(encoding="utf-8")
MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")


def commands():
    """The lines without comments."""
    return "\n".join(line for line in WORKFLOW.splitlines() if not line.lstrip().startswith("#"))


class Workflow(unittest.TestCase):
    def test_it_has_the_form_of_a_workflow(self):
        try:
            import yaml
        except ImportError:
            self.skipTest("this interpreter has no PyYAML")
        jobs = yaml.safe_load(WORKFLOW)["jobs"]
        for name, job in jobs.items():
            self.assertIn("runs-on", job, name)
            for step in job["steps"]:
                self.assertEqual(("run" in step) + ("uses" in step), 1, f"{name}: {step}")
            needed = job.get("needs", [])
            for other in [needed] if isinstance(needed, str) else needed:
                self.assertIn(other, jobs)

    def test_targets_of_make_exist(self):
        named = set(re.findall(r"\bmake ([a-z-]+)(?=[\n ]|$)", commands())) - {"box", "rook"}
        self.assertGreaterEqual(named, {"demo", "test", "windows", "macos", "wheels", "web"})
        for target in named:
            self.assertRegex(MAKEFILE, rf"(?m)^{target}:", f"make {target}")

    def test_archives_have_the_names_that_the_makefile_gives_them(self):
        made = {path.replace("$@", processor) for processor in ("macos-arm64", "macos-x86_64")
                for path in re.findall(r"(build-\S+?/)(?=lamella-\$\(VERSION\))", MAKEFILE)}
        made |= {f"{path}/" for path in re.findall(r"make_archives\.py .*\\\n.* \$\(VERSION\) (\S+)", MAKEFILE)}
        named = set(re.findall(r"(build-\S+?/)(?=lamella-\*)", commands()))
        self.assertTrue(named)
        self.assertLessEqual(named, made)

    def test_versions_of_actions_are_pinned(self):
        actions = re.findall(r"uses: (\S+)", commands())
        self.assertTrue(actions)
        for action in actions:
            self.assertRegex(action, r"^[\w-]+/[\w-]+@v[0-9]+\.[0-9]+\.[0-9]+$")


if __name__ == "__main__":
    unittest.main()
