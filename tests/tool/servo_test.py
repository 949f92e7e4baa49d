#!/usr/bin/env python3
"""limber servo with the device as limber-sim runs it and its model servos; and limber-sim servos by itself."""
import os
import re
import select
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import tool_case
from tool_case import ToolCase, track

SIM = None

# ROBOTIS e-Manual, DYNAMIXEL Protocol 2.0, 6: Ping to 1 and to all, Write 512 to Goal Position of 1
PING_1 = bytes.fromhex("ff ff fd 00 01 03 00 01 19 4e")
PING_ALL = bytes.fromhex("ff ff fd 00 fe 03 00 01 31 42")
GOAL_1 = bytes.fromhex("ff ff fd 00 01 09 00 03 74 00 00 02 00 00 ca 89")
DONE_1 = bytes.fromhex("ff ff fd 00 01 04 00 55 00 a1 0c")

SERVO_PING, SERVO_SILENT, SERVO_BEYOND = 0x39, 22, 25  # PROTOCOL.md: a message and reasons to refuse it


class ServoCase(ToolCase):
    def simulate(self, *arguments):
        """limber-sim with these arguments, up and reachable at self.place."""
        process = subprocess.Popen([SIM, *arguments], cwd=self.folder, stdout=subprocess.PIPE, text=True)

        def stop():
            process.kill()
            process.communicate()
        self.addCleanup(stop)
        self.place = process.stdout.readline().split()[-1]
        return process

    def device(self, *options):
        self.simulate("device", "--pty", "rod", *options)
        self.environment["LIMBER_PORT"] = self.place

    def ids(self, *options):
        return [row["id"] for row in self.good_json("servo", "scan", *options)]


class Scan(ServoCase):
    def test_finds_all_and_tells_how_they_are(self):
        self.device("--links", "2")
        rows = self.good_json("servo", "scan", "--last", "20")
        self.assertEqual([row["id"] for row in rows], [1, 2, 3, 4])
        self.assertEqual(rows[0], {"id": 1, "baud": 1000000, "model": 1060, "firmware": 46, "hardware_error": 0,
                                   "position_rad": 0, "supply_v": 12, "temperature_c": 31})
        lines = self.good("servo", "scan", "--first", "2", "--last", "3").splitlines()
        self.assertRegex(lines[1], r"^  2  1000000 .* fine$")
        self.assertEqual(len(lines), 3)

    def test_the_whole_range_takes_seconds(self):
        self.device("--links", "1")
        start = time.monotonic()
        self.assertEqual(self.ids(), [1, 2])
        self.assertLess(time.monotonic() - start, 20)

    def test_all_baud_rates(self):
        self.device("--servo-baud", "3000000")
        self.fails(4, ["servo", "scan", "--last", "3"], "no servo answers", "--baud all")
        rows = self.good_json("servo", "scan", "--baud", "all", "--first", "1", "--last", "2")
        self.assertEqual([(row["id"], row["baud"]) for row in rows], [(1, 3000000), (2, 3000000)])

    def test_broken_and_missing_ones(self):
        self.device("--inject", "unplug@0+1000:2", "--inject", "servo@0+1000:3")
        found = {row["id"]: row["hardware_error"] for row in self.good_json("servo", "scan", "--last", "9")}
        self.assertEqual(found, {1: 0, 3: 0x20, 4: 0, 5: 0, 6: 0, 7: 0, 8: 0})
        self.assertRegex(self.good("servo", "scan", "--first", "3", "--last", "3"), "ERROR: overload")
        self.fails(4, ["servo", "test", "2"], "servo 2 does not answer", "limber servo scan --baud all")
        self.fails(4, ["servo", "test", "3"], "servo 3 reports a hardware error", "overload")

    def test_noise(self):
        self.device("--inject", "garble@0+1000:1")
        code, _, err = self.run_tool("servo", "scan", "--first", "1", "--last", "1")
        self.assertEqual(code, 4)
        self.assertIn("servo 1 answers with noise", err)
        self.assertIn("connect one servo at a time", err)

    def test_ctrl_c_leaves_what_was_found(self):
        self.device()
        scan = self.start("servo", "scan")
        scan.stdout.readline()
        scan.stdout.readline()
        scan.send_signal(signal.SIGINT)
        out, err = scan.communicate(timeout=20)
        self.assertEqual((scan.returncode, err), (130, ""))

    def test_ctrl_c_switches_the_supply_off(self):
        fake = self.fake("--nack", SERVO_PING, "--reason", SERVO_SILENT)
        self.environment["LIMBER_PORT"] = fake.port
        scan = self.start("servo", "scan", "--baud", "all")
        fake.wait_for("request SERVO_PING")
        scan.send_signal(signal.SIGINT)
        scan.communicate(timeout=20)
        self.assertEqual(scan.returncode, 130)
        self.assertEqual(fake.requests()[-1], "DISARM")

    def test_an_id_that_is_no_channel_is_not_there(self):
        fake = self.fake("--nack", SERVO_PING, "--reason", SERVO_BEYOND)
        self.environment["LIMBER_PORT"] = fake.port
        self.fails(4, ["servo", "scan", "--last", "20"], "no servo answers at this baud rate")
        self.assertEqual(fake.requests(), ["SERVO_PING"] * 21)

    def test_echo_on_the_wire(self):
        self.device("--echo", "--links", "1")
        self.assertEqual(self.ids("--last", "3"), [1, 2])
        self.good("servo", "test", "1")


class SetUp(ServoCase):
    def test_a_servo_from_the_factory(self):
        self.device("--factory")
        self.fails(4, ["servo", "scan", "--last", "3"], "no servo answers")
        self.assertEqual(self.ids("--baud", "57600", "--last", "1"), [1])
        self.assertIn("servo 7 now", self.good("servo", "id", "1", "7", "--baud", "57600"))
        self.assertEqual(self.ids("--baud", "57600", "--last", "8"), [7])
        self.assertIn("1000000 baud", self.good("servo", "baud", "7", "1000000", "--from-baud", "57600"))
        self.assertEqual(self.ids("--last", "8"), [7])
        self.assertIn("has turned", self.good("servo", "test", "7"))
        self.assertIn("has turned", self.good("servo", "test", "7", "--turn", "-0.3"))

    def test_what_is_refused(self):
        self.device()
        self.fails(4, ["servo", "id", "3", "4"], "servo 3 cannot have that id")
        self.fails(4, ["servo", "id", "30", "40"], "servo 30 does not answer")
        self.fails(4, ["servo", "baud", "3", "123456"], "servo 3 cannot be driven at that rate")
        self.assertEqual(self.ids("--last", "4"), [1, 2, 3, 4])

    def test_arguments(self):
        for arguments in ([], ["find"], ["id", "1"], ["id", "1", "253"], ["id", "x", "2"], ["baud", "1"],
                          ["baud", "1", "5000000"], ["test"], ["test", "1", "2"], ["test", "1", "--turn", "0.6"],
                          ["test", "1", "--baud", "all"], ["scan", "--last", "253"], ["scan", "3"],
                          ["scan", "--baud", "fast"], ["scan", "--whom"]):
            self.fails(2, ["servo", *arguments])
        for arguments in (["id", "1.5", "9"], ["id", "1", "9.9"], ["baud", "2", "1000000.9"], ["test", "0.5"],
                          ["test", "1", "--baud", "57600.5"], ["baud", "1", "57600", "--from-baud", "57600.5"],
                          ["scan", "--first", "1.5"], ["scan", "--last", "1.5"]):
            self.fails(2, ["servo", *arguments], "must be a whole number")
        help_text = self.good("servo", "--help")
        for words in ("limber servo id 1 7 --baud 57600", "ALL servos on, until 10 s after", "Ctrl-C, or limber disarm",
                      "PWM channels cannot tell whether a servo is there", "jumps to the middle of its travel first"):
            self.assertIn(words, help_text)

    def test_options_that_are_not_meant_for_it(self):
        self.fails(2, ["servo", "test", "1", "--from-baud", "57600"], "--from-baud is for baud only")
        self.fails(2, ["servo", "id", "1", "2", "--first", "0"], "--first is for scan only")
        self.fails(2, ["servo", "baud", "1", "57600", "--last", "252"], "--last is for scan only")
        self.fails(2, ["servo", "scan", "--turn", "0.2"], "--turn is for test only")
        self.fails(2, ["servo", "baud", "1", "57600", "--baud", "9600", "--from-baud", "9600"], "give one of them")

    def test_ctrl_c_ends_a_test(self):
        self.device()
        for arguments in (["test", "1"], ["id", "1", "9"]):
            tool = self.start("servo", *arguments)
            time.sleep(0.3)  # of the 0.5 s that the servos boot, before anything else
            tool.send_signal(signal.SIGINT)
            out, err = tool.communicate(timeout=20)
            self.assertEqual((tool.returncode, out), (130, ""))
            self.assertRegex(err, r"\Alimber: interrupted: servo 1 was stopped[^\n]*\n\Z")
            # one still under way would keep the device busy
            self.assertEqual(self.ids("--first", "1", "--last", "1"), [1])
            self.good("disarm")  # so that they boot again

    def test_only_while_disarmed(self):
        self.device()
        self.run_tool("estop")
        self.fails(4, ["servo", "test", "1"], "limber clear")
        self.run_tool("clear")
        self.good("servo", "test", "1")

    def test_no_servos(self):
        self.device("--servos", "none")
        self.fails(4, ["servo", "scan"], "servo_kind")
        self.good("stream", self.write("track.txt", track(100)))

    def test_hobby_servos(self):
        self.device("--servos", "pwm")
        self.good("servo", "test", "8")
        self.fails(4, ["servo", "test", "9"], "channel")
        self.assertEqual(self.ids(), [1, 2, 3, 4, 5, 6, 7, 8])
        self.assertEqual(self.ids("--baud", "all"), [1, 2, 3, 4, 5, 6, 7, 8])  # once: they know no rates
        self.fails(4, ["servo", "id", "1", "2"])


class Rod(ServoCase):
    def test_turns_its_servos(self):
        self.device()
        self.good("stream", self.write("track.txt", track(150)))
        rows = self.good_json("servo", "scan", "--last", "8")
        self.assertGreater(max(abs(row["position_rad"]) for row in rows), 0.01)

    def test_a_hundred_servos(self):
        self.device("--links", "50", "--servo-baud", "4000000")
        self.good("params", "set", "servo_baud=4000000")
        self.good("stream", self.write("track.txt", track(100)))
        self.assertEqual(len(self.good_json("servo", "scan")), 100)

    def test_is_not_armed_without_one_of_its_servos(self):
        self.device("--inject", "unplug@0+1000:5")
        code, _, err = self.run_tool("stream", self.write("track.txt", track(150)))
        self.assertEqual(code, 4)
        self.assertIn("does not answer", err)
        self.assertEqual(self.good_json("info")["state"], "DISARMED")

    def test_bears_some_loss_on_the_bus(self):
        self.device("--inject", "lose@0+1000:0.01", "--inject", "garble@0+1000:0.01")
        self.good("stream", self.write("track.txt", track(150)))

    def test_stops_when_a_servo_fails(self):
        self.device("--inject", "servo@3+1000:5")
        code, _, err = self.run_tool("stream", self.write("track.txt", track(500)))
        self.assertEqual(code, 4)
        self.assertIn("FAULT", err)
        self.assertEqual(self.good_json("info")["fault"], "SERVO")


class Alone(ServoCase):
    """limber-sim servos, asked with the e-Manual's own bytes."""

    def ask(self, line, packet, answer_bytes):
        line.sendall(packet)
        got = b""
        while len(got) < answer_bytes and select.select([line], [], [], 2)[0]:
            got += line.recv(4096)
        return got

    def finish(self, process):
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=10)
        return {name.strip(): int(number) for name, number in re.findall(r"^([a-z ]+?) +(\d+)$", out, re.M)}

    def test_over_tcp(self):
        servos = self.simulate("servos", "--tcp", "127.0.0.1:0", "--count", "3", "--baud", "4000000")
        _, host, port = self.place.split(":")
        with socket.create_connection((host, int(port))) as line:
            time.sleep(0.4)  # they boot
            start = time.monotonic()
            answer = self.ask(line, PING_1, 14)
            self.assertLess(time.monotonic() - start, 0.1)
            self.assertEqual((answer[:9], answer[9:12]), (bytes.fromhex("fffffd000107005500"), bytes([0x24, 4, 46])))
            everybody = self.ask(line, PING_ALL, 42)
            self.assertEqual([everybody[at] for at in (4, 18, 32)], [1, 2, 3])
            self.assertEqual(self.ask(line, GOAL_1, 11), DONE_1)
            self.assertEqual(self.ask(line, b"\xff\xfd" + GOAL_1[:9] + PING_1, 14), answer)
        counts = self.finish(servos)
        self.assertEqual((servos.returncode, counts["ping"], counts["write"], counts["goals"], counts["refused"]),
                         (0, 3, 1, 1, 0))

    def test_over_a_pty_with_echo_and_a_missing_servo(self):
        servos = self.simulate("servos", "--pty", "bus", "--echo", "--inject", "unplug@0+1000:1")
        line = os.open(self.folder / "bus", os.O_RDWR | os.O_NOCTTY)
        self.addCleanup(os.close, line)
        time.sleep(0.4)
        os.write(line, PING_1)
        got = b""
        while select.select([line], [], [], 0.3)[0]:
            got += os.read(line, 4096)
        self.assertEqual(got, PING_1)
        self.assertEqual(self.finish(servos)["answers"], 0)

    def test_arguments(self):
        for arguments in ([], ["--tcp", "here"], ["--pty", "a", "--tcp", "127.0.0.1:0"], ["--count", "0"],
                          ["--baud", "12345"], ["--inject", "rust@1"], ["more"]):
            done = subprocess.run([SIM, "servos", *arguments], capture_output=True, text=True, cwd=self.folder,
                                  check=False)
            self.assertEqual(done.returncode, 2, arguments)
            self.assertRegex(done.stderr, r"\Alimber-sim: [^\n]+\n\Z")


if __name__ == "__main__":
    SIM = str(Path(sys.argv.pop(4)).resolve())
    tool_case.main()
