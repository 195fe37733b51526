#!/usr/bin/env python3
"""The judge of costs itself: what it makes of a table and of a run. A stand-in for valgrind writes dumps in Callgrind's shape."""
import os
import stat
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import cost  # noqa: E402

HEAD = "# a comment\nmade with  GCC 12, glibc 2.36\n\n"
ROW = "region on a flat sheet  linear  4000  4.0  20  4.0\n"


def table(text=HEAD + ROW):
    return cost.read_table(text)[1]


def measured(instructions=4000.0, growth=4.0, peak=20.0, growth_of_bytes=4.0, name="region on a flat sheet"):
    return {name: (instructions, growth, peak, growth_of_bytes)}


class Comparing(unittest.TestCase):
    def dearer(self, figures, rows=None):
        return cost.compare(rows or table(), figures)[0]

    def test_as_in_the_table(self):
        self.assertEqual(cost.compare(table(), measured()), ([], []))

    def test_a_figure_may_grow_by_a_tenth(self):
        for grown in ({"instructions": 1.09 * 4000}, {"growth": 1.09 * 4}, {"peak": 1.09 * 20}, {"growth_of_bytes": 1.09 * 4}):
            self.assertEqual(self.dearer(measured(**grown)), [], grown)

    def test_more_than_a_tenth_is_dearer_and_named_with_both_figures(self):
        self.assertEqual(self.dearer(measured(instructions=4440)), ["region on a flat sheet: instructions a shell: was 4000, is 4440 (+11.0 %)"])
        self.assertEqual(self.dearer(measured(peak=22.2)), ["region on a flat sheet: bytes a shell: was 20, is 22.2 (+11.0 %)"])
        self.assertEqual(self.dearer(measured(growth_of_bytes=4.44)), ["region on a flat sheet: growth of bytes: was 4, is 4.44 (+11.0 %)"])

    def test_growth(self):
        self.assertEqual(self.dearer(measured(growth=4.6)),
                         ["region on a flat sheet: growth: was 4, is 4.6 (+15.0 %)",
                          "region on a flat sheet: growth is 4.6, and its order 'linear' allows 4.4"])
        self.assertEqual(self.dearer(measured(growth=2)), [], "it may shrink: more of the cost is fixed, which the first figure judges")

    def test_an_order_holds_whatever_figures_the_table_has(self):
        rows = table(HEAD + ROW.replace("4000  4.0", "4000  4.8"))
        self.assertEqual(self.dearer(measured(growth=4.8), rows), ["region on a flat sheet: growth is 4.8, and its order 'linear' allows 4.4"])

    def test_rows_that_only_one_of_them_has(self):
        self.assertEqual(self.dearer({**measured(), **measured(name="a new one")}), ["a new one: it isn't in the table"])
        self.assertEqual(self.dearer({}), ["region on a flat sheet: it is in the table, but isn't measured"])

    def test_cheaper_is_no_failure(self):
        self.assertEqual(cost.compare(table(), measured(instructions=3600)),
                         ([], ["region on a flat sheet: instructions a shell: was 4000, is 3600 (-10.0 %)"]))
        self.assertEqual(cost.compare(table(), measured(instructions=3700)), ([], []))

    def test_a_figure_of_nothing(self):
        rows = table(HEAD + "look up  constant  0  1  0  1\n")
        self.assertEqual(self.dearer(measured(0, 1, 0, 1, "look up"), rows), [])
        self.assertEqual(self.dearer(measured(0, 1, 3, 1, "look up"), rows), ["look up: bytes a shell: was 0, is 3"])


class Tables(unittest.TestCase):
    def refused(self, text):
        with self.assertRaises(cost.CostError) as refusal:
            cost.read_table(text)
        return str(refusal.exception)

    def test_what_cannot_be_read_is_named_with_its_line(self):
        self.assertEqual(self.refused(HEAD + ROW + "undo  linear  10  4\n"), "table.txt:5: there are 4 columns instead of 6; columns are two spaces apart")
        self.assertEqual(self.refused(HEAD + ROW.replace("4000", "many")), "table.txt:4: a figure isn't a number")
        self.assertTrue(self.refused(HEAD + ROW.replace("linear", "lineal")).startswith("table.txt:4: no order 'lineal'; there are constant, "))
        self.assertEqual(self.refused(HEAD + ROW + ROW), "table.txt:5: 'region on a flat sheet' stands twice")
        self.assertEqual(self.refused(ROW), "table.txt:1: the first line isn't what the table was made with")
        self.assertEqual(self.refused("# nothing\n"), "table.txt: it is empty")

    def test_what_was_written_is_read_again(self):
        figures = {"undo": (10.4713, 2.994, 0.6176, 3.982), "repair": (123456.0, 4.8, 179.0, 3.286)}
        made_with, rows = cost.read_table(cost.write_table("GCC 12", figures, {}))
        self.assertEqual(made_with, "GCC 12")
        self.assertEqual(rows["undo"], cost.Row("linear", (10.47, 2.994, 0.6176, 3.982)))
        self.assertEqual(rows["repair"], cost.Row("n log n", (123456.0, 4.8, 179.0, 3.286)))

    def test_writing_keeps_an_order_and_gives_a_new_row_the_smallest(self):
        text = cost.write_table("GCC 12", measured(growth=8), table())
        self.assertEqual(cost.read_table(text)[1]["region on a flat sheet"].order, "linear", "so that it fails until somebody changes it")
        for growth, order in ((1.0, "constant"), (2.0, "root"), (4.0, "linear"), (4.6, "n log n"), (16, "quadratic"), (64, "quadratic")):
            self.assertEqual(cost.order_of(growth), order)

    def test_writing_keeps_figures_that_are_off_by_less_than_a_hundredth(self):
        text = cost.write_table("GCC 12", measured(instructions=4030, growth=4.1, peak=19.9, growth_of_bytes=4.01), table())
        self.assertEqual(cost.read_table(text)[1]["region on a flat sheet"].figures, (4000, 4.1, 20, 4))

    def test_the_project_has_one(self):
        made_with, rows = cost.read_table(cost.content_of(os.path.join(HERE, "table.txt")))
        self.assertIn("GCC", made_with)
        self.assertGreater(len(rows), 20)


VALGRIND = """#!/bin/sh
for argument; do
  case $argument in --callgrind-out-file=*) out=${argument#*=} ;; esac
  size=$argument
done
printf 'desc: Trigger: Client Request: undo\\nsummary: %s\\n' $((size * UNDO)) >"$out.1"
printf 'desc: Trigger: Client Request: save\\nsummary: %s\\n' $((size * 7)) >"$out.2"
printf 'desc: Trigger: Program termination\\nsummary: 0\\n' >"$out.3"
printf 'undo\\t%s\\nsave\\t%s\\n' $((size * 2)) $((size * 3))
exit "$STATUS"
"""
PROGRAM = "#!/bin/sh\necho 'GCC 12, glibc 2.36'\n"


class Running(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        os.mkdir(self.path("bin"))
        self.script("bin/valgrind", VALGRIND)
        self.script("cost", PROGRAM)
        self.table = self.path("table.txt")

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def script(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod(self.path(name), stat.S_IRWXU)

    def judge(self, *more, undo=5, status=0, path=None):
        environment = {**os.environ, "UNDO": str(undo), "STATUS": str(status), "PATH": path or self.path("bin") + ":" + os.environ["PATH"]}
        return subprocess.run([sys.executable, os.path.join(HERE, "cost.py"), self.path("cost"), "--table", self.table, "--out", self.path("out"), *more],
                              capture_output=True, text=True, env=environment, check=False)

    def setUpTable(self):
        if (first := self.judge("--write")).returncode == cost.SKIPPED:
            self.skipTest(first.stdout)
        self.assertEqual(first.returncode, 0, first.stderr)

    def test_written_then_the_same_then_dearer(self):
        self.setUpTable()
        same = self.judge()
        self.assertEqual(same.returncode, 0, same.stdout + same.stderr)
        self.assertIn("undo", same.stdout)
        dearer = self.judge(undo=6)
        self.assertEqual(dearer.returncode, 1)
        self.assertIn("DEARER  undo: instructions a shell: was 5, is 6 (+20.0 %)", dearer.stdout)
        self.assertIn("run ./station cost --write and say why in the commit", dearer.stdout)
        cheaper = self.judge(undo=4)
        self.assertEqual(cheaper.returncode, 0)
        self.assertIn("cheaper  undo: instructions a shell: was 5, is 4 (-20.0 %)\nRun ./station cost --write", cheaper.stdout)

    def test_a_run_that_fails(self):
        self.setUpTable()
        failed = self.judge(status=3)
        self.assertEqual(failed.returncode, 1)
        self.assertIn("ended with status 3", failed.stderr)

    def test_no_table(self):
        failed = self.judge()
        self.assertEqual(failed.returncode, 1)
        self.assertIn("./station cost --write makes it anew", failed.stderr)

    def test_skipped_aloud_without_valgrind_and_with_another_compiler(self):
        self.setUpTable()
        os.mkdir(self.path("empty"))
        without = self.judge(path=self.path("empty"))
        self.assertEqual(without.returncode, cost.SKIPPED)
        self.assertIn("SKIPPED: cost.table counted nothing: valgrind is missing", without.stdout)
        self.script("cost", PROGRAM.replace("GCC 12", "GCC 13"))
        other = self.judge()
        self.assertEqual(other.returncode, cost.SKIPPED)
        self.assertIn("the table was made with GCC 12, glibc 2.36, and this is GCC 13, glibc 2.36", other.stdout)

    def test_a_program_that_marks_nothing(self):
        self.setUpTable()
        self.script("bin/valgrind", "#!/bin/sh\nprintf 'undo\\t1\\n'\n")
        failed = self.judge()
        self.assertEqual(failed.returncode, 1)
        self.assertIn("Callgrind counted 0 operations of 1", failed.stderr)


if __name__ == "__main__":
    unittest.main()
