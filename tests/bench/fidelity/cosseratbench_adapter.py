#!/usr/bin/env python3
"""limber as a solver of PyPI's cosseratbench 0.3, beside its own. Run in an environment of its own:

    pip install 'cosseratbench[all]==0.3' 'mujoco<4'      (mujoco 4.0 dropped the cable that cosseratbench drives)
    cosseratbench_adapter.py build/host/limber-sim

Only the cantilever: limber's rod is one that is clamped at its base, does not stretch and has no contact. Replay knows
no force on the tip, so the load is a weight there. The rest of the rod, which the scenario leaves weightless, is light,
and what little it bends the rod is extrapolated away.
"""
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from cosseratbench import registry
from cosseratbench.experiment import run
from cosseratbench.scenario import EndCondition, parallel_transport
from cosseratbench.trajectory import Trajectory

GRAVITY = 0.1                    # weak, so that even light nodes have a mass that limber takes
LIGHT = 1e-3                     # of the other nodes, as a share of the mass at the tip
RATE_HZ = 200


class LimberSolver:
    """Interface: cosseratbench.solver.Solver."""
    name, capabilities = "limber", frozenset()

    def __init__(self, program):
        self.program = program

    def run(self, scenario, *, n_elements, n_frames):
        (rod,) = scenario.rods
        (load,) = rod.loads
        start, along = rod.nodes(n_elements)[0], rod.nodes(n_elements)[-1] - rod.nodes(n_elements)[0]
        if rod.start is not EndCondition.CLAMPED or rod.end is not EndCondition.FREE or any(scenario.gravity):
            raise NotImplementedError("a rod that is not clamped at its start and loaded at its end alone")
        if np.linalg.norm(along[1:]) > 0 or any(load.force[:2]) or not scenario.quasi_static:
            raise NotImplementedError("a rod that is not level along x, or a load that is not its rest under a weight")
        link_m, bending = rod.length / n_elements, rod.material.youngs_modulus * rod.second_moment_of_area
        weight_kg = -load.force[2] / GRAVITY
        slowest = np.sqrt(3 * bending / (weight_kg * rod.length ** 3))       # rad/s, of that weight on that rod
        spring = np.array([2.0, *np.ones(n_elements - 1)]) * bending / link_m     # the clamp is half a cell
        settings = {"model": "elastic", "links": n_elements, "length": link_m, "gravity": GRAVITY, "spring": spring,
                    "damper": 2 * spring / slowest}                          # critical: it may be damped as one likes
        light, heavier = (self.replay(scenario.duration, settings | {
            "mass": weight_kg * np.array([*np.full(n_elements - 1, share), 1.0])}) for share in (LIGHT, 2 * LIGHT))
        nodes = 2 * light - heavier
        pick = np.rint(np.linspace(0, len(nodes) - 1, n_frames)).astype(int)
        positions = start + nodes[pick]
        directors = np.array([parallel_transport(frame, np.asarray(rod.normal)) for frame in positions])
        return Trajectory(np.linspace(0, scenario.duration, n_frames), (positions,), (directors,))

    def replay(self, duration_s, settings):
        """Nodes [m] of a base that lies still, its rod along x."""
        with tempfile.TemporaryDirectory() as folder:
            track, nodes = Path(folder) / "still.txt", Path(folder) / "nodes.csv"
            level = "0 0 0 0 0.70710678118654752 0 0.70710678118654752"
            tenths = range(int(np.ceil(duration_s / 0.1)) + 1)
            track.write_text("".join(f"{n / 10:.1f} {level}\n" for n in tenths), encoding="ascii")
            texts = {key: " ".join(map(str, np.atleast_1d(value))) for key, value in settings.items()}
            subprocess.run([self.program, "replay", track, "--rate", str(RATE_HZ), "--nodes", nodes,
                            *(f"--set={key}={text}" for key, text in texts.items())],
                           check=True, stdout=subprocess.DEVNULL)
            return np.loadtxt(nodes, delimiter=",", skiprows=1)[:, 1:].reshape(-1, settings["links"] + 1, 3)


def main(program):
    experiment = registry.load_experiment("cantilever")
    for n_elements in (10, 20, 50):
        for solver in (LimberSolver(program), *map(registry.load_solver, ("mujoco", "pyelastica"))):
            result = run(experiment, solver, n_elements=n_elements)
            print(f"{n_elements:3} elements  {solver.name:10}  tip deflection off by "
                  f"{100 * result.metrics['tip_deflection_error']:.3f} %, still moving at "
                  f"{result.metrics['settling_residual']:.1e} lengths/s", flush=True)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]) if len(sys.argv) == 2 else f"usage: {sys.argv[0]} LIMBER_SIM")
