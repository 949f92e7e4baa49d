"""What the tests of the booted image share: a board for each test, the PC tool, a hand that moves."""
import argparse
import contextlib
import functools
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

import emulated
import line_log

choices = None  # the arguments of the test program
ATTEMPTS_N = 3
BUSY = ("poses stayed away", "does not answer", "answers with noise")


class TooBusy(Exception):
    """The emulator runs in real time, and the machine it runs on had something else to do."""


def again_if_too_busy(test):
    """For tests that need this machine to keep up: what cannot be told from that is tried again, aloud."""
    @functools.wraps(test)
    def attempt(self, *arguments):
        for attempts_left in reversed(range(ATTEMPTS_N)):
            try:
                return test(self, *arguments)
            except TooBusy as why:
                if not attempts_left:
                    raise
                print(f"again, this machine was perhaps too busy: {why}", flush=True)
        return None
    return attempt


def float32(value=0.0, bits=None):
    packed = struct.pack("<f", value) if bits is None else struct.pack("<I", bits)
    return struct.unpack("<f", packed)[0]


def length_s(track):
    times = [float(line.split()[0]) for line in track.read_text(encoding="utf-8").splitlines()
             if line and line[0] not in "#\n"]
    return times[-1] - times[0]


class FirmwareCase(unittest.TestCase):
    def setUp(self):
        self.stack = contextlib.ExitStack()
        self.addCleanup(self.stack.close)
        self.board = self.line = self.folder = None

    def boot(self, **how):
        """A board, instead of the last one, that has told HELLO and BOOT_REPORT; self.line overhears it."""
        self.stack.close()
        self.folder = pathlib.Path(self.stack.enter_context(tempfile.TemporaryDirectory()))
        self.board = self.stack.enter_context(emulated.Board(choices.qemu, choices.elf, self.folder, held=True, **how))
        self.line = line_log.Line(self.board.connect())
        self.stack.callback(self.line.close)
        with self.board.debugger():
            pass  # with somebody to hear it, now it may go
        self.line.wait_for(line_log.BOOT_REPORT)

    def run_program(self, *command, text=None):
        return subprocess.run([str(word) for word in command], input=text, capture_output=True, text=True, check=True,
                              timeout=60).stdout

    def limber(self, command, *words):
        """(exit code, stdout, stderr)"""
        done = subprocess.run([choices.limber, command, *map(str, words), "--port", f"tcp:127.0.0.1:{self.line.port}"],
                              capture_output=True, text=True, timeout=120, check=False)
        return done.returncode, done.stdout, done.stderr

    def good(self, command, *words):
        code, out, err = self.limber(command, *words)
        self.assertEqual(code, 0, f"limber {command} {words}: {err}{out}\n{self.board.complaints()}")
        return out

    def good_json(self, command, *words):
        return json.loads(self.good(command, *words, "--json"))

    def stream(self, *words):
        """What limber stream tells. It follows the track to its end, or the machine was too busy."""
        code, out, err = self.limber("stream", "--json", *words)
        if code == 4 and any(sign in err for sign in BUSY):
            raise TooBusy(err)
        self.assertEqual(code, 0, err + out)
        return json.loads(out)

    def track(self, seconds=3.0, rate_hz=100.0):
        """A TUM file of a hand that swings and turns."""
        path = self.folder / "track.txt"
        lines = ["# made by a test"]
        for n in range(int(seconds * rate_hz)):
            t = n / rate_hz
            half = 0.3 * math.sin(4 * t)
            x, y, z = 0.15 * math.sin(5 * t), 0.1 * math.sin(3 * t), 0.05 * math.sin(7 * t)
            lines.append(f"{100 + t:.6f} {x:.9f} {y:.9f} {z:.9f} 0 {math.sin(half):.9f} 0 {math.cos(half):.9f}")
        path.write_text("\n".join(lines) + "\n", encoding="ascii")
        return path

    def start_stream(self, seconds=60.0):
        """limber stream as a process of its own, ended with the test."""
        command = [choices.limber, "stream", str(self.track(seconds)), "--port", f"tcp:127.0.0.1:{self.line.port}"]
        tool = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.stack.callback(tool.stdout.close)
        self.stack.callback(tool.wait)
        self.stack.callback(tool.kill)
        return tool

    def wait_for_state(self, name, after=0, seconds=10):
        return self.line.wait_for(line_log.HEARTBEAT, lambda p: line_log.heartbeat(p)["state"] == name, seconds, after)

    @staticmethod
    def states_in_order(states):
        """Names of the states of (tick, state), each once for each time it was entered."""
        names = [line_log.STATES[state] for _, state in states]
        return [name for name, before in zip(names, [None, *names]) if name != before]


def main():
    global choices
    parser = argparse.ArgumentParser()
    for name in ("qemu", "elf", "limber", "sim"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--replay", help="replay_pose_log")
    parser.add_argument("--build", nargs="+", help="where the image's objects and their call graph are")
    parser.add_argument("--all-tracks", action="store_true", help="of the shared ones; else one")
    parser.add_argument("--shared-tracks", type=pathlib.Path, default=pathlib.Path("/nowhere"))
    choices, rest = parser.parse_known_args()
    unittest.main(argv=[sys.argv[0], *rest], verbosity=2)
