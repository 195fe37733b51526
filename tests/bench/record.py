#!/usr/bin/env python3
"""Measures what users wait for, at several sizes of the model and of the change, appends the figures with machine and commit to a file, and draws the file as curves.

    tests/bench/record.py [--programs build/bin] [--records docs/performance/records.jsonl] [--sizes 10000,100000,1000000,5000000]
                          [--changes 100,1000,10000,100000] [--no-curves]

`./station bench --record` builds what it needs and runs it. Processor time is compared over time, since it depends less on what else the
machine does; the load that it had is noted.
"""
import argparse
import datetime
import html
import json
import math
import os
import pathlib
import platform
import statistics
import subprocess
import sys
import tempfile
import time

# What users wait for: (row, benchmark program, its filter, what a figure is divided by, goal in milliseconds of wall time or None).
ROWS = [
    ("read LS-DYNA, 1M shells", "deck_bench", "open_a_million", None, None),
    ("read Nastran, 1M shells", "deck_bench", "open_a_twin/nastran", None, 600),
    ("read Radioss, 1M shells", "deck_bench", "open_a_twin/radioss", None, 600),
    ("read Abaqus, 1M shells", "deck_bench", "open_a_twin/abaqus", None, 600),
    ("save in place, 1M shells, 10,000 nodes moved", "saving_bench", "save_in_place", None, 250),
    ("copy and flush the same file", "saving_bench", "copy_and_flush", None, None),
    ("edit of 586 nodes, 1,000 others selected", "document_bench", "translate_586_beside_a_selection/1000$", None, 5),
    ("edit of 586 nodes, 100,000 others selected", "document_bench", "translate_586_beside_a_selection/100000$", None, 5),
    ("slide, 10,000 nodes, a step", "document_bench", "drag_step_10k/slide/", None, 1.5),
    ("translate, 10,000 nodes, a step", "document_bench", "drag_step_10k/translate/", None, None),
    ("repair, a damaged shell of 124", "repair_bench", "repair_bump/8/", "damaged", 5),
    ("repair, a damaged shell of 2,004", "repair_bench", "repair_bump/35/", "damaged", 5),
    ("relax 1M shells", "relax_bench", "relax_million", None, 6000),
]
OPENING = "open in prismesh-modeld with the first snapshot, 1M shells"
GOALS = {row[0]: row[4] for row in ROWS} | {OPENING: 1000}
PROGRAMS = sorted({row[1] for row in ROWS})
CURVES = ["open", "quality", "save", "lift", "drag_step", "relax", "undo"]  # of `prismesh bench`
CHANGE_CURVES = ["lift", "lift_beside", "drag_step", "slide_step", "relax", "undo"]  # of `prismesh bench`, in a model of a million shells
COLOURS = ["#1b6ca8", "#c0392b", "#1e8449", "#8e44ad", "#b9770e", "#2c3e50", "#d81b60"]
MILLISECONDS = {"ns": 1e-6, "us": 1e-3, "ms": 1, "s": 1e3}


def output_of(command):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{command[0]} failed with status {done.returncode}: {done.stderr.strip()[-500:]}")
    return done.stdout


def measure_row(programs, program, wanted, per):
    result = json.loads(output_of([programs / program, f"--benchmark_filter={wanted}", "--benchmark_min_time=1", "--benchmark_format=json"]))["benchmarks"]
    if not result or result[0].get("error_occurred"):
        sys.exit(f"{program} has no figure {wanted}: {result[0]['error_message'] if result else 'its filter finds none'}")
    factor = MILLISECONDS[result[0]["time_unit"]] / (result[0][per] if per else 1)
    return {"wall_ms": result[0]["real_time"] * factor, "cpu_ms": result[0]["cpu_time"] * factor}


def bench(programs, figures, *options):
    print("prismesh bench", *options, "..", file=sys.stderr, flush=True)
    return json.loads(output_of([programs / "prismesh", "bench", "--json", *options, "|".join(f"^{name}$" for name in figures)]))


def times_of(shown):
    return {f["name"]: {"wall_ms": f["median_ms"], "cpu_ms": f["cpu_ms"]} for f in shown["figures"] if f["runs"]}


def measure(programs, sizes, changes):
    record = {
        "date": datetime.date.today().isoformat(),
        "commit": output_of(["git", "rev-parse", "--short=12", "HEAD"]).strip(),
        "threads": os.cpu_count(),
        "load_before": os.getloadavg()[0],
        "rows": {},
        "sizes": {},
        "changes": {},
    }
    for size in sizes:
        shown = bench(programs, CURVES, "--elements", str(size))
        record["processor"] = shown["processor"] or platform.machine()
        record["sizes"][str(shown["shells"])] = times_of(shown)
    for change in changes:
        shown = bench(programs, CHANGE_CURVES, "--elements", "1000000", "--patch", str(change))
        record["changes"][str(shown["patch"]["nodes"])] = times_of(shown)
    for name, program, wanted, per, _ in ROWS:
        print(f"{name} ..", file=sys.stderr, flush=True)
        record["rows"][name] = measure_row(programs, program, wanted, per)
    print("prismesh-modeld ..", file=sys.stderr, flush=True)
    record["modeld_mb"], record["rows"][OPENING] = measure_modeld(programs)
    record["load_after"] = os.getloadavg()[0]
    return record


def resident_mb(process):
    with open(f"/proc/{process.pid}/status") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmRSS")) / 1024


def processor_seconds(process):
    with open(f"/proc/{process.pid}/stat") as stat:
        fields = stat.read().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def measure_modeld(programs):
    """With the sample of a million shells: its memory in megabytes, also after closing, and its time to open with the first snapshot (median of three)."""
    with tempfile.TemporaryDirectory(prefix="prismesh-memory-") as folder:
        folder = pathlib.Path(folder)
        (folder / "run").mkdir(mode=0o700)
        output_of([programs / "prismesh", "sample", "--elements", "1000000", "-o", folder / "million.k"])
        daemon = subprocess.Popen([programs / "prismesh-modeld", "--runtime-dir", folder / "run", "--state-dir", folder / "state"], stderr=subprocess.DEVNULL)
        try:
            while not (folder / "run" / "model.sock").exists() and daemon.poll() is None:
                time.sleep(0.05)
            session = lambda *words: output_of([programs / "prismesh", "session", *words, "--runtime-dir", folder / "run"])
            found = {"started": resident_mb(daemon)}
            opened = []
            for last in (False, False, True):
                wall, cpu = time.perf_counter(), processor_seconds(daemon)
                session("open", folder / "million.k")
                opened.append(((time.perf_counter() - wall) * 1e3, (processor_seconds(daemon) - cpu) * 1e3))
                if not last:
                    session("close")
            found["opened"] = resident_mb(daemon)
            session("edit", '{"edit":"translate","on":"5000001-5010000","by":[0,0,0.5],"falloff":{"profile":"constant"}}')
            session("save")
            found["saved"] = resident_mb(daemon)
            session("close")
            found["closed"] = resident_mb(daemon)
        finally:
            daemon.terminate()
            daemon.wait()
    wall, cpu = (statistics.median(each) for each in zip(*opened))
    return found, {"wall_ms": wall, "cpu_ms": cpu}


def number(value):
    return f"{value:,.0f}" if value >= 100 else f"{value:.3g}"


def table_of(record):
    lines = ["| work | wall ms | processor ms | goal, wall ms |", "|---|---|---|---|"]
    for name, figure in record["rows"].items():
        goal = GOALS.get(name)
        lines.append(f"| {name} | {number(figure['wall_ms'])} | {number(figure['cpu_ms'])} | {'' if goal is None else '≤ ' + number(goal)} |")
    memory = ", ".join(f"{number(value)} {when}" for when, value in record["modeld_mb"].items())
    return "\n".join(lines) + f"\n\nMemory of prismesh-modeld with a million shells, MB: {memory}"


class Axis:
    """Decades of a logarithmic axis."""

    def __init__(self, values, begin, end):
        self.low, self.high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
        self.high += self.high == self.low
        self.begin, self.end = begin, end

    def at(self, value):
        return self.begin + (math.log10(value) - self.low) / (self.high - self.low) * (self.end - self.begin)

    def ticks(self):
        return [10.0**decade for decade in range(self.low, self.high + 1)]


def tick_text(value):
    return f"{value:,.0f}" if value >= 1 else f"{value:g}"


def curves_of(times, names, below):
    """Processor time against a size, both logarithmic."""
    sizes = sorted((int(size), figures) for size, figures in times.items())
    lines = {name: [(size, figures[name]["cpu_ms"]) for size, figures in sizes if name in figures] for name in names}
    lines = {name: points for name, points in lines.items() if points}
    x = Axis([size for size, _ in sizes], 80, 620)
    y = Axis([max(value, 1e-3) for points in lines.values() for _, value in points], 380, 30)
    out = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 760 440" font-family="sans-serif" font-size="13">', '<rect width="760" height="440" fill="#ffffff"/>']
    for tick in x.ticks():
        out.append(f'<path d="M{x.at(tick):.1f} 30V380" stroke="#dddddd"/><text x="{x.at(tick):.1f}" y="398" text-anchor="middle">{tick_text(tick)}</text>')
    for tick in y.ticks():
        out.append(f'<path d="M80 {y.at(tick):.1f}H620" stroke="#dddddd"/><text x="74" y="{y.at(tick) + 4:.1f}" text-anchor="end">{tick_text(tick)}</text>')
    out.append(f'<text x="350" y="425" text-anchor="middle">{html.escape(below)}</text><text x="18" y="205" text-anchor="middle" transform="rotate(-90 18 205)">processor time, ms</text>')
    ends = []
    for (name, points), colour in zip(lines.items(), COLOURS):
        places = [(x.at(size), y.at(max(value, 1e-3))) for size, value in points]
        out.append(f'<path d="M{"L".join(f"{a:.1f} {b:.1f}" for a, b in places)}" fill="none" stroke="{colour}" stroke-width="2"/>')
        out += [f'<circle cx="{a:.1f}" cy="{b:.1f}" r="3.5" fill="{colour}"/>' for a, b in places]
        ends.append([places[-1][1], name, colour])
    ends.sort()
    for before, after in zip(ends, ends[1:]):  # names keep apart
        after[0] = max(after[0], before[0] + 16)
    out += [f'<text x="632" y="{at + 4:.1f}" fill="{colour}">{html.escape(name)}</text>' for at, name, colour in ends]
    return "\n".join(out + ["</svg>"]) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--programs", type=pathlib.Path, default=pathlib.Path("build/bin"))
    parser.add_argument("--records", type=pathlib.Path, default=pathlib.Path("docs/performance/records.jsonl"))
    parser.add_argument("--sizes", default="10000,100000,1000000,5000000")
    parser.add_argument("--changes", default="100,1000,10000,100000", help="about how many nodes move, in a model of a million shells")
    parser.add_argument("--no-curves", action="store_true", help="only append the figures")
    options = parser.parse_args()
    for program in ["prismesh", "prismesh-modeld", *PROGRAMS]:
        if not os.access(options.programs / program, os.X_OK):
            sys.exit(f"{options.programs / program}: isn't built; ./station bench --record builds it")
    record = measure(options.programs, *([int(size) for size in sizes.split(",")] for sizes in (options.sizes, options.changes)))
    options.records.parent.mkdir(parents=True, exist_ok=True)
    with open(options.records, "a") as records:
        records.write(json.dumps(record) + "\n")
    print(table_of(record))
    if not options.no_curves:
        (options.records.parent / "size.svg").write_text(curves_of(record["sizes"], CURVES, "shells"))
        (options.records.parent / "change.svg").write_text(curves_of(record["changes"], CHANGE_CURVES, "nodes that move, of a million"))
        print(f"\nappended to {options.records}; curves in size.svg and change.svg beside it")


if __name__ == "__main__":
    main()
