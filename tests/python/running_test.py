"""Long work: other threads go on meanwhile, progress is told, and it can be stopped. Nothing here is timed."""

import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from conftest import PACKAGE

import lamella


@pytest.fixture(scope="session")
def sheet(bodies):
    return bodies("sheet", "--holes", 100, "--segments", 256)


def run_python(code, *arguments):
    """Runs code in an interpreter of its own; its output."""
    result = subprocess.run(
        [sys.executable, "-B", "-c", code, *map(str, arguments)],
        env={**os.environ, "PYTHONPATH": PACKAGE},
        capture_output=True,
        text=True,
        timeout=240,
        check=False,
    )
    assert result.returncode == 0, result.stderr
    return result.stdout


def test_other_threads_go_on_while_slicing(sheet):
    # The interpreter takes the lock from no thread by force, so the count goes on only where slicing gives it up.
    code = """
import sys, threading, time
import lamella
sys.setswitchinterval(1000)
mesh = lamella.read(sys.argv[1])
counted, done = 0, False
def count():
    global counted
    while not done:
        counted += 1
        time.sleep(0.0001)
counter = threading.Thread(target=count)
counter.start()
while counted == 0:
    time.sleep(0.0001)
before = counted
lamella.slice(mesh, 0.005)
print(counted - before)
done = True
counter.join()
"""
    assert int(run_python(code, sheet)) > 10


def test_two_threads_slice_side_by_side(sheet):
    # Each call waits, in its midst, for the other one to be in its midst, too.
    meeting = threading.Barrier(2, timeout=60)
    areas = [None, None]

    def slice_one(place):
        met = []

        def progress(stage, done, total):
            if stage == "slice" and not met:
                met.append(meeting.wait())

        areas[place] = lamella.slice(sheet, 0.01, threads=1, progress=progress).area
        assert met

    threads = [threading.Thread(target=slice_one, args=(place,)) for place in (0, 1)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert (areas[0] == areas[1]).all() and len(areas[0]) == 300


def test_many_threads_may_ask_one_layer(sheet):
    layer = lamella.slice(sheet)[3]
    found = []
    threads = [threading.Thread(target=lambda: found.append((layer.area, layer.hash, layer.parent.sum())))
               for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 8 and len(set(found)) == 1


@pytest.mark.parametrize("work", [lamella.slice, lambda *a, **k: list(lamella.iter_layers(*a, **k))])
def test_progress_is_told_in_order_by_the_thread_that_called(rook, work):
    told = []
    work(rook, 0.05, progress=lambda *event: told.append((threading.get_ident(), *event)))
    assert {thread for thread, *_ in told} == {threading.get_ident()}
    stages = [stage for _, stage, _, _ in told]
    assert list(dict.fromkeys(stages)) == ["read", "link", "slice"]
    for stage in set(stages):
        steps = [(done, total) for _, name, done, total in told if name == stage]
        assert steps == sorted(steps) and len({total for _, total in steps}) == 1
        assert steps[-1][0] == steps[-1][1]


class Stop(Exception):
    pass


@pytest.mark.parametrize("stage", ["read", "link", "slice"])
@pytest.mark.parametrize("work", [lamella.slice, lambda *a, **k: list(lamella.iter_layers(*a, **k))])
def test_what_progress_raises_stops_the_work_and_arrives(rook, work, stage):
    reason = Stop()

    def progress(name, done, total):
        if name == stage:
            raise reason

    with pytest.raises(Stop) as caught:
        work(rook, 0.01, progress=progress)
    assert caught.value is reason


def interrupted(code, *arguments):
    """Sends Ctrl-C when the code has written a line; what it wrote after that."""
    process = subprocess.Popen([sys.executable, "-B", "-c", code, *map(str, arguments)], stdout=subprocess.PIPE,
                               text=True, env={**os.environ, "PYTHONPATH": PACKAGE})
    try:
        assert process.stdout.readline() == "ready\n"
        process.send_signal(signal.SIGINT)
        rest, _ = process.communicate(timeout=60)
        assert process.returncode == 0
        return rest
    finally:
        process.kill()


def test_ctrl_c_stops_slicing(bodies):
    # Hours of work, had it been left alone.
    code = """
import sys, lamella
said = []
def progress(stage, done, total):
    if stage == "weld" and not said:
        said.append(print("ready", flush=True))
try:
    lamella.slice(sys.argv[1], 0.01, engine="conventional", progress=progress)
    print("finished")
except KeyboardInterrupt:
    print("interrupted")
"""
    assert interrupted(code, bodies("sheet", "--holes", 225)) == "interrupted\n"


def test_ctrl_c_stops_a_stream(rook):
    code = """
import os, sys, lamella
layers = lamella.iter_layers(sys.argv[1], 0.00001)
next(layers)
try:
    print("ready", flush=True)
    for layer in layers:
        pass
    print("finished")
except KeyboardInterrupt:
    layers.close()
    print("interrupted", len(os.listdir("/proc/self/task")))
"""
    assert interrupted(code, rook).split()[0] == "interrupted"


def threads_of_this_process():
    return len(os.listdir("/proc/self/task"))


def test_a_stream_that_is_left_stops(sheet):
    before = threads_of_this_process()
    layers = lamella.iter_layers(sheet, 0.0001)
    first = next(layers)
    assert threads_of_this_process() > before
    layers.close()
    assert threads_of_this_process() == before
    assert list(layers) == []
    layers.close()
    assert first.area > 0

    layers = lamella.iter_layers(sheet, 0.0001)
    del layers
    assert threads_of_this_process() == before

    for layer in lamella.iter_layers(sheet, 0.0001):
        break
    assert threads_of_this_process() == before

    with pytest.raises(Stop):
        with lamella.iter_layers(sheet, 0.0001) as layers:
            raise Stop
    assert threads_of_this_process() == before and list(layers) == []


def test_threads_may_share_a_stream(sheet):
    stack = lamella.slice(sheet, 0.05)
    stream = lamella.iter_layers(sheet, 0.05)
    taken = [[] for _ in range(4)]
    threads = [threading.Thread(target=mine.extend, args=(stream,)) for mine in taken]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted((layer for mine in taken for layer in mine), key=lambda layer: layer.index) == list(stack)

    before = threads_of_this_process()
    stream = lamella.iter_layers(sheet, 0.0001)
    threads = [threading.Thread(target=lambda: [stream.close() for layer in stream if layer.index > 5])
               for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    # Python joins a thread a moment before the system has done so.
    deadline = time.monotonic() + 20
    while threads_of_this_process() > before and time.monotonic() < deadline:
        time.sleep(0.01)
    assert threads_of_this_process() <= before


def test_a_program_may_end_with_a_stream_open(sheet):
    code = "import sys, lamella; layers = lamella.iter_layers(sys.argv[1], 0.0001); print(next(layers).index)"
    assert run_python(code, sheet) == "0\n"


def test_a_stream_holds_a_bounded_part_of_the_layers(sheet):
    code = """
import sys, lamella
points = 0
for layer in lamella.iter_layers(sys.argv[1], 0.001, threads=2):
    points += len(layer.points)
peak = next(int(line.split()[1]) for line in open("/proc/self/status") if line.startswith("VmHWM"))
print(points * 16, peak * 1024)
"""
    points, peak = map(int, run_python(code, sheet).split())
    assert points > 2_000_000_000
    # Two threads of 56 MB each, the queue of 16 MB, the mesh and the interpreter; and what the allocator keeps.
    assert peak < 500_000_000


def test_errors_of_a_stream_arrive(rook):
    with pytest.raises(lamella.InputError):
        lamella.iter_layers(str(rook) + ".missing")
    with pytest.raises(lamella.UsageError):
        lamella.iter_layers(rook, -1)
    with pytest.raises(lamella.UsageError, match="the engines are: sweep"):
        lamella.iter_layers(rook, engine="zigzag")


def test_numpy_arrays_of_a_stream_outlive_it(rook):
    kept = []
    with lamella.iter_layers(rook, 1) as layers:
        for layer in layers:
            kept.append((layer.points, layer.area))
    expected = lamella.slice(rook, 1)
    assert all((points == layer.points).all() for (points, _), layer in zip(kept, expected))
    assert np.array([area for _, area in kept]).tolist() == expected.area.tolist()
