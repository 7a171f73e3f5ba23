#!/usr/bin/env python3
"""Tests what walks.py collects from the JSON of program runs."""
import argparse
import contextlib
import io
import json
import os
import sys
import tarfile
import tempfile
import unittest

import walks


def answer(microseconds, valid=True, cpu_time=False, smallest=None):
    times = {"median": microseconds, "min": microseconds if smallest is None else smallest}
    return {"hardware": {"processor": "P"}, "build": {"catena": "1"}, "measured": {"chains": 1, "command": ["catena", "bench"], "cpu_time": cpu_time},
            "results": [{"joint": "link", "bodies": 100, "microseconds": times, "valid": valid}]}


def solved(nanoseconds):
    found = answer(0)
    found["results"] = [{"joint": "link", "bodies": 100, "ns_per_body": {"evaluation": {"median": nanoseconds, "min": 0}}, "valid": True}]
    return found


def stepped(rate):
    return {"measured": {"chains": 20, "command": ["catena", "run"], "cpu_time": False}, "system": {"bodies": 2000}, "valid": True,
            "speed": {"steps_per_second_of_second_half": rate}}


class Collect(unittest.TestCase):
    def collected(self, files, pack=False, kind="host"):
        with tempfile.TemporaryDirectory() as folder:
            place, target = os.path.join(folder, "runs"), os.path.join(folder, "walks.json")
            os.mkdir(place)
            for name, content in files.items():
                with open(os.path.join(place, name), "w", encoding="utf-8") as file:
                    json.dump(content, file)
            if pack:
                with tarfile.open(os.path.join(folder, "runs.tar"), "w") as archive:
                    archive.add(place, "runs")
                place = os.path.join(folder, "runs.tar")
            with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
                self.status = walks.collect(walks.WALKS[kind], place, target)
            with open(target, encoding="utf-8") as file:
                return json.load(file)["results"]

    def test_keeps_the_smallest_median_of_each_side(self):
        files = {"vectors@with@0@0.json": answer(3), "vectors@with@0@1.json": answer(2), "vectors@without@0@0.json": answer(8)}
        for pack in (False, True):
            with self.subTest(pack=pack):
                row, = self.collected(files, pack)
                self.assertEqual((row["microseconds_with"], row["microseconds_without"]), (2, 8))
                self.assertEqual(self.status, 0)

    def test_takes_the_smallest_time_of_a_thread(self):
        files = {"vectors@with@0@0.json": answer(3, cpu_time=True, smallest=1), "vectors@without@0@0.json": answer(8, cpu_time=True)}
        self.assertEqual(self.collected(files)[0]["microseconds_with"], 1)

    def test_converts_solves_and_steps_to_microseconds(self):
        solve = self.collected({"host-levels@with@0@0.json": solved(50), "host-levels@without@0@0.json": solved(10)})
        self.assertEqual((solve[0]["microseconds_with"], solve[0]["microseconds_without"]), (5, 1))
        steps = self.collected({"host-blocks@with@0@0.json": stepped(1000), "host-blocks@without@0@0.json": stepped(500)})
        self.assertEqual((steps[0]["bodies"], steps[0]["chains"], steps[0]["microseconds_without"]), (100, 20, 2000))

    def test_leaves_out_what_is_invalid_or_has_one_side(self):
        files = {"vectors@with@0@0.json": answer(3), "vectors@without@0@0.json": answer(8, valid=False)}
        self.assertEqual(self.collected(files), [])
        self.assertEqual(self.status, 1)

    def test_leaves_out_the_walks_of_the_other_set(self):
        self.assertEqual(self.collected({"together@with@0@0.json": answer(3), "together@without@0@0.json": answer(8)}), [])


class Walks(unittest.TestCase):
    def test_every_walk_says_what_it_does_and_what_replaces_it(self):
        for each in walks.WALKS.values():
            for name, walk in each.items():
                self.assertEqual(len(walk.does.split("; ")), 2, name)
                self.assertTrue(not walk.cases or walk.off or walk.options != walk.others, name)

    def test_a_walk_that_was_removed_is_not_measured(self):
        gone = [name for name, walk in walks.WALKS["gpu"].items() if not walk.cases]
        self.assertEqual(gone, ["groups", "narrow-teams", "scan-cluster"])
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
            options = argparse.Namespace(set="gpu", folder=folder, seconds=60, turns=1, only=",".join(gone), cpu_time=False, catena="no program")
            walks.Measurement(options).all()
            self.assertEqual(os.listdir(folder), [])


if __name__ == "__main__":
    sys.exit(unittest.main())
