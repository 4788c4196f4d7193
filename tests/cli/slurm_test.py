"""Slurm on this machine, with two nodes of a processor each: slurm_test.py LUMULUS SOURCE_FOLDER. Needs Debian's slurm-wlm, and
no systemd, munge or rights. What the jobs make has the bytes of what one process makes, whatever is killed meanwhile.
"""

import hashlib
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

LUMULUS, SOURCE = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2])
SCRIPTS = SOURCE / "configs/slurm"
SCENE = """
image = { width = 48, height = 27 }
photon_map = { photons = 400000, generations = 8 }
preparation = { samples = 500 }
sky = { model = "constant" }
[[cloud]]
resolution = 24
[animate]
"sun.azimuth" = [[0, 0], [7, 90]]
"""
CONFIGURATION = """
ClusterName=lumulus
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/none
CredType=cred/none
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
SchedulerParameters=sched_interval=1,batch_sched_delay=0
MinJobAge=600
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd-%n.log
NodeName=n0 NodeHostName={host} NodeAddr=127.0.0.1 Port={ports[1]} CPUs=1
NodeName=n1 NodeHostName={host} NodeAddr=127.0.0.1 Port={ports[2]} CPUs=1
PartitionName=all Nodes=n0,n1 Default=YES State=UP
"""


def free_ports(count):
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


def sums(folder, pattern):
    """SHA-256 by name."""
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(folder.glob(pattern))}


class Slurm(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="lumulus-slurm-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        (cls.folder / "state").mkdir()
        user = subprocess.run(["id", "-un"], capture_output=True, text=True, check=True).stdout.strip()
        configuration = cls.folder / "slurm.conf"
        configuration.write_text(CONFIGURATION.format(host=socket.gethostname().split(".")[0], user=user, folder=cls.folder,
                                                      ports=free_ports(3)))
        cls.environment = {**os.environ, "SLURM_CONF": str(configuration), "LUMULUS": LUMULUS}
        for command in (["slurmctld", "-D"], ["slurmd", "-D", "-N", "n0"], ["slurmd", "-D", "-N", "n1"]):
            path = shutil.which(command[0], path=os.environ["PATH"] + ":/usr/sbin")
            daemon = subprocess.Popen([path, *command[1:], "-f", configuration], env=cls.environment,
                                      stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            cls.addClassCleanup(daemon.wait)
            cls.addClassCleanup(daemon.terminate)
        cls.scene = cls.folder / "scene.toml"
        cls.scene.write_text(SCENE)
        cls.wait_until(lambda: cls.slurm("sinfo", "-h", "-o", "%D %t").split() == ["2", "idle"], 60)

    @classmethod
    def slurm(cls, *arguments):
        result = subprocess.run(list(map(str, arguments)), env=cls.environment, cwd=cls.folder, capture_output=True, text=True)
        return result.stdout.strip()

    @classmethod
    def wait_until(cls, happens, seconds=120):
        deadline = time.monotonic() + seconds
        while not happens():
            if time.monotonic() > deadline:
                raise AssertionError(cls.slurm("squeue", "-r", "-t", "all", "-o", "%i %j %T %r %S") + "\n" +
                                     (cls.folder / "slurmctld.log").read_text()[-2000:])
            time.sleep(0.1)

    def states(self, job):
        return self.slurm("squeue", "-h", "-r", "-t", "all", "-j", job, "-o", "%T").split()

    def ended(self, job):
        """Whether all tasks are done. A task that was requeued would wait two minutes: its start is asked for until Slurm
        takes it, since what is asked before the killed one has left is forgotten."""
        for task in self.slurm("squeue", "-h", "-r", "-t", "pending", "-o", "%i %r").splitlines():
            if task.endswith(" BeginTime"):
                self.slurm("scontrol", "update", f"JobId={task.split()[0]}", "StartTime=now")
        states = self.states(job)
        self.assertFalse(set(states) & {"FAILED", "CANCELLED", "TIMEOUT", "NODE_FAIL"}, self.logs())
        return bool(states) and set(states) == {"COMPLETED"}

    def requeue(self, job):
        """Kills the first task of a job that runs, as where a node is lost."""
        running = []
        self.wait_until(lambda: running.extend(self.slurm("squeue", "-h", "-r", "-t", "running", "-j", job, "-o", "%i").split()) or
                        running)
        self.slurm("scontrol", "requeue", running[0])

    def logs(self):
        return "\n".join(f"{path.name}: {path.read_text()}" for path in sorted(self.folder.glob("*.log"))[-12:])

    def lumulus(self, *arguments):
        subprocess.run([LUMULUS, *map(str, arguments), "--quiet"], check=True)

    def test_frames(self):
        """Eight frames in four tasks, one of which is requeued while it works."""
        alone, farm = self.folder / "alone", self.folder / "farm"
        alone.mkdir()
        farm.mkdir()
        self.lumulus("render", self.scene, "--frames", "0-7", "-o", alone / "f_####.exr")
        environment = {**self.environment, "CHUNK": "2"}
        job = subprocess.run(["sbatch", "--parsable", "--array=0-3", SCRIPTS / "frames.sbatch", self.scene, "0", "7",
                              farm / "f_####.exr"], env=environment, cwd=self.folder, capture_output=True, text=True,
                             check=True).stdout.strip()
        self.wait_until(lambda: any(farm.iterdir()))
        self.requeue(job)
        self.wait_until(lambda: self.ended(job))
        self.assertEqual(sums(farm, "*.exr"), sums(alone, "*.exr"))
        self.assertEqual(len(sums(farm, "*")), 8)

    def test_still(self):
        """Four parts, one of them killed and traced again, and the picture behind them."""
        self.lumulus("render", self.scene, "-o", self.folder / "one.exr")
        maps, picture = self.folder / "maps", self.folder / "still.exr"
        more = ["--set", "photon_map.photons=400000"]
        job = self.slurm(SCRIPTS / "still", self.scene, 4, maps, picture, "--", *more)
        self.assertTrue(job.isdigit(), job)
        self.wait_until(lambda: "RUNNING" in self.states(int(job) - 1))
        self.requeue(int(job) - 1)
        self.wait_until(lambda: self.ended(job))
        self.assertEqual(hashlib.sha256(picture.read_bytes()).hexdigest(),
                         hashlib.sha256((self.folder / "one.exr").read_bytes()).hexdigest())

    def test_a_part_that_fails_stops_the_picture(self):
        job = self.slurm(SCRIPTS / "still", self.folder / "none.toml", 2, self.folder / "none", self.folder / "none.exr")
        self.wait_until(lambda: set(self.states(int(job) - 1)) == {"FAILED"})
        self.wait_until(lambda: "DependencyNeverSatisfied" in self.slurm("squeue", "-h", "-j", job, "-o", "%r"))
        self.slurm("scancel", job)
        self.assertFalse((self.folder / "none.exr").exists())
        self.assertIn("none.toml", self.logs())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
