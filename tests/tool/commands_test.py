#!/usr/bin/env python3
"""Every command of the PC tool against a device that behaves: what it prints, what the device was told."""
import csv
import json
import signal
import time
import unittest

import tool_case
from tool_case import STATES, ToolCase

COMMANDS = "ports info stream params preset arm disarm estop clear record latency".split()


class Help(ToolCase):
    def test_every_command_has_examples(self):
        listed = self.good("--help")
        for command in COMMANDS:
            self.assertIn(f"\n  {command} ", listed)
            text = self.good(command, "--help")
            self.assertIn(f"Usage: limber {command}", text)
            self.assertIn(f"  limber {command}", text.split("Examples:")[1])
            self.assertLess(max(map(len, text.splitlines())), 130, command)
        self.assertRegex(self.good("--version"), r"\Alimber \d")


class Commands(ToolCase):
    def setUp(self):
        super().setUp()
        self.device = self.fake()
        self.environment["LIMBER_PORT"] = self.device.port

    def test_info(self):
        text = self.good("info")
        for words in ("fake 0.0 test, protocol 1.3", "3 links of at most 64", "simulated", "DISARMED", "168 MHz"):
            self.assertIn(words, text)
        info = self.good_json("info")
        self.assertEqual((info["device"], info["links"], info["state"], info["protocol"]),
                         ("fake", 3, "DISARMED", "1.3"))
        self.assertEqual(info["boot"]["cause"], "POWER")
        self.assertLess(info["clock_error_us"], 20000)
        # the tool tells the device of each exchange that was answered
        self.assertGreater(info["counters"]["clock_exchanges"], 7)
        self.assertEqual(info["counters"]["lengths_restored"], 3)
        self.assertRegex(text, r"lengths_restored +3\n")
        self.device.wait_for(r"hello limber .* pose_hz 0")

    def test_tcp(self):
        device = self.fake(tcp=True)
        self.assertEqual(self.good_json("info", "--port", device.port)["device"], "fake")
        self.assertEqual(self.good_json("info", "--port", device.port.replace("127.0.0.1", "localhost"))["device"], "fake")

    def test_params(self):
        listed = {one["name"]: one for one in self.good_json("params", "list")}
        self.assertEqual(listed["spring"]["values"], [100, 100, 100])
        self.assertEqual(listed["scheme"]["choice"], "midpoint")
        self.assertTrue(listed["tick"]["read_only"])
        self.good("params", "set", "spring=5", "scheme=paper", "spring[2]=7,8")
        spring, scheme = self.good_json("params", "get", "spring", "scheme")
        self.assertEqual((spring["values"], scheme["choice"]), ([5, 7, 8], "paper"))
        self.assertIn("5 7 8 N m", self.good("params", "get", "spring"))
        self.good("params", "set", "blend=0.1")
        self.assertIn("[0.1]", self.good("params", "get", "blend", "--json"))  # not 0.100000001490116
        self.good("params", "defaults")
        self.assertEqual(self.good_json("params", "get", "spring")[0]["values"], [100, 100, 100])
        self.good("params", "save")
        self.assertEqual(self.device.requests().count("PARAM_SAVE"), 1)

    def test_params_file_and_back(self):
        self.good("params", "set", "spring=1,2.5,3e-7", "scheme=paper", "pose_hold=70")
        text = self.good("params", "list", "--ini")
        self.good("params", "defaults")
        self.good("params", "load", self.write("mine.ini", text))
        self.assertEqual(self.good("params", "list", "--ini"), text)
        # with remarks, continued lines, and no section at all
        self.good("params", "load", self.write("other.ini", "; mine\nspring = 1 2 # soft\n    3\nlinks=3\n"))
        self.assertEqual(self.good_json("params", "get", "spring")[0]["values"], [1, 2, 3])

    def test_lists_are_set_after_what_may_change_their_length(self):
        self.good("params", "set", "spring=1", "links=2")
        staged = [line for line in self.device.settled() if line.startswith("staged")]
        self.assertEqual([line.split()[1] for line in staged], ["links", "spring"])

    def test_what_was_staged_before_a_refusal_is_taken_back(self):
        self.fails(4, ["params", "set", "blend=2", "spring=-1"], "spring[1] = -1, allowed 0 ... 1e+06: out of bounds")
        self.assertNotIn("PARAM_COMMIT", self.device.requests())
        self.good("params", "set", "links=4")  # would commit what is still staged
        self.assertEqual(self.good_json("params", "get", "blend")[0]["values"], [0.3])

    def test_presets(self):
        self.assertIn("whip           limp and lively", self.good("preset"))
        self.assertEqual([one["name"] for one in self.good_json("preset")], ["foil", "whip"])
        self.assertIn("whip now", self.good("preset", "whip"))
        self.fails(4, ["preset", "sword"], "no parameter or preset of that name (foil, whip)")

    def test_control(self):
        self.fails(4, ["arm"], "refuses ARM: no good stream of poses; limber stream")
        self.assertIn("disarmed", self.good("disarm"))
        self.assertIn("state ESTOP", self.good("estop"))
        self.device.wait_for("estop without a session")  # before any handshake
        self.assertIn("ESTOP: torque off, latched", self.good("info"))
        self.fails(4, ["arm"], "latched: CLEAR_FAULT first; limber clear")
        self.assertIn("state DISARMED", self.good("clear"))

    def test_record(self):
        out = self.good("record", "angles.csv", "--seconds", "0.5")
        with open(self.folder / "angles.csv", encoding="ascii", newline="") as file:
            rows = list(csv.reader(file))
        self.assertEqual(rows[0], "t theta1 phi1 theta2 phi2 theta3 phi3".split())
        self.assertIn(f"{len(rows) - 1} rows", out)
        self.assertGreater(len(rows), 20)
        times = [float(row[0]) for row in rows[1:]]
        self.assertEqual(times[0], 0.0)
        self.assertTrue(all(a < b for a, b in zip(times, times[1:])))
        self.assertEqual({row[6] for row in rows[1:]}, {"nan"})
        self.assertLess(max(abs(float(row[1])) for row in rows[1:]), 0.1)

    def test_record_until_interrupted(self):
        process = self.start("record", "angles.csv")
        self.device.wait_for("hello.*")
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=10)
        self.assertEqual((process.returncode, err), (0, ""))
        self.assertRegex(out, r"angles.csv: \d+ rows")
        self.assertEqual([path.name for path in self.folder.glob("angles*")], ["angles.csv"])

    def test_latency(self):
        text = self.good("latency", "--seconds", "0.5")
        for words in ("p50", "line to device", "tick and solve", "reply", "200 times a second"):
            self.assertIn(words, text)
        told = self.good_json("latency", "--seconds", "0.5", "--rate", "100")
        self.assertEqual(told["sent"], 50)
        whole = told["latency"]["whole"]
        self.assertTrue(0 < whole["p50_ms"] <= whole["p99_ms"] <= whole["max_ms"] < 1000, whole)
        self.assertNotIn("ARM", self.device.requests())

    def test_ports_without_any(self):
        self.assertIsInstance(json.loads(self.good("ports", "--json")), list)
        self.good("ports")


class Versions(ToolCase):
    def test_latency_leaves_an_armed_device_alone(self):
        device = self.fake("--state", STATES["ARMING"], "--still")
        self.fails(4, ["latency", "--port", device.port], "is ARMING", "limber disarm first")
        self.assertEqual(device.poses(), [])

    def test_a_new_session_whatever_the_one_before(self):
        device = self.fake()
        for _ in range(3):
            self.good("info", "--port", device.port)
        self.assertEqual(len([line for line in device.settled() if line.startswith("hello")]), 6)


if __name__ == "__main__":
    tool_case.main()
