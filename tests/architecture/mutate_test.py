#!/usr/bin/python3
"""The tool that breaks sources (./station mutate): the right mutants of a small source, which of them a good and a poor test notice, and what
isn't touched. Exit status 77 where its package isn't installed: the test is skipped.
"""
import os
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
TOOL = os.path.join(HERE, "..", "mutate")
sys.path.insert(0, TOOL)
try:
    import clang.cindex  # noqa: F401
except ImportError:
    print("skipped: ./station mutate can't be tested without the package python3-clang-14")
    sys.exit(77)

import mutate  # noqa: E402
import places  # noqa: E402
import report  # noqa: E402
import running  # noqa: E402
from copy_of_tree import Copy  # noqa: E402
from equivalent import read_equivalent  # noqa: E402
from schemata import Schemata  # noqa: E402

SMALL = b"""\
bool is_adult(int age) {
  return age >= 18;
}
int first_gap(const int* begin, int size) {
  int at = 0;
  while (at < size && begin[at] == at) ++at;
  return at;
}
"""

# No test tells these apart from what they break, since nothing of them depends on the program's run.
LEFT_ALONE = b"""\
#define SMALLER(a, b) ((a) < (b))
enum Colour { red = 1, green = red + 1 };
template <int N> struct Block { int bytes[N * 2]; };
constexpr int kSize = 3 + 4;
static_assert(kSize == 7, "seven");
[[deprecated("old")]] int old(int a = 1 + 2) noexcept(kSize > 3);
int kind_of(int value, Block<4 - 1>& block) {
  static constexpr int kThree = 1 + 2;
  if constexpr (kThree < 4) (void)block;
  switch (value) {
    case 1 + 1: break;
  }
  (void)sizeof(value + 1);
  bool seldom = SMALLER(value, value);
  (void)seldom;
  return value;
}
"""


def mutants_of(text, *arguments):
    """All mutants of a source in a folder of its own."""
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "small.cpp"), "wb") as file:
            file.write(text)
        found = places.places_in(os.path.join(folder, "small.cpp"), ["-x", "c++", "-std=c++20", *arguments], folder, {"small.cpp"})
    for number, mutant in enumerate(found, 1):
        mutant.number = number
    return found


def changes(text):
    return {f"{mutant.line}: {mutant.after}" for mutant in mutants_of(text)}


class Places(unittest.TestCase):
    def test_a_comparison_and_its_limit_are_broken(self):
        self.assertEqual(changes(SMALL[: SMALL.index(b"int first")]), {"2: return age > 18;"})

    def test_conditions_operands_constants_and_statements_are_broken(self):
        self.assertEqual(changes(SMALL) - {"2: return age > 18;"}, {
            "5: int at = 1;", "7: return 0;", "6: while (false) ++at;",
            "6: while (begin[at] == at) ++at;", "6: while (at < size) ++at;", "6: while (at <= size && begin[at] == at) ++at;",
            "6: while (at < size && begin[at] != at) ++at;",
            "6: while (at < size && begin[at] == at) --at;"})

    def test_real_numbers_are_compared_the_other_way_round_rather_than_at_the_limit(self):
        self.assertEqual(changes(b"bool f(double a, double b) {\n  return a < b;\n}\n"), {"2: return a >= b;"})

    def test_comparisons_that_give_no_truth_value_are_left_alone(self):
        text = b"struct Both { bool all() const; };\nstruct Place {};\nBoth operator<=(Place, Place);\n" \
               b"bool operator==(Place, Place);\nbool operator!=(Place, Place);\n" \
               b"bool f(Place a, Place b) { const bool so = (a <= b).all(); return so; }\n" \
               b"bool g(Place a, Place b) { return a == b; }\n"
        found = changes(text)
        self.assertIn("7: bool g(Place a, Place b) { return a != b; }", found)
        self.assertFalse([after for after in found if "a < b" in after])
        self.compiles(text)

    def test_neighbouring_arguments_of_one_type_are_exchanged(self):
        text = b"int area(int width, int height, double depth);\nint f(int a, int b) { return area(a, b, 2.0); }\n"
        self.assertIn("2: int f(int a, int b) { return area(b, a, 2.0); }", changes(text))
        self.assertFalse([after for after in changes(text) if "2.0, b" in after])

    def test_constant_expressions_types_attributes_and_macros_are_left_alone(self):
        self.assertEqual(changes(LEFT_ALONE), {"16: return 0;"})

    def test_what_only_makes_things_quicker_or_logs_is_left_alone(self):
        text = b"struct List { void reserve(int); void add(int); };\nnamespace logging { void info(int); }\n" \
               b"void f(List& list) {\n  list.reserve(7);\n  logging::info(3);\n  list.add(1);\n}\n"
        self.assertEqual(changes(text), {"6: ;", "6: list.add(2);"})

    def test_a_constant_function_is_broken_only_while_the_program_runs(self):
        text = b"constexpr int twice(int a) { return a + a; }\nstatic_assert(twice(2) == 4);\n"
        self.compiles(text)

    def test_lambdas_comments_and_lines_survive(self):
        text = b"int f(int a) {\n  const auto more = [&](int b) {  // a comment\n    return a + b;  // another\n  };\n" \
               b"  return more(1) + /* what */\n         more(2);\n}\n"
        written = self.compiles(text)
        self.assertEqual(written.count(b"\n"), text.count(b"\n"))

    def compiles(self, text):
        mutants = mutants_of(text)
        self.assertTrue(mutants)
        written = Schemata(text, mutants).text
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "small.cpp")
            with open(path, "wb") as file:
                file.write(b'#include "mutant.h"\n' + written)
            done = subprocess.run(["c++", "-std=c++20", "-w", "-fsyntax-only", f"-I{TOOL}", path], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return written


# Stands in for a program of GoogleTest.
TEST_PROGRAM = """\
#!/bin/bash
if [ "$1" = --gtest_list_tests ]; then printf 'Small.\\n  poor\\n  good\\n'; exit; fi
file=${1#--gtest_flagfile=}
for name in $(sed -n 's/^--gtest_filter=//p' "$file" | tr : ' '); do
  "$(dirname "$0")/small" "${name#Small.}" || { echo "[  FAILED  ] $name (0 ms)"; exit 1; }
done
"""
TESTS = b"""
#include <cstring>
int main(int, char** arguments) {
  const int gap[] = {0, 1, 7}, none[] = {0, 1, 2}, late[] = {5};
  if (!is_adult(30) || is_adult(3) || first_gap(gap, 3) != 2) return 1;
  if (std::strcmp(arguments[1], "poor") == 0) return 0;
  return !is_adult(18) || first_gap(none, 2) != 2 || first_gap(late, 1) != 0;
}
"""


class Running(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.mutants = mutants_of(SMALL)
        source = os.path.join(cls.folder.name, "small.cpp")
        with open(source, "wb") as file:
            file.write(b'#include "mutant.h"\n' + Schemata(SMALL, cls.mutants).text + TESTS)
        subprocess.run(["c++", "-std=c++20", "-w", f"-I{TOOL}", source, "-x", "c++", os.path.join(TOOL, "mutant.cpp.in"), "-o",
                        os.path.join(cls.folder.name, "small")], check=True)
        with open(os.path.join(cls.folder.name, "small_test"), "w", encoding="utf-8") as file:
            file.write(TEST_PROGRAM)
        os.chmod(os.path.join(cls.folder.name, "small_test"), 0o755)
        running.MORE_SECONDS = 2
        cls.runner = running.Runner(cls.folder.name, 2)
        cls.tests = cls.runner.record("small_test", len(cls.mutants), 10, print)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def slipped(self, names):
        tests = [test for test in self.tests if test.name in names]
        return {mutant.after for mutant in self.mutants if not self.runner.judge(mutant.number, tests)}

    def test_every_mutant_is_reached(self):
        self.assertEqual([test.name for test in self.tests], ["Small.poor", "Small.good"])
        self.assertEqual(self.tests[0].reached, {mutant.number for mutant in self.mutants})

    def test_a_poor_test_lets_limits_slip_and_a_good_one_notices_them(self):
        self.assertEqual(self.slipped(["Small.poor"]), {"return age > 18;", "int at = 1;",
                                                        "while (at <= size && begin[at] == at) ++at;", "while (begin[at] == at) ++at;"})
        self.assertEqual(self.slipped(["Small.poor", "Small.good"]), set())


class Building(unittest.TestCase):
    def test_what_the_compiler_refuses_is_left_out_and_nothing_else(self):
        mutants = mutants_of(SMALL)
        source = Schemata(SMALL, mutants)
        line = source.text.split(b"\n")[1]
        column = line.index(b"age > 18") + 1
        copy = Copy("/nowhere", 1)
        output = f"FAILED: small.o\nc++ small.cpp\n{copy.tree}/small.cpp:2:{column}: error: no\n"
        self.assertEqual(copy.drop_what_fails(output, {"small.cpp": source}), 1)
        self.assertEqual([mutant.after for mutant in mutants if mutant.state == "not compiled"], ["return age > 18;"])


class Choosing(unittest.TestCase):
    PROGRAMS = {"base_test": ["tests/base"], "mesh_deck_test": ["tests/mesh/deck"], "mesh_deck_nastran_test": ["tests/mesh/deck/nastran"],
                "mesh_document_test": ["tests/mesh/document"]}

    def test_tests_are_those_of_the_nearest_folder(self):
        self.assertEqual(mutate.programs_for(["base/file.cpp"], self.PROGRAMS), (["base_test"], []))
        self.assertEqual(mutate.programs_for(["mesh/deck/nastran/card.cpp"], self.PROGRAMS), (["mesh_deck_nastran_test"], ["mesh_document_test"]))
        self.assertEqual(mutate.programs_for(["mesh/deck/text/line.cpp"], self.PROGRAMS),
                         (["mesh_deck_nastran_test", "mesh_deck_test"], ["mesh_document_test"]))
        self.assertEqual(mutate.programs_for(["mesh/document/edit.cpp"], self.PROGRAMS), (["mesh_document_test"], []))

    def test_a_module_is_a_folder_a_file_or_both_files_of_a_topic(self):
        files = ["base/file.h", "base/file.cpp", "base/hash.cpp", "tests/base/file_test.cpp"]
        self.assertEqual(mutate.files_of("base/file", files), ["base/file.h", "base/file.cpp"])
        self.assertEqual(mutate.files_of("base/", files), files[:3])
        with self.assertRaises(mutate.Failed):
            mutate.files_of("tests/base", files)

    def test_the_changed_lines_are_those_of_the_working_tree(self):
        with tempfile.TemporaryDirectory() as folder:
            def git(*words):
                subprocess.run(["git", "-c", "user.name=n", "-c", "user.email=e", *words], cwd=folder, check=True, capture_output=True)
            os.mkdir(os.path.join(folder, "base"))
            path = os.path.join(folder, "base/a.cpp")
            with open(path, "w", encoding="utf-8") as file:
                file.write("1\n2\n3\n4\n")
            git("init", "-q", "-b", "main")
            git("add", ".")
            git("commit", "-qm", "one")
            with open(path, "w", encoding="utf-8") as file:
                file.write("1\ntwo\n4\nfive\nsix\n")
            root, mutate.ROOT = mutate.ROOT, folder
            try:
                self.assertEqual(mutate.changed_lines("main"), {"base/a.cpp": {2, 4, 5}})
            finally:
                mutate.ROOT = root


class Reporting(unittest.TestCase):
    def test_the_list_shows_the_line_before_and_after_and_counts(self):
        mutants = mutants_of(SMALL)
        for mutant in mutants:
            mutant.state = "caught"
        mutants[0].state = "slipped"
        mutants[1].state = "not reached"
        self.assertEqual(report.entry(mutants[0]), "small.cpp:2: slipped: comparison\n    - return age >= 18;\n    + return age > 18;")
        self.assertEqual(report.not_reached(mutants), ["small.cpp: not reached: 5"])
        self.assertIn("made 9, reached 8, caught 7, slipped 1, not reached 1", report.counts(mutants, 0))

    def test_what_slipped_is_found_again_in_the_list(self):
        mutants = mutants_of(SMALL)
        for mutant in mutants[:2]:
            mutant.state = "slipped"
        with tempfile.NamedTemporaryFile("w", suffix=".txt") as file:
            file.write("\n".join(["[ 1 s] words", *map(report.entry, mutants[:2]), "[ 2 s] counts\n"]))
            file.flush()
            again = report.read_slipped(file.name)
        self.assertEqual([m for m in mutants if (m.file, m.before, m.after) in again], mutants[:2])

    def test_what_is_known_to_change_nothing_is_told_apart(self):
        with tempfile.NamedTemporaryFile("w", suffix=".txt") as file:
            file.write("# a comment\nsmall.cpp: age >= 18 => age > 18: nobody is asked on a birthday\n")
            file.flush()
            is_equivalent = read_equivalent(file.name)
        self.assertEqual([mutant.after for mutant in mutants_of(SMALL) if is_equivalent(mutant)], ["return age > 18;"])


if __name__ == "__main__":
    unittest.main()
