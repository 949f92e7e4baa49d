#!/usr/bin/env python3
"""ROBOTIS' own dynamixel-sdk (PyPI) against dynamixel.c: the CRC of random bytes, Ping to every id, Sync Write of
goals, byte for byte as the SDK hands them to its port.

Only packets in which nothing has to be stuffed are compared: where FF FF FD comes up, SDK 3.7.31 makes the longer
packet in a new list and then sends the old one, without the FD. Goals never need any (test_servo_bus_on.c).

Exit code 77 where the package registry cannot be reached.
"""
import argparse
import pathlib
import random
import subprocess
import sys

PACKAGE = "dynamixel-sdk==3.7.31"
GOAL_POSITION, GOAL_BYTES = 116, 4


def install(directory):
    stamp = directory / "installed"
    wanted = f"{PACKAGE} {sys.version}"
    if stamp.exists() and stamp.read_text() == wanted:
        return
    directory.mkdir(parents=True, exist_ok=True)
    pip = subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check",
                          "--target", directory / "python", "--upgrade", PACKAGE], capture_output=True, text=True)
    if pip.returncode != 0:
        print(f"SKIPPED, pip could not install {PACKAGE}: {pip.stderr.strip()[-300:]}", file=sys.stderr)
        sys.exit(77)
    stamp.write_text(wanted)


class Port:
    """What the SDK writes to; nobody answers."""
    is_using = False

    def __init__(self):
        self.written = b""

    def clearPort(self):
        pass

    def writePort(self, packet):
        self.written = bytes(packet)
        return len(packet)

    def readPort(self, _length):
        return []

    def setPacketTimeout(self, _length):
        pass

    def isPacketTimeout(self):
        return True


def cases(sdk):
    """(the line for dynamixel_packets, the bytes of the SDK)"""
    handler, port, chance = sdk.Protocol2PacketHandler(), Port(), random.Random(4)
    for number in range(200):
        data = chance.randbytes(1 + 5 * number)
        yield f"crc {data.hex()}", handler.updateCRC(0, data, len(data)).to_bytes(2, "little")
    for servo in range(253):
        handler.ping(port, servo)
        yield f"ping {servo}", port.written
    for servos_n in (1, 2, 8, 100, 128):
        group = sdk.GroupSyncWrite(port, handler, GOAL_POSITION, GOAL_BYTES)
        words = []
        for servo in chance.sample(range(253), servos_n):
            goal = chance.randint(2048 - 5215, 2048 + 5215) & 0xFFFFFFFF
            group.addParam(servo, list(goal.to_bytes(GOAL_BYTES, "little")))
            words += [servo, goal]
        group.txPacket()
        yield f"sync_write {GOAL_POSITION} {GOAL_BYTES} {' '.join(map(str, words))}", port.written


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--directory", type=pathlib.Path, required=True, help="to install the SDK in")
    parser.add_argument("--packets", required=True, help="the program dynamixel_packets")
    arguments = parser.parse_args()
    install(arguments.directory)
    sys.path.insert(0, str(arguments.directory / "python"))
    import dynamixel_sdk  # pylint: disable=import-error,import-outside-toplevel

    lines, expected = zip(*cases(dynamixel_sdk))
    ours = subprocess.run([arguments.packets], input="\n".join(lines) + "\n", capture_output=True, text=True,
                          check=True).stdout.split("\n")
    wrong = [line for line, theirs, mine in zip(lines, expected, ours) if theirs.hex().upper() != mine]
    for line in wrong[:5]:
        print(f"differs: {line[:100]}")
    print(f"{len(lines)} compared, {len(wrong)} differ")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
