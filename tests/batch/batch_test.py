#!/usr/bin/env python3
"""`prismesh batch` as it is used: on this machine's cores, and on a real Slurm where its packages are installed.

    batch_test.py PROGRAMS
"""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "report"))
from cluster import Cluster, missing  # noqa: E402
from report_test import Page, fetched  # noqa: E402
from study_folder import BEAD, StudyFolder  # noqa: E402

PROGRAMS = pathlib.Path()


class Batch(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def study(self, plan, **more):
        return StudyFolder(PROGRAMS, self.folder, plan, **more)

    def page(self, study):
        page = Page((study.results / "results.html").read_text())
        self.assertEqual(page.faults, [])
        self.assertEqual([address for address in fetched(page) if not str(address).startswith(("data:image/png;base64,", "variants/"))], [])
        return page

    def test_a_study_on_this_machine(self):
        study = self.study('pictures = true\n[parameters]\nheight = [2, 6]\nname = ["part:1", "part:99"]\n', script=BEAD + '{"edit": "select", "expr": "${name}"}\n')
        done = study.batch("--local", "--jobs", "2", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual({key: value for key, value in json.loads(done.stdout).items() if key != "page"}, {"variants": 4, "done": 2, "refused": 2, "failed": 0, "missing": 0})
        rows = {(float(row["height"]), row["name"]): row for row in study.table()}
        for (height, name), row in rows.items():
            if name == "part:99":
                self.assertEqual(row["state"], "refused")
                self.assertIn("bead.jsonl:4: ", row["reason"])
                continue
            deck = study.results / row["file"]
            check = json.loads(subprocess.run([study.program, "check", deck, "--json", "--target-size", "30"], capture_output=True).stdout)
            contacts = json.loads(subprocess.run([study.program, "penetrations", deck, "--json"], capture_output=True).stdout)
            diff = json.loads(subprocess.run([study.program, "diff", study.deck, deck, "--json"], capture_output=True).stdout)
            self.assertEqual((int(row["warn"]), int(row["fail"])), (check["warn"], check["fail"]))
            self.assertAlmostEqual(float(row["mass"]), check["mass"], delta=1e-9)
            self.assertAlmostEqual(float(row["time_step"]), check["time_step"]["min"], delta=1e-12)
            self.assertEqual((int(row["perforations"]), int(row["penetrations"])), (contacts["perforations"], contacts["penetrations"]))
            self.assertEqual(int(row["nodes_moved"]), diff["nodes_moved"])
            self.assertAlmostEqual(float(row["max_displacement"]), diff["max_displacement"], delta=1e-6)
            self.assertEqual(int(row["lines_changed"]), diff["lines_changed"])
        page = self.page(study)
        body = page.rows["variants"][1:]
        self.assertEqual([row[1].split()[-1] for row in body], ["refused", "refused", "done", "done"], "failures first")
        if (PROGRAMS / "prismesh-kiosk").exists():
            self.assertEqual(len([tag for tag, _ in page.elements if tag == "img"]), 2)
        as_json = json.loads((study.results / "results.json").read_text())
        self.assertEqual([str(row["variant"]) for row in as_json["rows"]], [row["variant"] for row in study.table()])
        # again: nothing is worked twice
        before = {path: path.stat().st_mtime_ns for path in (study.results / "variants").rglob("*")}
        self.assertEqual(study.batch("--local").returncode, 0)
        self.assertEqual({path: path.stat().st_mtime_ns for path in (study.results / "variants").rglob("*")}, before)
        # a wider plan works only what is new
        study.plan.write_text(study.plan.read_text().replace("[2, 6]", "[2, 4, 6]"))
        self.assertEqual(study.batch("--local").returncode, 0)
        self.assertTrue(before.items() <= {path: path.stat().st_mtime_ns for path in (study.results / "variants").rglob("*") if path in before}.items())
        self.assertEqual(len(study.table()), 6)

    def killed(self, runner, want):
        """Kills workers of a running study, so many."""
        killed = 0
        end = time.monotonic() + 60
        while killed < want and time.monotonic() < end and runner.poll() is None:
            for child in subprocess.run(["pgrep", "-P", str(runner.pid)], capture_output=True, text=True).stdout.split():
                try:
                    os.kill(int(child), signal.SIGKILL)
                    killed += 1
                except ProcessLookupError:
                    continue
                if killed == want:
                    break
            time.sleep(0.02)
        return killed

    def test_killed_workers_and_a_killed_run(self):
        study = self.study('plan = "latin-hypercube"\nsamples = 12\npictures = false\n[parameters]\nheight = {from = 2, to = 12}\n')
        command = [study.program, "batch", study.plan, "--local", "--jobs", "2"]
        runner = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        killed = self.killed(runner, 2)
        out, err = runner.communicate()
        self.assertEqual(killed, 2)
        failed = [row for row in study.table() if row["state"] == "failed"]
        self.assertEqual((runner.returncode, len(failed)), (1, 2), err)
        self.assertEqual({row["reason"] for row in failed}, {"the worker ended by signal 9 (Killed)"})
        self.assertEqual([row[1] for row in self.page(study).rows["variants"][1:3]], ["✖ failed"] * 2)
        self.assertIn("failed: the worker ended by signal 9", err)
        # what is missing runs again; this time the run itself is killed
        for row in (study.results / "variants").iterdir():
            if len(list((study.results / "variants").iterdir())) > 4:
                shutil.rmtree(row)
        runner = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        time.sleep(0.3)
        os.killpg(runner.pid, signal.SIGKILL)
        runner.wait()
        self.assertEqual(study.batch("--local", "--jobs", "2").returncode, 0)
        self.assertEqual(study.faults(12), [])

    def test_ctrl_c_keeps_what_is_done(self):
        study = self.study('pictures = false\n[parameters]\nheight = {from = 2, to = 12, levels = 40}\n')
        runner = subprocess.Popen([study.program, "batch", study.plan, "--local", "--jobs", "1"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        time.sleep(1)
        runner.send_signal(signal.SIGINT)
        out, err = runner.communicate()
        self.assertEqual(runner.returncode, 1)
        self.assertIn("stopped; the same command goes on with what is missing", err)
        states = [row["state"] for row in study.table()]
        self.assertEqual(states.count("failed"), 0, "what was stopped hasn't failed")
        self.assertGreater(states.count("missing"), 0)

    def test_the_study_of_the_documentation(self):
        study = self.study("")
        for file in (pathlib.Path(__file__).parents[2] / "docs" / "examples" / "study").iterdir():
            shutil.copy(file, study.folder)
        study.plan = study.folder / "night.toml"
        study.results = study.folder / "night.results"
        study.plan.write_text(study.plan.read_text().replace("samples = 200", "samples = 4\npictures = false"))
        done = study.batch("--local")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(study.faults(4), [])

    def test_what_is_wrong_is_said_before_any_work(self):
        study = self.study("[parameters]\nheight = []\n")
        wrong = [
            ("[parameters]\nheight = []\n", "bead.toml:5: the parameter height has no values"),
            ("[parameters]\nhight = [1]\n", 'bead.jsonl:2: the plan has no parameter "height"; the nearest known is "hight"'),
            ("[parameters]\nheight = [1]\npitch = [2]\n", "bead.toml: no script names the parameter pitch"),
            ('[parameters]\nheight = ["high"]\n', "bead.jsonl:2: "),
        ]
        head = study.plan.read_text().split("[parameters]")[0]
        for text, words in wrong:
            study.plan.write_text(head + text)
            for how in ("--local", "--slurm"):
                done = study.batch(how)
                self.assertEqual(done.returncode, 1)
                self.assertIn(words, done.stderr)
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                self.assertFalse(study.results.exists())
        self.assertEqual(study.batch("--local", "--slurm").returncode, 2)
        self.assertEqual(study.batch("--task", "7", "--tasks", "2").returncode, 2)
        self.assertEqual(study.batch("--local", "--target-size", "3").returncode, 2)
        study.plan.write_text(head + "[parameters]\nheight = [1]\n")
        done = study.batch("--slurm", env={**os.environ, "PATH": "/nowhere"})
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stderr, "sbatch: Slurm's client can't be started, so nothing is submitted; the package slurm-client has it\n")

    def test_a_deck_that_changes_while_the_plan_runs(self):
        study = self.study("pictures = false\n[parameters]\nheight = [2, 4]\n")
        study.batch("--slurm", env={**os.environ, "PATH": "/nowhere"})  # freezes the study
        frozen = next((study.results / "studies").iterdir())
        worker = [study.program, "batch", frozen]
        self.assertEqual(subprocess.run([*worker, "--variant", "1"], capture_output=True).returncode, 0)
        study.deck.write_text("$ a comment\n" + study.deck.read_text())
        done = subprocess.run([*worker, "--variant", "2"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("rail.k: the deck has changed since the plan was started", done.stderr)
        told = subprocess.run(worker, capture_output=True, text=True)
        self.assertEqual(told.returncode, 1)
        self.assertEqual([row["state"] for row in study.table()], ["done", "failed"])
        self.assertEqual(subprocess.run([*worker, "--variant", "3"], capture_output=True).returncode, 1)


class Slurm(Batch):
    """Only what is Slurm's."""

    def setUp(self):
        super().setUp()
        if why := missing():
            self.skipTest("SLURM IS NOT TESTED: " + why)

    test_a_study_on_this_machine = test_killed_workers_and_a_killed_run = test_ctrl_c_keeps_what_is_done = test_the_study_of_the_documentation = None
    test_what_is_wrong_is_said_before_any_work = test_a_deck_that_changes_while_the_plan_runs = None

    def test_a_study_on_a_cluster(self):
        study = self.study("pictures = false\n[parameters]\nheight = {from = 2, to = 12, levels = 8}\n[slurm]\nmax_tasks = 4\n")
        with Cluster(self.folder / "cluster", 2) as cluster:
            plan = study.plan.read_text()
            study.plan.write_text(plan + 'options = ["--partition=none"]\n')
            refused = study.batch("--slurm", env=cluster.environment)
            self.assertEqual(refused.returncode, 1)
            self.assertIn("the cluster refuses, and nothing is submitted: ", refused.stderr)
            self.assertIn("partition", refused.stderr)
            self.assertEqual(cluster.jobs(), [])
            study.plan.write_text(plan)
            done = study.batch("--slurm", "--json", env=cluster.environment)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(json.loads(done.stdout)["submitted"], 8)
            cluster.until_done(120)
            self.assertEqual(study.faults(8), [], "the job after the array has made the tables")
            shutil.rmtree(next((study.results / "variants").iterdir()))
            again = study.batch("--slurm", "--json", env=cluster.environment)
            self.assertEqual(json.loads(again.stdout)["submitted"], 1, "only what is missing")
            cluster.until_done(120)
            self.assertEqual(study.faults(8), [])

    def test_a_task_uses_the_processors_that_it_has(self):
        study = self.study('pictures = false\n[parameters]\nheight = {from = 2, to = 12, levels = 40}\n[slurm]\nmax_tasks = 1\noptions = ["--cpus-per-task=2"]\n')
        with Cluster(self.folder / "cluster", 2) as cluster:
            done = study.batch("--slurm", env=cluster.environment)
            self.assertEqual(done.returncode, 0, done.stderr)
            most = 0
            while cluster.jobs():
                workers = subprocess.run(["pgrep", "-f", f"^{study.program} batch {study.results}.* --variant "], capture_output=True, text=True)
                most = max(most, len(workers.stdout.split()))
            self.assertEqual(most, 2)
            self.assertEqual(study.faults(40), [])


if __name__ == "__main__":
    PROGRAMS = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main(verbosity=2)
