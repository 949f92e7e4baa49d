#!/usr/bin/env python3
"""Replays of the generated tracks give the bits they always gave: the hashes in tests/data/golden_hashes.txt.

    golden_test.py LIMBER_SIM             compares; exit 1 where any differs
    golden_test.py LIMBER_SIM --update    writes the file's hashes anew, after a change that was meant

A new case is a line with any word in place of the hash, and then --update.
"""
import argparse
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]  # where the cases' own files are told from
GOLDEN = ROOT / "tests" / "data" / "golden_hashes.txt"


def replay(sim, track, arguments):
    """The hash that a replay prints, or a word of complaint."""
    done = subprocess.run([Path(sim).resolve(), "replay", track, *arguments], cwd=ROOT, capture_output=True, text=True,
                          check=False)
    found = re.search(r"^hash +([0-9a-f]{16})$", done.stdout, re.MULTILINE)
    return found.group(1) if done.returncode == 0 and found else f"exit {done.returncode}: {done.stderr.strip()}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sim", metavar="LIMBER_SIM")
    parser.add_argument("--update", action="store_true")
    given = parser.parse_args()
    lines = GOLDEN.read_text(encoding="ascii").splitlines()
    changed = []
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([given.sim, "tracks", folder], check=True, stdout=subprocess.DEVNULL)
        for i, line in enumerate(lines):
            if not line.strip() or line.startswith("#"):
                continue
            golden, track, *arguments = line.split()
            now = replay(given.sim, Path(folder) / track, arguments)
            if now != golden:
                changed.append(f"{golden} now {now}  {track} {' '.join(arguments)}")
                if len(now) == 16:
                    lines[i] = f"{now}  {track:<24} {' '.join(arguments)}".rstrip()
    cases = sum(bool(line.strip()) and not line.startswith("#") for line in lines)
    print("\n".join([*changed, f"{cases} replays, {len(changed)} with other bits"]))
    if given.update:
        GOLDEN.write_text("\n".join(lines) + "\n", encoding="ascii")
    elif changed:
        print("if the change was meant: tests/sim/golden_test.py build/host/limber-sim --update")
    return 1 if cases < 100 or any("exit" in line for line in changed) or (changed and not given.update) else 0


if __name__ == "__main__":
    sys.exit(main())
