#!/usr/bin/env python3
"""A run that was recorded comes back: limber stream --poses writes what the device used, limber-sim replay makes of it
the angles that the device sent, and a report.

    record_test.py SIM LIMBER TRACK
"""
import csv
import json
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

SIM = LIMBER = TRACK = None
STEP_RAD = 1e-4  # of the angles in ANGLES
LIMITS_OFF = ("servo_speed=100", "servo_acceleration=10000")


def rows(path):
    with open(path, encoding="ascii") as file:
        return [[float(text) for text in row] for row in list(csv.reader(file))[1:]]


def furthest_apart(sent, again, offset, most=1.0):
    """The largest difference of any angle; the replay's rows are ticks, the device's begin `offset` ticks earlier."""
    worst = 0.0
    for row in sent:
        tick = round(row[0] * 1000) + offset
        for x, y in zip(row[1:], again[tick][1:]):
            worst = max(worst, abs(x - y))
        if worst > most:
            break
    return worst


class RoundTrip(unittest.TestCase):
    def setUp(self):
        home = tempfile.TemporaryDirectory(prefix="limber-test-")
        self.addCleanup(home.cleanup)
        self.folder = Path(home.name)
        # without servos: those on a bus get goals in every second tick only, and ANGLES tells the goals
        device = subprocess.Popen([SIM, "device", "--pty", "rod", "--servos", "none"], cwd=self.folder,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(device.wait)
        self.addCleanup(device.kill)
        deadline = time.monotonic() + 10
        while not (self.folder / "rod").exists() and time.monotonic() < deadline:
            time.sleep(0.02)

    def run_one(self, command, *arguments, code=0):
        done = subprocess.run([command, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True,
                              timeout=100, check=False)
        self.assertEqual(done.returncode, code, (arguments, done.stdout, done.stderr))
        return done.stdout if code == 0 else done.stderr

    def limber(self, *arguments, **options):
        return self.run_one(LIMBER, *arguments, "--port", "pty:rod", **options)

    def pose_log(self):
        return json.loads(self.limber("params", "get", "pose_log", "--json"))[0]["values"]

    def test_angles_come_back(self):
        self.limber("params", "set", "angles_rate=200", *LIMITS_OFF)
        told = json.loads(self.limber("stream", TRACK, "--poses", "run.txt", "--angles", "sent.csv", "--json"))
        self.assertEqual(told["ticks_missing"], 0)
        self.assertEqual(self.pose_log(), [0], "the device sends them for ever")
        said = self.run_one(SIM, "replay", "run.txt", "--angles", "again.csv", "--report", "run.html")
        self.assertIn("report     run.html", said)
        self.assertIn("</html>", (self.folder / "run.html").read_text(encoding="utf-8"))
        again = rows(self.folder / "again.csv")
        self.assertEqual(len(again), told["ticks_in_track"])

        # the track itself: after the arming, until the last pose
        ends_s = rows(self.folder / "sent.csv")[-1][0]
        sent = [row for row in rows(self.folder / "sent.csv") if ends_s - 2.6 < row[0] < ends_s - 0.3]
        self.assertGreater(len(sent), 300)
        self.assertGreater(max(abs(angle) for row in sent for angle in row[1:]), 0.1, "it hardly moved")
        fitting = {offset: furthest_apart(sent, again, offset, 0.6 * STEP_RAD) for offset in range(-700, 1)}
        best = min(fitting, key=fitting.get)
        # half a step of rounding, and what the clocks differ by: 5 us at 1 rad/s
        self.assertLessEqual(fitting[best], 0.55 * STEP_RAD, "not the same run")
        for offset in (best - 1, best + 1):
            self.assertGreater(furthest_apart(sent, again, offset), 10 * STEP_RAD, "a tick off would pass as well")

    def test_the_track_can_be_streamed_again(self):
        self.limber("stream", TRACK, "--dry", "--poses", "run.txt")
        lines = (self.folder / "run.txt").read_text(encoding="ascii").splitlines()
        times = [float(line.split()[0]) for line in lines if not line.startswith("#")]
        self.assertEqual(times, [tick / 1000 for tick in range(len(times))])
        told = json.loads(self.limber("stream", "run.txt", "--dry", "--json"))
        self.assertEqual(told["poses"]["sent"], len(times))
        self.assertTrue(told["poses"]["balances"])

    def test_no_poses_no_file(self):
        (self.folder / "empty.txt").write_text("# nothing\n", encoding="ascii")
        self.limber("stream", "empty.txt", "--poses", "run.txt", code=2)
        self.limber("stream", TRACK, "--poses", "no/such/folder/run.txt", "--angles", "angles.csv", code=2)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["empty.txt", "rod"])
        self.assertEqual(self.pose_log(), [0])


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit("usage: record_test.py SIM LIMBER TRACK [UNITTEST_ARGUMENT...]")
    SIM, LIMBER, TRACK = (str(Path(sys.argv.pop(1)).resolve()) for _ in range(3))
    unittest.main()
