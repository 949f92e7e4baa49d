#!/usr/bin/env python3
"""limber-sim's rods beside MuJoCo's, as stored in tests/data/fidelity: how far apart the tips are, in % of the length.

`elastic` gets the same parameters, nothing fitted; `contour`, which has no gravity, the parameters that fit each case
best (fit_contour.py). Needs numpy and nothing else; recorded motions are compared where the recordings are.
"""
import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import cases
import stored

RATES_HZ = (1000, 100)
CONTOUR_LINKS, CONTOUR_LIMIT = 10, 1.57   # contour is fitted to rods of so many links; its joints stop at so many rad
CONTOUR_KEYS = ("hold", "inertia", "spring", "damper", "coupling", "drag")
QUICK_LINKS = (4, 10)

# What is allowed at every rate: tip RMS in % of the length, of any number of links or of the one rod named; about 1.5 times
# what was measured. ANY where a soft rod whips about the hand, which amplifies small differences beyond use.
ANY = float("inf")
BOUNDS = {
    ("design", "soft"): 0.1, ("design", "medium"): 0.06, ("design", "medium-10"): 0.035, ("design", "stiff"): 0.07,
    ("design-eased", "soft"): 0.06, ("design-eased", "medium"): 0.06, ("design-eased", "stiff"): 0.007,
    ("circle", "soft"): 1.6, ("circle", "medium"): 0.04, ("circle", "stiff"): 0.005,
    ("jerk", "soft"): 0.25, ("jerk", "medium"): 0.13, ("jerk", "stiff"): 0.08,
    ("shake", "soft"): ANY, ("shake", "medium"): 0.09, ("shake", "stiff"): 2.5,
    ("recorded-shake", "soft"): 0.5, ("recorded-shake", "medium"): 0.16, ("recorded-shake", "stiff"): 3.0,
    ("recorded-arcs", "soft"): 0.9, ("recorded-arcs", "medium"): 0.13, ("recorded-arcs", "stiff"): 0.11,
}


def contour_settings():
    """(motion, rod name) -> settings of limber-sim, from the fitted parameters."""
    fitted = {}
    for line in (stored.FOLDER / "contour.csv").read_text(encoding="ascii").splitlines()[1:]:
        motion, rod, *values = line.split(",")
        fitted[motion, rod] = {"limit": CONTOUR_LIMIT, **dict(zip(CONTOUR_KEYS, values, strict=True))}
    return fitted


def elastic_settings(rod, motion):
    return {"model": "elastic", "mass": rod.node_kg, "spring": rod.spring, "damper": rod.damper,
            "gravity": motion.gravity}


class Simulator:
    """limber-sim replay of the motions' tracks, in a folder of its own."""

    def __init__(self, program, folder):
        self.program, self.folder, self.tracks = program, Path(folder), {}

    def track(self, motion):
        if motion.name not in self.tracks:
            self.tracks[motion.name] = self.folder / f"{motion.name}.txt"
            cases.write_track(motion, self.tracks[motion.name])
        return self.tracks[motion.name]

    def kept_nodes(self, rod, motion, rate_hz, settings):
        """The nodes that are stored of the reference, when they are [m] (samples, kept nodes, 3)."""
        nodes_path = self.folder / "nodes.csv"
        settings = {"links": rod.links, "length": rod.link_m, **settings}
        done = subprocess.run([self.program, "replay", self.track(motion), "--rate", str(rate_hz),
                               "--nodes", nodes_path, *(f"--set={key}={value}" for key, value in settings.items())],
                              capture_output=True, text=True, check=False)
        if done.returncode:
            raise RuntimeError(f"{motion.name} {rod.name}: {done.stderr.strip()}")
        rows = nodes_path.read_text(encoding="ascii").splitlines()[1::stored.EVERY_TICKS * rate_hz // cases.TRACK_HZ]
        numbers = np.array([row.split(",")[1:] for row in rows], float).reshape(len(rows), rod.links + 1, 3)
        return numbers[:, stored.kept_nodes(rod.links)]


def tip_percent(nodes, reference):
    """Distance between the tips in % of the length: RMS and maximum."""
    distance = np.linalg.norm(nodes[:, -1] - reference[:, -1], axis=1) / cases.LENGTH_M * 100
    return np.sqrt(np.mean(distance ** 2)), distance.max()


def compare(simulator, motions, links):
    """(motion, rod, what it is: a rate of elastic, or "contour") -> (RMS, maximum) in %."""
    fitted, results = contour_settings(), {}
    for motion in motions:
        references = stored.read(motion.name)
        for rod in (rod for rod in cases.RODS if rod.links in links):
            if rod.name not in references:
                print(f"{motion.name} {rod.name}: no reference yet (reference.py)", file=sys.stderr)
                continue
            runs = {rate: (rate, elastic_settings(rod, motion)) for rate in RATES_HZ}
            if (motion.name, rod.name) in fitted:
                runs["contour"] = (max(RATES_HZ), fitted[motion.name, rod.name])
            for what, (rate_hz, settings) in runs.items():
                nodes = simulator.kept_nodes(rod, motion, rate_hz, settings)
                results[motion.name, rod, what] = tip_percent(nodes, references[rod.name])
    return results


def report(results):
    """Tip RMS and maximum of each case, in % of the length."""
    print(f"{'motion':16} {'rod':10}{'1 kHz':>12}{'100 Hz':>20}{'contour, fitted':>20}")
    for motion, rod in dict.fromkeys((motion, rod) for motion, rod, _ in results):
        columns = (results.get((motion, rod, what)) for what in (*RATES_HZ, "contour"))
        print(f"{motion:16} {rod.name:10}", *(f"{rms:9.4f} {most:8.3f}  " for rms, most in filter(None, columns)))


def markdown(results):
    """The table of MODEL.md: tip RMS in % of the length, one row for each motion and stiffness."""
    links = sorted({rod.links for _, rod, _ in results})
    heads = [f"{n} links, {rate} Hz" for rate in RATES_HZ for n in links]
    print("| motion | rod |", " | ".join([*heads, f"`contour`, {CONTOUR_LINKS} links"]), "|")
    print("|---" * (len(heads) + 3) + "|")
    for motion, stiffness in dict.fromkeys((motion, rod.stiffness) for motion, rod, _ in results):
        keys = [(motion, cases.Rod(stiffness, n), rate) for rate in RATES_HZ for n in links]
        keys.append((motion, cases.Rod(stiffness, CONTOUR_LINKS), "contour"))
        cells = (f"{results[key][0]:.2g}" if key in results else "" for key in keys)
        print(f"| {motion} | {stiffness} |", " | ".join(cells), "|")


def beyond(results):
    """Complaints about cases that are not as near to MuJoCo as they are to be."""
    for (motion, rod, what), (rms, _) in results.items():
        if what == "contour":
            continue
        bound = BOUNDS.get((motion, rod.name), BOUNDS[motion, rod.stiffness])
        if not rms <= bound:
            yield f"{motion} {rod.name} at {what} Hz: tip RMS {rms:.4f} % of the length, allowed are {bound:g} %"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sim", help="limber-sim")
    parser.add_argument("--quick", action="store_true", help=f"generated motions and rods of {QUICK_LINKS} links only")
    parser.add_argument("--markdown", action="store_true", help="print the table of firmware/core/MODEL.md")
    options = parser.parse_args()
    motions = [motion for motion in cases.MOTIONS.values()
               if motion.available and not (options.quick and motion.recorded)]
    with tempfile.TemporaryDirectory(prefix="limber-fidelity-") as folder:
        results = compare(Simulator(options.sim, folder), motions, QUICK_LINKS if options.quick else cases.LINKS)
    (markdown if options.markdown else report)(results)
    complaints = list(beyond(results))
    print("\n".join(complaints), file=sys.stderr, end="\n" if complaints else "")
    return bool(complaints)


if __name__ == "__main__":
    sys.exit(main())
