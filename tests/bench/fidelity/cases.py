"""The rods and base motions that limber and MuJoCo are both given. Needs numpy and nothing else.

All rods have the same length, mass and bending stiffness whatever their number of links: N point masses of M/N, links
of L/N, and at each joint k N/10 and c N/10 with the k and c of ten links. A motion is a smooth function of time, so
that a rigid-body engine can be told the base's velocity and acceleration; limber gets it as a track with a sample on
every tick.
"""
import functools
from dataclasses import dataclass
from pathlib import Path

import numpy as np

LENGTH_M, MASS_KG = 0.6, 0.2
LINKS = (4, 10, 20, 50)
STIFFNESS = {"soft": (2.0, 0.01), "medium": (10.0, 0.02), "stiff": (100.0, 0.1)}  # k [N m/rad], c [N m s/rad], 10 links
TRACK_HZ = 1000
RECORDED_TRACKS = Path(__file__).resolve().parents[4] / "shared" / "tracks"


@dataclass(frozen=True)
class Rod:
    stiffness: str
    links: int

    @property
    def name(self):
        return f"{self.stiffness}-{self.links}"

    @property
    def link_m(self):
        return LENGTH_M / self.links

    @property
    def node_kg(self):
        return MASS_KG / self.links

    @property
    def spring(self):
        return STIFFNESS[self.stiffness][0] * self.links / 10

    @property
    def damper(self):
        return STIFFNESS[self.stiffness][1] * self.links / 10


RODS = tuple(Rod(stiffness, links) for stiffness in STIFFNESS for links in LINKS)


@dataclass(frozen=True)
class Motion:
    name: str
    duration_s: float
    gravity: float               # m/s^2 along world -z
    pose: object                 # times [s] -> positions [m] (n, 3) from the first, unit quaternions x y z w (n, 4)
    recorded: str = ""           # the file in RECORDED_TRACKS it is made from

    @property
    def available(self):
        return not self.recorded or (RECORDED_TRACKS / self.recorded).is_file()


# ---------------------------------------------------------------- generated motions

def smooth_step(share):
    """0 to 1 with no jump in velocity or acceleration."""
    share = np.clip(share, 0, 1)
    return share ** 3 * (10 - 15 * share + 6 * share ** 2)


def about(axis, angle_rad):
    """Quaternions of turns about one axis."""
    axis = np.asarray(axis, float) / np.linalg.norm(axis)
    return np.column_stack([np.sin(angle_rad / 2)[:, None] * axis, np.cos(angle_rad / 2)])


def design(t):
    """In one plane, and at its fastest from the first instant, when the rod still rests: a kick."""
    zero = np.zeros_like(t)
    return (np.column_stack([0.15 * np.sin(2 * np.pi * t), zero, zero]),
            about([0, 1, 0], 3 / 81 * (1 - np.cos(9 * t))))


def design_eased(t):
    """The same, grown from rest: without the kick of the first instant."""
    grow = smooth_step(t / 0.5)
    position_m, _ = design(t)
    return grow[:, None] * position_m, about([0, 1, 0], grow * 3 / 81 * (1 - np.cos(9 * t)))


def circle(t):
    """A whip swung overhead in a circle, its handle leaning now this way, now that."""
    grow, turn = smooth_step(t / 0.8), 2 * np.pi * t
    return (0.15 * grow[:, None] * np.column_stack([np.cos(turn), np.sin(turn), 0.2 * np.sin(2 * turn)]),
            about([1, 0.5, 0], 0.4 * grow * np.sin(5 * t)))


def jerk(t):
    """A rod held level, pulled 0.1 m aside and upward within 80 ms, turned a little, and held still."""
    gone = smooth_step((t - 0.2) / 0.08)
    level = np.broadcast_to(about([0, 1, 0], np.array([np.pi / 2])), (len(t), 4))
    return gone[:, None] * [0, 0.1, 0.04], quaternion_product(level, about([1, 1, 0], 0.2 * gone))


def shake(t):
    """As hard as a hand can, in three axes: peaks of 3 m/s and 70 m/s^2."""
    grow = smooth_step(t / 0.3)
    return (grow[:, None] * np.column_stack([0.08 * np.sin(2 * np.pi * 4.1 * t), 0.06 * np.sin(2 * np.pi * 4.7 * t + 1),
                                             0.03 * np.sin(2 * np.pi * 3.3 * t)]),
            about([1, -0.7, 0.4], 0.35 * grow * np.sin(2 * np.pi * 3.7 * t)))


def quaternion_product(a, b):
    vector = a[:, 3:] * b[:, :3] + b[:, 3:] * a[:, :3] + np.cross(a[:, :3], b[:, :3])
    return np.column_stack([vector, a[:, 3] * b[:, 3] - np.sum(a[:, :3] * b[:, :3], axis=1)])


# ---------------------------------------------------------------- recorded motions

def recorded(name, file, start_s, duration_s):
    """A stretch of a recording as a C2 curve: a cubic spline, at rest at first, through the means over every 40 ms.
    Glitches and noise of the tracker would test the tracker, with 900 m/s^2 of it."""
    window_s = 0.04

    @functools.cache
    def spline():
        rows = np.loadtxt(RECORDED_TRACKS / file)
        rows = rows[np.any(rows[:, 4:] != 0, axis=1)]
        rows[:, 0] -= rows[0, 0] + start_s
        signs = np.where(np.sum(rows[1:, 4:] * rows[:-1, 4:], axis=1) < 0, -1.0, 1.0)
        rows[1:, 4:] *= np.cumprod(signs)[:, None]
        window = np.floor(rows[:, 0] / window_s)
        means = np.array([rows[window == n].mean(axis=0) for n in np.unique(window)
                          if 0 <= n <= duration_s / window_s + 2])
        return cubic_spline(means[:, 0] - means[0, 0], means[:, 1:])

    def pose(t):
        values, first = spline()(t), spline()(np.zeros(1))
        return values[:, :3] - first[:, :3], values[:, 3:] / np.linalg.norm(values[:, 3:], axis=1)[:, None]

    return Motion(name, duration_s, 9.81, pose, file)


def cubic_spline(knots, values):
    """Through all values, slope 0 at the first knot, curvature 0 at the last."""
    step, slope = np.diff(knots), np.diff(values, axis=0) / np.diff(knots)[:, None]
    system = np.diag(np.concatenate([[2 * step[0]], 2 * (step[:-1] + step[1:]), [1.0]]))
    system[np.arange(len(step)), np.arange(1, len(knots))] = step
    system[np.arange(1, len(step)), np.arange(len(step) - 1)] = step[:-1]
    curvature = np.linalg.solve(system, 6 * np.vstack([slope[:1], np.diff(slope, axis=0), 0 * slope[:1]]))

    def at(t):
        i = np.clip(np.searchsorted(knots, t, side="right") - 1, 0, len(step) - 1)
        h, a, b = step[i, None], (knots[i + 1] - t)[:, None], (t - knots[i])[:, None]
        bend = curvature[i] * (a ** 3 / h - h * a) + curvature[i + 1] * (b ** 3 / h - h * b)
        return (values[i] * a + values[i + 1] * b) / h + bend / 6

    return at


MOTIONS = {motion.name: motion for motion in (
    Motion("design", 3.0, 0.0, design),
    Motion("design-eased", 3.0, 0.0, design_eased),
    Motion("circle", 3.0, 9.81, lambda t: (circle(t)[0] - circle(np.zeros(1))[0], circle(t)[1])),
    Motion("jerk", 2.0, 9.81, jerk),
    Motion("shake", 2.0, 9.81, shake),
    recorded("recorded-shake", "04_vive_shake_knuckles.txt", 1.8, 2.0),
    recorded("recorded-arcs", "08_index_hmd_arcs_500hz.txt", 0.0, 3.0),
)}


def write_track(motion, path):
    """The motion as a TUM file with a sample on every tick."""
    t = np.arange(round(motion.duration_s * TRACK_HZ) + 1) / TRACK_HZ
    position_m, quaternion = motion.pose(t)
    np.savetxt(path, np.column_stack([t, position_m, quaternion]), fmt="%.4f" + " %.12g" * 7)
