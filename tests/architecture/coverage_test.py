#!/usr/bin/env python3
"""The list of error branches that `./station coverage` prints: which conditions and statements of a source lead to an error, and which of them no
test has taken. The counts are written here in the shape in which llvm-cov exports them.
"""
import json
import os
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
SCRIPTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts")
sys.path.insert(0, SCRIPTS)
from error_branches import ErrorBranches  # noqa: E402

SOURCE = """\
int read(int a) {
  if (a < 0) return fail("negative");  // (
  if (a > 9 || !known(a)) {
    log(")");
    return refuse_node(a);
  }
  if (!(a == 3 && b == 4)) throw 1;
  if (a == 5) return 5; else return error("not five");
  while (is_full(a)) a = next(a);
  if (a == 6) return 6;
  return a == 7 ? 7 : fail("not seven");
}
"""


def places(text):
    """Line and column of a text's only place in the source."""
    assert SOURCE.count(text) == 1, text
    before = SOURCE[: SOURCE.index(text)]
    return before.count("\n") + 1, len(before) - (before.rfind("\n") + 1) + 1


class WayToError(unittest.TestCase):
    def expect(self, text, way):
        self.assertIs(ErrorBranches(SOURCE).way_to_error(*places(text)), way, text)

    def test_the_true_way_of_a_condition_whose_statement_says_an_error(self):
        for text in ("a < 0", "a > 9", "!known(a)"):
            self.expect(text, True)

    def test_the_false_way_inside_a_negation(self):
        self.expect("a == 3", False)
        self.expect("b == 4", False)

    def test_the_false_way_where_the_error_stands_in_the_else(self):
        self.expect("a == 5", False)

    def test_no_way_where_no_error_is_said(self):
        for text in ("is_full(a)", "a == 6", "a == 7"):
            self.expect(text, None)


class Report(unittest.TestCase):
    def report(self, branches, untaken, reasons):
        """What the script prints for these counts: (text of the condition, times true, times false), and texts that no test runs."""
        with tempfile.TemporaryDirectory() as folder:
            os.makedirs(os.path.join(folder, "deck"))
            self.write(folder, "deck/read.cpp", SOURCE)
            self.write(folder, "reasons.txt", reasons)
            rows = []
            for text, taken, not_taken in branches:
                line, column = places(text)
                rows.append([line, column, line, column + len(text), taken, not_taken, 0, 0, 4])
            segments = []
            for text in untaken:
                line, column = places(text)
                segments += [[line, column, 0, True, True, False], [line, column + len(text), 1, True, False, False]]
            summary = {"lines": {"count": 4, "covered": 3}, "branches": {"count": 8, "covered": 4}}
            entry = {"filename": os.path.join(folder, "deck/read.cpp"), "branches": rows, "segments": segments, "summary": summary}
            self.write(folder, "export.json", json.dumps({"data": [{"files": [entry]}]}))
            command = [sys.executable, os.path.join(SCRIPTS, "coverage.py"), "export.json", "reasons.txt", "one_way.txt", "deck"]
            printed = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True).stdout.strip().split("\n")
            with open(os.path.join(folder, "one_way.txt"), encoding="utf-8") as file:
                return printed[1].split(), printed[2:], file.read().splitlines()

    def write(self, folder, name, text):
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text)

    def test_lists_what_no_test_takes(self):
        figures, open_ones, one_way = self.report([("a < 0", 0, 9), ("a > 9", 2, 7), ("!known(a)", 0, 7), ("a == 6", 0, 3)], ['fail("not seven")'], "")
        self.assertEqual(figures, ["deck", "3/4", "75.0%", "4/8", "50.0%", "1/4", "25.0%", "0", "3"])
        self.assertEqual(open_ones, ["deck/read.cpp:2: never true: a < 0", "deck/read.cpp:3: never true: !known(a)",
                                     'deck/read.cpp:11: never run: return a == 7 ? 7 : fail("not seven");'])
        self.assertIn("deck/read.cpp:10: never true: a == 6", one_way)

    def test_a_reason_closes_a_branch_and_is_told_when_a_test_takes_it(self):
        reasons = "# why\ndeck/read.cpp: a < 0 => the caller has checked it\ndeck/read.cpp: a > 9 => it can't be\n"
        figures, open_ones, _ = self.report([("a < 0", 0, 9), ("a > 9", 2, 7)], [], reasons)
        self.assertEqual(figures[-2:], ["1", "0"])
        self.assertEqual(open_ones, ["reasons.txt: no longer an untested error branch: deck/read.cpp: a > 9"])

    def test_an_error_whose_condition_is_listed_is_not_listed_again(self):
        _, open_ones, _ = self.report([("a < 0", 0, 9)], ['return fail("negative");'], "")
        self.assertEqual(open_ones, ["deck/read.cpp:2: never true: a < 0"])


if __name__ == "__main__":
    unittest.main()
