"""Edit lists on disk: what the server of prismesh.mcp has done to a deck since it was opened, so that nothing is lost when it is killed.

A list is a script of edits, one a line, as `prismesh edit --script` and `prismesh replay` read it. Beside it NAME.json tells which deck it is of, what else
the edits were made with, and what was saved. A line is on disk before the edit is answered. The server holds a lock on each list that it writes, so an
unlocked one was left by a server that ended.
"""
from __future__ import annotations

import contextlib
import errno
import fcntl
import hashlib
import json
import os
import time
from typing import Any

SEVERAL = "several"  # stands for the hash of a file that edits were made with before and after it changed


def content_of(files: list[str]) -> dict[str, str]:
    """The hash of each file."""
    found = {}
    for path in files:
        digest = hashlib.blake2b(digest_size=16)
        with open(path, "rb") as file:
            while piece := file.read(1 << 20):
                digest.update(piece)
        found[path] = digest.hexdigest()
    return found


def content_or_none_of(files: list[str]) -> dict[str, str | None]:
    """The hash of each file; None: there is no such file."""
    return {path: content_of([path])[path] if os.path.isfile(path) else None for path in files}


def _flush_folder(folder: str) -> None:
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


class EditList:
    """One list, locked for as long as this object holds it."""

    def __init__(self, path: str, descriptor: int, about: dict[str, Any]):
        self.path = path
        self.about = about  # the deck, the options it was opened with, its files' hashes, those of other inputs, what was saved
        self._descriptor = descriptor
        self._size = os.fstat(descriptor).st_size

    @classmethod
    def begin(cls, folder: str, deck: str, options: dict[str, Any], files: dict[str, str], inputs: dict[str, str | None]) -> EditList:
        os.makedirs(folder, mode=0o700, exist_ok=True)
        stem = "".join(c if c.isascii() and (c.isalnum() or c in "._") else "_" for c in os.path.basename(deck))[:80]
        about = {"deck": deck, "options": options, "files": files, "inputs": inputs}
        for number in range(1, 1_000_000):
            path = os.path.join(folder, f"{stem}-{time.strftime('%Y%m%dT%H%M%S')}-{os.getpid()}-{number}.jsonl")
            try:
                descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o600)
                break
            except FileExistsError:
                continue
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        _write_about(path, about)
        return cls(path, descriptor, about)

    def keep(self, **more: Any) -> None:
        """Adds to what NAME.json tells. Raises OSError; then it tells what it did before."""
        about = {**self.about, **more}
        self._check_named()
        _write_about(self.path, about)
        self.about = about

    def keep_inputs(self, inputs: dict[str, str | None]) -> None:
        """Adds files that an edit was made with. Edits with two contents of one file can't be done again. Raises OSError."""
        known = self.about.get("inputs", {})
        new = {path: content if known.get(path, content) == content else SEVERAL for path, content in inputs.items()}
        if any(path not in known or known[path] != content for path, content in new.items()):
            self.keep(inputs={**known, **new})

    def _check_named(self) -> None:
        if os.fstat(self._descriptor).st_nlink == 0:
            raise OSError(errno.ENOENT, "the list was removed", self.path)

    @staticmethod
    def line_of(edit: dict[str, Any]) -> bytes:
        return json.dumps(edit, allow_nan=False).encode("ascii") + b"\n"

    def append(self, line: bytes) -> None:
        """Writes the line of an edit and flushes it to disk. Raises OSError; then the list is as it was, if the disk lets it."""
        self._check_named()
        try:
            written = 0
            while written < len(line):
                written += os.pwrite(self._descriptor, line[written:], self._size + written)
            os.fsync(self._descriptor)
        except OSError:
            with contextlib.suppress(OSError):
                os.ftruncate(self._descriptor, self._size)
            raise
        self._size += len(line)

    def count(self) -> int:
        with open(self.path, "rb") as file:
            return file.read().count(b"\n")

    def edits(self) -> list[dict[str, Any]]:
        """What it holds. A line that was being written when its server ended was never answered; it is cut off. Raises ValueError."""
        with open(self.path, "rb") as file:
            text = file.read()
        whole = text[: text.rfind(b"\n") + 1]
        if len(whole) < len(text):
            os.ftruncate(self._descriptor, len(whole))
            os.fsync(self._descriptor)
            self._size = len(whole)
        return [json.loads(line) for line in whole.splitlines()]

    def is_empty(self) -> bool:
        return self._size == 0

    def release(self) -> None:
        """Lets go of the list; it stays as one that a server has left."""
        os.close(self._descriptor)

    def retire(self) -> str | None:
        """Keeps the list under NAME.closed.jsonl, where no opening offers it, and returns that path; None: it was empty, or is gone. Raises OSError."""
        kept = None
        try:
            if self.is_empty():
                os.unlink(self.path)
            else:
                os.rename(self.path, closed_path(self.path))
                kept = closed_path(self.path)
        except FileNotFoundError:
            pass  # somebody has removed it
        finally:
            with contextlib.suppress(OSError):
                os.unlink(about_path(self.path))
            os.close(self._descriptor)
        return kept


def about_path(path: str) -> str:
    return path.removesuffix(".jsonl") + ".json"


def closed_path(path: str) -> str:
    return path.removesuffix(".jsonl") + ".closed.jsonl"


def _write_about(path: str, about: dict[str, Any]) -> None:
    new = path + ".new"
    try:
        with open(new, "w", encoding="ascii") as file:
            json.dump(about, file)
            file.flush()
            os.fsync(file.fileno())
        os.replace(new, about_path(path))
    except OSError:
        with contextlib.suppress(OSError):
            os.unlink(new)
        raise
    _flush_folder(os.path.dirname(path))


def left_of(folder: str, deck: str) -> list[EditList]:
    """The lists of a deck that servers have left, the newest first, locked. Empty ones are removed on the way."""
    left = []
    try:
        names = sorted(os.listdir(folder))
    except OSError:
        return []
    for name in names:
        path = os.path.join(folder, name)
        if not name.endswith(".jsonl") or name.endswith(".closed.jsonl") or not os.path.exists(about_path(path)):
            continue
        try:
            with open(about_path(path), encoding="utf-8") as file:
                about = json.load(file)
            if not isinstance(about, dict) or about.get("deck") != deck or not all(isinstance(about.get(key), dict) for key in ("options", "files", "inputs")):
                continue
            descriptor = os.open(path, os.O_RDWR | os.O_CLOEXEC)
        except (OSError, ValueError):
            continue
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            os.close(descriptor)
            continue
        found = EditList(path, descriptor, about)
        if found.is_empty():
            found.retire()
        else:
            left.append(found)
    return sorted(left, key=lambda each: os.stat(each.path).st_mtime_ns, reverse=True)
