#!/usr/bin/env python3
"""Variants a minute of `prismesh batch --local` by the number of workers, and time and memory of one worker on a large deck.

    batch_rate.py PROGRAMS [--runs 3] [--elements 5000] [--variants 40] [--large 1000000]
"""
import argparse
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "batch"))
from study_folder import StudyFolder  # noqa: E402

parser = argparse.ArgumentParser()
parser.add_argument("programs", type=pathlib.Path)
parser.add_argument("--runs", type=int, default=3)
parser.add_argument("--elements", type=int, default=5000)
parser.add_argument("--variants", type=int, default=40)
parser.add_argument("--large", type=int, default=1_000_000)
options = parser.parse_args()
programs = options.programs.resolve()


def study(folder, variants, pictures, elements, more=""):
    return StudyFolder(
        programs, folder, f'plan = "latin-hypercube"\nsamples = {variants}\npictures = {str(pictures).lower()}\n{more}[parameters]\nheight = {{from = 2, to = 6}}\n', elements=elements
    )


with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    cores = len(os.sched_getaffinity(0))
    print(f"{options.elements} shells, {options.variants} variants, median of {options.runs} runs, {cores} cores; variants a minute:")
    print("| workers | without pictures | with pictures |\n|---|---|---|")
    for jobs in sorted({1, 2, *(2**i for i in range(1, 10) if 2**i <= cores), cores}):
        rates = []
        for pictures in (False, True):
            times = []
            for run in range(options.runs):
                each = study(folder / "small", options.variants, pictures, options.elements)
                shutil.rmtree(each.results, ignore_errors=True)
                begun = time.monotonic()
                subprocess.run([each.program, "batch", each.plan, "--local", "--jobs", str(jobs)], check=True, capture_output=True)
                times.append(time.monotonic() - begun)
            rates.append(options.variants * 60 / statistics.median(times))
        print(f"| {jobs} | {rates[0]:.0f} | {rates[1]:.0f} |", flush=True)
    if options.large:
        print("| one worker on a large deck | seconds | MB |\n|---|---|---|")
        for words, more in (("open, edit, measure, write", "penetrations = false\n"), ("and the search of contacts before and after", "")):
            each = study(folder / "large", options.runs, False, options.large, 'repair = "none"\n' + more)
            shutil.rmtree(each.results, ignore_errors=True)
            subprocess.run([each.program, "batch", each.plan, "--local", "--jobs", "1"], check=True, capture_output=True)
            rows = each.table()
            print(f"| {words} | {statistics.median(float(row['seconds']) for row in rows):.2f} | {max(float(row['peak_mb']) for row in rows):.0f} |", flush=True)
