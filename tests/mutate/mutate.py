#!/usr/bin/python3
"""./station mutate [MODULE.. | --diff [BASE] | --again LIST]: breaks the sources in small ways and tells which breaks no test notices.

MODULE is a folder (mesh/repair), a file or a file without its ending (base/file). --diff takes the lines that differ from BASE (default: main),
--again what slipped through in an earlier run. docs/testing.md says how to read the list.
"""
import argparse
import os
import random
import re
import sys
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
try:
    import clang.cindex  # noqa: F401
except ImportError:
    sys.exit("mutate needs the package python3-clang-14, which ./station mutate installs")

import places  # noqa: E402
import report  # noqa: E402
from copy_of_tree import Copy, Failed, run  # noqa: E402
from equivalent import read_equivalent  # noqa: E402
from running import Runner  # noqa: E402

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
# Test programs that judge what a folder's own haven't noticed.
ALSO = {"mesh/": "mesh_document_test"}
CHEAP_SECONDS = 1  # of a test that is run besides
KIOSK_TESTS = ("kiosk_test", "pictures_test", "optics_test", "losses_test", "phase_error_test", "station_test", "viewer_test")
MODULES = ("base/", "mesh/", "drivers/", "ipc/", "daemon/", "kiosk/", "cli/")


def arguments():
    parser = argparse.ArgumentParser(prog="station mutate", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("modules", nargs="*", metavar="MODULE")
    parser.add_argument("--diff", nargs="?", const="main", metavar="BASE", help="the lines that differ from BASE")
    parser.add_argument("--again", metavar="LIST", help="what slipped through in this list")
    parser.add_argument("--max", type=int, metavar="N", help="at most N mutants, chosen by chance")
    parser.add_argument("--seed", type=int, default=1, help="of the chance (default 1)")
    parser.add_argument("--tests", metavar="NAME,..", help="the test programs (default: those of the module's tests, and a few more)")
    parser.add_argument("--minutes", type=float, help="stop running mutants after so many minutes")
    parser.add_argument("--slow", type=float, default=5, metavar="SECONDS", help="leave out tests that take longer (default 5)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--out", default="out/mutate.txt", help="where the list goes besides (default out/mutate.txt)")
    options = parser.parse_args()
    if [bool(options.modules), bool(options.diff), bool(options.again)].count(True) != 1:
        parser.error("name either modules or --diff or --again")
    return options


class Output:
    """What is printed is also kept for a file."""

    def __init__(self):
        self.lines = []
        self.began = time.monotonic()

    def line(self, text):
        print(text, flush=True)
        self.lines.append(text)

    def save(self, path):
        path = os.path.join(ROOT, path)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(self.lines) + "\n")

    def step(self, text):
        self.line(f"[{time.monotonic() - self.began:5.0f} s] {text}")


# --- choice of mutants ---


def changed_lines(base):
    """The lines of the sources of the modules that differ from `base`: sets by file."""
    diff = run(["git", "diff", "--unified=0", "--no-color", "--no-ext-diff", base, "--", *MODULES], cwd=ROOT)
    if diff.returncode != 0:
        raise Failed(diff.stderr.strip())
    lines, file = {}, ""
    for line in diff.stdout.splitlines():
        if line.startswith("+++ "):
            file = line[6:] if line.startswith("+++ b/") else ""
        elif (hunk := re.match(r"@@ -\S+ \+(\d+)(?:,(\d+))? @@", line)) and re.search(r"\.(cpp|h)$", file):
            first, count = int(hunk.group(1)), int(hunk.group(2) or 1)
            lines.setdefault(file, set()).update(range(first, first + count))
    return {file: changed for file, changed in lines.items() if changed}


def files_of(module, files):
    """The sources of a module: a folder, a file, or a file without its ending."""
    module = module.rstrip("/")
    sources = [file for file in files if re.search(r"\.(cpp|h)$", file) and file.startswith(MODULES)]
    found = [file for file in sources if file.startswith(module + "/") or file == module or re.sub(r"\.(cpp|h)$", "", file) == module]
    if not found:
        raise Failed(f"there are no sources of a module {module}")
    return found


def find_mutants(wanted, copy, jobs):
    """All mutants of these files, by place."""
    commands = places.compile_commands(copy.configure_commands())
    by_name = {os.path.relpath(source, ROOT): source for source in commands}
    readers = {file for file in wanted if file in by_name}
    for header in wanted:
        # A header is read by its own source, or by whoever includes it.
        own = re.sub(r"\.h$", ".cpp", header)
        if header.endswith(".h") and own in by_name:
            readers.add(own)
        elif header.endswith(".h"):
            users = run(["git", "grep", "-l", f'#include "{header}"', "--", "*.cpp"], cwd=ROOT).stdout.split()
            readers.update([user for user in users if user in by_name][:1])
    found = {}
    with ProcessPoolExecutor(jobs) as pool:
        tasks = [pool.submit(places.places_in, by_name[name], commands[by_name[name]], ROOT, set(wanted)) for name in sorted(readers)]
        for task in tasks:
            for mutant in task.result():
                found.setdefault(mutant.key(), mutant)
    return sorted(found.values(), key=lambda m: (m.file, m.parts[0].start, m.parts[0].end, m.kind))


# --- test programs ---


def programs_for(files, test_programs):
    """The programs of the nearest folder of tests, and those that run afterwards on the mutants they didn't notice."""
    own, also = set(), set()
    for file in files:
        folder = os.path.dirname(file)
        while folder:
            near = [name for name, homes in test_programs.items() if any((home + "/").startswith(f"tests/{folder}/") for home in homes)]
            if near:
                own.update(near)
                break
            folder = os.path.dirname(folder)
        also.update(program for beginning, program in ALSO.items() if file.startswith(beginning) and program in test_programs)
    return sorted(own), sorted(also - own)


def judge(mutants, programs, slow, copy, options, output):
    """Builds the programs with these mutants, runs them, and gives each mutant its state."""
    copy.build_mutants(mutants, programs, output.step)
    output.step(f"built: {', '.join(programs)}")
    mutants = [mutant for mutant in mutants if mutant.state != "not compiled"]
    runner = Runner(copy.programs, options.jobs)
    tests = [test for program in programs for test in runner.record(program, len(mutants), slow, output.step)]
    output.step(f"{len(tests)} tests recorded, {sum(test.seconds for test in tests):.0f} s")
    reaching = {}
    for test in tests:
        for number in test.reached:
            reaching.setdefault(number, []).append(test)
    end = time.monotonic() + 60 * options.minutes if options.minutes else None

    def one(mutant):
        if mutant.number not in reaching:
            mutant.state = mutant.state or "not reached"
            return
        problem = runner.judge(mutant.number, reaching[mutant.number], end)
        if problem is not None:
            mutant.state = "caught" if problem else "slipped"

    # In random order, so that the mutants run before the time limit are a sample of all.
    order = random.Random(options.seed).sample(mutants, len(mutants))
    with ThreadPoolExecutor(options.jobs) as pool:
        for done, _ in enumerate(pool.map(one, order), 1):
            if done % 100 == 0:
                output.step(f"{done} of {len(mutants)} judged")


def choose(options, output, copy):
    """The mutants that are asked for, and how many there were to choose from."""
    again = report.read_slipped(options.again) if options.again else set()
    lines = changed_lines(options.diff) if options.diff else {}
    files = sorted({file for file, _, _ in again} | set(lines) | {file for module in options.modules for file in files_of(module, copy.files())})
    mutants = find_mutants(files, copy, options.jobs) if files else []
    if options.diff:
        mutants = [mutant for mutant in mutants if mutant.line in lines[mutant.file]]
    if options.again:
        mutants = [mutant for mutant in mutants if (mutant.file, mutant.before, mutant.after) in again]
    found = len(mutants)
    if options.max and found > options.max:
        chosen = set(random.Random(options.seed).sample(range(found), options.max))
        mutants = [mutant for i, mutant in enumerate(mutants) if i in chosen]
    output.step(f"{found} places in {len(files)} files, {len(mutants)} chosen (seed {options.seed})")
    return mutants, found


def main():
    options = arguments()
    output = Output()
    copy = Copy(ROOT, options.jobs)
    mutants, found = choose(options, output, copy)
    if not mutants:
        return
    files = {mutant.file for mutant in mutants}
    copy.write({})
    named = options.tests.split(",") if options.tests else []
    copy.configure(kiosk=any(file.startswith("kiosk/") for file in files) or any(name in KIOSK_TESTS for name in named))
    own, also = (named, []) if named else programs_for(files, copy.test_programs())
    if not own:
        raise Failed("there is no test program for this; name some with --tests")
    judge(mutants, own, options.slow, copy, options, output)
    # A header that is broken for all who include it would cost a build of nearly everything.
    rest = [mutant for mutant in mutants if mutant.state in ("slipped", "not reached") and mutant.file.endswith(".cpp")]
    if also and rest:
        output.step(f"{len(rest)} left for {', '.join(also)}")
        judge(rest, also, min(options.slow, CHEAP_SECONDS), copy, options, output)
    is_equivalent = read_equivalent(os.path.join(ROOT, "tests/mutate/equivalent.txt"))
    for mutant in mutants:
        if mutant.state == "slipped" and is_equivalent(mutant):
            mutant.state = "no change of behaviour"
    for line in report.listed(mutants):
        output.line(line)
    output.step(report.counts(mutants, found - len(mutants)))
    output.save(options.out)


if __name__ == "__main__":
    try:
        main()
    except Failed as problem:
        sys.exit(f"station: {problem}")
    except KeyboardInterrupt:
        sys.exit(130)
