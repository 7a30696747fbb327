"""One measurement: a command in its own process, timed from start to end, with a limit."""

import json
import os
import signal
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

LAUNCHER = Path(__file__).with_name("launch.py")


@dataclass
class Outcome:
    seconds: float  # wall time of the whole process
    user: float
    system: float
    peak_rss_bytes: int  # at least about 7 MB, the size of the launcher
    fresh_bytes: int  # of pages that the system provided: the page faults times the size of their pages
    ended: str  # "ok", "timeout", "killed by SIGSEGV", "exit code 3"
    text: str  # standard output and error

    @property
    def ok(self):
        return self.ended == "ok"

    @property
    def timed_out(self):
        return self.ended == "timeout"


def physical_memory():
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")


def run(command, timeout, log, memory=None):
    """Runs `command`; its output goes to the file `log`. `memory` limits its address space, by default to the memory of
    the machine, so that a program that exceeds it ends and the machine does not."""
    command = [str(word) for word in command]
    launcher = [sys.executable, "-I", "-S", "-B", str(LAUNCHER), str(timeout), str(memory or physical_memory()),
                str(log), *command]
    told = json.loads(subprocess.run(launcher, capture_output=True, text=True, check=True).stdout)
    text = Path(log).read_text(encoding="utf-8", errors="replace")
    return Outcome(told["seconds"], told["user"], told["system"], told["peak_rss_bytes"],
                   told["fresh_bytes"], how_it_ended(told["status"], told["timed_out"]), text)


def how_it_ended(status, timed_out):
    if timed_out:
        return "timeout"
    if os.WIFSIGNALED(status):
        return f"killed by {signal.Signals(os.WTERMSIG(status)).name}"
    code = os.WEXITSTATUS(status)
    return "ok" if code == 0 else f"exit code {code}"
