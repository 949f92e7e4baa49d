#!/usr/bin/env python3
"""Fits `contour` to MuJoCo's rods, each case for itself; writes tests/data/fidelity/contour.csv. Needs numpy, scipy.

Only the ratios of inertia, spring, damper, coupling and drag matter, so inertia stays at 0.2 and the others are sought
over several decades, for hold 1 and 2: a coarse look around, then Nelder and Mead from the best places.
"""
import sys
import tempfile

import numpy as np
from scipy.optimize import minimize

import cases
import compare
import stored

INERTIA, RATE_HZ = 0.2, 1000
DECADES = np.array([(0, 4), (-3, 1), (0, 4), (-3, 1)])      # of spring, damper, coupling, drag
LOOKS, PLACES, TRIES = 60, 2, 100


def settings(hold, decades):
    values = (hold, INERTIA, *(f"{10 ** decade:.4g}" for decade in decades))
    return {"limit": compare.CONTOUR_LIMIT, **dict(zip(compare.CONTOUR_KEYS, values, strict=True))}


def fit(simulator, rod, motion):
    reference = stored.read(motion.name)[rod.name]

    def error(decades, hold):
        if np.any(decades < DECADES[:, 0] - 1) or np.any(decades > DECADES[:, 1] + 1):
            return np.inf
        try:
            nodes = simulator.kept_nodes(rod, motion, RATE_HZ, settings(hold, decades))
        except RuntimeError:                 # refused: damped beyond what the tick allows
            return np.inf
        return compare.tip_percent(nodes, reference)[0]

    random, found = np.random.default_rng(57), []
    for hold in (1, 2):
        looks = random.uniform(*DECADES.T, (LOOKS, len(DECADES)))
        for start in sorted(looks, key=lambda decades: error(decades, hold))[:PLACES]:
            result = minimize(error, start, (hold,), "Nelder-Mead", options={"maxfev": TRIES})
            found.append((result.fun, settings(hold, result.x)))
    return min(found, key=lambda one: one[0])


def main():
    rows = [",".join(["motion", "rod", *compare.CONTOUR_KEYS])]
    with tempfile.TemporaryDirectory(prefix="limber-fidelity-") as folder:
        simulator = compare.Simulator(sys.argv[1], folder)
        for motion in (motion for motion in cases.MOTIONS.values() if motion.available):
            for rod in (rod for rod in cases.RODS if rod.links == compare.CONTOUR_LINKS):
                rms, found = fit(simulator, rod, motion)
                rows.append(",".join([motion.name, rod.name, *(str(found[key]) for key in compare.CONTOUR_KEYS)]))
                print(f"{rms:8.3f} %", rows[-1], flush=True)
    (stored.FOLDER / "contour.csv").write_text("\n".join(rows) + "\n", encoding="ascii")


if __name__ == "__main__":
    sys.exit(main() if len(sys.argv) == 2 else f"usage: {sys.argv[0]} LIMBER_SIM")
