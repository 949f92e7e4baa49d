#!/usr/bin/env python3
"""tools/dev qemu: says where to stream to, leaves nothing behind when it is interrupted, and refuses what cannot be;
and limber servo scan with what only a board's own UART refuses."""
import json
import pathlib
import re
import signal
import socket
import subprocess
import sys
import unittest

import firmware_case

TOOL = pathlib.Path(__file__).resolve().parents[2] / "tools" / "firmware" / "qemu.py"
BAUDS = (9600, 57600, 115200, 1000000, 2000000, 3000000, 4000000)  # of smart servos, but 4500000


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
        self.scan_passes_over_a_rate_that_the_board_cannot_make(port)
        children = self.children(process)
        self.assertEqual(len(children), 2)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=20), 0)
        self.assertEqual([pid for pid in children if pathlib.Path(f"/proc/{pid}").exists()], [])

    def scan_passes_over_a_rate_that_the_board_cannot_make(self, port):
        """The model servos understand every other one: nobody can tell them which it is."""
        told = subprocess.run([firmware_case.choices.limber, "servo", "scan", "--baud", "all", "--first", "1", "--last",
                               "2", "--json", "--port", port], capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual((told.returncode, told.stderr),
                         (0, "limber: 4500000 baud: skipped, the board cannot make that rate\n"))
        found = {(row["baud"], row["id"]) for row in json.loads(told.stdout)}
        self.assertEqual(found, {(baud, i) for baud in BAUDS for i in (1, 2)})

    def refuses(self, *words):
        done = subprocess.run([sys.executable, "-B", TOOL, *words], capture_output=True, text=True, check=False,
                              timeout=20)
        self.assertEqual(done.stdout, "")
        return done.returncode, done.stderr.splitlines()[-1]

    def test_a_port_in_use(self):
        with socket.create_server(("127.0.0.1", 0)) as taken:
            port = taken.getsockname()[1]
            # a QEMU that is not there: it is not even tried
            code, said = self.refuses("--elf", __file__, "--qemu", "nowhere", "--port", str(port), "--servos")
        self.assertEqual((code, said), (1, f"qemu: --port {port}: Address already in use; choose another, or none"))

    def test_bounds(self):
        for links in ("0", "65", "1.5", "-1"):
            code, said = self.refuses("--links", links)
            self.assertEqual(code, 2)
            self.assertIn(f"argument --links: {links}: must be a whole number from 1 to 64", said)
        self.assertIn("from 1 to 65535", self.refuses("--port", "65536")[1])

    def test_an_image_that_is_not_there(self):
        done = subprocess.run([sys.executable, "-B", TOOL, "--elf", "nowhere.elf"], capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.returncode, 1)
        self.assertIn("tools/dev firmware", done.stderr)


if __name__ == "__main__":
    firmware_case.main()
