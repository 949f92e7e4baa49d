#!/usr/bin/env python3
"""Independent float64 reference for the `elastic` rod, against `limber-sim replay --model elastic`.

Written from the mathematics (firmware/core/MODEL.md, Section 5) on node positions, with dense matrices and rotation
matrices; recordings are read and resampled by oracle_track.py. It shares no line with the firmware. Needs numpy.
"""
import argparse
import math
import multiprocessing
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from oracle import OneLineParser
from oracle_rod import csv_header, given_settings
from oracle_track import UserError, awkward_track, clean, read_track, resample, rotation_matrix

PER_LINK = {"length": 0.03, "mass": 0.02, "drag": 0.0, "spring": 80.0, "damper": 2.0}
DEFAULTS = {"links": 4, "gravity": 9.81, **PER_LINK}
STEP_S, LONGEST_STEP_S = 1.0001e-3, 2.0002e-3   # a tick longer than the latter is several steps of the former
LENGTH_GOOD, LENGTH_MAX, NEWTON_MAX = 1e-6, 1e-5, 3
DAMPER_MAX = 600                            # h c / m l^2 beyond which spin and torsion are not taken in full
FOLD = 0.9                                  # sin^2 of half the bend at which secants stop growing


def dot(a, b):
    return np.einsum("ij,ij->i", a, b)[:, None]


def unit(v):
    return v / np.sqrt(dot(v, v))


def cross(a, b):
    return a[:, [1, 2, 0]] * b[:, [2, 0, 1]] - a[:, [2, 0, 1]] * b[:, [1, 2, 0]]


class Rod:
    """N point masses. Points are ghost, base, nodes; links 0 is the base's axis, from ghost to base."""

    def __init__(self, settings, rate_hz, noise=None):
        vars(self).update(settings)                                  # links, gravity and one array per link key
        self.noise = noise                                           # random generator, or None
        self.steps = 1 if 1 / rate_hz <= LONGEST_STEP_S else math.ceil(1 / rate_hz / STEP_S)
        n, self.h = self.links, 2 / (3 * rate_hz * self.steps)
        lengths = np.concatenate([self.length[:1], self.length])                 # link 0 is as long as link 1
        self.E = (np.eye(n + 2, k=1) - np.eye(n + 2))[:n + 1] / lengths[:, None]          # points to links
        self.D = self.E[1:] - self.E[:-1]                                        # points to curvatures
        self.G = np.eye(n) - np.eye(n, k=-1)                                     # nodes to link vectors

    def rest(self, pose):
        n = self.links
        self.at = self.at_before = self.points(pose)
        self.axes = pose[1]
        self.v = self.v_before = np.zeros((n, 3))
        self.pull = self.pull_before = np.zeros(n)
        self.spin, self.hostile = 0.0, False

    def points(self, pose):
        place, turn = pose
        reach = np.concatenate([[-self.length[0], 0.0], np.cumsum(self.length)])
        return place + np.outer(reach, turn[:, 2])

    def damping(self, e, rate, base_spin):
        """What dampers do: moments on the curvatures, to be subtracted, and couples on the links, to be added (N m). A
        damper sees two links turn against each other: what the curvature gains, but for what lies along the middle of
        the two and for the inner link's spin, which a joint that does not twist hands on. The torsion this takes
        goes down to the base and pushes each bent joint aside."""
        u = unit(e)
        normal, middle = cross(u[:-1], u[1:]), e[:-1] + e[1:]
        per_cos = 1 / (1 - np.minimum(FOLD, dot(e[1:] - e[:-1], e[1:] - e[:-1]) / 4))      # of half the bend, squared
        fold = normal * per_cos / 2                                              # tan(bend / 2) long
        gained = np.cumsum(dot(rate[:-1] + rate[1:], fold))
        about = base_spin - np.concatenate([[0.0], gained[:-1]]) - dot(rate[:-1], fold)[:, 0]
        damper = per_cos * self.damper[:, None]
        held = DAMPER_MAX * (self.mass * self.length ** 2)[:, None] / np.maximum(self.h * damper, 1e-30)
        share = np.minimum(1, held)                                              # of what would else drive the rod
        bending = rate[1:] - rate[:-1] - share * about[:, None] * normal
        bending -= per_cos / 4 * dot(middle, bending) * middle
        bending *= damper
        carried = -np.cumsum(share[::-1] * dot(bending, normal)[::-1])[::-1]              # by the link before joint j
        beyond = np.append(carried[1:], 0.0)[:, None]
        return bending, beyond * (fold + np.vstack([fold[1:], np.zeros(3)]))

    def step(self, pose):
        n, h, mass = self.links, self.h, self.mass
        bar = (4 * self.at - self.at_before) / 3
        v_bar = (4 * self.v - self.v_before) / 3
        axis = pose[1][:, 2]
        r = pose[1] @ self.axes.T
        sine = np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]]) / 2
        spin = sine @ axis * 2 / math.sqrt(1 + np.trace(r)) if np.trace(r) > -1 + 1e-9 else 0.0
        at = self.points(pose)
        at[2:] = bar[2:] + h * v_bar
        e, rate = self.E @ at, self.E @ (at - bar) / h
        kappa = e[1:] - e[:-1]
        bend = 2 * np.arcsin(np.sqrt(np.minimum(FOLD, dot(kappa, kappa)[:, 0] / 4)))
        k = self.spring * np.where(bend > 1e-6, bend / np.sin(np.maximum(bend, 1e-9)), 1.0)
        pull = 2 * self.pull - self.pull_before
        lasting = np.maximum(0, np.minimum(pull, np.minimum(self.pull, self.pull_before)))
        along = unit(e[1:])

        bending, push = self.damping(e, rate, (spin - self.spin / 3) / h)
        force = -self.D.T @ (k[:, None] * kappa + bending)
        force += self.E[1:].T @ (push - (pull * self.length)[:, None] * along)
        force = force[2:] - self.drag[:, None] * v_bar
        force[:, 2] -= mass * self.gravity
        D, E = self.D[:, 2:], self.E[1:, 2:]
        stiff = k + self.damper / np.cos(bend / 2) ** 2 / h
        A = (np.diag(mass / h ** 2 + self.drag / h) + D.T @ np.diag(stiff) @ D
             + E.T @ np.diag(lasting * self.length) @ E)
        at[2:] += np.linalg.solve(A, force)

        errors = []
        for _ in range(NEWTON_MAX):
            link = np.diff(at[1:], axis=0)
            u, excess = unit(link), np.linalg.norm(link, axis=1) - self.length
            J = self.G[:, :, None] * u[:, None, :]                               # d length_i / d node_j
            J = J.reshape(n, -1)
            per_mass = np.repeat(1 / mass, 3)
            x = np.linalg.solve(J * per_mass @ J.T, excess)
            at[2:] -= (per_mass * (x @ J)).reshape(n, 3)
            pull = pull + x / h ** 2
            errors.append(np.max(np.abs(np.linalg.norm(np.diff(at[1:], axis=0), axis=1) / self.length - 1)))
            if errors[-1] <= LENGTH_GOOD:
                break
        v = (at[2:] - bar[2:]) / h                                               # without what lengths still miss
        u = unit(np.diff(at[1:], axis=0))
        if self.noise:
            u = unit(u + self.noise.uniform(-ROUNDING, ROUNDING, u.shape))
        at[2:] = at[1] + np.cumsum(self.length[:, None] * u, axis=0)
        self.hostile |= errors[-1] > 0.3 * LENGTH_MAX
        self.v_before, self.pull_before = self.v, self.pull
        self.v, self.pull = v, pull
        self.at_before, self.at, self.axes, self.spin = self.at, at, pose[1], spin


def simulate(rod, position_m, quaternion, restart):
    """Every tick's nodes 0 ... N (ticks x N + 1 x 3), and the rows from which on the motion is hostile: where Newton's
    method does not find the lengths, the firmware does what no equation says."""
    nodes, hostile = np.empty((len(restart), rod.links + 1, 3)), np.zeros(len(restart), bool)
    for n, again in enumerate(restart):
        if again:
            rod.rest((position_m[n], rotation_matrix(quaternion[n])))
            before = n
        else:
            with np.errstate(all="ignore"):
                follow(rod, *([rows[before], rows[n - 1], rows[n]] for rows in (position_m, quaternion)))
            before = n - 1
        nodes[n], hostile[n] = rod.at[1:], rod.hostile
    return nodes, hostile


def follow(rod, positions, quaternions):
    """A tick of as many steps as it takes, on the parabola through its two poses and the one before."""
    near = np.array([-q if q @ quaternions[1] < 0 else q for q in quaternions])
    for i in range(1, rod.steps + 1):
        s = i / rod.steps
        weights = np.array([s * (s - 1) / 2, 1 - s * s, s * (s + 1) / 2])
        turn = weights @ near
        rod.step((weights @ np.array(positions), rotation_matrix(turn / np.linalg.norm(turn))))


# ---------------------------------------------------------------- agreement with the simulator

# Errors are of nodes, seen from the base, as a share of the rod's length. How far float32 can follow: the oracle runs
# twice, the second time with every link's direction moved at random in each step, by some 4e-9: about what float32 does
# to it. From the first row at which that alone moved a node by a tenth of the tolerance a difference says nothing about
# the code, until the rod starts anew after a gap; nor does it where the motion is hostile. Which rows are left depends
# on oracle and track alone, never on the simulator.
TOLERANCE, ROUNDING, SEED = 1e-3, 2.0 ** -28, 1
DECIDED = TOLERANCE / 10
SHARE = 0.9                      # of the rows must be left, where a rod is damped
COMPARED_S = 8                   # of a track: a dense step takes half a millisecond


def settings_from(pairs):
    """['links=3', 'spring=80,70,60', ...] -> every setting, per-link ones as arrays of N."""
    given = given_settings(pairs, DEFAULTS)
    try:
        links, lists = int(given["links"]), {key: np.array(str(given[key]).split(","), float) for key in PER_LINK}
        return {"links": links, "gravity": float(given["gravity"]),
                **{key: np.broadcast_to(values, links).copy() for key, values in lists.items()}}
    except ValueError as error:
        raise UserError(f"--set: {error}") from None


def replayed(sim, track, rate_hz, pairs, links):
    """Nodes and angles as `limber-sim replay` writes them: ticks x N + 1 x 3, ticks x N x 2."""
    with tempfile.TemporaryDirectory() as folder:
        outs = [Path(folder) / name for name in ("nodes.csv", "angles.csv")]
        command = [str(sim), "replay", str(track), "--model", "elastic", "--rate", f"{rate_hz:.12g}",
                   "--nodes", str(outs[0]), "--angles", str(outs[1])]
        command += [word for pair in pairs for word in ("--set", pair)]
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=300)
        except (OSError, subprocess.TimeoutExpired) as error:
            raise UserError(f"{sim}: {error}") from None
        if done.returncode != 0:
            raise UserError(f"{sim} exit {done.returncode}: {' '.join(done.stderr.split()) or 'no message'}")
        nodes, angles = (np.loadtxt(out, delimiter=",", skiprows=1, ndmin=2)[:, 1:] for out in outs)
        if outs[1].read_text(encoding="utf-8").split(maxsplit=1)[0] != csv_header(links):
            raise UserError(f"{sim}: not the angles of {links} links")
    return nodes.reshape(len(nodes), links + 1, 3), angles.reshape(len(angles), links, 2)


def nodes_of(angle_rad, base, axes, length_m):
    """Angles to nodes: every joint turns about its parent's y by theta, then by phi toward it."""
    x, y, z = (axes[:, :, k] for k in range(3))
    nodes = [base]
    for (theta, phi), reach in zip(np.moveaxis(angle_rad, 0, 2)[:, :, :, None], length_m):
        x, z = x * np.cos(theta) - z * np.sin(theta), x * np.sin(theta) + z * np.cos(theta)
        y, z = y * np.cos(phi) - z * np.sin(phi), y * np.sin(phi) + z * np.cos(phi)
        nodes.append(nodes[-1] + reach * z)
    return np.stack(nodes, axis=1)


def comparable(moved, hostile, restart):
    """Rows up to the first that is undecided, in every stretch anew."""
    rows, good = np.empty(len(restart), bool), True
    for n, again in enumerate(restart):
        good = bool(again) or (good and moved[n] < DECIDED and not hostile[n])
        rows[n] = good
    return rows


def judge(case):
    """(sim, track, rate_hz, pairs, least share) -> (verdict, table line)."""
    sim, track, rate_hz, pairs, share = case
    try:
        settings = settings_from(pairs)
        rod, links = Rod(settings, rate_hz), settings["links"]
        whole_s, *poses = resample(*clean(*read_track(track)), rate_hz)
        position_m, quaternion, restart = (rows[:round(COMPARED_S * rate_hz)] for rows in poses)
        length_m = rod.length.sum()
        expected, hostile = simulate(rod, position_m, quaternion, restart)
        rounded = Rod(settings, rate_hz, np.random.default_rng(SEED))
        moved, _ = simulate(rounded, position_m, quaternion, restart)
        got, angle_rad = replayed(sim, track, rate_hz, pairs, links)
        if len(got) != len(whole_s):
            raise UserError(f"{sim}: {len(got)} rows, expected {len(whole_s)}")
        got, angle_rad = got[:len(restart)], angle_rad[:len(restart)]
    except UserError as error:
        return "FAIL", f"{Path(track).name:<28} {rate_hz:>5g} {' '.join(pairs)}: FAIL {error}"
    axes = np.array([rotation_matrix(q) for q in quaternion])
    own = np.abs(nodes_of(angle_rad, got[:, 0], axes, rod.length) - got).max() / length_m
    expected, moved, got = ((nodes - nodes[:, :1]) / length_m for nodes in (expected, moved, got))
    rows = comparable(np.nan_to_num(np.abs(moved - expected).max(axis=(1, 2)), nan=np.inf), hostile, restart)
    error = np.nan_to_num(np.abs(got - expected).max(axis=(1, 2))[rows], nan=np.inf)
    swing = np.abs(expected[:, -1] - axes[:, :, 2])[rows].max()
    faults = [text for fault, text in (
        (error.max() > TOLERANCE, f"differs by more than {TOLERANCE:g} of its length"),
        (not own < 1e-5, f"angles and nodes differ by {own:.1e}"),
        (not np.all(np.abs(np.linalg.norm(np.diff(got, axis=1), axis=2) * length_m / rod.length - 1) < 1e-4),
         "links not of their length, or no number"),
        (rows.mean() < share, f"under {share:.0%} of the rows comparable")) if fault]
    verdict = "FAIL" if faults else "ok" if rows.mean() > 0.02 else "none"
    return verdict, (f"{Path(track).name:<28} {rate_hz:>5g} {len(rows):>6} {rows.sum():>8} {swing:>6.3f} "
                     f"{np.median(error):>8.1e} {error.max():>8.1e} {verdict:<4} {' '.join(pairs)[:60]} "
                     + "; ".join(faults)).rstrip()


def judge_all(cases):
    if not Path(cases[0][0]).is_file():
        raise UserError(f"--sim {cases[0][0]}: no such file")
    print(f"{'':8}{'track':<28} {'rate':>5} {'rows':>6} {'compared':>8} {'swing':>6} {'median':>8} {'max':>8}",
          flush=True)
    verdicts = []
    with multiprocessing.Pool(min(2, len(cases))) as pool:
        for verdict, line in pool.imap(judge, cases):
            verdicts.append(verdict)
            print(f"{len(verdicts):>3}/{len(cases):<3} {line}", flush=True)
    agree, fail = verdicts.count("ok"), verdicts.count("FAIL")
    print(f"{agree} agree within {TOLERANCE:g} of the rod's length, {fail} FAIL, {len(cases) - agree - fail} with too "
          "little to compare")
    return 1 if fail or not agree else 0


FOIL = ["links=8", "length=0.1", "spring=20", "damper=0.1", "mass=0.01"]
TAPER = ["links=5", "length=.04,.035,.03,.025,.02", "spring=9,7,5,3,1", "damper=.02,.02,.01,.01,.005",
         "mass=.03,.02,.02,.01,.005", "drag=.05,0,.02,.1,.02"]
WHIP = ["links=10", "length=0.06", "spring=2", "damper=0.05"]
BARE = ["links=10", "length=0.06", "spring=2", "damper=0", "gravity=0"]


def suite(sim, folder, share, quick):
    tracks = sorted(Path(folder).glob("*.txt"))[::4 if quick else 1]
    if not tracks:
        print(f"SKIPPED: no tracks in {folder}")
        return 77
    with tempfile.TemporaryDirectory() as made:
        tracks.append(Path(made) / "awkward.txt")
        awkward_track(tracks[-1])
        cases = []
        for track in tracks:
            for rate_hz in (100,) if quick else (100, 500, 1000):
                for pairs, least in ((TAPER, share),) if quick else (
                        (FOIL, share), (TAPER, share), (WHIP, 0), (BARE, 0), (["links=1", "spring=1", "damper=.01"], 0),
                        (["links=50", "length=.01", "spring=4", "damper=.01", "mass=.002"], 0)):
                    cases.append((sim, track, rate_hz, pairs, least))
        return judge_all(cases)


def main():
    parser = OneLineParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, epilog=f"""\
examples:
  elastic_oracle.py compare --sim build/host/limber-sim swing.txt --rate 500 --set links=20 --set spring=2
  elastic_oracle.py suite --sim build/host/limber-sim tests/data/tracks --quick
keys for --set (one value, or one per link separated by commas) and their defaults:
  {" ".join(f"{key}={value}" for key, value in DEFAULTS.items())}""")
    commands = parser.add_subparsers(dest="command", required=True)
    several = commands.add_parser("compare", help="replay tracks here and in limber-sim, compare row by row")
    several.add_argument("track", nargs="+")
    several.add_argument("--rate", type=float, default=100.0, metavar="HZ", help="ticks a second (default 100)")
    several.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="repeatable")
    everything = commands.add_parser("suite", help="compare a folder of tracks; exit 77 if it has none")
    everything.add_argument("folder", metavar="TRACKDIR")
    everything.add_argument("--quick", action="store_true", help="some tracks, one rod, 100 Hz")
    for command in (several, everything):
        command.add_argument("--sim", required=True, help="path of limber-sim")
        command.add_argument("--share", type=float, default=SHARE,
                             help=f"of the rows that must be comparable (default {SHARE}; suite: of the stiffer rods)")
    given = parser.parse_args()
    try:
        if given.command == "compare":
            return judge_all([(given.sim, track, given.rate, given.set, given.share) for track in given.track])
        return suite(given.sim, given.folder, given.share, given.quick)
    except UserError as error:
        parser.error(str(error))


if __name__ == "__main__":
    sys.exit(main())
