#!/usr/bin/env python3
"""What must not be in a firmware image: software double and 64-bit division, libm, a heap, stdio, anything where the
settings live. And what must: the vector table at the start of flash.

    check_elf.py IMAGE.elf
"""
import argparse
import re
import sys

import elf

FORBIDDEN = [  # a symbol's whole name, why
    (r"__aeabi_(d\w+|cd\w+|\w+2d|d2\w+)|__\w+df[23]|__(un|ge|le|gt|lt|eq|ne|cmp)df2|__fix(uns)?df\w+|__float(un)?\w+df"
     r"|__extendsfdf2|__truncdfsf2", "double precision, in software"),
    (r"__aeabi_(u?ldivmod|l2f|ul2f|f2u?lz)|__u?divmoddi4|__u?(div|mod)di3|__float(un)?disf|__fix(uns)?sfdi",
     "64-bit division or conversion, in software"),
    (r"(__ieee754_|__kernel_)\w+|(a?(sin|cos|tan)h?|atan2|sqrt|cbrt|exp|exp2|expm1|log|log2|log10|log1p|pow|fmod|hypot"
     r"|floor|ceil|round|trunc|rint|lrint|lround|fabs|fma|ldexp|frexp|scalbn|copysign|nextafter)f?", "libm"),
    (r"_?(malloc|calloc|realloc|free|memalign)(_r)?|_?sbrk(_r)?|__malloc_\w+", "a heap"),
    (r"_?v?(as|d|f|s|sn)?i?(printf|scanf)(_r)?|_?(puts|putchar|fputs|fputc|putc|fopen|fwrite|fread|fflush)(_r)?"
     r"|__sfvwrite_r|__sinit|__sfp", "stdio"),
]
DOUBLE = re.compile(r"\.f64\b")  # the FPU has none: ARMv7E-M with FPv4-SP


def check_symbols(path):
    names = elf.symbols(path)
    return [f"{name}: {why}" for name in sorted(names) for pattern, why in FORBIDDEN if re.fullmatch(pattern, name)]


def check_instructions(path):
    faults = []
    for name, instructions in elf.functions(path).items():
        double = next((i for i in instructions if DOUBLE.search(i.mnemonic)), None)
        if double:
            faults.append(f"{name}: {double.mnemonic} at {double.address:#x}: double precision, which this FPU has not")
    return faults


def check_places(path):
    faults = []
    for address, bytes_n in elf.segments(path):
        last = address + bytes_n - 1
        if address not in elf.FLASH or last not in elf.FLASH:
            faults.append(f"{bytes_n} bytes at {address:#x} are not in flash")
        elif last in elf.SETTINGS or address in elf.SETTINGS:
            faults.append(f"{bytes_n} bytes at {address:#x} reach into sectors 10 and 11, where the settings are")
    if not any(address == elf.FLASH.start for address, _ in elf.segments(path)):
        return [*faults, f"nothing at {elf.FLASH.start:#x}, where the processor looks for the vectors"]
    stack, handlers = elf.vectors(path)
    if stack % 8 or stack - 8 not in elf.SRAM and stack - 8 not in elf.CCM:
        faults.append(f"the first vector, {stack:#x}, is no stack: a multiple of 8 in SRAM or CCM")
    if len(handlers) < 15 or None in handlers[:6]:
        faults.append("the vectors of reset and faults (1 to 6) are not all functions")
    return faults


def check(path):
    """A list of sentences, empty where all is well."""
    return check_symbols(path) + check_instructions(path) + check_places(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("image")
    faults = check(parser.parse_args().image)
    for fault in faults:
        print("FAIL", fault)
    print(f"{len(faults)} things in the image that must not be")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
