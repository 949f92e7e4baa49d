"""What the tests of live sources share: limber-sim device behind a tap that sees every frame, and what poses should
come to."""
import json
import math
import os
import pty
import select
import signal
import socket
import struct
import subprocess
import threading
import time
import tty

import tool_case
from frames import Frames
from tool_case import ToolCase

SIM = None
POSE, ANGLES, NODES = 0x10, 0x11, 0x12


def float32(value):
    return struct.unpack("<f", struct.pack("<f", value))[0]


class Tap:
    """Between tool and device, on a pseudo-terminal of its own: .poses, .angles, .nodes as they passed. The device's
    counters tell what arrived; here is what its values were."""

    def __init__(self, device_link):
        self.master, self.slave = pty.openpty()
        tty.setraw(self.slave)
        self.device = os.open(device_link, os.O_RDWR | os.O_NOCTTY)
        os.set_blocking(self.master, False)
        os.set_blocking(self.device, False)
        self.port = f"pty:{os.ttyname(self.slave)}"
        self.poses, self.angles, self.nodes = [], [], []
        self.stop = False
        self.thread = threading.Thread(target=self._run, daemon=True)
        self.thread.start()

    def _pass_on(self, fd, data):
        """What nobody reads is lost, as on a cable."""
        while data and select.select([], [fd], [], 0.2)[1]:
            data = data[os.write(fd, data):]

    def _run(self):
        frames = {self.master: Frames(), self.device: Frames()}
        while not self.stop:
            for fd in select.select([self.master, self.device], [], [], 0.1)[0]:
                try:
                    data = os.read(fd, 65536)
                except OSError:
                    return  # the device has been killed
                self._pass_on(self.device if fd == self.master else self.master, data)
                for kind, payload in frames[fd].take(data):
                    self._take(kind, payload)

    def _take(self, kind, payload):
        if kind == POSE:
            self.poses.append(list(struct.unpack_from("<7f", payload)) + [struct.unpack_from("<H", payload, 28)[0]])
        elif kind == ANGLES:
            self.angles.append((struct.unpack_from("<I", payload)[0], payload[10],
                                struct.unpack(f"<{(len(payload) - 12) // 2}h", payload[12:])))
        elif kind == NODES:
            tick, first, nodes_n = struct.unpack_from("<IHH", payload)
            self.nodes.append((tick, first, nodes_n, struct.unpack(f"<{(len(payload) - 8) // 4}f", payload[8:])))

    def close(self):
        self.stop = True
        self.thread.join()
        for fd in (self.master, self.slave, self.device):
            os.close(fd)


def rows_of(text):
    """The numbers of TUM lines."""
    return [[float(word) for word in line.split()] for line in text.splitlines() if line.strip() and line[0] != "#"]


def unity_to_ours(row):
    """x y z qx qy qz qw from left-handed, y up, to right-handed, z up: x mirrored, then a quarter turn about x."""
    x, y, z, qx, qy, qz, qw = row
    x, qy, qz = -x, -qy, -qz
    h = math.sqrt(0.5)
    return [x, -z, y, h * (qx + qw), h * (qy - qz), h * (qy + qz), h * (qw - qx)]


def ours_to_unity(row):
    x, y, z, qx, qy, qz, qw = row
    h = math.sqrt(0.5)
    ux, uy, uz, uw = h * (qx - qw), h * (qy + qz), h * (qz - qy), h * (qx + qw)
    return [-x, z, -y, ux, -uy, -uz, uw]


def expected(rows):
    """Rows of x y z qx qy qz qw as the device should get them: from the first one, unit length."""
    out = []
    for row in rows:
        norm = math.sqrt(sum(value * value for value in row[3:]))
        out.append([row[i] - rows[0][i] for i in range(3)] + [value / norm for value in row[3:]])
    return out


def osc_text(text):
    data = text.encode() + b"\0"
    return data + bytes(-len(data) % 4)


def osc_pose(row, serial="LHR-1", address="/VMC/Ext/Tra/Pos"):
    return osc_text(address) + osc_text(",sfffffff") + osc_text(serial) + struct.pack(">7f", *row)


def osc_bundle(*elements):
    return b"#bundle\0" + struct.pack(">Q", 1) + b"".join(struct.pack(">I", len(e)) + e for e in elements)


def free_udp_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Sender:
    """Datagrams to the tool."""

    def __init__(self, case):
        self.port = free_udp_port()
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        case.addCleanup(self.socket.close)

    def __call__(self, data):
        self.socket.sendto(data, ("127.0.0.1", self.port))


def paced(rows, rate_hz, send):
    """send(row) at an even rate."""
    start = time.monotonic()
    for n, row in enumerate(rows):
        wait = start + n / rate_hz - time.monotonic()
        if wait > 0:
            time.sleep(wait)
        send(row)


class LiveCase(ToolCase):
    def setUp(self):
        super().setUp()
        self.rod = self.folder / "rod"

    def simulator(self, *options):
        process = subprocess.Popen([SIM, "device", "--pty", "rod", *options], cwd=self.folder,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

        def stop():
            process.kill()
            process.wait()
        self.addCleanup(stop)
        deadline = time.monotonic() + 10
        while not self.rod.exists() and time.monotonic() < deadline:
            time.sleep(0.02)
        return process

    def wait_for_listener(self, port, seconds=10):
        """Somebody has a UDP port of that number, at whatever address."""
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            with open("/proc/net/udp", encoding="ascii") as four, open("/proc/net/udp6", encoding="ascii") as six:
                if f":{port:04X} " in four.read() + six.read():
                    return
            time.sleep(0.02)
        raise AssertionError(f"nobody listens at {port}")

    def tap(self):
        tap = Tap(str(self.rod))
        self.addCleanup(tap.close)
        return tap

    def stream(self, source, port=None, *options):
        process = self.start("stream", source, "--json", "--port", port or "pty:rod", *options)
        process.said = []

        def listen():
            for line in process.stderr:
                process.said.append(line.rstrip("\n"))
        process.listener = threading.Thread(target=listen, daemon=True)
        process.listener.start()
        return process

    def replace_device(self, process, device, at):
        """Kills it, and starts another on the same link: (that one, where its last news ends)."""
        device.kill()
        device.wait()
        self.rod.unlink()
        at = self.wait_until(process, "lost the device", at)
        device = self.simulator("--flash", "flash.bin")
        at = self.wait_until(process, "the device is back", at)
        return device, self.wait_until(process, "the device is ACTIVE again", at)

    def wait_until(self, process, words, after=0, seconds=20):
        """The index behind the first line on stderr, from `after` on, that has these words."""
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            for n, line in enumerate(process.said[after:]):
                if words in line:
                    return after + n + 1
            time.sleep(0.02)
        raise AssertionError(f"never said '{words}': {process.said[after:]}")

    def wait_for_state(self, state, seconds=20):
        """Only where no stream holds the port."""
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            if self.good_json("info", "--port", "pty:rod")["state"] == state:
                return
            time.sleep(0.1)
        raise AssertionError(f"the device never was {state}")

    def end(self, process, code=0):
        """Ctrl-C; the summary. Every pose is where the sum says."""
        process.send_signal(signal.SIGINT)
        out = process.stdout.read()
        self.assertEqual(process.wait(timeout=20), code, (process.said, out))
        process.listener.join(5)
        told = json.loads(out)
        poses = told["poses"]
        self.assertEqual(poses["sent"], poses["accepted"] + sum(poses["rejected"].values()) + poses["lost"] +
                         poses["unaccounted"], told)
        return told

    def assert_whole(self, tap, told, rows):
        """Each of the source's poses was sent once, equal to float32, and the device has taken in every one: what it
        did not follow, it found too old because this machine was busy."""
        wanted = expected(rows)
        self.assertEqual((told["poses_of_track"], told["poses"]["sent"]), (len(rows), len(rows)), told)
        self.assertEqual(len(tap.poses), len(rows))
        for got, want in zip(tap.poses, wanted):
            for value, right in zip(got, want):
                # the last bit of a float32 may hang on the order of operations in double
                self.assertLessEqual(abs(value - float32(right)), 1.2e-7 * max(abs(right), 1e-3), (got, want))
        self.assertTrue(told["poses"]["balances"])
        self.assertEqual((told["poses"]["lost"], told["poses"]["unaccounted"]), (0, 0))
        self.assertLessEqual(sum(told["poses"]["rejected"].values()), 0.05 * len(rows), told["poses"])


def main():
    global SIM
    import sys
    from pathlib import Path
    SIM = str(Path(sys.argv.pop(4)).resolve())
    tool_case.main()
