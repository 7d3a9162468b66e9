#!/usr/bin/env python3
# tests/dev/paper_to_si_test.py: the committed study equals the converted papers' file, and
# conversion errors are reported.
import json
import pathlib
import unittest

import paper_to_si

ROOT = pathlib.Path(__file__).parents[2]
OLD = ROOT / "tests/golden/paper.json"
NEW = ROOT / "server/lab/reproduce/study.json"


def old():
    return json.loads(OLD.read_text(encoding="utf-8"))


class PaperToSi(unittest.TestCase):
    def test_the_committed_study_is_the_conversion(self):
        self.assertEqual(paper_to_si.written(paper_to_si.convert(old())),
                         NEW.read_text(encoding="utf-8"))

    def test_a_polygon_with_a_notch_becomes_convex_parts(self):
        # An L of three unit squares: area 3, its inner corner at (1, 1) free on one side.
        parts = paper_to_si.convex_parts([(0, 0), (0, 2), (1, 2), (1, 1), (2, 1), (2, 0)])
        self.assertTrue(all(len(part) == 3 for part in parts))
        areas = [paper_to_si.turn(*part) / 2 for part in parts]
        self.assertTrue(all(area > 0 for area in areas))
        self.assertEqual(sum(areas), 3)

    def test_a_polygon_may_say_its_first_vertex_again(self):
        square = [(0, 0), (1, 0), (1, 1), (0, 1)]
        self.assertEqual(paper_to_si.convex_parts(square + square[:1]), [square])

    def test_a_bow_tie_and_a_line_are_no_solids(self):
        self.assertIsNone(paper_to_si.convex_parts([(0, 0), (1, 1), (1, 0), (0, 1)]))
        self.assertIsNone(paper_to_si.convex_parts([(0, 0), (1, 1), (2, 2)]))

    def test_what_is_not_understood_is_refused(self):
        def refused(change, words):
            document = old()
            change(document)
            with self.assertRaises(paper_to_si.Refusal) as caught:
                paper_to_si.convert(document)
            self.assertIn(words, str(caught.exception))

        refused(lambda d: d["common"].update(dt="fast"), "common/dt: 'fast'")
        refused(lambda d: d["common"]["lidar"].update(beams=181), "has 361 only")
        refused(lambda d: d["common"].update(d_r=1000), "common/d_r")
        refused(lambda d: d["scenarios"][0]["accept"].update(best={}), "best")
        refused(lambda d: d["scenarios"][0]["accept"]["modified"].update(speed_at_most=1),
                "scenarios/0/accept/modified/speed_at_most")
        refused(lambda d: d["scenarios"][8]["obstacles"][0].update(points=[[0, 0], [1, 1], [2, 2]]),
                "scenarios/8/obstacles/0/points")

    def test_limits_without_noise_say_so(self):
        document = old()
        document["scenarios"][0]["accept_noise_free"] = {"original": {"outcome": "timeout"}}
        self.assertIn({"scenario": "case1", "controller": "original", "noise_free": True,
                       "outcome": "out_of_time"}, paper_to_si.convert(document)["limits"])


if __name__ == "__main__":
    unittest.main()
