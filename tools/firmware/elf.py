"""What a firmware image holds, read with the cross compiler's own binutils."""
import collections
import pathlib
import re
import struct
import subprocess
import tempfile

Section = collections.namedtuple("Section", "name address bytes_n is_loaded")
Instruction = collections.namedtuple("Instruction", "address mnemonic operands")

FLASH = range(0x08000000, 0x08100000)  # RM0090, 2.3
SRAM = range(0x20000000, 0x20020000)
CCM = range(0x10000000, 0x10010000)
VECTORS_N = 16 + 82  # RM0090, 12.1.3
SETTINGS = range(0x080C0000, 0x08100000)  # sectors 10 and 11: RM0090, table 5


def run(tool, *arguments):
    return subprocess.run([f"arm-none-eabi-{tool}", *map(str, arguments)], check=True, capture_output=True,
                          text=True).stdout


def sections(path):
    """Those that take memory on the board."""
    found = []
    for line in run("readelf", "-SW", path).splitlines():
        row = re.match(r"\s*\[\s*\d+\]\s+(\S+)\s+(\S+)\s+([0-9a-f]{8}) [0-9a-f]+ ([0-9a-f]+) \S+\s+(\w*)", line)
        if row and "A" in row[5]:
            found.append(Section(row[1], int(row[3], 16), int(row[4], 16), row[2] != "NOBITS"))
    return found


def segments(path):
    """What a flasher writes: (address, bytes)."""
    rows = re.findall(r"^\s*LOAD\s+\S+ \S+ 0x([0-9a-f]+) 0x([0-9a-f]+)", run("readelf", "-lW", path), re.MULTILINE)
    return [(int(address, 16), int(size, 16)) for address, size in rows if int(size, 16)]


def symbols(path):
    """Name -> value, of everything that is defined; of names used twice, the first."""
    found = {}
    for line in run("nm", path).splitlines():
        value, _, name = line.rpartition(" ")
        if value[:8].strip():
            found.setdefault(name, int(value[:8], 16))
    return found


def functions(path):
    """Name -> list of Instruction. Static functions of one name are put together."""
    found, current = {}, []
    for line in run("objdump", "-d", "--no-show-raw-insn", path).splitlines():
        if heading := re.match(r"[0-9a-f]{8} <(.+)>:$", line):
            current = found.setdefault(heading[1], [])
        elif row := re.match(r"\s*([0-9a-f]+):\t(\S+)(?:\t([^@;]*))?", line):
            current.append(Instruction(int(row[1], 16), row[2], (row[3] or "").strip()))
    return found


def vectors(path):
    """The vector table: the initial stack pointer, and the handlers' names in order, None where there is none."""
    with tempfile.TemporaryDirectory() as folder:
        image = pathlib.Path(folder) / "image.bin"
        run("objcopy", "-O", "binary", path, image)
        words = [word for word, in struct.iter_unpack("<I", image.read_bytes()[:VECTORS_N * 4])]
    names = {instructions[0].address: name for name, instructions in functions(path).items() if instructions}
    handlers = []
    for word in words[1:]:
        if word != 0 and not (word & 1 and word - 1 in names):
            break  # the table of a program that uses no interrupt is shorter: code begins here
        handlers.append(names.get(word - 1))
    return words[0], handlers
