"""The demo's editing session: lift, undo, repair; then stretch, signs, repair, relax, compare, save. Every step tells its counts."""
import json
import shutil
import subprocess

import targets
from programs import Refused, Stop, edit, figures, program, session, shown, tell, tool

MEND_LIMIT_S = 120  # of a repair: a deck whose mesh is bad everywhere may take far longer
MAX_MENDED = 10  # of the shells that failed in the sample as it was made


class Editing:
    """The session on one deck. `out`: the demo's folder."""

    def __init__(self, deck, is_sample, out, with_pictures):
        self.deck, self.is_sample, self.out, self.with_pictures = deck, is_sample, out, with_pictures
        session("open", deck)
        state = session("state")
        self.unit, self.size, self.first = state["length_unit"], state["target_size"], state["counts"]
        self.options = ["--target-size", repr(self.size), "--length-unit", self.unit]
        self.stretched = None  # the deck with the signs
        tell(f"opened    {state['nodes']} nodes, {state['shells']} shells, {state['parts']} parts; unit {self.unit}, target size {self.size:g}; "
             f"{counted(self.first)}")

    # --- steps ---

    def lift(self):
        """Lifts a patch, undoes and redoes it, and repairs what it made worse. Returns whether anything could be lifted."""
        lifts = targets.sample_lift(self.size) if self.is_sample else targets.lifts(self.deck, self.size)
        lift, report, reason = first_done(lifts, self.select_and_lift)
        if lift is None:
            return self.left_out("lifted", reason)
        distance = lift.edit["distance"]
        tell(f"lifted    {lift.what}, by {distance:.3g} {self.unit} along its normal: {report['nodes_moved']} nodes moved; {change(report)}")
        before = session("state")["counts"]
        edit(edit="undo")
        if session("state")["counts"] != self.first:
            raise Stop("undo didn't restore the first state")
        edit(edit="redo")
        if session("state")["counts"] != before:
            raise Stop("redo didn't restore the edited state")
        tell("undone    and redone")
        self.save_lifted(report["nodes_moved"])
        edit(edit="show", on="all")
        self.repair()
        return True

    def select_and_lift(self, lift):
        for select in lift.select:
            edit(**select)
        return edit(**lift.edit)

    def save_lifted(self, moved):
        """Saves a copy and compares it with the deck: exactly the lines of the moved nodes differ."""
        copy = self.save("lifted")
        difference = figures("diff", self.deck, copy)
        # A node that moved by less than the deck's fields hold is where it was.
        wrong = difference["nodes_moved"] > moved or (self.is_sample and difference["nodes_moved"] < moved)
        if wrong or difference["lines_changed"] < difference["nodes_moved"]:
            raise Stop(f"the saved deck differs in {difference['nodes_moved']} nodes, but {moved} were moved")
        tell(f"saved     {shown(copy)}: {difference['lines_changed']} lines differ from the deck's, those of the {difference['nodes_moved']} moved nodes")
        if self.with_pictures and difference["moved"]:
            script = self.out / "moved.jsonl"
            script.write_text(json.dumps({"edit": "select", "expr": difference["moved"]}) + "\n")
            session("edit", "--script", script)
            self.picture("moved.png", "the nodes that moved, as white octahedra")

    def stretch(self):
        """Stretches an end, shows the signs, repairs and relaxes. Returns whether anything could be stretched."""
        stretches = targets.sample_stretch() if self.is_sample else targets.stretches(self.deck)
        stretch, report, reason = first_done(stretches, lambda each: edit(**each.edit))
        if stretch is None:
            return self.left_out("stretched", reason)
        tell(f"stretched {stretch.what}: {report['nodes_moved']} nodes moved; {change(report)}")
        for note in report["notes"]:
            tell(f"          {note}")
        self.stretched = self.save("stretched")
        tell(f"signs     {self.signs(self.stretched)}")
        deselect()
        edit(edit="only", on=stretch.parts)
        self.picture("stretched.png", "the stretched part with its signs: yellow warns, red fails")
        self.repair()
        self.relax()
        if self.is_sample:
            self.mend_sample()
        self.picture("repaired.png", "the same, repaired and relaxed")
        edit(edit="show", on="all")
        return True

    def left_out(self, word, reason):
        """Tells why an edit is left out; the sample has room for all."""
        if self.is_sample:
            raise Stop(f"the sample can't be {word}: {reason}")
        tell(f"{word:9} nothing: {reason}")
        return False

    def repair(self):
        self.mend("repaired", "what edits made worse", edit="repair", scope="damaged")

    def relax(self):
        self.mend("relaxed", "around what is left", edit="relax", scope="damaged")

    def mend(self, word, what, **wanted):
        try:
            report = edit(limit_s=None if self.is_sample else MEND_LIMIT_S, **wanted)
        except Refused as reason:
            tell(f"{word:9} nothing: {reason}")
            return
        structure = f", {report['elements_added']} shells added, {report['elements_removed']} removed" if wanted["edit"] == "repair" else ""
        tell(f"{word:9} {what}: {report['nodes_moved']} nodes moved{structure}; {change(report)}")
        for note in report["notes"]:
            tell(f"          {note}")

    def mend_sample(self):
        """Repairs the shells that failed in the sample as it was made, each with its neighbours."""
        before = session("state")["counts"]["fail"]
        tried = set()
        for _ in range(MAX_MENDED):
            metrics = figures("check", self.save("edited"), *self.options)["metrics"].values()
            worst = next((metric["worst"] for metric in metrics if metric["fail"] > 0 and metric["worst"] not in tried), None)
            if worst is None:
                break
            tried.add(worst)
            edit(edit="select", expr=worst)
            edit(edit="grow", rings=1)
            edit(edit="repair", scope="selection")
        deselect()
        after = session("state")["counts"]
        if before > 0:
            tell(f"repaired  {before} shells that failed in the sample as it was made; {counted(after)}")
        if after["fail"] > 0:
            raise Stop(f"the session ends with {after['fail']} failing shells, and it should end with none")

    def compare(self):
        """Saves the deck, and compares it with the deck as it was."""
        edited = self.save("edited")
        difference = figures("diff", self.deck, edited)
        largest, off = difference["displacement"], difference["surface_distance"]
        tell(f"compared  {difference['nodes_moved']} nodes moved, {difference['nodes_added']} added; {difference['elements_added']} elements added, "
             f"{difference['elements_removed']} removed, {difference['elements_changed']} with other corners")
        if largest and off:
            tell(f"          moved by {largest['max']:.4g} {self.unit} at most ({largest['max_at']}); "
                 f"off the first surface by {off['max']:.4g} {self.unit} at most ({off['max_at']})")
        read = figures("check", edited, *self.options)
        now = session("state")["counts"]
        new = max(0, now["fail"] - self.first["fail"])
        tell(f"saved     {shown(edited)}: {difference['lines_changed']} lines changed; {counted(now)}"
             + ("" if self.is_sample else f", {new} more failing than in the deck as it was" if new else ", none more failing than in the deck as it was"))
        if self.is_sample and read["fail"] > 0:
            raise Stop(f"{read['fail']} shells of the saved deck fail, and none should")
        return edited

    # --- pieces ---

    def save(self, name):
        """Saves a copy into a folder of its own, so that include files keep their names."""
        folder = self.out / name
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        session("save", folder / self.deck.name)
        return folder / self.deck.name

    def signs(self, deck):
        """The signs by kind, as the program counts them in the saved deck: "528 max length (4 fail), 20 taper"."""
        metrics = figures("check", deck, *self.options)["metrics"]
        marked = {name: (m["warn"] + m["fail"], m["fail"]) for name, m in metrics.items() if m["warn"] + m["fail"] > 0}
        words = [f"{count} {name.replace('_', ' ')}" + (f" ({fail} fail)" if fail else "")
                 for name, (count, fail) in sorted(marked.items(), key=lambda item: (-item[1][1], -item[1][0], item[0]))]  # fmt: skip
        return ", ".join(words) or "none"

    def picture(self, name, caption):
        """What the kiosk shows of the session, drawn without a screen."""
        if not self.with_pictures:
            return
        shots = self.out / "shots"
        shutil.rmtree(shots, ignore_errors=True)
        command = [program("prismesh-kiosk"), "--profile", "mono", "--size", "1600x1000", "--headless-frames", "1", "--shots", shots,
                   "--title", caption[0].upper() + caption[1:]]  # fmt: skip
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True, stdin=subprocess.DEVNULL)
        if done.returncode != 0:
            raise Stop(f"prismesh-kiosk said: {done.stderr.strip()}")
        (shots / "frame-0001.png").replace(self.out / name)
        shots.rmdir()
        tell(f"          {shown(self.out / name)}: {caption}")


def deselect():
    edit(edit="select", expr="all", mode="subtract")


def counted(counts):
    return f"{counts['warn']} warn, {counts['fail']} fail"


def change(report):
    before, after = report["before"], report["after"]
    return f"warn {before['warn']} -> {after['warn']}, fail {before['fail']} -> {after['fail']}"


def first_done(candidates, do):
    """Tries one after the other. Returns the first that the program did and that moved something, its report, and otherwise the first reason."""
    reasons = []
    for candidate in candidates:
        try:
            report = do(candidate)
        except Refused as reason:
            reasons.append(str(reason))
            continue
        if report["nodes_moved"] > 0:
            return candidate, report, ""
        reasons.append(f"{candidate.what}: no node moved")
    return None, None, reasons[0] if reasons else "no part has an extent"


RENDERED = [
    ("before.png", "deck", ["--profile", "mono"], "the deck as it was"),
    ("after.png", "edited", ["--profile", "mono"], "the same view after the session"),
    ("displacement.png", "edited", ["--profile", "mono", "--colour", "displacement", "--against", "deck"], "how far nodes are from where they were"),
    ("distance.png", "edited", ["--profile", "mono", "--colour", "distance-to-original", "--against", "deck"], "how far the surface is from the first one"),
    ("woven.png", "edited", ["--profile", "prism-mask"], "both eyes' images woven into columns, for the prism-mask display"),
    ("anaglyph.png", "edited", ["--profile", "anaglyph"], "the same in depth through red-cyan glasses"),
]


def render(deck, edited, out):
    tell("")
    decks = {"deck": deck, "edited": edited}
    for name, which, options, caption in RENDERED:
        tool("render", decks[which], "-o", out / name, "--size", "1600x1000", *(decks.get(option, option) for option in options))
        tell(f"  {str(shown(out / name)):32} {caption}")


def play(deck, is_sample, out, with_pictures):
    """The whole session. Returns the edited deck."""
    editing = Editing(deck, is_sample, out, with_pictures)
    lifted = editing.lift()
    if not (editing.stretch() or lifted):
        raise Stop(f"{deck} has nothing that can be shaped")
    edited = editing.compare()
    if with_pictures:
        render(deck, edited, out)
    return edited
