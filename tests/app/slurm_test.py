"""The Slurm example on a real Slurm: a cluster of one node, started for this test."""

import getpass
import os
import shutil
import socket
import subprocess
import time
import unittest

from program import PROGRAM, SOURCE, ProgramTest, main

CLUSTER = SOURCE / "examples" / "cluster"
MISSING = [name for name in ("slurmctld", "slurmd", "sbatch") if shutil.which(name) is None]

CONFIGURATION = """
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
AuthType=auth/none
CredType=cred/none
SlurmUser={user}
SlurmdUser={user}
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
ReturnToService=2
MpiDefault=none
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} RealMemory=1000 State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


@unittest.skipIf(MISSING, f"not installed: {', '.join(MISSING)}")
class Slurm(ProgramTest):
    def setUp(self):
        super().setUp()
        cluster = self.path("cluster")
        for name in ["state", "spool", "bin"]:
            (cluster / name).mkdir(parents=True)
        (cluster / "bin" / "lamella").symlink_to(PROGRAM)
        configuration = cluster / "slurm.conf"
        configuration.write_text(CONFIGURATION.format(
            host=socket.gethostname().split(".")[0], user=getpass.getuser(), ports=self.free_ports(2), folder=cluster,
            cpus=len(os.sched_getaffinity(0))))
        self.environment = dict(os.environ, SLURM_CONF=str(configuration), PART="part.stl", SHARDS="3",
                                PATH=f"{cluster / 'bin'}:{os.environ['PATH']}")
        for daemon in ["slurmctld", "slurmd"]:
            self.start(daemon, cluster)
        self.wait_until("the node is idle", lambda: "idle" in self.slurm("sinfo", "--noheader", check=False))

    @staticmethod
    def free_ports(count):
        sockets = [socket.socket() for _ in range(count)]
        for one in sockets:
            one.bind(("127.0.0.1", 0))
        ports = [one.getsockname()[1] for one in sockets]
        for one in sockets:
            one.close()
        return ports

    def start(self, daemon, cluster):
        log = open(cluster / f"{daemon}.out", "wb")
        self.addCleanup(log.close)
        process = subprocess.Popen([daemon, "-D", "-f", self.environment["SLURM_CONF"]], env=self.environment,
                                   stdout=log, stderr=log)
        self.addCleanup(process.wait, timeout=60)
        self.addCleanup(process.terminate)

    def slurm(self, *command, check=True):
        words = [str(word) for word in command]
        result = subprocess.run(words, cwd=self.folder, env=self.environment, capture_output=True, text=True, timeout=60,
                                check=False)
        if check:
            self.assertEqual(result.returncode, 0, f"{words}: {result.stderr}")
        return result.stdout.strip()

    def wait_until(self, what, holds):
        for _ in range(600):
            if holds():
                return
            time.sleep(0.1)
        logs = {p.name: p.read_text(errors="replace")[-2000:] for p in self.path("cluster").glob("*.log")}
        self.fail(f"waited a minute for this: {what}; {logs}")

    def run_job(self):
        small = ["--mem=200M", "--cpus-per-task=1"]
        job = self.slurm("sbatch", "--parsable", f"--array=1-{self.environment['SHARDS']}", *small,
                         CLUSTER / "slice.sbatch")
        self.slurm("sbatch", "--parsable", f"--dependency=afterok:{job}", *small, CLUSTER / "merge.sbatch")
        self.wait_until("all jobs are over", lambda: self.slurm("squeue", "--noheader") == "")

    def test_an_array_slices_and_is_merged_and_skips_what_is_finished(self):
        self.succeed("make", "rook", "-o", "part.stl")
        self.succeed("slice", "part.stl", "-o", "whole.cli")
        self.run_job()
        self.assertEqual(self.bytes_of("part.cli"), self.bytes_of("whole.cli"))

        finished = {i: self.path(f"part.{i}.cli").stat().st_ino for i in (1, 3)}
        self.path("part.2.cli").unlink()
        self.path("part.cli").unlink()
        self.run_job()
        self.assertEqual(self.bytes_of("part.cli"), self.bytes_of("whole.cli"))
        for i, inode in finished.items():
            self.assertEqual(self.path(f"part.{i}.cli").stat().st_ino, inode)


if __name__ == "__main__":
    main()
