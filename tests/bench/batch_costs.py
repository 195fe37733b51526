#!/usr/bin/env python3
"""What the steps of `prismesh batch` cost on this machine, as JSON: the inputs of batch_scale.py.

    batch_costs.py PROGRAMS [--parts slurm,files,tables,worker,variant,rate] [--most 100000] > batch_costs.json

slurm: a real slurmctld (tests/batch/cluster.py), which needs root. files: folders of results. tables: `prismesh batch PLAN` on results that were
made here from a real one. worker: what a process for one variant costs before it works. variant: what the work on one costs. rate: variants a minute with one and two workers.
Processor seconds are of the process and its children; other work on the machine changes them little.
"""
import argparse
import json
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "batch"))
from cluster import Cluster, missing  # noqa: E402
from study_folder import StudyFolder  # noqa: E402

TICKS = os.sysconf("SC_CLK_TCK")


def timed(work):
    """(result, wall seconds, processor seconds of this process and the children that it waited for)"""
    def cpu():
        used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
        return sum(each.ru_utime + each.ru_stime for each in used)
    begun, before = time.monotonic(), cpu()
    result = work()
    return result, time.monotonic() - begun, cpu() - before


def cpu_of(process):
    fields = pathlib.Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / TICKS


def run(command, **more):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, **more)


def slurm_costs(folder):
    if why := missing():
        print("SLURM IS NOT MEASURED: " + why, file=sys.stderr)
        return {}
    cluster = Cluster(folder / "cluster", 2)
    conf = cluster.conf.read_text()
    cluster.conf.write_text(conf.replace("MaxArraySize=1001", "MaxArraySize=100001").replace("MaxJobCount=20000", "MaxJobCount=150000"))
    found = {"version": run(["sbatch", "--version"], env=cluster.environment).stdout.strip()}
    with cluster:
        script = folder / "true.sh"
        script.write_text("#!/bin/sh\nexit 0\n")

        def submit(*how):
            return run(["sbatch", "--parsable", "--output=/dev/null", *how, script], env=cluster.environment)

        def controller(work):
            """(result, wall seconds, the controller's processor seconds)"""
            before = cpu_of(cluster.daemons["slurmctld"].pid)
            result, wall, _ = timed(work)
            return result, wall, cpu_of(cluster.daemons["slurmctld"].pid) - before

        found["submit_array"], found["squeue"] = {}, {}
        for count in (1000, 10_000, 100_000):
            job, wall, cpu = controller(lambda: submit("--hold", f"--array=0-{count - 1}"))
            assert job.returncode == 0, job.stderr
            found["submit_array"][count] = {"wall_s": wall, "controller_cpu_s": cpu}
            listed, wall, cpu = controller(lambda: run(["squeue", "-h", "-r", "-o", "%i %T"], env=cluster.environment))
            assert len(listed.stdout.splitlines()) == count, listed.stderr
            folded, folded_wall, _ = controller(lambda: run(["squeue", "-h", "-o", "%i %T"], env=cluster.environment))
            assert len(folded.stdout.splitlines()) == 1
            found["squeue"][count] = {"each_task_wall_s": wall, "controller_cpu_s": cpu, "folded_wall_s": folded_wall}
            if count == 100_000:  # does an array count as one job or as its tasks?
                found["second_array_of_100000"] = submit("--hold", "--array=0-99999").stderr.strip() or "accepted"
            run(["scancel", "-u", "root"], env=cluster.environment)
            cluster.until_done(120)
            time.sleep(1)
        found["array_above_limit"] = submit("--hold", "--array=0-100001").stderr.strip()
        jobs, wall, cpu = controller(lambda: [submit("--hold") for _ in range(100)])
        found["submit_single"] = {"jobs": len(jobs), "wall_s": wall, "controller_cpu_s": cpu}
        run(["scancel", "-u", "root"], env=cluster.environment)
        cluster.until_done(120)
        found["sacct"] = run(["sacct", "-n"], env=cluster.environment).stderr.strip()

        tasks = 400
        def all_run():
            submit(f"--array=0-{tasks - 1}")
            cluster.until_done(300)
        _, wall, cpu = controller(all_run)
        found["empty_tasks"] = {"tasks": tasks, "wall_s": wall, "controller_cpu_s": cpu}
    return found


def file_costs(folder, most):
    found = {"file_system": run(["stat", "-f", "-c", "%T", folder]).stdout.strip(), "counts": {}}
    text = "x" * 1200
    count = 1000
    while count <= most:
        variants = folder / f"files{count}"
        variants.mkdir()

        def make():
            for number in range(count):
                work = variants / f"work-{number}"
                work.mkdir()
                (work / "result.json").write_text(text)
                work.rename(variants / f"{number:032x}")
        _, wall, cpu = timed(make)
        listed, list_wall, _ = timed(lambda: sum(1 for _ in os.scandir(variants)))
        _, stat_wall, _ = timed(lambda: [os.stat(variants / f"{number:032x}" / "result.json") for number in range(count)])
        _, read_wall, _ = timed(lambda: [(variants / f"{number:032x}" / "result.json").read_bytes() for number in range(count)])
        assert listed == count
        found["counts"][count] = {"make_s": wall, "make_cpu_s": cpu, "list_s": list_wall, "stat_s": stat_wall, "read_s": read_wall}
        shutil.rmtree(variants)
        count *= 10

    def flush(path):
        descriptor = os.open(path, os.O_RDONLY)
        os.fsync(descriptor)
        os.close(descriptor)
    variants = folder / "flushed"
    variants.mkdir()

    def accept():
        for number in range(200):
            work = variants / f"work-{number}"
            work.mkdir()
            (work / "result.json").write_text(text)
            for path in (work / "result.json", work, work):
                flush(path)
            work.rename(variants / f"{number:032x}")
            flush(variants)
    _, wall, _ = timed(accept)
    found["flushed"] = {"results": 200, "wall_s": wall}
    return found


def small_study(programs, folder, how, samples, elements=2000, more=""):
    return StudyFolder(programs, folder, f'{more}plan = "{how}"\nsamples = {samples}\npictures = false\n[parameters]\nheight = {{from = 2, to = 12}}\n', elements=elements)


def fill(study, keys, template, deck):
    """Results of these keys, each in its folder with a file for its deck, as one worked here."""
    for key in keys:
        at = study.results / "variants" / key
        if at.exists():
            continue
        at.mkdir(parents=True)
        (at / "result.json").write_text(json.dumps({**template, "key": key}))
        (at / deck.name).write_bytes(b"$\n")  # is only looked for


def tables_costs(programs, folder, most):
    found = {}
    count = 1000
    while count <= most:
        study = small_study(programs, folder / f"tables{count}", "sobol", count)
        study.batch()
        keys = [row["key"] for row in json.loads((study.results / "results.json").read_text())["rows"]]
        with_none = timed(study.batch)
        frozen_run = study.batch("--slurm", env={**os.environ, "PATH": "/nowhere"})
        assert "can't be started" in frozen_run.stderr
        frozen = next((study.results / "studies").iterdir())
        assert run([study.program, "batch", frozen, "--variant", "1"]).returncode == 0
        at = study.results / "variants" / keys[0]
        fill(study, keys, json.loads((at / "result.json").read_text()), at / "rail.k")
        with_all = timed(study.batch)
        assert with_all[0].returncode == 0, with_all[0].stderr
        again = timed(lambda: study.batch("--local"))
        peak = run(["/usr/bin/time", "-f", "%M", study.program, "batch", study.plan]).stderr.split()
        found[count] = {
            "without_results": {"wall_s": with_none[1], "cpu_s": with_none[2]},
            "with_all": {"wall_s": with_all[1], "cpu_s": with_all[2]},
            "local_with_nothing_left": {"wall_s": again[1], "cpu_s": again[2]},
            "bytes": {name: (study.results / name).stat().st_size for name in ("results.html", "results.csv", "results.json")},
            "result_bytes": (at / "result.json").stat().st_size,
            "deck_bytes": (at / "rail.k").stat().st_size,
            "peak_mb": int(peak[-1]) / 1024 if peak and peak[-1].isdigit() else None,
        }
        print(f"tables {count}: {found[count]}", file=sys.stderr, flush=True)
        shutil.rmtree(study.folder)
        count *= 10
    return found


def worker_costs(programs, folder):
    """Of a process whose variant has a result: everything but the work."""
    found = {}
    for how in ("sobol", "latin-hypercube"):
        found[how] = {}
        for count in (1000, 10_000, 100_000, 1_000_000):
            study = small_study(programs, folder / f"worker-{how}-{count}", how, count)
            frozen_folder = study.results / "studies"
            frozen_folder.mkdir(parents=True)
            # the study of a small plan, with the number of samples changed: freezing a large one needs no table
            small = StudyFolder(programs, folder / f"seed-{how}-{count}", study.plan.read_text().split("\n", 3)[3].replace(f"samples = {count}", "samples = 1"))
            small.batch("--slurm", env={**os.environ, "PATH": "/nowhere"})
            text = next((small.results / "studies").iterdir()).read_text()
            frozen = small.results / "studies" / "large.json"
            frozen.write_text(text.replace("samples = 1\\n", f"samples = {count}\\n"))
            command = [small.program, "batch", frozen, "--variant", str(count)]
            first = run(command)
            assert first.returncode == 0, first.stderr
            runs = 10
            _, wall, cpu = timed(lambda: [run(command) for _ in range(runs)])
            found[how][count] = {"wall_s": wall / runs, "cpu_s": cpu / runs}
    return found


def variant_costs(programs, folder):
    found = {}
    for name, elements, variants, more in (("small", 5000, 40, ""), ("large", 1_000_000, 2, 'repair = "none"\n')):
        study = small_study(programs, folder / f"variant-{name}", "latin-hypercube", variants, elements, more)
        study.batch()  # reads everything once
        _, _, nothing = timed(study.batch)
        _, wall, cpu = timed(lambda: study.batch("--local", "--jobs", "1"))
        rows = study.table()
        assert [row["state"] for row in rows] == ["done"] * variants
        found[name] = {"shells": elements, "variants": variants, "cpu_s": (cpu - nothing) / variants, "wall_s": wall / variants, "result_mb": study.deck.stat().st_size / 1e6,
                       "peak_mb": max(float(row["peak_mb"]) for row in rows)}
        shutil.rmtree(study.folder)
    return found


def rate_costs(programs, folder):
    found = {}
    for jobs in (1, 2):
        study = small_study(programs, folder / f"rate{jobs}", "latin-hypercube", 60, 5000)
        study.batch()  # reads everything once
        _, wall, cpu = timed(lambda: study.batch("--local", "--jobs", str(jobs)))
        faults = study.faults(60)
        assert not faults, faults
        found[jobs] = {"variants": 60, "wall_s": wall, "cpu_s": cpu, "a_minute": 60 * 60 / wall, "a_minute_of_a_core": 60 * 60 / cpu}
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--parts", default="slurm,files,tables,worker,variant,rate")
    parser.add_argument("--most", type=int, default=100_000, help="results in one folder")
    options = parser.parse_args()
    programs = options.programs.resolve()
    costs = {"date": time.strftime("%Y-%m-%d"), "cores": os.cpu_count(), "load": os.getloadavg()[0]}
    with tempfile.TemporaryDirectory(prefix="costs-") as folder:
        folder = pathlib.Path(folder)
        parts = {"slurm": lambda: slurm_costs(folder), "files": lambda: file_costs(folder, options.most), "tables": lambda: tables_costs(programs, folder, options.most),
                 "worker": lambda: worker_costs(programs, folder),
                 "variant": lambda: variant_costs(programs, folder), "rate": lambda: rate_costs(programs, folder)}
        for part in options.parts.split(","):
            costs[part] = parts[part]()
            print(f"{part}: {json.dumps(costs[part])}", file=sys.stderr, flush=True)
    print(json.dumps(costs, indent=1))


if __name__ == "__main__":
    main()
