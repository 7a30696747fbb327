"""Runs one command and measures it; a separate program, so that it forks from a small process.

usage: launch.py TIMEOUT_SECONDS MEMORY_BYTES LOG COMMAND...

A process inherits the peak memory of the process that it was forked from, so a large driver cannot measure a small
child. Prints one JSON object: seconds, user, system, peak_rss_bytes, fresh_bytes, timed_out, status (as of waitpid).
"""

import json
import os
import resource
import signal
import sys
import time

LARGE_PAGE = 2 << 20


def main():
    timeout, memory, log, command = float(sys.argv[1]), int(sys.argv[2]), sys.argv[3], sys.argv[4:]
    signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGCHLD])
    # A request to stop must also reach the child.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    large_pages = large_page_faults()
    started = time.perf_counter()
    child = os.fork()
    if child == 0:
        run(command, memory, log)
    timed_out, reaped = False, False
    try:
        timed_out = signal.sigtimedwait([signal.SIGCHLD], timeout) is None
        ended = time.perf_counter()
        if timed_out:
            os.killpg(child, signal.SIGKILL)
        _, status, usage = os.wait4(child, 0)
        reaped = True
    finally:
        if not reaped:
            os.killpg(child, signal.SIGKILL)
    large_pages = min(large_page_faults() - large_pages, usage.ru_minflt)
    fresh = large_pages * LARGE_PAGE + (usage.ru_minflt - large_pages) * resource.getpagesize()
    print(json.dumps({"seconds": ended - started, "user": usage.ru_utime, "system": usage.ru_stime,
                      "peak_rss_bytes": usage.ru_maxrss * 1024, "fresh_bytes": fresh, "timed_out": timed_out,
                      "status": status}))


def large_page_faults():
    """Returns how many large pages the system has provided so far, to all processes; 0 where it does not tell."""
    try:
        with open("/proc/vmstat", encoding="ascii") as counts:
            return next((int(line.split()[1]) for line in counts if line.startswith("thp_fault_alloc ")), 0)
    except OSError:
        return 0


def run(command, memory, log):
    """In the child: becomes the command, in its own process group."""
    try:
        os.setpgid(0, 0)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGCHLD])
        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        output = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o644)
        os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
        os.dup2(output, 1)
        os.dup2(output, 2)
        os.execvp(command[0], command)
    except OSError as error:
        os.write(2, f"{command[0]}: {error}\n".encode())
    os._exit(127)


if __name__ == "__main__":
    main()
