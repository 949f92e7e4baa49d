#!/usr/bin/env python3
"""Live sources that fail, with limber-sim device: late, silent, gone and back; a device that goes; hostile bytes."""
import random
import signal
import socket
import struct
import threading
import time

import live_case
from live_case import LiveCase, Sender, osc_bundle, osc_pose, osc_text, paced, rows_of
from tool_case import track
from vrpn_server import Server, message, play, pose


class Dropouts(LiveCase):
    def test_source_comes_and_goes(self):
        """Late, silent for a moment, gone for long, back: the device follows at the end."""
        self.simulator()
        port = socket.create_server(("127.0.0.1", 0))
        number = port.getsockname()[1]
        port.close()
        process = self.stream(f"vrpn:Tracker0@127.0.0.1:{number}")
        at = self.wait_until(process, "cannot reach the server: Connection refused; trying again")
        rows = rows_of(track(5000, rate_hz=100))
        server = Server(number)
        server.wait_for_client()
        play(server, rows[:350])
        at = self.wait_until(process, "silent for 0.1", at)
        time.sleep(0.1)
        play(server, rows[350:500])
        at = self.wait_until(process, "back after", at)
        server.close()
        at = self.wait_until(process, "lost the server", at)
        at = self.wait_until(process, "waited for too long and is in RELAX; it is armed again when poses come", at)
        time.sleep(4.5)  # longer than arming is ever tried for
        server = Server(number)
        self.addCleanup(server.close)
        server.wait_for_client()
        play(server, rows[500:900], company=False)
        told = self.end(process)
        self.assertTrue(any("connected" in line for line in process.said[at:]))
        self.assertTrue(any("the device is ACTIVE again" in line for line in process.said[at:]))
        self.assertEqual((told["state_at_end"], told["armings"]), ("ACTIVE", 2))
        self.assertEqual(told["source"]["connections"], 2)
        self.assertGreaterEqual(told["source"]["silences"], 2)
        self.assertGreater(told["source"]["longest_silence_s"], 0.5)
        self.assertTrue(told["poses"]["balances"])

    def test_device_comes_and_goes(self):
        device = self.simulator("--flash", "flash.bin")
        send = Sender(self)
        process = self.stream(f"osc:{send.port}", None, "--rearm")
        stop = threading.Event()
        rows = rows_of(track(6000))

        def feed():
            for row in rows:
                if stop.wait(0.01):
                    return
                send(osc_pose(row[1:8]))
        feeder = threading.Thread(target=feed, daemon=True)
        feeder.start()
        time.sleep(2.5)
        at = 0
        for _ in range(2):
            device, at = self.replace_device(process, device, at)
        told = self.end(process, code=1)  # what the dead devices had got nobody can know
        stop.set()
        feeder.join()
        self.assertEqual((told["state_at_end"], told["armings"], told["reconnects"]), ("ACTIVE", 3, 2))
        self.assertGreater(told["skipped"], 0)
        self.assertEqual(told["source"]["silences"], 0)

    def test_line_stalls(self):
        """The device hears nothing for a while, of its own line's making; it is armed again as after a silence."""
        self.simulator("--inject", "stall@4+0.56")
        send = Sender(self)
        process = self.stream(f"osc:{send.port}", None, "--rearm")
        paced(rows_of(track(900)), 100, lambda row: send(osc_pose(row[1:8])))
        told = self.end(process)
        self.assertEqual(told["state_at_end"], "ACTIVE", process.said)


class Hostile(LiveCase):
    """Counted, never fatal, and poses go on."""

    def test_osc(self):
        self.simulator()
        send = Sender(self)
        process = self.stream(f"osc:{send.port}#T", None, "--dry")
        time.sleep(0.5)
        good, dice = osc_pose([0, 0, 0, 0, 0, 0, 1], "T"), random.Random(5)
        nan, infinite = float("nan"), float("inf")
        bad = [b"", b"/", b"#bundle\0", b"#bundle\0" + bytes(8), osc_bundle(good)[:-4], osc_bundle(good)[:18],
               b"#bundle\0" + bytes(8) + b"\xff\xff\xff\xff" + good, b"#bundle\0" + bytes(8) + b"\0\0\0\x05" + good,
               osc_text("/VMC/Ext/Tra/Pos"),
               osc_text("/VMC/Ext/Tra/Pos") + osc_text(",sfff") + osc_text("T") + bytes(12),
               osc_text("/VMC/Ext/Tra/Pos") + osc_text(",sddddddd") + osc_text("T") + bytes(56),
               osc_text("/VMC/Ext/Tra/Pos") + osc_text(",fffffff") + bytes(28),
               osc_text("/VMC/Ext/Tra/Pos") + osc_text(",bfffffff") + struct.pack(">I", 2**31) + bytes(28),
               osc_pose([0] * 6 + [1], "T" * 5000), osc_pose([nan, 0, 0, 0, 0, 0, 1], "T"),
               osc_pose([0, 0, 0, infinite, 0, 0, 1], "T"), osc_pose([0] * 7, "T"), dice.randbytes(60000)]
        bad += [good[:n] for n in range(len(good))]
        bad += [osc_bundle(osc_bundle(osc_bundle(b"")))] + [osc_bundle(dice.randbytes(4 * n)) for n in range(50)]
        for n in range(2000):
            spoilt = bytearray(osc_bundle(good, good) if n % 2 else good)
            for _ in range(dice.randint(1, 8)):
                spoilt[dice.randrange(len(spoilt))] = dice.randrange(256)
            bad.append(bytes(spoilt[:dice.randint(0, len(spoilt))]))
        for n, data in enumerate(bad):
            send(data)
            if n % 20 == 0:
                time.sleep(0.002)
        told_before = time.monotonic()
        while time.monotonic() - told_before < 1:  # a flood: far more than any line carries
            send(good)
        self.assertIsNone(process.poll(), process.said)
        time.sleep(0.5)
        for n in range(100):
            send(osc_pose([0.001 * n, 0, 0, 0, 0, 0, 1], "T"))
            time.sleep(0.01)
        time.sleep(0.2)
        told = self.end(process)
        source = told["source"]
        self.assertGreater(source["unreadable"], 800, source)
        self.assertGreater(source["too_many"], 500, source)
        self.assertGreaterEqual(source["without_orientation"], 1)
        self.assertGreater(told["poses_of_track"], 100)
        self.assertLess(told["poses_of_track"], 100 + 2100 * 2.5)
        self.assertEqual(told["reconnects"], 0)

    def test_vrpn(self):
        self.simulator()
        server = Server()
        self.addCleanup(server.close)
        process = self.stream(f"vrpn:Tracker0@127.0.0.1:{server.port}#3", None, "--dry")
        server.wait_for_client()
        good, dice = pose([0, 0, 0, 0, 0, 0, 1], sensor=3), random.Random(6)
        nan = float("nan")
        kind = struct.unpack_from(">i", good, 16)[0]
        sender = struct.unpack_from(">i", good, 12)[0]
        # what leaves the stream of messages in step
        for body in (bytes(0), bytes(8), bytes(63), bytes(65), dice.randbytes(60000)):
            server.send(message(sender, kind, body), message(dice.randint(-9, 9), dice.randint(-9, 99), body))
        for number in (-1, -2):
            for body in (bytes(3), b"\xff" * 8, struct.pack(">I", 2**31) + b"x", struct.pack(">I", 5) + b"abcde",
                         struct.pack(">I", 300) + b"n" * 299 + b"\0"):
                server.send(message(7, number, body))
        server.send(pose([nan] * 7, sensor=3), pose([0] * 7, sensor=3), pose([1e300] * 6 + [1], sensor=3),
                    pose([0] * 6 + [1], sensor=-1), good[:8] + b"\xff\xff\xff\xff" + good[12:])
        server.send(*[good] * 20000)  # a flood
        time.sleep(0.5)
        self.assertEqual(server.welcomed_n, 1)
        # what does not: the connection is given up, and tried again
        number = 1
        for data in (message(0, 0, b"", length=3), message(0, 0, b"", length=2**32 - 1),
                     message(0, 0, b"", length=70000)):
            server.send(good, data)
            number += 1
            server.wait_for_client(number)
        for n in range(5):
            server.send(dice.randbytes(40000))
            time.sleep(0.3)
        server.drop_clients()
        before = server.welcomed_n
        server.wait_for_client(before + 1)
        play(server, [[n / 100, 0.001 * n, 0, 0, 0, 0, 0, 1] for n in range(100)], sensor=3)
        time.sleep(0.2)
        told = self.end(process)
        source = told["source"]
        self.assertGreaterEqual(source["connections"], 5)
        self.assertGreaterEqual(source["unreadable"], 15, source)
        self.assertGreater(source["too_many"], 10000, source)
        self.assertGreater(told["poses_of_track"], 100)
        self.assertLess(len(process.said), 40, process.said)  # and not told of over and over

    def test_not_vrpn(self):
        self.simulator()
        for cookie in (b"HTTP/1.1 400 Bad Request\r\n", b"vrpn: ver. 06.01  0".ljust(24, b"\0"), b"v"):
            server = Server(cookie=cookie)
            process = self.stream(f"vrpn:Tracker0@127.0.0.1:{server.port}", None, "--dry")
            self.wait_until(process, "it does not greet as VRPN 07 does; trying again")
            time.sleep(1.2)
            self.assertEqual(sum("trying again" in line for line in process.said), 1)  # tried often, told once
            process.send_signal(signal.SIGINT)
            process.wait(timeout=10)
            server.close()

    def test_another_tracker(self):
        self.simulator()
        server = Server(tracker="Wand")
        self.addCleanup(server.close)
        process = self.stream(f"vrpn:Tracker0@127.0.0.1:{server.port}", None, "--dry")
        self.wait_until(process, "the server has no tracker 'Tracker0'; it has: Other, Wand")
        process.send_signal(signal.SIGINT)
        process.wait(timeout=10)
        process = self.stream(f"vrpn:Wand@127.0.0.1:{server.port}#7", None, "--dry")
        server.wait_for_client(2)
        play(server, [[n / 100, 0, 0, 0, 0, 0, 0, 1] for n in range(150)])
        self.wait_until(process, "nothing from sensor 7 of it; others send")


if __name__ == "__main__":
    live_case.main()
