#!/usr/bin/env python3
"""The man pages and the completion hold everything that the programs print for --help.

Usage: manual_test.py PROGRAMS. It reads the help texts by itself, with patterns of its own, and asks bash what it would complete.
"""
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = {"prismesh": 1, "prismesh-kiosk": 1, "prismesh-modeld": 8, "prismesh-deviced": 8, "prismesh-import": 8, "prismesh-intake": 8,
            "prismesh-setup": 8}


def output(*command, **options):
    return subprocess.run(command, check=True, capture_output=True, text=True, stdin=subprocess.DEVNULL, **options).stdout


def helps(words):
    """The words of a command and its help text, and those of the commands below."""
    text = output(str(programs / words[0]), *words[1:], "--help")
    yield words, text
    for name in re.findall(r"^  ([a-z-]+) ", text.partition("\nSubcommands:\n")[2], re.MULTILINE):
        yield from helps([*words, name])


def options_of(text):
    """The options that a help text explains: those at the beginning of a line."""
    return {name for line in re.findall(r"^  (-\S+)", text, re.MULTILINE) for name in line.split(",")}


def section_heading(words):
    return '\n.SS "' + " ".join(words).replace("-", "\\-") + '"\n'


class Generated(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = Path(cls.folder.name)
        output(sys.executable, "-B", str(ROOT / "scripts/manual/generate.py"), str(programs), str(cls.out))
        cls.helps = [each for name in PROGRAMS for each in helps([name])]

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def page(self, name):
        return (self.out / f"man{PROGRAMS[name]}" / f"{name}.{PROGRAMS[name]}").read_text()

    def completed(self, *words, folder="/"):
        """What bash offers at the end of the words; the last one is completed."""
        script = ('source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); '
                  '"$(complete -p "$1" | sed "s/.*-F \\([^ ]*\\).*/\\1/")"; printf "%s\\n" "${COMPREPLY[@]}"')
        return set(output("bash", "-c", script, "bash", str(self.out / "bash-completion" / words[0]), *words, cwd=folder).split())

    def test_there_are_commands_below_commands(self):
        self.assertIn(["prismesh", "session", "open"], [words for words, _ in self.helps])

    def test_each_command_has_its_section(self):
        for words, _ in self.helps:
            if len(words) > 1:
                with self.subTest(command=words):
                    self.assertIn(section_heading(words), self.page(words[0]))

    def test_each_option_is_in_its_section(self):
        for words, text in self.helps:
            page = self.page(words[0])
            heading = section_heading(words) if len(words) > 1 else "\n.SH OPTIONS\n"
            section = re.split(r"\n\.S[SH] ", page.partition(heading)[2])[0].replace("\\-", "-")
            for option in options_of(text) - ({"-h", "--help"} if len(words) > 1 else set()):
                with self.subTest(command=words, option=option):
                    self.assertIn(f"\\fB{option}\\fR", section)

    def test_each_option_is_completed(self):
        for words, text in self.helps:
            offered = self.completed(*words, "-")
            for option in options_of(text):
                with self.subTest(command=words, option=option):
                    self.assertIn(option, offered)

    def test_each_command_is_completed(self):
        for words, _ in self.helps:
            if len(words) > 1:
                with self.subTest(command=words):
                    self.assertIn(words[-1], self.completed(*words[:-1], words[-1][:1]))

    def test_values_are_completed(self):
        self.assertEqual(self.completed("prismesh", "info", "--length-unit", ""), {"mm", "m", "in"})
        self.assertEqual(self.completed("prismesh", "info", "--length-unit", "=", "m"), {"mm", "m"})
        self.assertEqual(self.completed("prismesh", "render", "a.k", "--view", "t"), {"top"})
        self.assertIn("quality", self.completed("prismesh", "render", "a.k", "--colour", "q"))
        self.assertEqual(self.completed("prismesh", "check", "--select", ""), set())
        self.assertEqual(self.completed("prismesh", "--length-unit", "mm", "session", "--runtime-dir", "/run", "und"), {"undo"})

    def test_files_are_completed(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "rail.k").touch()
            (Path(folder) / "room").mkdir()
            for words in (["prismesh", "info"], ["prismesh", "edit", "a.k", "-o"], ["prismesh", "session", "edit", "--script"],
                          ["prismesh-kiosk", "--open"], ["prismesh-modeld", "--config"]):
                with self.subTest(words=words):
                    self.assertEqual(self.completed(*words, "r", folder=folder), {"rail.k", "room"})
            self.assertEqual(self.completed("prismesh-modeld", "--state-dir", "r", folder=folder), {"room"})

    def test_the_pages_are_set_without_warnings(self):
        for name, section in PROGRAMS.items():
            with self.subTest(page=name):
                done = subprocess.run(["groff", "-man", "-ww", "-Tutf8", str(self.out / f"man{section}" / f"{name}.{section}")],
                                      capture_output=True, text=True, check=True)
                self.assertEqual(done.stderr, "")

    def test_the_same_time_gives_the_same_bytes(self):
        again = self.out / "again"
        output(sys.executable, "-B", str(ROOT / "scripts/manual/generate.py"), str(programs), str(again))
        for name, section in PROGRAMS.items():
            self.assertEqual((again / f"man{section}" / f"{name}.{section}").read_text(), self.page(name))


class Reading(unittest.TestCase):
    def test_refuses_what_it_does_not_understand(self):
        sys.path.insert(0, str(ROOT / "scripts/manual"))
        import help_text
        for text in ("No usage\n", "What.\nUsage: p [OPTIONS]\nand more\n", "W.\nUsage: p\n\nOptions:\n--left  of the margin\n"):
            with self.subTest(text=text), self.assertRaises(help_text.UnknownForm):
                help_text.parse(["p"], text, lambda path: "")


if __name__ == "__main__":
    programs = Path(sys.argv.pop(1))
    unittest.main()
