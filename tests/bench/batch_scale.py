#!/usr/bin/env python3
"""A simulation of `prismesh batch --slurm` on many nodes: which part bends first, and at how many variants.

    batch_scale.py [--costs batch_costs.json] [--table] [--svg docs/performance/batch_scale.svg]

It knows four things that are shared: the scheduler, which starts tasks one after the other; the file system's metadata and its bandwidth, each a queue
that serves one request after the other; and the reconciler, one process that reads all results and writes the tables. Between them are the workers,
each of which works one variant after the other of its task's share, as cli/batch.cpp gives them out: variant v belongs to task v mod tasks.
A worker may die; what then has no result is submitted again, as often as needed. Costs were measured by batch_costs.py, or are cited in docs/batch.md.
"""
import argparse
import heapq
import html
import json
import math
import pathlib
import random
from dataclasses import dataclass, field, replace

HERE = pathlib.Path(__file__).parent


@dataclass(frozen=True)
class Study:
    variants: int
    work_s: float  # of one variant, on a core
    spread: float = 0  # of the work, relative: uniform within ± spread
    result_mb: float = 0  # written for a variant
    death: float = 0  # the chance that a worker dies in a variant


@dataclass(frozen=True)
class Cluster:
    nodes: int
    cores: int  # of a node that a task uses
    tasks: int  # of the array, at most
    start_s: float = 0  # the scheduler's for each task
    submit_s: float = 0  # until the first task may start
    process_s: float = 0  # of a worker before it works: starting, reading the study
    sampling_s: float = 0  # and for each variant that the study has
    write_operations: float = 0  # of the file system's metadata, for each result
    metadata_s: float = 0  # for each of these
    mb_s: float = math.inf  # bandwidth of writing
    read_operations: float = 0  # of the reconciler for each result
    read_s: float = 0  # for each of these
    readers: int = 1  # at the same time
    reconcile_s: float = 0  # of its processor for each variant
    table_mb: float = 0  # its memory for each variant


@dataclass
class Outcome:
    variants: int
    ideal_s: float
    work_s: float = 0  # until the last result is there
    tables_s: float = 0  # until the tables are written
    busy_core_s: float = 0
    metadata_busy_s: float = 0
    bandwidth_busy_s: float = 0
    scheduler_busy_s: float = 0
    reconciler_s: float = 0
    memory_mb: float = 0
    rounds: int = 0
    killed: int = 0
    results: dict = field(default_factory=dict)  # variant → how often accepted

    @property
    def efficiency(self):
        return self.ideal_s / self.tables_s


def ideal(study, cluster):
    """With nothing but the work, on all cores."""
    return math.ceil(study.variants / (cluster.nodes * cluster.cores)) * study.work_s


def simulate(study, cluster, seed=1, keep_results=True):
    random_ = random.Random(seed)
    outcome = Outcome(study.variants, ideal(study, cluster))
    clock = 0.0
    metadata_free = bandwidth_free = 0.0
    left = range(study.variants)
    tasks = min(cluster.tasks, study.variants)
    before_work = cluster.process_s + cluster.sampling_s * study.variants
    while len(left):
        outcome.rounds += 1
        shares = {}
        for variant in left:
            shares.setdefault(variant % tasks, []).append(variant)
        queue = sorted(shares)  # tasks that wait for a node, the next one last
        queue.reverse()
        scheduler_free = clock + cluster.submit_s
        free_nodes = [clock] * cluster.nodes  # when each is free
        heapq.heapify(free_nodes)
        events = []  # (when, tie, task): a worker has finished its work
        running = {}  # task → [its share, the next of it, its workers that work]
        missing = []
        tie = 0

        def begin_task(free_at):
            nonlocal scheduler_free, tie
            task = queue.pop()
            scheduler_free = max(scheduler_free, free_at) + cluster.start_s
            outcome.scheduler_busy_s += cluster.start_s
            share = shares[task]
            workers = min(cluster.cores, len(share))
            running[task] = [share, 0, workers]
            for _ in range(workers):
                begin_variant(task, scheduler_free)

        def begin_variant(task, now):
            nonlocal tie
            state = running[task]
            variant = state[0][state[1]]
            state[1] += 1
            seconds = before_work + study.work_s * (1 + study.spread * (2 * random_.random() - 1))
            dies = study.death > 0 and random_.random() < study.death
            if dies:
                seconds *= random_.random()
            outcome.busy_core_s += seconds
            tie += 1
            heapq.heappush(events, (now + seconds, tie, task, variant, dies))

        while queue and free_nodes:
            begin_task(heapq.heappop(free_nodes))
        last = clock
        while events:
            now, _, task, variant, dies = heapq.heappop(events)
            if dies:
                missing.append(variant)
                outcome.killed += 1
            else:
                serve = cluster.write_operations * cluster.metadata_s
                metadata_free = max(metadata_free, now) + serve
                bandwidth_free = max(bandwidth_free, now) + study.result_mb / cluster.mb_s
                outcome.metadata_busy_s += serve
                outcome.bandwidth_busy_s += study.result_mb / cluster.mb_s
                done = max(metadata_free, bandwidth_free)
                outcome.busy_core_s += done - now  # the worker waits on its core
                now = done
                if keep_results:
                    outcome.results[variant] = outcome.results.get(variant, 0) + 1
            last = max(last, now)
            state = running[task]
            if state[1] < len(state[0]):
                begin_variant(task, now)
                continue
            state[2] -= 1
            if state[2] == 0:
                del running[task]
                heapq.heappush(free_nodes, now)
                if queue:
                    begin_task(heapq.heappop(free_nodes))
        left = sorted(missing)
        outcome.work_s = last
        # the tables are made after each round, and the next submission reads all results once more to see what is missing
        reading = study.variants * (cluster.read_operations * cluster.read_s / cluster.readers + cluster.reconcile_s)
        outcome.reconciler_s += reading
        clock = last + reading
        outcome.tables_s = clock
        if len(left):
            outcome.reconciler_s += reading
            clock += reading
    outcome.memory_mb = study.variants * cluster.table_mb
    return outcome


# --- the scenarios of docs/batch.md ---

CORES = 32
# Cited in docs/batch.md: Slurm's High Throughput Computing Administration Guide; mdtest and IOzone of Dell's Lustre storage with Infiniband EDR.
SLURM_TASKS_S = 500
LUSTRE_CREATES_S = 29_000
LUSTRE_STATS_S = 2_000  # of one process, one after the other
LUSTRE_MB_S = 15_100
WRITE_OPERATIONS = 8  # of a result, counted by strace: mkdir, two files, two changes of mode, three renames
READ_OPERATIONS = 4  # two stats, an open, a stat of the deck
READERS = 16  # mesh/batch/read_many.cpp
COUNTS = (1_000, 10_000, 100_000, 1_000_000)
DECKS = {"5,000 shells": "small", "1,000,000 shells": "large", "60 s a variant": "long"}


def cluster_of(costs, **more):
    sobol, latin = costs["worker"]["sobol"]["1000000"]["cpu_s"], costs["worker"]["latin-hypercube"]["1000000"]["cpu_s"]
    most = max(costs["tables"], key=int)
    tables = costs["tables"][most]
    return replace(Cluster(
        nodes=1000, cores=CORES, tasks=1000, start_s=1 / SLURM_TASKS_S, submit_s=costs["slurm"]["submit_array"]["1000"]["wall_s"], process_s=sobol, sampling_s=max(0, latin - sobol) / 1_000_000,
        write_operations=WRITE_OPERATIONS, metadata_s=1 / LUSTRE_CREATES_S, mb_s=LUSTRE_MB_S, read_operations=READ_OPERATIONS, read_s=1 / LUSTRE_STATS_S, readers=READERS,
        reconcile_s=tables["with_all"]["cpu_s"] / int(most), table_mb=tables["peak_mb"] / int(most)), **more)


def study_of(costs, deck, variants):
    if deck == "long":  # not measured: a repair of many shells, a tenth of the large deck's bytes
        return Study(variants, 60, 0.2, costs["variant"]["large"]["result_mb"] / 10)
    figures = costs["variant"][deck]
    return Study(variants, figures["cpu_s"], 0.2, figures["result_mb"])


def rows_of(costs, counts=COUNTS):
    """(deck, variants, outcome, its causes, outcome with one core a task)"""
    for words, deck in DECKS.items():
        for variants in counts:
            study, cluster = study_of(costs, deck, variants), cluster_of(costs)
            yield words, variants, simulate(study, cluster, keep_results=False), alone_of(study, cluster), simulate(study, replace(cluster, cores=1), keep_results=False)


def alone_of(study, cluster):
    """Seconds that each shared part needs at least, whatever the others do; the largest is what the study waits for."""
    return {
        "scheduler": min(cluster.tasks, study.variants) * cluster.start_s,
        "metadata": study.variants * cluster.write_operations * cluster.metadata_s,
        "bandwidth": study.variants * study.result_mb / cluster.mb_s,
        "sampling": math.ceil(study.variants / (cluster.nodes * cluster.cores)) * cluster.sampling_s * study.variants,
        "reconciler": study.variants * (cluster.read_operations * cluster.read_s / cluster.readers + cluster.reconcile_s),
        "work": ideal(study, cluster),
    }


COLOURS = {"work": "#1e8449", "scheduler": "#2c3e50", "metadata": "#8e44ad", "bandwidth": "#c0392b", "sampling": "#b9770e", "reconciler": "#1b6ca8"}


def words_of(seconds):
    if seconds < 120:
        return f"{seconds:.2g} s" if seconds < 10 else f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 2 * 3600 else f"{seconds / 3600:.1f} h"


def table(costs, counts=COUNTS):
    out = ["| deck | variants | work alone | results are there | tables are there | longest shared part | tables, one core a task |", "|---|---|---|---|---|---|---|"]
    for deck, variants, outcome, alone, single in rows_of(costs, counts):
        shared = {name: seconds for name, seconds in alone.items() if name != "work"}
        longest = max(shared, key=shared.get)
        out.append(f"| {deck} | {variants:,} | {words_of(outcome.ideal_s)} | {words_of(outcome.work_s)} | {words_of(outcome.tables_s)} | "
                   f"{longest}, {words_of(shared[longest])} | {words_of(single.tables_s)} |")
    return "\n".join(out)


def fed(costs):
    """How many cores can work before a shared part takes as long as the work, at a million variants."""
    out = ["| shared part | a million variants | " + " | ".join(DECKS) + " |", "|---|---|" + "---|" * len(DECKS)]
    rows = []
    for name in ("reconciler", "bandwidth", "metadata"):
        cells, lasts = [], []
        for deck in DECKS.values():
            study = study_of(costs, deck, 1_000_000)
            seconds = alone_of(study, cluster_of(costs))[name]
            lasts.append(seconds)
            cells.append(f"{float(f'{study.work_s * study.variants / seconds:.2g}'):,.0f} cores")
        rows.append(f"| {name} | {words_of(min(lasts))}{' to ' + words_of(max(lasts)) if max(lasts) > min(lasts) else ''} | " + " | ".join(cells) + " |")
    return "\n".join(out + rows)


def curves(costs, deck="small", counts=COUNTS):
    """Seconds of each part alone, and of all together, against the variants, both logarithmic."""
    lines = {}
    for count in (10 ** (3 + step / 4) for step in range(13)):
        study, cluster = study_of(costs, deck, round(count)), cluster_of(costs)
        for name, seconds in alone_of(study, cluster).items():
            lines.setdefault(name, []).append((count, seconds))
    lines["all together"] = [(count, simulate(study_of(costs, deck, count), cluster_of(costs), keep_results=False).tables_s) for count in counts]
    low = math.floor(math.log10(min(seconds for points in lines.values() for _, seconds in points if seconds > 1e-3)))
    high = math.ceil(math.log10(max(seconds for points in lines.values() for _, seconds in points)))
    x = lambda value: 80 + (math.log10(value) - 3) / 3 * 540  # noqa: E731
    y = lambda value: 380 - (math.log10(max(value, 10**low)) - low) / (high - low) * 350  # noqa: E731
    out = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 760 440" font-family="sans-serif" font-size="13">', '<rect width="760" height="440" fill="#ffffff"/>']
    for decade in range(3, 7):
        out.append(f'<path d="M{x(10**decade):.1f} 30V380" stroke="#dddddd"/><text x="{x(10**decade):.1f}" y="398" text-anchor="middle">{10**decade:,}</text>')
    for decade in range(low, high + 1):
        words = f"{10**decade:,}" if decade >= 0 else f"{10.0**decade:g}"
        out.append(f'<path d="M80 {y(10.0**decade):.1f}H620" stroke="#dddddd"/><text x="74" y="{y(10.0**decade) + 4:.1f}" text-anchor="end">{words}</text>')
    out.append('<text x="350" y="425" text-anchor="middle">variants</text><text x="18" y="205" text-anchor="middle" transform="rotate(-90 18 205)">seconds</text>')
    ends = []
    for name, points in lines.items():
        points = [(count, seconds) for count, seconds in points if seconds >= 10.0**low]
        if len(points) < 2:
            continue
        colour, width = COLOURS.get(name, "#d81b60"), 3 if name == "all together" else 2
        out.append(f'<path d="M{"L".join(f"{x(count):.1f} {y(seconds):.1f}" for count, seconds in points)}" fill="none" stroke="{colour}" stroke-width="{width}"/>')
        ends.append([y(points[-1][1]), name, colour])
    ends.sort()
    for before, after in zip(ends, ends[1:]):  # names keep apart
        after[0] = max(after[0], before[0] + 16)
    out += [f'<text x="632" y="{at + 4:.1f}" fill="{colour}">{html.escape(name)}</text>' for at, name, colour in ends]
    return "\n".join(out + ["</svg>"]) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--costs", type=pathlib.Path, default=HERE / "batch_costs.json")
    parser.add_argument("--svg", type=pathlib.Path)
    parser.add_argument("--table", action="store_true")
    options = parser.parse_args()
    costs = json.loads(options.costs.read_text())
    if options.table or not options.svg:
        print(table(costs) + "\n\n" + fed(costs))
        again = simulate(replace(study_of(costs, "small", 1_000_000), death=0.001), cluster_of(costs), keep_results=False)
        print(f"\nwith a death in 1,000: {again.rounds} submissions, {words_of(again.tables_s)}, {again.killed} deaths; memory {again.memory_mb / 1000:.1f} GB")
    if options.svg:
        options.svg.write_text(curves(costs))


if __name__ == "__main__":
    main()
