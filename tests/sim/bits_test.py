#!/usr/bin/env python3
"""Every compiler comes to the simulator's bits: the core and tests/target/replay_capsule.c, compiled by gcc and clang
with and without optimisation, repeat the replays of tests/target/same_bits.py. Exit 77 where there is no compiler."""
import argparse
import platform
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
# Part of the mathematics (see CMakeLists.txt); the rest may be chosen freely.
BINDING = ["-std=c11", "-ffp-contract=off", "-fno-math-errno"]
FREE = [["-O0"], ["-O3"]]
if platform.machine() == "x86_64":
    # A machine that can fuse multiplications with additions. Without the last flag gcc 12 does it (vfmsubadd for
    # kinematics_motion) in spite of -ffp-contract=off, and comes to other bits.
    FREE.append(["-O3", "-march=native", "-fno-tree-slp-vectorize"])


def compile_runner(command, program):
    sources = [*sorted((ROOT / "firmware/core").glob("*.c")), ROOT / "tests/target/replay_capsule.c"]
    includes = [f"-I{ROOT / 'firmware/core'}", f"-I{ROOT / 'host_sim'}"]
    subprocess.run([*command, *BINDING, *includes, *map(str, sources), "-o", str(program)], check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sim", metavar="LIMBER_SIM")
    parser.add_argument("--max-links", default="64", help="ROD_MAX_LINKS of LIMBER_SIM (default 64)")
    parser.add_argument("--shared-tracks", default="", help="a folder of recorded tracks, replayed as well")
    given = parser.parse_args()
    compilers = [name for name in ("gcc", "clang") if shutil.which(name)]
    print("compilers:", ", ".join(compilers) or "none")
    if not compilers:
        return 77
    differing = []
    with tempfile.TemporaryDirectory() as folder:
        for compiler in compilers:
            for flags in FREE:
                program = Path(folder) / "runner"
                compile_runner([compiler, *flags, f"-DROD_MAX_LINKS={given.max_links}"], program)
                print(f"--- {compiler} {' '.join(flags)}", flush=True)
                done = subprocess.run([sys.executable, "-B", ROOT / "tests/target/same_bits.py", "--sim", given.sim,
                                       "--shared-tracks", given.shared_tracks or folder, "--command", program],
                                      stdout=subprocess.PIPE, text=True, check=False)
                print(done.stdout if done.returncode else done.stdout.splitlines()[-1], flush=True)
                if done.returncode:
                    differing.append(f"{compiler} {' '.join(flags)}")
    print(f"{len(compilers) * len(FREE)} builds, differing: {', '.join(differing) or 'none'}")
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
