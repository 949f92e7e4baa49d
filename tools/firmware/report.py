#!/usr/bin/env python3
"""What a firmware image takes of the board, against what it may take. Exit 1 over a budget, or where something is in
the image that must not be (check_elf.py).

    report.py IMAGE.elf --build FOLDER_OF_ITS_OBJECTS...
"""
import argparse
import pathlib
import sys

import check_elf
import elf
import stack

ROOT = pathlib.Path(__file__).resolve().parents[2]
FLASH_MAX_BYTES = 128 * 1024
SRAM_MAX_BYTES = 64 * 1024  # the stack beside it
# Handlers that change to a stack of their own, and its ends: symbols of the linker script
OWN_STACK = {"fault_handler": ("fault_stack_bottom", "fault_stack_top")}


def kilobytes(bytes_n, most):
    return f"{bytes_n:8,} of {most:8,} bytes, {100 * bytes_n / most:3.0f} %"


def memory(path):
    """(name, bytes, budget, what it consists of) of flash, SRAM and CCM."""
    parts = {"SRAM": [], "CCM": []}
    for section in elf.sections(path):
        area = "SRAM" if section.address in elf.SRAM else "CCM" if section.address in elf.CCM else None
        if area and section.bytes_n and (area, section.name) != ("SRAM", ".stack"):
            parts[area].append(section)
    yield "flash", sum(bytes_n for _, bytes_n in elf.segments(path)), FLASH_MAX_BYTES, ""
    for area, most in (("SRAM", SRAM_MAX_BYTES), ("CCM", len(elf.CCM))):
        yield (area, sum(s.bytes_n for s in parts[area]), most,
               ", ".join(f"{s.name} {s.bytes_n:,}" for s in parts[area]))


def check_stack(graph, image):
    """Prints it; returns what is wrong, as sentences."""
    symbols = elf.symbols(image)
    most, guard = (symbols["stack_top"] - symbols["stack_bottom"], symbols["stack_bottom"] - symbols["guard_start"])
    handlers = {name for name in elf.vectors(image)[1] if name}
    (main_bytes, main_path), interrupts = stack.worst(graph, handlers, OWN_STACK)
    worst = main_bytes + sum(bytes_n for bytes_n, _ in interrupts)
    largest = graph.largest(["main", *handlers], 5)
    print(f"  stack  {kilobytes(worst, most)}  at worst, if all interrupts nest")
    for name, bytes_n, path in [("main loop", main_bytes, main_path), *(("interrupt", *i) for i in interrupts)]:
        print(f"           {name} {bytes_n:,}: " + " > ".join(stack.base_name(title) for title in path))
    print("           largest frames: " + ", ".join(f"{name} {bytes_n:,}" for bytes_n, name in largest))
    faults = []
    if worst > most:
        faults.append(f"stack: {worst:,} bytes at worst, and there are {most:,}")
    if largest[0][0] > guard:
        bytes_n, name = largest[0]
        faults.append(f"stack: the frame of {name}, {bytes_n:,} bytes, can step over the guard's {guard:,}")
    for name, (bottom, top) in OWN_STACK.items():
        bytes_n, most = graph.entry(name)[0], symbols[top] - symbols[bottom]
        print(f"           {name}, on a stack of its own: {bytes_n:,} of {most:,}")
        if bytes_n > most:
            faults.append(f"stack of {name}: {bytes_n:,} bytes at worst, and there are {most:,}")
    return faults


def report(path, builds):
    """Prints it; returns what is wrong, as sentences."""
    faults = check_elf.check(path)
    print(pathlib.Path(path).name)
    for name, bytes_n, most, detail in memory(path):
        print(f"  {name:6} {kilobytes(bytes_n, most)}  {detail}".rstrip())
        if bytes_n > most:
            faults.append(f"{name}: {bytes_n:,} bytes, and {most:,} are all it may take")
    try:
        return faults + check_stack(stack.Graph(path, builds, ROOT), path)
    except stack.Unknown as why:
        return [*faults, f"stack: {why}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("image")
    parser.add_argument("--build", required=True, nargs="+", help="where its objects and their .ci files are")
    choices = parser.parse_args()
    faults = report(choices.image, choices.build)
    for fault in faults:
        print(f"FAIL {fault}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
