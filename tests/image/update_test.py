#!/usr/bin/env python3
"""The scripts of updates, on a folder in place of the boot partition: which version starts next, what is refused, what a health check's answer leads to.
tests/vm/update.py has the same with the real boot loader and RAUC; here each case costs milliseconds."""
import os
import pathlib
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2] / "scripts/image/root"
SCRIPTS = ROOT / "usr/lib/prismesh/update"


class Updates(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.top = pathlib.Path(self.folder.name)
        self.kernels = self.top / "esp/EFI/Linux"
        for path in (self.kernels, self.top / "bin", self.top / "boot", self.top / "state", self.top / "update", self.top / "bundle"):
            path.mkdir(parents=True)
        (self.top / "release").write_text("IMAGE_VERSION=1.1\n")
        (self.top / "boot/slot").write_text("B\n")
        # The real scripts with other paths; the partition is a folder that is mounted already.
        for script in SCRIPTS.iterdir():
            text = script.read_text()
            for real, here in (("/usr/lib/prismesh/update", "update"), ("/usr/lib/os-release", "release"), ("/run/prismesh-boot/mounted", "esp"),
                               ("/run/prismesh-boot", "boot"), ("/var/lib/prismesh-update", "state"), ("/dev/tty1", "screen")):
                text = text.replace(real, str(self.top / here))
            if script.name == "esp":
                text += '\nwith_esp() { "$@"; }\n'
            at = self.top / "update" / script.name
            at.write_text(text)
            at.chmod(0o755)
        self.program("rauc", f'echo "$@" >>{self.top}/rauc.log; case $2 in mark-good) {self.top}/update/bootloader set-state B good ;; '
                             f'mark-bad) {self.top}/update/bootloader set-state B bad ;; esac')
        self.program("systemctl", f'echo "$@" >>{self.top}/systemctl.log')
        self.program("sleep", "true")
        self.program("df", "echo Use%; echo ' 12%'")

    def tearDown(self):
        self.folder.cleanup()

    def program(self, name, text):
        path = self.top / "bin" / name
        path.write_text(f"#!/bin/sh\n{text}\n")
        path.chmod(0o755)

    def kernel(self, *names):
        for name in names:
            (self.kernels / f"prismesh-{name}").write_text(name)

    def there(self):
        return sorted(each.name.removeprefix("prismesh-") for each in self.kernels.iterdir())

    def run_script(self, name, *arguments, **more):
        environment = {**os.environ, "PATH": f"{self.top / 'bin'}:{os.environ['PATH']}", **more}
        return subprocess.run([self.top / "update" / name, *arguments], capture_output=True, text=True, env=environment)

    def primary(self):
        return self.run_script("bootloader", "get-primary").stdout.strip()

    def state(self, slot):
        return self.run_script("bootloader", "get-state", slot).stdout.strip()

    # --- which one starts: as systemd-boot sorts them ---

    def test_the_highest_version_starts(self):
        self.kernel("1.9-A.efi", "1.10-B.efi")
        self.assertEqual(self.primary(), "B")

    def test_a_version_on_trial_starts_before_a_confirmed_older_one(self):
        self.kernel("1.0-A.efi", "1.1-B+1-1.efi")
        self.assertEqual(self.primary(), "B")

    def test_a_version_without_tries_doesn_t_start(self):
        self.kernel("1.0-A.efi", "1.1-B+0-2.efi")
        self.assertEqual((self.primary(), self.state("B"), self.state("A")), ("A", "bad", "good"))

    def test_an_empty_slot_is_bad(self):
        self.kernel("1.0-A.efi")
        self.assertEqual((self.primary(), self.state("B")), ("A", "bad"))

    def test_ten_tries_aren_t_none(self):
        self.kernel("1.0-A.efi", "1.1-B+10.efi")
        self.assertEqual(self.state("B"), "good")

    def test_without_a_good_version_there_is_no_next_one(self):
        self.kernel("1.0-A+0-2.efi")
        self.assertNotEqual(self.run_script("bootloader", "get-primary").returncode, 0)

    # --- RAUC's calls during an update ---

    def test_an_installed_version_gets_two_tries(self):
        self.kernel("1.0-A.efi", "1.1-B.new")
        self.assertEqual(self.run_script("bootloader", "set-primary", "B").returncode, 0)
        self.assertEqual(self.there(), ["1.0-A.efi", "1.1-B+2.efi"])

    def test_it_takes_the_place_of_what_the_slot_had(self):
        self.kernel("1.0-A.efi", "1.1-B+0-2.efi", "1.2-B.new")
        self.run_script("bootloader", "set-primary", "B")
        self.assertEqual(self.there(), ["1.0-A.efi", "1.2-B+2.efi"])

    def test_a_slot_that_is_being_written_doesn_t_start(self):
        self.kernel("1.0-A.efi", "1.1-B.efi")
        self.run_script("bootloader", "set-state", "A", "bad")
        self.assertEqual(self.there(), ["1.0-A+0.efi", "1.1-B.efi"])

    def test_an_empty_slot_may_be_marked_bad(self):
        self.kernel("1.0-A.efi")
        self.assertEqual(self.run_script("bootloader", "set-state", "B", "bad").returncode, 0)

    def test_a_confirmed_version_has_no_count(self):
        self.kernel("1.0-A.efi", "1.1-B+1-1.efi")
        self.run_script("bootloader", "set-state", "B", "good")
        self.assertEqual(self.there(), ["1.0-A.efi", "1.1-B.efi"])

    def test_confirming_an_empty_slot_fails(self):
        self.kernel("1.0-A.efi")
        self.assertNotEqual(self.run_script("bootloader", "set-state", "B", "good").returncode, 0)

    # --- what may be installed ---

    def may_install(self, version):
        if version is not None:
            (self.top / "bundle/version").write_text(version + "\n")
        return self.run_script("may-install", RAUC_BUNDLE_MOUNT_POINT=str(self.top / "bundle"))

    def test_a_newer_version_may_be_installed(self):
        for version in ("1.2", "1.10", "2", "1.1.1"):
            self.assertEqual(self.may_install(version).returncode, 0, version)

    def test_older_and_equal_versions_are_refused_with_both_numbers(self):
        for version in ("1.0", "1.1", "0.9", "1"):
            said = self.may_install(version)
            self.assertEqual(said.returncode, 1, version)
            self.assertIn(f"version {version} isn't newer than 1.1", said.stderr)
            self.assertIn(f"version {version} isn't newer", (self.top / "boot/refused").read_text())

    def test_while_the_running_version_is_on_trial_nothing_is_installed(self):
        self.kernel("1.0-A.efi", "1.1-B+1-1.efi")
        said = self.may_install("1.2")
        self.assertEqual(said.returncode, 1)
        self.assertIn("version 1.1, which runs, isn't confirmed yet", said.stderr)

    def test_an_update_without_version_is_refused(self):
        said = self.may_install(None)
        self.assertEqual(said.returncode, 1)
        self.assertIn("doesn't say its version", said.stderr)

    # --- the health check's answer ---

    def health(self, text, status):
        path = self.top / "update/health"
        path.write_text(f"#!/bin/sh\necho '{text}'\nexit {status}\n")
        path.chmod(0o755)

    def reason(self):
        path = self.top / "state/reason"
        return path.read_text().strip() if path.exists() else None

    def test_a_healthy_version_is_confirmed(self):
        self.kernel("1.0-A.efi", "1.1-B+1-1.efi")
        (self.top / "state/reason").write_text("Version 1.0.1 was given up: old story.")
        self.health("all is well", 0)
        said = self.run_script("confirm")
        self.assertEqual(self.there(), ["1.0-A.efi", "1.1-B.efi"])
        self.assertIn("version 1.1 is confirmed: all is well", said.stdout)
        self.assertIsNone(self.reason())
        self.assertFalse((self.top / "systemctl.log").exists())

    def test_an_ill_version_says_why_before_it_restarts(self):
        self.kernel("1.0-A.efi", "1.1-B+1-1.efi")
        self.health("first line\nthe device loop stands still", 1)
        self.run_script("confirm")
        self.assertEqual(self.reason(), "Version 1.1 was given up: the device loop stands still.")
        self.assertEqual(self.there(), ["1.0-A.efi", "1.1-B+0.efi"])
        self.assertIn("reboot", (self.top / "systemctl.log").read_text())

    def test_a_version_on_its_last_try_is_confirmed_as_well(self):
        self.kernel("1.0-A.efi", "1.1-B+0-2.efi")
        self.health("all is well", 0)
        self.run_script("confirm")
        self.assertEqual(self.there(), ["1.0-A.efi", "1.1-B.efi"])

    def test_a_version_that_was_given_up_isn_t_examined_again(self):
        self.kernel("1.0-A.efi", "1.1-B+0.efi")
        self.health("would be well", 0)
        self.run_script("confirm")
        self.assertEqual(self.there(), ["1.0-A.efi", "1.1-B+0.efi"])

    def test_a_health_check_without_an_answer_gives_the_version_up(self):
        self.kernel("1.0-A.efi", "1.1-B+1-1.efi")
        self.program("timeout", "exit 124")
        self.run_script("confirm")
        self.assertEqual(self.reason(), "Version 1.1 was given up: its health check has not ended in 20 minutes.")

    def test_a_confirmed_version_isn_t_examined_again(self):
        self.kernel("1.0-A.efi", "1.1-B.efi")
        self.health("would be ill", 1)
        self.run_script("confirm")
        self.assertIsNone(self.reason())
        self.assertFalse((self.top / "rauc.log").exists())

    # --- what is on the screen afterwards ---

    def shown(self):
        self.run_script("notice")
        path = self.top / "screen"
        text = path.read_text() if path.exists() else ""
        path.unlink(missing_ok=True)
        return text

    def test_the_reason_is_shown_once(self):
        self.kernel("1.1-B.efi", "1.2-A+0-2.efi")
        (self.top / "state/reason").write_text("Version 1.2 was given up: it stands still.\n")
        text = self.shown()
        self.assertIn("Version 1.2 was given up: it stands still.", text)
        self.assertIn("runs the previous version, 1.1", text)
        self.assertEqual(self.shown(), "")

    def test_a_version_that_never_came_so_far_is_named_too(self):
        self.kernel("1.1-B.efi", "1.2-A+0-2.efi")
        self.assertIn("Version 1.2 was given up: it didn't start.", self.shown())

    def test_an_old_version_in_the_other_slot_is_no_news(self):
        self.kernel("1.1-B.efi", "1.0-A.efi")
        self.assertEqual(self.shown(), "")
        self.kernel("1.0-A+0-2.efi")
        (self.kernels / "prismesh-1.0-A.efi").unlink()
        self.assertEqual(self.shown(), "")

    def test_a_full_disk_is_named(self):
        self.kernel("1.1-B.efi")
        self.program("df", "echo Use%; echo ' 99%'")
        self.assertIn("The disk for models is full (99 %)", self.shown())

    def test_a_clock_before_the_image_was_made_is_named(self):
        self.kernel("1.1-B.efi")
        self.program("date", "case $1 in +%s) echo 1675000000 ;; *) echo 2023-01-29 ;; esac")
        self.assertIn("The clock stands at 2023-01-29", self.shown())


if __name__ == "__main__":
    unittest.main()
