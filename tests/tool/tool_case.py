"""What the tests of the PC tool share: the tool, a fake device that misbehaves on demand, a folder for each test."""
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

# A shell's background job ignores Ctrl-C and hands that on: the programs under test are to be stopped by it.
signal.signal(signal.SIGINT, signal.default_int_handler)

LIMBER = FAKE = SHIM = None  # the arguments of the test program
STATES = {name: number for number, name in enumerate(
    "BOOT SELFTEST DISARMED ARMING ACTIVE HOLD RELAX LIMP FAULT ESTOP".split())}


def track(poses_n, rate_hz=100.0):
    """TUM lines of a hand that moves gently and turns."""
    import math
    lines = ["# made by a test"]
    for n in range(poses_n):
        t = n / rate_hz
        half = 0.2 * math.sin(2 * t)
        lines.append(f"{100 + t:.6f} {3 + 0.1 * math.sin(3 * t):.9f} {-2 + 0.05 * t:.9f} {1.1:.9f} "
                     f"0 {math.sin(half):.9f} 0 {math.cos(half):.9f}")
    return "\n".join(lines) + "\n"


class Fake:
    """A fake device in a process of its own; what it tells is in .lines."""

    def __init__(self, folder, *ways, tcp=False):
        self.link = None if tcp else str(folder / "rod")
        arguments = [FAKE, *([] if tcp else ["--pty", self.link]), *map(str, ways)]
        self.process = subprocess.Popen(arguments, stdout=subprocess.PIPE, text=True)
        self.lines = []
        self.news = threading.Condition()
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()
        place = self.wait_for(r"ready (.*)").group(1)
        self.port = f"tcp:{place}" if tcp else f"pty:{place}"

    def _read(self):
        for line in self.process.stdout:
            with self.news:
                self.lines.append(line.rstrip("\n"))
                self.news.notify_all()

    def wait_for(self, pattern, seconds=20, after=0):
        """The match of a line, which may have come already."""
        deadline, looked_at = time.monotonic() + seconds, after
        with self.news:
            while True:
                for line in self.lines[looked_at:]:
                    found = re.fullmatch(pattern, line)
                    if found:
                        return found
                looked_at = len(self.lines)
                if time.monotonic() > deadline:
                    raise AssertionError(f"the device never told {pattern}: {self.lines[-20:]}")
                self.news.wait(0.1)

    def settled(self):
        """All lines, once no more come."""
        before = -1
        while before != len(self.lines):
            before = len(self.lines)
            time.sleep(0.05)
        return list(self.lines)

    def requests(self):
        return [line.split()[1] for line in self.settled() if line.startswith("request ")]

    def poses(self):
        """(seq, t_us, age_us, [x y z qx qy qz qw]) of each POSE."""
        found = []
        for line in self.settled():
            words = line.split()
            if words[0] == "pose":
                found.append((*map(int, words[1:4]), [float.fromhex(word) for word in words[4:]]))
        return found

    def close(self):
        self.process.kill()
        self.process.wait()
        self.reader.join()
        self.process.stdout.close()


class ToolCase(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="limber-test-"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.environment = {name: value for name, value in os.environ.items() if name != "LIMBER_PORT"}

    def write(self, name, content):
        path = self.folder / name
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    def fake(self, *ways, **options):
        fake = Fake(self.folder, *ways, **options)
        self.addCleanup(fake.close)
        return fake

    def start(self, *arguments, **options):
        process = subprocess.Popen([LIMBER, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   text=True, cwd=self.folder, env=self.environment, **options)

        def close():
            process.kill()
            process.communicate()
        self.addCleanup(close)
        return process

    def run_tool(self, *arguments, **options):
        """(exit code, stdout, stderr)"""
        done = subprocess.run([LIMBER, *map(str, arguments)], capture_output=True, text=True, errors="replace",
                              cwd=self.folder, timeout=60, env=self.environment, **options)
        return done.returncode, done.stdout, done.stderr

    def good(self, *arguments, **options):
        code, out, err = self.run_tool(*arguments, **options)
        self.assertEqual((code, err), (0, ""), arguments)
        return out

    def good_json(self, *arguments, **options):
        return json.loads(self.good(*arguments, "--json", **options))

    def fails(self, expected, arguments, *says, **options):
        """Runs, expects that exit code and one line on stderr that says so; returns it."""
        code, _, err = self.run_tool(*arguments, **options)
        self.assertEqual(code, expected, (arguments, err))
        self.assertRegex(err, r"\Alimber: [^\x00-\x1f\x7f]+\n\Z", arguments)
        for words in says:
            self.assertIn(words, err, arguments)
        return err


def main():
    global LIMBER, FAKE, SHIM
    if len(sys.argv) < 4:
        sys.exit(f"usage: {Path(sys.argv[0]).name} LIMBER FAKE_DEVICE SERIAL_SHIM [UNITTEST_ARGUMENT...]")
    LIMBER, FAKE, SHIM = (str(Path(sys.argv.pop(1)).resolve()) for _ in range(3))
    unittest.main(module="__main__")
