#!/usr/bin/env python3
"""The checker itself: that it reads small decks of every format correctly, and that it reports every forbidden change of an edit."""
import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True
import check_deck  # noqa: E402
import edit_proof  # noqa: E402

PLATE = ("*KEYWORD\n*NODE\n$ the corners\n"
         + "".join(f"{i:8d}{x:16}{y:16}{0.0:16}\n" for i, x, y in ((1, 0.0, 0.0), (2, 10.0, 0.0), (3, 20.0, 0.0), (4, 0.0, 10.0), (5, 10.0, 10.0), (6, 20.0, 10.0)))
         + "*ELEMENT_SHELL\n       1       1       1       2       5       4\n       2       1       2       3       6       6\n"
         "*SET_NODE_LIST\n         1\n         2         5\n*SET_NODE_LIST_GENERATE\n         2\n       100       200\n*END\n")


class Decks(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()

    def tearDown(self):
        self.folder.cleanup()

    def read(self, text, name="deck.k"):
        path = os.path.join(self.folder.name, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "wb") as f:
            f.write(text.encode("latin-1"))
        return check_deck.read(path)

    def wrong(self, before, after, expected, name="deck.k"):
        try:
            saved = self.read(after, "after/" + name)
        except ValueError as error:
            return [str(error)]
        return edit_proof.compare(self.read(before, name), saved, expected)["wrong"]


class Reading(Decks):
    def test_lsdyna(self):
        deck = self.read(PLATE)
        self.assertEqual(deck.words, {"SHELL_QUAD": 1, "SHELL_TRI": 1})
        self.assertEqual(deck.nodes[3].basic(), (20.0, 0.0, 0.0))
        self.assertEqual(deck.sets[("node", 1)].members, {2, 5})
        self.assertEqual(deck.sets[("node", 2)].ranges, [(100, 200)])

    def test_lsdyna_transformed_include(self):
        self.read("*NODE\n       1             1.0             0.0             0.0\n", "part.k")
        deck = self.read("*DEFINE_TRANSFORMATION\n         7\nROTATE           0.0       0.0       1.0       0.0       0.0       0.0      90.0\n"
                         "TRANSL           5.0\n*INCLUDE_TRANSFORM\npart.k\n       100\n\n       0.0       0.0       2.0\n         7\n*END\n")
        for found, wanted in zip(deck.nodes[101].basic(), (5.0, 2.0, 0.0)):
            self.assertAlmostEqual(found, wanted, 12)
        for found, wanted in zip(deck.nodes[101].frame.from_basic((5.0, 4.0, 6.0)), (2.0, 0.0, 3.0)):
            self.assertAlmostEqual(found, wanted, 12)

    def test_lsdyna_parameters(self):
        deck = self.read("*PARAMETER\nR       w      10.0\n*PARAMETER_EXPRESSION\nR      w2 sqrt(&w*10)+1\n*NODE\n1,&w,&w2,-&w\n*END\n")
        self.assertEqual(deck.nodes[1].basic(), (10.0, 11.0, -10.0))

    def test_nastran(self):
        deck = self.read("SOL 101\nCEND\nBEGIN BULK\nCORD2C         1       0     10.      0.      0.     10.      0.      1.        +\n"
                         "+            20.      0.      0.\nGRID           1       1      2.     90.      1.\nGRID,2,,1.5-1,2.,3.\n"
                         "GRID*                  3                              4.              5.*\n*                     6.\n"
                         "=,*(1),=,*(.5),==\n=(2)\nCQUAD4,7,8,1,2,3,4\nENDDATA\nGRID,99\n", "deck.bdf")
        self.assertEqual(sorted(deck.nodes), [1, 2, 3, 4, 5, 6])
        for found, wanted in zip(deck.nodes[1].basic(), (10.0, 2.0, 1.0)):
            self.assertAlmostEqual(found, wanted, 12)
        self.assertEqual(deck.nodes[2].basic(), (0.15, 2.0, 3.0))
        self.assertEqual(deck.nodes[3].basic(), (4.0, 5.0, 6.0))
        self.assertEqual(deck.nodes[6].basic(), (5.5, 5.0, 6.0))
        self.assertEqual(deck.words, {"CQUAD4": 1})

    def test_radioss(self):
        self.read("/NODE\n         2" + "1.0".rjust(20) * 3 + "\n/END\n", "sub/b.inc")
        deck = self.read("#RADIOSS STARTER\n/NODE\n         1" + "2.5".rjust(20) * 3 + "\n#include sub/b.inc\n/PART/4\nroof\n         1\n"
                         "/SHELL/4\n         9         1         2         1         2\n#include gone.inc\n/END\n", "deck.rad")
        self.assertEqual(deck.nodes[2].basic(), (1.0, 1.0, 1.0))
        self.assertEqual((deck.parts, deck.words, deck.missing), ({4}, {"SHELL": 1}, ["gone.inc"]))

    def test_abaqus(self):
        deck = self.read("*NODE, NSET=ALL\n1, 1., 2.\n2, 3., 4., 5.\n*ELEMENT, TYPE=S3, ELSET=ROOF\n1, 1, 2, 1\n"
                         "*NSET, NSET=G, GENERATE\n1, 7, 2\n*SHELL SECTION, ELSET=ROOF, MATERIAL=M\n1.\n", "deck.inp")
        self.assertEqual(deck.nodes[1].basic(), (1.0, 2.0, 0.0))
        self.assertEqual((deck.parts, deck.words, deck.elements[0].part), ({"ROOF"}, {"S3": 1}, "ROOF"))
        self.assertEqual(deck.sets[("node", "G")].ranges, [(1, 7)])


class Proving(Decks):
    MOVED = PLATE.replace(f"{5:8d}{10.0:16}", f"{5:8d}{10.25:16}")
    BY = {"moved": {"nodes": [5], "by": [0.25, 0, 0]}}

    def test_the_same_deck(self):
        self.assertEqual(self.wrong(PLATE, PLATE, {}), [])

    def test_a_moved_node(self):
        self.assertEqual(self.wrong(PLATE, self.MOVED, self.BY), [])
        self.assertTrue(self.wrong(PLATE, self.MOVED, {}), "a node that shouldn't have moved")
        self.assertTrue(self.wrong(PLATE, PLATE, self.BY), "a node that should have moved")
        self.assertTrue(self.wrong(PLATE, self.MOVED, {"moved": {"nodes": [5], "by": [0.26, 0, 0]}}), "by a wrong amount")

    def test_any_other_byte(self):
        for before, after in (("$ the corners", "$ The corners"), ("*KEYWORD\n", "*KEYWORD\r\n"), ("*END\n", "*END"), ("*END\n", "*END\n\n"),
                              ("         2         5", "         2         6"), ("$ the corners\n", "")):
            self.assertTrue(self.wrong(PLATE, self.MOVED.replace(before, after), self.BY), after)

    def test_the_style_of_a_changed_line(self):
        line = f"{5:8d}{10.25:16}"
        for other in (f"{5:7d} {10.25:16}", f"{5:8d}{10.25:17}", f"{5:8d},{10.25:16}"):
            self.assertTrue(self.wrong(PLATE, self.MOVED.replace(line, other), self.BY), other)
        self.assertTrue(self.wrong(PLATE, self.MOVED.replace(line + f"{10.0:16}", line + f"{'1.0E1':>16}"), self.BY), "a text changed in vain")

    def test_digits_thrown_away(self):
        third = {"moved": {"nodes": [5], "by": [1 / 3, 0, 0]}}
        self.assertEqual(self.wrong(PLATE, PLATE.replace(f"{5:8d}{10.0:16}", f"{5:8d}10.3333333333333"), third), [])
        self.assertTrue(self.wrong(PLATE, PLATE.replace(f"{5:8d}{10.0:16}", f"{5:8d}{'10.333333333':>16}"), third))

    def split(self, node, members, twin="       3       1       7       2       5       5\n"):
        text = PLATE.replace("*ELEMENT_SHELL", f"{node:8d}{5.0:16}{0.0:16}{0.0:16}\n*ELEMENT_SHELL")
        text = text.replace("       1       1       1       2       5       4\n", "       1       1       1       7       5       4\n" + twin)
        return text.replace("         2         5\n", members)

    def test_welds_follow_their_sheet(self):
        def node(id, x, y, z):
            return f"{id:8d}{x:16}{y:16}{z:16}\n"
        weld = "*ELEMENT_BEAM\n" + "".join(f"{n:8d}" for n in (9, 9, 7, 8)) + "\n"
        text = PLATE.replace("*ELEMENT_SHELL", node(7, 5.0, 5.0, 1.0) + node(8, 5.0, 5.0, 20.0) + "*ELEMENT_SHELL").replace("*SET_NODE_LIST\n", weld + "*SET_NODE_LIST\n", 1)
        pulled = text.replace(node(1, 0.0, 0.0, 0.0), node(1, 0.0, 0.0, 4.0))
        expected = {"moved": {"by": [0, 0, 4], "nodes": [1]}}
        self.assertEqual(self.wrong(text, pulled.replace(node(7, 5.0, 5.0, 1.0), node(7, 5.0, 5.0, 3.0)), expected), [])
        self.assertNotEqual(self.wrong(text, pulled.replace(node(7, 5.0, 5.0, 1.0), node(7, 5.0, 5.0, 3.5)), expected), [])
        self.assertNotEqual(self.wrong(text, pulled.replace(node(8, 5.0, 5.0, 20.0), node(8, 5.0, 5.0, 22.0)), expected), [])

    def test_new_entities(self):
        expected = {"nodes_added": 1, "elements_added": 1, "elements_changed": 1}
        both = PLATE.replace("         2         5\n", "         1         2\n")
        after = self.split(7, "         1         2         7\n")
        self.assertEqual(self.wrong(both, after, expected), [])
        self.assertTrue(self.wrong(both, self.split(7, "         1         2\n"), expected), "not in the set of both ends")
        self.assertTrue(self.wrong(both, after.replace("       3       1       7", "       2       1       7"), expected), "an id given twice")
        self.assertTrue(self.wrong(both, after.replace("       3       1       7", "       3       2       7"), expected), "another part")
        both_removed = both.replace("       2       1       2       3       6       6\n", "")
        self.assertEqual(self.wrong(both, both_removed, {"elements_removed": 1}), [])
        self.assertTrue(self.wrong(both, both_removed, {}), "an element gone")
        self.assertTrue(self.wrong(both, both_removed.replace("         1         2\n*SET", "         1\n*SET"), {"elements_removed": 1}), "a set's member gone")
        captured = self.split(150, "         1         2       150\n").replace("       7", "     150")
        self.assertTrue(self.wrong(both, captured, expected), "an id within another set's range")

    def test_new_shells_after_a_repair(self):
        def node(id, x, y):
            return f"{id:8d}{x:16}{y:16}{0.0:16}\n"

        def grown(nodes, shell):
            text = PLATE.replace("*ELEMENT_SHELL", "".join(node(*n) for n in nodes) + "*ELEMENT_SHELL")
            text = text.replace("       1       1       1       2       5       4\n", "       1       1       1       7       5       4\n" + shell)
            return self.wrong(PLATE, text, {"moved_freely": True, "nodes_added": "any", "elements_added": "any", "elements_changed": "any"})

        middle = (7, 5.0, 0.0)
        self.assertEqual(grown([middle], "       3       1       7       2       5       5\n"), [])
        one_old_node = "       3       1       7       8       5       5\n       4       1       7       2       8       8\n       5       1       8       2       5       5\n"
        self.assertEqual(grown([middle, (8, 6.0, 4.0)], one_old_node), [], "in two rounds")
        elsewhere = "       3       1       7       2       5       5\n       4       1       2       8       9       9\n"
        self.assertTrue(grown([middle, (8, 90.0, 90.0), (9, 95.0, 90.0)], elsewhere), "one node in common, and placed elsewhere")
        flap = "       3       1       7       2       5       5\n       4       1       3       8       9       6\n"
        self.assertTrue(grown([middle, (8, 30.0, 0.0), (9, 30.0, 10.0)], flap), "at an edge of the part, where nothing was divided")
        tip = "       3       1       7       2       5       5\n       4       1       2       8       9       9\n"
        self.assertTrue(grown([middle, (8, 8.0, -3.0), (9, 6.0, -3.0)], tip), "near, but at a node only")

    def test_groups_of_quads_and_of_triangles(self):
        def ints(*ids):
            return "".join(f"{id:10d}" for id in ids)

        def deck(quads, triangles, groups):
            nodes = "".join(f"{id:10d}{x:20}{y:20}{0.0:20}\n" for id, x, y in ((1, 0.0, 0.0), (2, 1.0, 0.0), (3, 1.0, 1.0), (4, 0.0, 1.0), (5, 2.0, 0.0), (6, 2.0, 1.0)))
            return ("#RADIOSS STARTER\n/NODE\n" + nodes + "/SHELL/4\n" + quads + triangles + "/PART/4\nroof\n         1\n/SECT/1\ncut\n"
                    + ints(1, 2, 3, 0) + "\n\n" + groups + "/END\n")

        two, one = ints(9, 1, 2, 3, 4) + "\n" + ints(8, 2, 5, 6, 3) + "\n", ints(8, 2, 5, 6, 3) + "\n"
        cut = "/SH3N/4\n" + ints(9, 1, 2, 3) + "\n" + ints(10, 1, 3, 4) + "\n"
        group = "/GRSHEL/SHEL/27\ncut\n"
        before = deck(two, "", ints(0, 0, 27, 0, 0, 0, 0) + "\n" + group + ints(8, 9) + "\n")

        def after(section, members):
            text = deck(one, cut, section + "\n" + group + ints(8) + "\n/GRSH3N/SH3N/27\ncut\n" + ints(*members) + "\n")
            return self.wrong(before, text, {"elements_added": "any", "elements_removed": "any", "elements_changed": "any"}, "deck.rad")
        self.assertEqual(after(ints(0, 0, 27, 0, 0, 0, 27), (9, 10)), [])
        self.assertTrue(after(ints(0, 0, 27, 0, 0, 0, 0), (9, 10)), "the section doesn't use the triangles")
        self.assertTrue(after(ints(0, 0, 27, 0, 0, 0, 27), (9,)), "a piece is in no group")
        self.assertTrue(after(ints(1, 0, 27, 0, 0, 0, 27), (9, 10)), "another field of the section differs")
        self.assertTrue(after(ints(0, 0, 28, 0, 0, 0, 27), (9, 10)), "the section lost its quads")

    def test_nastran_fields(self):
        before = ("GRID           1             1.0     2.0     3.0       7\nGRID*                  2                             1.0             2.0\n"
                  "*                    3.0\n")
        third = {"moved": {"by": [1 / 3, 0, 0]}}
        after = before.replace("     1.0     2.0", "1.333333     2.0").replace("             1.0             2.0", "1.33333333333333             2.0")
        self.assertEqual(self.wrong(before, after, third, "deck.bdf"), [])
        for text, poorer in (("1.333333 ", " 1.33333 "), ("1.33333333333333", "  1.333333333333"), ("     3.0", "3.0     "), ("       7", "7       ")):
            self.assertTrue(self.wrong(before, after.replace(text, poorer), third, "deck.bdf"), poorer)


if __name__ == "__main__":
    unittest.main()
