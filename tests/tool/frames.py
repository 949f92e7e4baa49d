"""Frames out of bytes: PROTOCOL.md's layout, read independently of the code under test."""


def crc_table():
    for byte in range(256):
        crc = byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x82F63B78 if crc & 1 else 0)
        yield crc


CRC_TABLE = list(crc_table())


def crc32c(data):
    crc = 0xFFFFFFFF
    for byte in data:
        crc = crc >> 8 ^ CRC_TABLE[(crc ^ byte) & 0xFF]
    return crc ^ 0xFFFFFFFF


def cobs_decode(data):
    out, at = bytearray(), 0
    while at < len(data):
        code = data[at]
        out += data[at + 1:at + code]
        at += code
        if code < 255 and at < len(data):
            out.append(0)
    return bytes(out)


class Frames:
    """Frames out of bytes, in any pieces: (type, payload)."""

    def __init__(self):
        self.rest = b""
        self.bad_n = 0

    def take(self, data):
        *pieces, self.rest = (self.rest + data).split(b"\0")
        for piece in filter(None, pieces):
            body = cobs_decode(piece)
            if len(body) < 12 or crc32c(body[:-4]) != int.from_bytes(body[-4:], "little"):
                self.bad_n += 1
            else:
                yield body[0], body[8:-4]
