#!/usr/bin/env python3
"""Instructions of a step on the Cortex-M4F, exact, held against what they were and what they may be.

The stored counts belong to Debian's arm-none-eabi-gcc 12.2 and are met within 3 % either way (a sudden
gain is as suspicious as a loss); another compiler's are only held to the upper bounds.
"""
import argparse
import pathlib
import re
import subprocess
import sys

import emulator

STORED = pathlib.Path(__file__).resolve().parent.parent / "data" / "instruction_counts.txt"
HEADER = """# Instructions on the Cortex-M4F, counted under QEMU; the dearest of a hundred ticks.
# part  N  instructions  (step: smoothing > 0, hold 1; written by tests/target/cost.py --update)
# compiler: {}
"""
MOST = {("step", 4): 1500, ("step", 50): 7000}  # what the project promises
TOLERANCE = 0.03


def compiler():
    text = subprocess.run(["arm-none-eabi-gcc", "--version"], capture_output=True, text=True, check=True).stdout
    return re.sub(r"\s+", " ", text.splitlines()[0])


def parse(text):
    counts = {}
    for line in text.splitlines():
        fields = line.split()
        if len(fields) == 3 and not line.startswith("#"):
            counts[fields[0], int(fields[1])] = int(fields[2])
    return counts


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--qemu", required=True)
    parser.add_argument("--program", required=True)
    parser.add_argument("--update", action="store_true", help="write what is measured to tests/data")
    choices = parser.parse_args()
    counts = parse(emulator.run(choices.qemu, choices.program, count_instructions=True))
    if choices.update:
        rows = "".join(f"{part} {n} {count}\n" for (part, n), count in counts.items())
        STORED.write_text(HEADER.format(compiler()) + rows)
    text = STORED.read_text()
    stored = parse(text)
    same_compiler = compiler() in text
    failures = 0
    for key, was in stored.items():
        now = counts.get(key, -1)
        good = now > 0 and now <= MOST.get(key, now)
        if same_compiler:
            good = good and abs(now - was) <= TOLERANCE * was
        failures += not good
        print(f"{key[0]:18} N = {key[1]:2}  {now:6} instructions, was {was:6}"
              f"{'' if key not in MOST else f', at most {MOST[key]}'}{'' if good else '   <-- FAILED'}")
    print(f"{'the same compiler' if same_compiler else 'another compiler: only the upper bounds count'}; "
          f"{len(stored)} counts, {failures} failed")
    return 1 if failures or not stored else 0


if __name__ == "__main__":
    sys.exit(main())
