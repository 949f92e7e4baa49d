#!/usr/bin/env python3
"""Independent float64 reference for the `contour` rod and for the replay of recordings.

Written from the mathematics alone (firmware/core/MODEL.md; "Eq." is the paper's) in the most literal form: dense
matrices, an explicit inverse, 3 x 3 rotations. It shares no line with the firmware, so where the two agree on every
row of a recording, a mistake would have to have been made twice. Needs numpy and nothing else.
"""
import argparse
import functools
import math
import multiprocessing
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

GAP_S = 0.25                     # a longer pause between two samples is not bridged
TICK_SLACK = 1e-9                # in ticks: times printed in decimals miss a tick they mean by a rounding
PER_JOINT = {"length": 0.03, "inertia": 0.2, "drag": 0.0, "coupling": 100.0, "smoothing": 0.0,
             "spring": 80.0, "damper": 2.0, "limit": 1.4}
DEFAULTS = {"links": 4, "hold": 1, "scheme": "midpoint", **PER_JOINT}


class UserError(Exception):
    """Something the user can mend: one line, exit status 2."""


# ---------------------------------------------------------------- recordings (MODEL.md, Replay)

def read_track(path):
    """TUM or EuRoC file -> (times from the first line [s], positions [m] n x 3, quaternions x y z w n x 4)."""
    try:
        lines = Path(path).read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise UserError(f"{path}: {error}") from None
    stamps, rows, unit_s = [], [], 1.0
    for number, line in enumerate(lines, 1):
        if not line.strip() or line.strip().startswith("#"):
            continue
        fields = line.replace(",", " ").split()
        try:
            if "," in line:                                         # EuRoC: ns, position, quaternion w x y z, more
                x, y, z, qw, qx, qy, qz = map(float, fields[1:8])
                stamps.append(int(fields[0]))                       # kept whole: 1.4e18 ns do not fit a double
                unit_s = 1e-9
            else:
                stamp, x, y, z, qx, qy, qz, qw = map(float, fields)
                stamps.append(stamp)
        except ValueError:
            raise UserError(f"{path}:{number}: not a time, a position and a quaternion: {line[:60]}") from None
        rows.append((x, y, z, qx, qy, qz, qw))
    time_s, rows = np.array([(stamp - stamps[0]) * unit_s for stamp in stamps]), np.array(rows).reshape(-1, 7)
    if not (np.all(np.isfinite(time_s)) and np.all(np.isfinite(rows)) and np.any(rows[:, 3:])):
        raise UserError(f"{path}: holds no samples, or some that are not finite")
    return time_s, rows[:, :3], rows[:, 3:]


def clean(time_s, position_m, quaternion):
    """Drop all-zero quaternions, then all but the last of equal times; normalise; times from the first kept one."""
    keep = np.any(quaternion != 0, axis=1)
    time_s, position_m, quaternion = time_s[keep], position_m[keep], quaternion[keep]
    keep = np.append(time_s[1:] != time_s[:-1], True)
    time_s, position_m, quaternion = time_s[keep], position_m[keep], quaternion[keep]
    if np.any(np.diff(time_s) < 0):
        raise UserError("a track whose times run backwards")
    return time_s - time_s[0], position_m, quaternion / np.linalg.norm(quaternion, axis=1)[:, None]


def resample(time_s, position_m, quaternion, rate_hz):
    """Cleaned samples -> (tick times, positions, quaternions, restart flags), one row per tick."""
    ticks = math.floor(time_s[-1] * rate_hz + TICK_SLACK) + 1
    after_gap = np.append(False, np.diff(time_s) > GAP_S)           # sample i lies on the far side of a gap
    stretch_of = np.cumsum(after_gap)                               # which unbroken stretch sample i is part of
    tick_s, position, turn = np.arange(ticks) / rate_hz, np.empty((ticks, 3)), np.empty((ticks, 4))
    near, stretch, restart = 0, -1, np.zeros(ticks, bool)
    for n in range(ticks):
        while near + 1 < len(time_s) and n + TICK_SLACK >= time_s[near + 1] * rate_hz:
            near += 1
        restart[n], stretch = stretch_of[near] != stretch, stretch_of[near]
        if near + 1 == len(time_s) or after_gap[near + 1]:          # past the end, or in a gap: the near pose is held
            position[n], turn[n] = position_m[near], quaternion[near]
            continue
        share = (tick_s[n] - time_s[near]) / (time_s[near + 1] - time_s[near])
        position[n] = (1 - share) * position_m[near] + share * position_m[near + 1]
        far = quaternion[near + 1]
        far = -far if far @ quaternion[near] < 0 else far           # the shorter way round
        blend = (1 - share) * quaternion[near] + share * far
        turn[n] = blend / np.linalg.norm(blend)
    return tick_s, position, turn, restart


def rotation_matrix(q):
    """Hamilton x y z w, body -> world."""
    x, y, z, w = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


@functools.lru_cache(maxsize=2)
def replayed_poses(track, rate_hz):
    if not 0 < rate_hz < math.inf:
        raise UserError(f"--rate {rate_hz:g}: must be > 0 Hz")
    tick_s, position_m, quaternion, restart = resample(*clean(*read_track(track)), rate_hz)
    return tick_s, position_m, np.array([rotation_matrix(q) for q in quaternion]), restart


# ---------------------------------------------------------------- the rod (MODEL.md, frames and contour)

def direction(theta_rad, phi_rad):
    """A link's direction in its parent's frame (Eq. 6)."""
    return np.array([math.cos(phi_rad) * math.sin(theta_rad), math.sin(phi_rad),
                     math.cos(phi_rad) * math.cos(theta_rad)])


def angles_of(d, theta_kept_rad):
    """Inverse of `direction` for a unit vector; straight along +-y theta is undefined and keeps its value."""
    theta_rad = theta_kept_rad if d[0] ** 2 + d[2] ** 2 < 1e-12 else math.atan2(d[0], d[2])
    return np.array([theta_rad, math.asin(min(1.0, max(-1.0, d[1])))])


def rot_y(a):
    return np.array([[math.cos(a), 0, math.sin(a)], [0, 1, 0], [-math.sin(a), 0, math.cos(a)]])


def rot_x(a):
    return np.array([[1, 0, 0], [0, math.cos(a), -math.sin(a)], [0, math.sin(a), math.cos(a)]])


def wrap(angle_rad):
    """To (-pi, pi]."""
    return angle_rad - 2 * math.pi * np.ceil((angle_rad - math.pi) / (2 * math.pi))


class Rod:
    """N joints; x is N x 2 (theta, phi), one column per axis; a pose is (position, 3 x 3 rotation)."""

    def __init__(self, settings, rate_hz):
        vars(self).update(settings)                                 # links, hold, scheme and one array per joint key
        n, dt = self.links, 1.0 / rate_hz
        self.dt = dt
        if self.scheme == "midpoint" and np.any((self.drag + self.damper) * dt > 2 * self.inertia):
            least_hz = np.max((self.drag + self.damper) / (2 * self.inertia))
            raise UserError(f"(drag + damper) / rate must not exceed 2 * inertia: rate >= {least_hz:g} Hz")
        # D1: x_i - x_{i-1} with x_0 = 0 (Eq. 7); D2: x_{i+1} - 2 x_i + x_{i-1}, i = 1..N-1 (Eq. 2)
        d1 = np.eye(n) - np.eye(n, k=-1)
        d2 = (np.eye(n, k=1) - 2 * np.eye(n) + np.eye(n, k=-1))[:n - 1]
        inner = d1.T @ np.diag(self.coupling) @ d1 + d2.T @ np.diag(self.smoothing[:n - 1]) @ d2
        self.K = np.diag(self.spring) + inner
        if self.scheme == "midpoint":
            M = np.diag(self.inertia + 0.5 * (self.drag + self.damper) * dt) + 0.25 * dt ** 2 * self.K
        else:
            M = np.diag(self.inertia + 0.5 * self.drag * dt) + dt ** 2 * inner
        self.M_inverse = np.linalg.inv(M)
        self.mu, self.gamma, self.c, self.k, self.stop = (          # N x 1: the same for both axes
            v[:, None] for v in (self.inertia, self.drag, self.damper, self.spring, self.limit))

    def rest(self, pose, start_rad=0.0):
        """At rest in this pose; straight, unless an experiment starts bent."""
        self.x, self.g = np.full((self.links, 2), float(start_rad)), np.zeros((self.links, 2))
        self.w_prev = self.x.copy()
        self.last, self.before_last, self.touched = pose, pose, False

    def base_motion(self, a, b):
        """Delta(A -> B; x): how the held joints turn while the links' far ends stay in the world (Eqs. 9, 10)."""
        delta = np.zeros((self.links, 2))
        (p_a, r_a), (p_b, r_b), l = a, b, self.length
        base_to_p1 = (p_a - p_b) + r_a @ (l[0] * direction(*self.x[0]))
        distance_m = math.sqrt(base_to_p1 @ base_to_p1)
        if distance_m < 1e-6 * l[0]:
            return delta
        along_1 = base_to_p1 / distance_m
        new_1 = angles_of(r_b.T @ along_1, self.x[0, 0])
        delta[0] = wrap(new_1 - self.x[0])
        if self.hold < 2 or self.links < 2:
            return delta
        r_a1 = r_a @ rot_y(self.x[0, 0]) @ rot_x(-self.x[0, 1])
        p1_to_p2 = base_to_p1 + r_a1 @ (l[1] * direction(*self.x[1])) - l[0] * along_1      # Fig. 6b
        distance_m = math.sqrt(p1_to_p2 @ p1_to_p2)
        if distance_m < 1e-6 * l[1]:
            return delta
        r_b1 = r_b @ rot_y(new_1[0]) @ rot_x(-new_1[1])
        delta[1] = wrap(angles_of(r_b1.T @ (p1_to_p2 / distance_m), self.x[1, 0]) - self.x[1])
        return delta

    def earlier_base_motion(self):
        """Delta': the base's earlier motion, seen at the *current* angles."""
        return self.base_motion(self.before_last, self.last)

    def step(self, pose):
        dt, mu, gamma, c, x, g = self.dt, self.mu, self.gamma, self.c, self.x, self.g
        delta = self.base_motion(self.last, pose)
        if self.scheme == "midpoint":
            rhs = ((mu - 0.5 * gamma * dt) * (g - self.earlier_base_motion()) - 0.5 * c * dt * (delta + g)
                   - dt ** 2 * (self.K @ (x + 0.25 * (delta - g))))
            self.g = delta + self.M_inverse @ rhs
            self.x = x + self.g
        else:                                                       # Eq. 5 with its sign corrected
            v, w = x + delta, self.w_prev + delta
            rhs = 2 * mu * v - (mu - 0.5 * gamma * dt) * w - dt ** 2 * self.k * v - c * dt * (v - w)
            self.x, self.w_prev = self.M_inverse @ rhs, v
        over = np.abs(self.x) > self.stop
        self.touched = bool(over.any())
        if self.touched:                                            # joint stop: placed on it, no motion left
            self.x = np.clip(self.x, -self.stop, self.stop)
            self.g = np.where(over, 0.0, self.g)
            self.w_prev = np.where(over, self.x, self.w_prev)
        self.before_last, self.last = self.last, pose


def simulate(rod, position_m, rotation, restart, start_rad=0.0):
    """Every tick's angles (ticks x N x 2) and whether a joint met its stop at that tick."""
    angle_rad, touched = np.zeros((len(restart), rod.links, 2)), np.zeros(len(restart), bool)
    for n, again in enumerate(restart):
        pose = (position_m[n], rotation[n])
        rod.rest(pose, start_rad) if again else rod.step(pose)
        angle_rad[n], touched[n] = rod.x, rod.touched
    return angle_rad, touched


def given_settings(pairs, defaults):
    """['links=3', 'spring=80,70,60', ...] over the defaults, still as texts."""
    given = dict(defaults)
    for pair in pairs:
        key, equals, value = pair.partition("=")
        if not equals or key not in defaults:
            raise UserError(f"--set {pair}: expected key=value, key one of {' '.join(defaults)}")
        given[key] = value
    return given


def settings_from(pairs):
    """['links=3', 'spring=80,70,60', ...] -> every setting, per-joint ones as arrays of N."""
    given = given_settings(pairs, DEFAULTS)
    try:
        links, hold = int(given["links"]), int(given["hold"])
        joint = {key: np.array([float(v) for v in str(given[key]).split(",")]) for key in PER_JOINT}
    except ValueError as error:
        raise UserError(f"--set: {error}") from None
    if links < 1 or hold not in (1, 2) or given["scheme"] not in ("midpoint", "paper"):
        raise UserError("--set: links must be >= 1, hold 1 or 2, scheme midpoint or paper")
    for key, values in joint.items():
        positive, bound = key in ("length", "inertia", "limit"), math.pi / 2 if key == "limit" else math.inf
        if len(values) not in (1, links) or not np.all((values > 0 if positive else values >= 0) & (values < bound)):
            raise UserError(f"--set {key}={given[key]}: one value or {links}, {'>' if positive else '>='} 0"
                            + (", under pi/2 rad" if key == "limit" else ", finite"))
        joint[key] = np.broadcast_to(values, links).copy()
    return {"links": links, "hold": hold, "scheme": given["scheme"], **joint}


def csv_header(links):
    return ",".join(["t"] + [f"{axis}{i + 1}" for i in range(links) for axis in ("theta", "phi")])


# ---------------------------------------------------------------- agreement with the simulator

TOLERANCE_RAD = 2e-3             # about 0.1 degree: no servo shows it
# How far the recording itself decides: the oracle runs twice, the second time with every tick's base position moved by
# up to 1e-7 m (on real tracks that usually moves the rod ten times as far as rounding the input to float32). From
# the first row at which this alone moved an angle by the whole tolerance, a difference says nothing about the code,
# and the cut is final: after a stop met or missed a rod may take another path for as long as it is shaken.
# Which rows are left depends on oracle and track alone, never on the simulator, and a stiff rod must keep most of them.
DISTURBANCE_M, SEED = 1e-7, 1
SHARE = 0.9                      # of the rows must be left, where the spring is stiff
SOFT_SPRING = 500.0              # below it a shaken rod is chaotic from its first contact with a stop: compared to there


def simulator_angles(sim, track, rate_hz, pairs, tick_s, links):
    """Angles as `limber-sim replay` writes them (ticks x N x 2)."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "angles.csv"
        command = [str(sim), "replay", str(track), "--rate", f"{rate_hz:.12g}", "--angles", str(out)]
        command += [word for pair in pairs for word in ("--set", pair)]
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=300)
            if done.returncode != 0:
                raise UserError(f"{sim} exit {done.returncode}: {' '.join(done.stderr.split()) or 'no message'}")
            header, *rows = out.read_text(encoding="utf-8").split()
            table = np.array([row.split(",") for row in rows], float)
        except (OSError, ValueError, subprocess.TimeoutExpired) as error:
            raise UserError(f"{sim}: {error}") from None
    if header != csv_header(links) or table.shape != (len(tick_s), 1 + 2 * links):
        raise UserError(f"{sim}: {len(rows)} rows under {header[:30]}…, expected {len(tick_s)} for {links} links")
    if not np.all(np.abs(table[:, 0] - tick_s) < 1e-6):
        raise UserError(f"{sim}: column t is not n / rate")
    return table[:, 1:].reshape(len(tick_s), links, 2)


def judge(case):
    """(sim, track, rate_hz, pairs, least share, least peak [rad]) -> (verdict, table line)."""
    sim, track, rate_hz, pairs, share, least_rad = case
    try:
        settings = settings_from(pairs)
        tick_s, position_m, rotation, restart = replayed_poses(track, rate_hz)
        rod, links, rows = Rod(settings, rate_hz), settings["links"], len(tick_s)
        expected, touched = simulate(rod, position_m, rotation, restart)
        push_m = np.random.default_rng(SEED).uniform(-DISTURBANCE_M, DISTURBANCE_M, position_m.shape)
        moved = np.abs(simulate(rod, position_m + push_m, rotation, restart)[0] - expected).max(axis=(1, 2))
        got = simulator_angles(sim, track, rate_hz, pairs, tick_s, links)
    except UserError as error:
        return "FAIL", f"{Path(track).name:<28} {rate_hz:>5g} {' '.join(pairs)}: FAIL {error}"
    soft = settings["spring"].min() < SOFT_SPRING
    end = (moved >= TOLERANCE_RAD) | (touched & soft)
    compared = int(np.argmax(end)) if end.any() else rows           # at least 1: row 0 is all zeros
    error_rad = np.nan_to_num(np.abs(got - expected)[:compared], nan=np.inf)
    worst = np.unravel_index(np.argmax(error_rad), error_rad.shape)
    peak_rad = np.abs(expected[:compared]).max()
    faults = [text for fault, text in (
        (error_rad[worst] > TOLERANCE_RAD, f"differs by more than {TOLERANCE_RAD:g} rad"),
        (not np.all(np.abs(got) <= settings["limit"][:, None] + 1e-6), "beyond a stop, or no number"),      # any row
        (not soft and compared < share * rows, f"under {share:.0%} of the rows comparable"),
        (not soft and peak_rad < least_rad, "hardly moves: shows nothing")) if fault]
    verdict = "FAIL" if faults else "ok" if compared > 0.02 * rows else "none"      # none: too little to call it a pass
    spring = "..".join(f"{k:g}" for k in dict.fromkeys(settings["spring"][[0, -1]]))
    where = f"{tick_s[worst[0]]:.3f} s {('theta', 'phi')[worst[2]]}{worst[1] + 1}"
    others = " ".join(p for p in pairs if p.split("=")[0] not in ("links", "hold", "spring"))[:32]
    return verdict, (f"{Path(track).name:<28} {rate_hz:>5g} {links:>3} {settings['hold']:>4} {spring:>10} {rows:>6} "
                     f"{compared:>8} {peak_rad:>6.3f} {error_rad[worst]:>9.1e} {where:<17} {verdict:<4} {others} "
                     + "; ".join(faults)).rstrip()


def judge_all(cases):
    if not Path(cases[0][0]).is_file():
        raise UserError(f"--sim {cases[0][0]}: no such file")
    print(f"{'':8}{'track':<28} {'rate':>5} {'N':>3} {'hold':>4} {'k':>10} {'rows':>6} {'compared':>8} {'peak':>6} "
          f"{'max error':>9} where", flush=True)
    verdicts = []
    with multiprocessing.Pool(min(2, len(cases))) as pool:
        for verdict, line in pool.imap(judge, cases):
            verdicts.append(verdict)
            print(f"{len(verdicts):>3}/{len(cases):<3} {line}", flush=True)
    agree, fail = verdicts.count("ok"), verdicts.count("FAIL")
    print(f"{agree} agree within {TOLERANCE_RAD:g} rad, {fail} FAIL, {len(cases) - agree - fail} with too little to compare")
    return 1 if fail or not agree else 0


def awkward_track(path):
    """A swinging hand, badly recorded: gaps, repeated times, empty and flipped quaternions, uneven spacing."""
    rng, euroc = np.random.default_rng(2), path.suffix == ".csv"
    time_s = 100.0 + np.cumsum(rng.uniform(0.002, 0.018, 600))
    for gap_at, pause_s in ((150, 0.3137), (151, 0.2719), (400, 0.2211), (500, 1.1113)):    # 0.2211 s is no gap
        time_s[gap_at:] += pause_s
    lines = ["#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []" if euroc else "# timestamp tx ty tz qx qy qz qw"]
    for n, t in enumerate(time_s):
        half, size = 0.6 * math.sin(2.5 * t), (0 if n in (0, 80, 401) else -1.3 if n % 7 == 0 else 1)
        x, y, z, w = (size * v for v in (0.6 * math.sin(half), 0.8 * math.sin(half), 0, math.cos(half)))
        for wrong_m in (0.05, 0) if n in (60, 300) else (0,):       # of equal times the last is the one
            place = (0.2 * math.sin(5 * t) + wrong_m, 0.15 * math.cos(4 * t), 0.1 * math.sin(3 * t))
            numbers = [f"{v:.9f}" for v in (*place, *((w, x, y, z) if euroc else (x, y, z, w)))]
            lines.append(",".join([f"{t * 1e9:.0f}", *numbers]) if euroc else " ".join([f"{t:.9f}", *numbers]))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


TAPER = ["links=5", "spring=2600,2200,1800,1400,1000", "damper=12,11,10,9,8", "length=.04,.035,.03,.025,.02",
         "inertia=.3,.25,.2,.15,.12", "coupling=40,100,80,60,30", "smoothing=10,20,15,5,1000",   # the last is unused
         "drag=.5,.2,0,.1,.3", "limit=1.3,0.4,0.2,0.1,0.05"]


def suite(sim, folder, quick):
    def is_track(path):                                             # a folder may also list its tracks in a .csv
        return path.suffix == ".txt" or path.read_text(encoding="utf-8", errors="replace").startswith("#timestamp")
    tracks = [p for p in sorted(Path(folder).glob("*")) if p.suffix in (".txt", ".csv") and is_track(p)]
    if not tracks:
        print(f"SKIPPED: no tracks in {folder}")
        return 77
    cases = []

    def add(track, rate_hz, *pairs, share=SHARE):
        cases.append((sim, track, rate_hz, list(pairs), share, 5 * TOLERANCE_RAD))

    with tempfile.TemporaryDirectory() as made:
        for name in ("awkward.txt", "awkward.csv"):
            tracks.append(Path(made) / name)
            awkward_track(tracks[-1])
        for track in tracks:
            for rate_hz in (100,) if quick else (100, 500):
                for hold in ("hold=1", "hold=2"):
                    for links in ("links=4", "links=20"):
                        add(track, rate_hz, links, hold, "spring=2000", "damper=10")
                    add(track, rate_hz, *TAPER, hold)
                    # with the default damper, 2, a shaken rod rings from stop to stop: one recording leaves 17 %
                    add(track, rate_hz, "links=4", hold, "spring=2000", share=0.15)
                    add(track, rate_hz, "links=4", hold, "spring=80")
                add(track, rate_hz, "links=4", "spring=2000", "scheme=paper", share=0.15)
            for links in ("links=1", "links=2", "links=3"):
                add(track, 100, links, "hold=2", "spring=2000", "damper=10", "coupling=0", "smoothing=30")
        return judge_all(cases)


# ---------------------------------------------------------------- command line

def run(track, rate_hz, pairs, out):
    tick_s, position_m, rotation, restart = replayed_poses(track, rate_hz)
    rod = Rod(settings_from(pairs), rate_hz)
    angle_rad, touched = simulate(rod, position_m, rotation, restart)
    if out:
        table = np.column_stack([tick_s, angle_rad.reshape(len(tick_s), -1)])
        try:
            np.savetxt(out, table, fmt="%.9g", delimiter=",", header=csv_header(rod.links), comments="")
        except OSError as error:
            raise UserError(f"--angles {error}") from None
    met = f"a stop first met at {tick_s[np.argmax(touched)]:.3f} s" if touched.any() else "no stop met"
    print(f"{Path(track).name}: {len(tick_s)} ticks, {restart.sum() - 1} restarts, "
          f"largest angle {np.abs(angle_rad).max():.4f} rad, {met}")
    return 0


class OneLineParser(argparse.ArgumentParser):
    def error(self, message):
        self.exit(2, f"oracle.py: {message}\n")


def main():
    parser = OneLineParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, epilog=f"""\
examples:
  oracle.py run swing.txt --rate 500 --set links=20 --set spring=2000 --angles angles.csv
  oracle.py compare --sim build/host/limber-sim swing.txt shake.txt --set links=2 --set spring=2000,1500
  oracle.py suite --sim build/host/limber-sim tests/data/tracks --quick
keys for --set (one value, or one per joint separated by commas) and their defaults:
  {" ".join(f"{key}={value}" for key, value in DEFAULTS.items())}""")
    commands = parser.add_subparsers(dest="command", required=True)
    one = commands.add_parser("run", help="replay one track, write its angles")
    one.add_argument("track")
    one.add_argument("--angles", metavar="OUT.csv", help="columns t,theta1,phi1,theta2,phi2,…; seconds and radians")
    several = commands.add_parser("compare", help="replay tracks here and in limber-sim, compare row by row")
    several.add_argument("track", nargs="+")
    several.add_argument("--share", type=float, default=SHARE,
                         help=f"of the rows that must be comparable (default {SHARE}; soft springs: none)")
    everything = commands.add_parser("suite", help="compare a folder of tracks at many settings; exit 77 if it has none")
    everything.add_argument("folder", metavar="TRACKDIR")
    everything.add_argument("--quick", action="store_true", help="100 Hz only, under a minute")
    for command in (one, several):
        command.add_argument("--rate", type=float, default=100.0, metavar="HZ", help="ticks a second (default 100)")
        command.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="repeatable")
    for command in (several, everything):
        command.add_argument("--sim", required=True, help="path of limber-sim")
    given = parser.parse_args()
    try:
        if given.command == "run":
            return run(given.track, given.rate, given.set, given.angles)
        if given.command == "compare":
            for track in given.track:                               # a wrong command line is no disagreement
                replayed_poses(track, given.rate)
            Rod(settings_from(given.set), given.rate)
            return judge_all([(given.sim, track, given.rate, given.set, given.share, 0.0) for track in given.track])
        return suite(given.sim, given.folder, given.quick)
    except UserError as error:
        parser.error(str(error))


if __name__ == "__main__":
    sys.exit(main())
