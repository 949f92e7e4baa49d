"""What a device says on its line, overheard: a relay between a PC tool and the device that keeps all frames."""
import pathlib
import select
import socket
import struct
import sys
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "tool"))
from frames import Frames  # noqa: E402  (where it is found must be said first)

HEARTBEAT, ANGLES, POSE_LOG, FAULT, BOOT_REPORT = 0x06, 0x11, 0x13, 0x45, 0x46  # message types
STATES = "BOOT SELFTEST DISARMED ARMING ACTIVE HOLD RELAX LIMP FAULT ESTOP".split()


def angles(payload):
    """(tick, state, [tenths of a mrad])"""
    tick, _, _, _, state, _ = struct.unpack_from("<IHHHBB", payload)
    return tick, state, list(struct.unpack_from(f"<{(len(payload) - 12) // 2}h", payload, 12))


def pose_log(payload):
    """(tick, state, flags, [7 floats as bits])"""
    tick, *bits, _, state, flags = struct.unpack("<I7IIBB", payload)
    return tick, state, flags, bits


def heartbeat(payload):
    state, fault, flags, uptime_ms = struct.unpack_from("<BBBI", payload)
    return {"state": STATES[state], "fault": fault, "torque": bool(flags & 1), "uptime_ms": uptime_ms}


def boot_report(payload):
    names = "cause fault settings clock flags clock_hz settings_sequence pc lr cfsr".split()
    return dict(zip(names, struct.unpack("<5B5I", payload)))


RELAY_S = 0.001  # QEMU sends byte by byte: to take each at once would keep a processor busy


class Line:
    """The device's line, with a relay's port for the PC tool: limber ... --port tcp:127.0.0.1:{line.port}.

    Without a tool connected it goes on listening. frames has all that came, in order: (moment, type, payload)."""

    def __init__(self, connection):
        self.device = connection
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        self.frames = []
        self.decoder = Frames()
        self.spoil = None  # what a test does to bytes on their way to the device
        self.ended = False
        self.thread = threading.Thread(target=self.relay)
        self.thread.start()

    def relay(self):
        tool = None
        while not self.ended:
            time.sleep(RELAY_S)
            ready = select.select([self.device, tool or self.listener], [], [], 0.05)[0]
            if self.device in ready:
                data = self.device.recv(65536)
                if not data:
                    break
                for frame in self.decoder.take(data):
                    self.frames.append((time.monotonic(), *frame))
                tool = self.pass_on(tool, data)
            if tool in ready:
                data = self.hear(tool)
                if data:
                    self.device.sendall(self.spoil(data) if self.spoil else data)
                else:
                    tool.close()
                    tool = None
            elif self.listener in ready:
                tool = self.listener.accept()[0]
                tool.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        if tool:
            tool.close()

    @staticmethod
    def hear(tool):
        try:
            return tool.recv(65536)
        except OSError:  # it has gone without a word
            return b""

    @staticmethod
    def pass_on(tool, data):
        try:
            if tool:
                tool.sendall(data)
            return tool
        except OSError:  # it has gone
            tool.close()
            return None

    def end_of_last(self, kind):
        """How many frames there are up to the last of that type."""
        return 1 + max(n for n, (_, found, _) in enumerate(self.frames) if found == kind)

    def of(self, kind, after=0):
        """Payloads of that type, from the after-th frame on."""
        return [payload for _, found, payload in self.frames[after:] if found == kind]

    def wait_for(self, kind, good=lambda payload: True, seconds=10, after=0):
        """The first such payload that is good, which may have come already."""
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            for payload in self.of(kind, after):
                if good(payload):
                    return payload
            time.sleep(0.02)
        raise AssertionError(f"nothing of type {kind:#x} came that is as it should be, in {seconds} s; of all "
                             f"{len(self.frames) - after} frames: {sorted({f[1] for f in self.frames[after:]})}")

    def close(self):
        self.ended = True
        self.thread.join()
        self.listener.close()
        self.device.close()
