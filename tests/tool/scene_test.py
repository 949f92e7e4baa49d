#!/usr/bin/env python3
"""limber scene and limber shape: against a fake device what goes over the wire and what is said, and with the device
itself that a log of it replays to the bit."""
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import tool_case
from tool_case import ToolCase, track

SIM = None
TABLE = """# things to touch
[plane floor]
point = 0, 0, -0.5
normal = 0, 0, 1

[sphere ball]
centre = 0.1, -0.2, 0.5
radius = 0.1
friction = 0.7

[box table]
centre = 1, 0, 0
size = 0.4, 0.4, 0.1
"""
BAD_ARGUMENTS = [
    ([], "say what: send, show, put"), (["sent"], "scene sent: must be send"), (["send"], "needs a FILE.ini"),
    (["send", "no.ini"], "no.ini: No such file"), (["send", "bad.ini"], "bad.ini:3"), (["show", "1"], "unexpected '1'"),
    (["put"], "needs an object in quotes"), (["put", "cone radius=1"], "scene put: "),
    (["put", "sphere centre=0,0,0 radius=0"], "0.001 ... 1000"),
    (["put", "sphere radius=1", "--place", "9"], "--place 9: must be a number from 1 to 8"),
    (["move", "1"], "needs a PLACE from 1 to 8 and x,y,z"),
    (["move", "0", "1,2,3"], "scene move 0: must be a number from 1"),
    (["move", "1.5", "1,2,3"], "must be a whole number"), (["move", "1", "1,2"], "must be x,y,z"),
    (["move", "1", "0,0,2000"], "1000"), (["remove"], "needs a PLACE"), (["remove", "one"], "scene remove one"),
    (["clear", "all"], "unexpected 'all'"), (["clear", "--origin", "0,0,0"], "--origin is for"),
    (["send", "good.ini", "--place", "1"], "--place is for put only"), (["show", "--origin", "1"], "--origin"),
]
BAD_SHAPES = [
    ([], "give either a shape"), (["arc:90", "--off"], "give either a shape"),
    (["arc:90", "coil:2"], "unexpected 'coil:2'"),
    (["arc:90", "--strength", "-1"], "--strength -1: must be a number from 0"),
    (["arc:90", "--blend", "61"], "--blend 61: must be a number from 0 to 60"),
    (["--off", "--strength", "1"], "no use"),
]


class Fake(ToolCase):
    def setUp(self):
        super().setUp()
        self.device = self.fake()
        self.environment["LIMBER_PORT"] = self.device.port
        self.table = self.write("table.ini", TABLE)

    def told(self, word):
        return [line for line in self.device.settled() if line.startswith(word)]

    def test_send_puts_these_and_no_others(self):
        self.good("scene", "put", "sphere centre=0,0,0 radius=1", "--place", "7")
        self.assertEqual(self.good("scene", "send", self.table), "3 objects stand there\n")
        self.assertEqual(self.told("object")[1:], [f"object {i} kind 0 at 0 0 0" for i in range(3, 8)] + [
            "object 0 kind 1 at 0 0 -0.5", "object 1 kind 2 at 0.1 -0.2 0.5", "object 2 kind 4 at 1 0 0"])
        self.assertEqual([one["kind"] for one in self.good_json("scene", "show")], ["plane", "sphere", "box"])
        self.assertIn("scene      3 objects", self.good("info"))
        self.assertEqual(self.good_json("info")["objects"], 3)

    def test_nothing_is_sent_of_a_file_that_is_wrong(self):
        self.write("bad.ini", TABLE + "[sphere two]\ncentre = 0, 0, 0\nradius = -1\n")
        self.fails(2, ["scene", "send", "bad.ini"], "bad.ini:", "radius")
        self.assertEqual(self.device.requests(), [])

    def test_what_is_shown_can_be_put_again(self):
        self.good("scene", "send", self.table)
        shown = self.good("scene", "show")
        self.assertIn("   touched by 2 nodes, pushes with 5 N (-3, 0, 4)\n", shown)
        lines = re.findall(r"^(\d)  (.*)$", shown, re.MULTILINE)
        self.assertEqual([place for place, _ in lines], ["1", "2", "3"])
        self.good("scene", "clear")
        self.assertEqual(self.good_json("scene", "show"), [])
        self.assertIn("nothing stands there", self.good("scene", "show"))
        for _, line in lines:
            self.good("scene", "put", line)  # into the first free place
        self.assertEqual(self.good("scene", "show"), shown)
        one = self.good_json("scene", "show")[1]
        self.assertEqual((one["place"], one["centre_m"], one["radius_m"], one["friction"], one["contacts"],
                          one["force_newton"]), (2, [0.1, -0.2, 0.5], 0.1, 0.7, 2, [-3, 0, 4]))

    def test_move_and_remove(self):
        self.good("scene", "send", self.table)
        self.good("scene", "move", "2", "-0.5,0,0.25")
        self.good("scene", "move", "3", "0,-0.5,1", "--origin", "-1,0,1")
        self.good("scene", "remove", "1")
        told = self.good_json("scene", "show")
        self.assertEqual([(one["place"], one["centre_m"]) for one in told], [(2, [-0.5, 0, 0.25]), (3, [1, -0.5, 0])])
        self.assertEqual((told[0]["radius_m"], told[0]["friction"]), (0.1, 0.7))
        self.fails(4, ["scene", "move", "1", "0,0,0"], "nothing stands in place 1", "limber scene show")

    def test_no_place_is_left(self):
        for _ in range(8):
            self.good("scene", "put", "sphere centre=0,0,0 radius=1")
        self.fails(4, ["scene", "put", "sphere centre=0,0,0 radius=1"], "all 8 places are taken", "--place")
        self.good("scene", "put", "plane point=0,0,0 normal=0,0,1", "--place", "8")

    def test_shapes(self):
        self.good("shape", "arc:90", "--strength", "2.5", "--blend", "0")
        self.write("bow.csv", "theta_deg,phi_deg\n90,0\n-45,10\n0,0\n")
        self.good("shape", "bow.csv")
        self.good("shape", "--off", "--blend", "1")
        self.assertEqual(self.told("shape")[1:], ["shape 3 strength 5 blend 0.5 first 15708 0",
                                                  "shape 0 strength 0 blend 1 first 0 0"])
        self.assertRegex(self.told("shape")[0], r"shape 3 strength 2\.5 blend 0 first -?\d+ -?\d+")
        self.write("long.csv", "theta,phi\n" + 4 * "0,0\n")
        self.fails(2, ["shape", "long.csv"], "long.csv")
        self.assertEqual(len(self.told("shape")), 3)

    def test_arguments(self):
        self.write("bad.ini", "[sphere ball]\ncentre = 0, 0, 0\nradio = 1\n")
        self.write("good.ini", "")
        for arguments, says in BAD_ARGUMENTS:
            self.fails(2, ["scene", *arguments], says)
        for arguments, says in BAD_SHAPES:
            self.fails(2, ["shape", *arguments], says)
        self.assertEqual(self.device.requests(), [])


class Streams(ToolCase):
    """limber stream --scene: the file is in the track's world, whose first pose is 3, -2, 1.1."""

    def setUp(self):
        super().setUp()
        self.device = self.fake()
        self.environment["LIMBER_PORT"] = self.device.port

    def scene(self, x):
        self.write("new.ini", f"[sphere ball]\ncentre = {x}, -2, 1.6\nradius = 0.1\n").rename(self.folder / "ball.ini")

    def test_objects_come_before_the_poses(self):
        self.scene(3.25)
        self.good("stream", self.write("track.txt", track(20)), "--scene", "ball.ini")
        lines = self.device.settled()
        self.assertLess(lines.index("object 0 kind 2 at 0.25 0 0.5"), lines.index("request ARM"))
        self.assertEqual(len([line for line in lines if " kind 0 " in line]), 7)

    def test_a_file_saved_again_is_read_again(self):
        self.scene(3.25)
        process = self.start("stream", self.write("track.txt", track(110)), "--scene", "ball.ini")
        self.device.wait_for("pose .*")
        self.scene(3.75)
        self.device.wait_for("object 0 kind 2 at 0.75 0 0.5")
        seen = len(self.device.lines)
        self.write("ball.ini", "[sphere ball]\nradius = 0\n")  # wrong: what there is stays
        time.sleep(0.3)
        self.assertEqual([line for line in self.device.lines[seen:] if line.startswith("object")], [])
        self.scene(2.5)
        self.device.wait_for("object 0 kind 2 at -0.5 0 0.5", after=seen)
        _, err = process.communicate(timeout=20)
        self.assertEqual(process.returncode, 0, err)
        self.assertRegex(err, r"(?m)^limber: ball.ini: 1 object stands there now\nlimber: ball.ini:2: .*radius.*\n"
                              r"limber: ball.ini: 1 object stands there now$")

    def test_a_file_that_is_wrong_is_not_streamed(self):
        self.write("ball.ini", "[sphere ball]\nradius = 0\n")
        self.write("track.txt", track(2))
        self.fails(2, ["stream", "track.txt", "--scene", "ball.ini"], "ball.ini:")
        self.fails(2, ["stream", "track.txt", "--scene", "no.ini"], "no.ini: No such file")
        self.assertEqual(self.device.requests(), [])

    def test_a_live_source_s_world_begins_at_its_first_pose(self):
        self.scene(3.25)
        process = self.start("stream", "-", "--scene", "ball.ini", stdin=subprocess.PIPE)
        self.device.wait_for("request STATS_GET")
        self.assertEqual([line for line in self.device.settled() if line.startswith("object")], [])
        for line in track(40).splitlines(keepends=True):
            process.stdin.write(line)
            process.stdin.flush()
            time.sleep(0.01)
        self.device.wait_for("object 0 kind 2 at 0.25 0 0.5")
        process.communicate(timeout=20)
        self.assertEqual(process.returncode, 0)


class OtherDevices(ToolCase):
    def test_one_that_is_older_is_not_asked(self):
        device = self.fake("--older", 1)
        for arguments in (["scene", "show"], ["scene", "clear"], ["shape", "--off"]):
            self.fails(4, [*arguments, "--port", device.port], "speaks protocol 1.2", "need 1.3", "newer firmware")
        self.assertEqual(device.requests(), [])
        self.assertNotIn("objects", self.good_json("info", "--port", device.port))
        self.assertNotIn("scene", self.good("info", "--port", device.port))

    def test_lost_answers(self):
        device = self.fake("--drop-requests", 2)
        self.good("scene", "put", "sphere centre=0,0,0 radius=1", "--place", "1", "--port", device.port)
        self.good("shape", "--off", "--port", device.port)


class Simulator(ToolCase):
    """The whole way: stream along objects, with a log that is replayed."""

    def device(self, *options):
        process = subprocess.Popen([SIM, "device", "--pty", "rod", "--log", "body.log", *options], cwd=self.folder,
                                   stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)

        def stop():
            process.kill()
            process.communicate()
        self.addCleanup(stop)
        deadline = time.monotonic() + 10
        while not (self.folder / "rod").exists() and time.monotonic() < deadline:
            time.sleep(0.02)
        self.environment["LIMBER_PORT"] = "pty:rod"
        return process

    def test_a_log_with_objects_replays_to_the_bit(self):
        device = self.device("--servos", "none")
        self.good("scene", "put", "sphere ball centre=0.05,0,0.06 radius=0.03 friction=0.3")
        self.good("shape", "arc:40", "--strength", "1", "--blend", "0.2")
        self.good("stream", "--dry", self.write("track.txt", track(30)))
        self.good("scene", "move", "1", "-0.05,0,0.06")
        self.good("shape", "--off")
        self.good("stream", "--dry", "track.txt")
        device.send_signal(signal.SIGINT)
        out, _ = device.communicate(timeout=20)
        again = subprocess.run([SIM, "replay", "--per-tick", "body.log"], cwd=self.folder, capture_output=True,
                               text=True, check=True).stdout
        self.assertEqual(re.findall(r"(?:ticks|hash) .*", again), re.findall(r"(?:ticks|hash) .*", out))
        self.assertEqual(len(re.findall(r"hash +[0-9a-f]{16}", out)), 1)

    def test_what_does_not_fit_a_tick_is_refused_with_the_arithmetic(self):
        self.device("--servos", "none")
        self.good("params", "set", "model=elastic", "links=41")
        self.fails(4, ["scene", "put", "sphere centre=0,0,0 radius=1"], "objects = 1, allowed 0 ... 0",
                   "elastic, 41 links, 1 object:", "us at 168 MHz, a tick of 1000 has 900")
        self.fails(4, ["scene", "send", self.write("table.ini", TABLE)], "floor, object 1 of 3: the device refuses")
        self.fails(4, ["shape", "arc:90"], "links = 41, allowed 1 ... ", "elastic, 41 links, a shape:")


if __name__ == "__main__":
    SIM = str(Path(sys.argv.pop(4)).resolve())
    tool_case.main()
