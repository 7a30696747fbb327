"""Versions of programs, as they print them."""

import re
import shutil
import subprocess


def version(command, pattern):
    """Returns the first match of `pattern` in the output of `command`, or None if there is no such program."""
    if shutil.which(command[0]) is None:
        return None
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
    found = re.search(pattern, done.stdout + done.stderr)
    return found[1] if found else "of unknown version"
