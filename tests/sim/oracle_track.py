"""Recordings for the float64 references: read, cleaned and resampled as MODEL.md, Section 6 (Replay), says; and a made one with all
that goes wrong in a recording. It shares no line with the firmware. Needs numpy.
"""
import functools
import math
from pathlib import Path

import numpy as np

GAP_S = 0.25                     # a longer pause between two samples is not bridged
TICK_SLACK = 1e-9                # in ticks: times printed in decimals miss a tick they mean by a rounding


class UserError(Exception):
    """Something the user can mend: one line, exit status 2."""


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
