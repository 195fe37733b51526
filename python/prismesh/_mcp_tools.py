"""The tools of the server of prismesh.mcp: decks that are open, what is done to them, and where files may lie."""
from __future__ import annotations

import contextlib
import filecmp
import json
import os
import tempfile
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import prismesh
from prismesh._mcp_edit_list import EditList, content_of, content_or_none_of, left_of
from prismesh._mcp_edits import EDITS

Progress = Callable[[float, str], bool]
Answer = dict[str, Any]
MAX_OPEN = 8
MAX_EDIT_SHOWN = 2_000  # characters
BUILT_IN_CRITERIA = ("default", "strict", "skew_and_thickness")
SETTINGS = ".prismesh.toml"  # stands behind a deck's name in that of its settings


class Refused(Exception):
    """A tool can't do it; the sentence says why."""


def part_of(progress: Progress, begin: float, end: float) -> Progress:
    """The progress of the part of the work from `begin` to `end`."""
    return lambda fraction, words: progress(begin + fraction * (end - begin), words)


def leads_up(name: str) -> bool:
    return name == os.pardir or name.startswith(os.pardir + os.sep)


@dataclass
class Opened:
    """A deck that is open."""

    document: prismesh.Document
    path: str
    options: dict[str, Any]
    files: list[str]
    names: list[str]  # of its files and of those that a save copies along, relative to its folder, the main one first
    edits: EditList
    done: list[Answer] = field(default_factory=list)  # the edits with what came of them
    saved_at: int = 0  # how many edits there were at the last save
    takes_no_edits: str = ""  # why


class Tools:
    def __init__(self, root: str, edits_folder: str, allow_overwrite: bool):
        self.root = os.path.realpath(root)
        self.edits_folder = edits_folder
        self.allow_overwrite = allow_overwrite
        self.opened: dict[str, Opened] = {}
        self._numbers = 0

    def shut_down(self) -> None:
        """Edits that weren't saved stay on disk, where the next opening finds them."""
        for each in self.opened.values():
            with contextlib.suppress(OSError):
                if each.edits.is_empty() or each.saved_at == len(each.done):
                    each.edits.retire()
                else:
                    each.edits.release()
        self.opened.clear()

    # --- where files may lie ---

    def _is_inside(self, path: str) -> bool:
        return os.path.commonpath([os.path.realpath(path), self.root]) == self.root

    def _inside(self, path: str, folder: str | None = None) -> str:
        """The path without symbolic links, if it lies below the root; relative to `folder`, or to the root."""
        try:
            whole = os.path.join(folder or self.root, path)
            os.fsencode(whole)
            if "\0" not in whole and self._is_inside(whole):
                return os.path.realpath(whole)
        except (UnicodeError, ValueError, OSError):
            raise Refused("the path isn't one that a file can have") from None
        raise Refused(f"{path}: lies outside the folder that this server may use, {self.root}")

    def _existing_file(self, path: str, folder: str | None = None) -> str:
        whole = self._inside(path, folder)
        if not os.path.isfile(whole):
            raise Refused(f"{whole}: there is no such file")
        return whole

    def _check_settings(self, deck: str) -> None:
        """The settings beside a deck, and the criteria files that they name, lie below the root too."""
        for name in self._criteria_of_settings(deck):
            self._inside(name, os.path.dirname(deck))

    def _criteria_of_settings(self, deck: str) -> list[str]:
        file = deck + SETTINGS
        if not os.path.lexists(file):
            return []
        self._inside(file)
        try:
            with open(file, "rb") as opened:
                settings = tomllib.load(opened)
        except OSError:
            return []  # the opening says what is wrong
        except (ValueError, RecursionError) as error:
            raise Refused(f"{file}: not TOML: {error}") from None  # what isn't understood here can't be checked
        parts = settings.get("parts")
        tables = [settings, *(parts if isinstance(parts, list) else [])]
        return [table["criteria"] for table in tables if isinstance(table, dict) and isinstance(table.get("criteria"), str)]

    def _inputs(self, deck: str, options: Answer) -> dict[str, str | None]:
        """The hashes of what a deck is opened with beside its own files: the settings beside it, also that there are none, and criteria files."""
        named = [os.path.join(os.path.dirname(deck), each) for each in self._criteria_of_settings(deck) if each not in BUILT_IN_CRITERIA]
        if options.get("criteria", BUILT_IN_CRITERIA[0]) not in BUILT_IN_CRITERIA:
            named.append(options["criteria"])
        return content_or_none_of([deck + SETTINGS, *named])

    @contextlib.contextmanager
    def _nothing_told_of_outside(self, deck: str) -> Iterator[None]:
        try:
            yield
        except prismesh.Error as error:
            if error.file and error.file != "expression" and not self._is_inside(os.path.join(os.path.dirname(deck), error.file)):
                raise Refused(f"{deck}: names a file outside the folder that this server may use, {self.root}") from None
            raise

    def _open(self, path: str, progress: Progress, **options: Any) -> tuple[prismesh.Document, list[str], list[str]]:
        """Opens a deck all of whose files lie below the root. Of a file outside nothing is told but that."""
        self._check_settings(path)
        with self._nothing_told_of_outside(path):
            document = prismesh.open(path, progress=progress, **options)
        folder = os.path.dirname(path)
        info = document.info()
        files = [os.path.join(folder, each) for each in info["files"]]
        for each in files:
            if not self._is_inside(each):
                document.close()
                raise Refused(f"{path}: includes a file outside the folder that this server may use, {self.root}")
        return document, files, [os.path.relpath(os.path.join(folder, each), folder) for each in [*files, *info["companions"]]]

    def _with_safe_paths(self, opened: Opened, edit: Answer, progress: Progress) -> tuple[Answer, dict[str, str | None]]:
        """The edit with the files that it names as whole paths, so that a replay from anywhere finds them; and the hashes of what it reads."""
        folder = os.path.dirname(opened.path)
        edit = dict(edit)
        kind = edit.get("edit")
        reads: list[str] = []
        if kind == "repair" and edit.get("on_cancel") == "keep":
            raise Refused('repair: "on_cancel": "keep" isn\'t possible here, since the list of edits couldn\'t say how far it came')
        if kind == "replace_part" and isinstance(edit.get("deck"), str):
            edit["deck"] = self._existing_file(edit["deck"], folder)
            if "mesh" not in edit:
                variant, reads, _ = self._open(edit["deck"], progress)
                variant.close()
        if kind == "weld" and isinstance(edit.get("points_file"), str):
            edit["points_file"] = self._existing_file(edit["points_file"], folder)
            reads = [edit["points_file"]]
        if kind == "set_criteria" and isinstance(edit.get("criteria"), str) and "text" not in edit and edit["criteria"] != "deck":
            edit["criteria"] = self._criteria(edit["criteria"], folder)
            if edit["criteria"] not in BUILT_IN_CRITERIA and os.path.isabs(edit["criteria"]):
                reads = [edit["criteria"]]
        return edit, content_or_none_of(reads)

    def _criteria(self, name: str, folder: str) -> str:
        """The name of a built-in set as it is; of a file its whole path."""
        if "/" in name or name.endswith(".toml"):
            return self._existing_file(name, folder)
        whole = self._inside(name, folder)
        return whole if name not in BUILT_IN_CRITERIA and os.path.isfile(whole) else name

    # --- the tools ---

    def _of(self, arguments: Answer) -> Opened:
        name = arguments["document"]
        if name not in self.opened:
            raise Refused(f"no document \"{name[:80]}\" is open; " + (f"open are {', '.join(self.opened)}" if self.opened else "open_deck opens one"))
        return self.opened[name]

    def _summary(self, name: str) -> Answer:
        opened = self.opened[name]
        info = opened.document.info()
        check = opened.document.check()
        return {
            "document": name, "path": opened.path, "format": info["format"], "length_unit": info["length_unit"], "target_size": info["target_size"],
            "nodes": info["nodes"], "elements": info["elements"], "parts": len(info["parts"]), "warnings": info["warnings"],
            "quality": {key: check[key] for key in ("elements", "ok", "warn", "fail")}, "edit_list": opened.edits.path,
        }

    def open_deck(self, arguments: Answer, progress: Progress) -> Answer:
        if len(self.opened) >= MAX_OPEN:
            raise Refused(f"{MAX_OPEN} decks are open, and no more can be; close one")
        path = self._existing_file(arguments["path"])
        options = {key: arguments[key] for key in ("length_unit", "target_size") if key in arguments}
        if "criteria" in arguments:
            options["criteria"] = self._criteria(arguments["criteria"], self.root)
        left = left_of(self.edits_folder, path)
        wanted = arguments.get("recover", False)
        try:
            if wanted and not left:
                raise Refused(f"{path}: no edits of this deck are left by a server that ended")
            if wanted:
                opened = self._recovered(path, left[0], progress)
                left.pop(0)
            else:
                opened = self._begun(path, options, progress)
        finally:
            others = [{"edit_list": each.path, "edits": each.count(), **{key: each.about[key] for key in ("saved_edits", "saved_as") if key in each.about}} for each in left]
            for each in left:
                each.release()
        self._numbers += 1
        name = f"d{self._numbers}"
        self.opened[name] = opened
        answer = self._summary(name)
        answer["recovered_edits"] = len(opened.done)
        answer["left_by_servers_that_ended"] = others
        if above := [each for each in opened.names if leads_up(each)]:
            answer["notes"] = [f"the deck names {above[0]}, which lies outside the main file's folder, so it can't be saved to a new file, only over the source"]
        return answer

    def _begun(self, path: str, options: Answer, progress: Progress) -> Opened:
        inputs = self._inputs(path, options)
        document, files, names = self._open(path, progress, **options)
        try:
            return Opened(document, path, options, files, names, EditList.begin(self.edits_folder, path, options, content_of(files), inputs))
        except BaseException:
            document.close()
            raise

    def _recovered(self, path: str, edits: EditList, progress: Progress) -> Opened:
        """Does the edits of a list again, if all files that they were made with are as they were."""
        options = edits.about["options"]
        known = edits.about["inputs"]
        try:
            for each in known:
                self._inside(each)
            now = {**content_or_none_of(list(known)), **self._inputs(path, options)}
        except OSError as error:
            raise Refused(f"{error.filename}: {error.strerror}") from None
        for each in {**known, **now}:
            if known.get(each, "") != now[each]:
                raise Refused(f"{each}: has changed since the edits in {edits.path} were made; \"prismesh replay\" applies what still fits")
        document, files, names = self._open(path, part_of(progress, 0, 0.5), **options)
        try:
            if edits.about["files"] != content_of(files):
                raise Refused(f"{path}: the deck has changed since the edits in {edits.path} were made; \"prismesh replay\" applies what still fits")
            saved_at = edits.about.get("saved_edits", 0)
            opened = Opened(document, path, options, files, names, edits, saved_at=saved_at if isinstance(saved_at, int) else 0)
            try:
                wanted = edits.edits()
            except ValueError:
                raise Refused(f"{edits.path}: isn't a list of edits any more") from None
            for number, edit in enumerate(wanted, 1):
                told = part_of(progress, 0.5 + 0.5 * (number - 1) / len(wanted), 0.5 + 0.5 * number / len(wanted))
                try:
                    safe, _ = self._with_safe_paths(opened, edit, part_of(told, 0, 0.5))
                    self._note(opened, edit, document.edit(safe, progress=part_of(told, 0.5, 1)))
                except prismesh.Cancelled:
                    raise
                except (prismesh.Error, Refused) as error:
                    raise Refused(f"{edits.path}:{number}: this edit can't be done again: {error}") from None
            return opened
        except BaseException:
            document.close()
            raise

    def describe(self, arguments: Answer, _progress: Progress) -> Answer:
        opened = self._of(arguments)
        info, check, state = opened.document.info(), opened.document.check(), opened.document.state
        check.pop("parts", None)
        first, count = arguments.get("first_part", 1), arguments.get("parts", 100)
        parts = info.pop("parts")
        return {
            **info, "part_count": len(parts), "first_part": first, "parts": parts[first - 1:first - 1 + count], "quality": check,
            "selected": {"nodes": len(state.selected_nodes), "shells": len(state.selected_shells)}, "edits": len(opened.done),
            "unsaved_edits": len(opened.done) - opened.saved_at, "can_undo": opened.document.can_undo, "can_redo": opened.document.can_redo,
        }

    @staticmethod
    def _note(opened: Opened, edit: Answer, report: Answer) -> None:
        text = json.dumps(edit)
        shown = edit if len(text) <= MAX_EDIT_SHOWN else {"edit": edit["edit"], "too_long": f"{len(text)} characters; the edit list has all"}
        opened.done.append({"number": len(opened.done) + 1, "edit": shown,
                            **{key: report[key] for key in ("nodes_moved", "elements_added", "elements_removed") if key in report}})

    def _apply(self, opened: Opened, edit: Answer, progress: Progress) -> Answer:
        """Does an edit and writes it to the list. What can't be written isn't kept."""
        if opened.takes_no_edits:
            raise Refused(opened.takes_no_edits)
        edit, inputs = self._with_safe_paths(opened, edit, part_of(progress, 0, 0.5))
        try:
            line = EditList.line_of(edit)  # what can't be written isn't done
        except ValueError:
            raise Refused("the numbers of an edit must be finite") from None
        report = opened.document.edit(edit, progress=part_of(progress, 0.5, 1) if inputs else progress)
        try:
            opened.edits.keep_inputs(inputs)
            opened.edits.append(line)
        except OSError as error:
            back = {"undo": "redo", "redo": "undo"}.get(edit["edit"], "undo")
            with contextlib.suppress(prismesh.Error):
                if edit["edit"] != "branch":
                    opened.document.edit(back)
            opened.takes_no_edits = (f"{opened.edits.path}: an edit couldn't be written ({error.strerror}) and was taken back; the document takes no more edits. "
                                     "Save it under a new name, or close it and open the deck with \"recover\"")
            raise Refused(opened.takes_no_edits) from None
        self._note(opened, edit, report)
        return report

    def select(self, arguments: Answer, progress: Progress) -> Answer:
        opened = self._of(arguments)
        edit = {"edit": "select", "expr": arguments["expr"], "kind": arguments.get("kind", "node"), "mode": arguments.get("mode", "set")}
        report = self._apply(opened, edit, progress)
        state, shown = opened.document.state, arguments.get("ids", 100)
        nodes, shells = state.selected_nodes, state.selected_shells
        return {**report, "selected_nodes": len(nodes), "selected_shells": len(shells), "node_ids": nodes[:shown].tolist(), "shell_ids": shells[:shown].tolist()}

    def edit(self, arguments: Answer, progress: Progress) -> Answer:
        return self._apply(self._of(arguments), arguments["edit"], progress)

    def describe_edit(self, arguments: Answer, _progress: Progress) -> Answer:
        name = arguments.get("name")
        if name is None:
            return {"edits": {each: does for each, (does, _, _) in EDITS.items()}}
        if name not in EDITS:
            raise Refused(f"there is no edit \"{name[:80]}\"; the edits are {', '.join(EDITS)}")
        does, fields, example = EDITS[name]
        return {"edit": name, "does": does, "fields": fields, "example": example}

    def undo(self, arguments: Answer, progress: Progress) -> Answer:
        return self._apply(self._of(arguments), {"edit": "undo"}, progress)

    def redo(self, arguments: Answer, progress: Progress) -> Answer:
        return self._apply(self._of(arguments), {"edit": "redo"}, progress)

    def list_edits(self, arguments: Answer, _progress: Progress) -> Answer:
        opened = self._of(arguments)
        first = arguments.get("first", 1)
        return {"edits": len(opened.done), "edit_list": opened.edits.path, "first": first, "shown": opened.done[first - 1:first - 1 + arguments.get("count", 100)],
                "can_undo": opened.document.can_undo, "can_redo": opened.document.can_redo}

    def check_quality(self, arguments: Answer, _progress: Progress) -> Answer:
        return self._of(arguments).document.check(arguments.get("select"), chordal=arguments.get("chordal", False))

    def diff(self, arguments: Answer, progress: Progress) -> Answer:
        opened = self._of(arguments)
        with tempfile.TemporaryDirectory(prefix="prismesh-mcp-") as folder:
            copy = os.path.join(folder, os.path.basename(opened.path))
            opened.document.save(copy, progress=part_of(progress, 0, 0.5))
            with self._nothing_told_of_outside(opened.path):  # the deck on disk may have changed
                return {"compared_with": opened.path, **prismesh.diff(opened.path, copy, progress=part_of(progress, 0.5, 1))}

    def save(self, arguments: Answer, progress: Progress) -> Answer:
        opened = self._of(arguments)
        target = self._inside(arguments["path"])
        if os.path.isdir(target):
            raise Refused(f"{target}: is a folder; name the deck's file")
        exists = os.path.lexists(target)
        if exists and not arguments.get("overwrite", False):
            raise Refused(f"{target}: exists already; give another name")
        if exists and not self.allow_overwrite:
            raise Refused(f"{target}: exists already, and this server was started without --allow-overwrite; give another name")
        self._check_written(opened, target)
        answer = self._save_over(opened, target, progress) if exists else self._save_new(opened, target, progress)
        opened.saved_at = len(opened.done)
        with contextlib.suppress(OSError):  # the list tells less then, but the deck is saved
            opened.edits.keep(saved_edits=opened.saved_at, saved_as=target)
        if target in (os.path.realpath(each) for each in opened.files):
            answer["saved_over_the_source"] = True
            self._begin_anew(opened, arguments["document"], answer)
        return {"path": target, **answer}

    def _check_written(self, opened: Opened, target: str) -> None:
        """Of all that a save reads and writes, links followed: the deck's files, those that it copies along, and the settings."""
        source_folder, parent = os.path.dirname(opened.path), os.path.dirname(target)
        for number, name in enumerate(opened.names):
            source = os.path.join(source_folder, name)
            # a name that leads up isn't copied
            final = target if number == 0 else source if leads_up(name) else os.path.join(parent, name)
            if not os.path.lexists(source) and number > 0:
                raise Refused(f"{source}: isn't there, or has a name that this server can't check")
            if not self._is_inside(source) or not self._is_inside(final):
                raise Refused(f"{target}: the deck has the file {name}, which leads outside the folder that this server may use, {self.root}")
        for deck in (opened.path, target):
            self._inside(deck + SETTINGS)

    @staticmethod
    def _save_over(opened: Opened, target: str, progress: Progress) -> Answer:
        settings = target + SETTINGS
        before = os.stat(settings) if os.path.exists(settings) else None
        answer = opened.document.save(target, progress=progress)
        after = os.stat(settings) if os.path.exists(settings) else None
        if after and (before is None or (before.st_ino, before.st_mtime_ns) != (after.st_ino, after.st_mtime_ns)) and settings not in answer["files_written"]:
            answer["files_written"].append(settings)
        return answer

    def _save_new(self, opened: Opened, target: str, progress: Progress) -> Answer:
        """Saves beside the target, then gives each file its name where there is none: no file is ever replaced."""
        parent = os.path.dirname(target)
        with contextlib.ExitStack() as undone:
            made: list[str] = []  # folders, the outer ones first
            undone.callback(self._remove_empty, made)
            self._make_folder(parent, made)
            with tempfile.TemporaryDirectory(prefix=".prismesh-save-", dir=parent) as folder:
                main = os.path.join(folder, os.path.basename(target))
                answer = opened.document.save(main, progress=progress)
                names = [os.path.relpath(os.path.join(at, name), folder) for at, _, files in os.walk(folder) for name in files]
                new = []
                for name in sorted(names, key=lambda name: name == os.path.basename(target)):  # the main file last
                    final = os.path.join(parent, name)
                    if not os.path.lexists(final):
                        new.append(name)
                    elif not os.path.isfile(final) or not filecmp.cmp(final, os.path.join(folder, name), shallow=False):
                        raise Refused(f"{final}: exists already with other content, and the deck has a file of this name; save into another folder")
                self._name(new, folder, parent, made)
            undone.pop_all()
        answer["files_written"] = [os.path.join(parent, name) for name in new]
        return answer

    @staticmethod
    def _make_folder(folder: str, made: list[str]) -> None:
        """Makes it, and notes what had to be made."""
        missing = []
        while not os.path.lexists(folder):
            missing.append(folder)
            folder = os.path.dirname(folder)
        for each in reversed(missing):
            os.mkdir(each)
            made.append(each)

    @staticmethod
    def _remove_empty(folders: list[str]) -> None:
        for each in reversed(folders):
            with contextlib.suppress(OSError):
                os.rmdir(each)

    @classmethod
    def _name(cls, names: list[str], folder: str, parent: str, made: list[str]) -> None:
        named: list[str] = []
        try:
            for name in names:
                final = os.path.join(parent, name)
                cls._make_folder(os.path.dirname(final), made)
                try:
                    os.link(os.path.join(folder, name), final)
                except FileExistsError:
                    raise
                except OSError:  # a file system without links
                    if os.path.lexists(final):
                        raise FileExistsError(17, os.strerror(17), final) from None
                    os.rename(os.path.join(folder, name), final)
                named.append(final)
            for at in {os.path.dirname(each) for each in named}:
                descriptor = os.open(at, os.O_RDONLY | os.O_DIRECTORY)
                try:
                    os.fsync(descriptor)
                finally:
                    os.close(descriptor)
        except OSError as error:
            for each in named:
                with contextlib.suppress(OSError):
                    os.unlink(each)
            raise Refused(f"{error.filename or parent}: {error.strerror}; nothing is saved") from None

    def _begin_anew(self, opened: Opened, name: str, answer: Answer) -> None:
        """The deck on disk is what is shown now, so the edits before it must not be done to it again."""
        self._let_go(opened, name)
        try:
            self.opened[name] = self._begun(opened.path, opened.options, lambda _fraction, _words: True)
        except (prismesh.Error, Refused, OSError) as error:
            answer["closed"] = True
            answer["notes"] = [*answer.get("notes", []), f"the deck is saved, but couldn't be opened again, so the document is closed: {error}"]

    def _let_go(self, opened: Opened, name: str) -> str | None:
        """Closes the document, whatever becomes of its list, whose path is returned."""
        opened.document.close()
        del self.opened[name]
        try:
            return opened.edits.retire()
        except OSError:
            return None

    def close(self, arguments: Answer, _progress: Progress) -> Answer:
        opened = self._of(arguments)
        unsaved = len(opened.done) - opened.saved_at
        return {"closed": arguments["document"], "unsaved_edits": unsaved, "edit_list": self._let_go(opened, arguments["document"])}


def _tool(name: str, title: str, description: str, properties: Answer, required: list[str], reads: bool = False, destroys: bool = False) -> Answer:
    return {
        "name": name, "title": title, "description": description,
        "inputSchema": {"type": "object", "properties": properties, "required": required, "additionalProperties": False},
        "annotations": {"title": title, "readOnlyHint": reads, "destructiveHint": destroys, "openWorldHint": False},
    }


_DOCUMENT = {"document": {"type": "string", "description": "the name that open_deck gave, like \"d1\""}}
_PATH = "a path relative to the server's folder, or a whole one below it"

TOOLS = [
    _tool("open_deck", "Open a deck",
          "Opens a deck of LS-DYNA, Nastran, Radioss or Abaqus with its include files. Edits are kept on disk until the document is closed; "
          "\"left_by_servers_that_ended\" lists such edits from before, which \"recover\" does again.",
          {"path": {"type": "string", "description": "the deck's main file: " + _PATH},
           "length_unit": {"type": "string", "enum": ["mm", "m", "in"], "description": "the deck's length unit; without it, it is guessed"},
           "target_size": {"type": ["number", "string"], "exclusiveMinimum": 0,
                           "description": "element edge that quality is judged by: a length in the deck's length unit, \"part\" (each part's median edge) or \"deck\" (the deck's)"},
           "criteria": {"type": "string", "description": f"a built-in set of quality criteria ({', '.join(BUILT_IN_CRITERIA)}), or a criteria file (.toml): {_PATH}"},
           "recover": {"type": "boolean", "description": "do again what a server that ended had done to this deck, newest first; the options are those of then"}},
          ["path"]),
    _tool("describe", "Describe the document",
          "What the document holds now: format, units, counts, parts with thickness (length unit), warnings with file and line, quality figures, selection.",
          {**_DOCUMENT, "first_part": {"type": "integer", "minimum": 1, "description": "the first part to list, counted from 1"},
           "parts": {"type": "integer", "minimum": 0, "maximum": 500, "description": "how many parts to list; default 100"}},
          ["document"], reads=True),
    _tool("select", "Select nodes, elements or parts",
          "Selects by an expression: \"1-100,205,!17\", \"part:3\", \"shell:7\", \"set:17\", \"file:bumper.k\", \"all\". It counts as an edit, which undo takes back.",
          {**_DOCUMENT, "expr": {"type": "string", "description": "the expression; bare numbers are the deck's ids"},
           "kind": {"type": "string", "enum": ["node", "element", "part"], "description": "what bare ids are; default node"},
           "mode": {"type": "string", "enum": ["set", "add", "subtract", "intersect"], "description": "how it is combined with the selection; default set"},
           "ids": {"type": "integer", "minimum": 0, "maximum": 1000, "description": "how many ids to list; default 100"}},
          ["document", "expr"]),
    _tool("edit", "Apply an edit",
          f"Applies one edit, completely or not at all: {{\"edit\": \"translate\", \"by\": [0, 0, 2.5]}}. Edits: {', '.join(EDITS)}; describe_edit tells their fields. "
          "Lengths and positions are in the deck's length unit, angles in degrees, ids the deck's own. Paths in edits are relative to the deck's folder. "
          f"Built-in criteria: {', '.join(BUILT_IN_CRITERIA)}. A wrong name or field is told with the nearest known one.",
          {**_DOCUMENT, "edit": {"type": "object", "required": ["edit"],
                                 "properties": {"edit": {"type": "string", "description": "which edit"},
                                                "on": {"type": ["string", "object"], "description": "what to act on, an expression or a selecting edit; without it, the selection"},
                                                "by": {"type": ["array", "string"], "items": {"type": "number"}, "description": "translate, slide, move: [x, y, z], in the deck's length unit; select_region: what bounds it"},
                                                "distance": {"type": "number", "description": "lift: along the surface's normal, in the deck's length unit"},
                                                "degrees": {"type": "number", "description": "rotate, move: the angle in degrees"}},
                                 "description": "the edit with its fields"}},
          ["document", "edit"]),
    _tool("describe_edit", "Describe an edit", "The fields of an edit with their defaults, units and an example; without a name, all edits with what they do.",
          {"name": {"type": "string", "description": "the edit, like \"translate\""}}, [], reads=True),
    _tool("undo", "Undo", "Takes the last edit back, also one that selects.", _DOCUMENT, ["document"]),
    _tool("redo", "Redo", "Does again what undo took back.", _DOCUMENT, ["document"]),
    _tool("list_edits", "List the edits", "The edits since the deck was opened, undo and redo among them, and the file on disk that keeps them.",
          {**_DOCUMENT, "first": {"type": "integer", "minimum": 1, "description": "the first to list, counted from 1"},
           "count": {"type": "integer", "minimum": 1, "maximum": 200, "description": "how many to list; default 100"}}, ["document"], reads=True),
    _tool("check_quality", "Check the quality",
          "Element quality: how many elements are ok, warn and fail; each metric's least, mean and greatest value and its worst element; mass and time step in the deck's units.",
          {**_DOCUMENT, "select": {"type": "string", "description": "an expression of elements; without it, all"},
           "chordal": {"type": "boolean", "description": "also measure the chordal deviation, in the deck's length unit"}}, ["document"], reads=True),
    _tool("diff", "Compare with the file on disk", "What the document differs in from the deck on disk: nodes moved, the largest displacement (length unit), elements, lines.", _DOCUMENT,
          ["document"], reads=True),
    _tool("save", "Save to a new file",
          "Writes the deck with its include files to a new file; only the lines of what changed are new. A file that exists is never replaced, unless \"overwrite\" is true and the "
          "server was started with --allow-overwrite.",
          {**_DOCUMENT, "path": {"type": "string", "description": "the new main file: " + _PATH},
           "overwrite": {"type": "boolean", "description": "replace a file that exists; default false"}}, ["document", "path"], destroys=True),
    _tool("close", "Close the document", "Frees the document. Edits that weren't saved aren't in any deck, but their list stays on disk.", _DOCUMENT, ["document"], destroys=True),
]
