#!/usr/bin/env python3
"""Writes the firmware to a board, with whichever tool is there and connected; prefers a debug probe, then USB, then
the serial line.

Only the sectors that the image fills are erased. Settings (sectors 10 and 11) stay: no mass erase, ever.

    tools/dev flash                      # finds out by itself
    tools/dev flash --port /dev/ttyUSB0  # over the serial line, by the boot loader in ROM
    tools/dev flash --with dfu-util --dry-run
"""
import argparse
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

USB = pathlib.Path("/sys/bus/usb/devices")
DEVICES = pathlib.Path("/dev")
FLASH_START = 0x08000000
SECTORS_BYTES = [16384] * 4 + [65536] + [131072] * 5  # 0 ... 9, RM0090 table 5; the settings are in 10 and 11
PACKAGES = {"st-flash": "stlink-tools", "openocd": "openocd", "dfu-util": "dfu-util", "stm32flash": "stm32flash"}

DFU = "0483:df11"
ST_LINK = re.compile("0483:37(44|48|4[a-f]|5[2-7])")
OPENOCD_PROBES = {  # JTAG adapters of the board's maker: what OpenOCD calls them
    "15ba:0003": "ftdi/olimex-arm-usb-ocd", "15ba:002b": "ftdi/olimex-arm-usb-ocd-h",
    "15ba:0004": "ftdi/olimex-jtag-tiny", "15ba:002a": "ftdi/olimex-arm-usb-tiny-h"}

BOOT_LOADER = """to reach the boot loader in ROM (AN2606, STM32F405): power off, BOOT0 to 3.3 V, BOOT1 (PB2) to ground,
  power on. Over USB (PA11, PA12) it then shows up as 0483:df11; over a serial line it listens on PA9 (TX) and
  PA10 (RX). Afterwards: BOOT0 back to ground, reset."""


def connected():
    """USB ids of what is plugged in."""
    ids = []
    for vendor in sorted(USB.glob("*/idVendor")):
        ids.append(f"{vendor.read_text().strip()}:{(vendor.parent / 'idProduct').read_text().strip()}")
    return ids


def serial_ports():
    return sorted(str(path) for kind in ("ttyUSB*", "ttyACM*") for path in DEVICES.glob(kind))


def sectors_n(bytes_n):
    """How many sectors, from the first on, an image of that size fills."""
    n, room = 0, 0
    while room < bytes_n:
        room += SECTORS_BYTES[n]
        n += 1
    return n


def st_flash(image, _):
    return ["st-flash", "--reset", "write", image, hex(FLASH_START)]  # erases what it writes


def openocd(image, probe):
    return ["openocd", "-f", f"interface/{probe or 'stlink'}.cfg", "-f", "target/stm32f4x.cfg",
            "-c", f"program {image} {FLASH_START:#x} verify reset exit"]  # likewise


def dfu_util(image, _):
    return ["dfu-util", "-d", DFU, "-a", "0", "-s", f"{FLASH_START:#x}:leave", "-D", image]  # likewise


def stm32flash(image, port):
    # without -e, versions before 0.7 erase everything
    pages = sectors_n(pathlib.Path(image).stat().st_size)
    return ["stm32flash", "-b", "115200", "-w", image, "-e", str(pages), "-v", "-g", "0x0", port]


TOOLS = {"st-flash": st_flash, "openocd": openocd, "dfu-util": dfu_util, "stm32flash": stm32flash}


def ways(port):
    """(tool, its detail, what is connected) in order of preference, installed or not."""
    if port:
        return [("stm32flash", port, f"a serial port, {port}")]
    ids, found = connected(), []
    if any(ST_LINK.fullmatch(i) for i in ids):
        found += [("st-flash", None, "an ST-Link"), ("openocd", "stlink", "an ST-Link")]
    found += [("openocd", OPENOCD_PROBES[i], f"a JTAG adapter, {i}") for i in ids if i in OPENOCD_PROBES]
    if DFU in ids:
        found.append(("dfu-util", None, f"a board in its USB boot loader, {DFU}"))
    if len(serial_ports()) == 1:
        found.append(("stm32flash", serial_ports()[0], f"a serial port, {serial_ports()[0]}"))
    return found


def give_up(*lines):
    print("flash:", "\n  ".join(lines), file=sys.stderr)
    return 1


def choose(tool, port):
    """(tool, detail), or a list of sentences that tell what to do."""
    found = ways(port)
    if tool:
        detail = next((d for t, d, _ in found if t == tool), None)
        if tool == "stm32flash" and not detail:
            return ["which serial port? --port /dev/ttyUSB0", f"there are: {' '.join(serial_ports()) or 'none'}"]
        return tool, detail
    for name, detail, _ in found:
        if shutil.which(name):
            return name, detail
    if found:
        return [f"{what} is there, but no {name}: sudo apt install {PACKAGES[name]}" for name, _, what in found]
    return ["nothing to flash through is connected (an ST-Link, a board in its USB boot loader, or one serial port)",
            *([f"serial ports: {' '.join(serial_ports())}; say which with --port"] if serial_ports() else []),
            *(f"{name}: {'installed' if shutil.which(name) else f'sudo apt install {package}'}"
              for name, package in PACKAGES.items()), BOOT_LOADER]


def main(words=None):
    parser = argparse.ArgumentParser(prog="tools/dev flash", description=__doc__, epilog=BOOT_LOADER,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--image", default="build/stm32f405/limber-stm32f405.bin")
    parser.add_argument("--port", help="serial port whose other end is PA9 and PA10; for stm32flash")
    parser.add_argument("--with", dest="tool", choices=TOOLS, help="this tool, connected or not")
    parser.add_argument("--dry-run", action="store_true", help="only say what would be run")
    choices = parser.parse_args(words)
    if choices.port and choices.tool not in (None, "stm32flash"):
        return give_up(f"--port {choices.port} is for stm32flash; {choices.tool} does not use a serial port")
    image = pathlib.Path(choices.image)
    if not image.exists():
        return give_up(f"no {image}: tools/dev firmware makes it")
    if image.stat().st_size > sum(SECTORS_BYTES):
        return give_up(f"{image} reaches into the sectors of the settings")
    way = choose(choices.tool or ("stm32flash" if choices.port else None), choices.port)
    if isinstance(way, list):
        return give_up(*way)
    name, detail = way
    command = TOOLS[name](str(image), detail)
    print(shlex.join(command), flush=True)
    if choices.dry_run:
        return 0
    if not shutil.which(name):
        return give_up(f"no {name}: sudo apt install {PACKAGES[name]}")
    if subprocess.run(command, check=False).returncode != 0:
        return give_up(f"{name} failed", *([BOOT_LOADER] if name in ("dfu-util", "stm32flash") else []))
    return 0


if __name__ == "__main__":
    sys.exit(main())
