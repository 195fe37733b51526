#!/usr/bin/env python3
"""The page of prismesh-intake in Chromium without a window: pairing, sending a real deck over a line that is cut, going on, the catalogue, an edit
at the station, fetching; what assistive programs are told; no complaint of console or policy. Skipped, aloud, without Chromium.

    page_test.py PROGRAMS [--pictures FOLDER]     PROGRAMS: the folder of the built programs
"""
import hashlib
import json
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
import zipfile

sys.dont_write_bytecode = True
from cutting_line import CuttingLine  # noqa: E402
from devtools import Browser, Failed, Tab, chromium, key_hash  # noqa: E402

MODELS = os.environ.get("PRISMESH_MODELS")
PROGRAMS = pathlib.Path()
PICTURES = None

SMALL_EDIT = {"edit": "translate", "on": "500000-500200", "by": [0.0, 0.0, 0.5], "falloff": {"profile": "constant"}}


class Station:
    """prismesh-intake and modeld in folders of their own."""

    def __init__(self, folder):
        self.folder = folder
        self.runtime, self.state = folder / "run", folder / "state"
        (folder / "station.toml").write_text('[remote]\nlisten = "127.0.0.1:0"\nreserved_gb = 0\n')
        common = ["--runtime-dir", self.runtime, "--state-dir", self.state]
        self.log = open(folder / "station.log", "wb")
        start = lambda *command: subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=self.log, stderr=self.log)
        self.processes = [start(PROGRAMS / "prismesh-intake", *common, "--config", folder / "station.toml"), start(PROGRAMS / "prismesh-modeld", *common)]
        for socket in ("intake.sock", "model.sock"):
            for _ in range(500):
                if (self.runtime / socket).exists():
                    break
                time.sleep(0.02)
        self.port = int(json.loads(self.ask("intake", "code", "--json"))["address"].split(":")[1])

    def ask(self, command, *arguments):
        done = subprocess.run([PROGRAMS / "prismesh", command, *arguments, "--runtime-dir", self.runtime], capture_output=True, text=True)
        if done.returncode != 0:
            raise Failed(f"prismesh {command} {arguments}: {done.stderr}")
        return done.stdout

    def code(self, *rights):
        return json.loads(self.ask("intake", "code", "--json", "--allow", ",".join(rights or ("read", "upload", "remove", "metrics"))))["code"]

    def close(self):
        for process in self.processes:
            process.terminate()
        for process in self.processes:
            process.wait(20)
        self.log.close()


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="page-test-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        cls.station = Station(cls.folder)
        cls.addClassCleanup(cls.station.close)
        cls.browser = Browser(cls.folder / "browser", [key_hash(("127.0.0.1", cls.station.port))])
        cls.addClassCleanup(cls.browser.close)

    def setUp(self):
        self.line = CuttingLine(self.station.port)
        self.addCleanup(self.line.close)
        self.downloads = self.folder / f"downloads-{self.line.port}"
        self.downloads.mkdir()
        self.tab = Tab(self.browser, self.downloads)
        self.url = f"https://127.0.0.1:{self.line.port}/"
        self.tab.open(self.url)

    def paired(self, *rights, name=""):
        self.tab.wait("!document.getElementById('pairing').hidden")
        self.tab.tab_to("#pair-code")
        self.tab.type(self.station.code(*rights))
        self.tab.tab_to("#pair-compared")
        self.tab.key(" ")
        self.tab.tab_to("#pair-name")
        self.tab.type(name or f"browser {self.line.port}")
        self.tab.key("Enter")
        self.tab.wait("document.getElementById('pairing').hidden")
        self.tab.wait_for_text("connected")

    def no_complaints(self, *allowed):
        """Of the console and the policy, but those that a cut line or an awaited answer makes."""
        left = [each for each in self.tab.complaints if not any(each[0] == source and text in each[1] for source, text in allowed)]
        self.assertEqual(left, [])

    MISSES_FILES = ("network", "409 (Conflict)")  # publishing is tried before the files are sent
    LINE_IS_CUT = ("network", "net::ERR_")

    def deck(self, name, sizes, seed=1):
        """A folder with files of bytes that nobody has seen."""
        folder = self.folder / f"{name}-{self.line.port}"
        noise = random.Random(seed * 1000 + self.line.port)
        for path, size in sizes.items():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_bytes(noise.randbytes(size))
        return folder

    def card(self, title):
        return f"[...document.querySelectorAll('#uploads > li')].find((card) => card.querySelector('h3').textContent === {json.dumps(title)})"

    def model_card(self, hash_):
        return f"document.getElementById('model-{hash_}')"

    def newest(self, name):
        """The hash of the newest model of that name that the page shows, once it does."""
        found = f"[...document.querySelectorAll('#models > li')].find((card) => card.querySelector('h3').textContent === {json.dumps(name)})"
        return self.tab.wait(f"{found}?.id")[len("model-") :]

    def click_in(self, hash_, text):
        self.tab.run(f"[...{self.model_card(hash_)}.querySelectorAll('button')].find((each) => each.textContent === {json.dumps(text)}).focus()")
        self.tab.key("Enter")

    def fetch(self, hash_):
        """Fetches a model and returns {path: bytes}."""
        self.click_in(hash_, "Fetch")
        state, path = self.tab.downloaded.get(timeout=30)
        self.assertEqual(state, "completed", self.tab.text())
        with zipfile.ZipFile(path) as archive:
            self.assertIsNone(archive.testzip())
            return {name: archive.read(name) for name in archive.namelist()}

    # --- tests ---

    def test_hashes_as_other_programs_do(self):
        """FIPS 180-4's own examples, and every length about the ends of blocks, in pieces."""
        known = {
            "": "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855",
            "abc": "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad",
            "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq": "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1",
            "a" * 1_000_000: "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0",
        }
        for text, digest in known.items():
            self.assertEqual(self.tab.run(f"import('/page/sha256.js').then(({{sha256OfText}}) => sha256OfText({json.dumps(text)}))"), digest)
        digests = self.tab.run(
            """import('/page/sha256.js').then(({Sha256}) => Array.from({length: 200}, (_, length) => {
                 const sum = new Sha256();
                 const bytes = Uint8Array.from({length}, (_, i) => (7 * i + length) & 255);
                 for (let at = 0, step = 1; at < length; at += step, step = step % 71 + 5) sum.add(bytes.subarray(at, at + step));
                 return sum.hex(); }))"""
        )
        for length, digest in enumerate(digests):
            self.assertEqual(digest, hashlib.sha256(bytes((7 * i + length) & 255 for i in range(length))).hexdigest(), length)
        self.no_complaints()

    def test_a_code_is_read_as_people_type_it(self):
        read = lambda text: self.tab.run(f"import('/page/pairing.js').then(({{readCode}}) => readCode({json.dumps(text)}) ?? null)")
        made = json.loads(self.station.ask("intake", "code", "--json"))
        code, fingerprint = made["code"], made["fingerprint"].upper()
        secret = code[20:]
        for text in (code, code.lower(), code.replace("-", ""), code.replace("0", "o").replace("1", "l"), f"  {code} "):
            self.assertEqual(read(text), {"beginning": " ".join(fingerprint[i : i + 2] for i in range(0, 20, 2)), "secret": secret})
        self.assertEqual(read(secret), {"beginning": "", "secret": secret})
        for text in ("", code[:-1], code + "0", code.replace(code[0], "U", 1), "hello"):
            self.assertIsNone(read(text), text)

    def test_pairing_asks_to_compare_and_says_what_is_wrong(self):
        tab = self.tab
        tab.tab_to("#pair-code")
        tab.type("0000-0000-0000-0000")
        tab.key("Enter")
        tab.wait_for_text("Compare the fingerprint first")
        self.assertEqual(tab.run("document.activeElement.id"), "pair-compared")
        tab.key(" ")
        tab.key("Enter")
        tab.tab_to("#pair-name")
        tab.type("ann")
        tab.key("Enter")
        tab.wait_for_text("Not paired: pairing code: is wrong, or its time is over")
        self.assertEqual(tab.run("document.activeElement.getAttribute('aria-invalid')"), "true")
        self.no_complaints(("network", "403 (Forbidden)"))
        tab.run("document.getElementById('pair-code').value = ''")
        self.paired("read")
        self.assertEqual(tab.run("document.cookie"), "", "no script sees the cookie")
        self.assertTrue(tab.run("document.getElementById('sending').hidden"), "this browser may only read")
        self.assertEqual(tab.run("fetch('/uploads', {method: 'POST', headers: {'Tus-Resumable': '1.0.0', 'Upload-Length': '1'}}).then((answer) => answer.status)"), 403)
        tab.reload()
        tab.wait_for_text("connected")
        self.assertTrue(tab.run("document.getElementById('pairing').hidden"), "the cookie outlives a reload")

    def test_a_cut_line_goes_on_by_itself_and_after_a_reload(self):
        self.paired()
        tab, line = self.tab, self.line
        deck = self.deck("noise", {"main.k": 3_000_000, "parts/door.k": 900_000, "parts/empty.k": 0, "parts/Tür Ω.k": 10})
        total = 3_900_010
        tab.choose_files("#folder", [deck])
        tab.wait("!document.getElementById('set').hidden")
        self.assertEqual(tab.run("document.activeElement.id"), "set-main")
        self.assertEqual(tab.run("document.getElementById('set-main').value"), "main.k")
        tab.run("document.getElementById('set-name').value = 'noise'")
        before = line.to_server
        line.cut_at = before + 1_500_000
        tab.tab_to("#set-send")
        tab.key("Enter")
        tab.wait_for_text("The line is cut; it goes on by itself.")
        line.bytes_per_s = 1_000_000
        line.up()
        tab.wait(f"{self.card('noise')}.innerText.includes('Sends ')")
        tab.wait(f"{self.card('noise')}.querySelector('progress').value > 0.5")
        tab.reload()
        line.bytes_per_s = None
        tab.wait_for_text("Not finished. Choose the same 4 files again to go on.")
        reloaded = line.quiet()
        tab.drop_files("#drop", [deck])
        tab.wait_for_text("Published.")
        self.assertEqual(line.cuts, 1)
        # At least the first chunk isn't sent again; TLS and headers take some bytes.
        self.assertLess(line.to_server - reloaded, total - 1_048_576 + 80_000)
        self.assertLess(line.to_server - before, total + 2 * 2_097_152 + 200_000)
        got = self.fetch(self.newest("noise"))
        self.assertEqual(got, {str(path.relative_to(deck)): path.read_bytes() for path in deck.rglob("*") if path.is_file()})
        self.assertEqual(tab.run("localStorage.getItem('prismesh.uploads')"), "[]", "nothing is remembered any more")
        self.no_complaints(self.MISSES_FILES, self.LINE_IS_CUT)

    def test_what_changed_in_the_meantime_is_sent_anew(self):
        self.paired()
        tab, line = self.tab, self.line
        deck = self.deck("changing", {"main.k": 3_000_000})
        tab.choose_files("#files", [deck / "main.k"])
        tab.tab_to("#set-send")
        line.cut_at = line.to_server + 2_000_000
        tab.key("Enter")
        tab.wait_for_text("The line is cut")
        line.up()
        tab.reload()
        (deck / "main.k").write_bytes(bytes(3_000_000))
        tab.choose_files("#files", [deck / "main.k"])
        tab.wait_for_text("Published.")
        self.assertIn(hashlib.sha256(bytes(3_000_000)).hexdigest(), tab.run(f"fetch('/models/{self.newest('main.k')}').then((answer) => answer.text())"))

    def test_cancelling_and_forgetting_leave_nothing_at_the_station(self):
        self.paired()
        tab, line = self.tab, self.line
        uploads = lambda: int(tab.run("fetch('/metrics').then((answer) => answer.text())").split("\nprismesh_intake_uploads ")[1].split("\n")[0])
        before = uploads()
        for stop in ("Cancel", "Forget it"):
            deck = self.deck(stop.replace(" ", "-"), {"main.k": 3_000_000})
            line.bytes_per_s = 500_000
            tab.choose_files("#files", [deck / "main.k"])
            tab.tab_to("#set-send")
            tab.key("Enter")
            tab.wait("[...document.querySelectorAll('#uploads progress')].some((bar) => bar.value > 0.1)")
            tab.wait(f"(async () => (await (await fetch('/metrics')).text()).includes('prismesh_intake_uploads {before + 1}\\n'))()")
            if stop == "Forget it":
                tab.reload()
                tab.wait_for_text("Not finished.")
            tab.run(f"[...document.querySelectorAll('#uploads button')].find((each) => each.textContent === '{stop}').click()")
            line.bytes_per_s = None
            tab.wait(f"(async () => (await (await fetch('/metrics')).text()).includes('prismesh_intake_uploads {before}\\n'))()")
            self.assertEqual(tab.run("localStorage.getItem('prismesh.uploads')"), "[]")
            if stop == "Cancel":
                tab.wait_for_text("Cancelled.")

    def test_the_catalogue_is_live_and_removing_asks(self):
        self.paired()
        tab = self.tab
        deck = self.deck("live", {"a.k": 1000})
        other = Tab(self.browser, self.downloads)
        other.open(self.url)
        tab, self.tab = self.tab, other
        self.paired(name=f"other {self.line.port}")
        self.tab = tab
        other.choose_files("#files", [deck / "a.k"])
        other.run("document.getElementById('set-name').value = '<b>bold</b> & Ünïcode'")
        other.click("#set-send")
        tab.call("Page.bringToFront")
        hash_ = self.newest("<b>bold</b> & Ünïcode")
        tab.wait_for_text("just now")
        self.click_in(hash_, "Files")
        link = f"{self.model_card(hash_)}.querySelector('.files a')"
        tab.wait(f"{link}?.textContent === 'a.k'")
        tab.run(f"{link}.click()")
        state, path = tab.downloaded.get(timeout=30)
        self.assertEqual((state, pathlib.Path(path).name, pathlib.Path(path).read_bytes()), ("completed", "a.k", (deck / "a.k").read_bytes()))
        self.click_in(hash_, "Remove")
        tab.wait("document.getElementById('question').open")
        self.assertEqual(tab.run("document.activeElement.id"), "question-no", "the answer that changes nothing has the focus")
        tab.key("Escape")
        self.assertFalse(tab.run("document.getElementById('question').open"))
        self.assertTrue(tab.run(f"{self.model_card(hash_)} !== null"))
        self.click_in(hash_, "Remove")
        tab.wait("document.getElementById('question').open")
        tab.tab_to("#question-yes")
        tab.key("Enter")
        for each in (tab, other):
            each.wait(f"{self.model_card(hash_)} === null")
        self.no_complaints(self.MISSES_FILES)

    def test_news_that_come_while_the_list_is_on_its_way_are_kept(self):
        self.paired("read", "upload")
        tab = self.tab
        first, second = (self.deck(name, {"a.k": 500}, seed) for seed, name in ((1, "first"), (2, "second")))
        tab.choose_files("#files", [first / "a.k"])
        tab.click("#set-send")
        self.newest("a.k")
        # Answers to what is listed from now on wait until the test lets them through.
        tab.run(
            """(() => { const own = window.fetch; window.held = new Promise((go) => { window.letGo = go; });
                 window.fetch = async (path, ...rest) => { const answer = await own(path, ...rest);
                   if (String(path).startsWith('/models?')) { window.isHeld = true; await window.held; } return answer; }; })()"""
        )
        tab.run("document.getElementById('search-name').dispatchEvent(new Event('input'))")
        tab.wait("window.isHeld === true")
        tab.choose_files("#files", [second / "a.k"])
        tab.run("document.getElementById('set-name').value = 'late a.k'")
        tab.click("#set-send")
        hash_ = self.newest("late a.k")
        tab.run("window.letGo()")
        tab.run("new Promise((done) => setTimeout(done, 300))")
        self.assertTrue(tab.run(f"{self.model_card(hash_)} !== null"))

    def test_a_revoked_browser_is_told(self):
        self.paired()
        self.station.ask("intake", "revoke", f"browser {self.line.port}")
        self.tab.reload()
        self.tab.wait_for_text("Pair this browser")
        self.paired()
        self.tab.click("#leave")
        self.tab.tab_to("#question-yes")
        self.tab.key("Enter")
        self.tab.wait_for_text("Pair this browser")
        self.assertNotIn(f"browser {self.line.port}", self.station.ask("intake", "tokens"))

    def test_a_real_deck_goes_there_is_edited_and_comes_back(self):
        if not MODELS:
            self.skipTest("PRISMESH_MODELS doesn't name the real decks")
        self.paired()
        tab, line = self.tab, self.line
        deck = pathlib.Path(MODELS) / "wing_ferig"
        line.cut_at = line.to_server + 1_200_000
        tab.drop_files("#drop", [deck])
        tab.wait("!document.getElementById('set').hidden")
        self.assertEqual(tab.run("document.getElementById('set-main').value"), "main.k")
        tab.run("document.getElementById('set-name').value = 'wing'")
        tab.click("#set-send")
        tab.wait_for_text("The line is cut")
        line.up()
        tab.wait_for_text("Published.")
        sent = self.newest("wing")
        # The station edits it.
        self.station.ask("session", "open", "--stored", sent)
        self.station.ask("session", "edit", json.dumps(SMALL_EDIT))
        self.station.ask("session", "save")
        tab.wait_for_text("edited from wing")
        tab.wait(f"{self.model_card(sent)}.innerText.includes('19,243 nodes, 18,317 elements, 4 parts')")
        for each in (sent, self.newest("wing")):
            self.shows_a_picture(each)
        if PICTURES:
            self.tab.size(800, 900)
            self.tab.run("document.querySelector('#uploads button').click(); document.activeElement.blur(); scrollTo(0, 0)")
            self.tab.picture(PICTURES / "catalogue.png")
        edited = self.newest("wing")
        self.assertNotEqual(edited, sent)
        out = self.folder / "edited"
        done = subprocess.run([PROGRAMS / "prismesh", "edit", deck / "main.k", "--edit", json.dumps(SMALL_EDIT), "-o", out / "main.k"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        expected = {str(path.relative_to(out)): path.read_bytes() for path in out.rglob("*") if path.is_file()}
        got = self.fetch(edited)
        self.assertEqual({path: len(bytes_) for path, bytes_ in got.items()}, {path: len(bytes_) for path, bytes_ in expected.items()})
        self.assertEqual(got, expected)
        self.assertNotEqual(got, self.fetch(sent))
        self.no_complaints(self.MISSES_FILES, self.LINE_IS_CUT)

    def shows_a_picture(self, hash_):
        """What `prismesh intake describe` has the kiosk draw; without a kiosk there is none."""
        self.tab.run(f"[...{self.model_card(hash_)}.querySelectorAll('button')][0].focus()")
        self.station.ask("intake", "describe", hash_)
        if (PROGRAMS / "prismesh-kiosk").exists():
            picture = f"{self.model_card(hash_)}.querySelector('img')"
            self.tab.wait(f"{picture}?.complete && {picture}.naturalWidth === 320")
            self.assertEqual(self.tab.run(f"{picture}.alt"), "Picture of wing")
        self.assertTrue(self.tab.run("document.activeElement.textContent === 'Fetch'"), "news don't take the focus away")

    def test_everybody_can_use_it(self):
        """What assistive programs are told, the keyboard, contrast, narrow windows; in both schemes, unpaired and paired."""
        for is_paired in (False, True):
            if is_paired:
                self.paired()
                self.tab.choose_files("#files", [self.deck("shown", {"car.k": 1200})/ "car.k"])
                self.tab.wait("!document.getElementById('set').hidden")
                self.tab.click("#set-send")
                self.newest("car.k")
                self.tab.choose_files("#files", [self.deck("shown", {"car.k": 1300})/ "car.k"])
                self.tab.wait("!document.getElementById('set').hidden")
            with self.subTest(paired=is_paired):
                self.names()
                self.keyboard()
                for scheme in ("light", "dark"):
                    self.tab.scheme(scheme)
                    self.contrast(scheme)
                    for width in (320, 360, 1280):
                        self.tab.size(width, 900)
                        self.assertLessEqual(self.tab.run("document.documentElement.scrollWidth"), width, "nothing is cut off")
                        if PICTURES and width != 320:
                            self.tab.picture(PICTURES / f"{'paired' if is_paired else 'pairing'}-{scheme}-{width}.png")
        self.no_complaints(self.MISSES_FILES)

    def names(self):
        roles = {"button", "link", "textbox", "searchbox", "combobox", "checkbox", "progressbar", "image", "option", "DisclosureTriangle", "dialog", "main", "region"}
        nodes = self.tab.named_nodes()
        controls = [node for node in nodes if node[0] in roles]
        self.assertGreater(len(controls), 5)
        self.assertEqual([node for node in controls if not node[1].strip() and node[0] != "main"], [])
        buttons = [name for role, name in controls if role == "button"]
        self.assertEqual(sorted(set(buttons)), sorted(buttons), "two buttons of one name do different things")
        levels = self.tab.run("[...document.querySelectorAll('h1, h2, h3')].filter((it) => it.checkVisibility()).map((it) => Number(it.tagName[1]))")
        self.assertEqual(levels[0], 1)
        self.assertTrue(all(after - before <= 1 for before, after in zip(levels, levels[1:])), levels)
        self.assertEqual(self.tab.run("document.documentElement.lang"), "en")
        self.assertEqual(self.tab.run("[...document.querySelectorAll('[id]')].length"), self.tab.run("new Set([...document.querySelectorAll('[id]')].map((it) => it.id)).size"))

    def keyboard(self):
        """Tab reaches every control once, and each shows that it has the focus."""
        tab = self.tab
        controls = "[...document.querySelectorAll('a, button, input, select, summary')].filter((it) => it.checkVisibility() && !it.disabled)"
        tab.run("document.activeElement.blur(); window.reached = new Set(); scrollTo(0, 0)")
        count = tab.run(f"{controls}.length")
        for _ in range(count + 3):
            tab.key("Tab")
            shown = tab.run(
                "(() => { const it = document.activeElement; if (it === document.body) return true; reached.add(it);"
                " const style = getComputedStyle(it); return style.outlineStyle !== 'none' && parseFloat(style.outlineWidth) >= 2; })()"
            )
            self.assertTrue(shown, tab.run("document.activeElement.outerHTML"))
        self.assertEqual(tab.run(f"{controls}.filter((it) => !reached.has(it)).map((it) => it.outerHTML)"), [])
        small = f"{controls}.filter((it) => it.tagName === 'BUTTON' || it.type === 'checkbox').filter((it) => it.getBoundingClientRect().height < 24).length"
        self.assertEqual(tab.run(small), 0, "targets are large enough for a finger")

    def contrast(self, scheme):
        """Of each text that is seen with its ground (WCAG 2.2, 1.4.3)."""
        faint = self.tab.run(
            """(() => {
              const numbers = (colour) => colour.match(/[\\d.]+/g).map(Number);
              const light = ([r, g, b]) => [r, g, b].map((c) => c / 255).map((c) => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)
                .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
              const ground = (it) => {
                for (; it; it = it.parentElement) {
                  const colour = numbers(getComputedStyle(it).backgroundColor);
                  if (colour.length === 3 || colour[3] === 1) return colour;
                }
                return [255, 255, 255];
              };
              return [...document.querySelectorAll('body *')].filter((it) => it.checkVisibility() && [...it.childNodes].some((each) => each.nodeType === 3 && each.data.trim()))
                .map((it) => {
                  const [one, other] = [light(numbers(getComputedStyle(it).color)), light(ground(it))];
                  return [it.textContent.slice(0, 40), (Math.max(one, other) + 0.05) / (Math.min(one, other) + 0.05)];
                }).filter(([, ratio]) => ratio < 4.5);
            })()"""
        )
        self.assertEqual(faint, [], scheme)


if __name__ == "__main__":
    PROGRAMS = pathlib.Path(sys.argv.pop(1)).resolve()
    if "--pictures" in sys.argv:
        at = sys.argv.index("--pictures")
        PICTURES = pathlib.Path(sys.argv.pop(at + 1))
        sys.argv.pop(at)
        PICTURES.mkdir(parents=True, exist_ok=True)
    if not chromium():
        print("SKIPPED: the page isn't tried in a browser: chromium isn't installed")
        sys.exit(77)
    unittest.main(verbosity=2)
