"""The `contour` rod in float64, in the most literal form: dense matrices, an explicit inverse, 3 x 3 rotations (MODEL.md, frames and
contour; "Eq." is the paper's). It shares no line with the firmware. Needs numpy.
"""
import math

import numpy as np

from oracle_track import UserError

PER_JOINT = {"length": 0.03, "inertia": 0.2, "drag": 0.0, "coupling": 100.0, "smoothing": 0.0,
             "spring": 80.0, "damper": 2.0, "limit": 1.4}
DEFAULTS = {"links": 4, "hold": 1, "scheme": "midpoint", **PER_JOINT}


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
