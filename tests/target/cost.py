#!/usr/bin/env python3
"""What the firmware's parts cost on the Cortex-M4F, in instructions, exact, held against what they were and what they
may be; and an estimate of the cycles (cycles.py).

The stored counts belong to one compiler and are met within 3 % either way (a sudden gain is as suspicious as a loss);
another compiler's are only held to the upper bounds. With --update they are written anew, and the table in
firmware/boards/stm32f405/COST.md with them.
"""
import argparse
import collections
import pathlib
import re
import subprocess
import sys
import tempfile

import cost_table
import cycles
import emulator

STORED = pathlib.Path(__file__).resolve().parent.parent / "data" / "instruction_counts.txt"
HEADER = """# Instructions on the Cortex-M4F, counted under QEMU, the dearest of a hundred ticks; and estimated cycles,
# with flash from the cache and without. Written by tests/target/cost.py --update.
# part  N  instructions  cycles  cycles without cache
# compiler: {}
"""
MOST = {("step", 4): 1500, ("step", 50): 7000, ("tick", 50): 40000, ("tick_preset", 50): 90000,
        ("elastic_step", 50): 60000, ("elastic_hostile", 50): 60000,
        ("step_rattling", 50): 240000, ("elastic_rattling", 50): 280000}  # what the project promises
WORST_STEP = {"contour": "step_hold_2", "elastic": "elastic_hostile", "elastic_4ms": "elastic_hostile_4ms",
              "contour_among": "step_rattling", "elastic_among": "elastic_rattling"}
TOLERANCE = 0.03
Count = collections.namedtuple("Count", "instructions cycles cold", defaults=(0, 0))


def compiler():
    text = subprocess.run(["arm-none-eabi-gcc", "--version"], capture_output=True, text=True, check=True).stdout
    return re.sub(r"\s+", " ", text.splitlines()[0])


def parse(text):
    counts = {}
    for line in text.splitlines():
        fields = line.split()
        if len(fields) >= 3 and not line.startswith("#"):
            counts[fields[0], int(fields[1])] = Count(*map(int, fields[2:]))
    return counts


def parse_budgets(text):
    """(model, N) -> cycles: what the device takes a tick for (tick_budget.h)."""
    lines = re.findall(r"^# budget (\w+) (\d+) (\d+)", text, re.MULTILINE)
    return {(model, int(n)): int(most) for model, n, most in lines}


def measure(qemu, program, plugin):
    """(part, N) -> Count, as the program tells them, with what the plugin has seen, cycles too; and the budgets."""
    if not plugin:
        return parse(emulator.run(qemu, program, count_instructions=True)), {}
    image = cycles.Image(program)
    with tempfile.NamedTemporaryFile() as file:
        marks = ",".join(f"{word}={image.symbols['cost_' + word]:#x}" for word in ("begin", "end", "tell"))
        text = emulator.run(qemu, program, count_instructions=True, plugin=f"{plugin},out={file.name},{marks}")
        regions = cycles.read_regions(file.name)
    told, counts = parse(text), {}
    for (key, count), tallies in zip(told.items(), regions):
        mix = image.cost(tallies)
        if count.instructions and mix.instructions:  # the dearest has the mix of them all
            counts[key] = Count(count.instructions, *(round(count.instructions * each / mix.instructions)
                                                      for each in (mix.cycles, mix.cold)))
    return counts, parse_budgets(text)


def judge(counts, stored, same_compiler):
    """Prints every count; returns how many are not as they should be."""
    failures = 0
    for key in sorted({*counts, *stored}, key=lambda k: (k[1], k[0])):
        now, was = counts.get(key, Count(-1)).instructions, stored.get(key, Count(-1)).instructions
        good = now > 0 and was > 0 and now <= MOST.get(key, now)
        if same_compiler:
            good = good and abs(now - was) <= TOLERANCE * was
        failures += not good
        print(f"{key[0]:18} N = {key[1]:2}  {now:6} instructions, was {was:6}"
              f"{'' if key not in MOST else f', at most {MOST[key]}'}{'' if good else '   <-- FAILED'}")
    return failures


def judge_budgets(counts, budgets):
    """The device's own idea of its dearest tick lies between the two estimates of it. Returns how often not."""
    failures = 0
    for (model, n), budget in budgets.items():
        full, step, worst = (counts[part, n] for part in ("tick_full", "step", WORST_STEP[model]))
        least, most = (getattr(full, kind) - getattr(step, kind) + getattr(worst, kind) for kind in ("cycles", "cold"))
        good = least <= budget <= most
        failures += not good
        print(f"{model:18} N = {n:2}  {budget:6} cycles are its budget, {least} ... {most} estimated"
              f"{'' if good else '   <-- FAILED'}")
    return failures


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--qemu", required=True)
    parser.add_argument("--program", required=True, nargs="+")
    parser.add_argument("--plugin", help="mix_plugin.c, compiled; needed to tell cycles")
    parser.add_argument("--update", action="store_true", help="write what is measured to tests/data, and the table")
    choices = parser.parse_args()
    counts, budgets = {}, {}
    for program in choices.program:
        told = measure(choices.qemu, program, choices.plugin)
        counts |= told[0]
        budgets |= told[1]
    if choices.update:
        rows = "".join(f"{part} {n} {c.instructions} {c.cycles} {c.cold}\n" for (part, n), c in counts.items())
        STORED.write_text(HEADER.format(compiler()) + rows, encoding="utf-8")
        cost_table.write(counts, budgets, compiler())
    text = STORED.read_text(encoding="utf-8")
    stored = parse(text)
    same_compiler = compiler() in text
    failures = judge(counts, stored, same_compiler)
    failures += sum(key not in counts for key in MOST)
    failures += judge_budgets(counts, budgets)
    print(f"{'the same compiler' if same_compiler else 'another compiler: only the upper bounds count'}; "
          f"{len(stored)} counts, {failures} failed")
    return 1 if failures or not stored else 0


if __name__ == "__main__":
    sys.exit(main())
