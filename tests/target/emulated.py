"""The firmware's own image on the emulated board, with its lines on sockets and a hand on the processor.

    with Board(qemu, elf, folder) as board:
        line = board.connect()
        with board.debugger() as gdb:
            gdb.set_register(PC, 0x1000)

What goes wrong in the image is provoked from outside: the image is the one that is flashed.
"""
import contextlib
import socket
import subprocess
import tempfile
import time

SP, LR, PC = 13, 14, 15


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


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
    """USART1 is a socket in the folder: each byte is a packet, and TCP would take most of the machine for that. USART6 is
    connected to 127.0.0.1:bus_port where that is given. With `held` the processor waits for the debugger. Ends QEMU, and
    only this one, on leaving."""

    def __init__(self, qemu, elf, folder, bus_port=None, held=False, plugin=None):
        self.elf, self.socket, self.debug_port = elf, str(folder / "usart1"), free_port()
        bus = f"socket,id=bus,host=127.0.0.1,port={bus_port},nodelay=on" if bus_port else "null,id=bus"
        self.command = [
            str(qemu), "-M", "olimex-stm32-h405", "-display", "none", "-monitor", "none", "-kernel", str(elf),
            "-chardev", f"socket,id=line,path={self.socket},server=on,wait=off",
            "-chardev", bus, "-serial", "chardev:line", *["-serial", "null"] * 4, "-serial", "chardev:bus",
            "-gdb", f"tcp:127.0.0.1:{self.debug_port}", *(["-S"] if held else []),
            *(["-plugin", plugin] if plugin else [])]
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
    """GDB's remote protocol, as much of it as QEMU needs. The processor is halted while one is connected, but
    between go_on and halt; close lets it run."""

    def __init__(self, port):
        self.line = keep_trying(lambda: socket.create_connection(("127.0.0.1", port), timeout=5))
        self.running = False
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

    def word(self, address):
        return int.from_bytes(self.read(address, 4), "little")

    def register(self, number):
        return int.from_bytes(bytes.fromhex(self.ask(f"p{number:x}"))[:4], "little")

    def set_register(self, number, value):
        self.good(f"P{number:x}={value.to_bytes(4, 'little').hex()}")

    def go_on(self):
        self.send("c")
        self.running = True

    def halt(self):
        self.line.sendall(b"\x03")
        self.running = False
        return self.receive()

    def run_to(self, address, timeout_s=5.0):
        """Goes on until the instruction there is next."""
        self.good(f"Z1,{address:x},2")
        self.line.settimeout(timeout_s)
        self.ask("c")
        self.good(f"z1,{address:x},2")

    def close(self):
        if self.running:
            self.halt()
        self.ask("D")
        self.line.close()
