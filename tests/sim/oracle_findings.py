#!/usr/bin/env python3
"""Measures with the float64 oracle what MODEL.md states of the contour model, statement by statement.

The same statements are tested of the float32 core in test_findings.c; this is where their numbers come from.
"""
import math
import sys

import numpy as np

from oracle_rod import Rod, settings_from, simulate


class NaiveRod(Rod):
    """Delta added to both stored time levels: the earlier motion as it was seen at the earlier angles."""
    stored = 0.0

    def step(self, pose):
        now = self.base_motion(self.last, pose)
        super().step(pose)
        self.stored = now

    def earlier_base_motion(self):
        return self.stored


def drive(position_of, seconds, rate_hz, pairs, start_rad=0.0, kind=Rod):
    """Rod on a base that moves without turning: (times, ticks x N x 2)."""
    time_s = np.arange(round(seconds * rate_hz) + 1) / rate_hz
    position_m = np.stack(np.broadcast_arrays(*position_of(time_s)), axis=1).astype(float)
    rod, rotation = kind(settings_from(pairs), rate_hz), [np.eye(3)] * len(time_s)
    return time_s, simulate(rod, position_m, rotation, time_s == 0, start_rad)[0]


def circle(*pairs):
    """The paper's circle: amplitudes and phases of theta over the last 3 of 6 turns; theta_1 less that, early on."""
    turn_s, radius_m = 2.39, 0.15
    w = 2 * math.pi / turn_s
    t, x = drive(lambda t: (radius_m * np.cos(w * t), radius_m * np.sin(w * t), 0), 6 * turn_s, 100, pairs)
    waves, late = np.stack([np.cos(w * t), np.sin(w * t), t ** 0], axis=1), t >= 3 * turn_s
    fit = np.linalg.lstsq(waves[late], x[late, :, 0], rcond=None)[0]
    ripple = (x[:, 0, 0] - waves @ fit[:, 0])[(t >= 0.2) & (t <= 0.6)]
    return np.hypot(fit[0], fit[1]), np.degrees(np.arctan2(fit[1], fit[0])), math.sqrt(np.mean(ripple ** 2))


def jump(rate_hz, *pairs):
    """0.1 m sideways in 50 ms, raised cosine: peak of theta_1, and when it stays within 2 % of that."""
    t, x = drive(lambda t: (0.05 * (1 - np.cos(math.pi * np.clip(t / 0.05, 0, 1))), 0, 0), 1.0, rate_hz,
                 ["spring=2000", "damper=10", "coupling=20", *pairs])
    theta = np.abs(x[:, 0, 0])
    return theta.max(), t[np.nonzero(theta > 0.02 * theta.max())[0][-1]]


def thrust(kind, rate_hz, start_rad, seconds, *pairs):
    """Base pushed along the rod at 1 m/s: largest angle, that of the last second, growth of theta_1's peaks [1/s]."""
    t, x = drive(lambda t: (0, 0, t), seconds, rate_hz, ["spring=80", "damper=0.2", "coupling=20", *pairs],
                 start_rad, kind)
    y = np.abs(x[:, 0, 0])
    peak = 1 + np.nonzero((y[1:-1] >= y[:-2]) & (y[1:-1] >= y[2:]) & (t[1:-1] > 0.2) & (y[1:-1] < 0.02))[0]
    growth_per_s = np.polyfit(t[peak], np.log(y[peak]), 1)[0] if len(peak) > 2 else math.nan
    return np.abs(x).max(), np.abs(x[t > t[-1] - 1]).max(), growth_per_s


def findings():
    """Print measured against stated; 1 if any leaves what is stated."""
    verdicts = []

    def show(what, measured, stated, within, form="{:.4f}"):
        measured, stated = np.atleast_1d(measured), np.atleast_1d(stated)
        verdicts.append(bool(np.all(np.abs(measured - stated) <= within)))
        text = ["/".join(form.format(v) for v in values) for values in (measured, stated)]
        print(f"{'ok  ' if verdicts[-1] else 'FAIL'} {what:<60} {text[0]:<30} stated {text[1]} +- {within:g}", flush=True)

    for k, amplitude, lag, within in ((10, (.054, .044, .038, .035), (0, 2.9, 5.3, 6.7), .06),
                                      (80, (.029, .013, .006, .003), (0, .8, 1.7, 2.5), .06),
                                      (2000, (.003,), (0, 0, 0, 0), .22)):
        size, phase, _ = circle(f"spring={k}", "damper=1")
        show(f"circle, k = {k}: amplitudes [rad]", size[:len(amplitude)], amplitude, 6e-4)
        show(f"circle, k = {k}: lags against joint 1 [deg]", phase - phase[0], lag, within, "{:.2f}")
    (size, phase, ripple), (size_8, phase_8, ripple_8) = (
        circle("spring=80", "coupling=20", f"damper={c}") for c in (0.2, 8))
    show("circle, c = 0.2 -> 8: amplitude of theta_1 [rad]", (size[0], size_8[0]), (.0597, .0586), 1e-4)
    show("circle, c = 0.2 -> 8: phase moves by [deg]", phase_8[0] - phase[0], 10, .6, "{:.1f}")
    show("circle, c = 0.2 -> 8: ripple, 0.2 to 0.6 s [rad RMS]", (ripple, ripple_8), (.026, .0002), 3e-4)

    peak_rad, settled_s = zip(*(jump(rate_hz) for rate_hz in (100, 250, 500, 1000, 2000)))
    show("jump: peak at 100/250/500/1000/2000 Hz [rad]", peak_rad, (.69, .81, .82, .83, .84), 6e-3, "{:.3f}")
    show("jump: within 2 % after [s]", settled_s, (.23, .19, .19, .19, .19), 1e-2, "{:.3f}")
    peak_rad = [jump(rate_hz, "scheme=paper")[0] for rate_hz in (100, 250, 500, 1000, 2000)]
    show("jump, scheme = paper: peak (first measured here) [rad]", peak_rad, (.560, .536, .618, .703, .745), 6e-3, "{:.3f}")

    growing = (0.2 * 1.0 / 0.03 - 0.2) / (2 * 0.2)                  # (mu v/l - c) / 2 mu
    for name, kind, pairs, growth, end_rad in (("midpoint", Rod, (), -0.5, 0), ("naive", NaiveRod, (), growing, 1.4),
                                               ("paper", Rod, ("scheme=paper",), growing, 1.4)):
        measured = thrust(kind, 5000, 1e-12, 1.2, "links=1", *pairs)[2]
        show(f"thrust, {name}: growth, N = 1, 5 kHz [1/s]", measured, growth, .1, "{:.2f}")
        largest, left, _ = thrust(kind, 100, 0.01, 10.0, *pairs)
        show(f"thrust, {name}, N = 4, 100 Hz: " + ("largest [rad]" if end_rad else "left after 10 s [rad]"),
             largest if end_rad else left, end_rad, 5e-4)

    # scheme = paper, one joint, spring and damper explicit: stable while k dt^2 + 2 c dt < 4 mu, here k < 7600
    for pairs, start_rad, end_rad in ((["damper=2"], 1, 0), (["damper=0", "drag=2"], 1, 0),
                                      (["hold=2", "smoothing=50"], 1, 0),
                                      (["scheme=paper", "links=1", "coupling=0", "spring=7500"], .01, 0),
                                      (["scheme=paper", "links=1", "coupling=0", "spring=7700"], .01, 1.4)):
        _, x = drive(lambda t: (0, 0, 0 * t), 10.0, 100, pairs, start_rad)
        show(f"base still, {' '.join(pairs)} [rad]", np.abs(x[-50:]).max(), end_rad, 1e-5, "{:.1e}")
    return 0 if all(verdicts) else 1


if __name__ == "__main__":
    sys.exit(findings())
