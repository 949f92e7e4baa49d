#!/usr/bin/env python3
"""What the PC tool says when something is wrong: one line with what, where, and what to try; the exit code."""
import fcntl
import os
import pty
import socket

import tool_case
from tool_case import STATES, ToolCase, track

BAD_ARGUMENTS = [
    ([], "no command given"), (["play"], "unknown command 'play'"),
    (["info", "--prot", "x"], "--prot: unknown option; try limber info --help"),
    (["info", "rod"], "unexpected 'rod'"), (["info", "--port", "usb0"], "--port usb0: must be serial:"),
    (["info", "--port", "serial:"], "must be serial:"), (["info", "--port"], "--port"),
    (["stream", "--port", "pty:x"], "no track given; try limber stream --help"),
    (["stream", "a", "b"], "one track at a time"), (["stream", "a", "--speed", "0"], "--speed 0: must be max or"),
    (["stream", "a", "--speed", "fast"], "--speed fast: must be"),
    (["stream", "a", "--resample", "0.5"], "--resample 0.5: must be a number from 1 to 2000"),
    (["stream", "a", "--up", "x"], "--up x: must be y or z"), (["stream", "a", "--scale", "0"], "--scale 0"),
    (["stream", "a", "--mount", "1,2"], "--mount 1,2: must be X,Y,Z or"),
    (["stream", "a", "--mount", "1,2,3,4"], "--mount 1,2,3,4: must be"),
    (["stream", "a", "--mount", "1,2,3,4,5,6,7"], "--mount"), (["stream", "a", "--mount", "1,2,3,"], "--mount"),
    (["stream", "a", "--mount", "1,2,nan"], "--mount"), (["stream", "a", "--mount", "11,0,0"], "at most 10 m"),
    (["stream", "no-such.txt", "--port", "pty:x"], "no-such.txt: No such file"),
    (["stream", "-", "--resample", "100", "--port", "pty:x"], "add --speed 1"),
    (["params"], "say what: list, get, set"), (["params", "put"], "params put: must be list"),
    (["params", "get"], "say which"), (["params", "set"], "say NAME=VALUE"),
    (["params", "set", "spring"], "params set spring: must be NAME=VALUE"),
    (["params", "load"], "say which file"), (["params", "load", "no.ini"], "no.ini: No such file"),
    (["params", "load", "bad.ini"], "bad.ini:2: neither a [section]"),
    (["params", "load", "empty.ini"], "empty.ini: no parameter in it"),
    (["params", "save", "x.ini"], "unexpected 'x.ini'"),
    (["record"], "no file to write given"), (["record", "x.csv", "--seconds", "0"], "--seconds 0"),
    (["latency", "--rate", "0"], "--rate 0"), (["latency", "now"], "unexpected 'now'"),
    (["ports", "all"], "unexpected 'all'"),
]


class BadInput(ToolCase):
    def test_arguments(self):
        self.write("bad.ini", "[rod]\nspring\n")
        self.write("empty.ini", "# nothing\n")
        for arguments, says in BAD_ARGUMENTS:
            self.fails(2, arguments, says)

    def test_parameters(self):
        port = ["--port", self.fake().port]
        self.fails(2, ["params", "get", "sprung", *port], "no parameter 'sprung'")
        self.fails(2, ["params", "set", "sprung=1", *port], "params set: the device has no parameter 'sprung'")
        self.fails(2, ["params", "set", "spring=soft", *port], "spring = soft: not a number")
        self.fails(2, ["params", "set", "spring=", *port], "spring has no value")
        self.fails(2, ["params", "set", "spring[0]=1", *port], "counted from 1")
        self.fails(2, ["params", "set", "scheme=euler", *port], "scheme = euler: must be one of midpoint|paper")
        self.fails(4, ["params", "set", "tick=0.01", *port], "tick: cannot be set")
        self.fails(4, ["params", "set", "spring[3]=1,2", *port], "spring: more or other entries")
        self.fails(4, ["params", "set", "spring=nan", *port], "spring[1] = nan")
        self.write("mine.ini", "[rod]\nlinks = 3\nspring = 1\n    -2 3\n")
        self.fails(4, ["params", "load", "mine.ini", *port], "mine.ini:3: the device refuses PARAM_SET: spring[2] = -2")
        self.write("mine.ini", "sprung = 1\n")
        self.fails(2, ["params", "load", "mine.ini", *port], "mine.ini:1: the device has no parameter 'sprung'")


class Ports(ToolCase):
    def test_none_there(self):
        self.fails(4, ["info", "--port", "pty:no/such"], "no/such: there is no such port", "simulator running?")
        self.fails(4, ["info", "--port", "serial:/dev/ttyUSB77"], "/dev/ttyUSB77: there is no such port")
        self.fails(4, ["info", "--port", "/dev/ttyUSB77"], "/dev/ttyUSB77: there is no such port")
        self.fails(4, ["info", "--port", "serial:/dev/ttyUSB77@fast"], "baud rate must be a number")
        self.fails(4, ["info", "--port", f"pty:{self.write('file', '')}"], "is no serial port")
        self.fails(4, ["info", "--port", "pty:/dev/null"], "is no serial port")
        self.fails(4, ["info", "--port", "tcp:127.0.0.1"], "must be tcp:HOST:PORT")
        with socket.socket() as server:
            server.bind(("127.0.0.1", 0))  # not listening
            self.fails(4, ["info", "--port", f"tcp:127.0.0.1:{server.getsockname()[1]}"], "Connection refused",
                       "limber-sim device --tcp")

    def test_nothing_given_and_nothing_there(self):
        code, _, err = self.run_tool("info")
        self.assertEqual(code, 4)
        self.assertRegex(err, "no USB serial port is there; plug the board in|may be a board|nothing answers")

    def test_busy(self):
        device = self.fake()
        with open(device.link, "rb+", buffering=0) as taken:
            fcntl.flock(taken, fcntl.LOCK_EX)
            self.fails(4, ["info", "--port", device.port], "in use by another program (", "ModemManager")
        self.good("info", "--port", device.port)


class WrongDevice(ToolCase):
    def test_nobody_answers(self):
        self.fails(4, ["info", "--port", self.fake("--mute").port], "nothing answers, not one byte")

    def test_somebody_else(self):
        self.fails(4, ["info", "--port", self.fake("--text", "$GPGGA,1234\r\n").port], "bytes came, but no limber device",
                   "beginning with '$GPGGA,1234", "115200")

    def test_deaf(self):
        self.fails(4, ["info", "--port", self.fake("--deaf").port], "talks there but does not hear")

    def test_hung_up(self):
        master, slave = pty.openpty()
        name = os.ttyname(slave)
        os.close(slave)
        os.close(master)
        self.fails(4, ["info", "--port", f"pty:{name}"], "there is no such port")

    def test_versions(self):
        self.fails(4, ["info", "--port", self.fake("--major", "2").port], "speaks protocol 2.3", "get a newer limber")
        err = self.fails(4, ["info", "--port", self.fake("--nack", 1, "--reason", 2).port],
                         "other major version", "not with me")
        self.assertIn("this limber", err)
        code, out, err = self.run_tool("info", "--port", self.fake("--other-hash").port)
        self.assertEqual(code, 0)
        self.assertIn("developer's build", err)
        self.assertIn("DISARMED", out)


class Answers(ToolCase):
    def test_repeated_until_answered(self):
        device = self.fake("--drop-requests", "3")
        self.good("info", "--port", device.port)
        self.assertEqual(device.requests(), ["STATS_GET"] + 8 * ["SCENE_GET"])

    def test_never_answered(self):
        device = self.fake("--drop-requests", "9")
        self.fails(4, ["disarm", "--port", device.port], "does not answer DISARM, though it is alive")

    def test_refused(self):
        device = self.fake("--nack", 0x34, "--reason", 16)  # PARAM_SAVE, DISARMED_ONLY
        self.fails(4, ["params", "save", "--port", device.port],
                   "refuses PARAM_SAVE: only while DISARMED (because?I say so); limber disarm")
        device = self.fake("--nack", 0x21, "--reason", 99)
        self.fails(4, ["disarm", "--port", device.port], "reason 99, which this limber does not know")

    def test_garbage_between_the_frames(self):
        device = self.fake("--garbage")
        self.assertEqual(self.good_json("info", "--port", device.port)["device"], "fake")
        self.assertEqual(len(self.good_json("params", "list", "--port", device.port)), 6)

    def test_slow_source(self):
        slow = self.write("slow.txt", track(30, rate_hz=10))
        device = self.fake()
        self.fails(4, ["stream", slow, "--port", device.port], "a pose every 100.0 ms (10.0 a second) is too slow",
                   "50 ms", "--resample 100")
        self.assertEqual(device.poses(), [])
        device = self.fake("--nack", 0x31, "--reason", 9, "--state", STATES["DISARMED"])
        self.run_tool("stream", slow, "--port", device.port, "--speed", "3")  # nothing known of a timeout: tried

    def test_device_finds_the_source_too_slow(self):
        path = self.write("track.txt", track(50, rate_hz=25))
        self.fails(4, ["stream", path, "--port", self.fake("--nack", 1, "--reason", 8).port],
                   "track.txt: 25.0 poses a second are too slow", "hold timeout", "--resample 100")

    def test_latched(self):
        device = self.fake("--state", STATES["FAULT"])
        self.fails(4, ["stream", self.write("track.txt", track(50)), "--port", device.port],
                   "refuses ARM: a fault or e-stop is latched", "limber clear")
        self.assertIn("fault      DEADLINE", self.good("info", "--port", device.port))


if __name__ == "__main__":
    tool_case.main()
