#!/usr/bin/env python3
"""The way through libserialport, on a PTY that a preloaded shim makes look like a USB serial port."""
import fcntl
import os
import struct
import subprocess

import tool_case
from tool_case import ToolCase, track


class Serial(ToolCase):
    def setUp(self):
        super().setUp()
        # the sanitizer's runtime must come first; it is told that it does not
        self.environment["LD_PRELOAD"] = tool_case.SHIM
        self.environment["ASAN_OPTIONS"] = "verify_asan_link_order=0:detect_leaks=0"
        if "/dev/pts/" not in os.path.realpath(self.fake().link):
            self.skipTest("PTYs are not /dev/pts/N here")

    def port(self, device, baud=""):
        return f"serial:{os.path.realpath(device.link)}{baud}"

    def test_info(self):
        device = self.fake()
        self.assertEqual(self.good_json("info", "--port", self.port(device))["device"], "fake")
        self.assertIn("fake", self.good("info", "--port", self.port(device, "@115200")))

    def test_baud_rate_arrives(self):
        device = self.fake()
        process = self.start("record", "angles.csv", "--seconds", "1", "--port", self.port(device, "@921600"))
        device.wait_for("hello.*")
        with open(device.link, "rb", buffering=0) as line:
            termios2 = fcntl.ioctl(line, 0x802C542A, bytes(44))  # TCGETS2; stty knows no such rates
        self.assertEqual(struct.unpack("=4I20x2I", termios2)[4:], (921600, 921600))
        settings = subprocess.run(["stty", "-a", "-F", os.path.realpath(device.link)], capture_output=True, text=True,
                                  check=True).stdout
        for word in ("cs8", "-cstopb", "-parenb", "-crtscts", "-icanon", "-echo", "-ixon", "-opost"):
            self.assertIn(word, settings.replace(";", " ").split(), settings)
        self.assertEqual(process.wait(timeout=10), 0)

    def test_stream(self):
        device = self.fake()
        out = self.good("stream", self.write("track.txt", track(100)), "--port", self.port(device))
        self.assertIn("every pose is accounted for", out)
        self.assertEqual(len(device.poses()), int(out.split("sent ")[1].split(",")[0]))

    def test_unplugged(self):
        device = self.fake("--close-after", "50")
        code, _, err = self.run_tool("stream", self.write("track.txt", track(300)), "--port", self.port(device))
        self.assertEqual(code, 4)
        self.assertRegex(err, "lost the device: serial:.* is gone")

    def test_busy(self):
        device = self.fake()
        process = self.start("record", "angles.csv", "--seconds", "1", "--port", self.port(device))
        device.wait_for("hello.*")
        self.fails(4, ["info", "--port", self.port(device)], "in use by another program (", ", process ")
        self.assertEqual(process.wait(timeout=10), 0)

    def test_refused_by_the_system(self):
        device = self.fake()
        self.environment["LIMBER_SHIM_OPEN_ERRNO"] = "13"
        self.fails(4, ["info", "--port", self.port(device)], "permission denied", "usermod -a -G dialout $USER")
        self.environment["LIMBER_SHIM_OPEN_ERRNO"] = "16"
        self.fails(4, ["info", "--port", self.port(device)], "in use by another program")

    def test_latency_timer(self):
        device = self.fake()
        self.environment["LIMBER_SHIM_LATENCY_TIMER"] = "16"
        code, _, err = self.run_tool("info", "--port", self.port(device))
        self.assertEqual(code, 0)
        self.assertRegex(err, r"gathers bytes for 16 ms .*; echo 1 \| sudo tee /sys/bus/usb-serial/devices/\d+/latency_timer")
        self.environment["LIMBER_SHIM_LATENCY_TIMER"] = "1"
        self.assertEqual(self.run_tool("info", "--port", self.port(device))[2], "")


if __name__ == "__main__":
    tool_case.main()
