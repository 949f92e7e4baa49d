"""From what mix_plugin.c has counted to an estimate of cycles on a Cortex-M4F.

Timing: ARM Cortex-M4 Technical Reference Manual (100166), 3.3.1 and 7.2.3. Where it gives a range, or says that
loads may overlap, the dearer is taken: a refill of the pipeline after a jump 2 cycles (1 to 3), a division of integers
12 (2 to 12), each load 2. One more where the next instruction uses the result of floating-point arithmetic.
Flash: from the STM32F405's cache (ART accelerator, RM0090 3.5) without waiting; `cold` is the same code as if
neither a jump nor a constant were ever found there, 5 wait states each (168 MHz, RM0090 table 10).
"""
import collections
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools" / "firmware"))
import elf  # noqa: E402  (where it is found must be said first)

REFILL, WAIT_STATES = 2, 5
ARITHMETIC = re.compile(r"v(n?mul|add|sub|div|sqrt|f?n?m[la][as]|cvt|abs|neg)")
KINDS = [  # mnemonic, cycles (None: 1 + registers of the list), what it is called in the table
    (r"vdiv|vsqrt", 14, "division, square root"),
    (r"vf?n?ml[as]|vfn?m[as]", 3, "float"),
    (r"v(push|pop|ldm|stm)", None, "load, store"),
    (r"vldr|vstr", 2, "load, store"),
    (r"v", 1, "float"),
    (r"ldrd|strd", 3, "load, store"),
    (r"ldm|stm|push|pop", None, "load, store"),
    (r"ldr", 2, "load, store"),
    (r"str", 1, "load, store"),
    (r"[us]div", 12, "division, square root"),
    (r"b$|b[lx]|b(eq|ne|cs|cc|mi|pl|vs|vc|hi|ls|ge|lt|gt|le)|cbn?z", 1, "branch"),
    (r"tb[bh]", 2, "branch"),
    (r"", 1, "integer"),
]
Cost = collections.namedtuple("Cost", "instructions cycles cold kinds")


def registers_n(operands):
    return sum(int(last[1:]) - int(first[1:]) + 1 if last else 1
               for part in re.search(r"\{([^}]*)\}", operands)[1].split(",")
               for first, _, last in [part.strip().partition("-")])


def kind_of(instruction):
    """(cycles, kind) of one that does not jump."""
    mnemonic = instruction.mnemonic.split(".")[0]
    for pattern, cycles, kind in KINDS:
        if re.match(pattern, mnemonic):
            return (1 + registers_n(instruction.operands) if cycles is None else cycles), kind
    raise ValueError(instruction)


def uses_result(before, instruction):
    result = before.operands.split(",")[0]
    return ARITHMETIC.match(before.mnemonic) and re.search(rf",\s*{result}\b", instruction.operands)


class Image:
    def __init__(self, path):
        self.instructions = sorted(i for some in elf.functions(path).values() for i in some)
        self.symbols = elf.symbols(path)
        self.left_out = {i.address for i in elf.functions(path).get("cost_begin", [])}

    def cost(self, tallies):
        """tallies: address -> (runs, jumps)."""
        instructions = cycles = cold = 0
        kinds, before = collections.Counter(), None
        for i in self.instructions:
            runs, jumps = tallies.get(i.address, (0, 0))
            if runs and i.address not in self.left_out:
                each, kind = kind_of(i)
                instructions += runs
                kinds[kind] += runs
                cycles += runs * (each + bool(before and uses_result(before, i))) + jumps * REFILL
                cold += (jumps + runs * ("[pc, #" in i.operands)) * WAIT_STATES
            before = i
        return Cost(instructions, cycles, cycles + cold, kinds)


def read_regions(path):
    """A list of address -> (runs, jumps), one for each cost_tell, and one for the rest."""
    regions = []
    for line in pathlib.Path(path).read_text(encoding="ascii").splitlines():
        if line == "region":
            regions.append({})
        else:
            address, runs, jumps = line.split()
            regions[-1][int(address, 16)] = int(runs), int(jumps)
    return regions
