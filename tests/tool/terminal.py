"""A terminal for tests: a program in a pty of a given size, and what its screen shows by now.

Understands what ncurses sends to a vt100 and to an xterm, no more; anything else fails the test by name.
"""
import fcntl
import os
import pty
import re
import select
import struct
import subprocess
import termios
import time

SEQUENCE = re.compile(r"\x1b(?:\[([?>]?)([\d;]*)([@-~])|[()][0-9A-B]|([=>78MDE]))")


class Screen:
    def __init__(self, rows, columns):
        self.alternate = self.colour = False
        self.cursor_shown = True
        self.pending = ""
        self.top, self.bottom = 0, rows - 1
        self.row = self.column = 0
        self.saved = (0, 0)
        self.last = " "
        self.resize(rows, columns)

    def resize(self, rows, columns):
        self.rows, self.columns = rows, columns
        self.top, self.bottom = 0, rows - 1
        self.row, self.column = min(self.row, rows - 1), min(self.column, columns - 1)
        self.cells = [[" "] * columns for _ in range(rows)]

    def lines(self):
        return ["".join(row).rstrip() for row in self.cells]

    def feed(self, text):
        text = self.pending + text
        self.pending = ""
        at = 0
        while at < len(text):
            if text[at] == "\x1b":
                found = SEQUENCE.match(text, at)
                if not found:
                    if len(text) - at > 20:
                        raise AssertionError(f"unknown sequence {text[at:at + 20]!r}")
                    self.pending = text[at:]
                    return
                self.obey(found)
                at = found.end()
            else:
                self.take(text[at])
                at += 1

    def take(self, character):
        if character == "\r":
            self.column = 0
        elif character == "\n":
            self.line_feed()
        elif character == "\b":
            self.column = max(0, self.column - 1)
        elif character == "\t":
            self.column = min(self.columns - 1, (self.column // 8 + 1) * 8)
        elif character >= " ":
            if self.column == self.columns:
                self.column = 0
                self.line_feed()
            self.cells[self.row][self.column] = self.last = character
            self.column += 1

    def line_feed(self):
        if self.row == self.bottom:
            self.scroll(1, self.top)
        else:
            self.row = min(self.row + 1, self.rows - 1)

    def scroll(self, n, top):
        for _ in range(n):
            del self.cells[top]
            self.cells.insert(self.bottom, [" "] * self.columns)

    def insert_lines(self, n, top):
        for _ in range(n):
            del self.cells[self.bottom]
            self.cells.insert(top, [" "] * self.columns)

    def obey(self, found):
        private, numbers, final, single = found.groups()
        if single:
            if single == "7":
                self.saved = (self.row, self.column)
            elif single == "8":
                self.row, self.column = self.saved
            elif single == "M" and self.row == self.top:
                self.insert_lines(1, self.top)
            elif single == "M":
                self.row -= 1
            return
        if final is None:
            return  # a character set
        values = [int(n) for n in numbers.split(";") if n]
        n = values[0] if values else 1
        if private:
            self.set_mode(values, final)
        elif final == "m":
            self.colour = self.colour or any(30 <= v <= 49 and v not in (39, 49) for v in values)
        else:
            self.move_or_erase(final, n, values)

    def set_mode(self, values, final):
        for value in values:
            if value in (1049, 47):
                self.alternate = final == "h"
            elif value == 25:
                self.cursor_shown = final == "h"

    def move_or_erase(self, final, n, values):
        row = self.cells[self.row]
        column = min(self.column, self.columns - 1)
        if final in "Hf":
            self.row = min((values[0] if values else 1), self.rows) - 1
            self.column = min((values[1] if len(values) > 1 else 1), self.columns) - 1
        elif final in "ABCD":
            self.row = min(max(self.row + {"A": -n, "B": n}.get(final, 0), 0), self.rows - 1)
            self.column = min(max(column + {"C": n, "D": -n}.get(final, 0), 0), self.columns - 1)
        elif final == "G":
            self.column = min(n, self.columns) - 1
        elif final == "d":
            self.row = min(n, self.rows) - 1
        elif final == "K":
            kind = values[0] if values else 0
            begin, end = {0: (column, self.columns), 1: (0, column + 1), 2: (0, self.columns)}[kind]
            row[begin:end] = [" "] * (end - begin)
        elif final == "J":
            kind = values[0] if values else 0
            row[column if kind == 0 else 0:] = [" "] * (self.columns - (column if kind == 0 else 0))
            for other in range(self.rows):
                if kind == 2 or (kind == 0 and other > self.row):
                    self.cells[other] = [" "] * self.columns
        elif final == "X":
            row[column:column + n] = [" "] * min(n, self.columns - column)
        elif final == "P":
            self.cells[self.row] = row[:column] + row[column + n:] + [" "] * min(n, self.columns - column)
        elif final == "@":
            self.cells[self.row] = (row[:column] + [" "] * n + row[column:])[:self.columns]
        elif final == "b":
            for _ in range(n):
                self.take(self.last)
        elif final == "L":
            self.insert_lines(n, self.row)
        elif final == "M":
            self.scroll(n, self.row)
        elif final == "S":
            self.scroll(n, self.top)
        elif final == "T":
            self.insert_lines(n, self.top)
        elif final == "r":
            self.top, self.bottom = (values[0] - 1, values[1] - 1) if len(values) == 2 else (0, self.rows - 1)
            self.row = self.column = 0
        elif final not in "hlnct":
            raise AssertionError(f"unknown sequence {final!r} {values}")


class Terminal:
    """The program as the leader of a session with this terminal; its stdin, stdout and stderr are there."""

    def __init__(self, command, rows, columns, **options):
        self.screen = Screen(rows, columns)
        self.master, slave = pty.openpty()
        self.set_size(rows, columns)
        self.before = termios.tcgetattr(slave)
        self.slave = slave  # kept, so that its settings can be asked for afterwards

        def own_terminal():
            fcntl.ioctl(0, termios.TIOCSCTTY, 0)
        self.process = subprocess.Popen(list(map(str, command)), stdin=slave, stdout=slave, stderr=slave,
                                        start_new_session=True, preexec_fn=own_terminal, **options)
        self.raw = ""

    def set_size(self, rows, columns):
        fcntl.ioctl(self.master, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))

    def resize(self, rows, columns):
        self.read(0.0)
        self.screen.resize(rows, columns)
        self.set_size(rows, columns)

    def type(self, keys):
        os.write(self.master, keys.encode())

    def read(self, seconds):
        """What comes within that time, to the screen."""
        deadline = time.monotonic() + seconds
        while True:
            left = max(0.0, deadline - time.monotonic())
            if not select.select([self.master], [], [], left)[0]:
                return
            text = os.read(self.master, 65536).decode("utf-8", "replace")
            self.raw += text
            self.screen.feed(text)
            if left == 0.0:
                return

    def text(self):
        return "\n".join(self.screen.lines())

    def settle(self):
        """Reads on until the program pauses: a busy machine delivers a picture in pieces."""
        while select.select([self.master], [], [], 0.05)[0]:
            self.read(0.0)

    def wait_for(self, pattern, seconds=10):
        """The match on the whole screen, once the picture that has it is complete."""
        deadline = time.monotonic() + seconds
        while True:
            if re.search(pattern, self.text()):
                self.settle()
            found = re.search(pattern, self.text())
            if found:
                return found
            if time.monotonic() > deadline:
                raise AssertionError(f"never showed {pattern}:\n{self.text()}")
            self.read(0.05)

    def finish(self, seconds=10):
        """The exit code; all that it wrote is on the screen."""
        deadline = time.monotonic() + seconds
        while self.process.poll() is None and time.monotonic() < deadline:
            self.read(0.05)
        self.read(0.1)
        return self.process.wait(timeout=1)

    def is_as_before(self):
        return (termios.tcgetattr(self.slave) == self.before and self.screen.cursor_shown and
                not self.screen.alternate)

    def close(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        for fd in (self.master, self.slave):
            os.close(fd)
