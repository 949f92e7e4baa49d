#!/usr/bin/env python3
"""Others' code at the other end: VRPN's own client library reads the test server, python-osc sends and receives, and
liblo's oscdump listens."""
import os
import shutil
import subprocess
import sys
import threading
import time

import live_case
from live_case import LiveCase, float32, free_udp_port, paced, rows_of, unity_to_ours
from pythonosc.dispatcher import Dispatcher
from pythonosc.osc_server import BlockingOSCUDPServer
from pythonosc.udp_client import SimpleUDPClient
from tool_case import track
from vrpn_server import Server, play

TRACKS = os.path.join(os.path.dirname(__file__), "..", "..", "..", "shared", "tracks")
CLIENT = """
import sys, time, motioncapture
cortex = motioncapture.connect("vrpn", {"hostname": "tcp://127.0.0.1:" + sys.argv[1]})
until = time.monotonic() + float(sys.argv[2])
while time.monotonic() < until:
    cortex.waitForNextFrame()
    for name, body in cortex.rigidBodies.items():
        if name == "Tracker0":
            q = body.rotation
            print("pose", *map(float, body.position), q.x, q.y, q.z, q.w, flush=True)
"""


def tracks():
    """A generated track always, and recorded ones where they are: names and rows, at most 6 s of each."""
    yield "generated", rows_of(track(400))
    for name in ("04_vive_shake_knuckles.txt", "08_index_hmd_arcs_500hz.txt"):
        path = os.path.join(TRACKS, name)
        if os.path.exists(path):
            with open(path, encoding="ascii") as file:
                rows = rows_of(file.read())
            rows = [row for row in rows if row[0] < rows[0][0] + 6 and any(row[4:8])]
            yield name, [row for n, row in enumerate(rows) if n == 0 or row[0] > rows[n - 1][0]]


class Peers(LiveCase):
    def test_the_server_is_right(self):
        """VRPN's C++ client follows it: every pose that it shows is one of the track's, in order, most are seen."""
        server = Server()
        self.addCleanup(server.close)
        client = subprocess.Popen([sys.executable, "-c", CLIENT, str(server.port), "5"], stdout=subprocess.PIPE,
                                  stderr=subprocess.DEVNULL, text=True)
        self.addCleanup(client.kill)
        server.wait_for_client()
        time.sleep(0.5)
        rows = rows_of(track(120, rate_hz=40))
        play(server, rows, company=False)
        out, _ = client.communicate(timeout=20)
        places = {tuple(float32(value) for value in row[1:8]): n for n, row in enumerate(rows)}
        poses = [line.split()[1:] for line in out.splitlines() if line.startswith("pose ")]
        seen = [places[tuple(float32(float(word)) for word in line)] for line in poses]
        self.assertEqual(seen, sorted(seen))
        self.assertGreater(len(set(seen)), 0.8 * len(rows))

    def test_the_tool_is_right(self):
        for name, rows in tracks():
            with self.subTest(name):
                device = self.simulator()
                tap, server = self.tap(), Server()
                process = self.stream(f"vrpn:Tracker0@127.0.0.1:{server.port}", tap.port)
                server.wait_for_client()
                play(server, rows)
                time.sleep(0.3)
                told = self.end(process)
                self.assert_whole(tap, told, [row[1:8] for row in rows])
                print(name, told["source"], told["poses"]["rejected"])
                server.close()
                device.kill()
                device.wait()
                self.rod.unlink()

    def test_python_osc_sends(self):
        for name, rows in tracks():
            with self.subTest(name):
                device = self.simulator()
                tap, port = self.tap(), free_udp_port()
                process = self.stream(f"osc:{port}", tap.port)
                time.sleep(0.5)
                client = SimpleUDPClient("127.0.0.1", port)
                rows32 = [[float32(value) for value in row[1:8]] for row in rows]
                rate_hz = (len(rows) - 1) / (rows[-1][0] - rows[0][0])
                paced(rows32, rate_hz, lambda row: client.send_message("/VMC/Ext/Tra/Pos", ["LHR-1", *row]))
                time.sleep(0.3)
                told = self.end(process)
                self.assert_whole(tap, told, [unity_to_ours(row) for row in rows32])
                print(name, told["source"], told["poses"]["rejected"])
                device.kill()
                device.wait()
                self.rod.unlink()

    def test_python_osc_receives(self):
        self.simulator("--links", "8")
        tap, got = self.tap(), {"/limber/nodes": [], "/limber/angles": []}
        dispatcher = Dispatcher()
        for address, values in got.items():
            dispatcher.map(address, lambda _, *arguments, values=values: values.append(arguments))
        server = BlockingOSCUDPServer(("127.0.0.1", 0), dispatcher)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        self.addCleanup(server.server_close)
        self.addCleanup(server.shutdown)
        told = self.good_json("stream", self.write("track.txt", track(200)), "--port", tap.port, "--graphics",
                              f"osc:127.0.0.1:{server.server_address[1]}")
        time.sleep(0.3)
        nodes, angles = got["/limber/nodes"], got["/limber/angles"]
        self.assertEqual((len(nodes), len(angles)), (told["graphics"]["nodes"], told["graphics"]["angles"]))
        self.assertGreater(len(nodes), 100)
        self.assertEqual(nodes, [(tick, first, n, *values) for tick, first, n, values in tap.nodes][:len(nodes)])
        tenths = {tick: values for tick, _, values in tap.angles}
        for tick, _, *values in angles:
            self.assertEqual([round(value * 1e4) for value in values], list(tenths[tick]))

    def test_oscdump_receives(self):
        if shutil.which("oscdump") is None:
            self.skipTest("no oscdump (Debian: liblo-tools)")
        self.simulator()
        port = free_udp_port()
        path = self.folder / "dump.txt"
        with open(path, "w", encoding="ascii") as file:
            dump = subprocess.Popen(["oscdump", "-L", str(port)], stdout=file)
        self.addCleanup(dump.wait)
        self.addCleanup(dump.kill)
        self.wait_for_listener(port)
        told = self.good_json("stream", self.write("track.txt", track(100)), "--port", "pty:rod", "--graphics",
                              f"osc:127.0.0.1:{port}")
        time.sleep(0.3)
        lines = path.read_text(encoding="ascii").splitlines()
        self.assertEqual(sum("/limber/nodes iii" + "f" * 15 + " " in line for line in lines), told["graphics"]["nodes"])
        self.assertEqual(sum("/limber/angles ii" + "f" * 8 + " " in line for line in lines), told["graphics"]["angles"])


if __name__ == "__main__":
    live_case.main()
