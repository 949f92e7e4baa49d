#!/usr/bin/env python3
"""What MuJoCo makes of the rods and motions of cases.py, written to tests/data/fidelity. Needs numpy and PyPI's mujoco.

The rod is a chain of links without mass on MuJoCo's own ball joints, with their springs and dampers, and a mass at the
end of each link. A ball also twists, which a massless link would do infinitely fast: the masses get a little inertia,
so that the step resolves that too, and what is written is extrapolated from two runs, with inertia and step halved in
the second. The base is prescribed exactly: its joints carry so much armature that the rod cannot disturb them, it gets
the motion's acceleration in every step, and its position and velocity are put right after it.
"""
import argparse
import sys

import mujoco
import numpy as np

import cases
import stored

ARMATURE_KG = 1e6
LONGEST_STEP_S = 4e-5
DIFFERENCE_S = 1e-4              # of the base's path, for its velocity and acceleration


def rod_xml(rod, gravity, step_s, inertia_kg_m2):
    bodies = "".join(
        f'<body pos="0 0 {rod.link_m if i else 0}"><joint type="ball" stiffness="{rod.spring}" damping="{rod.damper}"/>'
        f'<inertial pos="0 0 {rod.link_m}" mass="{rod.node_kg}" diaginertia="{f"{inertia_kg_m2} " * 3}"/>'
        for i in range(rod.links))
    slides = "".join(f'<joint type="slide" axis="{axis}" armature="{ARMATURE_KG}"/>'
                     for axis in ("1 0 0", "0 1 0", "0 0 1"))
    return (f'<mujoco><option timestep="{step_s}" gravity="0 0 {-gravity}" integrator="Euler">'
            '<flag contact="disable" constraint="disable"/></option>'
            '<worldbody><body><inertial pos="0 0 0" mass="1e-6" diaginertia="1e-9 1e-9 1e-9"/>'
            f'{slides}<joint type="ball" armature="{ARMATURE_KG}"/>'
            f'{bodies}<site name="tip" pos="0 0 {rod.link_m}"/>{"</body>" * rod.links}</body></worldbody></mujoco>')


class BasePath:
    """Pose, velocity and acceleration of the base at every step, in MuJoCo's coordinates."""

    def __init__(self, motion, steps, step_s):
        t, d = np.arange(steps + 1) * step_s, DIFFERENCE_S
        (x0, q0), (x, q), (x1, q1) = (motion.pose(t + shift) for shift in (-d, 0, d))
        self.pose = np.hstack([x, q[:, 3:], q[:, :3]])
        self.velocity = np.hstack([(x1 - x0) / (2 * d), 2 * conjugate_times(q, (q1 - q0) / (2 * d))])
        self.acceleration = np.hstack([(x1 - 2 * x + x0) / d ** 2, 2 * conjugate_times(q, (q1 - 2 * q + q0) / d ** 2)])


def conjugate_times(a, b):
    """Vector part of conj(a) b, row by row."""
    return a[:, 3:] * b[:, :3] - b[:, 3:] * a[:, :3] - np.cross(a[:, :3], b[:, :3])


def step_for(rod):
    """Well inside what MuJoCo's Euler is stable for, 2 rad a step of the fastest mode; dampers are implicit in it."""
    fastest_rad_per_s = 4 * np.sqrt(rod.spring / rod.node_kg) / rod.link_m
    return 1 / (cases.TRACK_HZ * np.ceil(max(1 / LONGEST_STEP_S, fastest_rad_per_s / 1.5) / cases.TRACK_HZ))


def simulate(rod, motion, refine=1):
    """Node positions [m] (ticks at 1 kHz, nodes, 3). All nodes rest at time 0, whatever the base is doing by then."""
    step_s = step_for(rod) / refine
    inertia_kg_m2 = 2 * rod.spring * (step_s * refine) ** 2 / refine      # twist: at most 1.4 rad a step, then 1
    coarse, fine = (march(rod, motion, step_s / part, inertia_kg_m2 / part) for part in (1, 2))
    return 2 * fine - coarse


def march(rod, motion, step_s, inertia_kg_m2):
    model = mujoco.MjModel.from_xml_string(rod_xml(rod, motion.gravity, step_s, inertia_kg_m2))
    data = mujoco.MjData(model)
    steps_a_tick, ticks = round(1 / (cases.TRACK_HZ * step_s)), round(motion.duration_s * cases.TRACK_HZ)
    base = BasePath(motion, ticks * steps_a_tick, step_s)
    data.qpos[:7], data.qvel[:6] = base.pose[0], base.velocity[0]
    set_nodes_at_rest(data, base.velocity[0], rod)
    nodes = np.empty((ticks + 1, rod.links + 1, 3))
    for tick in range(ticks + 1):
        mujoco.mj_kinematics(model, data)
        nodes[tick] = np.vstack([data.xpos[2:], data.site_xpos[0]])
        for step in range(tick * steps_a_tick, (tick + 1) * steps_a_tick if tick < ticks else 0):
            data.qfrc_applied[:6] = ARMATURE_KG * base.acceleration[step]
            mujoco.mj_step(model, data)
            data.qpos[:7], data.qvel[:6] = base.pose[step + 1], base.velocity[step + 1]
    if any(warning.number for warning in data.warning):
        raise ArithmeticError(f"{rod.name} in {motion.name}: MuJoCo diverged at steps of {step_s:g} s")
    return nodes


def set_nodes_at_rest(data, velocity, rod):
    """Joint 1 takes up the motion of the base across the rod, joint 2 undoes it for the rest."""
    if np.any(np.abs(velocity[1:]) > 1e-3):
        raise ValueError("a base that starts otherwise than along x")
    data.qvel[7], data.qvel[10] = -velocity[0] / rod.link_m, velocity[0] / rod.link_m


def check():
    """How far the references themselves are to be trusted: half the steps, half the inertia."""
    print("tip RMS and maximum in % of the length")
    for name, rod in (("design", cases.Rod("soft", 10)), ("circle", cases.Rod("medium", 10)),
                      ("jerk", cases.Rod("stiff", 20)), ("shake", cases.Rod("medium", 4)),
                      ("shake", cases.Rod("soft", 20))):
        nodes, finer = (simulate(rod, cases.MOTIONS[name], refine) for refine in (1, 2))
        distance = np.linalg.norm(nodes[:, -1] - finer[:, -1], axis=1) / cases.LENGTH_M * 100
        print(f"{name} {rod.name} {np.sqrt(np.mean(distance ** 2)):.5f} {distance.max():.5f}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="print how far references are converged; writes nothing")
    parser.add_argument("--rods", default="", help="only those whose name (stiffness-links) contains this")
    parser.add_argument("motions", nargs="*", metavar="MOTION", help=f"all of {', '.join(cases.MOTIONS)} by default")
    options = parser.parse_args()
    if options.check:
        return check()
    for motion in (cases.MOTIONS[name] for name in options.motions or cases.MOTIONS):
        if not motion.available:
            print(f"{motion.name}: {motion.recorded} is not here", file=sys.stderr)
            continue
        for rod in cases.RODS:
            if options.rods in rod.name:
                stored.write(motion.name, rod, simulate(rod, motion))
                print(motion.name, rod.name, flush=True)
    print(f"mujoco {mujoco.__version__}, {sum(path.stat().st_size for path in stored.FOLDER.iterdir())} bytes")


if __name__ == "__main__":
    main()
