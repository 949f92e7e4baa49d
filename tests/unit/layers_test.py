#!/usr/bin/env python3
"""The house stands as drawn: who may include whom, and what the board's code may ask of a C library.

    layers_test.py ROOT [--nm NM --libraries LIBRARY...]
"""
import argparse
import pathlib
import re
import subprocess
import sys

MAY_INCLUDE = {  # a layer: the layers whose headers it may use, beside its own
    "firmware/core": [],
    "firmware/hal": [],
    "proto": [],
    "firmware/servos": ["firmware/core", "firmware/hal"],
    "firmware/app": ["firmware/core", "firmware/hal", "firmware/servos", "proto"],
    "firmware/boards/stm32f405": ["firmware/app", "firmware/core", "firmware/hal", "firmware/servos", "proto"],
    "host_sim": ["firmware/app", "firmware/core", "firmware/hal", "firmware/servos", "proto"],
    "tools/limber": ["host_sim", "firmware/core", "proto"],
}
NO_LIBRARY = re.compile(r"#include <(math|stdlib|stdio|time|malloc)\.h>")
BOARD_LAYERS = ["firmware/core", "firmware/servos", "firmware/app", "proto"]
MAY_CALL = {"memcpy", "memset", "memmove", "memcmp", "memchr", "strcmp", "strlen", "strncmp"}
FORBIDDEN = re.compile(r"__aeabi_[dfi]2?|malloc|free|printf|^(sin|cos|tan|atan2?|asin|acos|sqrt|exp|log|pow|fabs|fmod)f?$")


def check_includes(root):
    homes = {}
    for layer in MAY_INCLUDE:
        for header in (root / layer).glob("*.h"):
            homes[header.name] = layer
    faults = []
    for layer, allowed in MAY_INCLUDE.items():
        for source in sorted([*(root / layer).glob("*.[ch]")]):
            text = source.read_text(encoding="utf-8")
            for name in re.findall(r'#include "([^"]+)"', text):
                home = homes.get(name)
                if home not in (layer, *allowed):
                    faults.append(f"{source.relative_to(root)} includes {name} of {home}: {layer} may use {allowed}")
            if layer in BOARD_LAYERS and NO_LIBRARY.search(text):
                faults.append(f"{source.relative_to(root)} includes {NO_LIBRARY.search(text).group(0)}")
    return faults, len(homes)


def check_symbols(nm, libraries):
    defined, wanted = set(), set()
    for library in libraries:
        for line in subprocess.run([nm, library], capture_output=True, text=True, check=True).stdout.splitlines():
            fields = line.split()
            if len(fields) >= 2 and fields[-2] == "U":
                wanted.add(fields[-1])
            elif len(fields) == 3:
                defined.add(fields[-1])
    unknown = sorted(wanted - defined - MAY_CALL)
    return [f"{name} is called: {'forbidden on the board' if FORBIDDEN.search(name) else 'not in the list'}"
            for name in unknown], len(wanted)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("root", type=pathlib.Path)
    parser.add_argument("--nm")
    parser.add_argument("--libraries", nargs="+", default=[])
    choices = parser.parse_args()
    faults, seen_n = check_symbols(choices.nm, choices.libraries) if choices.nm else check_includes(choices.root)
    for fault in faults:
        print("FAIL", fault)
    print(f"{seen_n} {'symbols' if choices.nm else 'headers'}, {len(faults)} faults")
    return 1 if faults or seen_n == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
