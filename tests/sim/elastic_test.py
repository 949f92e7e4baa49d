#!/usr/bin/env python3
"""What limber-sim says of a rod of the elastic model, and leaves out that is contour's."""
import json
import math
import re

import sim_case
from output_test import Page
from sim_case import SimCase, columns


class Elastic(SimCase):
    FOIL = ["--preset", "foil", "--model", "elastic"]

    def test_the_summary_is_that_of_its_model(self):
        elastic = self.good("replay", self.tracks / "shaking.txt", *self.FOIL)
        self.assertIn("rod        foil: 8 links, 0.88 m, 0.0789 kg, elastic\n", elastic)
        self.assertIn("first mode 6.71 Hz in a still hand; gravity 9.81 m/s^2\n", elastic)
        self.assertRegex(elastic, r"(?m)^joint .*beyond limit$")
        self.assertNotRegex(elastic, "midpoint|on stop|warning")
        contour = self.good("replay", self.tracks / "shaking.txt", "--preset", "foil")
        self.assertIn("rod        foil: 8 links, 0.88 m, contour, midpoint\n", contour)
        self.assertRegex(contour, r"(?m)^joint .*on stop$")
        self.assertNotRegex(contour, "first mode|gravity|beyond")

    def test_under_resolved_is_what_no_six_steps_show(self):
        stiff = [*self.FOIL, "--set", "spring=200000"]
        out = self.good("replay", self.track, *stiff)
        needed_hz = 2 * math.pi * float(re.search(r"^first mode ([\d.]+) Hz", out, re.MULTILINE)[1])
        self.assertGreater(needed_hz, 1100)  # below 1 kHz a tick is of several steps
        for rate_hz, warned in ((needed_hz * 0.97, True), (needed_hz * 1.03, False), (500, True), (100, True)):
            out = self.good("replay", self.track, *stiff, "--rate", f"{rate_hz:.2f}")
            self.assertEqual("warning    under-resolved: the slowest swing" in out, warned, out)
            told = re.findall(r"--rate (\d+) would show it", out)
            self.assertEqual([abs(float(hz) / needed_hz - 1) < 0.006 for hz in told], [True] * warned)  # three digits
        bar = self.good("replay", self.track, "--preset", "stiff-bar", "--model", "elastic", "--rate", "100")
        self.assertIn("\nsteps      30 at 100 Hz, each in 10 parts\n", bar)
        self.assertNotIn("under-resolved", bar)

    def test_beyond_the_limit_is_counted_not_stopped(self):
        out = self.good("replay", self.tracks / "shaking.txt", *self.FOIL, "--set", "limit=0.02", "--angles",
                        "angles.csv")
        rows = [[abs(float(v)) for v in row[1:]] for row in columns(self.folder / "angles.csv")[1]]
        shares = [sum(max(row[2 * joint:2 * joint + 2]) >= 0.02 for row in rows) / len(rows) for joint in range(8)]
        self.assertGreater(max(map(max, rows)), 0.04)
        self.assertEqual([f"{100 * share:.2f}" for share in shares], re.findall(r"([\d.]+) %$", out, re.MULTILINE))
        worst = max(range(8), key=lambda joint: shares[joint])
        self.assertIn(f"warning    joint {worst + 1} is bent beyond its limit {100 * shares[worst]:.2g} % of the time; "
                      "the rod has no stop there, its servo may", out)

    def test_lengths_that_had_to_be_restored_are_told(self):
        self.write("wild.txt", "".join(f"{0.01 * n:.2f} {9 * (n % 2)} {7 * (n % 3)} 0 0 0 0 1\n" for n in range(60)))
        out = self.good("replay", "wild.txt", *self.FOIL, "--rate", "100", "--nodes", "nodes.csv")
        told = re.search(r"^warning .* links had to be pulled back .*: (\d+) ticks$", out, re.MULTILINE)
        self.assertTrue(0 < int(told[1]) < 60, out)
        for row in columns(self.folder / "nodes.csv")[1]:
            node = [list(map(float, row[1 + 3 * i:4 + 3 * i])) for i in range(9)]
            for a, b in zip(node, node[1:]):
                self.assertAlmostEqual(math.dist(a, b), 0.11, delta=2e-5)

    def test_a_level_rod_droops(self):
        self.write("level.txt", "".join(f"{0.2 * n:.1f} 0 0 1 0 0.70710678 0 0.70710678\n" for n in range(60)))
        self.good("replay", "level.txt", *self.FOIL, "--nodes", "nodes.csv")
        tip = [float(v) for v in columns(self.folder / "nodes.csv")[1][-1][-3:]]
        self.assertAlmostEqual(tip[2] - 1, -0.00988, delta=0.0001)  # sum of moments over springs, in float64
        self.good("replay", "level.txt", *self.FOIL, "--set", "gravity=0", "--nodes", "nodes.csv")
        self.assertAlmostEqual(float(columns(self.folder / "nodes.csv")[1][-1][-1]), 1, delta=1e-6)

    def test_the_report_is_that_of_its_model(self):
        self.good("replay", self.tracks / "shaking.txt", *self.FOIL, "--report", "report.html")
        data = json.loads(Page((self.folder / "report.html").read_text(encoding="utf-8")).scripts["data"])
        self.assertEqual((data["model"], "scheme" in data), ("elastic", False))
        self.assertAlmostEqual(data["first_mode_hz"], 6.71, delta=0.01)
        units = {entry["name"]: entry["unit"] for entry in data["parameters"]}
        self.assertEqual(list(units), ["model", "links", "tick", "length", "drag", "spring", "damper", "limit", "mass",
                                       "gravity"])
        self.assertEqual((units["drag"], units["damper"]), ("N s/m", "N m s"))
        self.assertEqual([joint["limit_share"] for joint in data["joints"]], [0] * 8)
        self.good("replay", self.tracks / "shaking.txt", "--report", "report.html")
        data = json.loads(Page((self.folder / "report.html").read_text(encoding="utf-8")).scripts["data"])
        self.assertEqual((data["scheme"], "first_mode_hz" in data), ("midpoint", False))
        self.assertEqual({entry["name"] for entry in data["parameters"]} & {"mass", "gravity"}, set())


if __name__ == "__main__":
    sim_case.main()
