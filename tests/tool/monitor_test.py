#!/usr/bin/env python3
"""limber monitor in terminals of several sizes and makes: what it shows, that it only watches, how it leaves."""
import math
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import tool_case
from terminal import Terminal
from tool_case import STATES, Fake, ToolCase

SIM = None
SIZES = ((24, 80), (12, 40), (60, 200))
JOINT = re.compile(r"(\d+) ([.|=-]+) +([+-]\d+\.\d) ([.|=-]+) +([+-]\d+\.\d)")


def phi_deg(joint):
    """What the fake device says of a joint, from 1: tests/tool/fake_swing.c."""
    return math.degrees(0.01 * (joint - 1)) * (1 if joint % 2 == 1 else -1)


class MonitorCase(ToolCase):
    def monitor(self, port, rows=24, columns=80, term="xterm-256color", more=(), **environment):
        terminal = Terminal([tool_case.LIMBER, "monitor", "--port", port, *more], rows, columns, cwd=self.folder,
                            env={**self.environment, "TERM": term, **environment})
        self.addCleanup(terminal.close)
        return terminal

    def swinging(self, joints_n):
        return self.fake("--swing", joints_n, "--state", STATES["ACTIVE"])

    def joints(self, terminal):
        """{joint: (bar of theta, degrees, bar of phi, degrees)} of what the screen shows."""
        return {int(number): (theta_bar, float(theta), phi_bar, float(phi))
                for number, theta_bar, theta, phi_bar, phi in JOINT.findall(terminal.text())}

    def check_joint(self, joint, shown, full_deg):
        for bar, angle in (shown[:2], shown[2:]):
            half = len(bar) // 2
            self.assertEqual(bar[half], "|", (joint, bar))
            left, right = bar[:half], bar[half + 1:]
            filled, empty = (left[::-1], right) if angle < 0 else (right, left)
            self.assertRegex(filled, r"\A=*-?\.*\Z")
            self.assertEqual(set(empty), {"."}, (joint, bar, angle))
            length = filled.count("=") + 0.5 * filled.count("-")
            self.assertAlmostEqual(length, min(abs(angle) / full_deg, 1) * half, delta=0.3, msg=(joint, bar, angle))
        self.assertAlmostEqual(shown[3], phi_deg(joint), delta=0.051)


class Picture(MonitorCase):
    def test_sizes_and_terminals(self):
        for rows, columns in SIZES:
            for term in ("vt100", "xterm-256color"):
                device = self.swinging(64)
                with self.subTest(rows=rows, columns=columns, term=term):
                    terminal = self.monitor(device.port, rows, columns, term)
                    terminal.wait_for(r"poses (99|100|101)/s, refused 1\.0, lost 0")
                    terminal.wait_for(r"limited rate \d+ %")
                    text = terminal.text()
                    self.assertRegex(text, r"\A fake 0\.0 test  64 links .* up \d:\d\d:\d\d\n")
                    self.assertIn("\n ACTIVE  following the poses\n", text)
                    self.assertRegex(text, r"poses_late \d+ \+[12]")
                    full_deg = float(re.search(r"theta, phi: degrees, of (\d+)", text).group(1))
                    joints = self.joints(terminal)
                    self.assertEqual(sorted(joints), list(range(1, len(joints) + 1)))
                    self.assertGreaterEqual(len(joints), {24: 20, 12: 4, 60: 64}[rows])
                    for joint, shown in joints.items():
                        self.check_joint(joint, shown, full_deg)
                    terminal.read(0.35)
                    self.assertNotEqual([j[1] for j in self.joints(terminal).values()],
                                        [j[1] for j in joints.values()], "it does not move")
                    terminal.type("q")
                    self.assertEqual(terminal.finish(), 0)

    def test_scrolling(self):
        terminal = self.monitor(self.swinging(64).port)
        shown_n = int(terminal.wait_for(r"; 1-(\d+) of 64").group(1))
        terminal.type("\x1bOB\x1bOB")  # as an xterm sends arrows to who has asked for the keypad
        terminal.wait_for(rf"; 3-{shown_n + 2} of 64")
        self.assertEqual(sorted(self.joints(terminal)), list(range(3, shown_n + 3)))
        terminal.type("\x1b[6~" * 5)
        terminal.wait_for(rf"; {65 - shown_n}-64 of 64")
        terminal.type("k")
        terminal.wait_for(rf"; {64 - shown_n}-63 of 64")
        terminal.type("\x1b[5~" * 5)
        terminal.wait_for(rf"; 1-{shown_n} of 64")

    def test_resizing(self):
        terminal = self.monitor(self.swinging(20).port)
        terminal.wait_for(r"poses 1\d\d/s")
        for rows, columns in ((12, 40), (60, 200), (5, 20), (1, 1), (24, 80)):
            terminal.resize(rows, columns)
            terminal.read(0.5)
        terminal.wait_for(r"poses 1\d\d/s")
        self.assertEqual(sorted(self.joints(terminal)), list(range(1, 21)))
        self.assertEqual(terminal.text().count("following the poses"), 1)

    def test_colour_is_only_an_addition(self):
        device = self.swinging(3)
        texts = []
        for term, environment, coloured in (("xterm-256color", {}, True), ("xterm-256color", {"NO_COLOR": "1"}, False),
                                            ("xterm-256color", {"NO_COLOR": ""}, True), ("vt100", {}, False)):
            terminal = self.monitor(device.port, term=term, **environment)
            terminal.wait_for("limited rate")
            self.assertEqual(terminal.screen.colour, coloured, (term, environment))
            texts.append(terminal.screen.lines()[:2])
            terminal.type("q")
            self.assertEqual(terminal.finish(), 0)
        self.assertEqual(len({lines[1] for lines in texts}), 1)

    def test_fault(self):
        terminal = self.monitor(self.fake("--state", STATES["FAULT"]).port)
        terminal.wait_for(r"\n FAULT  torque off, latched.*\n DEADLINE: a tick took longer than it may\n")
        self.assertIn("no limit acts", terminal.text())


class Behaviour(MonitorCase):
    def test_help(self):
        text = self.good("monitor", "--help")
        self.assertIn("Usage: limber monitor", text)
        self.assertIn("never arms", text)
        self.assertLess(max(map(len, text.splitlines())), 130)
        self.assertIn("\n  monitor ", self.good("--help"))
        self.fails(2, ["monitor", "now"], "unexpected 'now'")
        self.fails(2, ["monitor", "--seconds", "0"], "--seconds 0")

    def test_leaves_the_terminal_as_it_was(self):
        device = self.swinging(3)
        for leave in ("q", "\x03", signal.SIGTERM, signal.SIGHUP):
            terminal = self.monitor(device.port)
            terminal.wait_for("ACTIVE")
            self.assertTrue(terminal.screen.alternate)
            self.assertFalse(terminal.is_as_before())
            if isinstance(leave, str):
                terminal.type(leave)
            else:
                terminal.process.send_signal(leave)
            self.assertEqual(terminal.finish(), 0, leave)
            self.assertTrue(terminal.is_as_before(), leave)

    def test_only_watches(self):
        device = self.swinging(3)
        terminal = self.monitor(device.port)
        terminal.wait_for(r"poses 1\d\d/s")
        self.assertEqual(set(device.requests()), {"STATS_GET"})
        self.assertEqual(device.poses(), [])
        # a port has one owner
        self.fails(4, ["info", "--port", device.port], "in use")
        terminal.type("q")
        self.assertEqual(terminal.finish(), 0)
        recording = self.start("record", "angles.csv", "--port", device.port)
        device.wait_for("hello .*", after=len(device.settled()) - 1)
        hellos_n = sum(line.startswith("hello") for line in device.settled())
        self.fails(4, ["monitor", "--port", device.port], "in use")
        self.assertEqual(sum(line.startswith("hello") for line in device.settled()), hellos_n)
        recording.send_signal(signal.SIGINT)
        self.assertEqual(recording.wait(10), 0)

    def test_lost_and_found_again(self):
        device = self.swinging(3)
        terminal = self.monitor(device.port)
        terminal.wait_for(r"poses 1\d\d/s")
        device.close()
        terminal.wait_for("LOST: .*")
        again = Fake(self.folder, "--swing", 4, "--state", STATES["HOLD"])
        self.addCleanup(again.process.kill)
        terminal.wait_for(r"4 links[^\x00]*\n (HOLD|ACTIVE)")
        self.assertNotIn("LOST", terminal.text())
        again.close()
        terminal.wait_for("LOST: .*")
        terminal.type("q")
        self.assertEqual(terminal.finish(), 4)
        self.assertIn("limber: lost the device", terminal.text())
        self.assertTrue(terminal.is_as_before())

    def test_seconds(self):
        device = self.swinging(3)
        start = time.monotonic()
        terminal = self.monitor(device.port, more=["--seconds", "1.5"])
        self.assertEqual(terminal.finish(), 0)
        self.assertGreater(time.monotonic() - start, 1.5)
        self.assertTrue(terminal.is_as_before())


class Plain(MonitorCase):
    LINE = re.compile(r" +(\d+\.\d) s  ACTIVE    angles (\d+)/s  tick 20 us, max 30 \(3 %\)"
                      r"(  poses \d+/s, refused 1(\.\d)?, lost 0)?(  apart 10\.\d ms, jitter \d\.\d\d, max \d+\.\d)"
                      r"  limited rate \d+ %  largest theta\d [+-]\d+\.\d deg(  poses_late \d+ \+\d)?")

    def check(self, lines, lines_n):
        self.assertEqual(len(lines), lines_n, lines)
        for second, line in enumerate(lines, 1):
            found = self.LINE.fullmatch(line)
            self.assertTrue(found, line)
            self.assertAlmostEqual(float(found.group(1)), second, delta=0.3)
            self.assertGreater(int(found.group(2)), 100, line)

    def test_a_line_a_second(self):
        port = self.swinging(3).port
        self.check(self.good("monitor", "--port", port, "--seconds", "3.5").splitlines(), 3)  # a pipe
        for term, more in (("dumb", []), ("no-such-terminal", []), ("xterm", ["--plain"])):
            terminal = self.monitor(port, 24, 250, term, [*more, "--seconds", "2.5"])
            self.assertEqual(terminal.finish(), 0)
            self.check([line for line in terminal.screen.lines() if line], 2)
            self.assertNotIn("\x1b", terminal.raw)

    def test_reader_goes_away(self):
        process = self.start("monitor", "--plain", "--port", self.swinging(3).port)
        process.stdout.readline()
        process.stdout.close()
        process.stdout = subprocess.DEVNULL  # nothing to collect at the end
        process.wait(10)
        process.stdout = None


class Histogram(MonitorCase):
    def test_every_pose_is_in_a_bar(self):
        port = self.fake().port
        latency = self.good_json("latency", "--histogram", "--seconds", "1", "--port", port)["latency"]
        bars = latency["histogram"]
        self.assertEqual(sum(bar["poses"] for bar in bars), latency["poses"])
        self.assertGreater(latency["poses"], 50)
        for one, next_one in zip(bars, bars[1:]):
            self.assertEqual(one["to_ms"], next_one["from_ms"])
        self.assertGreaterEqual(bars[-1]["to_ms"], latency["whole"]["max_ms"])
        self.assertLessEqual(bars[-1]["from_ms"], latency["whole"]["max_ms"])
        self.assertNotIn("histogram", self.good_json("latency", "--seconds", "0.2", "--port", port)["latency"])

    def test_bars_are_drawn(self):
        text = self.good("latency", "--histogram", "--seconds", "1", "--port", self.fake().port)
        poses_n = int(re.search(r"of (\d+) poses", text).group(1))
        bars = re.findall(r"^ +\d+\.\d{3} \.\.\. +\d+\.\d{3} +(\d+) ?(#*)$", text, re.MULTILINE)
        self.assertEqual(sum(int(n) for n, _ in bars), poses_n)
        most = max(int(n) for n, _ in bars)
        self.assertEqual([len(bar) for _, bar in bars], [math.ceil(50 * int(n) / most) for n, _ in bars])


class Simulator(MonitorCase):
    def test_estop_and_what_the_device_says(self):
        device = subprocess.Popen([SIM, "device", "--pty", "rod", "--links", "5", "--inject", "estop@3+60"],
                                  cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(device.wait)
        self.addCleanup(device.kill)
        deadline = time.monotonic() + 10
        while not (self.folder / "rod").exists() and time.monotonic() < deadline:
            time.sleep(0.02)
        terminal = self.monitor("pty:rod")
        terminal.wait_for(r"limber-sim .* 5 links [^\x00]*\n DISARMED  servos without torque")
        self.assertEqual(len(self.joints(terminal)), 5)
        terminal.wait_for(r"\n ESTOP  torque off, latched.*\n the e-stop input says stop\n")
        terminal.wait_for(r"\n limber: the device says: emergency stop$")
        terminal.type("q")
        self.assertEqual(terminal.finish(), 0)
        self.assertIn("limber: the device says: emergency stop", terminal.text())


    def test_of_a_stream(self):
        device = subprocess.Popen([SIM, "device", "--pty", "rod"], cwd=self.folder, stdout=subprocess.DEVNULL,
                                  stderr=subprocess.DEVNULL)
        self.addCleanup(device.wait)
        self.addCleanup(device.kill)
        deadline = time.monotonic() + 10
        while not (self.folder / "rod").exists() and time.monotonic() < deadline:
            time.sleep(0.02)
        hand = self.write("hand.txt", tool_case.track(3000))
        self.fails(2, ["stream", hand, "--monitor", "--port", "pty:rod"], "--monitor needs a terminal")
        terminal = Terminal([tool_case.LIMBER, "stream", hand, "--monitor", "--port", "pty:rod"], 24, 80,
                            cwd=self.folder, env={**self.environment, "TERM": "xterm-256color"})
        self.addCleanup(terminal.close)
        terminal.wait_for(r"\n ARMING ")
        terminal.wait_for(r"\n ACTIVE  following the poses\n")
        terminal.wait_for(r"poses (9\d|10\d)/s")
        terminal.wait_for(r"pose -> angles \d+\.\d ms, p99 \d+\.\d")
        terminal.wait_for(r"apart (9|10)\.\d ms")
        self.assertEqual(len(self.joints(terminal)), 4)
        terminal.type("q")
        self.assertEqual(terminal.finish(), 130)  # as by Ctrl-C: disarmed first
        self.assertTrue(terminal.is_as_before())
        self.assertIn("every pose is accounted for", terminal.text())
        self.assertEqual(self.good_json("info", "--port", "pty:rod")["state"], "DISARMED")


if __name__ == "__main__":
    if len(sys.argv) < 5:
        sys.exit(f"usage: {Path(sys.argv[0]).name} LIMBER FAKE_DEVICE SERIAL_SHIM LIMBER_SIM [UNITTEST_ARGUMENT...]")
    SIM = str(Path(sys.argv.pop(4)).resolve())
    tool_case.main()
