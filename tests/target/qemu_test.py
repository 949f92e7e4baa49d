#!/usr/bin/env python3
"""tools/dev qemu: says where to stream to, and leaves nothing behind when it is interrupted."""
import pathlib
import re
import signal
import subprocess
import sys
import unittest

import firmware_case

TOOL = pathlib.Path(__file__).resolve().parents[2] / "tools" / "firmware" / "qemu.py"


class Qemu(unittest.TestCase):
    def start(self, *words):
        """(process, port)"""
        c = firmware_case.choices
        command = [sys.executable, "-B", TOOL, "--qemu", c.qemu, "--elf", c.elf, "--sim", c.sim, "--limber", c.limber]
        process = subprocess.Popen([*command, *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.terminate)
        for line in process.stdout:
            if found := re.search(r"--port (tcp:127\.0\.0\.1:\d+) ", line):
                return process, found[1]
        return self.fail("it does not say where to stream to")

    def children(self, process):
        path = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children")
        return [int(word) for word in path.read_text().split()]

    def test_with_servos(self):
        process, port = self.start("--links", "12", "--servos")
        told = subprocess.run([firmware_case.choices.limber, "info", "--port", port], capture_output=True, text=True,
                              timeout=30, check=False)
        self.assertEqual(told.returncode, 0, told.stderr)
        self.assertIn("12", told.stdout)
        children = self.children(process)
        self.assertEqual(len(children), 2)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=20), 0)
        self.assertEqual([pid for pid in children if pathlib.Path(f"/proc/{pid}").exists()], [])

    def test_an_image_that_is_not_there(self):
        done = subprocess.run([sys.executable, "-B", TOOL, "--elf", "nowhere.elf"], capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.returncode, 1)
        self.assertIn("tools/dev firmware", done.stderr)


if __name__ == "__main__":
    firmware_case.main()
