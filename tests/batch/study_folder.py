"""A study for tests: the sample, a script that presses a bead into its rail, and a plan; and what its results must be."""
import csv
import difflib
import json
import pathlib
import subprocess

LASSO = '{"edit": "select_lasso", "view": [0.001, 0, 0, 0, 0, 0, 0.001, 0, 0, 0.001, 0, 0, 0, 0, 0, 1], "outline": [[0.85, -0.04], [1.2, -0.04], [1.2, 0.04], [0.85, 0.04]], "visible": true}'
BEAD = f"""{{"edit": "only", "on": "1"}}
{{"edit": "translate", "on": {LASSO}, "by": [0, "${{height}}", 0], "grab": [1030, -84, 0], "falloff": {{"profile": "smooth", "along": [0, 0, 1]}}}}
{{"edit": "show", "on": "all"}}
"""


class StudyFolder:
    def __init__(self, programs, folder, plan, script=BEAD, elements=2000):
        self.program = pathlib.Path(programs) / "prismesh"
        self.folder = pathlib.Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.deck, self.script, self.plan = self.folder / "rail.k", self.folder / "bead.jsonl", self.folder / "bead.toml"
        self.results = self.folder / "bead.results"
        subprocess.run([self.program, "sample", "--elements", str(elements), "-o", self.deck], check=True, capture_output=True)
        self.script.write_text(script)
        self.plan.write_text('decks = ["rail.k"]\nscripts = ["bead.jsonl"]\ntarget_size = 30\n' + plan)

    def batch(self, *arguments, **more):
        return subprocess.run([self.program, "batch", self.plan, *arguments], capture_output=True, text=True, **more)

    def table(self):
        with open(self.results / "results.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def faults(self, count):
        """What is wrong with the results of a plan of so many different variants that must all be done."""
        faults = []
        rows = self.table()
        if [row["state"] for row in rows] != ["done"] * count:
            faults.append(f"not all done: {[(row['variant'], row['state'], row['reason']) for row in rows if row['state'] != 'done'][:5]}")
        folders = sorted(path.name for path in (self.results / "variants").iterdir())
        if len(folders) != count or any(name.startswith("work-") for name in folders):
            faults.append(f"{len(folders)} folders: {[name for name in folders if name.startswith('work-')][:5]}")
        listed = json.loads((self.results / "results.json").read_text())["rows"]
        if sorted(row["key"] for row in listed) != folders:
            faults.append("the folders aren't those of the variants")
        if (self.results / "failed").exists() and list((self.results / "failed").iterdir()):
            faults.append("failures are left")
        before = self.deck.read_text().splitlines()
        for row in rows:
            after = (self.results / row["file"]).read_text().splitlines()
            changed = sum(one != other for one, other in zip(before, after))
            if len(before) != len(after) or changed != int(row["lines_changed"]):  # lines were added and removed
                opcodes = difflib.SequenceMatcher(None, before, after, autojunk=False).get_opcodes()
                changed = sum(max(b - a, d - c) for tag, a, b, c, d in opcodes if tag != "equal")
            if changed != int(row["lines_changed"]):
                faults.append(f"variant {row['variant']}: {changed} lines differ, the table says {row['lines_changed']}")
        return faults
