#!/usr/bin/env python3
"""Boots the firmware's image on an emulated board (QEMU, olimex-stm32-h405) and says where to stream to.
Ends with Ctrl-C.

    tools/dev qemu                        # then, elsewhere: limber stream --port tcp:127.0.0.1:PORT track.txt
    tools/dev qemu --links 50 --servos    # with a model of a hundred smart servos on its bus

It keeps to real time as far as this machine lets it; each byte on a line costs it about 10 us, so some 50 KB a
second are all it can carry. Settings are not kept: the emulator has no flash to write. A client that stays
connected and stops reading stops the whole board until it reads again.
"""
import argparse
import pathlib
import re
import signal
import socket
import subprocess
import sys
import time

BUILD = pathlib.Path(__file__).resolve().parents[2] / "build"
SERVO_BAUD = 4000000
GOALS_HZ = 25  # so that a hundred servos' fit what the line can carry
SERVOS_MAX = 128
LINKS_MAX = 64


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def why_not_listen(port):
    """What keeps one from listening there, in words; None if nothing does."""
    with socket.socket() as s:
        s.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)  # as QEMU does: ended connections do not count
        try:
            s.bind(("127.0.0.1", port))
        except OSError as why:
            return why.strerror
    return None


def whole(least, most):
    def convert(text):
        if not (text.isdecimal() and least <= int(text) <= most):
            raise argparse.ArgumentTypeError(f"{text}: must be a whole number from {least} to {most}")
        return int(text)
    return convert


def give_up(text):
    print(f"qemu: {text}", file=sys.stderr)
    return 1


def start_servos(sim, servos_n):
    """(process, its port)"""
    command = [sim, "servos", "--tcp", "127.0.0.1:0", "--count", str(servos_n), "--baud", str(SERVO_BAUD)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    told = re.search(r"127\.0\.0\.1:(\d+)", process.stdout.readline())
    return process, told and int(told[1])


def board_command(qemu, image, line, bus_port=None):
    """USART1 listens at `line`, part of QEMU's -chardev socket; USART6 is connected to 127.0.0.1:bus_port, if any."""
    bus = f"socket,id=bus,host=127.0.0.1,port={bus_port},nodelay=on" if bus_port else "null,id=bus"
    return [str(qemu), "-M", "olimex-stm32-h405", "-display", "none", "-monitor", "none", "-kernel", str(image),
            "-chardev", f"socket,id=line,{line},server=on,wait=off", "-chardev", bus,
            "-serial", "chardev:line", *["-serial", "null"] * 4, "-serial", "chardev:bus"]


def set_up(limber, port, choices):
    """What --links and --servos ask for, told as a user would. False where the board does not take it."""
    settings = [f"links={choices.links}"] if choices.links else []
    if choices.servos:
        settings += ["servo_kind=2", f"servo_baud={SERVO_BAUD}", f"servo_rate={GOALS_HZ}"]
    if not settings:
        return True
    time.sleep(0.5)  # it starts
    told = subprocess.run([limber, "params", "set", *settings, "--port", f"tcp:127.0.0.1:{port}"], capture_output=True,
                          text=True, check=False)
    print(told.stdout + told.stderr, end="")
    return told.returncode == 0


def serve(choices, children):
    bus_port, port = None, choices.port or free_port()
    if choices.servos:
        servos, bus_port = start_servos(choices.sim, 2 * choices.links if choices.links else SERVOS_MAX)
        children.append(servos)
        if not bus_port:
            return give_up("limber-sim servos did not start")
    line = f"host=127.0.0.1,port={port},nodelay=on"
    board = subprocess.Popen(board_command(choices.qemu, choices.elf, line, bus_port), stdin=subprocess.DEVNULL)
    children.append(board)
    if not set_up(choices.limber, port, choices):
        return 1
    print(f"limber ... --port tcp:127.0.0.1:{port}    (Ctrl-C ends it)", flush=True)
    status = board.wait()
    return status and give_up(f"QEMU ended with {status}")


def main():
    parser = argparse.ArgumentParser(prog="tools/dev qemu", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--links", type=whole(1, LINKS_MAX), help=f"links of the rod, 1 to {LINKS_MAX}")
    parser.add_argument("--servos", action="store_true", help="smart servos on the bus, two a link")
    parser.add_argument("--port", type=whole(1, 65535), help="TCP port on 127.0.0.1 (any)")
    parser.add_argument("--elf", type=pathlib.Path, default=BUILD / "stm32f405" / "limber-stm32f405.elf")
    parser.add_argument("--qemu", default="qemu-system-arm")
    parser.add_argument("--sim", default=BUILD / "host" / "limber-sim")
    parser.add_argument("--limber", default=BUILD / "host" / "limber")
    choices = parser.parse_args()
    if not choices.elf.exists():
        return give_up(f"no {choices.elf}: tools/dev firmware makes it")
    if choices.port and (why := why_not_listen(choices.port)):
        return give_up(f"--port {choices.port}: {why}; choose another, or none")
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    children = []
    try:
        return serve(choices, children)
    except KeyboardInterrupt:
        print()
        return 0
    finally:
        for child in children:
            child.terminate()
            child.wait()


if __name__ == "__main__":
    sys.exit(main())
