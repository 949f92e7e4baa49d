#!/usr/bin/env python3
"""The booted image with a hundred smart servos on its bus, each a model (limber-sim servos) behind USART6."""
import re
import signal
import subprocess
import time

import firmware_case
import line_log
from firmware_case import BUSY, FirmwareCase, TooBusy, again_if_too_busy

SERVOS_N = 100
BAUD = 4000000
GOALS_HZ = 25  # 514 bytes each: an emulated line carries some 50 KB a second
SETTINGS = [f"links={SERVOS_N // 2}", "spring=2000", "smoothing=50", "servo_kind=2", f"servo_baud={BAUD}",
            f"servo_rate={GOALS_HZ}", "pose_hold=200", "angles_rate=20"]


class Servos(FirmwareCase):
    def start(self, *script):
        """Servos, to which `script` happens, and a board with the rod they need."""
        command = [firmware_case.choices.sim, "servos", "--tcp", "127.0.0.1:0", "--count", str(SERVOS_N), "--baud",
                   str(BAUD), *(word for fault in script for word in ("--inject", fault))]
        bus = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        self.addCleanup(bus.stdout.close)
        self.addCleanup(bus.wait)
        self.addCleanup(bus.kill)
        port = int(re.search(r"127\.0\.0\.1:(\d+)", bus.stdout.readline())[1])
        self.started = time.monotonic()
        self.boot(bus_port=port)
        self.good("params", "set", *SETTINGS)
        return bus

    def end(self, bus):
        """What the servos have seen."""
        bus.send_signal(signal.SIGINT)
        return {name: int(count) for name, count in re.findall(r"^(\S[^\d]*?) +(\d+)$", bus.communicate(timeout=20)[0],
                                                               re.MULTILINE)}

    @again_if_too_busy
    def test_a_hundred_servos_are_armed_follow_and_are_let_go(self):
        bus = self.start()
        start = len(self.line.frames)
        told = self.stream(self.track(5.0))
        self.assertTrue(told["poses"]["balances"])
        self.assertEqual(told["poses"]["lost"], 0)
        states = [line_log.angles(payload)[:2] for payload in self.line.of(line_log.ANGLES, start)]
        self.assertEqual(self.states_in_order(states)[:3], ["DISARMED", "ARMING", "ACTIVE"])
        self.assertEqual(self.good_json("info")["state"], "DISARMED")
        seen = self.end(bus)
        print(seen, flush=True)
        self.assertGreaterEqual(seen["ping"], SERVOS_N)
        self.assertEqual(seen["torque on"], SERVOS_N)
        self.assertGreater(seen["goals"], 80 * SERVOS_N)  # of at most 25 a second, for 6 s
        self.assertEqual((seen["damaged"], seen["unknown"], seen["refused"]), (0, 0, 0))

    @again_if_too_busy
    def test_one_that_is_missing_keeps_the_rest_from_being_armed(self):
        self.start("unplug@0+600:57")
        code, _, err = self.limber("stream", self.track())
        self.assertEqual(code, 4)
        if "servo 57 (joint 29, theta)" not in err and any(sign in err for sign in BUSY):
            raise TooBusy(err)
        self.assertIn("servo 57 (joint 29, theta)", err)
        told = self.good_json("info")
        self.assertEqual(told["state"], "DISARMED")
        self.assertNotIn("TORQUE", told["flags"])

    @again_if_too_busy
    def test_one_that_goes_missing_is_a_fault(self):
        bus = self.start("unplug@15+600:3")
        tool = self.start_stream()
        self.wait_for_state("FAULT", seconds=60)
        code = tool.wait(timeout=30)
        said = tool.stdout.read()
        if "servo 3 (joint 2, theta)" not in said:
            raise TooBusy(said)
        self.assertEqual(code, 4)
        self.assertGreater(time.monotonic() - self.started, 15)
        self.wait_for_state("ACTIVE", seconds=0.1)  # it had come so far
        told = self.good_json("info")
        self.assertEqual((told["state"], told["fault"]), ("FAULT", "SERVO"))
        self.assertNotIn("TORQUE", told["flags"])
        self.assertEqual(self.end(bus)["torque on"], SERVOS_N)


if __name__ == "__main__":
    firmware_case.main()
