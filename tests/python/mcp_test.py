#!/usr/bin/env python3
"""The server of prismesh.mcp, by a client that is written here and shares no code with it.

    mcp_test.py FOLDER_OF_THE_PACKAGE PRISMESH
"""
import json
import os
import pathlib
import random
import re
import resource
import select
import signal
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

PACKAGE = os.path.abspath(sys.argv[1]) if len(sys.argv) > 1 else ""
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import decks  # noqa: E402

COLUMNS, ROWS = 20, 16
PATIENCE_S = 60
MAX_ANSWER = 256 * 1024  # bytes that docs/mcp.md promises
LIFT = {"edit": "translate", "by": [0.5, 0.25, 4.125], "falloff": {"profile": "smooth"}}


class Client:
    def __init__(self, root, edits, *more, limit=None, package=PACKAGE, environment=None):
        def limited():
            if limit is not None:
                signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
                resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
        self.errors = tempfile.TemporaryFile()
        self.process = subprocess.Popen(
            [sys.executable, "-B", "-m", "prismesh.mcp", "--root", str(root), "--edits", str(edits), *more], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self.errors,
            env={**os.environ, "PYTHONPATH": package, **(environment or {})}, cwd="/", preexec_fn=limited)
        self.number = 0
        self.held = b""

    def write(self, line):
        self.process.stdin.write(line + b"\n")
        self.process.stdin.flush()

    def read(self):
        """The next message, as bytes; fails when none comes."""
        while b"\n" not in self.held:
            ready, _, _ = select.select([self.process.stdout], [], [], PATIENCE_S)
            piece = os.read(self.process.stdout.fileno(), 1 << 16) if ready else b""
            if not piece:
                self.errors.seek(0)
                raise AssertionError(f"no answer; the server says {self.errors.read()[-2000:]!r}")
            self.held += piece
        line, self.held = self.held.split(b"\n", 1)
        return line

    def ask(self, method, params=None, number=None):
        """The response to a request; the progress that is told before it is kept in .told."""
        self.number += 1
        number = self.number if number is None else number
        self.write(json.dumps({"jsonrpc": "2.0", "id": number, "method": method, **({} if params is None else {"params": params})}).encode())
        self.told = []
        while "id" not in (answer := json.loads(self.read())):
            self.told.append(answer)
        if answer["id"] != number:
            raise AssertionError(f"{answer} answers {number}")
        return answer

    def shake_hands(self, version="2025-06-18"):
        answer = self.ask("initialize", {"protocolVersion": version, "capabilities": {}, "clientInfo": {"name": "test", "version": "1"}})
        self.write(b'{"jsonrpc": "2.0", "method": "notifications/initialized"}')
        return answer["result"]

    def call(self, tool, **arguments):
        """The result of a tool, whatever it says."""
        answer = self.ask("tools/call", {"name": tool, "arguments": arguments})
        if "result" not in answer:
            self.errors.seek(0)
            raise AssertionError(f"{answer}; the server says {self.errors.read()[-2000:].decode()}")
        return answer["result"]

    def do(self, tool, **arguments):
        """The answer of a tool that must have done it."""
        result = self.call(tool, **arguments)
        if result["isError"]:
            raise AssertionError(result)
        answer = json.loads(result["content"][0]["text"])
        if result.get("structuredContent", answer) != answer:
            raise AssertionError("the text and the object differ")
        return answer

    def end(self):
        self.process.stdin.close()
        status = self.process.wait(PATIENCE_S)
        self.process.stdout.close()
        self.errors.close()
        return status

    def kill(self):
        self.process.kill()
        self.process.wait()
        self.process.stdin.close()
        self.process.stdout.close()
        self.errors.close()


def fields_below(schema):
    """All schemas within one, itself among them."""
    return [schema] + [each for field in schema.get("properties", {}).values() for each in fields_below(field)]


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.outside = pathlib.Path(folder.name)
        self.root = self.outside / "root"
        self.root.mkdir()
        self.edits = self.outside / "edits"
        self.deck = self.root / "sheet.k"
        decks.write_sheet(self.deck, COLUMNS, ROWS)
        self.before = self.deck.read_bytes()

    def client(self, *more, version="2025-06-18", **how):
        client = Client(self.root, self.edits, *more, **how)
        self.addCleanup(lambda: client.process.poll() is None and client.kill())
        client.shake_hands(version)
        return client

    def by_program(self, edits):
        """The bytes of the deck after these edits by the command line."""
        script = self.outside / "script.jsonl"
        script.write_text("".join(json.dumps(edit) + "\n" for edit in edits))
        status, _, err = decks.program("edit", self.deck, "--script", script, "-o", self.outside / "program.k")
        self.assertEqual(status, 0, err)
        return (self.outside / "program.k").read_bytes()

    def assertRefused(self, words, result):
        self.assertTrue(result["isError"], result)
        self.assertIn(words, result["content"][0]["text"])


class Session(InFolder):
    def test_a_whole_session(self):
        client = self.client()
        opened = client.do("open_deck", path="sheet.k", length_unit="mm")
        self.assertEqual((opened["document"], opened["nodes"], opened["quality"]["elements"]), ("d1", (COLUMNS + 1) * (ROWS + 1), COLUMNS * ROWS))
        description = client.do("describe", document="d1")
        self.assertEqual([(part["id"], part["name"], part["thickness"]) for part in description["parts"]], [(1, "sheet", 1.5), (2, "bar", None)])
        by_program = decks.program_json("check", self.deck, "--length-unit", "mm")[0]
        self.assertEqual(client.do("check_quality", document="d1"), by_program)
        selected = client.do("select", document="d1", expr="45-60,70", ids=3)
        self.assertEqual((selected["selected_nodes"], selected["node_ids"]), (17, [45, 46, 47]))
        report = client.do("edit", document="d1", edit=LIFT)
        self.assertTrue(report["ok"] and 0 < report["nodes_moved"] <= 17)
        client.do("edit", document="d1", edit={"edit": "relax", "mode": "full"})
        client.do("undo", document="d1")
        difference = client.do("diff", document="d1")
        self.assertEqual(difference["nodes_moved"], report["nodes_moved"])
        saved = client.do("save", document="d1", path="new/pulled.k")
        self.assertEqual(saved["files_written"], [str(self.root / "new" / "pulled.k")])
        edits = [{"edit": "select", "expr": "45-60,70"}, LIFT]
        self.assertEqual((self.root / "new" / "pulled.k").read_bytes(), self.by_program(edits))
        self.assertEqual(client.do("redo", document="d1")["nodes_moved"] > 0, True)
        listed = client.do("list_edits", document="d1", first=2, count=2)
        self.assertEqual((listed["edits"], [(each["number"], each["edit"]["edit"]) for each in listed["shown"]]), (5, [(2, "translate"), (3, "relax")]))
        client.do("save", document="d1", path="relaxed.k")
        self.assertEqual((self.root / "relaxed.k").read_bytes(), self.by_program([*edits, {"edit": "relax", "mode": "full"}]))
        closed = client.do("close", document="d1")
        self.assertEqual((closed["closed"], closed["unsaved_edits"]), ("d1", 0))
        self.assertRefused("no document \"d1\" is open", client.call("describe", document="d1"))
        self.assertEqual(self.deck.read_bytes(), self.before)
        self.assertEqual(sorted(path.name for path in self.root.rglob("*")), ["new", "pulled.k", "relaxed.k", "sheet.k"])
        self.assertEqual(client.end(), 0)

    def test_a_killed_server_loses_nothing(self):
        client = self.client()
        client.do("open_deck", path="sheet.k", target_size=4)
        client.do("select", document="d1", expr="45-60,70")
        client.do("edit", document="d1", edit=LIFT)
        client.do("undo", document="d1")
        client.do("redo", document="d1")
        edit_list = client.do("list_edits", document="d1")["edit_list"]
        # killed in the middle of an edit that is never answered
        client.write(b'{"jsonrpc": "2.0", "id": 99, "method": "tools/call", "params": {"name": "edit", "arguments": {"document": "d1", "edit": {"edit": "repair", "scope": "all"}}}}')
        client.kill()
        lines = pathlib.Path(edit_list).read_text().splitlines()
        self.assertIn(len(lines), (4, 5))
        pathlib.Path(edit_list).write_text("".join(line + "\n" for line in lines[:4]))
        status, _, err = decks.program("replay", edit_list, self.deck, "-o", self.outside / "replayed.k")
        self.assertEqual(status, 0, err)
        edits = [{"edit": "select", "expr": "45-60,70"}, LIFT]
        self.assertEqual((self.outside / "replayed.k").read_bytes(), self.by_program(edits))
        # a line that was being written
        with open(edit_list, "a") as file:
            file.write('{"edit": "transl')
        client = self.client()
        told = client.do("open_deck", path="sheet.k")
        self.assertEqual([(each["edit_list"], each["edits"]) for each in told["left_by_servers_that_ended"]], [(edit_list, 4)])
        client.do("close", document="d1")
        back = client.do("open_deck", path="sheet.k", recover=True)
        self.assertEqual((back["recovered_edits"], back["edit_list"], back["target_size"]), (4, edit_list, 4))
        client.do("save", document="d2", path="recovered.k")
        self.assertEqual((self.root / "recovered.k").read_bytes(), self.by_program(edits))
        client.do("edit", document="d2", edit={"edit": "lift", "distance": 0.5})
        # another server may not have the list that this one writes
        self.assertRefused("no edits of this deck are left", self.client().call("open_deck", path="sheet.k", recover=True))
        self.assertEqual(client.end(), 0)
        self.assertEqual(len(pathlib.Path(edit_list).read_text().splitlines()), 5)
        # a list that was damaged stays, and is told
        whole = pathlib.Path(edit_list).read_bytes()
        pathlib.Path(edit_list).write_bytes(b"no JSON\n" + whole)
        self.assertRefused("isn't a list of edits any more", self.client().call("open_deck", path="sheet.k", recover=True))
        self.assertEqual(self.client().do("open_deck", path="sheet.k")["left_by_servers_that_ended"][0]["edits"], 6)
        pathlib.Path(edit_list).write_bytes(whole)
        self.deck.write_bytes(b"$ another\n" + self.before)
        self.assertRefused("the deck has changed since", self.client().call("open_deck", path="sheet.k", recover=True))
        self.assertEqual(len(pathlib.Path(edit_list).read_text().splitlines()), 5)

    def test_an_edit_that_cannot_be_written_is_taken_back(self):
        client = self.client(limit=len(self.before) + 4096)
        edit_list = client.do("open_deck", path="sheet.k")["edit_list"]
        client.do("select", document="d1", expr="45-60,70")
        full = client.call("edit", document="d1", edit={"edit": "select", "expr": ",".join(["45-60"] * 16_000)})
        self.assertRefused("couldn't be written", full)
        self.assertRefused("takes no more edits", client.call("edit", document="d1", edit=LIFT))
        self.assertEqual(client.do("describe", document="d1")["selected"]["nodes"], 17)
        self.assertEqual(len(pathlib.Path(edit_list).read_text().splitlines()), 1)
        client.do("save", document="d1", path="as_it_was.k")
        self.assertEqual((self.root / "as_it_was.k").read_bytes(), self.before)

    def test_what_is_refused_says_where(self):
        client = self.client()
        bad = self.root / "bad.k"
        bad.write_text(self.before.decode().replace("%8d%16.3f" % (7, 30), "%8d%16s" % (7, "thirty")))
        line = 1 + bad.read_text().splitlines().index(next(line for line in bad.read_text().splitlines() if "thirty" in line))
        self.assertRefused(f"{bad}:{line}: ", client.call("open_deck", path="bad.k"))
        client.do("open_deck", path="sheet.k")
        self.assertRefused("\"lyft\"", client.call("edit", document="d1", edit={"edit": "lyft"}))
        self.assertRefused("expression:3: ", client.call("select", document="d1", expr="7,?"))
        self.assertRefused("isn't possible here", client.call("edit", document="d1", edit={"edit": "repair", "on_cancel": "keep"}))
        self.assertEqual(client.do("list_edits", document="d1")["edits"], 0)

    def test_a_recovery_needs_what_the_edits_were_made_with(self):
        criteria = 'name = "ours"\n[metrics.warpage]\nwarn_above = %d\nfail_above = 80\n'
        settings = self.root / "sheet.k.prismesh.toml"
        other, ours, points, named = (self.root / name for name in ("other.k", "ours.toml", "points.csv", "named.toml"))
        other.write_text("*KEYWORD\n*INCLUDE\nother_part.k\n*END\n")
        part = self.root / "other_part.k"
        decks.write_sheet(part, 3, 3)
        ours.write_text(criteria % 70)
        named.write_text(criteria % 60)
        points.write_text("1,2,3\n")
        settings.write_text('criteria = "named.toml"\n')
        client = self.client()
        edit_list = client.do("open_deck", path="sheet.k", criteria="ours.toml")["edit_list"]
        client.do("edit", document="d1", edit={"edit": "replace_part", "part": 1, "deck": "other.k", "with": 1})
        client.do("undo", document="d1")
        client.do("edit", document="d1", edit={"edit": "set_criteria", "criteria": "named.toml", "on": "1"})
        self.assertRefused("no weld can be made", client.call("edit", document="d1", edit={"edit": "weld", "points_file": "points.csv"}))
        client.end()
        client = self.client()
        for path in (ours, named, other, part, settings):
            held = path.read_bytes()
            for change in (lambda: path.write_bytes(held + b"\n"), path.unlink):
                change()
                self.assertRefused(f"{path}: has changed since the edits", client.call("open_deck", path="sheet.k", recover=True))
            path.write_bytes(held)
        points.unlink()  # what an edit named that wasn't done
        client.do("open_deck", path="sheet.k", recover=True)
        self.assertEqual(client.do("list_edits", document="d1")["edits"], 3)
        # settings that weren't there; a file that changed between two edits
        settings.unlink()
        self.assertEqual(client.end(), 0)
        pathlib.Path(edit_list).unlink()
        client = self.client()
        client.do("open_deck", path="sheet.k")
        client.do("edit", document="d1", edit={"edit": "set_criteria", "criteria": "ours.toml"})
        client.end()
        settings.write_text('criteria = "strict"\n')
        client = self.client()
        self.assertRefused(f"{settings}: has changed since", client.call("open_deck", path="sheet.k", recover=True))
        settings.unlink()
        client.do("open_deck", path="sheet.k", recover=True)
        ours.write_text(criteria % 50)
        client.do("edit", document="d1", edit={"edit": "set_criteria", "criteria": "ours.toml", "on": "1"})
        client.end()
        self.assertRefused(f"{ours}: has changed since", self.client().call("open_deck", path="sheet.k", recover=True))

    def test_a_client_that_ends_without_close(self):
        client = self.client()
        edit_list = pathlib.Path(client.do("open_deck", path="sheet.k")["edit_list"])
        client.do("edit", document="d1", edit=LIFT | {"on": "45-60"})
        client.do("save", document="d1", path="new.k")
        client.kill()
        client = self.client()
        left = client.do("open_deck", path="sheet.k")["left_by_servers_that_ended"]
        self.assertEqual(left, [{"edit_list": str(edit_list), "edits": 1, "saved_edits": 1, "saved_as": str(self.root / "new.k")}])
        self.assertEqual(client.do("open_deck", path="sheet.k", recover=True)["recovered_edits"], 1)
        client.do("edit", document="d2", edit={"edit": "lift", "on": "70", "distance": 1})
        client.end()
        self.assertTrue(edit_list.exists())
        client = self.client()
        client.do("open_deck", path="sheet.k", recover=True)
        self.assertEqual(client.do("close", document="d1")["unsaved_edits"], 1)
        client.do("open_deck", path="sheet.k")
        client.do("select", document="d2", expr="1")
        client.do("save", document="d2", path="saved.k")
        client.end()  # nothing is unsaved
        self.assertEqual([path.name for path in self.edits.iterdir() if not path.name.endswith(".closed.jsonl")], [])
        self.assertEqual(len(list(self.edits.iterdir())), 2)

    def test_a_list_that_is_removed(self):
        client = self.client()
        for path in (self.deck, self.root / "other.k"):
            path.write_bytes(self.before)
        edit_list = pathlib.Path(client.do("open_deck", path="sheet.k")["edit_list"])
        client.do("select", document="d1", expr="45-60,70")
        edit_list.unlink()
        self.assertRefused("couldn't be written (the list was removed)", client.call("edit", document="d1", edit=LIFT))
        self.assertEqual(client.do("describe", document="d1")["selected"]["nodes"], 17)
        self.assertEqual(client.do("close", document="d1"), {"closed": "d1", "unsaved_edits": 1, "edit_list": None})
        client.do("open_deck", path="other.k")
        for path in self.edits.iterdir():
            path.unlink()
        self.edits.rmdir()
        client.do("save", document="d2", path="kept.k")
        client.do("close", document="d2")
        client.do("open_deck", path="other.k")
        self.assertEqual(client.end(), 0)

    def test_terminated(self):
        """Nothing temporary stays of a comparison and of a save that are ended by SIGTERM."""
        decks.write_sheet(self.deck, 80, 80)
        temporary = self.outside / "temporary"
        temporary.mkdir()
        for where, tool, arguments in ((temporary, "diff", {}), (self.root / "new", "save", {"path": "new/saved.k"})):
            seen = False
            for _ in range(20):
                client = self.client(environment={"TMPDIR": str(temporary)})
                client.do("open_deck", path="sheet.k")
                client.do("select", document="d1", expr="1")
                client.write(json.dumps({"jsonrpc": "2.0", "id": 99, "method": "tools/call", "params": {"name": tool, "arguments": {"document": "d1", **arguments}}}).encode())
                while not (seen := any(name.startswith((".prismesh-save-", "prismesh-mcp-")) for name in (os.listdir(where) if where.exists() else []))):
                    if select.select([client.process.stdout], [], [], 0)[0]:
                        break
                client.process.send_signal(signal.SIGTERM)
                self.assertEqual(client.process.wait(PATIENCE_S), 0)
                if seen:
                    break
            self.assertTrue(seen)
            self.assertEqual([path for path in (*temporary.iterdir(), *self.root.rglob("*")) if "prismesh-" in path.name], [])

    def test_described_edits_are_those_of_the_core(self):
        import prismesh
        decks.write_sheet(self.root / "tiny.k", 2, 2)
        sheet, tiny = prismesh.open(str(self.deck)), prismesh.open(str(self.root / "tiny.k"))
        document = sheet

        def refused(edit):
            """Why the core refuses it; empty: it doesn't."""
            try:
                document.edit(edit)
                return ""
            except prismesh.Error as error:
                return str(error)

        def known(sentence):
            found = re.search(r"\(known: (.*)\)$", sentence)
            return set(found[1].split(", ")) if found else set()

        rows = {}  # of the pages' tables, by the fields in their first cell
        pages = "".join((pathlib.Path(__file__).parents[2] / "docs" / page).read_text() for page in ("edits.md", "welds.md", "bonds.md", "replacing.md"))
        for line in pages.splitlines():
            if line.startswith("| "):
                for name in re.findall(r"`(\w+)`", line.split("|")[1]):
                    rows.setdefault(name, []).append(line)
        client = self.client()
        edits = client.do("describe_edit")["edits"]
        self.assertEqual(set(edits), known(refused({"edit": "zz"})))
        misread = re.compile(r"must be |has no field|needs the field|there is no edit|known:")
        compared = 0
        for name in edits:
            told = client.do("describe_edit", name=name)
            document = tiny if name == "repair" else sheet  # the waves of the sheet keep a repair busy for long
            example, fields = told["example"], {field["name"]: field for field in told["fields"]}
            self.assertEqual(set(fields), known(refused({"edit": name, "zz": 1})) - {"edit"}, name)
            self.assertLessEqual(set(example), {"edit", *fields})
            if name not in ("branch", "undo", "redo"):
                why = refused({key: value for key, value in example.items()})
                self.assertNotRegex(why, misread, name)
            if why == "" and name not in ("undo", "redo"):
                document.edit("undo")
            for field, about in fields.items():
                where = f"{name} {field}"
                self.assertEqual(sum(key in about for key in ("required", "default", "without")), 1, where)
                if "required" in about:
                    self.assertIn(f'needs the field "{field}"', refused({key: value for key, value in example.items() if key != field}), where)
                self.assertRegex(pages, f'`{field}`|"{field}":', where)
                if "default" in about:
                    text = about["default"] if isinstance(about["default"], str) else json.dumps(about["default"])
                    self.assertTrue(any(re.search(r"(?<!\w)%s(?!\w)" % re.escape(text), row) for row in rows.get(field, [])), f"{where}: {text}")
                    if field in example:
                        continue
                    # the default says nothing new to the core
                    reports = []
                    for edit in (example, {**example, field: about["default"]}):
                        document.edit({"edit": "select", "expr": "1-4" if document is tiny else "45-60,70"})
                        try:
                            reports.append({key: value for key, value in document.edit(edit).items() if key != "ms"})
                            document.edit("undo")
                        except prismesh.Error as error:
                            reports.append(str(error))
                        document.edit("undo")
                    self.assertEqual(reports[0], reports[1], where)
                    compared += isinstance(reports[0], dict)
        self.assertGreater(compared, 30)
        self.assertRefused("there is no edit", client.call("describe_edit", name="lyft"))


class Files(InFolder):
    def test_only_below_the_root(self):
        secret = self.outside / "secret.k"
        secret.write_bytes(self.before)
        (self.root / "link.k").symlink_to(secret)
        (self.root / "out").symlink_to(self.outside)
        (self.root / "dangling.k").symlink_to(self.outside / "made.k")
        for name, include in (("up.k", "../secret.k"), ("through.k", "out/secret.k"), ("missing.k", "../none.k"), ("broken.k", "../broken_outside.k")):
            (self.root / name).write_text(f"*KEYWORD\n*INCLUDE\n{include}\n*NODE\n%8d%16.3f%16.3f%16.3f\n*END\n" % (900001, 1, 2, 3))
        (self.outside / "broken_outside.k").write_text("*KEYWORD\n*NODE\n       1 SECRETWORD\n*END\n")
        (self.outside / "criteria.toml").write_text('name = "SECRETWORD"\n[metrics.warpage]\nwarn_above = 13\nfail_above = 15\n')
        (self.outside / "settings.toml").write_text('criteria = "strict"\n')
        for name, settings in (("judged.k", 'criteria = "../criteria.toml"\n'), ("judged_part.k", '[[parts]]\non = "1"\ncriteria = "out/criteria.toml"\n')):
            (self.root / name).write_bytes(self.before)
            (self.root / (name + ".prismesh.toml")).write_text(settings)
        (self.root / "linked.k").write_bytes(self.before)
        (self.root / "linked.k.prismesh.toml").symlink_to(self.outside / "settings.toml")
        client = self.client()
        refused = "outside the folder"
        for path in ("../secret.k", str(secret), "link.k", "out/secret.k", "up.k", "through.k", "broken.k", "judged.k", "judged_part.k", "linked.k"):
            result = client.call("open_deck", path=path)
            self.assertRefused(refused, result)
            self.assertNotIn("SECRETWORD", json.dumps(result))
        for path in ("nul\0.k", "\ud800.k", "", ".", "x" * 5000, "none.k"):
            self.assertTrue(client.call("open_deck", path=path)["isError"], path)
        client.do("open_deck", path=str(self.deck))
        for path in ("../new.k", str(self.outside / "new.k"), "out/new.k", "dangling.k"):
            self.assertRefused(refused, client.call("save", document="d1", path=path))
        for edit in ({"edit": "replace_part", "part": 1, "deck": str(secret)}, {"edit": "replace_part", "part": 1, "deck": "up.k"}, {"edit": "set_criteria", "criteria": "../criteria.toml"},
                     {"edit": "weld", "points_file": "out/points.csv"}):
            self.assertRefused(refused, client.call("edit", document="d1", edit=edit))
        self.assertRefused(refused, client.call("open_deck", path="sheet.k", criteria="/etc/passwd"))
        self.assertEqual(sorted(path.name for path in self.outside.iterdir()), ["broken_outside.k", "criteria.toml", "edits", "root", "secret.k", "settings.toml"])

    def test_settings_beside_the_deck_hold(self):
        (self.root / "sheet.k.prismesh.toml").write_text('criteria = "strict"\n')
        client = self.client()
        client.do("open_deck", path="sheet.k")
        by_program = decks.program_json("check", self.deck)[0]
        self.assertEqual(client.do("check_quality", document="d1"), by_program)
        client.do("edit", document="d1", edit={"edit": "set_criteria", "criteria": "default"})
        self.assertNotEqual(client.do("check_quality", document="d1")["criteria"], by_program["criteria"])

    def test_no_file_is_replaced_unless_both_sides_say_so(self):
        other = self.root / "other.k"
        other.write_bytes(b"something\n")
        for more in ((), ("--allow-overwrite",)):
            client = self.client(*more)
            client.do("open_deck", path="sheet.k")
            client.do("edit", document="d1", edit={"edit": "translate", "on": "45", "by": [0, 0, 1], "falloff": {"profile": "constant"}})
            for path in ("sheet.k", "other.k"):
                self.assertRefused("exists already", client.call("save", document="d1", path=path))
            if not more:
                self.assertRefused("--allow-overwrite", client.call("save", document="d1", path="sheet.k", overwrite=True))
                self.assertEqual((self.deck.read_bytes(), other.read_bytes()), (self.before, b"something\n"))
                client.do("close", document="d1")
                continue
            moved = self.by_program([{"edit": "translate", "on": "45", "by": [0, 0, 1], "falloff": {"profile": "constant"}}])
            client.do("save", document="d1", path="other.k", overwrite=True)
            self.assertEqual(other.read_bytes(), moved)
            self.assertTrue(client.do("save", document="d1", path="sheet.k", overwrite=True)["saved_over_the_source"])
            self.assertEqual(self.deck.read_bytes(), moved)
            # what is saved isn't done again to the new deck
            edit_list = client.do("list_edits", document="d1")["edit_list"]
            self.assertEqual(client.do("describe", document="d1")["can_undo"], False)
            self.assertEqual(pathlib.Path(edit_list).read_bytes(), b"")

    def test_includes(self):
        (self.root / "inc").mkdir()
        part = self.root / "inc" / "part.k"
        self.deck.rename(part)
        self.deck.write_text("*KEYWORD\n*INCLUDE\ninc/part.k\n*END\n")
        client = self.client()
        client.do("open_deck", path="sheet.k")
        client.do("save", document="d1", path="same.k")
        self.assertEqual((self.root / "same.k").read_bytes(), self.deck.read_bytes())
        edit = {"edit": "translate", "on": "45", "by": [0, 0, 1], "falloff": {"profile": "constant"}}
        client.do("edit", document="d1", edit=edit)
        self.assertRefused("part.k", client.call("save", document="d1", path="moved.k"))
        self.assertEqual(part.read_bytes(), self.before)
        self.assertEqual(sorted(path.name for path in self.root.rglob("*")), ["inc", "part.k", "same.k", "sheet.k"])
        client.do("save", document="d1", path="elsewhere/moved.k")
        script = self.outside / "one.jsonl"
        script.write_text(json.dumps(edit))
        status, _, err = decks.program("edit", self.deck, "--script", script, "-o", self.outside / "program" / "moved.k")
        self.assertEqual(status, 0, err)
        self.assertEqual(decks.files_of(self.root / "elsewhere"), decks.files_of(self.outside / "program"))

    def test_no_save_leaves_the_root_through_a_link(self):
        (self.outside / "folder").mkdir()
        (self.outside / "settings.toml").write_text("outside\n")
        (self.outside / "table.dat").write_text("SECRETWORD\n")
        (self.root / "inc").mkdir()
        (self.root / "inc" / "part.k").write_bytes(self.before)
        (self.outside / "folder" / "part.k").write_text("outside\n")
        main = "*KEYWORD\n*INCLUDE\ninc/part.k\n*END\n"
        self.deck.write_text(main)
        (self.root / "settled.k").write_bytes(self.before)
        (self.root / "settled.k.prismesh.toml").write_text('criteria = "strict"\n')
        (self.root / "tabled.k").write_text(self.before.decode().replace("*END", "*DEFINE_CURVE_FUNCTION\n         1\n*INCLUDE_UNITCELL\ntab.dat\n*END"))
        (self.root / "tab.dat").symlink_to(self.outside / "table.dat")
        for folder in ("v", "t", "c"):
            (self.root / folder).mkdir()
            (self.root / folder / "a.k").write_text(main)
        (self.root / "v" / "inc").symlink_to(self.outside / "folder")
        (self.root / "t" / "a.k.prismesh.toml").symlink_to(self.outside / "settings.toml")
        held = {path: path.read_bytes() for path in (self.outside / "folder" / "part.k", self.outside / "settings.toml")}
        client = self.client("--allow-overwrite")
        for number, (deck, target) in enumerate((("sheet.k", "v/a.k"), ("settled.k", "t/a.k"), ("tabled.k", "c/a.k")), 1):
            client.do("open_deck", path=deck)
            client.do("edit", document=f"d{number}", edit=LIFT | {"on": "45-60"})
            for path in (target, target.replace("a.k", "new.k") if number != 2 else target):
                self.assertRefused("outside the folder", client.call("save", document=f"d{number}", path=path, overwrite=True))
            self.assertEqual((self.root / target).read_text(), main)
        self.assertEqual({path: path.read_bytes() for path in held}, held)
        self.assertEqual(sorted(path.name for path in (self.root / "c").iterdir()), ["a.k"])
        # where nothing leads outside, settings that are written are told
        (self.root / "t" / "a.k.prismesh.toml").unlink()
        saved = client.do("save", document="d2", path="t/a.k", overwrite=True)
        self.assertEqual(sorted(saved["files_written"]), [str(self.root / "t" / "a.k"), str(self.root / "t" / "a.k.prismesh.toml")])

    def test_a_save_over_the_source_that_cannot_be_opened_again(self):
        criteria = self.root / "c.toml"
        criteria.write_text('name = "ours"\n[metrics.warpage]\nwarn_above = 70\nfail_above = 80\n')
        client = self.client("--allow-overwrite")
        edit_list = pathlib.Path(client.do("open_deck", path="sheet.k", criteria="c.toml")["edit_list"])
        client.do("edit", document="d1", edit=LIFT | {"on": "45-60"})
        criteria.unlink()
        saved = client.do("save", document="d1", path="sheet.k", overwrite=True)
        self.assertTrue(saved["saved_over_the_source"] and saved["closed"])
        self.assertIn("c.toml", saved["notes"][-1])
        self.assertNotEqual(self.deck.read_bytes(), self.before)
        self.assertRefused("no document", client.call("describe", document="d1"))
        self.assertFalse(edit_list.exists())
        client.do("open_deck", path="sheet.k")

    def test_a_deck_that_cannot_be_saved_elsewhere(self):
        for folder in ("lib", "v"):
            (self.root / folder).mkdir()
        (self.root / "lib" / "part.k").write_bytes(self.before)
        (self.root / "v" / "main.k").write_text("*KEYWORD\n*INCLUDE\n../lib/part.k\n*END\n")
        client = self.client()
        self.assertIn("../lib/part.k", client.do("open_deck", path="v/main.k")["notes"][0])
        self.assertRefused("outside the main file's folder", client.call("save", document="d1", path="some/new/main.k"))
        self.assertFalse((self.root / "some").exists())
        self.assertNotIn("notes", client.do("open_deck", path="sheet.k"))

    def test_settings_that_cannot_be_checked(self):
        (self.outside / "criteria.toml").write_text('name = "SECRETWORD"\n[metrics.warpage]\nwarn_above = 13\nfail_above = 15\n')
        (self.root / "sheet.k.prismesh.toml").write_text('\ufeffcriteria = "../criteria.toml"\n')  # a mark that one reader of TOML takes
        self.assertRefused("sheet.k.prismesh.toml: not TOML", self.client().call("open_deck", path="sheet.k"))


class Protocol(InFolder):
    def test_versions(self):
        for asked, given in (("2024-11-05", "2024-11-05"), ("2025-03-26", "2025-03-26"), ("2025-06-18", "2025-06-18"), ("1999-01-01", "2025-06-18")):
            client = Client(self.root, self.edits)
            result = client.shake_hands(asked)
            self.assertEqual(result["protocolVersion"], given)
            self.assertEqual((result["serverInfo"]["name"], "tools" in result["capabilities"]), ("prismesh", True))
            self.assertEqual(client.ask("ping")["result"], {})
            tools = client.ask("tools/list")["result"]["tools"]
            self.assertEqual([tool["name"] for tool in tools], ["open_deck", "describe", "select", "edit", "describe_edit", "undo", "redo", "list_edits", "check_quality", "diff", "save", "close"])
            self.assertEqual(("annotations" in tools[0], "title" in tools[0]), (given >= "2025-03-26", given >= "2025-06-18"))
            for tool in tools:
                schema = tool["inputSchema"]
                self.assertEqual((schema["type"], schema["additionalProperties"], set(schema["required"]) <= set(schema["properties"])), ("object", False, True))
                for name, field in schema["properties"].items():
                    self.assertTrue(field["description"], f"{tool['name']} {name}")
                for field in fields_below(schema):
                    self.assertEqual("array" in field["type"], "items" in field, f"{tool['name']} {field}")
            self.assertEqual("structuredContent" in client.call("open_deck", path="sheet.k"), given >= "2025-06-18")
            batch = [{"jsonrpc": "2.0", "id": 70, "method": "ping"}, {"jsonrpc": "2.0", "method": "notifications/x"}, {"jsonrpc": "2.0", "id": 71, "method": "nothing"}]
            client.write(json.dumps(batch).encode())
            answer = json.loads(client.read())
            if given == "2025-03-26":
                self.assertEqual([(each["id"], "result" in each) for each in answer], [(70, True), (71, False)])
            else:
                self.assertEqual((answer["id"], answer["error"]["code"]), (None, -32600))
            self.assertEqual(client.end(), 0)

    def test_errors(self):
        client = Client(self.root, self.edits)
        self.addCleanup(lambda: client.process.poll() is None and client.kill())
        self.assertEqual(client.ask("tools/list")["error"]["code"], -32600)
        self.assertEqual(client.ask("ping")["result"], {})
        self.assertEqual(client.ask("initialize", {})["error"]["code"], -32602)
        client.shake_hands()
        for line, code in ((b"{", -32700), (b"\xff\xfe", -32700), (b'{"jsonrpc": "2.0", "id": NaN, "method": "ping"}', -32700), (b"[" * 100_000, -32700), (b"7", -32600), (b"[]", -32600),
                           (b'{"jsonrpc": "1.0", "id": 1, "method": "ping"}', -32600), (b'{"jsonrpc": "2.0", "id": true, "method": "ping"}', -32600), (b'{"jsonrpc": "2.0", "id": 1}', -32600),
                           (b'{"jsonrpc": "2.0", "id": 1, "method": "tools/call", "params": [1]}', -32602), (b'{"jsonrpc": "2.0", "id": 1, "method": "resources/list"}', -32601),
                           (b'"' + b"x" * (5 << 20) + b'"', -32700)):
            client.write(line)
            answer = json.loads(client.read())
            self.assertEqual((answer["jsonrpc"], answer["error"]["code"]), ("2.0", code), line[:80])
        self.assertEqual(client.ask("ping", number="a text")["id"], "a text")
        call = lambda **params: client.ask("tools/call", params)["error"]  # noqa: E731
        self.assertEqual(call(name="drop_table")["code"], -32602)
        self.assertEqual(call()["code"], -32602)
        for arguments, words in (({}, "path"), ({"path": 7}, "string"), ({"path": "a", "colour": 1}, "colour"), ({"path": "a", "length_unit": "km"}, "mm, m, in"), ({"path": "a", "target_size": 0}, "greater than 0"),
                                 ({"path": "a", "recover": 1}, "boolean"), ([], "object")):
            error = call(name="open_deck", arguments=arguments)
            self.assertEqual(error["code"], -32602)
            self.assertIn(words, error["message"])
        self.assertIn("edit", call(name="edit", arguments={"document": "d1", "edit": {"by": 1}})["message"])
        # notifications and answers to nothing aren't answered
        for line in (b'{"jsonrpc": "2.0", "method": "notifications/cancelled", "params": {"requestId": 5}}', b'{"jsonrpc": "2.0", "id": 4, "result": {}}', b"", b"  "):
            client.write(line)
        self.assertEqual(client.ask("ping")["result"], {})

    def test_a_cancelled_edit_changes_nothing(self):
        decks.write_sheet(self.deck, 150, 120)
        client = self.client()
        client.do("open_deck", path="sheet.k")
        arguments = {"document": "d1", "edit": {"edit": "relax", "mode": "full", "scope": "all"}}

        def line(number, method, params):
            return json.dumps({"jsonrpc": "2.0", **({"id": number} if number else {}), "method": method, "params": params}).encode() + b"\n"

        def answered_until(number):
            """The ids that are answered before this one, and whether progress was told."""
            answered, told = [], False
            while (message := json.loads(client.read())).get("id") != number:
                if "id" in message:
                    answered.append(message["id"])
                else:
                    self.assertEqual((message["method"], message["params"]["progressToken"]), ("notifications/progress", "token"))
                    told = True
            return answered, told

        def tried(first, at_once):
            """Two edits, both cancelled: at once, or the first when its progress is told. Returns how many were done nevertheless."""
            edits = client.do("list_edits", document="d1")["edits"]
            both = [line(number, "tools/call", {"name": "edit", "arguments": arguments, "_meta": {"progressToken": "token"}}) for number in (first, first + 1)]
            cancels = [line(None, "notifications/cancelled", {"requestId": number}) for number in (first, first + 1)]
            done = []
            if at_once:
                client.write(b"".join(both + cancels)[:-1])
            else:
                client.write(b"".join(both)[:-1])
                if "id" in (message := json.loads(client.read())):
                    done.append(message["id"])
                client.write(b"".join(cancels)[:-1])
            client.write(line(first + 2, "tools/list", {})[:-1])
            done += answered_until(first + 2)[0]
            # one that was done before its cancel came is answered and kept, the others are neither
            self.assertEqual(client.do("list_edits", document="d1")["edits"] - edits, len(done))
            return len(done)

        self.assertIn(0, (tried(1000 + 10 * turn, True) for turn in range(20)))
        self.assertIn(0, (tried(2000 + 10 * turn, False) for turn in range(20)))

    def test_ids(self):
        client = self.client()
        for number in ("1e999", "-1e999", "1.5", "[1]", "{}", "true", "[" * 985 + "]" * 985, '{"a":' * 300 + "1" + "}" * 300, '"' + "x" * 100_000 + '"'):
            for rest in ('"method": 5', '"method": "ping"', '"method": "tools/call", "params": 7', '"a": 1'):
                client.write(b'{"jsonrpc": "2.0", "id": %b, %b}' % (number.encode(), rest.encode()))
                answer = json.loads(client.read())
                self.assertEqual((answer["id"], answer["error"]["code"]), (None, -32600), number[:20])
        client.write(b'{"jsonrpc": "2.0", "id": 1, "method": "tools/call", "params": {"name": %b}}' % (b"[" * 985 + b"]" * 985))
        self.assertEqual(json.loads(client.read())["error"]["code"], -32602)
        client.do("open_deck", path="sheet.k")
        for depth in range(900, 1000, 3):
            client.write(b'{"jsonrpc": "2.0", "id": 1, "method": "tools/call", "params": {"name": "edit", "arguments": {"document": "d1", "edit": {"edit": "select", "expr": %b}}}}'
                         % (b"[" * depth + b"]" * depth))
            answer = json.loads(client.read())
            self.assertTrue(answer["result"]["isError"] if "result" in answer else answer["error"]["code"] in (-32602, -32700), answer)
        self.assertEqual(client.do("list_edits", document="d1", first=1.0, count=5.0)["edits"], 0)
        self.assertEqual(client.ask("tools/call", {"name": "list_edits", "arguments": {"document": "d1", "first": 1.5}})["error"]["code"], -32602)

    def test_a_batch_is_bounded(self):
        client = self.client(version="2025-03-26")
        for count in (100, 101):
            client.write(json.dumps([{"jsonrpc": "2.0", "id": number, "method": "ping"} for number in range(count)]).encode())
            answer = json.loads(client.read())
            self.assertEqual(len(answer) if count == 100 else answer["error"]["code"], count if count == 100 else -32600)

    def test_a_ping_does_not_wait(self):
        client = self.client()
        client.do("open_deck", path="sheet.k")
        lines = [{"jsonrpc": "2.0", "id": number, "method": "tools/call", "params": {"name": "check_quality", "arguments": {"document": "d1"}}} for number in range(100, 140)]
        client.write(b"\n".join(json.dumps(line).encode() for line in [*lines, {"jsonrpc": "2.0", "id": "ping", "method": "ping"}]))
        order = [json.loads(client.read())["id"] for _ in range(41)]
        self.assertEqual([number for number in order if number != "ping"], list(range(100, 140)))
        self.assertLess(order.index("ping"), 40)

    def test_progress_rises(self):
        from prismesh import mcp
        tools = mcp.Tools(str(self.root), str(self.edits), False)
        tools.open_deck({"path": "sheet.k"}, lambda _fraction, _words: True)
        told = []

        def works(*_arguments, progress):
            """What tells all of its progress, which small decks don't."""
            for fraction in (0, 0.5, 1):
                progress(fraction, "words")
            return {}
        tools.opened["d1"].document = unittest.mock.Mock(save=works)
        with unittest.mock.patch("prismesh.diff", works):
            tools.diff({"document": "d1"}, lambda fraction, _words: told.append(fraction) or True)
        self.assertEqual(told, [0, 0.25, 0.5, 0.5, 0.75, 1])
        tools.shut_down()
        there, here = os.pipe()
        server = mcp.Server(tools, here)
        held, mcp.BETWEEN_PROGRESS_S = mcp.BETWEEN_PROGRESS_S, 0
        self.addCleanup(setattr, mcp, "BETWEEN_PROGRESS_S", held)
        tell = server._progress(1, "token")
        for fraction in (0.2, 0.1, 0.2, 0.7, 0.3, 1.0, 1.0):
            tell(fraction, "words")
        os.close(here)
        with open(there, "rb") as sent:
            self.assertEqual([json.loads(line)["params"]["progress"] for line in sent], [0.2, 0.7, 1.0])

    def test_an_edit_with_a_number_beyond_all(self):
        client = self.client()
        client.do("open_deck", path="sheet.k")
        lift = json.dumps(LIFT).replace("4.125", "1e999", 1)
        self.assertIn("1e999", lift)
        client.write(b'{"jsonrpc": "2.0", "id": 9, "method": "tools/call", "params": {"name": "edit", "arguments": {"document": "d1", "edit": ' + lift.encode() + b"}}}")
        answer = json.loads(client.read())
        self.assertTrue(answer["result"]["isError"], answer)
        self.assertIn("finite", answer["result"]["content"][0]["text"])
        self.assertEqual(client.do("list_edits", document="d1")["edits"], 0)

    def test_malformed_lines(self):
        seed = random.randrange(1 << 32)
        print(f"seed {seed}", file=sys.stderr)
        rnd = random.Random(seed)
        client = self.client()
        client.do("open_deck", path="sheet.k")
        shapes = [json.dumps({"jsonrpc": "2.0", "id": 7, "method": "tools/call", "params": {"name": name, "arguments": arguments}}).encode() for name, arguments in (
            ("select", {"document": "d1", "expr": "1-9"}), ("edit", {"document": "d1", "edit": LIFT}), ("describe", {"document": "d1"}), ("open_deck", {"path": "none.k"}),
            ("list_edits", {"document": "d1", "first": 1}), ("undo", {"document": "d1"}))]
        shapes += [b'{"jsonrpc": "2.0", "id": 8, "method": "initialize", "params": {"protocolVersion": "2025-06-18"}}', b'{"jsonrpc": "2.0", "id": "x", "method": "tools/list"}']
        pieces = [b"{", b"}", b"[", b"]", b'"', b"\\u0000", b"\\ud800", b"null", b"true", b"-", b"1e999", b"9" * 400, b"\xff", b"\0", b",", b":", b"{}", b"[[[[", b"d2", b"NaN"]
        def mangled():
            line = bytearray(rnd.choice(shapes))
            for _ in range(rnd.randint(1, 4)):
                at, what = rnd.randrange(len(line) + 1), rnd.randrange(4)
                if what == 0:
                    line[at:at + rnd.randint(1, 20)] = b""
                elif what == 1:
                    line[at:at] = rnd.choice(pieces)
                elif what == 2 and at < len(line):
                    line[at] = rnd.randrange(256)
                else:
                    line[at:at + rnd.randint(0, 9)] = rnd.choice(pieces)
            return bytes(line).replace(b"\n", b" ")
        answers = 0
        for turn in range(20):
            lines = [mangled() for _ in range(50)]
            mark = f"turn {turn}"
            client.process.stdin.write(b"\n".join(lines) + b"\n" + json.dumps({"jsonrpc": "2.0", "id": mark, "method": "tools/list"}).encode() + b"\n")
            client.process.stdin.flush()
            while True:
                line = client.read()
                self.assertLess(len(line), MAX_ANSWER)
                answer = json.loads(line, parse_constant=lambda word: self.fail(word))
                self.assertEqual(answer["jsonrpc"], "2.0")
                self.assertEqual(("result" in answer) + ("error" in answer), 1, answer)
                self.assertIsInstance(answer["id"], (str, int, type(None)))
                if "error" in answer:
                    self.assertNotEqual(answer["error"]["code"], -32603, "a fault of the server")
                    self.assertTrue(isinstance(answer["error"]["code"], int) and answer["error"]["message"])
                if answer["id"] == mark:
                    break
                answers += 1
        self.assertGreater(answers, 500)
        self.assertEqual(self.deck.read_bytes(), self.before)
        # what was done is what the list says
        edit_list = client.do("list_edits", document="d1")["edit_list"]
        client.do("save", document="d1", path="after.k")
        if pathlib.Path(edit_list).read_bytes():
            status, _, err = decks.program("replay", edit_list, self.deck, "-o", self.outside / "replayed.k")
            self.assertEqual(status, 0, err)
            self.assertEqual((self.root / "after.k").read_bytes(), (self.outside / "replayed.k").read_bytes())

    def test_big_answers_are_bounded(self):
        lines = ["*KEYWORD"]
        for part in range(1, 3001):
            lines += ["*PART", f"part {part} " + "x" * 60, "%10d%10d%10d" % (part, 1, 1)]
        self.deck.write_text("\n".join(lines) + "\n" + self.before.decode().split("\n", 1)[1].replace("%10d%10d%10d" % (1, 1, 1), "%10d%10d%10d" % (4001, 1, 1), 1).replace(
            "%10d%10d%10d" % (2, 2, 1), "%10d%10d%10d" % (4002, 2, 1), 1))
        client = self.client()
        client.do("open_deck", path="sheet.k")
        description = client.do("describe", document="d1", parts=500)
        self.assertEqual(description["part_count"], 3002)
        self.assertEqual(len(description["parts"]) + description["parts_left_out"], 500)
        self.assertEqual(client.do("describe", document="d1", first_part=3002, parts=5)["parts"][0]["id"], 4002)
        client.do("edit", document="d1", edit={"edit": "select_lasso", "outline": [[x / 1e3, (x * x % 7) / 7] for x in range(2_000)], "view": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]})
        result = client.ask("tools/call", {"name": "list_edits", "arguments": {"document": "d1"}})
        self.assertLess(len(json.dumps(result)), 10_000)
        for tool in ("check_quality", "describe"):
            result = client.ask("tools/call", {"name": tool, "arguments": {"document": "d1", **({"parts": 500} if tool == "describe" else {})}})["result"]
            self.assertLessEqual(len(result["content"][0]["text"]), 60_000)
            self.assertLess(len(json.dumps(result)), MAX_ANSWER)


if __name__ == "__main__":
    unittest.main()
