"""The C code's frames read by code that nobody here wrote, and the other way round.

COBS is PyPI's cobs, the checksum PyPI's crc32c, and the messages are read by what the Kaitai Struct
compiler made of limber.ksy.

    peers.py PROTO_VECTORS VECTORS_DIRECTORY
"""

import json
import math
import pathlib
import random
import struct
import subprocess
import sys

from cobs import cobs
from crc32c import crc32c
from limber import Limber

BODY_MIN, BODY_MAX, TEXT_MAX = 12, 1112, 96
TAIL_MAX = {"angles_tenth_mrad": 256, "nodes_m": 91, "values": 256}


def records(text):
    """name, wire bytes, expected words and {field: words} of each record."""
    for block in text.split("\n\n"):
        lines = [line for line in block.splitlines() if line and not line.startswith("#")]
        if not lines:
            continue
        head = dict(line.split(":", 1) for line in lines if not line.startswith("  "))
        fields = dict((line[2:].split(" ", 1) + [""])[:2] for line in lines if line.startswith("  "))
        yield head["name"].strip(), bytes.fromhex(head["hex"]), head["expect"].split(), fields


def tail_fits(body):
    for name, most in TAIL_MAX.items():
        if len(getattr(body, name, [])) > most:
            return False
    return len(getattr(body, "text", "").encode()) <= TEXT_MAX


def event(stretch):
    """What a stretch between two zeros is, and the frame if it is one."""
    try:
        body = cobs.decode(stretch)
    except cobs.DecodeError:
        return "cobs", None
    if len(body) > BODY_MAX:
        return "long", None
    if len(body) < BODY_MIN:
        return "short", None
    if crc32c(body[:-4]) != int.from_bytes(body[-4:], "little"):
        return "crc", None
    try:
        frame = Limber.from_bytes(body)
    except EOFError:
        return "length", None
    if isinstance(frame.body, bytes):
        return "unknown", frame
    if not frame.body._io.is_eof() or not tail_fits(frame.body):
        return "length", None
    return frame.header.type.name.upper(), frame


def events(wire):
    return [event(stretch) for stretch in wire.split(b"\0")[:-1] if stretch]


def flat(value):
    """Numbers of a field as Kaitai read it, in wire order."""
    if isinstance(value, list):
        return [number for item in value for number in flat(item)]
    if isinstance(value, Limber.AnglePair):
        return [value.theta, value.phi]
    if isinstance(value, Limber.Vector):
        return [value.x, value.y, value.z]
    return [value]


def same(read, written):
    """A number as read, and as the C code wrote it in decimal: the same float32, or integer."""
    if isinstance(read, float):
        return struct.pack("<f", read) == struct.pack("<f", float(written)) or (
            math.isnan(read) and math.isnan(float(written)))
    return int(read) == int(written)


def check_fields(name, frame, fields):
    for field, text in fields.items():
        holder = frame.header if field in ("session", "seq", "t_us") else frame.body
        if field == "tail":
            field = next(tail for tail in TAIL_MAX if hasattr(holder, tail))
        value = getattr(holder, field)
        if text.startswith('"'):
            good = value == json.loads(text)
        else:
            words, numbers = text.split(), flat(value)
            good = len(words) == len(numbers) and all(map(same, numbers, words))
        if not good:
            raise AssertionError(f"{name}: {field} is {text}, read as {value}")
    public = {key for key in vars(frame.body) if not key.startswith("_")}
    told = {field for field in fields if field not in ("session", "seq", "t_us", "tail")}
    if public - set(TAIL_MAX) != told:
        raise AssertionError(f"{name}: fields {public} read, {told} written")


def check_records(text):
    count = 0
    for name, wire, expect, fields in records(text):
        found = events(wire)
        words = [word for word, _ in found]
        if words != expect:
            raise AssertionError(f"{name}: expected {expect}, others' code finds {words}")
        if fields:
            check_fields(f"{expect[0]} ({name})", found[0][1], fields)
            body = cobs.decode(wire[1:-1])
            if b"\0" + cobs.encode(body) + b"\0" != wire:
                raise AssertionError(f"{name}: others encode it otherwise")
        count += 1
    return count


# Unknown ones, and those without texts: any payload of theirs can be read.
TYPES = [0, 0x0A, 0x4F, 0xFF] + [getattr(Limber.MessageType, name) for name in (
    "ping", "timesync", "stats", "pose", "angles", "nodes", "arm", "ack", "boot_report")]


def random_payload(rng):
    size = rng.choice([0, 1, 32, rng.randrange(60), rng.randrange(1101), 242, 243, 496, 1100])
    kind = rng.randrange(3)
    if kind == 0:
        return rng.randbytes(size)
    if kind == 1:
        return bytes(rng.randrange(1, 256) for _ in range(size))
    return bytes(rng.choice([0, 0, 1, 255]) for _ in range(size))


def check_their_frames(program, rounds_n):
    """Frames made by cobs and crc32c, whole and damaged, as the C code reads them."""
    rng, lines, expected = random.Random(1), [], []
    for number in range(rounds_n):
        header = bytes([rng.choice(TYPES)]) + rng.randbytes(7)
        payload = random_payload(rng)
        covered = header + payload
        wire = b"\0" + cobs.encode(covered + crc32c(covered).to_bytes(4, "little")) + b"\0"
        if number % 4 == 3:  # a byte changed, lost or put in, but for the zeros at the ends
            at = rng.randrange(1, len(wire) - 1)
            wire = wire[:at] + rng.choice([b"", rng.randbytes(1), wire[at:at + 1] * 2]) + wire[at + 1:]
        found = events(wire)
        line = "".join(f" {word}" for word, _ in found)
        for stretch in wire.split(b"\0")[:-1]:
            if stretch and event(stretch)[0] not in ("cobs", "long", "short", "crc"):
                body = cobs.decode(stretch)
                kind, session, seq, t_us = struct.unpack("<BBHI", body[:8])
                line += f" = {kind} {session} {seq} {t_us}" + "".join(f" {b:02x}" for b in body[8:-4])
        lines.append(wire.hex(" "))
        expected.append(line)
    answer = subprocess.run([program, "--read"], input="\n".join(lines) + "\n", capture_output=True,
                            text=True, check=True).stdout.splitlines()
    if len(answer) != len(expected):
        raise AssertionError(f"{len(expected)} lines given, {len(answer)} answered")
    for wire, theirs, ours in zip(lines, expected, answer):
        # One that is both too long and cut off is given up by C before its end.
        if theirs != ours and (theirs, ours) != (" cobs", " long"):
            raise AssertionError(f"{wire}\n others read{theirs}\n C reads{ours}")
    return len(expected)


def main():
    program, directory = sys.argv[1], pathlib.Path(sys.argv[2])
    for path in sorted(directory.glob("*.txt")):
        print(f"{path.name}: {check_records(path.read_text(encoding='utf-8'))} records as expected")
    dumped = subprocess.run([program, "--dump", "60"], capture_output=True, check=True).stdout
    print(f"random messages: {check_records(dumped.decode('utf-8'))} read field by field")
    print(f"others' frames: {check_their_frames(program, 4000)} read by the C code")


if __name__ == "__main__":
    main()
