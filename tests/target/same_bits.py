#!/usr/bin/env python3
"""Another machine comes to the same bits as the simulator: replays with their exact float32 poses.

The machine is the emulated board (--qemu, --runner) or any command that takes a capsule (--command).

Generated tracks always; the recorded ones where the checkout has them beside it (said aloud if not).
"""
import argparse
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

import emulator

GENERATED = [
    ("circular.txt", []),
    ("shaking.txt", ["--preset", "whip"]),
    ("star-stops.txt", ["--preset", "ribbon"]),  # smoothing > 0
    ("shaking-gaps.txt", ["--preset", "fishing-rod", "--set", "hold=2"]),
    ("rectangular-euroc.csv", ["--preset", "foil", "--rate", "500"]),
    ("linear.txt", ["--set", "links=50", "--set", "smoothing=50", "--set", "spring=2000"]),
    ("shaking-flips.txt", ["--set", "scheme=paper", "--rate", "2000"]),
]
SOFT = [word for value in ("model=elastic", "length=0.06", "mass=0.02", "spring=2", "damper=0.01")
        for word in ("--set", value)]
GENERATED += [
    ("circular.txt", [*SOFT, "--set", "links=10"]),
    ("shaking-gaps.txt", [*SOFT, "--set", "links=20", "--rate", "100"]),  # ten steps a tick
    ("shaking.txt", [*SOFT, "--set", "links=20", "--set", "spring=0", "--scale", "20"]),  # lengths are restored
    ("star-stops.txt", [*SOFT, "--set", "links=3", "--set", "gravity=0", "--set", "drag=0.1"]),
    ("linear.txt", [*SOFT, "--set", "links=50", "--rate", "500"]),
    ("shaking.txt", [*SOFT, "--set", "links=1"]),
]
SCENES = pathlib.Path(__file__).resolve().parents[2] / "host_sim" / "scenes"
FOIL = ["--preset", "foil", "--set", "links=24"]
GENERATED += [("pressing.txt", [*FOIL, *model, "--scene", str(SCENES / scene)])
              for model in (["--model", "elastic"], ["--set", "length=0.03667"])
              for scene in ("ball.ini", "corner.ini", "pole.ini", "table.ini")]
GENERATED += [
    ("star.txt", [*SOFT, "--set", "links=10", "--shape", "coil:1", "--shape-strength", "3"]),
    ("shaking.txt", ["--preset", "whip", "--shape", "arc:120", "--shape-strength", "50"]),
]
RECORDED = [["--set", "links=4"], ["--set", "links=50", "--set", "spring=2000"]]


def hash_in(text):
    return re.search(r"^hash\s+([0-9a-f]{16})", text, re.MULTILINE).group(1)


def compare(choices, track, arguments, folder):
    capsule = pathlib.Path(folder) / "capsule"
    host = subprocess.run([choices.sim, "replay", str(track), *arguments, "--capsule", str(capsule)],
                          check=True, capture_output=True, text=True).stdout
    if choices.command:
        other = subprocess.run([*shlex.split(choices.command), str(capsule)], check=True,
                               capture_output=True, text=True).stdout
    else:
        other = emulator.run(choices.qemu, choices.runner, [str(capsule)])
    same = hash_in(host) == hash_in(other)
    print(f"{hash_in(host)} {hash_in(other)}  {track.name} {' '.join(arguments)}"
          f"{'' if same else '   <-- FAILED'}", flush=True)
    return same


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("sim", "shared-tracks"):
        parser.add_argument(f"--{name}", required=True)
    for name in ("qemu", "runner", "command"):
        parser.add_argument(f"--{name}")
    choices = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        tracks = pathlib.Path(folder) / "tracks"
        subprocess.run([choices.sim, "tracks", str(tracks)], check=True, stdout=subprocess.DEVNULL)
        results = [compare(choices, tracks / name, arguments, folder) for name, arguments in GENERATED]
        recorded = sorted(pathlib.Path(choices.shared_tracks).glob("*_*.txt"))
        for track in recorded:
            results += [compare(choices, track, arguments, folder) for arguments in RECORDED]
        if not recorded:
            print("SKIPPED: the recorded tracks are not beside this checkout")
    print(f"{len(results)} replays, {results.count(False)} differ")
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
