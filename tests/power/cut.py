#!/usr/bin/env python3
"""Pulls the plug of a machine that edits and takes models, and looks at what is left: the real prismesh-modeld and prismesh-intake on a real ext4,
under user-mode Linux. Then it records what such a machine writes, and looks at what a disk with a write cache may hold after a cut. Skipped,
aloud, without user-mode Linux.

    cut.py PROGRAMS [--cuts N] [--images N] [--seed S] [--jobs N]     PROGRAMS: the folder of the built programs
"""
import argparse
import concurrent.futures
import os
import sys

sys.dont_write_bytecode = True
import machine  # noqa: E402
import session  # noqa: E402

CUTS_FOR_EACH_DISK = 10  # then a new one, so that checking what is there doesn't outgrow the work
IMAGES_OF_EACH_RECORD = 250


def all_of(count, size, jobs, work):
    """Calls work(number, size of its share) for shares of at most this size. Prints what is wrong; returns the results and the number of failures."""
    shares = [min(size, count - begin) for begin in range(0, count, size)]
    results, failed = [], 0
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for *result, wrong in pool.map(work, range(len(shares)), shares):
            results.append(result)
            if wrong:
                failed += 1
                print("FAILED: " + "\n    ".join(wrong), flush=True)
    return results, failed


def cuts(given):
    results, failed = all_of(given.cuts, CUTS_FOR_EACH_DISK, given.jobs, lambda number, count: session.cut_one_disk(given.programs, given.seed + number, count))
    edits, models = (sum(acknowledged[who] for acknowledged, in results) for who in ("editor", "sender"))
    print(f"{given.cuts} power cuts on {len(results)} disks: {edits} acknowledged edits and saves, {models} acknowledged publications and removals"
          + (f"; {failed} disks FAILED" if failed else ", all there, and nothing else"), flush=True)
    return failed


def write_caches(given):
    results, failed = all_of(given.images, IMAGES_OF_EACH_RECORD, given.jobs,
                             lambda number, count: session.try_write_cache(given.programs, given.seed + number, count))
    images, flushes = (sum(result[which] for result in results) for which in (0, 1))
    print(f"{images} states of a disk with a write cache, between {flushes} flushes of {len(results)} sessions"
          + (f"; {failed} sessions FAILED" if failed else ": all that was acknowledged is there, and nothing else"), flush=True)
    return failed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs")
    parser.add_argument("--cuts", type=int, default=10)
    parser.add_argument("--images", type=int, default=20, help="states of a disk with a write cache")
    parser.add_argument("--seed", type=int, default=int(os.environ.get("PRISMESH_SEED", "1")))
    parser.add_argument("--jobs", type=int, default=1, help="machines at a time")
    given = parser.parse_args()
    missing = machine.missing()
    if missing:
        print(f"SKIPPED: no power is cut: {missing} isn't installed")
        return 77
    machine.end_with_this_program()
    failed = (cuts(given) if given.cuts else 0) + (write_caches(given) if given.images else 0)
    return 1 if failed else 0


sys.exit(main())
