"""Runs tests: first which mutants each reaches, then each mutant against those that reach it."""
import os
import re
import shutil
import subprocess
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

MEMORY_KB = 4 << 20  # a mutant may allocate memory without end
FILE_BLOCKS = 4 << 20  # of 512 bytes, and write without end
BATCH_SECONDS = 0.5
BATCH_TESTS = 100
# A test's time limit in a mutant: its own time with everything that may disturb it.
TIMES = 5
MORE_SECONDS = 10


@dataclass
class Test:
    program: str
    name: str
    seconds: float = 0
    reached: set = field(default_factory=set)


def can_be_alone():
    """Whether programs can be started in a process space of their own, so that nothing that a mutant starts outlives it."""
    return subprocess.run(["unshare", "--pid", "--fork", "--kill-child", "--mount-proc", "true"], capture_output=True).returncode == 0


class Runner:
    def __init__(self, programs_folder, jobs):
        self.folder, self.jobs = programs_folder, jobs
        self.alone = ["unshare", "--pid", "--fork", "--kill-child", "--mount-proc"] if can_be_alone() else []

    def start(self, program, tests, environment, limit):
        """None where they pass; else what happened."""
        first = tests[0] + (" .." if len(tests) > 1 else "")
        scratch = tempfile.mkdtemp(prefix="prismesh-mutant-")
        limits = f"ulimit -c 0; ulimit -d {MEMORY_KB}; ulimit -f {FILE_BLOCKS}; \"$@\"; exit $?"
        flags = os.path.join(scratch, "flags")
        with open(flags, "w", encoding="utf-8") as file:
            file.write("--gtest_filter=" + ":".join(tests) + "\n--gtest_fail_fast\n--gtest_brief=1\n")
        own = os.path.join(scratch, "tmp")
        os.mkdir(own)
        for folder, mode in ((scratch, 0o755), (own, 0o1777)):  # some tests go on as another user
            os.chmod(folder, mode)
        process = subprocess.Popen(
            [*self.alone, "sh", "-c", limits, "sh", os.path.join(self.folder, program), f"--gtest_flagfile={flags}"],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", cwd=own,
            env={**os.environ, "TMPDIR": own, **environment}, start_new_session=True)
        try:
            output, _ = process.communicate(timeout=limit)
            if process.returncode == 0:
                return None
            failed = re.search(r"^\[  FAILED  \] (\S+) \(", output, re.M)
            return failed.group(1) if failed else f"{first} (ended with status {process.returncode})"
        except subprocess.TimeoutExpired:
            return f"{first} (still running after {limit:.0f} s)"
        finally:
            try:
                os.killpg(process.pid, 9)
            except ProcessLookupError:
                pass
            process.communicate()
            shutil.rmtree(scratch, ignore_errors=True)

    def list_tests(self, program):
        listed = subprocess.run([os.path.join(self.folder, program), "--gtest_list_tests"], capture_output=True, text=True)
        tests, suite = [], ""
        for line in listed.stdout.splitlines():
            name = line.split("#")[0].rstrip()
            if not line.startswith(" "):
                suite = name
            elif "DISABLED_" not in suite + name:
                tests.append(Test(program, suite + name.strip()))
        return tests

    def record(self, program, mutants, slow, say):
        """The program's tests with their time and the mutants they reach. Those that fail or are slow without a mutant are left out."""

        def one(test):
            with tempfile.NamedTemporaryFile(prefix="prismesh-reached-") as reached:
                reached.write(bytes(mutants + 1))
                reached.flush()
                os.chmod(reached.name, 0o666)
                began = time.monotonic()
                problem = self.start(program, [test.name], {"PRISMESH_MUTANTS_REACHED": reached.name}, slow)
                test.seconds = time.monotonic() - began
                reached.seek(0)
                test.reached = {number for number, byte in enumerate(reached.read()) if byte}
            return test, problem

        kept, too_slow = [], []
        with ThreadPoolExecutor(self.jobs) as pool:
            for test, problem in pool.map(one, self.list_tests(program)):
                if not problem:
                    kept.append(test)
                elif test.seconds >= slow:
                    too_slow.append(test.name)
                else:
                    say(f"left out: {program}: {problem} without any mutant")
        if too_slow:
            say(f"left out: {program}: longer than {slow:g} s: {', '.join(too_slow)}")
        return kept

    def judge(self, number, tests, end=None):
        """What caught the mutant; "" where all tests pass; None where the time was over before. The quickest tests run first."""
        for batch in batches(sorted(tests, key=lambda test: test.seconds)):
            if end and time.monotonic() > end:
                return None
            limit = TIMES * sum(test.seconds for test in batch) + MORE_SECONDS
            problem = self.start(batch[0].program, [test.name for test in batch], {"PRISMESH_MUTANT": str(number)}, limit)
            if problem:
                return problem
        return ""


def batches(tests):
    """Quick tests of a program that follow each other run in one process."""
    batch = []
    for test in tests:
        full = batch and (batch[0].program != test.program or len(batch) >= BATCH_TESTS or sum(t.seconds for t in batch) > BATCH_SECONDS)
        if full:
            yield batch
            batch = []
        batch.append(test)
    if batch:
        yield batch
