"""Completion scripts and the man page, which are made from the same tables as help."""

import re
import shutil
import subprocess
import unittest

from program import ProgramTest, main

COMMANDS = ["slice", "info", "verify", "convert", "make"]


class Completion(ProgramTest):
    def options(self, command):
        return re.findall(r"--[a-z-]+", "\n".join(
            line for line in self.succeed(command, "--help").text.splitlines() if re.match(r"  -", line)))

    def check_syntax(self, shell):
        if shutil.which(shell) is None:
            self.skipTest(f"{shell} is not installed")
        script = self.write("script", self.succeed("completion", shell).out)
        done = subprocess.run([shell, "-n", str(script)], capture_output=True, timeout=60)
        self.assertEqual((done.returncode, done.stderr), (0, b""))

    def test_bash_takes_the_script(self):
        self.check_syntax("bash")

    def test_zsh_takes_the_script(self):
        self.check_syntax("zsh")

    def test_fish_takes_the_script(self):
        self.check_syntax("fish")

    def test_powershell_gets_a_script_of_matched_brackets_and_quotes(self):
        """Where PowerShell is installed, its own parser says so, too."""
        script = self.succeed("completion", "powershell").text
        self.assertTrue(script.isascii())
        # A string in single quotes contains anything but these, which are doubled in it.
        code = re.sub(r"'(?:[^'\n]|'')*'|\"[^\"\n]*\"|#.*", "", script)
        self.assertNotRegex(code, "['\"]")
        opened = []
        for character in code:
            if character in "([{":
                opened.append(character)
            elif character in ")]}":
                self.assertEqual(opened.pop() + character, {")": "()", "]": "[]", "}": "{}"}[character])
        self.assertEqual(opened, [])
        if shutil.which("pwsh") is not None:
            path = self.write("lamella.ps1", script)
            check = ("$errors = $null; [void][System.Management.Automation.Language.Parser]::ParseFile("
                     f"'{path}', [ref]$null, [ref]$errors); $errors; exit $errors.Count")
            done = subprocess.run(["pwsh", "-NoProfile", "-Command", check], capture_output=True, timeout=120)
            self.assertEqual(done.returncode, 0, done.stdout)

    def test_every_option_is_in_every_script_and_in_the_man_page(self):
        manual = self.succeed("help", "--man").text.replace("\\-", "-")
        scripts = {shell: self.succeed("completion", shell).text for shell in ["bash", "zsh", "fish", "powershell"]}
        for command in COMMANDS:
            options = self.options(command)
            self.assertIn("--help", options)
            for option in options:
                self.assertIn(option, manual)
                self.assertIn(option, scripts["bash"])
                self.assertIn(option, scripts["zsh"])
                self.assertIn(f"-l {option[2:]} ", scripts["fish"])
                self.assertIn(f"Name = '{option}'; ", scripts["powershell"])

    def complete(self, *words):
        """What bash offers for the last word."""
        script = self.write("script", self.succeed("completion", "bash").out)
        quoted = " ".join(f"'{word}'" for word in ("lamella",) + words)
        code = (f"source {script}; COMP_WORDS=({quoted}); COMP_CWORD={len(words)}; _lamella 2>/dev/null; "
                "printf '%s\\n' \"${COMPREPLY[@]}\"")
        done = subprocess.run(["bash", "-c", code], capture_output=True, timeout=60)
        return done.stdout.decode().split()

    @unittest.skipIf(shutil.which("bash") is None, "bash is not installed")
    def test_bash_offers_what_fits(self):
        self.assertEqual(self.complete("sl"), ["slice"])
        self.assertEqual(self.complete("slice", "--layer"), ["--layer-height", "--layers"])
        self.assertEqual(self.complete("slice", "--slice-at", ""), ["bottom", "middle", "top"])
        self.assertEqual(self.complete("slice", "--slice-at", "=", "m"), ["middle"])
        self.assertEqual(self.complete("make", "ro"), ["rook"])
        self.assertIn("sweep", self.complete("slice", "--engine", ""))
        self.assertEqual(self.complete("help", "ver"), ["verify"])
        self.assertEqual(self.complete("help", "slice", "sc"), ["scan"])
        self.assertEqual(self.complete("strategy", ""), ["show", "check"])
        self.assertEqual(self.complete("strategy", "check", ""), [])  # files, which bash finds by itself

    @unittest.skipIf(shutil.which("fish") is None, "fish is not installed")
    def test_fish_offers_what_fits(self):
        script = self.write("script", self.succeed("completion", "fish").out)
        self.write("s.toml", b"")

        def complete(words):
            done = subprocess.run(["fish", "--no-config", "-c", f"source {script}; complete -C 'lamella {words}'"],
                                  capture_output=True, timeout=60, cwd=script.parent)
            return [line.split("\t")[0] for line in done.stdout.decode().splitlines()]

        self.assertEqual(complete("make ro"), ["rook"])
        self.assertEqual(complete("help ver"), ["verify"])
        self.assertEqual(complete("help slice sc"), ["scan"])
        self.assertEqual(sorted(complete("strategy ")), ["check", "show"])
        self.assertIn("s.toml", complete("strategy check "))
        self.assertNotIn("show", complete("strategy check "))
        self.assertIn("s.toml", complete("info "))

    @unittest.skipIf(shutil.which("mandoc") is None, "mandoc is not installed")
    def test_the_man_page_is_well_formed(self):
        page = self.write("lamella.1", self.succeed("help", "--man").out)
        done = subprocess.run(["mandoc", "-Tlint", "-Wwarning", str(page)], capture_output=True, timeout=60)
        # The page is the same whenever it is made: it has no date.
        self.assertEqual([line for line in done.stdout.decode().splitlines() if "missing date" not in line], [])


if __name__ == "__main__":
    main()
