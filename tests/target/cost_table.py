"""firmware/boards/stm32f405/COST.md, made of the counts."""
import pathlib

PAGE = pathlib.Path(__file__).resolve().parents[2] / "firmware" / "boards" / "stm32f405" / "COST.md"
CORE_HZ = 168e6
LINKS_N = (4, 10, 20, 50)
HEAD = """# What it costs on the Cortex-M4F

Made by `tools/dev cost`; do not edit. For a rod of N links with 2 N servos on a bus of 4 Mbaud.

Instructions are counted, exactly, under QEMU: of a hundred ticks the dearest. Cycles are estimated from which
instructions they are (rules and sources: `tests/target/cycles.py`): the first number with all of flash in the
chip's cache, the second as if no jump and no constant ever were. No board has measured them yet.

Compiler: {compiler}.
"""
PARTS = [  # name in the counts, what it is
    ("decode", "a POSE from bytes to message"),
    ("pose_input", "the pose judged, and the base of this tick"),
    ("step", "the rod: one step, smoothing on"),
    ("blend_limits", "blend, and the limits of all servos"),
    ("servo_encode", "goals of all servos as one Sync Write"),
    ("angles_reply", "ANGLES packed, framed and queued"),
    ("tick", "**the whole tick**, all of these in it"),
    ("tick_full", "the same, with HEARTBEAT and STATS"),
    ("tick_preset", "the whole tick, and the rod becomes another one in it"),
]
ELASTIC = [
    ("elastic_step", "one step"),
    ("elastic_hostile", "one step in a motion no hand can make: three of Newton's steps, not one"),
    ("elastic_hostile_4ms", "the same in a tick of 4 ms, which is several steps"),
    ("elastic_with_force", "one step with a force on it"),
    ("elastic_to_shape", "one step towards a shape"),
    ("elastic_among", "one step near eight objects, hardly touching"),
    ("elastic_rattling", "**one step between eight objects at its worst**: every node comes to touch two"),
    ("elastic_nodes", "its nodes"),
    ("elastic_set_params", "other parameters"),
    ("elastic_tick", "**the whole tick**"),
    ("elastic_tick_full", "the same, with HEARTBEAT and STATS"),
    ("elastic_tick_preset", "the whole tick, and the rod becomes another one in it"),
]
BUDGETS = [("contour", "contour"), ("elastic", "elastic, a tick of 1 ms"), ("elastic_4ms", "elastic, a tick of 4 ms"),
           ("contour_among", "contour with eight objects"),
           ("elastic_among", "elastic with eight objects, a tick of 1 ms")]
INTERRUPTS = {
    "interrupt_byte_in": "a byte has come in, on the line or the bus",
    "interrupt_byte_out": "a byte may go out",
    "interrupt_tick": "the tick",
}
MORE = [
    ("step_no_smoothing", "the rod without smoothing"),
    ("step_hold_2", "the rod in two steps a tick"),
    ("step_with_force", "the rod with a force on it"),
    ("step_to_shape", "the rod drawn to a shape that changes"),
    ("step_among_objects", "the rod near eight objects, hardly touching"),
    ("step_rattling", "**the rod between eight objects at its worst**: every node comes to touch two"),
    ("set_params", "other parameters"),
]


def table(counts, parts):
    yield "| | " + " | ".join(f"N = {n}" for n in LINKS_N) + " |"
    yield "|---|" + "---|" * len(LINKS_N)
    for part, meaning in parts:
        row = [counts.get((part, n)) for n in LINKS_N]
        if any(row):
            yield f"| {meaning} | " + " | ".join(f"{c.instructions:,} · {c.cycles:,} … {c.cold:,}" if c else ""
                                                 for c in row) + " |"


def time(counts):
    """One sentence a length of rod."""
    for n in LINKS_N:
        if tick := counts.get(("tick", n)):
            low, high = tick.cycles / CORE_HZ, tick.cold / CORE_HZ
            yield (f"- N = {n}: {low * 1e6:.0f} … {high * 1e6:.0f} µs of the 1,000 of a tick at "
                   f"{CORE_HZ / 1e6:.0f} MHz, {low * 1e5:.0f} … {high * 1e5:.0f} %")


def interrupts(counts):
    names = [name for name in INTERRUPTS if (name, 0) in counts]
    if names:
        yield from ("", "## Interrupts, beside that", "", "Each time it strikes; entry and return, 12 cycles each where "
                    "nothing waits (TRM 3.9), not included.", "", "| | instructions · cycles |", "|---|---|")
        for name in names:
            c = counts[name, 0]
            yield f"| {INTERRUPTS[name]} | {c.instructions:,} · {c.cycles:,} … {c.cold:,} |"


def budget_table(budgets):
    yield from ("", "## What the device takes a tick for", "",
                "Cycles, HEARTBEAT and STATS and the rod's worst step in it (`firmware/app/tick_budget.c`). A rod that",
                "needs more than interrupts leave of a tick, 90 % (a servo bus: 70 %), is refused. The test holds",
                "these numbers between the two estimates.", "",
                "| | " + " | ".join(f"N = {n}" for n in LINKS_N) + " |", "|---|" + "---|" * len(LINKS_N))
    for model, meaning in BUDGETS:
        if (model, LINKS_N[0]) in budgets:
            yield f"| {meaning} | " + " | ".join(f"{budgets[model, n]:,}" for n in LINKS_N) + " |"


def write(counts, budgets, compiler):
    lines = [HEAD.format(compiler=compiler), "## One tick: instructions · cycles", "", *table(counts, PARTS), "",
             *time(counts), *interrupts(counts), "", "## The rod alone", "", *table(counts, MORE),
             "", "## The elastic rod", "", *table(counts, ELASTIC), *budget_table(budgets)]
    PAGE.write_text("\n".join(lines) + "\n", encoding="utf-8")
