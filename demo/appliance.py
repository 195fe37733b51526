"""What a station does on its own: the document survives the loss of its daemon, and the doctor says what the machine needs."""
import json
import subprocess

from programs import Stop, edit, program, session, tell

GRADES = {"good": "good", "note": "to know", "bad": "to mend"}


def survive(station):
    """Kills modeld with an unsaved edit, starts it as systemd does, and compares the documents."""
    edit(edit="translate", on="all", by=[0, 0, 1])
    before = session("state")
    station.kill("modeld")
    station.start("modeld", ["session", "state"])
    after = session("state")
    ours = ("path", "nodes", "shells", "selected_nodes", "journalled_edits", "counts")
    lost = [key for key in ours if before[key] != after[key]]
    if lost:
        raise Stop(f"after modeld was killed, the document has another {', '.join(lost)}")
    tell("\nmodeld    killed with an unsaved edit and started again, as systemd does: the deck is open with every edit")
    session("undo")


def examine(station):
    """What `prismesh doctor` says of this machine as a station."""
    said = subprocess.run([program("prismesh"), "--json", "doctor"], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    findings = json.loads(said.stdout)["findings"]
    tell(f"doctor    {len(findings)} things that a station needs, on this machine:")
    for grade, word in GRADES.items():
        names = [finding["what"] for finding in findings if finding["grade"] == grade]
        if names:
            tell(f"  {word:8}  {', '.join(names)}")
    tell("  prismesh doctor says what to do; docs/appliance.md leads from a bare Debian to a station")
