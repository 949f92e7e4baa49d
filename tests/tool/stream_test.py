#!/usr/bin/env python3
"""limber stream: what reaches the device and when, where every pose went, and how it ends, whatever happens."""
import json
import math
import os
import pty
import re
import select
import signal
import struct
import subprocess
import time

import tool_case
from tool_case import STATES, ToolCase, track


def float32(value):
    return struct.unpack("<f", struct.pack("<f", value))[0]


def product(a, b):
    """Hamilton, x y z w."""
    return [a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
            a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
            a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
            a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]]


def turned(q, v):
    return product(product(q, [*v, 0.0]), [-q[0], -q[1], -q[2], q[3]])[:3]


def about(axis, degrees):
    q = [0.0, 0.0, 0.0, math.cos(math.radians(degrees) / 2)]
    q[axis] = math.sin(math.radians(degrees) / 2)
    return q


def samples(text):
    rows = [[float(word) for word in line.split()] for line in text.splitlines() if line[0] != "#"]
    for row in rows:
        norm = math.sqrt(sum(x * x for x in row[4:]))
        row[4:] = [x / norm for x in row[4:]]
    return rows


class Streaming(ToolCase):
    def stream(self, device, *arguments, code=0, **options):
        """The summary of a stream, as JSON, and stderr."""
        result, out, err = self.run_tool("stream", *arguments, "--port", device.port, "--json", **options)
        self.assertEqual(result, code, (arguments, out, err))
        told = json.loads(out)
        self.assertEqual(told["exit_code"], code)
        poses = told["poses"]
        self.assertEqual(poses["sent"], poses["accepted"] + sum(poses["rejected"].values()) + poses["lost"] +
                         poses["unaccounted"])
        return told, err

    def assert_pose(self, got, position, quaternion):
        for value, wanted in zip(got, [*position, *quaternion]):
            # the last bit of a float32 may hang on the order of operations in double
            self.assertLessEqual(abs(value - float32(wanted)), 1.2e-7 * max(abs(wanted), 1e-3), (got, position, quaternion))


class Values(Streaming):
    def played(self, device, told):
        return device.poses()[-told["poses_of_track"]:]

    def test_poses_as_they_are(self):
        text = track(60)
        rows = samples(text)
        device = self.fake()
        told, _ = self.stream(device, self.write("track.txt", text))
        poses = self.played(device, told)
        self.assertEqual(len(poses), 60)
        for row, (_, _, _, values) in zip(rows, poses):
            self.assert_pose(values, [row[i] - rows[0][i] for i in (1, 2, 3)], row[4:])
        self.assertEqual([value == float32(value) for _, _, _, values in poses for value in values].count(False), 0)
        seqs = [seq for seq, _, _, _ in device.poses()]
        self.assertEqual(seqs, list(range(len(seqs))))

    def test_own_pace_and_honest_ages(self):
        text = track(80, rate_hz=200)
        device = self.fake()
        told, _ = self.stream(device, self.write("track.txt", text), "--speed", "0.5")
        poses = self.played(device, told)
        captured = [(t_us - age_us) % 2**32 for _, t_us, age_us, _ in poses]
        for n, moment in enumerate(captured):
            self.assertLessEqual(abs((moment - captured[0]) % 2**32 - n * 10000), 2)
        self.assertLess(sorted(age_us for _, _, age_us, _ in poses)[40], 5000)
        self.assertTrue(0.75 < told["duration_s"] < 2, told["duration_s"])
        device.wait_for("hello limber .* pose_hz 100")

    def test_axes_scale_and_mount(self):
        text = track(40)
        rows = samples(text)
        offset, roll, pitch, yaw = [0.1, -0.05, 0.3], 20.0, -35.0, 110.0
        turn = product(about(2, yaw), product(about(1, pitch), about(0, roll)))
        device = self.fake()
        told, _ = self.stream(device, self.write("track.txt", text), "--dry", "--scale", "0.5", "--left-handed",
                              "--up", "y", "--mount", "0.1,-0.05,0.3,20,-35,110")
        base = []
        for row in rows:
            x, y, z = -row[1] * 0.5, row[2] * 0.5, row[3] * 0.5
            q = product(about(0, 90), [row[4], -row[5], -row[6], row[7]])
            position = [a + b for a, b in zip([x, -z, y], turned(q, offset))]
            base.append((position, product(q, turn)))
        for (position, q), (_, _, _, values) in zip(base, self.played(device, told)):
            self.assert_pose(values, [a - b for a, b in zip(position, base[0][0])], q)
        self.assertNotIn("ARM", device.requests())

    def test_resampled(self):
        text = track(11, rate_hz=10)
        rows = samples(text)
        device = self.fake()
        told, _ = self.stream(device, self.write("slow.txt", text), "--resample", "100")
        poses = self.played(device, told)
        self.assertEqual(len(poses), 101)
        for n, (_, _, _, values) in enumerate(poses):
            a, b = rows[n // 10], rows[min(n // 10 + 1, 10)]
            u = n % 10 / 10
            self.assert_pose(values[:3], [a[i] + u * (b[i] - a[i]) - rows[0][i] for i in (1, 2, 3)], [])
        device.wait_for("hello limber .* pose_hz 100")

    def test_csv_and_an_angles_file(self):
        lines = ["timestamp,tx,ty,tz,qw,qx,qy,qz"]
        lines += [f"{n / 100},{n / 1000},0,0,1,0,0,0" for n in range(50)]
        device = self.fake()
        told, _ = self.stream(device, self.write("track.csv", "\n".join(lines)), "--angles", "angles.csv")
        self.assertEqual(told["poses_of_track"], 50)
        rows = (self.folder / "angles.csv").read_text(encoding="ascii").splitlines()
        self.assertEqual(rows[0], "t,theta1,phi1,theta2,phi2,theta3,phi3")
        self.assertEqual(len(rows) - 1, told["angles"])
        self.assertGreater(told["latency"]["poses"], 20)


class Accounts(Streaming):
    def setUp(self):
        super().setUp()
        self.track = self.write("track.txt", track(120))

    def test_all_accepted(self):
        device = self.fake()
        out = self.good("stream", self.track, "--port", device.port)
        self.assertIn("every pose is accounted for", out)
        self.assertRegex(out, r"pose -> angles +[\d.]+ +[\d.]+ +[\d.]+")
        self.assertEqual(device.requests()[-2:], ["DISARM", "STATS_GET"])
        self.assertLess(device.settled().index("request ARM"), len(device.lines) - 120)

    def test_lost_and_rejected(self):
        told, _ = self.stream(self.fake("--drop-poses", "7", "--reject-poses", "10"), self.track)
        self.assertGreater(told["poses"]["lost"], 15)
        self.assertGreater(told["poses"]["rejected"]["teleport"], 9)

    def test_speed_max_and_dry(self):
        device = self.fake("--drop-poses", "9")
        told, _ = self.stream(device, self.track, "--speed", "max", "--dry")
        self.assertEqual(told["poses"]["sent"], 120)
        self.assertEqual(told["poses"]["lost"], 13)
        self.assertNotIn("ARM", device.requests())
        self.assertNotIn("DISARM", device.requests())

    def test_garbage_on_the_line(self):
        told, _ = self.stream(self.fake("--garbage"), self.track)
        self.assertEqual(told["poses"]["accepted"], told["poses"]["sent"])

    def test_a_device_that_cannot_count(self):
        told, _ = self.stream(self.fake("--lie", "5"), self.track, code=1)
        self.assertEqual(told["poses"]["unaccounted"], 5)
        told, _ = self.stream(self.fake("--lie", "-5"), self.track, code=1)
        self.assertEqual(told["poses"]["unaccounted"], -5)
        self.assertFalse(told["poses"]["balances"])

    def test_tcp(self):
        told, _ = self.stream(self.fake(tcp=True), self.track)
        self.assertTrue(told["poses"]["balances"])


class Ends(Streaming):
    def setUp(self):
        super().setUp()
        self.track = self.write("track.txt", track(1000, rate_hz=200))

    def interrupted(self, device, number, *arguments):
        process = self.start("stream", self.track, "--port", device.port, *arguments)
        device.wait_for("request ARM")
        device.wait_for("pose 60 .*")
        process.send_signal(number)
        sent = time.monotonic()
        out, err = process.communicate(timeout=10)
        self.assertLess(time.monotonic() - sent, 3)
        return process.returncode, out, err

    def test_interrupts_disarm_first(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            device = self.fake()
            code, out, err = self.interrupted(device, number)
            self.assertEqual((code, err), (130, ""))
            self.assertIn("(interrupted)", out)
            self.assertIn("every pose is accounted for", out)
            self.assertEqual(device.requests()[-2:], ["DISARM", "STATS_GET"])
            device.close()

    def test_interrupted_while_arming(self):
        device = self.fake("--still")
        process = self.start("stream", self.track, "--port", device.port)
        device.wait_for("request ARM")
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=10)
        self.assertEqual(process.returncode, 130)
        self.assertIn("DISARM", device.requests())

    def test_interrupted_with_requests_that_get_lost(self):
        device = self.fake("--drop-requests", "2")
        code, _, err = self.interrupted(device, signal.SIGINT)
        self.assertEqual((code, err), (130, ""))
        self.assertIn("DISARM", device.requests())

    def test_silent(self):
        device = self.fake("--silent-after", "100")
        process = self.start("stream", self.track, "--port", device.port, "--json")
        device.wait_for("silent")
        start = time.monotonic()
        out, err = process.communicate(timeout=10)
        self.assertLess(time.monotonic() - start, 2)
        self.assertEqual(process.returncode, 4)
        self.assertRegex(err, r"lost the device: nothing came from it for 0\.\d s; is the cable in")
        self.assertIn("could not be told to disarm", err)
        self.assertFalse(json.loads(out)["poses"]["balances"])

    def test_closed(self):
        for tcp in (False, True):
            code, _, err = self.run_tool("stream", self.track, "--port", self.fake("--close-after", "100", tcp=tcp).port)
            self.assertEqual(code, 4)
            self.assertRegex(err, "lost the device: .* is gone")

    def test_faults(self):
        for state, says in (("FAULT", "limber clear leaves it"), ("ESTOP", "limber clear leaves it"),
                            ("RELAX", "--resample 100 fills the gaps"), ("DISARMED", "somebody else")):
            device = self.fake("--fall-after", "150", "--fall-to", STATES[state])
            code, out, err = self.run_tool("stream", self.track, "--port", device.port)
            self.assertEqual(code, 4, err)
            self.assertIn(f"the device stopped following after", err)
            self.assertIn(f"it is in {state}", err)
            self.assertIn(says, err)
            self.assertIn("every pose is accounted for", out)
            if state == "FAULT":
                self.assertIn("reports fault DEADLINE: a tick took longer than it may; 1200 us", err)
            self.assertIn("DISARM", device.requests())
            device.close()

    def test_gaps_of_the_track(self):
        rows = track(100).splitlines()
        self.write("gap.txt", "\n".join(rows[:50] + [f"{100 + 1.7 + n / 100:.3f} 3 -2 1.1 0 0 0 1" for n in range(30)]))
        device = self.fake()
        code, _, err = self.run_tool("stream", "gap.txt", "--port", device.port)
        self.assertEqual(code, 4)
        self.assertIn("it is in RELAX", err)
        device.close()
        self.stream(self.fake(), "gap.txt", "--resample", "100")


class Reconnects(Streaming):
    def setUp(self):
        super().setUp()
        self.track = self.write("track.txt", track(300, rate_hz=200))

    def test_back_with_its_counters(self):
        device = self.fake("--close-after", "100", "--reopen-ms", "700")
        told, err = self.stream(device, self.track, "--reconnect")
        self.assertIn("trying again until it is back", err)
        self.assertRegex(err, r"back after \d\.\d s, state DISARMED; it stays without torque \(--rearm")
        self.assertEqual(told["reconnects"], 1)
        self.assertGreater(told["skipped"], 40)
        self.assertTrue(told["poses"]["balances"])
        self.assertEqual(device.requests().count("ARM"), 1)
        # the track went on where it would have been
        self.assertEqual(told["poses_of_track"] + told["skipped"], 300)

    def test_rearmed(self):
        device = self.fake("--close-after", "100", "--reopen-ms", "300")
        told, err = self.stream(device, self.track, "--rearm")
        self.assertIn("it will be armed again", err)
        self.assertEqual(device.requests().count("ARM"), 2)
        self.assertEqual(device.requests().count("DISARM"), 1)
        self.assertTrue(told["poses"]["balances"])

    def test_back_without_its_counters(self):
        told, _ = self.stream(self.fake("--close-after", "100", "--reopen-ms", "300", "--reboots"), self.track,
                              "--reconnect", code=1)
        self.assertGreater(told["poses"]["unaccounted"], 90)

    def test_never_back(self):
        device = self.fake("--close-after", "100")
        process = self.start("stream", self.track, "--port", device.port, "--reconnect")
        device.wait_for("closed")
        time.sleep(1)
        self.assertIsNone(process.poll())
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=10)
        self.assertIn(process.returncode, (1, 130))
        self.assertIn("trying again", err)


class StandardInput(Streaming):
    def live(self, device, *arguments):
        return self.start("stream", "-", "--port", device.port, "--json", *arguments, stdin=subprocess.PIPE)

    def feed(self, process, lines):
        for line in lines:
            process.stdin.write(line + "\n")
            process.stdin.flush()
            time.sleep(0.01)

    def test_lines_as_they_come(self):
        device = self.fake()
        process = self.live(device)
        lines = track(60).splitlines()
        lines.insert(20, "")
        lines.insert(30, "what is this")
        lines.insert(40, "101 0 0 0 0 0 0 0")
        self.feed(process, lines)
        out, err = process.communicate(timeout=10)
        self.assertEqual(process.returncode, 0, err)
        told = json.loads(out)
        self.assertEqual((told["poses_of_track"], told["unreadable_lines"]), (60, 1))
        self.assertRegex(err, r"\Alimber: standard input:31: not 'timestamp tx .*: 'what is this'; left out, as all like it\n\Z")
        self.assertIn("ARM", device.requests())
        self.assertIn("DISARM", device.requests())
        rows = samples(track(60))
        for row, (_, _, age_us, values) in zip(rows, device.poses()):
            self.assert_pose(values, [row[i] - rows[0][i] for i in (1, 2, 3)], row[4:])
            self.assertLess(age_us, 1000)

    def test_interrupted(self):
        device = self.fake()
        process = self.live(device)
        self.feed(process, track(60).splitlines())
        process.send_signal(signal.SIGINT)
        process.wait(timeout=10)
        self.assertEqual(process.returncode, 0)
        self.assertIn("DISARM", device.requests())

    def test_a_file_keeps_its_pace(self):
        path = self.write("track.txt", track(50))
        with open(path, encoding="ascii") as file:
            told, _ = self.stream(self.fake(), "-", stdin=file)
        self.assertGreater(told["duration_s"], 0.4)
        process = self.start("stream", "-", "--speed", "1", "--resample", "50", "--json", "--port", self.fake().port,
                             stdin=subprocess.PIPE)
        out, _ = process.communicate(track(50), timeout=20)
        self.assertEqual(json.loads(out)["poses_of_track"], 25)

    def test_too_fast_to_be_live(self):
        process = self.start("stream", "-", "--dry", "--port", self.fake().port, stdin=subprocess.PIPE)
        out, _ = process.communicate(track(200), timeout=20)
        self.assertIn("--speed 1 keeps to their times", out)


class Terminal(Streaming):
    def test_progress(self):
        device = self.fake()
        path = self.write("track.txt", track(100))
        master, slave = pty.openpty()
        process = subprocess.Popen([tool_case.LIMBER, "stream", str(path), "--port", device.port], stdout=slave,
                                   stderr=slave, cwd=self.folder, env=self.environment)
        os.close(slave)
        text = b""
        while select.select([master], [], [], 10)[0]:
            try:
                text += os.read(master, 4096)
            except OSError:
                break
        os.close(master)
        self.assertEqual(process.wait(timeout=10), 0)
        self.assertRegex(text.decode(), r"\rarming: ")
        self.assertRegex(text.decode(), r"\r\d\.\d of 1\.0 s, \d+ poses, ACTIVE, pose -> angles \d")
        self.assertTrue(re.search(r"\r\x1b\[Kstream ", text.decode()), text)


if __name__ == "__main__":
    tool_case.main()
