#!/usr/bin/env python3
"""Draws the rod that limber sends: an example of a receiver, from the side and from above.

    pip install python-osc                            # and tkinter: python3-tk
    draw_rod.py [PORT]                                # 9000
    limber stream hand.txt --graphics osc:127.0.0.1:9000

Without a display, or with --text, it prints the tip instead. /limber/nodes: tick, first node, nodes of the rod, then
x y z of each node in m, z up. /limber/angles: tick, state, then theta and phi of each joint in rad.
"""
import argparse
import threading

from pythonosc.dispatcher import Dispatcher
from pythonosc.osc_server import BlockingOSCUDPServer

STATES = "BOOT SELFTEST DISARMED ARMING ACTIVE HOLD RELAX LIMP FAULT ESTOP".split()


class Rod:
    """The newest whole rod; long ones come in several messages of one tick."""

    def __init__(self):
        self.nodes, self.parts, self.tick, self.state = [], {}, None, ""

    def take_nodes(self, _, tick, first, nodes_n, *values):
        if tick != self.tick:
            self.tick, self.parts = tick, {}
        self.parts[first] = [values[i:i + 3] for i in range(0, len(values), 3)]
        nodes = [node for _, part in sorted(self.parts.items()) for node in part]
        if len(nodes) == nodes_n:
            self.nodes = nodes

    def take_angles(self, _, __, state, *___):
        self.state = STATES[state] if state < len(STATES) else str(state)


def print_tips(rod, server):
    while True:
        server.handle_request()
        if rod.nodes:
            print(rod.tick, rod.state, *(f"{value:.4f}" for value in rod.nodes[-1]), flush=True)
            rod.nodes = []


def window_or_none():
    try:
        import tkinter
        return tkinter.Tk()
    except ImportError:
        print("no tkinter (Debian: python3-tk): printing where the tip is")
    except tkinter.TclError as error:
        print(f"{error}: printing where the tip is")
    return None


def draw(rod, server, window):
    import tkinter
    size, middle, reach_m = 500, 250, 0.3
    window.title("limber")
    canvas = tkinter.Canvas(window, width=2 * size, height=size, background="white")
    canvas.pack()
    threading.Thread(target=server.serve_forever, daemon=True).start()

    def again():
        nonlocal reach_m
        canvas.delete("all")
        nodes = rod.nodes
        canvas.create_text(10, 10, anchor="nw", text=f"{rod.state}   from the side (x, z)")
        canvas.create_text(size + 10, 10, anchor="nw", text="from above (x, y)")
        if len(nodes) > 1:
            reach_m = max(reach_m, max(abs(value) for node in nodes for value in node))
            per_m = 0.4 * size / reach_m
            for left, axis in ((0, 2), (size, 1)):
                points = [(left + middle + per_m * node[0], middle - per_m * node[axis]) for node in nodes]
                canvas.create_line(*points, width=4)
        window.after(16, again)

    again()
    window.mainloop()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("port", nargs="?", type=int, default=9000)
    parser.add_argument("--text", action="store_true", help="print where the tip is")
    choices = parser.parse_args()
    rod, dispatcher = Rod(), Dispatcher()
    dispatcher.map("/limber/nodes", rod.take_nodes)
    dispatcher.map("/limber/angles", rod.take_angles)
    server = BlockingOSCUDPServer(("127.0.0.1", choices.port), dispatcher)
    window = None if choices.text else window_or_none()
    if window is not None:
        draw(rod, server, window)
    else:
        print_tips(rod, server)


if __name__ == "__main__":
    main()
