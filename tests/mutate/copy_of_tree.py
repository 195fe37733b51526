"""The copy of the tree that the mutants are built in: build/mutate/tree. Everything in it that isn't broken is compiled as in a release build, so
that the compiler's cache has it."""
import json
import os
import re
import shutil
import subprocess

from schemata import Schemata
from source_text import SourceText

MAX_ROUNDS = 8
# Lines keep their numbers.
HEAD = b'#include "tests/mutate/mutant.h"\n#line 1\n'


class Failed(Exception):
    """Says in a sentence what to do."""


def run(command, **options):
    return subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace", **options)


def write_if_other(path, data):
    """Leaves the time of what is the same already, so that nothing is compiled for it."""
    try:
        with open(path, "rb") as file:
            if file.read() == data:
                return
    except OSError:
        os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as file:
        file.write(data)


class Copy:
    def __init__(self, root, jobs):
        self.root, self.jobs = root, jobs
        self.tree = os.path.join(root, "build/mutate/tree")
        self.build = os.path.join(self.tree, "build")
        self.programs = os.path.join(self.build, "bin")

    # --- the tree ---

    def files(self):
        listed = run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=self.root)
        return [name for name in listed.stdout.split("\0") if name and os.path.isfile(os.path.join(self.root, name))]

    def write(self, texts):
        """Makes the copy what the project is, but for `texts` (by file, from the root). What ran before in it is gone."""
        # Every library and program links base, so that is where the switch is.
        texts = {**texts, "base/mutant.cpp": self.read("tests/mutate/mutant.cpp.in"), "CMakeLists.txt": self.build_rules(texts)}
        wanted = set(self.files()) | set(texts)
        for folder, folders, names in os.walk(self.tree):
            if folder == self.tree and "build" in folders:
                folders.remove("build")
            for name in names:
                path = os.path.join(folder, name)
                if os.path.relpath(path, self.tree) not in wanted:
                    os.remove(path)
        for name in wanted:
            target = os.path.join(self.tree, name)
            write_if_other(target, texts[name] if name in texts else self.read(name))
            if os.path.exists(os.path.join(self.root, name)):
                shutil.copymode(os.path.join(self.root, name), target)

    def build_rules(self, texts):
        """The project's, and less optimisation for the libraries that hold mutants: the compiler's work on them is half of the waiting."""
        modules = re.findall(r"^ *prismesh_module\((\w+) ([\w/]+)", self.read("CMakeLists.txt").decode(), re.M)
        broken = [name for name, folder in modules if any(file.startswith(folder + "/") for file in texts)]
        lines = [f"if(TARGET {name})\n  target_compile_options({name} PRIVATE -O1 -w -D_GLIBCXX_ASSERTIONS)\n"
                 f"  set_target_properties({name} PROPERTIES DISABLE_PRECOMPILE_HEADERS ON)\nendif()\n" for name in broken]
        return self.read("CMakeLists.txt") + "".join(lines).encode()

    def read(self, name):
        with open(os.path.join(self.root, name), "rb") as file:
            return file.read()

    # --- configuring ---

    def configure(self, kiosk):
        """The build that runs: in batches, since a module's sources change all at once."""
        query = os.path.join(self.build, ".cmake/api/v1/query")
        os.makedirs(query, exist_ok=True)
        open(os.path.join(query, "codemodel-v2"), "w").close()
        self.cmake(self.tree, self.build, f"-DPRISMESH_KIOSK={'ON' if kiosk else 'OFF'}", "-DPRISMESH_UNITY=ON", "-DPRISMESH_PRECOMPILED=ON")

    def configure_commands(self):
        """How each source is compiled by itself, for libclang: the folder of the compile commands."""
        folder = os.path.join(self.root, "build/mutate/commands")
        self.cmake(self.root, folder, "-DPRISMESH_UNITY=OFF", "-DPRISMESH_PRECOMPILED=OFF")
        return folder

    def cmake(self, source, build, *options):
        done = run(["cmake", "-S", source, "-B", build, "-G", "Ninja", "-Wno-dev", "--log-level=WARNING", "-DCMAKE_BUILD_TYPE=Release",
                    "-DPRISMESH_BENCH=OFF", "-DPRISMESH_RUNS=", *options])
        if done.returncode != 0:
            raise Failed(f"{build} can't be configured:\n{done.stdout}{done.stderr}")

    def test_programs(self):
        """The folders of each test program's own sources (from the root), by its name."""
        reply = os.path.join(self.build, ".cmake/api/v1/reply")
        found = {}
        for name in os.listdir(reply):
            if not name.startswith("target-"):
                continue
            with open(os.path.join(reply, name), encoding="utf-8") as file:
                target = json.load(file)
            sources = [source["path"] for source in target.get("sources", []) if source["path"].endswith("_test.cpp")]
            if target["type"] == "EXECUTABLE" and target["name"].endswith("_test") and sources:
                found[target["name"]] = sorted({os.path.dirname(source) for source in sources})
        return found

    # --- building ---

    def build_mutants(self, mutants, programs, say):
        """Builds the test programs with all mutants. Those that don't compile are marked and left out, and the build is tried again."""
        for attempt in range(MAX_ROUNDS):
            left = [mutant for mutant in mutants if mutant.state != "not compiled"]
            for number, mutant in enumerate(left, 1):
                mutant.number = number
            sources = {file: Schemata(self.read(file), [m for m in left if m.file == file]) for file in {m.file for m in left}}
            self.write({file: HEAD + source.text for file, source in sources.items()})
            done = run(["ninja", "-C", self.build, "-k0", f"-j{self.jobs}", *programs])
            if done.returncode == 0:
                return
            dropped = self.drop_what_fails(done.stdout + done.stderr, sources)
            say(f"round {attempt + 1}: {dropped} mutants don't compile")
            if dropped == 0:
                raise Failed("the copy can't be built, with or without mutants:\n" + done.stdout[-6000:] + done.stderr[-2000:])
        raise Failed(f"after {MAX_ROUNDS} rounds there are still mutants that don't compile")

    def drop_what_fails(self, output, sources):
        """Marks the mutants that the compiler's errors are about; their number."""
        position = re.compile(re.escape(self.tree) + r"/([^\s:]+):(\d+):(\d+): *(error|note|[a-z ]*required from|[a-z ]*  required)?")
        count = 0
        for block in re.split(r"^FAILED: ", output, flags=re.M)[1:]:
            spots = [(file, int(line), int(column), what or "") for file, line, column, what in position.findall(block) if file in sources]
            for wanted in ("error", "required", ""):
                at = [spot for spot in spots if wanted in spot[3]]
                dropped = sum(self.drop_at(sources[file], line, column) for file, line, column, _ in at)
                count += dropped
                if dropped:
                    break
            else:
                count += sum(self.drop(s.groups) for name, s in sources.items() if f"/{name}" in block.split("\n", 2)[1] or f"{name}" in block[:400])
        return count

    def drop_at(self, source, line, column):
        text = SourceText(source.text)
        start = text.line_starts[line - 1]
        mutants = source.mutants_at(start + column - 1)
        if not mutants:
            end = start + len(text.line(line))
            mutants = [m for group in source.groups if start <= group.written[0] < end for m, _ in group.choices]
        return self.mark(mutants)

    def drop(self, groups):
        return self.mark([mutant for group in groups for mutant, _ in group.choices])

    @staticmethod
    def mark(mutants):
        fresh = [mutant for mutant in mutants if mutant.state != "not compiled"]
        for mutant in fresh:
            mutant.state = "not compiled"
        return len(fresh)
