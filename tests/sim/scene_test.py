#!/usr/bin/env python3
"""Things to touch and shapes to take, by the command line of limber-sim: what is refused, what the summary, the tables,
the report and the picture tell of it, and that it all repeats to the bit."""
import base64
import csv
import json
import math
import re
import struct
import unittest
import xml.etree.ElementTree
from collections import defaultdict
from pathlib import Path

import sim_case
from sim_case import SimCase, columns, hash_in

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "host_sim" / "scenes"
FOIL = ["--preset", "foil", "--model", "elastic", "--set", "links=24"]
RODS = (FOIL, ["--preset", "foil", "--set", "links=24", "--set", "length=0.03667"])
BALL = "[sphere ball]\ncentre = 0.55, 0, -0.25\nradius = 0.18\n"

BAD_SCENES = {  # name: content, what the line says beside the file's name; test_scene_text.c has them all
    "kind.ini": ("[ball a]\n", ":1: 'ball' is no kind of object"),
    "key.ini": ("[sphere a]\ncentre=0,0,0\nradius=1\nmass=1\n", ":4: 'mass' is no key of a sphere"),
    "bounds.ini": ("[sphere a]\nradius=0\n", ":2: radius = 0: out of bounds, must be 0.001 ... 1000 m"),
    "missing.ini": ("\n[box a]\ncentre=0,0,0\n", ":2: box 'a' has no size; give size = 1, 0.6, 0.04"),
    "nine.ini": ("".join(f"[sphere {n}]\ncentre=0,0,{n}\nradius=1\n" for n in range(9)), ":25: a scene has at most 8"),
    "rod.ini": ("[rod]\nlinks = 4\n", ":1: 'rod' is no kind of object"),
    "far.ini": ("[sphere a]\ncentre=999,0,0\nradius=1\n", "'a' is 1001 m from where the track begins, at most 1000 m"),
}
BAD_OPTIONS = [  # arguments after the track, what the line says
    (["--scene", "no-such.ini"], "no-such.ini: No such file"), (["--scene", "."], "Is a directory"),
    (["--contacts", "c.csv"], "--contacts: there is nothing to touch; give --scene"),
    (["--scene", "good.ini", "--per-tick", "log"], "--per-tick: the log holds what the device had to touch"),
    (["--scene", "good.ini", "--angles", "good.ini"], "good.ini: is the scene itself"),
    (["--shape", "arc:90"], "--shape: needs --shape-strength too"),
    (["--shape-strength", "5"], "--shape-strength: there is no shape"),
    (["--shape", "arc:x", "--shape-strength", "5"], "arc:x: must be arc: and a number"),
    (["--shape", "bow.csv", "--shape-strength", "5"], "bow.csv: 2 rows of theta,phi for a rod of 4 links; it needs 4"),
    (["--shape", "bow.csv", "--shape-strength", "5", "--set", "links=2", "--nodes", "bow.csv"], "is the shape itself"),
    (["--shape", "arc:9", "--shape-strength", "5", "--set", "scheme=paper"], "the paper's scheme takes no shape"),
    (["--shape", "no.csv", "--shape-strength", "5"], "no.csv: No such file"),
    (["--shape", "arc:90", "--shape-strength", "-1"], "--shape-strength -1: must be a number from 0 to 1e+06"),
    (["--shape", "arc:90", "--shape-strength", "1", "--shape-blend", "61"], "--shape-blend 61: must be a number"),
]


class Refusals(SimCase):
    def test_scenes(self):
        self.write("track.txt", "0 -2 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n")
        for name, (content, says) in BAD_SCENES.items():
            self.write(name, content)
            self.refused(["replay", self.track, "--scene", name, "--contacts", "c.csv"], name, says)
            if name != "far.ini":
                self.refused(["device", "--pty", "rod", "--scene", name], name, says)

    def test_options(self):
        self.write("good.ini", BALL)
        self.write("bow.csv", "theta,phi\n0.1,0\n0.1,0\n")
        for arguments, says in BAD_OPTIONS:
            self.refused(["replay", self.track, *arguments], says)
        self.refused(["device", "--pty", "rod", "--shape", "arc:9"], "--shape and --shape-strength go together")
        self.refused(["device", "--pty", "rod", "--shape", "arc:x", "--shape-strength", "1"], "arc:x: must be")


class Touching(SimCase):
    def replay(self, *arguments, scene=BALL):
        self.write("scene.ini", scene)
        return self.good("replay", self.tracks / "pressing.txt", *arguments, "--scene", "scene.ini")

    def test_it_repeats_to_the_bit_and_nothing_is_as_without(self):
        for rod in RODS:
            alone = self.replay_hash(self.tracks / "pressing.txt", *rod)
            touched = hash_in(self.replay(*rod))
            self.assertNotEqual(touched, alone, rod)
            self.assertEqual(hash_in(self.replay(*rod)), touched)
            for nothing in ("", "# a remark\n", "[plane far]\npoint = 0,0,-500\nnormal = 0,0,1\n"):
                self.assertEqual(hash_in(self.replay(*rod, scene=nothing)), alone, rod)
            self.assertIn("scene.ini: 1 object, nothing touches\n", self.replay(*rod, scene=nothing))

    def test_a_scene_is_where_the_track_is(self):
        hashes = []
        for x, y, z in ((0, 0, 0), (256, -32, 8)):  # floats hold exactly what is moved by that
            self.write("track.txt", "".join(f"{n / 64} {x} {y} {z - n / 512} 0 0.5 0 0.5\n" for n in range(65)))
            self.write("scene.ini", f"[sphere a]\ncentre = {x + 0.5} {y} {z - 0.1875}\nradius = 0.125\n")
            out = self.good("replay", "track.txt", *FOIL, "--scene", "scene.ini")
            self.assertIn("touches    a: ", out)
            hashes.append(hash_in(out))
        self.assertEqual(*hashes)

    def test_shipped_scenes(self):
        """The hand moves at up to 0.6 m/s: no node is inside by more than 1 % of a link (elastic), 2 % (contour, which
        is put out in one linear step after its own: 1.4 % for a tick where it slides over the table's edge)."""
        names = sorted(path.stem for path in SCENES.glob("*.ini"))
        self.assertEqual(names, ["ball", "corner", "pole", "table"])
        for name in names:
            for rod in RODS:
                out = self.good("replay", self.tracks / "pressing.txt", *rod, "--scene", SCENES / f"{name}.ini")
                depths = re.findall(r"^touches .*\((\S+) % of a link\)", out, re.MULTILINE)
                self.assertTrue(depths, (name, rod))
                self.assertLess(max(map(float, depths)), 1 if rod is FOIL else 2, (name, rod))
                self.assertNotIn("warning", out, name)

    def test_the_readmes_scene_is_one(self):
        scene = re.search(r"```ini\n(\[sphere .*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL)[1]
        self.assertIn("scene.ini: 4 objects", self.replay(*FOIL, scene=scene))

    def contacts(self):
        """The rows of contacts.csv, by time."""
        ticks = defaultdict(list)
        with open(self.folder / "contacts.csv", encoding="ascii") as file:
            rows = csv.DictReader(file)
            self.assertEqual(rows.fieldnames, ["t", "node", "object", "name", "fx", "fy", "fz"])
            for row in rows:
                force = [float(row[k]) for k in ("fx", "fy", "fz")]
                ticks[row["t"]].append((int(row["node"]), (row["object"], row["name"]), *force))
        return ticks

    def test_the_summary_is_the_tables(self):
        slope = "[plane slope]\npoint = 0.88,0,-0.08\nnormal = -0.2,0,1\nfriction = 0\n"
        up = math.hypot(0.2, 1)
        for name, scene, gap in (("ball", BALL, lambda p: math.dist((0.55, 0, -0.25), p) - 0.18),
                                 ("slope", slope, lambda p: (-0.2 * (p[0] - 0.88) + p[2] + 0.08) / up)):
            out = self.replay(*FOIL, "--contacts", "contacts.csv", "--nodes", "nodes.csv", scene=scene)
            ticks = self.contacts()
            self.assertEqual({row[1] for at in ticks.values() for row in at}, {("1", name)})
            force = max(math.hypot(*(sum(row[i] for row in at) for i in (2, 3, 4))) for at in ticks.values())
            names, nodes = columns(self.folder / "nodes.csv")
            depth = max(-gap(tuple(map(float, row[i:i + 3]))) for row in nodes for i in range(4, len(names), 3))
            shown = re.search(rf"^touches +{name}: (\d+) nodes?, (\S+) N at most, (\S+) mm deep \((\S+) % of a link\), "
                              r"(\S+) %", out, re.MULTILINE)
            self.assertEqual(int(shown[1]), max(map(len, ticks.values())))
            self.assertAlmostEqual(float(shown[2]), force, delta=0.006 * force)
            self.assertAlmostEqual(float(shown[3]), 1e3 * depth, delta=0.0005)
            self.assertAlmostEqual(float(shown[4]), 100 * depth / (0.88 / 24), delta=0.002)
            self.assertAlmostEqual(float(shown[5]), 100 * len(ticks) / len(nodes), delta=0.06)

    def test_contacts_stand_at_their_tick(self):
        """The first node that touches has come to the ball in that very tick, from well outside."""
        self.replay(*FOIL, "--contacts", "contacts.csv", "--nodes", "nodes.csv")
        first, at = next(iter(self.contacts().items()))
        place = 1 + 3 * at[0][0]
        rows = columns(self.folder / "nodes.csv")[1]
        gaps = {row[0]: math.dist((0.55, 0, -0.25), tuple(map(float, row[place:place + 3]))) - 0.18 for row in rows}
        self.assertLess(abs(gaps[first]), 2e-5)
        self.assertGreater(gaps[f"{float(first) - 0.001:.9g}"], 1e-4)

    def test_forces_push_out(self):
        """Without friction every force is along the way out of the ball."""
        self.replay(*FOIL, "--contacts", "contacts.csv", "--nodes", "nodes.csv", scene=BALL + "friction = 0\n")
        nodes = {row[0]: list(map(float, row[1:])) for row in columns(self.folder / "nodes.csv")[1]}
        rows = [(t, *row) for t, at in self.contacts().items() if float(t) > 0.4 for row in at]
        self.assertGreater(len(rows), 500)
        for t, node, _, *force in rows:
            out = [a - b for a, b in zip(nodes[t][3 * node:3 * node + 3], (0.55, 0, -0.25))]
            cosine = sum(a * b for a, b in zip(out, force)) / math.hypot(*out) / math.hypot(*force)
            self.assertGreater(cosine, 0.99, (t, node))

    def test_warnings(self):
        self.assertNotIn("warning", self.replay(*FOIL))
        thin = "[capsule wire]\nfrom = 0.5,-1,-0.1\nto = 0.5,1,-0.1\nradius = 0.02\n"
        self.assertRegex(self.replay(*FOIL, scene=thin), "warning +wire is 20 mm from middle .* a link is 36.7 mm")
        thin = "[box sheet]\ncentre = 0.5,0,-0.1\nsize = 1,1,0.04\n"
        self.assertRegex(self.replay(*FOIL, scene=thin), "warning +sheet is 20 mm from middle")
        inside = BALL.replace("-0.25", "-0.1")
        self.assertRegex(self.replay(*FOIL, scene=inside), "warning +the rod begins (79[0-9.]*|80) mm inside ball ")

    def test_report_and_picture(self):
        three = BALL + "[box <b>]\ncentre = 1,2,3\nsize = 0.2,0.4,0.6\nrounding = 0.1\nturn = 0,0,90\n"
        three += "[sphere c]\ncentre = 1,1,1\nradius = 0.1\n"
        self.replay(*FOIL, "--report", "r.html", "--picture", "p.svg", "--contacts", "c.csv", scene=three)
        text = (self.folder / "r.html").read_text(encoding="utf-8")
        self.assertNotIn("<b>]", text)
        data = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.DOTALL)[1])
        self.assertEqual([(o["name"], o["kind"]) for o in data["objects"]],
                         [("ball", "sphere"), ("<b>", "box"), ("c", "sphere")])
        self.assertEqual(data["objects"][1]["place"], [1, 2, 3])
        for got, expected in zip(data["objects"][1]["half"] + [data["objects"][0]["radius"]], (0, 0.1, 0.2, 0.18)):
            self.assertAlmostEqual(got, expected, delta=1e-6)
        values = list(struct.iter_unpack("<6f", base64.b64decode(data["contacts"])))
        expected = []
        with open(self.folder / "c.csv", encoding="ascii") as file:
            for row in csv.DictReader(file):
                tick = round(float(row["t"]) * 1000)
                if tick % data["frame_step"] == 0:
                    force = struct.pack("<3f", *(float(row[k]) for k in ("fx", "fy", "fz")))
                    expected.append((tick // data["frame_step"], int(row["node"]), int(row["object"]) - 1,
                                     *struct.unpack("<3f", force)))
        self.assertGreater(len(values), 100)
        self.assertTrue(values == expected)  # unittest would take minutes to tell how they differ
        root = xml.etree.ElementTree.parse(self.folder / "p.svg").getroot()
        outlines = [p for g in root.findall("{*}g") if g.get("fill") for p in g.findall("{*}path")]
        self.assertEqual(len(outlines), 1 + 4 + 1)  # of the box the faces that are seen, too
        self.assertNotRegex((self.folder / "p.svg").read_text(), r"\b(nan|inf)\b")
        self.good("replay", self.tracks / "pressing.txt", "--report", "r.html")
        self.assertNotIn('"objects":[', (self.folder / "r.html").read_text(encoding="utf-8"))

    def test_a_device_stands_among_them(self):
        self.write("scene.ini", BALL)
        out = self.good("device", "--tcp", "127.0.0.1:0", "--speed", "max", "--seconds", "0.2", "--log", "body.log",
                        "--scene", "scene.ini", "--shape", "arc:30", "--shape-strength", "50")
        again = self.good("replay", "--per-tick", "body.log")
        self.assertEqual(hash_in(again), hash_in(out))


class Shapes(SimCase):
    STILL = "".join(f"{n / 10} 0 0 0 0 0 0 1\n" for n in range(41))

    def last_angles(self, *arguments):
        self.write("still.txt", self.STILL)
        self.good("replay", "still.txt", *arguments, "--angles", "a.csv")
        return [list(map(float, row[1:])) for row in columns(self.folder / "a.csv")[1]]

    ROD = ["--set", "links=6", "--set", "coupling=0", "--set", "smoothing=0", "--set", "spring=40", "--set", "damper=3"]

    def test_springs_and_shape_meet_half_way(self):
        for strength, share in ((40, 0.5), (120, 0.75), (4, 1 / 11)):
            rows = self.last_angles(*self.ROD, "--shape", "arc:60", "--shape-strength", strength)  # in 0.5 s
            for joint in range(6):
                self.assertAlmostEqual(rows[-1][2 * joint], share * math.radians(10), delta=2e-4)
                self.assertAlmostEqual(rows[-1][2 * joint + 1], 0, delta=1e-6)
            self.assertLess(abs(rows[10][0]), 0.05 * share * math.radians(10))  # 10 ms into half a second
            speed = max(abs(b[0] - a[0]) for a, b in zip(rows, rows[1:]))
            self.assertLess(speed, 0.006 * share * math.radians(10))  # blended in, not thrown

    def test_a_table_of_points_bends_an_elastic_rod(self):
        points = [(0.1 * math.sin(0.3 * n), 0, 0.2 * n / 6 + 0.8) for n in range(7)]
        self.write("bow.csv", "x,y,z\n" + "".join(f"{x},{y},{z}\n" for x, y, z in points))
        elastic = ["--model", "elastic", "--set", "links=6", "--set", "gravity=0", "--set", "drag=0.5"]
        self.write("still.txt", self.STILL)
        row = re.compile(r"^shape +bow.csv, like springs of 2000 N m, blended in over 0.3 s$", re.MULTILINE)
        out = self.good("replay", "still.txt", *elastic, "--nodes", "n.csv",
                        "--shape", "bow.csv", "--shape-strength", 2000, "--shape-blend", 0.3)
        self.assertRegex(out, row)
        last = list(map(float, columns(self.folder / "n.csv")[1][-1][1:]))
        nodes = [last[i:i + 3] for i in range(0, 21, 3)]
        for a, b, p, q in zip(nodes, nodes[1:], points, points[1:]):
            link = [y - x for x, y in zip(a, b)]
            wanted = [y - x for x, y in zip(p, q)]
            cosine = sum(x * y for x, y in zip(link, wanted)) / math.hypot(*link) / math.hypot(*wanted)
            self.assertGreater(cosine, math.cos(math.radians(10)))

    def test_no_strength_is_no_shape(self):
        for rod in RODS:
            self.assertEqual(self.replay_hash(self.track, *rod, "--shape", "coil:1", "--shape-strength", "0"),
                             self.replay_hash(self.track, *rod))
            self.assertNotEqual(self.replay_hash(self.track, *rod, "--shape", "coil:1", "--shape-strength", "5"),
                                self.replay_hash(self.track, *rod))


if __name__ == "__main__":
    sim_case.main()
