"""The firmware's own image on the emulated board, with its lines on sockets and a hand on the processor.

    with Board(qemu, elf, folder) as board:
        line = board.connect()
        with board.debugger() as gdb:
            gdb.set_register(PC, 0x1000)

What goes wrong in the image is provoked from outside: the image is the one that is flashed.
"""
import contextlib
import pathlib
import socket
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools" / "firmware"))
from qemu import board_command, free_port  # noqa: E402  (where it is found must be said first)

SP, PC = 13, 15


def keep_trying(what, timeout_s=5.0):
    deadline = time.monotonic() + timeout_s
    while True:
        try:
            return what()
        except (ConnectionRefusedError, FileNotFoundError):
            if time.monotonic() > deadline:
                raise
            time.sleep(0.02)


class Board:
    """USART1 is a socket in the folder: each byte is a packet, and TCP would take most of the machine for that. USART6
    is connected to 127.0.0.1:bus_port where that is given. With `held` the processor waits for a debugger to come
    and go. Ends QEMU, and only this one, on leaving."""

    def __init__(self, qemu, elf, folder, bus_port=None, held=False):
        self.socket, self.debug_port = str(folder / "usart1"), free_port()
        self.command = [
            *board_command(qemu, elf, f"path={self.socket}", bus_port), "-gdb", f"tcp:127.0.0.1:{self.debug_port}",
            *(["-S"] if held else [])]
        self.process = None
        self.said = None

    def __enter__(self):
        self.said = tempfile.TemporaryFile(mode="w+", encoding="utf-8")
        self.process = subprocess.Popen(self.command, stdin=subprocess.DEVNULL, stdout=self.said, stderr=self.said)
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait(timeout=20)
        self.said.close()

    def connect(self):
        def attempt():
            line = socket.socket(socket.AF_UNIX)
            try:
                line.connect(self.socket)
            except OSError:
                line.close()
                raise
            return line
        return keep_trying(attempt)

    def complaints(self):
        """What QEMU itself has said; empty while all is well."""
        self.said.seek(0)
        return self.said.read()

    @contextlib.contextmanager
    def debugger(self):
        gdb = Debugger(self.debug_port)
        try:
            yield gdb
        finally:
            gdb.close()


class Debugger:
    """GDB's remote protocol, as much of it as QEMU needs. The processor is halted while one is connected;
    close lets it run on."""

    def __init__(self, port):
        self.line = keep_trying(lambda: socket.create_connection(("127.0.0.1", port), timeout=5))
        self.ask("?")

    def send(self, text):
        self.line.sendall(f"${text}#{sum(text.encode()) & 0xFF:02x}".encode())

    def receive(self):
        text = b""
        while b"#" not in text or len(text) - text.rindex(b"#") < 3:
            piece = self.line.recv(65536)
            if not piece:
                raise ConnectionError("QEMU has gone")
            text += piece
        self.line.sendall(b"+")
        return text.lstrip(b"+")[1:text.lstrip(b"+").rindex(b"#")].decode()

    def ask(self, text):
        self.send(text)
        return self.receive()

    def good(self, text):
        answer = self.ask(text)
        if answer != "OK":
            raise RuntimeError(f"QEMU answers '{answer}' to {text}")

    def read(self, address, bytes_n):
        data = b""
        while len(data) < bytes_n:
            data += bytes.fromhex(self.ask(f"m{address + len(data):x},{min(1024, bytes_n - len(data)):x}"))
        return data

    def write(self, address, data):
        for at in range(0, len(data), 1024):
            piece = data[at:at + 1024]
            self.good(f"M{address + at:x},{len(piece):x}:{piece.hex()}")

    def register(self, number):
        return int.from_bytes(bytes.fromhex(self.ask(f"p{number:x}"))[:4], "little")

    def set_register(self, number, value):
        self.good(f"P{number:x}={value.to_bytes(4, 'little').hex()}")

    def run_to(self, address, timeout_s=5.0):
        """Goes on until the instruction there is next."""
        self.good(f"Z1,{address:x},2")
        self.line.settimeout(timeout_s)
        self.ask("c")
        self.good(f"z1,{address:x},2")

    def close(self):
        self.ask("D")
        self.line.close()
