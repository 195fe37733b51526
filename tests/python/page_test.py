#!/usr/bin/env python3
"""The examples of docs/python.md run, and print what stands under them.

    page_test.py FOLDER_OF_THE_PACKAGE PRISMESH

A block of Python is run in the order of the page, all in one folder with the deck door.k; a block of text right after it is what it prints.
"""
import contextlib
import io
import os
import re
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import decks  # noqa: E402

PAGE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "python.md")


def examples(page):
    """[(code, what it prints, line)]"""
    found = []
    for block in re.finditer(r"```python\n(.*?)```(?:\s*```text\n(.*?)```)?", page, re.S):
        found.append((block.group(1), block.group(2) or "", page[:block.start(1)].count("\n") + 1))
    return found


class Page(unittest.TestCase):
    def test_examples(self):
        with open(PAGE, encoding="utf-8") as file:
            found = examples(file.read())
        self.assertGreaterEqual(len(found), 4)
        self.assertTrue(any(printed for _, printed, _ in found))
        at = os.getcwd()
        self.addCleanup(os.chdir, at)
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            status, _, err = decks.program("sample", "--elements", 2000, "-o", "door.k")
            self.assertEqual(status, 0, err)
            names = {}
            for code, printed, line in found:
                out = io.StringIO()
                with contextlib.redirect_stdout(out):
                    exec(compile("\n" * (line - 1) + code, "docs/python.md", "exec"), names)  # pylint: disable=exec-used
                self.assertEqual(out.getvalue(), printed, f"docs/python.md:{line}")
            os.chdir(at)


if __name__ == "__main__":
    unittest.main()
