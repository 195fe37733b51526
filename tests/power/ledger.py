"""What a session has done, by the lines that it wrote before and after each step, and what a disk may hold by them: a judge that shares no
code with Prismesh. The deck's nodes move along z by amounts that binary and decimal fractions both hold, so positions are compared exactly."""
import hashlib
import json
import pathlib
import random

SIDE = 40  # nodes along an edge of the sheet
NODES = SIDE * SIDE


def write_deck(folder):
    """A sheet of shells whose nodes lie in two files beside the main one: a save in place has three files to replace."""
    folder.mkdir(parents=True)
    half = NODES // 2
    for name, first, last in (("front.k", 1, half), ("back.k", half + 1, NODES)):
        lines = [f"{node:8d}{float((node - 1) % SIDE * 10):16.6f}{float((node - 1) // SIDE * 10):16.6f}{0.0:>16}" for node in range(first, last + 1)]
        (folder / name).write_text("*KEYWORD\n*NODE\n" + "\n".join(lines) + "\n*END\n")
    shells = []
    for row in range(SIDE - 1):
        for column in range(SIDE - 1):
            corner = row * SIDE + column + 1
            shells.append("".join(f"{each:8d}" for each in (len(shells) + 1, 1, corner, corner + 1, corner + SIDE + 1, corner + SIDE)))
    (folder / "main.k").write_text("*KEYWORD\n*INCLUDE\nfront.k\n*INCLUDE\nback.k\n*PART\nsheet\n         1         1         1\n*SECTION_SHELL\n         1         2\n"
                                   "       1.0       1.0       1.0       1.0\n*MAT_ELASTIC\n         1   7.85E-9  210000.0       0.3\n*ELEMENT_SHELL\n"
                                   + "\n".join(shells) + "\n*END\n")


def heights(texts):
    """z of each node, in the order of their ids; texts: the deck's files' contents. Raises ValueError where a file isn't whole."""
    found = {}
    for text in texts:
        inside = False
        if not text.endswith("*END\n"):
            raise ValueError("a file of the deck ends early")
        for line in text.splitlines():
            if line.startswith("*"):
                inside = line.strip() == "*NODE"
            elif inside and not line.startswith("$"):
                found[int(line[:8])] = float(line[40:56])
    if sorted(found) != list(range(1, NODES + 1)):
        raise ValueError(f"the deck has {len(found)} nodes")
    return tuple(found[node] for node in range(1, NODES + 1))


def heights_in(folder):
    return heights([path.read_text() for path in sorted(folder.glob("*.k")) if path.name != "main.k"])


def upload_files(number, seed):
    """The files of an upload: any bytes, intake parses no deck."""
    noise = random.Random(f"{seed} {number}")
    return {path: noise.randbytes(noise.choice((90, 3000, 70000))) for path in ("main.k", "parts/door.k")[:noise.choice((1, 2))]}


def hashes_of(files):
    return {path: hashlib.sha256(content).hexdigest() for path, content in files.items()}


class Ledger:
    """Follows the lines of sessions on one disk. Two steps can be under way at most: one of the editor, one of the sender."""

    def __init__(self):
        self.now = self.saved = (0.0,) * NODES
        self.been = {self.now}
        self.undone = []  # states that undo leads to in this life of modeld
        self.copied = {}  # heights of copies by name
        self.models = {}  # hash: {path: SHA-256}
        self.removed = set()
        self.tokens = []
        self.pending = {}  # by who: the step
        self.edits = []  # (first, last, dz) of all that the document holds; None where that isn't known by intents
        self.acknowledged = {"editor": 0, "sender": 0}

    def read(self, line):
        """Returns what is wrong: none of these steps may be refused."""
        step = json.loads(line)
        who = step.get("who")
        if "refused" in step:
            return [f"{self.pending[who]['do']} was refused: {step['refused']}"]
        if "do" in step:
            self.pending[who] = step
        elif "done" in step:
            self._apply(self.pending.pop(who))
            if "token" in step:
                self.tokens.append(step["token"])
            self.acknowledged[who] += 1
        return []

    def after(self, step):
        """Heights after an editor's step."""
        if step["do"] == "undo":
            return self.undone[-1]
        if step["do"] != "move":
            return self.now
        first, last, by = step["first"], step["last"], step["by"]
        return tuple(z + by if first <= node <= last else z for node, z in enumerate(self.now, 1))

    def _apply(self, step):
        kind = step["do"]
        if kind == "move":
            self.undone.append(self.now)
            self.now = self.after(step)
            self.been.add(self.now)
            self.edits.append((step["first"], step["last"], step["by"]))
        elif kind == "undo":
            self.now = self.undone.pop()
            self.edits.pop()
        elif kind == "save":
            self.saved = self.now
        elif kind == "copy":
            self.copied[step["name"]] = self.now
        elif kind == "publish":
            files = upload_files(step["number"], step["seed"])
            self.models[step["model"]] = hashes_of(files)
            self.removed.discard(step["model"])
        elif kind == "remove":
            self.models.pop(step["model"], None)
            self.removed.add(step["model"])

    def judge(self, out, repaired=True):
        """Compares the facts of a folder (station.py) with what may be there. Returns what is wrong, as sentences, and goes on from what is there."""
        wrong = []
        out = pathlib.Path(out)
        facts = json.loads((out / "facts.json").read_text())
        editing, sending = self.pending.pop("editor", None), self.pending.pop("sender", None)
        wrong += self._judge_deck(out, editing)
        wrong += self._judge_models(facts["models"], sending)
        wrong += [f"a token that was given isn't good any more: {problem}" for problem in facts["void"].values()]
        # Undo leads back to before a restart by what the journal holds; a session undoes its own edits only.
        self.undone = []
        return wrong

    def judge_spoilt(self, out):
        """As judge, where the disk has given back another bit: data may be missing or refused, but nothing may be there that never was."""
        facts = json.loads((out / "facts.json").read_text())
        editing, sending = self.pending.get("editor"), self.pending.get("sender")
        been = self.been | ({self.after(editing)} if editing else set())
        wrong = []
        try:
            if heights_in(out / "copy") not in been:
                wrong.append("the document is as it never was")
        except (ValueError, OSError) as problem:
            wrong.append(f"the document: {problem}")
        sent = dict(self.models)
        if sending and sending["do"] == "publish":
            sent[sending["model"]] = hashes_of(upload_files(sending["number"], sending["seed"]))
        for model, found in facts["models"].items():
            if "refused" not in found and (found["manifest"] != model or found["files"] != sent.get(model)):
                wrong.append(f"the model {model[:8]} has other bytes")
        return wrong

    def _judge_deck(self, out, step):
        wrong = []
        may_be = {self.now: "what was acknowledged"}
        if step:
            may_be.setdefault(self.after(step), "the step under way as well")
        try:
            copy = heights_in(out / "copy")
            if copy not in may_be:
                wrong.append(f"the document isn't what was acknowledged: {self._difference(copy)}")
            elif copy != self.now:
                self._apply(step)
        except (ValueError, OSError) as problem:
            wrong.append(f"the document: {problem}")
        saved = {self.saved}
        if step and step["do"] == "save":
            saved.add(self.now)
        try:
            finished = heights_in(out / "finished")
            if finished not in saved:
                wrong.append("the deck's files aren't those of a save, after modeld's start")
            else:
                self.saved = finished
        except (ValueError, OSError) as problem:
            wrong.append(f"the deck's files, after modeld's start: {problem}")
        wrong += self._judge_found(out / "found", saved)
        for name, state in self.copied.items():
            try:
                if heights_in(out / "copies" / name) != state:
                    wrong.append(f"the copy {name} isn't what was saved")
            except (ValueError, OSError) as problem:
                wrong.append(f"the copy {name}: {problem}")
        return wrong

    def _judge_found(self, folder, saved):
        """The deck's files before modeld has finished a save that was cut off: each by itself is of one save or the other."""
        wrong = []
        for name, part in (("front.k", slice(0, NODES // 2)), ("back.k", slice(NODES // 2, NODES))):
            try:
                text = (folder / name).read_text()
                found = tuple(float(line[40:56]) for line in text.splitlines() if line[:8].strip().isdigit())
                if not text.endswith("*END\n") or found not in {state[part] for state in saved}:
                    wrong.append(f"{name} isn't of an acknowledged save")
            except (ValueError, OSError) as problem:
                wrong.append(f"{name}: {problem}")
        return wrong

    def _difference(self, found):
        nodes = [node for node in range(1, NODES + 1) if found[node - 1] != self.now[node - 1]]
        return f"{len(nodes)} nodes differ, first {nodes[0]} at {found[nodes[0] - 1]} instead of {self.now[nodes[0] - 1]}"

    def _judge_models(self, found, step):
        wrong = []
        may_be_there, may_be_gone = {}, set()
        if step and step["do"] == "publish":
            files = upload_files(step["number"], step["seed"])
            may_be_there[step["model"]] = hashes_of(files)
        elif step and step["do"] == "remove":
            may_be_gone.add(step["model"])
        for model, files in self.models.items():
            if model not in found and model not in may_be_gone:
                wrong.append(f"the published model {model[:8]} is gone")
        for model, facts in found.items():
            files = self.models.get(model) or may_be_there.get(model)
            if "refused" in facts:
                wrong.append(f"the model {model[:8]} isn't given out: {facts['refused']}")
            elif files is None:
                wrong.append(f"the model {model[:8]} " + ("has come back" if model in self.removed else "was never sent"))
            elif facts["manifest"] != model or facts["files"] != files:
                wrong.append(f"the model {model[:8]} has other bytes")
        if step and "model" in step and (step["model"] in found) == (step["do"] == "publish"):
            self._apply(step)
        return wrong
