"""What sessions of modeld must do with edits, whatever the format: bring them back after a kill, and undo them."""
import json
import os
import shutil
import signal

from weld_proof import Modeld


def read(path):
    with open(path, newline="") as file:
        return file.read()


def prove_session(programs, folder, deck, edits, after):
    """`deck`: its path; `after`: the text that the command line saved. Killed (SIGKILL) the session saves the same, as does one that opens the deck
    in a sandbox; undone it saves the deck's."""
    prismesh, modeld = programs
    before, suffix = read(deck), os.path.splitext(deck)[1]
    os.makedirs(folder)
    script = os.path.join(folder, "edits.jsonl")
    with open(script, "w") as file:
        file.writelines(json.dumps(edit) + "\n" for edit in edits)
    daemon = Modeld(modeld, prismesh, folder)
    daemon.session("open", deck)
    daemon.session("edit", "--script", script)
    daemon.kill(signal.SIGKILL)
    other = os.path.join(folder, "other")
    shutil.copytree(os.path.join(folder, "state"), os.path.join(other, "state"))
    daemon = Modeld(modeld, prismesh, folder)
    daemon.session("open", deck)
    recovered = os.path.join(folder, "recovered" + suffix)
    daemon.session("save", recovered)
    daemon.kill(signal.SIGTERM)
    assert read(recovered) == after, "recovered, another deck is saved"
    daemon = Modeld(modeld, prismesh, other)
    daemon.session("open", deck)
    for _ in edits:
        daemon.session("undo")
    undone = os.path.join(folder, "undone" + suffix)
    daemon.session("save", undone)
    daemon.kill(signal.SIGTERM)
    assert read(undone) == before, "undone, another deck is saved"
    daemon = Modeld(modeld, prismesh, os.path.join(folder, "third"))
    daemon.session("open", "--sandboxed", deck)
    daemon.session("edit", "--script", script)
    rewritten = os.path.join(folder, "rewritten" + suffix)
    daemon.session("save", rewritten)
    daemon.kill(signal.SIGTERM)
    assert read(rewritten) == after, "rewritten in a sandbox, another deck is saved"
    print("  killed and recovered, or rewritten in a sandbox: the same bytes are saved; undone: the original's")


def added_lines(before, after):
    """The lines that are new. Fails if a line of the deck is gone or has changed its place among the others."""
    old, added, at = before.splitlines(), [], 0
    for line in after.splitlines():
        if at < len(old) and line == old[at]:
            at += 1
        else:
            added.append(line)
    assert at == len(old), f"line {at + 1} of the deck is gone: {old[at]!r}"
    return added
