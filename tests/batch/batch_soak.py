#!/usr/bin/env python3
"""A study of 1,000 variants on a real Slurm on this host, while workers are killed, the controller is restarted and the disk is filled. What is
missing is submitted again, until each variant has exactly one accepted result. Exit status 77: not tested, with the reason.

    batch_soak.py PROGRAMS [VARIANTS]
"""
import json
import pathlib
import random
import subprocess
import sys
import tempfile
import time

from cluster import Cluster, missing
from study_folder import StudyFolder

PATIENCE_S = 1800


def workers():
    """Process ids of the workers of this study, those that work one variant."""
    listed = subprocess.run(["pgrep", "-f", f"^{PROGRAM} batch {FOLDER}.* --variant "], capture_output=True, text=True)
    return [int(line) for line in listed.stdout.split()]


def identity(study, key):
    """Of an accepted result; None: there is none. It must never change."""
    try:
        state = (study.results / "variants" / key / "result.json").stat()
    except FileNotFoundError:
        return None
    return state.st_ino, state.st_mtime_ns


def results(study):
    """The identities of the accepted results. A folder that changes while it is listed may be listed without some that it holds."""
    names = [path.name for path in (study.results / "variants").iterdir()] if (study.results / "variants").exists() else []
    return {name: state for name in names if not name.startswith("work-") and (state := identity(study, name))}


class Trouble:
    def __init__(self, cluster, study, random_):
        self.cluster, self.study, self.random = cluster, study, random_
        self.killed = self.restarted = self.filled = 0
        self.filler = study.results / "filler"

    def kill_workers(self):
        for process in workers():
            if self.random.random() < 0.3 and subprocess.run(["kill", "-9", str(process)], capture_output=True).returncode == 0:
                self.killed += 1

    def restart_controller(self):
        self.cluster.stop("slurmctld", self.random.choice([9, 15]))
        time.sleep(1)
        self.cluster.start_controller()
        self.cluster.ask("scontrol", "reconfigure")  # the node says what runs there, and jobs that nobody knows any more run again
        self.restarted += 1

    def fill_disk(self):
        with open(self.filler, "wb") as file:
            try:
                while True:
                    file.write(bytes(1 << 20))
                    file.flush()
            except OSError:
                pass
        time.sleep(4)
        self.filler.unlink()
        self.filled += 1


def main():
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 1000
    seed = random.randrange(1 << 32)
    print(f"seed {seed}", flush=True)
    study = StudyFolder(PROGRAMS, FOLDER / "study", f'plan = "sobol"\nsamples = {count}\npictures = false\n[parameters]\nheight = {{from = 2, to = 12}}\n[slurm]\nmax_tasks = 100\n')
    study.results.mkdir()
    # every result has a deck of some 300 kB; beside them there is little room
    megabytes = 200 + count * 2 // 3
    if subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={megabytes}m", "tmpfs", study.results], capture_output=True).returncode != 0:
        print("SKIPPED: no small file system can be mounted here")
        return 77
    try:
        with Cluster(FOLDER / "cluster", 2) as cluster:
            return work(cluster, study, count, random.Random(seed))
    finally:
        subprocess.run(["umount", "-l", study.results], check=False)


def work(cluster, study, count, random_):
    trouble = Trouble(cluster, study, random_)
    accepted, submissions, begun = {}, 0, time.monotonic()
    while time.monotonic() - begun < PATIENCE_S:
        done = study.batch("--slurm", "--json", env=cluster.environment)
        said = json.loads(done.stdout) if done.stdout else {}
        if "submitted" not in said:
            if done.returncode == 0:
                break
            print(done.stderr, flush=True)
            return 1
        submissions += 1
        print(f"submission {submissions}: {said['submitted']} variants", flush=True)
        # once a submission each: Slurm needs its time to find the jobs of a controller that was killed. The last submissions go through.
        once = [trouble.restart_controller, trouble.fill_disk] if submissions <= 3 else []
        random_.shuffle(once)
        next_ = time.monotonic() + 10
        while cluster.jobs():
            time.sleep(random_.uniform(0.5, 3))
            cluster.resume_node()
            if once and time.monotonic() > next_:
                once.pop()()
                next_ = time.monotonic() + 45
            elif submissions <= 3:
                trouble.kill_workers()
            changed = [(key, state, identity(study, key)) for key, state in accepted.items() if identity(study, key) != state]
            if changed:
                print(f"{len(changed)} accepted results have changed: {changed[:5]}")
                return 1
            accepted.update(results(study))
    faults = study.faults(count)
    print(f"{count} variants, {submissions} submissions, {trouble.killed} workers killed, {trouble.restarted} restarts of the controller, {trouble.filled} times a full disk, {time.monotonic() - begun:.0f} s")
    for fault in faults:
        print(fault)
    if not (trouble.killed and trouble.restarted and trouble.filled):
        print("there was too little trouble")
        return 1
    return 1 if faults else 0


if __name__ == "__main__":
    PROGRAMS = pathlib.Path(sys.argv[1]).resolve()
    PROGRAM = PROGRAMS / "prismesh"
    if why := missing():
        print("SKIPPED: " + why)
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="soak-") as folder:
        FOLDER = pathlib.Path(folder)
        sys.exit(main())
