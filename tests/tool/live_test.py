#!/usr/bin/env python3
"""Live sources and live graphics with limber-sim device: whole and exact, named rightly, drawn."""
import shutil
import signal
import socket
import struct
import subprocess
import threading
import time

import live_case
from live_case import (LiveCase, Sender, float32, free_udp_port, osc_bundle, osc_pose, osc_text, paced, rows_of,
                       unity_to_ours)
from tool_case import track
from vrpn_server import Server, play


class Whole(LiveCase):
    def test_vrpn(self):
        self.simulator()
        tap, server = self.tap(), Server()
        self.addCleanup(server.close)
        process = self.stream(f"vrpn:Tracker0@127.0.0.1:{server.port}", tap.port)
        server.wait_for_client()
        rows = rows_of(track(400, rate_hz=125))
        play(server, rows)
        time.sleep(0.3)
        told = self.end(process)
        self.assert_whole(tap, told, [row[1:8] for row in rows])
        source = told["source"]
        self.assertTrue(120 < source["rate_hz"] < 130, source)
        self.assertEqual((source["connections"], source["clock_restarts"], source["unreadable"]), (1, 0, 0))
        self.assertGreater(source["of_others"], 100)
        self.assertEqual(told["armings"], 1)
        # older than they are by the clock rule: none; and late ones say so
        self.assertTrue(all(age < 65535 for *_, age in tap.poses))

    def test_osc(self):
        self.simulator()
        tap, send = self.tap(), Sender(self)
        process = self.stream(f"osc:{send.port}", tap.port)
        time.sleep(0.5)
        rows = [[float32(value) for value in row[1:8]] for row in rows_of(track(300, rate_hz=90))]
        count = iter(range(10**6))

        def send_one(row):  # alone, in a bundle with company, nested
            mine, other = osc_pose(row), osc_pose([1] * 7, serial="LHR-2")
            bone = osc_pose([0] * 7, serial="Hips", address="/VMC/Ext/Bone/Pos")
            nest = osc_bundle(other, osc_bundle(bone, mine), bone)
            send([mine, osc_bundle(bone, mine, other), nest][next(count) % 3])
        paced(rows, 90, send_one)
        time.sleep(0.3)
        told = self.end(process)
        self.assert_whole(tap, told, [unity_to_ours(row) for row in rows])
        self.assertTrue(any("following tracker 'LHR-1', the first one heard" in line for line in process.said))
        self.assertTrue(80 < told["source"]["rate_hz"] < 100, told["source"])
        self.assertEqual(told["source"]["of_others"], 100 * (2 + 3))

    def test_osc_axes_and_serial(self):
        self.simulator()
        tap, send = self.tap(), Sender(self)
        process = self.stream(f"osc:127.0.0.1:{send.port}#B", tap.port, "--up", "z", "--right-handed", "--dry")
        time.sleep(0.5)
        rows = [[float32(value) for value in row[1:8]] for row in rows_of(track(50))]
        paced(rows, 100, lambda row: (send(osc_pose([2] * 7, "A")), send(osc_pose(row, "B"))))
        time.sleep(0.2)
        told = self.end(process)
        self.assert_whole(tap, told, rows)
        self.assertEqual(told["source"]["of_others"], 50)

    def test_oscsend(self):
        if shutil.which("oscsend") is None:
            self.skipTest("no oscsend (Debian: liblo-tools)")
        self.simulator()
        tap, send = self.tap(), Sender(self)
        process = self.stream(f"osc:{send.port}", tap.port, "--dry")
        time.sleep(0.5)
        rows = [[float32(value) for value in row[1:8]] for row in rows_of(track(60, rate_hz=30))]
        # its file mode would keep times of its own; a process for each pose is slow, but oscsend's own
        paced(rows, 30, lambda row: subprocess.run(
            ["oscsend", "127.0.0.1", str(send.port), "/VMC/Ext/Tra/Pos", "sfffffff", "LHR-1", *map(repr, row)],
            check=True, timeout=10))
        time.sleep(0.3)
        told = self.end(process)
        self.assert_whole(tap, told, [unity_to_ours(row) for row in rows])


class Names(LiveCase):
    def test_bad(self):
        for name in ("vrpn:", "vrpn:x", "vrpn:@h", "vrpn:T@", "vrpn:T@h:0", "vrpn:T@h:99999", "vrpn:T@h#-1",
                     "vrpn:T@h#x", "vrpn:T@h:", "vrpn:" + "T" * 150 + "@h", "vrpn:T@" + "h" * 300):
            self.fails(2, ["stream", name, "--port", "pty:none"], "must be vrpn:TRACKER@HOST[:PORT][#SENSOR]")
        for name in ("osc:", "osc:x", "osc:0", "osc:65536", "osc::39539", "osc:127.0.0.1", "osc:1#", "osc:[::1]x:5",
                     "osc:127.0.0.1:+7", "osc:" + "9" * 300):
            self.fails(2, ["stream", name, "--port", "pty:none"], "must be osc:[ADDRESS:]PORT[#SERIAL]")
        self.fails(2, ["stream", "osc:203.0.113.7:39539", "--port", "pty:none"], "cannot listen there")
        self.fails(2, ["stream", "vrpn:T@nobody.invalid", "--port", "pty:none"], "vrpn:T@nobody.invalid")
        for option in (["--speed", "2"], ["--resample", "100"]):
            self.fails(2, ["stream", "osc:39539", "--port", "pty:none", *option], "are for tracks")
        for name in ("osc:h", "udp:h:1", "osc:h:0", "h:1", "osc::1"):
            self.fails(2, ["stream", "osc:39539", "--port", "pty:none", "--graphics", name], "must be osc:HOST:PORT")

    def test_loopback_unless_told(self):
        self.simulator()
        port = free_udp_port()
        process = self.stream(f"osc:{port}", None, "--dry")
        at = self.wait_until(process, "no pose yet; waiting")
        self.assertFalse(any("from the network" in line for line in process.said), process.said)
        listening = subprocess.run(["cat", "/proc/net/udp"], capture_output=True, text=True, check=True).stdout
        self.assertIn(f"0100007F:{port:04X}", listening)
        process.send_signal(signal.SIGINT)
        process.wait(timeout=10)
        process = self.stream(f"osc:0.0.0.0:{port}", None, "--dry")
        self.wait_until(process, "whoever reaches this port from the network can move the rod")
        self.assertGreater(at, 0)


class Graphics(LiveCase):
    def receiver(self):
        """Address, types and values of each packet, in a list that grows."""
        got, port = [], socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        port.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        port.bind(("127.0.0.1", 0))
        self.addCleanup(port.close)

        def listen():
            while True:
                try:
                    data = port.recv(65536)
                except OSError:
                    return
                address = data[:data.index(b"\0")].decode()
                at = len(osc_text(address))
                types = data[at:data.index(b"\0", at)].decode()
                at += len(osc_text(types))
                self.assertEqual(len(data) - at, 4 * (len(types) - 1))
                got.append((address, types, struct.unpack(">" + types[1:], data[at:])))
        threading.Thread(target=listen, daemon=True).start()
        return got, port.getsockname()[1]

    def test_equal_to_the_devices(self):
        self.simulator("--links", "12")
        tap = self.tap()
        got, port = self.receiver()
        out = self.good_json("stream", self.write("track.txt", track(200)), "--port", tap.port, "--graphics",
                             f"osc:127.0.0.1:{port}")
        time.sleep(0.2)
        angles = [values for address, types, values in got if address == "/limber/angles" and types == ",ii" + "f" * 24]
        nodes = [values for address, types, values in got if address == "/limber/nodes" and types == ",iii" + "f" * 39]
        self.assertEqual(len(angles) + len(nodes), len(got))
        self.assertGreater(len(nodes), 100)
        self.assertEqual((out["graphics"]["angles"], out["graphics"]["nodes"]), (len(angles), len(nodes)))
        self.assertEqual(nodes, [(tick, first, n, *values) for tick, first, n, values in tap.nodes][:len(nodes)])
        sent = {tick: (state, tenths) for tick, state, tenths in tap.angles}
        self.assertGreater(len(angles), 150)
        for tick, state, *values in angles:
            self.assertEqual(state, sent[tick][0])
            for value, tenth in zip(values, sent[tick][1]):
                self.assertEqual(value, float32(float32(tenth) * float32(1e-4)))
        # as it was
        self.assertEqual(self.good_json("params", "get", "nodes_rate", "--port", tap.port)[0]["values"], [0])

    def test_a_rate_that_is_set_stays(self):
        self.simulator()
        self.good("params", "set", "nodes_rate=20", "--port", "pty:rod")
        got, port = self.receiver()
        self.good("stream", self.write("track.txt", track(150)), "--dry", "--port", "pty:rod", "--graphics",
                  f"osc:localhost:{port}")
        nodes_n = sum(address == "/limber/nodes" for address, _, _ in got)
        self.assertTrue(20 <= nodes_n <= 45, nodes_n)
        self.assertEqual(self.good_json("params", "get", "nodes_rate", "--port", "pty:rod")[0]["values"], [20])

    def test_a_line_too_slow_for_nodes(self):
        self.simulator("--baud", "57600")
        got, port = self.receiver()
        code, _, err = self.run_tool("stream", self.write("track.txt", track(100)), "--dry", "--port", "pty:rod",
                                     "--graphics", f"osc:127.0.0.1:{port}")
        self.assertEqual(code, 0, err)
        self.assertIn("takes no nodes_rate of 60 Hz: only angles are drawn", err)
        self.assertEqual({address for address, _, _ in got}, {"/limber/angles"})

    def test_nobody_there(self):
        self.simulator()
        out = self.good_json("stream", self.write("track.txt", track(100)), "--port", "pty:rod", "--graphics",
                             f"osc:127.0.0.1:{free_udp_port()}")
        self.assertEqual(out["exit_code"], 0)


if __name__ == "__main__":
    live_case.main()
