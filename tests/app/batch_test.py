"""lamella slice --batch: many files share the processors, and none of them can hold up the others."""

import json
import os
import resource
import signal
import socket
import subprocess
import time
from pathlib import Path

from program import COMMAND, ON_WINDOWS, STOPPING_SIGNALS, UNPRIVILEGED, ProgramTest, binary_stl, box_triangles, main, needs_posix, open_box


class Batch(ProgramTest):
    def records(self, result):
        return [json.loads(line) for line in result.out.splitlines()]

    def batch(self, code, *arguments, **keywords):
        result = self.run_program("slice", "--batch", *arguments, **keywords)
        self.assertEqual(result.code, code, result.err)
        return self.records(result)

    def boxes(self, folder, count):
        """Boxes of different sizes, so that no result can pass for another."""
        self.path(folder).mkdir(parents=True, exist_ok=True)
        names = [f"{folder}/box{i:02}.stl" for i in range(count)]
        for i, name in enumerate(names):
            self.write(name, binary_stl(box_triangles(1 + i, 2, 3)))
        return names

    def test_every_file_comes_out_as_by_itself(self):
        names = self.boxes("parts", 12) + self.boxes("parts/more", 3)
        records = self.batch(0, "parts", "-o", "out", "--format", "cli", "--layer-height", "0.2", "--stats", "out")
        self.assertEqual([r["path"] for r in records], sorted(names))
        for record in records:
            single = self.succeed("slice", record["path"], "-o", "single.cli", "--layer-height", "0.2", "--stats", "-")
            self.assertEqual(record["output"], record["path"].replace("parts", "out", 1).replace(".stl", ".cli"))
            self.assertEqual(self.bytes_of(record["output"]), self.bytes_of("single.cli"))
            figures = single.json()
            self.assertEqual(record["layers"], len(figures["layers"]))
            for key in ["points", "contours", "open_chains", "volume_mm3"]:
                self.assertEqual(record[key], figures[key])
            kept = json.loads(self.bytes_of(record["output"].replace(".cli", ".json")))
            self.assertEqual(kept["layers"], figures["layers"])
        self.assertEqual(len({r["hash"] for r in records}), 12)  # the three are like the first three

    def test_the_results_depend_on_no_number_of_jobs(self):
        self.boxes("parts", 20)
        outcomes = []
        for jobs in ["1", "3", "7"]:
            records = self.batch(0, "parts", "-o", f"out{jobs}", "--format", "cli", "--jobs", jobs)
            for record in records:
                for varying in ["seconds", "output"]:
                    del record[varying]
            outcomes.append(records)
        self.assertEqual(outcomes[0], outcomes[1])
        self.assertEqual(outcomes[0], outcomes[2])

    def test_warnings_name_the_file_and_report_steps_that_leave_nothing(self):
        self.boxes("parts", 2)
        self.write("parts/box01.stl", binary_stl(box_triangles(9, 9, 9)) + b"more")
        records = self.batch(0, "parts", "-o", "out", "--format", "cli", "--min-area", "20")
        self.assertEqual(len(records[0]["warnings"]), 1)
        self.assertIn("parts/box00.stl: no contour is left in any of 30 layers", records[0]["warnings"][0])
        self.assertEqual(records[1]["warnings"],
                         ["parts/box01.stl: byte 684: left out 4 bytes that follow the 12 triangles of the count"])

    def test_hidden_files_and_linked_folders_are_left_out_of_a_folder(self):
        names = self.boxes("parts", 1)
        self.boxes("elsewhere", 1)
        self.boxes("parts/.hidden", 1)
        self.write("parts/.hidden.stl", binary_stl(box_triangles(1, 2, 3)))
        listed = "parts/.hidden.stl\n"
        if not ON_WINDOWS:  # which has other links
            self.path("parts/linked").symlink_to("../elsewhere")
            listed += "parts/linked/box00.stl\n"
        self.assertEqual([r["path"] for r in self.batch(0, "parts", "--stats", "out")], names)
        self.write("list.txt", listed)
        self.assertEqual(len(self.batch(0, "list.txt", "--stats", "out")), listed.count("\n"))

    @needs_posix("symbolic links")
    def test_errors_do_not_quote_what_a_link_leads_to(self):
        self.boxes("parts", 1)
        self.write("secret", b"root:x:0:0\n")
        self.path("parts/link.stl").symlink_to("../secret")
        records = self.records(self.run_program("slice", "--batch", "parts", "-o", "out", "--format", "cli"))
        self.assertEqual([record["ok"] for record in records], [True, False])
        self.assertEqual(records[1]["error"]["exit_code"], 3)
        self.assertIn("parts/link.stl: is a link, and what it leads to cannot be sliced", records[1]["error"]["text"])
        self.assertNotIn("root", records[1]["error"]["text"])

    def test_files_that_fail_hold_up_nobody(self):
        self.boxes("parts", 4)
        self.write("parts/box00a.stl", b"no mesh at all")
        self.write("parts/box01a.obj", b"")
        self.write("parts/box02a.stl", binary_stl(box_triangles(1, 1, 1))[:200])
        result = self.run_program("slice", "--batch", "parts", "-o", "out", "--format", "cli", "--max-triangles", "99")
        self.assertEqual(result.code, 7)
        records = self.records(result)
        self.assertEqual([r["ok"] for r in records], [True, False, True, False, True, False, True])
        for record in records:
            if record["ok"]:
                self.assertTrue(self.path(record["output"]).exists())
                continue
            self.assertIsNone(record["output"])
            self.assertEqual((record["error"]["kind"], record["error"]["exit_code"]), ("input", 3))
            single = self.run_program("slice", record["path"], "-o", "x.cli")
            self.assertEqual(single.err, f"lamella: error: {record['error']['text']}\n")
            self.assertIn(single.err, result.err)
        self.assertIn("7 files: 4 sliced, 3 failed (3 input)", result.err)
        self.assertEqual(len(list(self.path("out").iterdir())), 4)

    def test_limits_are_those_of_each_file(self):
        self.boxes("parts", 3)
        self.succeed("make", "sphere", "-o", "parts/box01a.stl")
        records = self.batch(7, "parts", "-o", "out", "--format", "cli", "--max-triangles", "100")
        self.assertEqual([r["ok"] for r in records], [True, True, False, True])
        self.assertEqual(records[2]["error"]["kind"], "limit")

    def test_a_list_in_its_order(self):
        self.boxes("a", 2)
        self.boxes("b", 2)
        listed = ["b/box01.stl", "a/box00.stl", "b/box00.stl"]
        self.write("list.txt", "# of tonight\nb/box01.stl\r\n\na/box00.stl\nb/box00.stl")
        expected = ["out/b/box01.svg", "out/a/box00.svg", "out/b/box00.svg"]
        records = self.batch(0, "list.txt", "-o", "out", "--format", "svg")
        self.assertEqual([(r["path"], r["output"]) for r in records], list(zip(listed, expected)))
        records = self.batch(0, "-", "-o", "out", "--format", "svg", stdin="\n".join(listed).encode())
        self.assertEqual([r["path"] for r in records], listed)
        odd = "#odd name" if ON_WINDOWS else "#odd\nname"
        self.write(f"a/{odd}.stl", binary_stl(box_triangles(1, 1, 1)))
        records = self.batch(0, "-", "-o", "out", "--format", "svg", stdin=f"a/{odd}.stl\0".encode())
        self.assertEqual([r["output"] for r in records], [f"out/{odd}.svg"])
        records = self.batch(0, "-", "-o", "out", "--format", "svg", stdin=b"\xef\xbb\xbfa/box00.stl\n")
        self.assertEqual([r["path"] for r in records], ["a/box00.stl"])  # as lists of Windows begin

    def test_a_line_that_is_longer_than_any_path(self):
        self.write("list", "# parts\n" + 8000 * "in/p.stl " + "\n")
        self.fail_with(3, "^lamella: error: list: line 2 is longer than any path; expected one path a line$",
                       "slice", "--batch", "list", "-o", "out", "--format", "cli")

    def test_names_of_results_never_collide(self):
        self.boxes("a", 1)
        self.boxes("b", 1)
        self.succeed("make", "box", "-o", "a/box00.obj")
        self.succeed("make", "box", "-o", "a/box00.ply")
        everything = "a/box00.stl\na/box00.obj\na/box00.ply\na/box00.obj\nb/box00.stl\n"
        records = self.batch(0, "-", "-o", "out", "--format", "cli", stdin=everything.encode())
        self.assertEqual([r["output"] for r in records], [
            "out/a/box00.cli", "out/a/box00.obj.cli", "out/a/box00.ply.cli", "out/a/box00.obj-2.cli", "out/b/box00.cli"])
        records = self.batch(0, "-", "-o", "flat/{name}.cli", stdin=everything.encode())
        self.assertEqual([r["output"] for r in records], [
            "flat/box00.cli", "flat/box00.obj.cli", "flat/box00.ply.cli", "flat/box00.obj-2.cli", "flat/box00.stl.cli"])
        records = self.batch(0, "-", "-o", "o/{folder}-{index}-{name}.svg", stdin=everything.encode())
        self.assertEqual(records[4]["output"], "o/b-4-box00.svg")
        # Pictures go into folders: none of them may be the folder of another.
        self.boxes("c", 1)
        self.boxes("c/box00", 1)
        records = self.batch(0, "c", "-o", "pictures", "--format", "svg-layers")
        self.assertEqual([r["output"] for r in records], ["pictures/box00.stl", "pictures/box00/box00"])
        self.fail_with(2, "would lie within the result p/box00", "slice", "--batch", "a", "-o", "p", "--format", "svg-layers",
                       "--stats", "p/{name}/{name}.json")

    def test_results_in_the_folder_itself_are_no_inputs_of_the_next_run(self):
        self.boxes("parts", 2)
        for _ in range(2):
            records = self.batch(0, "parts", "-o", "parts/layers", "--format", "3mf")
            self.assertEqual(len(records), 2)
        self.fail_with(2, r"would overwrite the input parts/layers/box00\.3mf", "slice", "--batch", "parts", "-o", "parts",
                       "--format", "3mf")

    def test_results_replace_neither_the_list_nor_the_configuration(self):
        self.box("list.stl")
        self.write("list.json", "list.stl\n")
        self.fail_with(2, "list.json: this output would overwrite the input list.json", "slice", "--batch", "list.json",
                       "-o", "{name}.json")
        self.write("list", "list.stl\n")
        self.write("list.toml", "layer-height = 0.5\n")
        self.fail_with(2, "list.toml: this output would overwrite the input list.toml", "slice", "--batch", "list",
                       "--config", "list.toml", "--stats", "{name}.toml")

    @needs_posix("symbolic links")
    def test_results_that_links_make_one_file_are_refused(self):
        self.boxes("parts", 2)
        self.path("out").mkdir()
        os.symlink("box01.cli", self.path("out/box00.cli"))
        os.symlink("out", self.path("linked"))
        for _ in range(2):  # where there is no result yet, and where there is one
            self.fail_with(2, "out/box00.cli and out/box01.cli are one file", "slice", "--batch", "parts", "-o", "out", "--format", "cli")
            self.write("out/box01.cli", "")
        self.path("out/box00.cli").unlink()
        self.fail_with(2, "out/box00 and linked/box00 are one file", "slice", "--batch", "parts", "-o", "out/{name}", "--format",
                       "cli", "--stats", "linked/{name}")
        self.batch(0, "parts", "-o", "out", "--format", "cli", "--stats", "linked")

    @needs_posix("limits of processes")
    def test_a_working_folder_that_is_gone_is_reported(self):
        self.boxes("parts", 2)
        self.write("list", "box00.stl\n")
        self.path("gone").mkdir()
        result = self.run_program("slice", "--batch", self.path("list"), "-o", self.path("out"), "--format", "cli",
                                  cwd=self.path("gone"), preexec_fn=lambda: os.rmdir("../gone"))
        self.assertEqual(result.code, 3, result.err)
        self.assertIn("box00.stl: the working folder", result.err)
        self.path("gone").mkdir()
        result = self.run_program("slice", self.path("parts/box00.stl"), "-o", "x.cli", cwd=self.path("gone"),
                                  preexec_fn=lambda: os.rmdir("../gone"))
        self.assertEqual(result.code, 6, result.err)
        self.assertIn("cannot write 'x.cli': the working folder has been removed", result.err)

    def test_a_file_whose_statistics_cannot_be_written_has_an_output(self):
        self.boxes("parts", 1)
        self.path("stats/box00.json").mkdir(parents=True)
        record, = self.batch(7, "parts", "-o", "out", "--format", "cli", "--stats", "stats")
        self.assertEqual((record["error"]["kind"], record["output"]), ("output", "out/box00.cli"))
        self.assertTrue(self.path("out/box00.cli").exists())

    def test_options_come_from_a_configuration_file_as_well(self):
        self.boxes("parts", 1)
        self.write("machine.toml", "layer-height = 0.5\njobs = 2\nformat = \"svg\"\n")
        self.assertEqual(self.batch(0, "parts", "-o", "out", "--config", "machine.toml")[0]["layers"], 6)
        self.write("batch.toml", 'batch = "parts"\n')
        self.fail_with(2, "batch.toml:1: --batch goes on the command line only", "slice", "--config", "batch.toml", "-o", "out")

    def test_what_makes_no_sense(self):
        self.boxes("parts", 1)
        self.fail_with(2, "where should the result go", "slice", "--batch", "parts")
        self.fail_with(2, "unknown|extension|format", "slice", "--batch", "parts", "-o", "out")
        self.fail_with(2, "contradict", "slice", "--batch", "parts", "parts/box00.stl", "-o", "out", "--format", "cli")
        self.fail_with(2, "contradict", "slice", "--batch", "parts", "-o", "-", "--format", "cli")
        self.fail_with(2, r"\{nam\}.*none of", "slice", "--batch", "parts", "-o", "out/{nam}.cli")
        self.fail_with(2, r'"\{name" is none of', "slice", "--batch", "parts", "-o", "out/{name")
        self.fail_with(2, "--jobs goes with --batch", "slice", "parts/box00.stl", "-o", "x.cli", "--jobs", "2")
        self.fail_with(2, r"parts/box00\.stl: has the name of a mesh; expected a folder", "slice", "--batch", "parts/box00.stl",
                       "-o", "out", "--format", "cli")
        self.fail_with(2, "too many", "slice", "--batch", "parts", "-o", "o{name}.cli", "--jobs", "99999")
        self.fail_with(3, "there is no|No such", "slice", "--batch", "nowhere", "-o", "out", "--format", "cli")
        self.fail_with(3, "names no file", "slice", "--batch", "-", "-o", "out", "--format", "cli", stdin=b"# none\n")
        self.path("empty").mkdir()
        self.fail_with(3, "no file in this folder", "slice", "--batch", "empty", "-o", "out", "--format", "cli")
        self.fail_with(6, "cannot be made", "slice", "--batch", "parts", "-o", "parts/box00.stl", "--format", "cli")

    @needs_posix("pipes and devices with names")
    def test_pipes_and_sockets_in_a_folder_are_no_meshes(self):
        self.boxes("parts", 2)
        os.mkfifo(self.path("parts/box00a.stl"))
        os.mkfifo(self.path("pipe"))
        os.symlink("../pipe", self.path("parts/link.stl"))
        with socket.socket(socket.AF_UNIX) as listener:
            listener.bind(str(self.path("parts/box01a.stl")))
            records = self.batch(0, "parts", "-o", "out", "--format", "cli")
        self.assertEqual([r["path"] for r in records], ["parts/box00.stl", "parts/box01.stl"])

    def test_a_folder_that_cannot_be_listed_fails_like_a_file(self):
        self.boxes("parts/a", 1)
        self.boxes("parts/locked", 1)
        self.boxes("parts/z", 1)
        self.path("parts/locked").chmod(0)
        self.addCleanup(self.path("parts/locked").chmod, 0o700)
        records = self.batch(7, "parts", "-o", "out", "--format", "cli", **UNPRIVILEGED)
        self.assertEqual([(r["path"], r["ok"]) for r in records],
                         [("parts/a/box00.stl", True), ("parts/locked", False), ("parts/z/box00.stl", True)])
        self.assertEqual(records[1]["error"]["text"], "parts/locked: no permission to read this file")
        self.path("parts").chmod(0)
        self.addCleanup(self.path("parts").chmod, 0o700)
        result = self.run_program("slice", "--batch", "parts", "-o", "out", "--format", "cli", **UNPRIVILEGED)
        self.assertEqual(result.code, 3)
        self.assertIn("parts: the folder cannot be listed", result.err)

    def test_every_error_names_its_file(self):
        self.boxes("parts", 2)
        records = self.batch(7, "parts", "-o", "out", "--format", "cli", "--layer-height", "50")
        for record in records:
            self.assertRegex(record["error"]["text"], f"^{record['path']}: the layer height")
            self.assertEqual(record["error"]["text"].count(record["path"]), 1)

    def test_a_large_file_gets_more_threads(self):
        self.path("parts").mkdir()
        self.succeed("make", "sphere", "--detail", "9", "-o", "parts/large.stl")
        self.assertGreater(self.path("parts/large.stl").stat().st_size, 48_000_000)
        self.write("parts/small.stl", binary_stl(box_triangles(1, 1, 1)))
        records = self.batch(0, "parts", "--jobs", "3", "--stats", "out", "--layer-height", "0.5")
        self.assertEqual([r["threads"] for r in records], [3, 1])
        records = self.batch(0, "parts", "--jobs", "3", "--threads", "2", "--stats", "out", "--layer-height", "0.5")
        self.assertEqual([r["threads"] for r in records], [2, 1])


class Workers(ProgramTest):
    """What happens to the processes that do the work."""

    def start(self, files, *arguments):
        """A batch of small boxes and of pipes that nobody writes to: whoever reads them is stuck."""
        self.path("in").mkdir()
        for name in files:
            if name.startswith("pipe"):
                self.make_pipe(f"in/{name}.stl")
            else:
                self.write(f"in/{name}.stl", binary_stl(box_triangles(1, 1, 1)))
        return self.start_list(files, *arguments)

    def start_list(self, names, *arguments, **keywords):
        self.write("list", "".join(f"in/{name}.stl\n" for name in names))
        process = subprocess.Popen([*COMMAND, "slice", "--batch", "list", "-o", "out", "--format", "cli", *arguments],
                                   cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **keywords)
        self.addCleanup(process.kill)
        return process

    @staticmethod
    def workers(process):
        return [int(pid) for pid in Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()]

    @staticmethod
    def holds_open(pid, path):
        try:
            return any(os.readlink(link) == str(path) for link in Path(f"/proc/{pid}/fd").iterdir())
        except FileNotFoundError:
            return False

    def wait_for_reader(self, process, name):
        """The worker that reads the pipe, once it does."""
        path = self.path(f"in/{name}.stl").resolve()
        while process.poll() is None:
            for pid in self.workers(process):
                if self.holds_open(pid, path):
                    return pid
            time.sleep(0.01)
        self.fail(process.stderr.read())

    def end_of(self, process):
        out, err = process.communicate(timeout=120)
        return [json.loads(line) for line in out.splitlines()], err.decode()

    @needs_posix("pipes and devices with names")
    def test_one_that_dies_takes_nobody_along(self):
        deaths = [(signal.SIGSEGV, "crash", 1), (signal.SIGKILL, "limit", 5), (signal.SIGXCPU, "limit", 5)]
        for number, kind, code in deaths:
            with self.subTest(number):
                process = self.start(["box1", "pipe", "box2", "box3"], "--jobs", "2")
                os.kill(self.wait_for_reader(process, "pipe"), number)
                records, err = self.end_of(process)
                self.assertEqual(process.returncode, 7)
                self.assertEqual([r["ok"] for r in records], [True, False, True, True])
                self.assertEqual((records[1]["error"]["kind"], records[1]["error"]["exit_code"]), (kind, code))
                self.assertIn("in/pipe.stl: ", records[1]["error"]["text"])
                self.assertIn(f"1 failed (1 {kind})", err)
                self.assertEqual(sorted(p.name for p in self.path("out").iterdir()), ["box1.cli", "box2.cli", "box3.cli"])
            self.doCleanups()
            self.setUp()

    @needs_posix("pipes and devices with names")
    def test_small_files_that_go_together_are_distinguished(self):
        names = [f"box{i:02}" for i in range(50)]
        self.path("in").mkdir()
        for name in names:
            self.write(f"in/{name}.stl", binary_stl(box_triangles(1, 1, 100_000 if name == "box05" else 1)))
        process = self.start_list(names, "--jobs", "1")
        before = self.path("out/box04.cli")
        for _ in range(2):  # with those beside it, and by itself
            written = before.stat().st_mtime_ns if before.exists() else None
            while process.poll() is None and (not before.exists() or before.stat().st_mtime_ns == written):
                time.sleep(0.005)
            time.sleep(0.1)
            for worker in self.workers(process) if process.poll() is None else []:
                os.kill(worker, signal.SIGKILL)
        records, _ = self.end_of(process)
        self.assertEqual(process.returncode, 7)
        self.assertEqual([r["path"] for r in records], [f"in/{name}.stl" for name in names])
        self.assertEqual([r["path"] for r in records if not r["ok"]], ["in/box05.stl"])

    def test_one_that_is_stuck_is_ended_by_its_timeout(self):
        process = self.start(["box1", "pipe1", "box2", "pipe2", "box3"], "--jobs", "1", "--timeout", "0.3")
        records, _ = self.end_of(process)
        self.assertEqual(process.returncode, 7)
        self.assertEqual([r["ok"] for r in records], [True, False, True, False, True])
        for record in [records[1], records[3]]:
            self.assertEqual(record["error"]["kind"], "limit")
            self.assertIn("--timeout", record["error"]["text"])

    def test_progress_is_reported_where_there_is_any(self):
        process = self.start(["box1", "pipe", "box2"], "--jobs", "2", "--progress", "json", "--timeout", "1")
        _, err = self.end_of(process)
        done = [line["done"] for line in map(json.loads, err.splitlines()) if "done" in line]
        self.assertEqual(done, sorted(set(done)))
        self.assertEqual(done[-1], 3)

    @needs_posix("pipes and devices with names")
    def test_a_batch_that_is_stopped_leaves_neither_files_nor_processes(self):
        for number in [signal.SIGINT, signal.SIGTERM, signal.SIGHUP]:
            with self.subTest(number):
                process = self.start(["box1", "pipe1", "pipe2", "box2"], "--jobs", "2")
                workers = [self.wait_for_reader(process, name) for name in ["pipe1", "pipe2"]]
                process.send_signal(number)
                records, err = self.end_of(process)
                self.assertEqual(process.returncode, 130)
                self.assertEqual([r["path"] for r in records], ["in/box1.stl"])
                self.assertIn("cancelled", err)
                self.assertEqual([p.name for p in self.path("out").iterdir()], ["box1.cli"])
                self.assert_gone(workers)
            self.doCleanups()
            self.setUp()

    def test_what_was_done_is_reported_of_a_batch_that_is_stopped(self):
        self.path("in").mkdir()
        names = [f"box{i:02}" for i in range(50)]
        for name in names:
            self.write(f"in/{name}.stl", binary_stl(box_triangles(1, 1, 1 if name < "box05" else 2_000)))
        process = self.start_list(names, "--jobs", "1")
        while not self.path("out/box04.cli").exists():
            self.assertIsNone(process.poll())
            time.sleep(0.005)
        process.send_signal(STOPPING_SIGNALS[-1])
        records, _ = self.end_of(process)
        self.assertEqual(process.returncode, 130)
        self.assertEqual([r["path"] for r in records][:5], [f"in/{name}.stl" for name in names[:5]])

    def soon(self, attempt):
        """One of a few attempts has to succeed: a program that is stopped waits for its workers for a part of a second, which
        is not enough where others keep the processors busy."""
        for _ in range(5):
            if attempt():
                return
            self.doCleanups()
            self.setUp()
        self.fail("results were lost each time")

    def test_results_behind_one_that_never_comes_are_reported_of_a_batch_that_is_stopped(self):
        def attempt():
            process = self.start(["pipe", "box1", "box2"], "--jobs", "2")
            while not self.path("out/box2.cli").exists():
                self.assertIsNone(process.poll())
                time.sleep(0.005)
            process.send_signal(signal.SIGINT)
            records, err = self.end_of(process)
            self.assertEqual(process.returncode, 130)
            self.assertEqual([r for r in records if not r["ok"]], [])
            return ([r["path"] for r in records] == ["in/box1.stl", "in/box2.stl"]
                    and "3 files: 2 sliced, 1 not begun or cancelled" in err)

        self.soon(attempt)

    @needs_posix("pipes and devices with names")
    def test_a_signal_that_workers_get_as_well_loses_no_result(self):
        # As Ctrl-C in a terminal, and the end of a service.
        def attempt(number):
            self.path("in").mkdir()
            names = [f"box{i:03}" for i in range(900)]
            for name in names:
                self.write(f"in/{name}.stl", binary_stl(box_triangles(1, 1, 10)))
            os.mkfifo(self.path("in/pipe.stl"))  # so that it does not end by itself
            process = self.start_list([*names, "pipe"], "--jobs", "3", start_new_session=True)
            while not self.path("out/box100.cli").exists():
                self.assertIsNone(process.poll())
                time.sleep(0.002)
            os.killpg(process.pid, number)
            records, _ = self.end_of(process)
            self.assertEqual(process.returncode, 130)
            self.assertEqual([r for r in records if not r["ok"]], [])
            told = [r["output"] for r in records]
            written = sorted(f"out/{p.name}" for p in self.path("out").iterdir())
            self.assertLessEqual(set(told), set(written))
            return told == written

        for number in [signal.SIGINT, signal.SIGTERM]:
            with self.subTest(number):
                self.soon(lambda: attempt(number))
            self.doCleanups()
            self.setUp()

    def test_a_batch_that_is_stopped_while_workers_are_started_reports_its_results(self):
        def attempt():
            names = [f"box{i:03}" for i in range(400)]
            self.path("in").mkdir()
            for name in names:
                self.write(f"in/{name}.stl", binary_stl(box_triangles(1, 1, 1)))
            self.make_pipe("in/pipe.stl")
            process = self.start_list([*names, "pipe"], "--jobs", "20" if ON_WINDOWS else "200")
            while not list(self.path("out").glob("*.cli")):
                self.assertIsNone(process.poll())
                time.sleep(0.002)
            process.send_signal(signal.SIGINT)
            records, err = self.end_of(process)
            self.assertEqual(process.returncode, 130)
            return len(records) > 0 and "401 files" in err

        self.soon(attempt)

    @needs_posix("limits of processes")
    def test_a_batch_goes_on_with_fewer_workers_where_no_more_can_be_started(self):
        names = [f"box{i:02}" for i in range(60)]
        self.path("in").mkdir()
        for name in names:
            self.write(f"in/{name}.stl", binary_stl(box_triangles(1, 1, 1)))
        self.write("list", "".join(f"in/{name}.stl\n" for name in names))
        result = self.succeed("slice", "--batch", "list", "-o", "out", "--format", "cli", "--jobs", "40",
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (20, 20)))
        self.assertEqual(len(result.out.splitlines()), len(names))

    @needs_posix("names of files of any bytes")
    def test_results_fit_a_message_whatever_names_and_texts_there_are(self):
        deep = "/".join(["in"] + 31 * [120 * "\u0001"])
        self.path(deep).mkdir(parents=True)
        self.write(f"{deep}/open.stl", binary_stl(open_box(1, 1, 1)))
        self.write(f"{deep}/wrong.stl", b"no mesh")
        self.write("list", "\0".join(f"{deep}/{name}.stl" for name in ["open", "wrong"]))
        result = self.run_program("slice", "--batch", "list", "-o", "out", "--format", "cli")
        records = [json.loads(line) for line in result.out.splitlines()]
        self.assertEqual([r["ok"] for r in records], [True, False], result.err)
        self.assertEqual([r["path"] for r in records], [f"{deep}/open.stl", f"{deep}/wrong.stl"])
        self.assertEqual(records[0]["warnings"], ["the warnings are too long to be listed here"])

    @needs_posix("pipes and devices with names")
    def test_workers_end_with_a_program_that_is_killed(self):
        process = self.start(["pipe1", "pipe2"], "--jobs", "2")
        workers = [self.wait_for_reader(process, name) for name in ["pipe1", "pipe2"]]
        process.kill()
        process.communicate()
        self.assert_gone(workers)

    def assert_gone(self, workers):
        end = time.monotonic() + 60
        while any(Path(f"/proc/{pid}/fd").exists() and self.is_alive(pid) for pid in workers):
            self.assertLess(time.monotonic(), end, "a worker lives on")
            time.sleep(0.02)

    @staticmethod
    def is_alive(pid):
        try:
            return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
        except (FileNotFoundError, ProcessLookupError):
            return False

    def test_nobody_reads_the_results(self):
        process = self.start(["box%d" % i for i in range(50)])
        process.stdout.close()
        self.assertEqual(process.wait(timeout=60), -signal.SIGPIPE)
        self.assertNotIn(b"error", process.stderr.read())
        process.stderr.close()


if __name__ == "__main__":
    main()
