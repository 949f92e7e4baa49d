#!/usr/bin/env python3
"""registers.h against sources that are not ours: where each register lies, each block, each bit, each interrupt.

    offsets_test.py --header registers.h --cc CC --work DIRECTORY

The compiler says what is in the header; crates.io's stm32f4 (generated from ST's SVD) and cortex-m say what
should be. Both crates are fetched by cargo. Exit 77, which ctest calls skipped, where that is not possible.
"""
import argparse
import pathlib
import re
import subprocess
import sys

CARGO_TOML = """[package]
name = "register-sources"
version = "0.0.0"
edition = "2021"
[dependencies]
stm32f4 = "=0.15.1"
cortex-m = "=0.7.7"
"""
CHIP_BLOCKS = {"rcc": "RCC", "pwr": "PWR", "flash": "FLASH", "gpio": "GPIOA", "tim": "TIM3", "usart": "USART1",
               "iwdg": "IWDG"}  # a struct of ours: the block that shows its layout
CORE_BLOCKS = {"systick": "syst", "scb": "scb", "nvic": "nvic", "mpu": "mpu"}
ELSEWHERE = {("tim", "ccmr1"): "ccmr1_output", ("tim", "ccmr2"): "ccmr2_output", ("mpu", "type"): "_type"}
# names made of several fields, or of a field and what it is set to: (field, value or variant)
COMPOSED = {
    "RCC_CFGR_SW_PLL": [("sw", "Pll")], "RCC_CFGR_SWS_PLL": [("sws", "Pll")],
    "RCC_CFGR_PPRE1_4": [("ppre1", "Div4")], "RCC_CFGR_PPRE2_2": [("ppre2", "PPRE1.Div2")],
    "RCC_CFGR_PPRE_MASK": [("ppre1", 7), ("ppre2", 7)],
    "FLASH_CR_PSIZE_WORD": [("psize", "Psize32")],
    "TIM_CCMR_LOW": [("oc1m", 4), ("oc2m", 4)],
    "TIM_CCMR_PWM_PRELOAD": [("oc1m", 6), ("oc2m", 6), ("oc1pe", 1), ("oc2pe", 1)],
    "TIM_CCER_ALL": [("cc1e", 1), ("cc2e", 1), ("cc3e", 1), ("cc4e", 1)],
}
REGISTER_OF = {"TIM_CCMR_LOW": "ccmr1_output", "TIM_CCMR_PWM_PRELOAD": "ccmr1_output", "TIM_CCER_ALL": "ccer"}
CORE_CONSTANTS = {"SYSTICK_CALIB_TENMS_MASK": "SYST_COUNTER_MASK"}
SHCSR = {"SCB_SHCSR_MEMFAULTENA": "MemoryManagement", "SCB_SHCSR_BUSFAULTENA": "BusFault",
         "SCB_SHCSR_USGFAULTENA": "UsageFault"}


def fetch(work):
    """The folders of the two crates; None where they cannot be had."""
    (work / "src").mkdir(parents=True, exist_ok=True)
    (work / "src/lib.rs").touch()
    (work / "Cargo.toml").write_text(CARGO_TOML, encoding="utf-8")
    folders = [work / "vendor/stm32f4-0.15.1/src", work / "vendor/cortex-m-0.7.7/src/peripheral"]
    if not all(folder.is_dir() for folder in folders):
        try:
            subprocess.run(["cargo", "vendor", "--quiet", "--versioned-dirs"], cwd=work, check=True, timeout=120,
                           stdout=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
        except (OSError, subprocess.SubprocessError) as why:
            print(f"SKIPPED: no register of the board was checked: the crates could not be fetched: {why}")
            return None
    return folders


def ours(header, cc, work):
    """structs {name: {member: offset}}, blocks {NAME: (struct, address)}, constants {NAME: value}."""
    text = re.sub(r"/\*.*?\*/", "", header.read_text(encoding="utf-8"), flags=re.S)
    structs = {name: [m for m in re.findall(r"\b([a-z]\w*)(?:\[\d+\])?[,;]", body) if "reserved" not in m]
               for body, name in re.findall(r"typedef struct \{(.*?)\} (\w+)_registers;", text, re.S)}
    blocks = dict(re.findall(r"#define (\w+) \(\((\w+)_registers \*\)", text))
    names = re.findall(r"^\s*(?:enum \{ )?([A-Z][A-Z0-9_]+) = ", text, re.M) + \
        re.findall(r", ([A-Z][A-Z0-9_]+) = ", text) + re.findall(r"#define (\w+) \(?[0-9]", text)
    lines = [f'printf("struct {s} {m} %zu\\n", offsetof({s}_registers, {m}));' for s in structs for m in structs[s]]
    lines += [f'printf("block {b} {s} %zu\\n", (size_t){b});' for b, s in blocks.items()]
    lines += [f'printf("constant {n} - %zu\\n", (size_t)(uint32_t){n});' for n in names]
    source = ("#include <stddef.h>\n#include <stdio.h>\n#include \"registers.h\"\nint main(void)\n{\n" +
              "\n".join(lines) + "}\n")
    (work / "places.c").write_text(source, encoding="utf-8")
    subprocess.run([cc, "-std=c11", "-DREGISTERS_SCRIPTED", f"-I{header.parent}", "-o", work / "places",
                    work / "places.c"], check=True)
    found = {"struct": {}, "block": {}, "constant": {}}
    for line in subprocess.run([work / "places"], check=True, capture_output=True, text=True).stdout.splitlines():
        kind, name, detail, number = line.split()
        if kind == "struct":
            found[kind].setdefault(name, {})[detail] = int(number)
        else:
            found[kind][name] = (detail, int(number)) if kind == "block" else int(number)
    return found["struct"], found["block"], found["constant"]


def number(text):
    value, _, shift = text.replace("_", "").partition("<<")
    return int(value, 0) << int(shift or "0")


class Chip:
    """What the stm32f4 crate says."""

    def __init__(self, folder):
        self.folder = folder / "stm32f405"
        text = (self.folder / "mod.rs").read_text(encoding="utf-8")
        self.blocks = {name: (module, number(address)) for name, module, address in re.findall(
            r"impl (\w+) \{\s*#\[doc[^\n]*\n\s*pub const PTR: \*const (\w+)::RegisterBlock = (0x[0-9a-f_]+)", text)}
        self.interrupts = {name: int(n) for name, n in re.findall(r"^    (\w+) = (\d+),", text, re.M)}

    def offsets(self, block):
        text = (self.folder / f"{self.blocks[block][0]}.rs").read_text(encoding="utf-8")
        return {name: int(offset, 16) for offset, name in re.findall(
            r'#\[doc = "0x([0-9a-f]+)[^"]*"\]\s*(?:#\[inline\(always\)\]\s*)?pub (?:fn )?(\w+)', text)}

    def register(self, block, name):
        path = self.folder / self.blocks[block][0] / f"{name}.rs"
        return path.read_text(encoding="utf-8") if path.is_file() else ""

    def fields(self, block, name):
        """{field: (shift, mask)}; a field that is only written has mask 1."""
        text = self.register(block, name)
        fields = {f: (int(shift), 1) for f, shift in re.findall(r"pub fn (\w+)\(&mut self\) -> \w+_W<(\d+)>", text)}
        for f, shift, mask in re.findall(
                r"pub fn (\w+)\(&self\) -> \w+ \{\s*\w+::new\(\(+self\.bits(?: >> (\d+)\))? & (\w+)\)", text):
            fields[f] = (int(shift or 0), number(mask))
        return fields

    def variant(self, block, name, field, variant):
        enum, _, value = variant.rpartition(".")
        body = re.search(rf"pub enum {enum or field.upper()}_A \{{(.*?)\n\}}", self.register(block, name), re.S)
        return int(re.search(rf"\b{value} = (\d+)", body.group(1)).group(1))


def core_offsets(text):
    """Of the first ARMv7-M RegisterBlock: fields follow each other; those for other cores are left out."""
    body = re.search(r"pub struct RegisterBlock \{(.*?)\n\}", text, re.S).group(1)
    body = re.sub(r"#\[cfg\((?:armv6m|armv8m)\)\]\s*(?:pub )?\w+: [^\n]+\n", "", body)
    offsets, at = {}, 0
    for name, kind in re.findall(r"^\s*(?:pub )?(\w+): ([^\n]+),$", body, re.M):
        offsets[name] = at
        size = 1 if "u8" in kind else 4
        count = re.search(r"; (\d+)\]", kind)
        at += size * (int(count.group(1)) if count else 1)
    return offsets


def expected_bits(chip, name):
    """What a constant of a chip block should be; None where its name says no field."""
    peripheral, register, field = name.split("_", 2) if name.count("_") >= 2 else (name, "", "")
    block = CHIP_BLOCKS.get(peripheral.lower())
    if block is None:
        return None
    register = REGISTER_OF.get(name, register.lower())
    fields = chip.fields(block, register)
    if name in COMPOSED:
        total = 0
        for f, value in COMPOSED[name]:
            total |= (chip.variant(block, register, f, value) if isinstance(value, str) else value) << fields[f][0]
        return total
    field = field.lower()
    if field in fields:
        return 1 << fields[field][0]
    if field.endswith("_mask") and field[:-5] in fields:
        return fields[field[:-5]][1] << fields[field[:-5]][0]
    if field.endswith("0") and field[:-1] in fields:
        return 1 << fields[field[:-1]][0]
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--header", type=pathlib.Path, required=True)
    parser.add_argument("--cc", default="cc")
    parser.add_argument("--work", type=pathlib.Path, required=True)
    choices = parser.parse_args()
    folders = fetch(choices.work)
    if folders is None:
        return 77
    chip, core = Chip(folders[0]), folders[1]
    core_text = {name: (core / f"{file}.rs").read_text(encoding="utf-8") for name, file in CORE_BLOCKS.items()}
    core_bases = {name: number(address) for name, address in re.findall(
        r"pub const PTR: \*(?:const|mut) (?:self::)?(\w+)::RegisterBlock = (0x[0-9A-F_]+)",
        (core / "mod.rs").read_text(encoding="utf-8"))}
    core_values = {name: number(value) for text in core_text.values()
                   for name, value in re.findall(r"^const (\w+): u32 = ([0-9a-fA-Fx_ <]+);", text, re.M)}
    structs, blocks, constants = ours(choices.header.resolve(), choices.cc, choices.work.resolve())
    faults, seen_n, unknown = [], 0, []

    def compare(what, got, want):
        nonlocal seen_n
        seen_n += 1
        if got != want:
            faults.append(f"{what} is {got:#x}, should be {'missing' if want is None else hex(want)}")

    for struct, members in structs.items():
        theirs = core_offsets(core_text[struct]) if struct in CORE_BLOCKS else chip.offsets(CHIP_BLOCKS[struct])
        for member, offset in members.items():
            compare(f"{struct}.{member}", offset, theirs.get(ELSEWHERE.get((struct, member), member)))
    for block, (struct, address) in blocks.items():
        want = core_bases[CORE_BLOCKS[struct]] if struct in CORE_BLOCKS else chip.blocks[block][1]
        compare(block, address, want)
    for name, value in constants.items():
        want = expected_bits(chip, name)
        if name.startswith("INTERRUPT_"):
            want = chip.interrupts.get(name[len("INTERRUPT_"):])
        elif name in SHCSR:
            shift = re.search(rf"Exception::{SHCSR[name]} => Some\((\d+)\)", core_text["scb"])
            want = 1 << int(shift.group(1))
        elif want is None:
            want = core_values.get(CORE_CONSTANTS.get(name, name.replace("SYSTICK", "SYST")))
        if want is None:
            unknown.append(name)
        else:
            compare(name, value, want)
    for fault in faults:
        print("FAIL", fault)
    print(f"{seen_n} places and bits, {len(faults)} faults; the crates do not know {', '.join(unknown) or 'none'}")
    return 1 if faults or seen_n < 170 else 0


if __name__ == "__main__":
    sys.exit(main())
