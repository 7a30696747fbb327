"""Describes the machine on which times were measured."""

import datetime
import os
import platform
import subprocess
from pathlib import Path


def describe(lamella):
    """Returns processor, threads, memory, system, compiler, program, date: name -> text."""
    return {
        "processor": processor(),
        "threads": str(len(os.sched_getaffinity(0))),
        "memory": f"{os.sysconf('SC_PAGE_SIZE') * os.sysconf('SC_PHYS_PAGES') / 2**30:.0f} GiB",
        "system": system(),
        "compiler": first_line(["c++", "--version"]),
        "program": first_line([str(lamella), "--version"]),
        "date": datetime.date.today().isoformat(),
    }


def processor():
    for line in read("/proc/cpuinfo").splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.processor() or platform.machine()


def system():
    for line in read("/etc/os-release").splitlines():
        if line.startswith("PRETTY_NAME="):
            return f"{line.split('=', 1)[1].strip().strip(chr(34))}, Linux {platform.release()}"
    return platform.platform()


def read(path):
    try:
        return Path(path).read_text(encoding="utf-8")
    except OSError:
        return ""


def first_line(command):
    try:
        text = subprocess.run(command, capture_output=True, text=True, check=False).stdout
    except OSError:
        return "unknown"
    return text.splitlines()[0].strip() if text.strip() else "unknown"
