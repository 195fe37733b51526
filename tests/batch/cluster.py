"""Slurm on this host: a real munged, slurmctld and slurmd with folders, ports and a key of their own.

Needs root, and the packages munge, slurmctld, slurmd and slurm-client. Nothing of it is left when it ends.
"""
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import time

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "scontrol", "squeue")
PATIENCE_S = 60


def missing():
    """Why there can be no cluster here; empty: there can."""
    lacking = [name for name in PROGRAMS if not shutil.which(name, path=os.environ["PATH"] + ":/usr/sbin")]
    if lacking:
        return "not installed: " + ", ".join(lacking)
    return "" if os.geteuid() == 0 else "slurmd needs root"


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for each in sockets:
        each.bind(("", 0))
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


class Cluster:
    def __init__(self, folder, cores):
        self.folder = pathlib.Path(folder)
        self.daemons = {}
        for name in ("munge", "state", "spool", "log"):
            (self.folder / name).mkdir(parents=True)
        self.host = socket.gethostname().split(".")[0]
        self.ports = free_ports(2)
        self.conf = self.folder / "slurm.conf"
        self.socket = self.folder / "munge" / "socket"
        self.conf.write_text(
            f"""ClusterName=test
SlurmctldHost={self.host}(127.0.0.1)
SlurmctldPort={self.ports[0]}
SlurmdPort={self.ports[1]}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={self.socket}
CredType=cred/munge
StateSaveLocation={self.folder}/state
SlurmdSpoolDir={self.folder}/spool
SlurmctldPidFile={self.folder}/slurmctld.pid
SlurmdPidFile={self.folder}/slurmd.pid
SlurmctldLogFile={self.folder}/log/slurmctld.log
SlurmdLogFile={self.folder}/log/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=2,batch_sched_delay=0,requeue_delay=1
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
SlurmdTimeout=30
KillWait=2
MinJobAge=20
MaxJobCount=20000
MaxArraySize=1001
JobRequeue=1
NodeName={self.host} NodeAddr=127.0.0.1 CPUs={cores} State=UNKNOWN
PartitionName=all Nodes={self.host} Default=YES MaxTime=INFINITE State=UP
"""
        )
        self.environment = {**os.environ, "SLURM_CONF": str(self.conf), "PATH": os.environ["PATH"] + ":/usr/sbin"}

    def __enter__(self):
        try:
            key = self.folder / "munge" / "key"
            key.write_bytes(os.urandom(1024))
            key.chmod(0o400)
            munge = [shutil.which("munged", path=self.environment["PATH"]), "--foreground", "--force", f"--socket={self.socket}", f"--key-file={key}"]
            munge += [f"--pid-file={key.parent}/pid", f"--log-file={key.parent}/log", f"--seed-file={key.parent}/seed"]
            self.start("munged", munge)
            self.until(self.socket.exists, "munged has no socket")
            self.start_controller()
            self.start_node()
            self.until(lambda: "idle" in self.ask("sinfo", "-h", "-o", "%T"), "the node isn't idle")
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        if "slurmctld" in self.daemons:
            subprocess.run(["scancel", "--full", "-u", "root"], env=self.environment, capture_output=True, timeout=PATIENCE_S)
            time.sleep(1)
        for name in ("slurmd", "slurmctld", "munged"):
            self.stop(name)

    def start(self, name, command):
        log = open(self.folder / "log" / f"{name}.out", "ab")
        self.daemons[name] = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=log, env=self.environment)
        log.close()

    def start_controller(self):
        self.start("slurmctld", ["/usr/sbin/slurmctld", "-D", "-f", str(self.conf)])
        self.until(lambda: "UP" in self.ask("scontrol", "ping"), "slurmctld doesn't answer")

    def start_node(self):
        self.start("slurmd", ["/usr/sbin/slurmd", "-D", "-f", str(self.conf), "-N", self.host])

    def stop(self, name, how=signal.SIGTERM):
        daemon = self.daemons.pop(name, None)
        if daemon is None:
            return
        daemon.send_signal(how)
        try:
            daemon.wait(20)
        except subprocess.TimeoutExpired:
            daemon.kill()
            daemon.wait()

    def ask(self, *command):
        return subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=PATIENCE_S).stdout

    def until(self, condition, complaint, patience=PATIENCE_S):
        end = time.monotonic() + patience
        while not condition():
            for name, daemon in self.daemons.items():
                if daemon.poll() is not None:
                    raise RuntimeError(f"{name} has ended: {self.logs()}")
            if time.monotonic() > end:
                raise RuntimeError(f"{complaint}: {self.logs()}")
            time.sleep(0.1)

    def logs(self):
        return "\n".join(f"--- {path.name}\n" + path.read_text(errors="replace")[-1500:] for path in sorted((self.folder / "log").iterdir()))

    def resume_node(self):
        """As an administrator does: a controller that was killed forgets jobs, and Slurm takes a node that still runs one out of service."""
        if any(word in self.ask("sinfo", "-h", "-o", "%T") for word in ("drain", "down")):
            self.ask("scontrol", "update", f"nodename={self.host}", "state=resume")

    def jobs(self):
        return [line for line in self.ask("squeue", "-h", "-r", "-o", "%i %T").splitlines() if line]

    def until_done(self, patience=600):
        self.until(lambda: not self.jobs(), "jobs are left", patience)
