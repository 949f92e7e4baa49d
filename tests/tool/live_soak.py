#!/usr/bin/env python3
"""Long streams: ten minutes from a VRPN server with live graphics, every pose accounted
for and no memory taken; then source and device each dropping out twenty times, ending ACTIVE.

    live_soak.py LIMBER FAKE_DEVICE SERIAL_SHIM LIMBER_SIM [SECONDS]
"""
import socket
import sys
import threading
import time

import live_case
from live_case import LiveCase, free_udp_port, osc_pose, rows_of
from tool_case import track
from vrpn_server import Server, play

SECONDS = 600.0


def resident_kb(process):
    with open(f"/proc/{process.pid}/status", encoding="ascii") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmRSS:"))


class Feeder:
    """An OSC source at 100 Hz that can be stopped and started."""

    def __init__(self, case):
        self.port, self.going, self.end = free_udp_port(), threading.Event(), threading.Event()
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.thread = threading.Thread(target=self._run, daemon=True)
        self.thread.start()
        case.addCleanup(self.close)

    def _run(self):
        rows, n = rows_of(track(1000)), 0
        rows += rows[::-1]  # there and back: no jump at the end
        while not self.end.wait(0.01):
            if self.going.is_set():
                self.socket.sendto(osc_pose(rows[n % len(rows)][1:8]), ("127.0.0.1", self.port))
                n += 1

    def close(self):
        self.end.set()
        self.thread.join()
        self.socket.close()


class Soak(LiveCase):
    def test_long(self):
        self.simulator()
        server = Server()
        self.addCleanup(server.close)
        process = self.stream(f"vrpn:Tracker0@127.0.0.1:{server.port}", None, "--graphics",
                              f"osc:127.0.0.1:{free_udp_port()}")
        server.wait_for_client()
        rows = rows_of(track(1000, rate_hz=250))
        rows = [row[1:8] for row in rows + rows[::-1]]
        timed = [[n / 250, *rows[n % len(rows)]] for n in range(int(SECONDS * 250))]
        half = len(timed) // 2  # the table of 65536 moments by seq is in use to its end after 262 s
        play(server, timed[:half])
        before_kb = resident_kb(process)
        play(server, timed[half:])
        after_kb = resident_kb(process)
        time.sleep(0.02)  # the last pose is on its way, and the device follows still
        told = self.end(process)
        poses = told["poses"]
        print(f"{SECONDS:g} s, {poses['sent']} poses, rejected {poses['rejected']}, lost {poses['lost']}; "
              f"resident {before_kb} -> {after_kb} KB; {told['source']}")
        self.assertEqual((told["state_at_end"], poses["unaccounted"], poses["lost"]), ("ACTIVE", 0, 0), process.said)
        self.assertEqual((told["poses_of_track"], poses["sent"]), (len(timed), len(timed)))
        self.assertTrue(poses["balances"])
        self.assertLess(after_kb - before_kb, 200)

    def test_dropouts(self):
        times = 20 if SECONDS >= 600 else 2
        device = self.simulator("--flash", "flash.bin")
        feeder = Feeder(self)
        process = self.stream(f"osc:{feeder.port}", None, "--rearm")
        feeder.going.set()
        time.sleep(3)
        before_kb = resident_kb(process)
        at = 0
        for _ in range(times):
            feeder.going.clear()
            at = self.wait_until(process, "silent for", at)
            at = self.wait_until(process, "is in RELAX; it is armed again when poses come", at)
            feeder.going.set()
            at = self.wait_until(process, "back after", at)
            at = self.wait_until(process, "the device is ACTIVE again", at)
            device, at = self.replace_device(process, device, at)
        after_kb = resident_kb(process)
        told = self.end(process, code=1)  # what the dead devices had got nobody can know
        print(f"{times} dropouts each; resident {before_kb} -> {after_kb} KB; {told['source']}")
        self.assertEqual((told["state_at_end"], told["reconnects"], told["armings"]), ("ACTIVE", times, 1 + 2 * times))
        self.assertGreaterEqual(told["source"]["silences"], times)
        self.assertLess(after_kb - before_kb, 200)


if __name__ == "__main__":
    if len(sys.argv) > 5 and sys.argv[5].replace(".", "").isdigit():
        SECONDS = float(sys.argv.pop(5))
    live_case.main()
