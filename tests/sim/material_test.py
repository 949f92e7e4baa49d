#!/usr/bin/env python3
"""limber-sim params of rods of a material: what it prints, what it warns of, and that the file is the same rod."""
import re
import unittest

import sim_case
from sim_case import SimCase, hash_in

ROD = ["--material", "carbon", "--length", "1.8", "--diameter", "0.012,0.002", "--links", "20"]
AS_SETS = ["--set", "material=carbon", "--set", "total_length=1.8", "--set", "diameter=0.012,0.002"]


def head(text):
    """The remarks before the first key, as {name: rest of the line}."""
    lines = text.split("[rod]")[0].splitlines()
    found = (re.match(r"# +(.+?)(?: {2,}| = |: |$)(.*)", line) for line in lines)
    return dict(one.groups() for one in found if one)


class Material(SimCase):
    def test_what_follows_is_told(self):
        told = head(self.good("params", *ROD))
        self.assertEqual(told["youngs_modulus"], "1.27e+11 Pa")
        self.assertEqual(told["diameter"], "0.012, 0.002 m")
        # E pi d^4 / 64; rho pi / 12 (a^2 + a b + b^2) L; a float64 beam of this taper rings at 8.797 Hz
        self.assertEqual(told["E I"], "129.3 N m^2 at the butt, 0.09975 at the tip")
        self.assertEqual(told["mass"], "0.1216 kg")
        tube = head(self.good("params", *ROD, "--bore", "0.8"))
        self.assertEqual((tube["E I"], tube["mass"]), ("76.32 N m^2 at the butt, 0.05889 at the tip", "0.04377 kg"))
        hz = [float(value) for value in re.findall(r"[\d.]+", told["frequencies"])]
        self.assertAlmostEqual(hz[0] / 8.797, 1, delta=0.0015)
        self.assertEqual(len(hz), 3)
        self.assertTrue(hz[0] < hz[1] < hz[2])
        self.assertEqual(told["droop"], "0.007495 m at the tip, held out level")
        for length, says in (("0.6", "level, if small deflections"), ("1.2", "it hangs: it cannot")):
            self.assertIn(says, head(self.good("params", *ROD, "--diameter", "0.0004", "--length", length))["droop"])
        self.assertNotIn("contour", "".join(told))
        contour = self.good("params", *ROD[:-1], "6", "--model", "contour", "--set", "drag=0.1")
        self.assertIn("\n# contour keeps of it the first frequency,", contour)
        self.assertIn("\n# but drag as written (--set)\n", contour)
        self.assertIn("\ninertia =", contour)

    def test_a_printed_file_is_the_same_rod(self):
        track = self.tracks / "shaking.txt"
        for model in ("elastic", "contour"):
            arguments = ["--model", model, "--set", "links=8"]
            self.write("rod.ini", self.good("params", *ROD[:-2], *arguments))
            hashes = {self.replay_hash(track, *AS_SETS, *arguments), self.replay_hash(track, "--params", "rod.ini")}
            self.write("material.ini", "[rod]\nmaterial = carbon\ntotal_length = 1.8\ndiameter = 0.012\n    0.002\n")
            hashes.add(self.replay_hash(track, "--params", "material.ini", *arguments))
            self.assertEqual(len(hashes), 1)
        self.refused(["replay", track, "--params", "rod.ini", "--set", "material=ash"],
                     "rod.ini:", "length follows from material (--set): leave out one of them")

    def test_warnings_go_to_stderr_and_the_file_is_whole(self):
        done = self.sim("params", "--material", "carbon", "--length", "0.3", "--diameter", "0.012")
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stderr, r"\Alimber-sim: warning: the first natural frequency, 170 Hz, wants \d+ steps a "
                                      r"second: at a tick of 1 ms .*\n\Z")
        self.write("bar.ini", done.stdout)
        self.assertIn("under-resolved", self.good("replay", self.track, "--params", "bar.ini"))

    def test_refusals_teach(self):
        for arguments, *says in (
                (["--material", "wood"], "--material: material = wood: must be spring-steel, aluminium, carbon,"),
                (["--material", "ash"], "for a rod that follows from material add diameter, total_length, or a preset"),
                (["--length", "1"], "--length: ", "(a material gives the first two)"),
                ([*ROD, "--set", "spring=3"], "--set: spring follows from material (--material): leave out one"),
                ([*ROD, "--length", "0"], "--length: total_length = 0: out of bounds, must be 0.01 ... 100 m"),
                ([*ROD, "--diameter", "1,2,3"], "--diameter: diameter = 1: out of bounds, must be 0.0001 ... 0.5 m"),
                ([*ROD, "--bore", "1"], "--bore: bore = 1: out of bounds, must be 0 ... 0.99"),
                ([*ROD, "--links", "65"], "--links: links = 65: out of bounds, must be 1 ... 64"),
                ([*ROD, "--diameter", "0.4"], "rod: spring of joint 1 comes out as ", "must be 0 ... 1e+06: ask for")):
            self.refused(["params", *arguments], *says)

    def test_the_list_and_the_help_have_materials(self):
        materials = self.good("params", "--list").split("materials:")[1].splitlines()[1:]
        names = [line.split()[0] for line in materials]
        self.assertEqual(names, ["spring-steel", "aluminium", "carbon", "fibreglass", "bamboo", "ash", "nylon"])
        for name in names:
            self.good("params", "--material", name, "--length", "1", "--diameter", "0.006")
        self.assertIn("--material carbon --length 1.8", self.good("params", "--help"))

    def test_the_same_on_the_command_line_of_a_replay(self):
        out = self.good("replay", self.track, "--preset", "foil", "--set", "material=aluminium")
        self.assertIn("elastic", out)
        self.assertNotEqual(hash_in(out), self.replay_hash(self.track, "--preset", "foil", "--model", "elastic"))


if __name__ == "__main__":
    sim_case.main()
