"""Reads what a program prints for --help: its usage, arguments, options and commands."""
import re
import subprocess
from dataclasses import dataclass, field


@dataclass
class Entry:
    """An option, or an argument without dashes."""
    names: list
    value: str  # what follows the name; empty for a flag
    text: str
    choices: list = field(default_factory=list)
    required: bool = False
    repeated: bool = False
    excludes: list = field(default_factory=list)


@dataclass
class Command:
    path: list  # the program's name, then those of the commands
    what: str = ""
    usage: str = ""
    arguments: list = field(default_factory=list)
    options: list = field(default_factory=list)
    commands: list = field(default_factory=list)
    closing: str = ""

    def walk(self):
        """This command and all below it."""
        yield self
        for command in self.commands:
            yield from command.walk()


SECTIONS = {"Positionals:": "arguments", "Options:": "options", "Subcommands:": "commands"}


class UnknownForm(Exception):
    """A help text that isn't written as expected: then nothing is generated, instead of half a page."""


def parse_entry(head, text):
    """`-o,--output TEXT REQUIRED` and its explanation."""
    head, _, excluded = head.partition(" Excludes: ")
    words = head.split(" Needs: ")[0].split()
    entry = Entry(names=words[0].split(","), value="", text=text, excludes=excluded.split())
    entry.required = "REQUIRED" in words
    entry.repeated = "..." in words
    entry.value = " ".join(word for word in words[1:] if word not in ("REQUIRED", "..."))
    kind, colon, form = entry.value.partition(":")
    if kind in ("UINT", "INT", "FLOAT"):
        entry.value = "N"
    elif colon:  # what the parser checks: {one,of,these} or a form
        entry.value = form
        if form.startswith("{"):
            entry.choices = form.strip("{}").split(",")
            entry.value = "|".join(entry.choices)
    elif entry.value == "TEXT":
        form = re.match(r"([A-Z]+(?:,[A-Z]+)+): |(WxH)\b", text)  # an explanation may begin with the value's form
        entry.value = (form[1] or form[2]) if form else entry.names[-1].lstrip("-").replace("-", "_").upper()
        entry.text = text.removeprefix(f"{entry.value}: ")
    if " " in entry.value:
        raise UnknownForm(f"the value of: {head}")
    return entry


def listed_words(text):
    """The words of a list in an explanation: `display profile: mono, anaglyph or a file` gives mono and anaglyph."""
    text = re.sub(r"\([^)]*\)", "", text.split(";")[0])
    items = [each.strip() for each in re.split(r",? or |, |: ", text)]
    words = [each for each in items if re.fullmatch(r"[a-z][a-z0-9-]*", each)]
    return words if len(words) >= 2 and 2 * len(words) >= len(items) else []


def entries(lines):
    """(head, text) of each entry of a section. The text stands behind two blanks or more, or on the following lines, farther in."""
    found = []
    for line in lines:
        if re.match(r" {2}\S", line):
            head, _, text = re.match(r"  (.*?)(\s{2,}|$)(.*)$", line).groups()
            found.append([head, text])
        elif line.startswith("   ") and found:
            found[-1][1] = (found[-1][1] + " " + line.strip()).strip()
        else:
            raise UnknownForm(f"neither an entry nor its text: {line!r}")
    return found


def parse(path, text, help_of):
    """help_of(path) gives the help text of a command below."""
    command = Command(path=path)
    if text.startswith("usage: "):
        return parse_daemon(command, text)
    blocks = {}
    section = "head"
    for line in text.splitlines():
        if line in SECTIONS:
            section = SECTIONS[line]
        elif line == "":
            section = "closing" if section not in ("head", "closing") else section
        else:
            blocks.setdefault(section, []).append(line)
    for line in blocks.get("head", []):
        if line.startswith("Usage: "):
            words = line.removeprefix("Usage: ").split()
            command.usage = " ".join(path + words[len(path):])
        elif command.usage == "":
            command.what = (command.what + " " + line).strip()
        else:
            raise UnknownForm(f"after the usage of {' '.join(path)}: {line!r}")
    if command.usage == "":
        raise UnknownForm(f"{' '.join(path)} --help has no usage")
    command.arguments = [parse_entry(*each) for each in entries(blocks.get("arguments", []))]
    command.options = [parse_entry(*each) for each in entries(blocks.get("options", []))]
    command.closing = "\n".join(blocks.get("closing", []))
    for head, _ in entries(blocks.get("commands", [])):
        below = path + [head]
        command.commands.append(parse(below, help_of(below), help_of))
    return command


def parse_daemon(command, text):
    """The daemons' shorter form: a usage that names the values, and a line for each option."""
    usage, *rest = text.splitlines()
    command.usage = usage.removeprefix("usage: ")
    values = dict(re.findall(r"\[(--[a-z-]+) ([A-Z]+)\]", usage))
    for head, what in entries(rest):
        command.options.append(Entry(names=[head], value=values.get(head, ""), text=what))
    for name in ("--help", "--version"):
        command.options.append(Entry(names=[name], value="", text={"--help": "print the usage", "--version": "print the version"}[name]))
    return command


def run(program, *arguments):
    return subprocess.run([program, *arguments], check=True, capture_output=True, text=True, stdin=subprocess.DEVNULL).stdout


def read(program, name):
    """Everything that the program's help says, of its commands too."""
    def help_of(path):
        return run(program, *path[1:], "--help")
    return parse([name], help_of([name]), help_of)


def version(program):
    return run(program, "--version").split()[-1]
