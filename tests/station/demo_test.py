#!/usr/bin/env python3
"""The demo's editing session: on the sample none fails at its end; on small decks of other formats it does all steps; what it can't shape it
refuses in one sentence.

    demo_test.py PROGRAMS     PROGRAMS: the folder of the built programs
"""
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tests" / "checker"))
sys.dont_write_bytecode = True
import check_deck  # noqa: E402
import repair_proof  # noqa: E402

STEPS = ["opened", "lifted", "undone", "saved", "repaired", "stretched", "signs", "repaired", "relaxed"]


def grid(columns, rows, step):
    """Nodes (id, place) and quads (id, corners) of a plate that is bent up at one end."""
    nodes = [(1 + row * (columns + 1) + column, (step * column, step * row, step * max(0, column - columns * 2 // 3)))
             for row in range(rows + 1) for column in range(columns + 1)]  # fmt: skip
    quads = []
    for row in range(rows):
        for column in range(columns):
            first = 1 + row * (columns + 1) + column
            quads.append((len(quads) + 1, (first, first + 1, first + columns + 2, first + columns + 1)))
    return nodes, quads


def nastran_plate():
    nodes, quads = grid(24, 10, 10.0)
    lines = ["BEGIN BULK", "PSHELL,1,1,1.5", "MAT1,1,210000.,,0.3,7.8E-9"]
    lines += [f"GRID    {id:8d}        {x:8.2f}{y:8.2f}{z:8.2f}" for id, (x, y, z) in nodes]
    lines += [f"CQUAD4  {id:8d}{1:8d}" + "".join(f"{n:8d}" for n in corners) for id, corners in quads]
    return "\n".join([*lines, "ENDDATA", ""])


def radioss_plate():
    nodes, quads = grid(24, 10, 10.0)
    lines = ["#RADIOSS STARTER", "/BEGIN", "plate", f"{100:10d}{0:10d}", f"{'Mg':>20}{'mm':>20}{'s':>20}", f"{'Mg':>20}{'mm':>20}{'s':>20}", "/NODE"]
    lines += [f"{id:10d}{x:20.6f}{y:20.6f}{z:20.6f}" for id, (x, y, z) in nodes]
    lines += ["/PART/1", "plate", f"{1:10d}{1:10d}", "/SHELL/1"]
    lines += [f"{id:10d}" + "".join(f"{n:10d}" for n in corners) for id, corners in quads]
    return "\n".join([*lines, "/END", ""])


class Demo(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="demo-test-"))
        self.addCleanup(subprocess.run, ["rm", "-rf", self.folder])

    def play(self, *deck):
        return subprocess.run([ROOT / "demo" / "play", "--edits-only", "--out", self.folder / "out", *deck], capture_output=True, text=True, stdin=subprocess.DEVNULL)

    def written(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def all_steps(self, done):
        """The steps' lines by their first word, the last of each."""
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(done.stderr, "")
        lines = [line for line in done.stdout.splitlines() if line and not line.startswith(" ")]
        words = [line.split()[0] for line in lines]
        self.assertEqual(words[: len(STEPS)], STEPS)
        self.assertEqual(words[-8:], ["compared", "saved", "modeld", "doctor", "contact", "joining", "figure", "remote"])
        return {line.split()[0]: line for line in lines}

    def test_the_sample_ends_with_none_failing(self):
        done = self.play()
        lines = self.all_steps(done)
        self.assertIn("the same bytes", done.stdout)
        self.assertEqual((self.folder / "out" / "remote" / "back" / "sample.k").read_bytes(), (self.folder / "out" / "sample.k").read_bytes())
        failing = [int(count) for count in re.findall(r"fail \d+ -> (\d+)", done.stdout)]
        self.assertGreater(max(failing), 5, "the session makes shells fail before it mends them")
        self.assertTrue(re.search(r"[, ]0 fail$", lines["saved"]), lines["saved"])
        # Counted from the saved deck without the program: corner angles and edge ratios beyond what the default criteria fail.
        mesh = repair_proof.Mesh(check_deck.read(str(self.folder / "out" / "edited" / "sample.k")))
        self.assertGreater(len(mesh.shells), 5000)
        for shell, corners in mesh.shells.items():
            angles = mesh.angles(shell)
            low, high = (30, 120) if len(corners) == 3 else (40, 140)
            sides = [math.dist(mesh.at[corners[i]], mesh.at[corners[i - 1]]) for i in range(len(corners))]
            self.assertTrue(low <= min(angles) and max(angles) <= high and max(sides) <= 5 * min(sides), f"shell {shell}: {angles}, {sides}")

        self.check_figure(self.folder / "out" / "figure12")

    def check_figure(self, folder):
        """The decks of the figure's stages, by their text alone."""
        beams, ends = {}, {}
        for stage in "abdef":
            section, beams[stage], nodes = "", 0, {}
            for line in (folder / f"{stage}.k").read_text().splitlines():
                if line.startswith("*"):
                    section = line.split()[0]
                elif line.startswith("$"):
                    continue
                elif section == "*NODE":
                    nodes[int(line[:8])] = [float(line[8 + 16 * i : 24 + 16 * i]) for i in range(3)]
                elif section.startswith("*ELEMENT_BEAM"):
                    beams[stage] += 1
            ends[stage] = max(at[0] for at in nodes.values())
        self.assertAlmostEqual(ends["a"], 1640, 6)
        for stage in "bdef":
            self.assertAlmostEqual(ends[stage], 1790, 6, stage)
        self.assertEqual({beams[stage] for stage in "abde"}, {183})
        self.assertGreater(beams["f"], 190)

    def test_a_nastran_and_a_radioss_deck_are_shaped_mended_and_saved(self):
        for name, text in (("plate.bdf", nastran_plate()), ("PLATE_0000.rad", radioss_plate())):
            with self.subTest(name):
                deck = self.written(name, text)
                lines = self.all_steps(self.play(deck))
                self.assertIn("none more failing", lines["saved"])
                before, after = (repair_proof.Mesh(check_deck.read(str(file))) for file in (deck, self.folder / "out" / "edited" / name))
                self.assertGreater(max(math.dist(at, after.at[node]) for node, at in before.at.items()), 30, "the end was pulled")

    def test_what_cannot_be_shaped_is_refused_in_one_sentence(self):
        without_shells = "*KEYWORD\n*NODE\n" + f"{1:8d}{0.0:16.4f}{0.0:16.4f}{0.0:16.4f}\n*END\n"
        for name, text, reason in (("beams.k", without_shells, "has no shells"), ("letter.txt", "Dear colleague,\n", "letter.txt")):
            with self.subTest(name):
                done = self.play(self.written(name, text))
                self.assertEqual(done.returncode, 1, done.stdout)
                self.assertTrue(done.stderr.startswith("demo: "), done.stderr)
                self.assertIn(reason, done.stderr)
                self.assertEqual(done.stderr.count("\n"), 1, done.stderr)


if __name__ == "__main__":
    os.environ["PRISMESH_PROGRAMS"] = sys.argv.pop(1)
    unittest.main()
