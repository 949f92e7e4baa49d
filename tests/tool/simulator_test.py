#!/usr/bin/env python3
"""The PC tool with the device itself, as limber-sim runs it: the way a user meets both."""
import json
import subprocess
import sys
import time
from pathlib import Path

import tool_case
from tool_case import ToolCase, track

SIM = None


class Simulator(ToolCase):
    def setUp(self):
        super().setUp()
        self.device = subprocess.Popen([SIM, "device", "--pty", "rod", "--flash", "flash.bin"], cwd=self.folder,
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

        def stop():
            self.device.kill()
            self.device.wait()
        self.addCleanup(stop)
        deadline = time.monotonic() + 10
        while not (self.folder / "rod").exists() and time.monotonic() < deadline:
            time.sleep(0.02)
        self.environment["LIMBER_PORT"] = "pty:rod"

    def test_a_stream_is_accounted_for(self):
        self.good("params", "set", "angles_rate=500")
        told = json.loads(self.good("stream", self.write("track.txt", track(150)), "--json", "--angles", "angles.csv"))
        poses = told["poses"]
        self.assertEqual(poses["sent"], poses["accepted"] + sum(poses["rejected"].values()) + poses["lost"])
        self.assertGreater(poses["accepted"], 0.9 * poses["sent"])
        self.assertGreater(told["latency"]["poses"], 100)
        self.assertEqual(self.good_json("info")["state"], "DISARMED")

    def test_slow_source(self):
        slow = self.write("slow.txt", track(20, rate_hz=15))
        self.fails(4, ["stream", slow], "too slow", "--resample 100")
        self.good("stream", slow, "--resample", "100")

    def test_parameters(self):
        whip = subprocess.run([SIM, "params", "--preset", "whip"], capture_output=True, text=True, check=True).stdout
        self.good("params", "load", self.write("whip.ini", whip))
        loaded = self.good("params", "list", "--ini")
        self.good("params", "save")
        self.good("params", "defaults")
        self.assertNotEqual(self.good("params", "list", "--ini"), loaded)
        self.good("preset", "whip")
        self.good("params", "set", "spring[1]=3")
        self.assertEqual(self.good_json("params", "get", "spring")[0]["values"][0], 3)
        self.fails(4, ["params", "set", "spring=-1"], "spring", "-1", "0 ... 1e+06")

    def test_stop(self):
        code, out, _ = self.run_tool("estop")  # the device may have something to say about it
        self.assertEqual(code, 0)
        self.assertIn("state ESTOP", out)
        code, _, err = self.run_tool("stream", self.write("track.txt", track(50)))
        self.assertEqual(code, 4)
        self.assertIn("limber clear", err)
        self.assertIn("state DISARMED", self.run_tool("clear")[1])


if __name__ == "__main__":
    SIM = str(Path(sys.argv.pop(4)).resolve())
    tool_case.main()
