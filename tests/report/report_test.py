#!/usr/bin/env python3
"""`prismesh report`: its page is read by Python's parser of HTML, and its figures are compared with `diff --json` and `check --json`.

    report_test.py PROGRAMS
"""
import base64
import html.parser
import json
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import zlib

PROGRAMS = pathlib.Path()
VOID = {"meta", "img", "br", "hr", "link", "input"}
BEAD = [
    {"edit": "select_region", "at": [1030, -84, 0], "angle": 30},
    {"edit": "lift", "distance": 6, "grab": [1030, -84, 0], "falloff": {"profile": "smooth"}},
    {"edit": "repair", "scope": "all"},
]


def prismesh(*arguments):
    return subprocess.run([PROGRAMS / "prismesh", *map(str, arguments)], capture_output=True)


class Page(html.parser.HTMLParser):
    """Elements with their attributes, rows of tables, texts; what isn't closed properly is a fault."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.open, self.elements, self.rows, self.texts, self.faults = [], [], {}, [], []
        self.table, self.cells = None, None
        self.feed(text)
        self.close()
        self.faults += [f"<{tag}> isn't closed" for tag in self.open]

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.elements.append((tag, attributes))
        if tag in VOID:
            return
        self.open.append(tag)
        if tag == "table":
            self.table = self.rows.setdefault(attributes.get("id"), [])
        if tag == "tr":
            self.cells = []
        if tag in ("td", "th"):
            self.cells.append("")

    def handle_startendtag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.faults.append(f"</{tag}> closes nothing, line {self.getpos()[0]}")
        if tag == "tr":
            self.table.append(self.cells)

    def handle_data(self, data):
        self.texts.append(data)
        if self.cells and self.open and "table" in self.open:
            self.cells[-1] += data


def fetched(page):
    """Everything that a browser would load: addresses in attributes and in styles."""
    addresses = [value for _, attributes in page.elements for name, value in attributes.items() if name in ("src", "href", "srcset", "data", "action", "background")]
    return addresses + re.findall(r"url\(([^)]*)\)|@import", " ".join(page.texts))


def png_size(address):
    """Of a whole picture: all checksums fit, and the pixels unpack to what the header says."""
    data = base64.b64decode(address.removeprefix("data:image/png;base64,"), validate=True)
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, pixels, size = 8, b"", None
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8 : at + 8 + length]
        assert struct.unpack_from(">I", data, at + 8 + length)[0] == zlib.crc32(kind + body)
        if kind == b"IHDR":
            size = struct.unpack_from(">II", body)
            channels = {2: 3, 6: 4}[body[9]]
        pixels += body if kind == b"IDAT" else b""
        at += 12 + length
    assert len(zlib.decompress(pixels)) == size[1] * (1 + size[0] * channels)
    return size


class Report(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.a, self.b, self.out = self.folder / "a.k", self.folder / "b.k", self.folder / "report.html"
        self.assertEqual(prismesh("sample", "--elements", 3000, "-o", self.a).returncode, 0)

    def edited(self, edits):
        script = self.folder / "edits.jsonl"
        script.write_text("".join(json.dumps(edit) + "\n" for edit in edits))
        done = prismesh("edit", self.a, "--script", script, "-o", self.b)
        self.assertEqual(done.returncode, 0, done.stderr)
        return script

    def page(self, *more):
        done = prismesh("report", self.a, self.b, "-o", self.out, *more)
        self.assertEqual(done.returncode, 0, done.stderr)
        page = Page(self.out.read_text(encoding="utf-8"))
        self.assertEqual(page.faults, [])
        self.assertEqual([address for address in fetched(page) if not str(address).startswith("data:image/png;base64,")], [])
        policy = [attributes["content"] for tag, attributes in page.elements if attributes.get("http-equiv") == "Content-Security-Policy"]
        self.assertEqual(len(policy), 1)
        self.assertIn("default-src 'none'", policy[0])
        self.assertNotIn("script", [tag for tag, _ in page.elements])
        self.assertEqual([name for _, attributes in page.elements for name in attributes if name.startswith("on")], [])
        return page

    def figures_agree(self, page):
        diff = json.loads(prismesh("diff", self.a, self.b, "--json").stdout)
        rows = {row[0]: row[1:] for row in page.rows["figures"]}
        for side, deck in enumerate((self.a, self.b)):
            # judged by the sizes of the first deck, as the page is
            first = json.loads(prismesh("check", self.a, "--json").stdout)
            sizes = [f"--target-size={part['target_size']}@{part['id']}" for part in first["parts"]]
            check = json.loads(prismesh("check", deck, "--json", *sizes).stdout)
            for name, key in (("shells", "elements"), ("shells that warn", "warn"), ("shells that fail", "fail")):
                self.assertEqual(int(rows[name][side]), check[key], name)
            self.assertAlmostEqual(float(rows["mass"][side]), check["mass"], delta=1e-5 * check["mass"])
            self.assertAlmostEqual(float(rows["least time step"][side]), check["time_step"]["min"], delta=1e-5 * check["time_step"]["min"])
        text = " ".join(page.texts)
        self.assertIn(f"{diff['lines_changed']} differ", rows["lines of the decks"][2])
        self.assertEqual("Shells added, " in text, diff["elements_added"] > 0)
        moves = page.rows.get("moves", [[]])[1:]
        self.assertEqual(len(moves), min(20, diff["nodes_moved"]))
        if moves:
            self.assertAlmostEqual(float(moves[0][1]), diff["max_displacement"], delta=1e-4 * diff["max_displacement"])
            self.assertEqual(f"node:{moves[0][0]}", diff["displacement"]["max_at"])
            for deck, cell in ((self.a, moves[0][2]), (self.b, moves[0][3])):
                card = next(line for line in deck.read_text().splitlines() if line[:8].strip() == moves[0][0] and "." in line[8:24])
                for got, field in zip(map(float, cell.split()), (card[8:24], card[24:40], card[40:56])):
                    self.assertAlmostEqual(got, float(field), delta=1e-3)
        return diff

    def test_its_figures_are_those_of_diff_and_check(self):
        script = self.edited(BEAD)
        page = self.page("--journal", script)
        diff = self.figures_agree(page)
        self.assertGreater(diff["nodes_moved"], 20)
        sizes = [png_size(attributes["src"]) for tag, attributes in page.elements if tag == "img"]
        if (PROGRAMS / "prismesh-kiosk").exists():
            self.assertEqual(sizes, [(960, 600), (960, 600), (1360, 850), (1360, 850)])
        edits = [json.loads(text)["edit"] for text in page.texts if text.startswith("{")]
        self.assertEqual(edits, [edit["edit"] for edit in BEAD])
        metrics = [attributes["data-metric"] for tag, attributes in page.elements if "data-metric" in attributes]
        self.assertEqual(len(metrics), 11)
        again = self.out.read_bytes()
        self.page("--journal", script)
        self.assertEqual(self.out.read_bytes(), again, "the same decks give the same bytes")

    def test_a_change_of_structure_and_no_change(self):
        shells = [line.split()[0] for line in self.a.read_text().split("*ELEMENT_SHELL")[1].splitlines()[1:] if line[:1] == " "]
        for shell in shells[500:]:  # not every shell can be divided
            edit = json.dumps({"edit": "split", "at": [f"shell:{shell}"]})
            if prismesh("edit", self.a, "--edit", edit, "-o", self.b).returncode == 0:
                break
        page = self.page()
        diff = self.figures_agree(page)
        self.assertGreater(diff["elements_added"], 0)
        self.assertIn("Not known. Two decks show what differs, not how it was done", " ".join(page.texts))
        self.b.write_bytes(self.a.read_bytes())
        page = self.page()
        self.assertIn("No node or element differs.", " ".join(page.texts))
        self.assertEqual(self.figures_agree(page)["lines_changed"], 0)

    def test_names_may_hold_anything(self):
        evil = '<script>alert(1)</script>&"\'<img src=x onerror=alert(1)>'
        text = self.a.read_bytes().replace(b"Rail and sill outer", evil.encode() + b"\xff\x01", 1)
        self.a = self.folder / "<b>a & 'b'.k"
        self.a.write_bytes(text)
        self.b = self.folder / "\"><script src=http:x>.k"
        self.b.write_bytes(text)
        page = self.page()
        names = [row[1] for row in page.rows["parts"]]
        self.assertIn(evil + r"\xFF\x01", [name.replace("\\xff", "\\xFF") for name in names])
        self.assertIn("<b>a & 'b'.k", " ".join(page.texts))

    def test_without_a_kiosk_the_page_says_which_pictures_are_missing(self):
        alone = self.folder / "alone"
        alone.mkdir()
        shutil.copy2(PROGRAMS / "prismesh", alone)
        self.edited(BEAD[:2])
        done = subprocess.run([alone / "prismesh", "report", self.a, self.b, "-o", self.out, "--json"], capture_output=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(b"warning: a picture is missing: ", done.stderr)
        self.assertIn("prismesh-station", json.loads(done.stdout)["picture_missing"])
        page = Page(self.out.read_text())
        self.assertEqual([text[:12] for text in page.texts if text.startswith("No picture")], ["No picture: "] * 4)
        self.figures_agree(page)

    def test_of_a_session(self):
        run, state = self.folder / "run", self.folder / "state"
        for each in (run, state):
            each.mkdir(mode=0o700)
        daemon = subprocess.Popen([PROGRAMS / "prismesh-modeld", "--runtime-dir", run, "--state-dir", state], stderr=subprocess.DEVNULL)
        self.addCleanup(daemon.wait)
        self.addCleanup(daemon.terminate)
        while not (run / "model.sock").exists():
            self.assertIsNone(daemon.poll())
            time.sleep(0.02)
        session = lambda *words: prismesh("session", *words, "--runtime-dir", run)
        nothing = session("report", "-o", self.out)
        self.assertEqual((nothing.returncode, nothing.stderr), (1, b"prismesh session: no document is open\n"))
        self.assertEqual(session("open", self.a).returncode, 0)
        unchanged = session("report", "-o", self.out)
        self.assertEqual(unchanged.returncode, 1)
        self.assertIn(b"has no unsaved edits: name the deck before them with --before", unchanged.stderr)
        for edit in BEAD[:2]:
            self.assertEqual(session("edit", json.dumps(edit)).returncode, 0)
        self.assertIn(b"would be replaced", session("report", "-o", self.a).stderr)
        done = session("report", "-o", self.out)
        self.assertEqual(done.returncode, 0, done.stderr)
        page = Page(self.out.read_text(encoding="utf-8"))
        self.assertEqual(page.faults, [])
        self.edited(BEAD[:2])  # the same edits by the command line
        self.figures_agree(page)
        self.assertIn("lift", [text for text in page.texts])
        self.assertIn(b'"changed":true', session("state", "--json").stdout)
        deck = self.a.read_bytes()
        self.assertEqual(session("save").returncode, 0)
        before = self.folder / "before.k"
        before.write_bytes(deck)
        done = session("report", "--before", before, "-o", self.out)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.a = before
        self.figures_agree(Page(self.out.read_text(encoding="utf-8")))

    def test_what_cannot_be_done_is_said_and_writes_nothing(self):
        self.b.write_bytes(self.a.read_bytes())
        (self.folder / "broken.jsonl").write_text('{"edit": "liift"}\n')
        wrong = [
            ([self.a, self.folder / "none.k"], 1, b"none.k"),
            ([self.a, self.b, "--journal", self.folder / "none.jsonl"], 1, b"none.jsonl"),
            ([self.a, self.b, "--journal", self.folder / "broken.jsonl"], 1, b"broken.jsonl:1:"),
            ([self.a, self.b, "--view", "sideways"], 2, b"--view"),
        ]
        for arguments, status, words in wrong:
            done = prismesh("report", *arguments, "-o", self.out)
            self.assertEqual(done.returncode, status, done.stderr)
            self.assertIn(words, done.stderr)
            self.assertFalse(self.out.exists())
        deck = self.a.read_bytes()
        journal = self.folder / "edits.jsonl"
        journal.write_text("")
        for arguments in ([self.a, self.b, "-o", self.a], [self.b, self.a, "-o", self.a], [self.a, self.b, "--journal", journal, "-o", journal]):
            done = prismesh("report", *arguments)
            self.assertEqual(done.returncode, 1)
            self.assertIn(b"would be replaced: name another file with -o", done.stderr)
        self.assertEqual((self.a.read_bytes(), journal.read_bytes()), (deck, b""))
        done = prismesh("report", self.a, self.b, "-o", "/proc/none/report.html")
        self.assertEqual(done.returncode, 1)


if __name__ == "__main__":
    PROGRAMS = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main(verbosity=2)
