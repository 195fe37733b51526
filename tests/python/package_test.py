#!/usr/bin/env python3
"""The Python package: the same figures and bytes as the command line, arrays, errors, stopping.

    package_test.py FOLDER_OF_THE_PACKAGE PRISMESH
"""
import ast
import inspect
import json
import os
import pathlib
import pickle
import signal
import sys
import tempfile
import threading
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import decks  # noqa: E402  before prismesh: finds it
import numpy as np  # noqa: E402
import prismesh  # noqa: E402

COLUMNS, ROWS = 70, 66  # 4,757 nodes and 4,620 shells: two chunks of each
EDITS = [
    {"edit": "select", "expr": "1-30:5", "kind": "element"},
    {"edit": "grow", "rings": 2},
    {"edit": "translate", "by": [0.5, 0.25, 4.0], "falloff": {"profile": "smooth"}},
    {"edit": "relax", "mode": "full"},
    {"edit": "undo"},
    {"edit": "hide", "on": "part:2"},
]


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.deck = os.path.join(self.folder, "sheet.k")
        decks.write_sheet(self.deck, COLUMNS, ROWS)

    def path(self, name):
        return os.path.join(self.folder, name)

    def bytes_of(self, name):
        return pathlib.Path(self.path(name)).read_bytes()

    def assertRefused(self, words, work, file=None, line=None):
        with self.assertRaises(prismesh.Error) as caught:
            work()
        self.assertIn(words, caught.exception.message)
        self.assertEqual((caught.exception.file, caught.exception.line), (file, line))
        return caught.exception


class SameAsTheCommandLine(InFolder):
    def test_info_and_check(self):
        with prismesh.open(self.deck) as document:
            self.assertEqual(document.info(), decks.program_json("info", self.deck)[0])
            self.assertEqual(document.check(), decks.program_json("check", self.deck)[0])
            some = decks.program_json("check", self.deck, "--select", "1-200", "--chordal")[0]
            self.assertEqual(document.check("1-200", chordal=True), some)
            self.assertEqual(some["elements"], 200)

    def test_info_counts_no_shell_that_an_edit_removed(self):
        with prismesh.open(self.deck) as document:
            before = document.info()
            shell = self.id_of_first_shell()
            document.edit({"edit": "collapse", "at": [f"shell:{shell}"]})
            document.save(self.path("less.k"))
            counted = document.info()
        of_file = decks.program_json("info", self.path("less.k"))[0]
        self.assertEqual(counted["parts"], of_file["parts"])
        self.assertNotEqual(counted["parts"], before["parts"])

    def id_of_first_shell(self):
        cards = pathlib.Path(self.deck).read_text().split("*ELEMENT_SHELL\n")[1]
        return int(next(line for line in cards.splitlines() if not line.startswith("$"))[:8])

    def test_options_of_open(self):
        with prismesh.open(self.deck, length_unit="m", target_size={None: 4, "1": 2.5}, criteria="strict") as document:
            by_program = decks.program_json("check", self.deck, "--length-unit", "m", "--target-size", "4", "--target-size", "2.5@1",
                                            "--criteria", "strict")[0]
            self.assertEqual(document.check(), by_program)
            self.assertEqual(by_program["parts"][0]["target_size"], 2.5)

    def test_edits_and_bytes(self):
        pathlib.Path(self.path("script.jsonl")).write_text("\n".join(map(json.dumps, EDITS)))
        by_program = decks.program_json("edit", self.deck, "--script", self.path("script.jsonl"), "-o", self.path("program.k"))
        with prismesh.open(self.deck) as document:
            reports = [document.edit(edit) for edit in EDITS]
            saved = document.save(self.path("python.k"))
        self.assertEqual(decks.without_time(reports), decks.without_time(by_program))
        self.assertGreater(reports[2]["nodes_moved"], 10)
        self.assertEqual(self.bytes_of("python.k"), self.bytes_of("program.k"))
        self.assertEqual(saved["files_written"], [self.path("python.k")])
        difference = prismesh.diff(self.deck, self.path("python.k"))
        self.assertEqual(difference, decks.program_json("diff", self.deck, self.path("program.k"))[0])
        self.assertEqual(difference["nodes_moved"], reports[2]["nodes_moved"])
        self.assertEqual(saved["lines_changed"], difference["lines_changed"])

    def test_only_changed_lines_are_new(self):
        with prismesh.open(self.deck) as document:
            document.save(self.path("same.k"))
            document.edit("translate", on="7", by=[0, 0, 1], falloff={"profile": "constant"})
            document.save(self.path("moved.k"))
        before = self.bytes_of("sheet.k")
        self.assertEqual(self.bytes_of("same.k"), before)
        changed = [pair for pair in zip(before.splitlines(), self.bytes_of("moved.k").splitlines(), strict=True) if pair[0] != pair[1]]
        self.assertEqual([line[:8] for line, _ in changed], [b"       7"])

    def test_forms_of_an_edit(self):
        def moved(*arguments, **fields):
            with prismesh.open(pathlib.Path(self.deck)) as document:
                document.select("7-9")
                document.edit(*arguments, **fields)
                return document.state.positions.copy()
        expected = moved({"edit": "translate", "by": [0, 0.5, 1]})
        self.assertEqual(expected[6:9, 2].max() - 1, [place[2] for place in map(decks.place, range(6, 9), [0] * 3)][
            int(np.argmax(expected[6:9, 2]))])
        for again in (moved("translate", by=(0, 0.5, 1)), moved("translate", by=np.array([0, 0.5, 1])),
                      moved({"edit": "translate"}, by=[np.int64(0), np.float64(0.5), 1])):
            self.assertTrue(np.array_equal(again, expected))

    def test_in_place(self):
        with prismesh.open(self.deck) as document:
            document.edit("translate", on="7", by=[0, 0, 1])
            document.save(self.deck)
            first = self.bytes_of("sheet.k")
            document.edit("translate", on="8", by=[0, 0, 1])
            document.save(self.path("copy.k"))
            document.save(self.deck)
            both = self.bytes_of("sheet.k")
            self.assertNotEqual(both, first)
            self.assertEqual(self.bytes_of("copy.k"), both)
            document.edit("undo")
            with open(self.deck, "a", encoding="ascii") as file:
                file.write("$ from another program\n")
            written = self.bytes_of("sheet.k")
            self.assertRefused("", lambda: document.save(self.deck), file=self.deck)
        self.assertEqual(self.bytes_of("sheet.k"), written)


class Arrays(InFolder):
    def test_what_the_deck_says(self):
        with prismesh.open(self.deck) as document:
            state = document.state
        nodes = [decks.place(i, j) for j in range(ROWS + 1) for i in range(COLUMNS + 1)]
        self.assertTrue(np.array_equal(np.asarray(state.positions), np.array(nodes)))
        self.assertTrue(np.array_equal(np.asarray(state.node_ids), np.arange(1, len(nodes) + 1)))
        corners = np.asarray(state.node_ids)[np.asarray(state.shell_nodes)]
        self.assertEqual(corners[1].tolist(), [2, 3, COLUMNS + 4 - 1 + 1, COLUMNS + 3])
        self.assertEqual(np.asarray(state.shell_ids)[-1], COLUMNS * ROWS)
        self.assertEqual(state.part_ids[np.asarray(state.shell_parts)].tolist(), [1] * (COLUMNS * ROWS))
        self.assertEqual((state.positions.shape, len(state.positions)), ((len(nodes), 3), len(nodes)))
        beam = state.elements("beam")
        self.assertEqual(beam["ids"].tolist(), [900001])
        self.assertEqual(np.asarray(state.node_ids)[beam["nodes"][:2]].tolist(), [1, 2])
        self.assertEqual(state.elements("solid")["ids"].size, 0)
        self.assertRefused("the classes are beam, solid", lambda: state.elements("shell"))

    def test_chunks_are_read_only_views(self):
        with prismesh.open(self.deck) as document:
            state = document.state
            chunks = state.positions.chunks
            self.assertEqual([chunk.shape for chunk in chunks], [(4096, 3), (len(state.positions) - 4096, 3)])
            self.assertTrue(np.shares_memory(chunks[0], state.positions.chunks[0]))
            self.assertFalse(np.shares_memory(state.positions.copy(), chunks[0]))
            for array in (chunks[0], state.node_ids.chunks[0], state.shell_nodes.chunks[1], state.elements("beam")["nodes"]):
                self.assertRaises(ValueError, array.__setitem__, 0, 0)
                self.assertRaises(ValueError, array.setflags, write=True)
            self.assertTrue(np.shares_memory(state.elements("beam")["ids"], state.elements("beam")["ids"]))
            self.assertRaises(ValueError, lambda: state.positions.__array__(copy=False))
            copy = state.positions.copy()
            copy[0] = 1  # a copy is the caller's own
            self.assertEqual(np.asarray(state.shell_ids, dtype=np.float32).dtype, np.float32)

    def test_a_state_stays_as_it_is(self):
        with prismesh.open(self.deck) as document:
            before = document.state
            held = before.positions.chunks[0][6]
            document.edit("translate", on="7", by=[0, 0, 2], falloff={"profile": "constant"})
            after = document.state
            self.assertEqual((before.made_by, after.made_by), ("open", "translate"))
            moved = np.flatnonzero((np.asarray(before.positions) != np.asarray(after.positions)).any(axis=1))
            self.assertEqual(moved.tolist(), [6])
            self.assertFalse(np.shares_memory(before.positions.chunks[0], after.positions.chunks[0]))
            self.assertTrue(np.shares_memory(before.positions.chunks[1], after.positions.chunks[1]))
            document.edit("undo")
            self.assertTrue(np.shares_memory(before.positions.chunks[0], document.state.positions.chunks[0]))
            self.assertTrue(document.can_redo and not document.can_undo)
        del document, before, after
        self.assertEqual(held.tolist(), list(decks.place(6, 0)))  # the view alone keeps its chunk

    def test_selection_and_grades(self):
        with prismesh.open(self.deck) as document:
            document.select("9,3-5", kind="element")
            self.assertEqual(document.state.selected_shells.tolist(), [3, 4, 5, 9])
            document.select("20,11")
            self.assertEqual(document.state.selected_nodes.tolist(), [11, 20])
            document.edit("translate", on="1-3000:7", by=[0, 0, 3.5], falloff={"profile": "constant"})
            check, grades = document.check(), document.state.shell_grades
            self.assertEqual([int((grades == grade).sum()) for grade in range(3)], [check["ok"], check["warn"], check["fail"]])
            self.assertGreater(check["fail"], 0)

    def test_removed_shells_keep_their_entries(self):
        with prismesh.open(self.deck) as document:
            report = document.edit("collapse", at=["shell:500"])
            state = document.state
            gone = state.shell_grades == 3
            self.assertEqual(int(gone.sum()), report["elements_removed"])
            self.assertTrue((np.asarray(state.shell_nodes)[gone, 0] == 0xFFFFFFFF).all())


class Errors(InFolder):
    def test_of_files(self):
        missing = self.path("missing.k")
        refused = self.assertRefused("", lambda: prismesh.open(missing), file=missing)
        self.assertEqual(str(refused), missing + ": " + refused.message)
        self.assertRefused("", lambda: prismesh.diff(self.deck, missing), file=missing)
        pathlib.Path(self.path("letter.txt")).write_text("Dear all,\n")
        refused = self.assertRefused("", lambda: prismesh.open(self.path("letter.txt")), file=self.path("letter.txt"))
        self.assertIn(refused.message, decks.program("info", self.path("letter.txt"))[2])
        again = pickle.loads(pickle.dumps(refused))
        self.assertEqual((again.file, again.line, again.message), (refused.file, refused.line, refused.message))

    def test_a_line_of_a_file(self):
        text = pathlib.Path(self.deck).read_text()
        pathlib.Path(self.deck).write_text(text.replace("%8d%16.3f" % (7, 30), "%8d%16s" % (7, "thirty")))
        with self.assertRaises(prismesh.Error) as caught:
            prismesh.open(self.deck)
        self.assertEqual((caught.exception.file, caught.exception.line), (self.deck, 11 + 7))
        self.assertEqual(str(caught.exception), decks.program("info", self.deck)[2].strip())

    def test_of_edits_change_nothing(self):
        with prismesh.open(self.deck) as document:
            document.select("1-100")
            before = document.state
            self.assertRefused("\"distanz\"", lambda: document.edit("lift", distanz=3))
            self.assertRefused("\"lyft\"", lambda: document.edit("lyft", distance=3))
            self.assertRefused("by", lambda: document.edit("translate", by="up"))
            self.assertRefused("twice", lambda: document.edit({"edit": "lift", "distance": 1}, distance=2))
            self.assertRefused("isn't finite", lambda: document.edit("lift", distance=float("nan")))
            self.assertRefused("too large", lambda: document.edit("grow", rings=10**30))
            self.assertRefused("of type set", lambda: document.edit("translate", by={1, 2, 3}))
            self.assertRefused("named by texts", lambda: document.edit({"edit": "undo", 3: 4}))
            self.assertRefused("valid Unicode", lambda: document.select("\udcff"))
            endless = []
            endless.append(endless)
            self.assertRefused("nested", lambda: document.edit("translate", by=endless))
            self.assertRefused("", lambda: document.select("1-3,part:77"), file="expression", line=5)
            self.assertRefused("", lambda: document.check("part:77"), file="expression", line=1)
            self.assertRefused("", lambda: document.edit("redo"))
            self.assertRaises(TypeError, document.edit, 5)
            self.assertRaises(TypeError, document.edit, "undo", progress=5)
            self.assertRaises(TypeError, document.save, None)
            after = document.state
            self.assertTrue(np.shares_memory(before.positions.chunks[0], after.positions.chunks[0]))
            self.assertEqual(after.selected_nodes.tolist(), list(range(1, 101)))

    def test_of_options(self):
        self.assertRefused("not \"yard\"", lambda: prismesh.open(self.deck, length_unit="yard"))
        self.assertRefused("", lambda: prismesh.open(self.deck, target_size=-1), file=self.deck)
        self.assertRefused("", lambda: prismesh.open(self.deck, criteria=self.path("none.toml")), file=self.path("none.toml"))

    def test_of_saving_leave_files_as_they_were(self):
        before = decks.files_of(self.folder)
        with prismesh.open(self.deck) as document:
            document.edit("translate", on="7", by=[0, 0, 1])
            with self.assertRaises(prismesh.Error) as caught:
                document.save(self.path("sheet.k/below/out.k"))
            self.assertTrue(caught.exception.file.startswith(self.path("sheet.k")), caught.exception)
        self.assertEqual(decks.files_of(self.folder), before)

    def test_of_a_closed_document(self):
        document = prismesh.open(self.deck)
        state = document.state
        document.close()
        document.close()  # twice is once
        self.assertTrue(document.closed)
        for use in (lambda: document.edit("undo"), document.check, document.info, lambda: document.save(self.path("out.k")),
                    lambda: document.state, lambda: document.path, lambda: document.select("1")):
            self.assertRefused("closed", use)
        self.assertEqual(len(state.node_ids), (COLUMNS + 1) * (ROWS + 1))
        self.assertFalse(os.path.exists(self.path("out.k")))


class Stopping(InFolder):
    """LONG takes minutes when it isn't stopped."""

    LONG = {"edit": "repair", "scope": "all"}
    SHORT = {"edit": "relax", "mode": "full", "scope": "all"}

    def test_a_progress_function(self):
        heard = []
        with prismesh.open(self.deck, progress=lambda fraction, words: heard.append(fraction)) as document:
            self.assertTrue(heard and all(0 <= fraction <= 1 for fraction in heard))
            before = document.state
            refused = self.assertRefused("cancelled", lambda: document.edit(self.LONG, progress=lambda fraction, words: False))
            self.assertIsInstance(refused, prismesh.Cancelled)
            with self.assertRaises(ZeroDivisionError):
                document.edit(self.LONG, progress=lambda fraction, words: 1 / 0)
            self.assertTrue(np.shares_memory(before.positions.chunks[0], document.state.positions.chunks[0]))
            self.assertFalse(document.can_undo)
            self.assertTrue(document.edit(self.SHORT)["nodes_moved"])  # the document still works
            self.assertRaises(prismesh.Cancelled, document.save, self.path("out.k"), progress=lambda fraction, words: False)
        self.assertRaises(prismesh.Cancelled, prismesh.open, self.deck, progress=lambda fraction, words: False)
        self.assertRaises(prismesh.Cancelled, prismesh.diff, self.deck, self.deck, progress=lambda fraction, words: False)
        self.assertEqual(os.listdir(self.folder), ["sheet.k"])

    def test_ctrl_c_stops_an_edit(self):
        with prismesh.open(self.deck) as document:
            with self.assertRaises(KeyboardInterrupt):
                document.edit(self.LONG, progress=lambda fraction, words: os.kill(os.getpid(), signal.SIGINT))
            self.assertFalse(document.can_undo)

    def test_a_repair_that_keeps_what_it_has_reached(self):
        def after(rounds, then):
            calls = []

            def progress(fraction, words):
                calls.append(words)
                return then() if len(calls) > rounds else None
            return progress

        def interrupt():
            raise KeyboardInterrupt

        keeping = dict(self.LONG, on_cancel="keep")
        with prismesh.open(self.deck) as document:
            report = document.edit(keeping, progress=after(3, lambda: False))
            self.assertGreater(report["stopped"]["bad_left"], 0)
            self.assertEqual(document.state.made_by, "repair")
            document.edit("undo")
            self.assertRaises(KeyboardInterrupt, document.edit, keeping, progress=after(3, interrupt))
            self.assertEqual(document.state.made_by, "repair")
            self.assertTrue(document.can_undo)

    def test_ctrl_c_without_a_progress_function(self):
        # Python handles a signal between its instructions, or when the work asks for it. Here the signal comes while the work has it.
        with prismesh.open(self.deck) as document:
            done = []
            go = threading.Event()

            def interrupt():
                go.wait()
                signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)

            thread = threading.Thread(target=interrupt)
            thread.start()
            interval = sys.getswitchinterval()
            sys.setswitchinterval(1000)  # the other thread runs only when the work gives the interpreter up
            try:
                go.set()
                with self.assertRaises(KeyboardInterrupt):
                    done.append(document.edit(self.LONG))
            finally:
                sys.setswitchinterval(interval)
                thread.join()
            self.assertFalse(done or document.can_undo)

    def test_other_threads_run_meanwhile(self):
        with prismesh.open(self.deck) as document:
            seen = []
            go, looked = threading.Event(), threading.Event()

            def look():
                go.wait()
                seen.append(document.state.made_by)
                seen.append(document.check()["elements"])
                looked.set()

            thread = threading.Thread(target=look)
            thread.start()
            interval = sys.getswitchinterval()
            sys.setswitchinterval(1000)
            try:
                go.set()
                with self.assertRaises(prismesh.Cancelled):
                    document.edit(self.LONG, progress=lambda fraction, words: not looked.is_set())
            finally:
                sys.setswitchinterval(interval)
                thread.join()
            self.assertEqual(seen, ["open", COLUMNS * ROWS])

    def test_one_edit_at_a_time(self):
        with prismesh.open(self.deck) as document:
            refusals = []

            def progress(fraction, words):
                for use in (lambda: document.edit("undo"), document.close):
                    try:
                        use()
                    except prismesh.Error as error:
                        refusals.append(error.message)
                return False

            self.assertRaises(prismesh.Cancelled, document.edit, self.LONG, progress=progress)
            self.assertIn("being edited already", refusals[0])
            self.assertIn("can't be closed", refusals[1])
            self.assertFalse(document.closed)


class Stubs(unittest.TestCase):
    """The typed stub names what there is, with the same arguments."""

    def test_names_and_arguments(self):
        with open(os.path.join(os.path.dirname(prismesh.__file__), "__init__.pyi"), encoding="utf-8") as file:
            stub = ast.parse(file.read())
        declared = {}
        for node in stub.body:
            if isinstance(node, ast.ClassDef):
                declared[node.name] = {f.name: f for f in node.body if isinstance(f, ast.FunctionDef)}
            elif isinstance(node, ast.FunctionDef):
                declared[node.name] = node
        for name in prismesh.__all__:
            there = getattr(prismesh, name)
            if inspect.isclass(there) and not issubclass(there, Exception):
                inherited = dir(object) + ["__module__"]
                members = {m: v for m, v in vars(there).items() if m not in inherited and not m.startswith("_pybind")}
                self.assertEqual(sorted(declared[name]), sorted(members), name)
                for member, value in members.items():
                    if not isinstance(value, property):
                        self.assertArguments(declared[name][member], value)
            elif not inspect.isclass(there):
                self.assertArguments(declared[name], there)

    def assertArguments(self, node, function):
        # pybind11's docstring begins with name(argument: type = default, ...) -> type
        said = function.__doc__.split(")")[0].split("(", 1)[1]
        for argument in [*node.args.args[1 if node.args.args[:1] and node.args.args[0].arg == "self" else 0:], *node.args.kwonlyargs]:
            if not node.name.startswith("__exit"):
                self.assertIn(argument.arg + ":", said, node.name)


if __name__ == "__main__":
    unittest.main()
