"""Long work: other threads go on meanwhile, progress is told, and it can be stopped. Nothing here is timed."""

import gc
import os
import signal
import subprocess
import sys
import threading
import time
import weakref

import numpy as np
import pytest
from conftest import PACKAGE, run_python

import lamella


@pytest.fixture(scope="session")
def sheet(bodies):
    return bodies("sheet", "--holes", 100, "--segments", 256)


def assert_lets_other_threads_go_on(prepared, work, *arguments):
    """Works on a statement until another thread has counted on meanwhile. The interpreter takes the lock from no thread
    by force, so a statement that keeps the lock would be worked on until run_python ends it."""
    code = f"""
import sys, threading, time
import lamella
sys.setswitchinterval(1000)
{prepared}
counted, done = 0, False
def count():
    global counted
    while not done:
        counted += 1
        time.sleep(0.0001)
counter = threading.Thread(target=count, daemon=True)
counter.start()
while counted == 0:
    time.sleep(0.0001)
before = counted
while counted - before < 10:
    {work}
print("counted on")
done = True
counter.join()
"""
    assert run_python(code, *arguments) == "counted on\n"


def test_other_threads_go_on_while_slicing(sheet):
    assert_lets_other_threads_go_on("mesh = lamella.read(sys.argv[1])", "lamella.slice(mesh, 0.005)", sheet)


@pytest.mark.parametrize("placed_by", ["(1, 1, 1), None", "(0, 0, 1), np.diag([2, 2, 2, 1])"])
def test_other_threads_go_on_while_a_mesh_is_placed(placed_by):
    prepared = """
import numpy as np
from lamella._meshes import placed
mesh = lamella.Mesh([(0, 0, 0), (1, 0, 0), (0, 1, 1)], [(0, 1, 2)])
"""
    assert_lets_other_threads_go_on(prepared, f"placed(mesh, ({placed_by}), 1)")


def test_two_threads_slice_side_by_side(sheet):
    # Each call waits, in its midst, for the other one to be in its midst, too.
    intersection = threading.Barrier(2, timeout=60)
    areas = [None, None]

    def slice_one(place):
        met = []

        def progress(stage, done, total):
            if stage == "slice" and not met:
                met.append(intersection.wait())

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
def test_progress_is_reported_in_order_by_the_thread_that_called(rook, work):
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


@pytest.mark.parametrize("work", ["layer.filled()", "layer.offset(-0.01)", "layer.union(layer)", "layer.to_shapely()",
                                  "next(lamella.scan([layer]))", "next(lamella.scan([layer], support=True))"])
def test_ctrl_c_stops_work_on_one_layer(work):
    # 400 million crossings, had it been left alone.
    modules = "numpy as np, lamella"
    if "shapely" in work:
        pytest.importorskip("shapely")
        modules += ", shapely.geometry"  # where an interrupt of an import may end Python, even if it is caught
    code = f"""
import {modules}
steps = np.arange(10000)[:, None, None] / 100
bar = np.array([(0, 0), (100, 0), (100, 0.005), (0, 0.005)])
across = steps * (0, 1) + bar
upwards = steps * (1, 0) + bar[::-1, ::-1]
layer = lamella.Layer([*across, *upwards], z=0.5, bottom=0, top=1)
try:
    print("ready", flush=True)
    {work}
    print("finished")
except KeyboardInterrupt:
    print("interrupted")
"""
    assert interrupted(code) == "interrupted\n"


def test_results_on_a_thread_of_their_own_are_those_of_the_calling_thread():
    # Layers of few points are worked on by the thread that asks.
    ring = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])
    for rings in (3, 2000):
        layer = lamella.Layer([ring + (0.75 * i, 0) for i in range(rings)], z=1)
        assert len(layer.polygons()) == rings and len(layer.parent) == rings
        united = layer.union(layer)
        assert united == layer.filled() == layer.filled("positive") and len(united) == 1
        assert np.isclose(united.area, 0.75 * (rings - 1) + 1)
        assert np.isclose(layer.offset(1).area, (0.75 * (rings - 1) + 3) * 3)


def test_errors_of_work_on_a_thread_of_its_own_arrive():
    strategy = lamella.ScanStrategy()
    strategy.hatch.distance = 1e-9
    turns = np.linspace(0, 2 * np.pi, 5000, endpoint=False)
    layer = lamella.Layer([10 * np.column_stack([np.cos(turns), np.sin(turns)])], z=1, bottom=0, top=2)
    with pytest.raises(lamella.LimitError):
        next(lamella.scan([layer], strategy))


def test_ctrl_c_stops_a_stream(rook):
    code = """
import os, sys, lamella
layers = lamella.iter_layers(sys.argv[1], 0.00003)
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


def assert_threads_end(before):
    # A thread that was joined may be listed for a moment longer.
    deadline = time.monotonic() + 20
    while threads_of_this_process() > before and time.monotonic() < deadline:
        time.sleep(0.01)
    assert threads_of_this_process() <= before


def test_a_stream_that_is_left_stops(sheet):
    before = threads_of_this_process()
    layers = lamella.iter_layers(sheet, 0.0001)
    first = next(layers)
    assert threads_of_this_process() > before
    layers.close()
    assert_threads_end(before)
    assert list(layers) == []
    layers.close()
    assert first.area > 0

    layers = lamella.iter_layers(sheet, 0.0001)
    del layers
    assert_threads_end(before)

    for layer in lamella.iter_layers(sheet, 0.0001):
        break
    assert_threads_end(before)

    with pytest.raises(Stop):
        with lamella.iter_layers(sheet, 0.0001) as layers:
            raise Stop
    assert_threads_end(before)
    assert list(layers) == []


class Viewer:
    """Listens to a stream of its own: neither is held by anybody else."""

    def __init__(self, path, height):
        self.stream = lamella.iter_layers(path, height, progress=self.on_progress)

    def on_progress(self, stage, done, total):
        pass


def test_a_stream_that_its_listener_holds_is_freed(sheet):
    before = threads_of_this_process()
    viewers = [Viewer(sheet, 0.0001) for _ in range(3)]
    first = [next(viewer.stream).index for viewer in viewers]
    assert first == [0, 0, 0] and threads_of_this_process() > before
    del viewers
    gc.collect()
    assert_threads_end(before)


def test_a_stream_that_is_not_made_yet_is_no_trouble_to_the_collector():
    class Both(lamella.LayerStream, lamella.Stack):
        pass

    for cls in (lamella.LayerStream, Both):
        unmade = cls.__new__(cls)
        assert gc.is_tracked(unmade)
        gc.collect()
        del unmade


def test_other_threads_collect_garbage_while_streams_stop(sheet):
    # In a program of its own, which a mistake would end with a signal.
    code = """
import gc, sys, threading
import lamella
done = False
def collect():
    while not done:
        gc.collect()
collector = threading.Thread(target=collect)
collector.start()
for _ in range(10):
    layers = lamella.iter_layers(sys.argv[1], 0.0001)
    next(layers)
    del layers
done = True
collector.join()
print("stopped")
"""
    assert run_python(code, sheet) == "stopped\n"


@pytest.mark.parametrize("finish", [list, lamella.LayerStream.close])
def test_a_stream_that_has_ended_lets_go_of_its_listener(rook, finish):
    viewer = Viewer(rook, 1)
    stream, viewer.stream, listener = viewer.stream, None, weakref.ref(viewer)
    del viewer
    next(stream)
    assert listener() is not None
    finish(stream)
    assert listener() is None


def test_a_listener_may_close_its_stream(sheet):
    before = threads_of_this_process()
    streams = []
    streams.append(lamella.iter_layers(sheet, 0.0001, progress=lambda *_: [stream.close() for stream in streams]))
    assert len(list(streams[0])) < len(streams[0].z)
    assert_threads_end(before)


def test_what_a_listener_raises_after_it_closed_its_stream_is_not_lost(sheet):
    streams = []

    def close_and_raise(*_):
        for stream in streams:
            stream.close()
            raise Stop

    streams.append(lamella.iter_layers(sheet, 0.0001, progress=close_and_raise))
    with pytest.raises(Stop):
        list(streams[0])


def test_a_stream_without_layers_left_has_no_bottom(rook):
    stream = lamella.iter_layers(rook, 1)
    assert stream._bottom == 0
    assert len(list(stream)) > 0
    with pytest.raises(lamella.UsageError, match="closed or at its end"):
        stream._bottom


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
    assert_threads_end(before)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="a system without fork")
def test_a_stream_raises_in_a_process_that_was_forked_from_its_own(sheet):
    """Its threads stay behind, so nothing would ever come; letting it go there does not wait for them either."""
    code = """
import os, sys
import lamella
stream = lamella.iter_layers(sys.argv[1], 0.01)
next(stream)
child = os.fork()
if child == 0:
    try:
        next(stream)
    except lamella.UsageError as error:
        told = "forked" in str(error)
        del stream, error
        own = len(list(lamella.iter_layers(sys.argv[1], 1)))
        os._exit(7 if told and own > 0 else 8)
    os._exit(9)
print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), len(list(stream)) > 100)
"""
    assert run_python(code, sheet) == "7 True\n"


def test_a_program_may_end_with_a_stream_open(sheet):
    code = "import sys, lamella; layers = lamella.iter_layers(sys.argv[1], 0.0001); print(next(layers).index)"
    assert run_python(code, sheet) == "0\n"


@pytest.mark.parametrize(
    "work",
    [
        "lamella.slice(path, 0.05)",
        "for layer in lamella.iter_layers(path, 0.05, progress=lambda *_: None): layer.parent",
        "layers = lamella.iter_layers(path, 0.001); next(layers); del layers",
        "lamella.read(path + '.missing')",
        "lamella.Mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]).volume",
    ],
)
def test_a_program_may_end_while_a_daemon_thread_is_at_work(rook, work):
    # The interpreter takes a while to end, in which the threads ask for the lock.
    code = f"""
import sys, threading, time, lamella
path = sys.argv[1]
started = threading.Event()
def work_on():
    while True:
        started.set()
        try:
            {work}
        except lamella.InputError:
            pass
class Slow:
    def __del__(self, sleep=time.sleep):
        sleep(0.3)
slow = Slow()
for _ in range(3):
    threading.Thread(target=work_on, daemon=True).start()
started.wait()
print("ends")
"""
    assert run_python(code, rook) == "ends\n"


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
    with pytest.raises(lamella.UsageError, match='"zigzag" is none of "sweep"'):
        lamella.iter_layers(rook, engine="zigzag")


def test_numpy_arrays_of_a_stream_outlive_it(rook):
    kept = []
    with lamella.iter_layers(rook, 1) as layers:
        for layer in layers:
            kept.append((layer.points, layer.area))
    expected = lamella.slice(rook, 1)
    assert all((points == layer.points).all() for (points, _), layer in zip(kept, expected))
    assert np.array([area for _, area in kept]).tolist() == expected.area.tolist()
