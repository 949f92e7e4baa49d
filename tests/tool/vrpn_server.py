#!/usr/bin/env python3
"""A VRPN server with one tracker (and another beside it), over TCP, for tests: after what vrpn_Connection.C and
vrpn_Tracker.C write. It sends a track's poses at their own times, or hostile bytes.

    vrpn_server.py TRACK [--port 3883] [--tracker Tracker0] [--sensor 0] [--rate HZ] [--wait S]
"""
import argparse
import socket
import struct
import sys
import threading
import time

COOKIE = b"vrpn: ver. 07.35  0".ljust(24, b"\0")
SENDER, TYPE = -1, -2
SENDERS = ["VRPN Control", "Other", "Tracker0"]
TYPES = ["vrpn_Base ping_message", "vrpn_Base pong_message", "vrpn_Tracker Velocity", "vrpn_Tracker Pos_Quat"]


def message(sender, kind, body, at_s=None, length=None):
    at_s = time.time() if at_s is None else at_s
    us = round(at_s * 1e6)
    head = struct.pack(">IIIiiI", 24 + len(body) if length is None else length, us // 1000000, us % 1000000, sender,
                       kind, 0)
    return head + body + bytes(-len(body) % 8)


def description(number, kind, name):
    text = name.encode() + b"\0"
    return message(number, kind, struct.pack(">I", len(text)) + text)


def pose(values, sender=None, sensor=0, at_s=None):
    """values: x y z qx qy qz qw."""
    body = struct.pack(">ii7d", sensor, sensor, *values)
    return message(SENDERS.index("Tracker0") if sender is None else sender, TYPES.index("vrpn_Tracker Pos_Quat"),
                   body, at_s)


def hang_up(connection):
    """Closing alone would wait for whoever is reading from it."""
    try:
        connection.shutdown(socket.SHUT_RDWR)
    except OSError:
        pass  # the other end was first
    connection.close()


class Server:
    """Listens; each client is welcomed and gets what is sent from then on."""

    def __init__(self, port=0, tracker="Tracker0", cookie=COOKIE):
        self.senders = [tracker if name == "Tracker0" else name for name in SENDERS]
        self.cookie = cookie
        self.clients = []
        self.welcomed_n = 0
        self.change = threading.Condition()
        self.listener = socket.create_server(("127.0.0.1", port))
        self.port = self.listener.getsockname()[1]
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self):
        while True:
            try:
                client, _ = self.listener.accept()
            except OSError:
                return
            threading.Thread(target=self._welcome, args=(client,), daemon=True).start()

    def _welcome(self, client):
        """Greets, tells what the numbers stand for, and answers until the client has gone."""
        try:
            client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            client.sendall(self.cookie)
            theirs = b""
            while len(theirs) < 24:
                got = client.recv(24 - len(theirs))
                if not got:
                    raise OSError("gone before it greeted")
                theirs += got
            if not theirs.startswith(b"vrpn: ver. 07."):
                raise OSError("not a VRPN client")
            for number, name in enumerate(self.senders):
                client.sendall(description(number, SENDER, name))
            for number, name in enumerate(TYPES):
                client.sendall(description(number, TYPE, name))
        except OSError:
            hang_up(client)
            return
        with self.change:
            self.clients.append(client)
            self.welcomed_n += 1
            self.change.notify_all()
        self._answer_pings(client)

    def _answer_pings(self, client):
        """Clients number their senders and types themselves; any message may be a ping, and a pong hurts nobody."""
        try:
            while client.recv(4096):
                client.sendall(message(self.senders.index("VRPN Control"), TYPES.index("vrpn_Base pong_message"), b""))
        except OSError:
            pass

    def wait_for_client(self, number=1, seconds=20):
        with self.change:
            if not self.change.wait_for(lambda: self.welcomed_n >= number, seconds):
                raise AssertionError("no client came")

    def send(self, *messages):
        """To all clients; those who have gone are forgotten. Messages that come between poses are sent with them."""
        for client in list(self.clients):
            try:
                client.sendall(b"".join(messages))
            except OSError:
                hang_up(client)
                self.clients.remove(client)

    def drop_clients(self):
        for client in self.clients:
            hang_up(client)
        self.clients = []

    def close(self):
        hang_up(self.listener)
        self.drop_clients()


def rows_of(path):
    with open(path, encoding="ascii") as file:
        return [[float(word) for word in line.split()] for line in file if line.strip() and line[0] != "#"]


def play(server, rows, rate_hz=None, sensor=0, company=True):
    """Each pose at its own time, or at an even rate, with the moment it is sent as its time. With company."""
    start = time.monotonic()
    for n, row in enumerate(rows):
        after = n / rate_hz if rate_hz else row[0] - rows[0][0]
        wait = start + after - time.monotonic()
        if wait > 0:
            time.sleep(wait)
        parts = [pose(row[1:8], sensor=sensor)]
        if company and n % 3 == 0:
            parts.append(pose([9.0] * 7, sender=SENDERS.index("Other")))
            parts.append(pose([8.0] * 7, sensor=sensor + 1))
        server.send(*parts)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("track")
    parser.add_argument("--port", type=int, default=3883)
    parser.add_argument("--tracker", default="Tracker0")
    parser.add_argument("--sensor", type=int, default=0)
    parser.add_argument("--rate", type=float)
    parser.add_argument("--wait", type=float, default=20, help="for a client")
    choices = parser.parse_args()
    server = Server(choices.port, choices.tracker)
    print(f"ready {server.port}", flush=True)
    server.wait_for_client(seconds=choices.wait)
    play(server, rows_of(choices.track), choices.rate, choices.sensor)


if __name__ == "__main__":
    sys.exit(main())
