#!/usr/bin/env python3
"""The simulation of batch_scale.py: nothing is lost or done twice, nobody works more than there is time, and what has a closed form agrees with it.

    batch_scale_test.py
"""
import json
import math
import pathlib
import random
import sys
import unittest
import xml.etree.ElementTree

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).parent))
from batch_scale import Cluster, Study, cluster_of, curves, fed, simulate, study_of, table  # noqa: E402

COSTS = json.loads((pathlib.Path(__file__).parent / "batch_costs.json").read_text())


class Conservation(unittest.TestCase):
    def test_each_variant_has_one_result_and_time_is_kept(self):
        seed = random.randrange(1 << 32)
        print(f"seed {seed}", file=sys.stderr)
        rnd = random.Random(seed)
        for _ in range(60):
            study = Study(rnd.randint(1, 400), rnd.uniform(0.01, 5), rnd.choice([0, 0.3, 0.9]), rnd.choice([0, 1, 20]), rnd.choice([0, 0.02, 0.4]))
            cluster = Cluster(rnd.randint(1, 20), rnd.randint(1, 6), rnd.randint(1, 50), rnd.choice([0, 0.01, 1]), rnd.choice([0, 2]), rnd.choice([0, 0.1]), rnd.choice([0, 1e-4]), 8,
                              rnd.choice([0, 0.001, 0.05]), rnd.choice([math.inf, 10]), 4, rnd.choice([0, 0.001]), rnd.choice([1, 16]), rnd.choice([0, 0.0002]))
            outcome = simulate(study, cluster, seed=rnd.randrange(1 << 32))
            self.assertEqual(outcome.results, {variant: 1 for variant in range(study.variants)}, (study, cluster))
            self.assertLessEqual(outcome.busy_core_s, cluster.nodes * cluster.cores * outcome.work_s * (1 + 1e-9), (study, cluster))
            self.assertGreaterEqual(outcome.busy_core_s * (1 + 1e-9), study.variants * study.work_s * (1 - study.spread))
            for busy in (outcome.metadata_busy_s, outcome.bandwidth_busy_s, outcome.scheduler_busy_s):
                self.assertLessEqual(busy, outcome.work_s * (1 + 1e-9), (study, cluster))
            self.assertLessEqual(outcome.work_s, outcome.tables_s)
            self.assertEqual(outcome.rounds > 1, outcome.killed > 0)
            if study.spread == 0:
                self.assertGreaterEqual(outcome.work_s * (1 + 1e-9), outcome.ideal_s)


class ClosedForms(unittest.TestCase):
    def test_without_overhead_it_takes_the_ideal_time(self):
        for nodes, cores, tasks, variants in ((1, 1, 1, 7), (10, 1, 10, 1000), (10, 4, 10, 1000), (7, 3, 7, 210)):
            outcome = simulate(Study(variants, 2.5), Cluster(nodes, cores, tasks))
            self.assertAlmostEqual(outcome.work_s, outcome.ideal_s, places=9)
            self.assertAlmostEqual(outcome.tables_s, variants / nodes / cores * 2.5, places=9)

    def test_what_a_single_shared_part_takes(self):
        study = Study(600, 3)
        # 60 tasks on 60 nodes start one after the other; the last one works ten variants
        self.assertAlmostEqual(simulate(study, Cluster(60, 1, 60, start_s=2, submit_s=5)).work_s, 5 + 60 * 2 + 10 * 3, places=9)
        # where the scheduler is slower than the nodes, each new task waits for it
        self.assertAlmostEqual(simulate(study, Cluster(100, 1, 600, start_s=4)).work_s, 600 * 4 + 3, places=9)
        # all finish at once and then queue at the file system, which is never idle afterwards
        self.assertAlmostEqual(simulate(study, Cluster(600, 1, 600, write_operations=8, metadata_s=0.5)).work_s, 3 + 600 * 8 * 0.5, places=9)
        self.assertAlmostEqual(simulate(Study(600, 3, result_mb=20), Cluster(600, 1, 600, mb_s=10)).work_s, 3 + 600 * 2, places=9)
        # a saturated queue with several variants a worker: the first work, then the queue alone
        self.assertAlmostEqual(simulate(study, Cluster(60, 1, 60, write_operations=8, metadata_s=0.5)).work_s, 3 + 600 * 4, places=9)
        # processes and sampling
        self.assertAlmostEqual(simulate(study, Cluster(60, 1, 60, process_s=0.25, sampling_s=0.001)).work_s, 10 * (3 + 0.25 + 0.6), places=9)
        # the reconciler afterwards
        outcome = simulate(study, Cluster(60, 1, 60, read_operations=4, read_s=0.04, readers=4, reconcile_s=0.002, table_mb=0.5))
        self.assertAlmostEqual(outcome.tables_s, 30 + 600 * 0.042, places=9)
        self.assertEqual((outcome.memory_mb, outcome.rounds), (300, 1))

    def test_tasks_bound_the_processors_that_work(self):
        # ten tasks of one core each leave the other nodes idle
        self.assertAlmostEqual(simulate(Study(1000, 1), Cluster(100, 1, 10)).work_s, 100, places=9)
        self.assertAlmostEqual(simulate(Study(1000, 1), Cluster(100, 8, 10)).work_s, 13, places=9)  # 100 each, by eight: 13 rounds

    def test_deaths(self):
        # the tries of a variant until one lives are geometric: 1 / (1 - p) of them
        study = Study(20_000, 0.01, death=0.25)
        outcome = simulate(study, Cluster(50, 2, 50))
        tries = outcome.killed + study.variants
        self.assertAlmostEqual(tries / study.variants, 1 / 0.75, delta=4 * math.sqrt(0.25 / 0.75**2 / study.variants))


class Scenarios(unittest.TestCase):
    def test_the_page_says_what_the_simulation_says(self):
        page = (pathlib.Path(__file__).parents[2] / "docs" / "batch.md").read_text()
        small = table(COSTS, counts=(1000, 10_000)).splitlines()
        for line in small:
            self.assertIn(line, page)
        self.assertEqual(len(small), 2 + 2 * 3)
        for line in fed(COSTS).splitlines():
            self.assertIn(line, page)

    def test_the_curves_are_drawn(self):
        drawn = curves(COSTS, counts=(1000, 3000))
        root = xml.etree.ElementTree.fromstring(drawn)
        names = {text.text for text in root.iter("{http://www.w3.org/2000/svg}text")}
        self.assertLessEqual({"work", "scheduler", "metadata", "bandwidth", "sampling", "reconciler", "all together"}, names)

    def test_the_costs_are_measured(self):
        cluster, study = cluster_of(COSTS), study_of(COSTS, "large", 1000)
        for figure in (cluster.start_s, cluster.process_s, cluster.sampling_s, cluster.reconcile_s, cluster.table_mb, study.work_s, study.result_mb):
            self.assertGreater(figure, 0)


if __name__ == "__main__":
    unittest.main()
