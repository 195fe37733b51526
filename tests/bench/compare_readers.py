#!/usr/bin/env python3
"""How long Prismesh and python3-meshio take to read the same deck (Nastran or Abaqus), in turns, in one run.

    PRISMESH_BENCH_TWINS=. build/bin/deck_bench --benchmark_filter=twin     # writes decks to compare with
    tests/bench/compare_readers.py twin.bdf [--bench PATH] [--python PATH] [--times 3]

Each reading is a process of its own, and only the reading counts, not its start: deck_bench's opening, up to the complete model with
adjacency, and meshio.read. Prints the medians of wall clock and processor time and their ratios. Status 77: meshio is missing.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys

READ = """
import json, sys, time, meshio
wall, cpu = time.perf_counter(), time.process_time()
mesh = meshio.read(sys.argv[1], "abaqus" if sys.argv[1].endswith(".inp") else "nastran")
wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
print(json.dumps([wall, cpu, sum(len(block.data) for block in mesh.cells)]))
"""


def printed_by(command, **environment):
    done = subprocess.run(command, capture_output=True, text=True, env=os.environ | environment)
    if done.returncode != 0:
        sys.exit(f"{command[0]} failed with status {done.returncode}: {done.stderr.strip()[-500:]}")
    return done.stdout


def read_with_prismesh(options):
    """Wall clock and processor time in seconds, and how many elements there are."""
    command = [options.bench, "--benchmark_filter=open_a_million", "--benchmark_min_time=0.01", "--benchmark_format=json"]
    result = json.loads(printed_by(command, PRISMESH_BENCH_DECK=options.deck))["benchmarks"][0]
    if result.get("error_occurred"):
        sys.exit(f"{options.deck}: {result['error_message']}")
    return result["4complete"] / 1e3, result["4complete_cpu"] / 1e3, int(result["shells"])


def read_with_meshio(options):
    # The last line: meshio warns on standard output as well.
    return json.loads(printed_by([options.python, "-c", READ, options.deck]).splitlines()[-1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("deck")
    parser.add_argument("--bench", default="build/bin/deck_bench")
    parser.add_argument("--python", default="/usr/bin/python3", help="the interpreter that has meshio")
    parser.add_argument("--times", type=int, default=3)
    options = parser.parse_args()
    if not os.access(options.bench, os.X_OK):
        sys.exit(f"{options.bench}: isn't built; name the program with --bench")
    found = subprocess.run([options.python, "-c", "import meshio; print(meshio.__version__)"], capture_output=True, text=True)
    if found.returncode != 0:
        print(f"{options.python} has no meshio, so NOTHING IS COMPARED (Debian: apt-get install python3-meshio)")
        return 77

    readers = {"prismesh": read_with_prismesh, f"meshio {found.stdout.strip()}": read_with_meshio}
    taken = {name: [] for name in readers}
    for turn in range(options.times):
        for name, read in readers.items():
            taken[name].append(read(options))
            wall, cpu, elements = taken[name][-1]
            print(f"{turn + 1}: {name}: {wall:.3f} s, {cpu:.3f} s of processor time, {elements} elements", flush=True)
    wall, cpu = ([statistics.median(one[which] for one in times) for times in taken.values()] for which in (0, 1))
    for i, name in enumerate(readers):
        print(f"median: {name}: {wall[i]:.3f} s, {cpu[i]:.3f} s of processor time")
    print(f"ratio: {wall[1] / wall[0]:.1f} by the clock, {cpu[1] / cpu[0]:.1f} by processor time")
    return 0


if __name__ == "__main__":
    sys.exit(main())
