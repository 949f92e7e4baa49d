#!/usr/bin/env python3
"""What limber-sim writes: CSV files that keep every bit, a report and a picture that need nothing else, parameter
files that lead to the same run, and never half a file."""
import base64
import html.parser
import json
import math
import os
import re
import signal
import struct
import subprocess
import time
import unittest
import xml.etree.ElementTree

import sim_case
from sim_case import SimCase, columns, hash_in

PRESETS = ("foil", "whip", "ribbon", "fishing-rod", "stiff-bar", "ribbon-stick")


def fnv1a(data):
    """FNV-1a, 64 bits, as in host_sim/angle_hash.h."""
    value = 0xcbf29ce484222325
    for byte in data:
        value = ((value ^ byte) * 0x100000001b3) & 0xffffffffffffffff
    return f"{value:016x}"


class Tables(SimCase):
    def test_angles_keep_every_bit(self):
        for track, rate_hz, arguments in (("shaking.txt", 1000, []), ("star-stops.txt", 100, ["--preset", "ribbon"]),
                                          ("shaking-gaps.txt", 333.3, ["--set", "links=1", "--rate", "333.3"])):
            arguments = ["--rate", rate_hz, *arguments]
            out = self.good("replay", self.tracks / track, *arguments, "--angles", "angles.csv")
            names, rows = columns(self.folder / "angles.csv")
            links = (len(names) - 1) // 2
            self.assertEqual(names, ["t"] + [f"{axis}{i + 1}" for i in range(links) for axis in ("theta", "phi")])
            floats = [struct.pack(f"<{2 * links}f", *map(float, row[1:])) for row in rows]
            self.assertEqual(fnv1a(b"".join(floats)), hash_in(out))
            self.assertTrue(all(len(value.lstrip("-0.").partition("e")[0].replace(".", "")) <= 9
                                for row in rows for value in row))
            for n, row in enumerate(rows):
                self.assertEqual(row[0], f"{n / rate_hz:.9g}")
            self.assertEqual(set(rows[0]), {"0"})
            self.assertIn(f"steps      {len(rows)} at {rate_hz:g} Hz", out)
            for joint in range(links):  # the summary's peak and RMS are the table's
                theta = [float(row[1 + 2 * joint]) for row in rows]
                shown = re.search(rf"^ +{joint + 1} +([\d.]+) +([\d.]+) rad +([\d.]+)", out, re.MULTILINE)
                self.assertEqual(shown[1], f"{max(map(abs, theta)):.4f}")
                self.assertAlmostEqual(float(shown[3]), math.hypot(*theta) / math.sqrt(len(theta)), delta=6e-5)

    def test_nodes_keep_the_links_lengths(self):
        lengths = [0.011, 0.052, 0.2, 1.0, 0.03]
        self.good("replay", self.tracks / "rectangular.txt", "--rate", 100, "--nodes", "nodes.csv", "--angles", "a.csv",
                  "--set", "links=5", "--set", "length=" + ",".join(map(str, lengths)))
        names, rows = columns(self.folder / "nodes.csv")
        self.assertEqual(names, ["t"] + [f"{axis}{i}" for i in range(6) for axis in "xyz"])
        self.assertEqual([row[0] for row in rows], [row[0] for row in columns(self.folder / "a.csv")[1]])
        samples = [line.split() for line in (self.tracks / "rectangular.txt").read_text().splitlines() if line[0] != "#"]
        self.assertEqual(len(rows), len(samples))
        for row, sample in zip(rows, samples):
            node = [list(map(float, row[1 + 3 * i:4 + 3 * i])) for i in range(6)]
            for got, expected in zip(node[0], sample[1:4]):  # node 0 is the hand
                self.assertAlmostEqual(got, float(expected), delta=1e-7)
            for i, length in enumerate(lengths):
                self.assertAlmostEqual(math.dist(node[i], node[i + 1]), length, delta=1e-6)

    def base(self, *arguments):
        """Node 0 and the direction of a straight rod, at the first tick of a track of one sample."""
        self.good("replay", "one.txt", *arguments, "--nodes", "nodes.csv", "--set", "links=1", "--set", "length=1")
        row = list(map(float, columns(self.folder / "nodes.csv")[1][0][1:]))
        return [round(v, 5) + 0.0 for v in row[:3]], [round(b - a, 5) + 0.0 for a, b in zip(row[:3], row[3:])]

    def test_axes_and_units(self):
        # turned by 0.6435 rad about y, x to -z: the rod, the body's z, points to (0.6, 0, 0.8)
        self.write("one.txt", f"0 1 2 3 0 {math.sqrt(0.1):.9f} 0 {math.sqrt(0.9):.9f}\n")
        self.assertEqual(self.base(), ([1, 2, 3], [0.6, 0, 0.8]))
        self.assertEqual(self.base("--up", "z"), ([1, 2, 3], [0.6, 0, 0.8]))
        self.assertEqual(self.base("--up", "y"), ([1, -3, 2], [0.6, -0.8, 0]))
        self.assertEqual(self.base("--left-handed"), ([-1, 2, 3], [-0.6, 0, 0.8]))
        self.assertEqual(self.base("--up", "y", "--left-handed"), ([-1, -3, 2], [-0.6, -0.8, 0]))
        self.assertEqual(self.base("--scale", "0.5"), ([0.5, 1, 1.5], [0.6, 0, 0.8]))

    def test_lags_are_those_of_the_swing(self):
        def swing(seconds, place):
            self.write("swing.txt", "".join("{:.2f} {:.6f} {:.6f} 0 0 0 0 1\n".format(n / 100, *place(n / 100))
                                            for n in range(round(seconds * 100))))
            out = self.good("replay", "swing.txt", "--rate", 100, "--set", "spring=10", "--set", "damper=1")
            return (float(re.search(r"^lags at +([\d.]+) Hz", out, re.MULTILINE)[1]),
                    [float(lag) for lag in re.findall(r"([-\d.]+) deg", out)])
        turn = 2 * math.pi / 2.39  # the paper's circle; lags as MODEL.md has them, with the start's ripples
        at_hz, lags = swing(12 * 2.39, lambda t: (0.15 * math.cos(turn * t), 0.15 * math.sin(turn * t)))
        self.assertAlmostEqual(at_hz, 1 / 2.39, delta=0.006)
        for lag, expected in zip(lags, (0, 2.9, 5.3, 6.7)):
            self.assertAlmostEqual(lag, expected, delta=0.5)
        # ten minutes, and hardly anything happens but at their end
        at_hz, _ = swing(600, lambda t: (0.001 * math.sin(t) + (t > 560) * 0.01 * math.sin(6 * math.pi * t), 0))
        self.assertAlmostEqual(at_hz, 3.0, delta=0.02)
        # they grow along the rod, beyond half a turn as well
        out = self.good("replay", self.tracks / "shaking.txt", "--set", "links=15", "--set", "damper=10", "--set", "drag=3")
        lags = [float(lag) for lag in re.findall(r"([-\d.]+) deg", out)]
        for before, lag in zip(lags, lags[1:13]):
            self.assertAlmostEqual(lag - before, 55, delta=1)

    def test_what_a_recorder_does_leaves_no_trace(self):
        plain = self.replay_hash(self.tracks / "shaking.txt")
        for damage, says in (("duplicates", "25 repeated times dropped"), ("flips", "124 sign flips")):
            out = self.good("replay", self.tracks / f"shaking-{damage}.txt")
            self.assertIn(f"oddities   {says}\n", out)
            self.assertEqual(hash_in(out), plain)
        for rate_hz in (10, 100, 333, 1000):  # EuRoC's nanoseconds are TUM's seconds
            self.assertEqual(self.replay_hash(self.tracks / "rectangular.txt", "--rate", rate_hz),
                             self.replay_hash(self.tracks / "rectangular-euroc.csv", "--rate", rate_hz))
        out = self.good("replay", self.tracks / "star-zeros.txt")
        self.assertIn("14 zero quaternions dropped", out)
        out = self.good("replay", self.tracks / "shaking-gaps.txt")
        self.assertIn("1 gap", out)
        self.assertIn("restarted after gaps", out)

    def test_tracks_are_always_the_same(self):
        self.good("tracks", "again")
        sizes = {}
        for path in sorted(self.tracks.iterdir()):
            self.assertEqual(path.read_bytes(), (self.folder / "again" / path.name).read_bytes())
            sizes[path.stem] = sum(line[0] not in "#\n" for line in path.read_text().splitlines())
        self.assertEqual({name: sizes[name] for name in ("circular", "linear", "rectangular", "shaking", "star")},
                         {"circular": 239, "linear": 227, "rectangular": 309, "shaking": 629, "star": 291})


class Page(html.parser.HTMLParser):
    """Collects a page's scripts, and every attribute that could load something."""
    def __init__(self, text):
        super().__init__()
        self.scripts, self.loads, self.inside, self.id = {}, [], None, None
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.loads += [(tag, k, v) for k, v in attrs if k in ("src", "href", "srcset", "data", "action", "poster")]
        self.inside = dict(attrs).get("id", f"script {len(self.scripts)}") if tag == "script" else None

    def handle_data(self, data):
        if self.inside:
            self.scripts[self.inside] = self.scripts.get(self.inside, "") + data


class Pictures(SimCase):
    def test_report_holds_the_run_and_needs_nothing_else(self):
        out = self.good("replay", self.tracks / "shaking.txt", "--preset", "whip", "--report", "report.html",
                        "--angles", "angles.csv", "--set", "links=3")
        text = (self.folder / "report.html").read_text(encoding="utf-8")
        self.assertNotRegex(text, r"@[A-Z][A-Z_]+@")
        code = re.sub(r"/\*.*?\*/|<!--.*?-->", "", text, flags=re.DOTALL)
        self.assertEqual(set(re.findall(r"(?:https?:)?//[a-z0-9-]+\.[a-z0-9./-]+", code)) - {"http://www.w3.org/2000/svg"},
                         set(), "addresses outside of comments")
        self.assertNotRegex(code, r"@import|\bimport\s*\(|XMLHttpRequest|\bfetch\s*\(|url\(\s*['\"]?(?!#|data:)")
        page = Page(text)
        self.assertEqual([load for load in page.loads if not load[2].startswith(("#", "data:"))], [])
        data = json.loads(page.scripts["data"])
        self.assertEqual((data["hash"], data["steps"], data["links"], data["preset"]), (hash_in(out), 6281, 3, "whip"))
        self.assertEqual(dict(data["summary"])["hash"], data["hash"])
        frames = data["frames"]
        for name, values in (("angles", 6), ("nodes", 12), ("base_q", 4)):
            self.assertEqual(len(base64.b64decode(data[name], validate=True)), 4 * values * frames)
        rows = columns(self.folder / "angles.csv")[1][::data["frame_step"]]
        self.assertEqual(len(rows), frames)
        self.assertEqual(base64.b64decode(data["angles"]),
                         b"".join(struct.pack("<6f", *map(float, row[1:])) for row in rows))

    def test_picture_is_well_formed(self):
        self.good("replay", self.tracks / "star.txt", "--preset", "whip", "--picture", "rod.svg")
        root = xml.etree.ElementTree.parse(self.folder / "rod.svg").getroot()
        self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")
        self.assertNotIn("nan", (self.folder / "rod.svg").read_text())
        for arguments in ([], ["--set", "links=1"], ["--rate", "10"]):  # hardly anything to see
            self.good("replay", self.write("one.txt", "0 0 0 0 0 0 0 1\n"), *arguments, "--picture", "rod.svg",
                      "--report", "report.html", "--nodes", "nodes.csv", "--angles", "angles.csv")
            self.assertNotRegex((self.folder / "rod.svg").read_text(), r"\b(nan|inf)\b")
            xml.etree.ElementTree.parse(self.folder / "rod.svg")


class Parameters(SimCase):
    def test_a_printed_file_is_the_same_rod(self):
        track = self.tracks / "shaking.txt"
        for preset in PRESETS:
            for sets in ([], ["links=7"], ["hold=2", "smoothing=33.3"], ["links=3", "spring=100.1,1e3,7"], ["scheme=paper"]):
                arguments = ["--preset", preset] + [word for s in sets for word in ("--set", s)]
                self.write("rod.ini", self.good("params", *arguments))
                self.assertEqual(self.good("replay", track, "--params", "rod.ini").splitlines()[-1],
                                 self.good("replay", track, *arguments).splitlines()[-1], arguments)
            for sets in ([], ["links=7"], ["gravity=0", "drag=0.02"], ["links=3", "mass=0.1,0.05,1e-3"]):
                arguments = ["--preset", preset, "--model", "elastic"] + [word for s in sets for word in ("--set", s)]
                self.write("rod.ini", self.good("params", *arguments))
                self.assertEqual(self.replay_hash(track, "--params", "rod.ini"), self.replay_hash(track, *arguments))
        listed = self.good("params", "--list").partition("\nmaterials")[0].splitlines()
        self.assertEqual([line.split()[0] for line in listed], ["presets", *PRESETS])

    def test_precedence(self):
        track = self.tracks / "star.txt"
        self.write("rod.ini", "[rod]\nspring = 500\nlinks = 6\n")
        expected = self.replay_hash(track, "--set", "links=6", "--set", "spring=700")
        for arguments in (["--params", "rod.ini", "--set", "spring=700"], ["--set", "spring=700", "--params", "rod.ini"],
                          ["--set", "spring=1", "--params", "rod.ini", "--set", "spring=700"],
                          ["--set", "spring=700", "--set", "links=6", "--model", "contour"]):
            self.assertEqual(self.replay_hash(track, *arguments), expected, arguments)
        self.assertNotEqual(self.replay_hash(track, "--params", "rod.ini"), expected)
        self.assertEqual(self.replay_hash(track, "--set", "links=2", "--preset", "foil"),
                         self.replay_hash(track, "--preset", "foil", "--set", "links=2"))


class WholeFiles(SimCase):
    def test_streams(self):
        out = self.good("replay", self.track, "--angles", "/dev/stdout", "--set", "links=1")
        self.good("replay", self.track, "--angles", "angles.csv", "--set", "links=1")
        angles = (self.folder / "angles.csv").read_text()
        self.assertTrue(out.startswith(angles))
        self.assertIn("\nhash ", out[len(angles):])
        with open(self.folder / "all.txt", "w+", encoding="ascii") as both:  # one file, one after the other
            subprocess.run([sim_case.SIM, "replay", self.track, "--angles", "/proc/self/fd/1", "--set", "links=1"],
                           stdout=both, check=True)
        both = (self.folder / "all.txt").read_text()
        self.assertTrue(both.startswith(angles) and "\nhash " in both[len(angles):])
        self.good("replay", self.track, "--angles", "/dev/null")
        os.mkfifo(self.folder / "pipe")
        with subprocess.Popen(["cat", self.folder / "pipe"], stdout=subprocess.PIPE, text=True) as reader:
            self.good("replay", self.track, "--angles", "pipe", "--set", "links=1")
            self.assertEqual(reader.stdout.read(), angles)

    def test_a_link_stays_a_link(self):
        (self.folder / "elsewhere").mkdir()
        (self.folder / "elsewhere" / "angles.csv").touch()
        (self.folder / "link.csv").symlink_to("elsewhere/angles.csv")
        self.good("replay", self.track, "--angles", "link.csv")
        self.assertTrue((self.folder / "link.csv").is_symlink())
        self.assertGreater((self.folder / "elsewhere" / "angles.csv").stat().st_size, 1000)

    def interrupted(self, signal_number):
        """Ends a run while it writes; False where the run was faster."""
        self.write("angles.csv", "mine\n")
        before = self.files()
        arguments = ["replay", "long.txt", "--set", "links=64", "--nodes", "nodes.csv", "--angles", "angles.csv"]
        with subprocess.Popen([sim_case.SIM, *arguments], cwd=self.folder, stdout=subprocess.DEVNULL) as run:
            while run.poll() is None and not any(self.folder.glob("*.partial*")):
                time.sleep(0.001)
            run.send_signal(signal_number)
        if run.returncode == 0:
            return False
        self.assertEqual(run.returncode, 128 + signal_number)
        self.assertEqual(self.files(), before)
        return True

    def test_an_interrupted_run_leaves_nothing(self):
        self.write("long.txt", "".join(f"{0.1 * n:.1f} {0.01 * (n % 2)} 0 0 0 0 0 1\n" for n in range(200)))
        for signal_number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
            self.assertTrue(any(self.interrupted(signal_number) for _ in range(5)), "could not be caught while writing")


if __name__ == "__main__":
    sim_case.main()
