#!/usr/bin/env python3
"""The firmware's own image, booted on the emulated board and used as a user uses it: streams, bits, noise, silence.

What goes wrong inside the board is faults_test.py's, the servo bus servos_test.py's.
"""
import random
import time

import firmware_case
import line_log
from firmware_case import FirmwareCase, TooBusy, again_if_too_busy


RODS = [
    ["links=4", "spring=50", "smoothing=50"],
    ["links=50", "spring=2000", "smoothing=50"],
    ["model=elastic", "links=20", "spring=10", "damper=0.02", "mass=0.02"],
]


def tenth_mrad(bits):
    """As telemetry.c rounds what it sends."""
    scaled = firmware_case.float32(firmware_case.float32(bits=bits) * 10000.0)
    return int(firmware_case.float32(scaled - 0.5 if scaled < 0 else scaled + 0.5))


class Firmware(FirmwareCase):
    def setUp(self):
        super().setUp()
        self.boot()

    def test_info(self):
        told = self.good_json("info")
        self.assertEqual(told["device"], "limber-stm32f405")
        self.assertEqual(told["state"], "DISARMED")
        self.assertEqual(told["boot"]["clock"], "EMULATOR")
        self.assertEqual(told["boot"]["cause"], "POWER")
        self.assertEqual(told["boot"]["fault"], "NONE")
        self.assertIn("ESTOP_IGNORED", told["boot"]["flags"])
        self.assertEqual(told["links_max"], 64)

    def test_estop_stops_and_is_latched(self):
        self.limber("estop")
        self.assertEqual(self.good_json("info")["state"], "ESTOP")
        self.assertEqual(self.limber("stream", self.track())[0], 4)
        self.good("clear")
        self.assertEqual(self.good_json("info")["state"], "DISARMED")

    def test_streams_come_to_the_hosts_bits(self):
        """Every pose accounted for, none lost; and ANGLES are what the host comes to from POSE_LOG, tick by tick."""
        recorded = sorted(firmware_case.choices.shared_tracks.glob("0*.txt"))
        if not recorded:
            print("SKIPPED: the recorded tracks are not beside this checkout")
        if not firmware_case.choices.all_tracks:
            recorded = recorded[1:2]
        for settings in RODS:
            for track in [None, *recorded]:
                with self.subTest(settings=settings, track=track):
                    self.stream_and_compare(track, settings)

    @again_if_too_busy
    def stream_and_compare(self, track, settings):
        self.boot()
        self.good("params", "set", *settings, "pose_hold=200", "pose_log=1")
        start = len(self.line.frames)
        track = track or self.track()
        told = self.stream("--resample", "100", track)
        self.assertGreater(told["duration_s"], 0.99 * firmware_case.length_s(track))
        poses = told["poses"]
        self.assertTrue(poses["balances"])
        self.assertEqual(poses["lost"], 0)
        self.assertEqual(poses["sent"], poses["accepted"] + sum(poses["rejected"].values()))
        if poses["accepted"] < 0.9 * poses["sent"]:
            raise TooBusy(poses["rejected"])
        self.assertEqual(self.line.decoder.bad_n, 0)

        log = [line_log.pose_log(payload) for payload in self.line.of(line_log.POSE_LOG, start)]
        ticks = [entry[0] for entry in log]
        self.assertEqual(ticks, list(range(ticks[0], ticks[0] + len(ticks))), "ticks are missing from the log")
        host = self.replay(settings, log)
        compared, moved = 0, set()
        for payload in self.line.of(line_log.ANGLES, start):
            tick, state, angles = line_log.angles(payload)
            if tick in host:
                self.assertEqual(angles, [tenth_mrad(bits) for bits in host[tick]], f"tick {tick}, state {state}")
                compared += 1
                moved.add(tuple(angles))
        print(f"{track.name}, {' '.join(settings)}: {len(log)} ticks, {compared} ANGLES the same, {len(moved)} of them "
              "different", flush=True)
        self.assertGreater(compared, 0.09 * len(log))  # one in ten ticks has ANGLES
        self.assertGreater(len(moved), 0.3 * compared)  # a rod that stood still would prove nothing

    @again_if_too_busy
    def test_noise_between_the_frames_and_in_them(self):
        rng = random.Random(4)
        self.boot()
        for _ in range(20):
            self.line.device.sendall(rng.randbytes(1000))
            time.sleep(0.02)
        told = self.good_json("info")
        self.assertEqual(told["state"], "DISARMED")
        counters = told["counters"]
        self.assertGreater(sum(counters[f"frames_{fate}"] for fate in ("crc", "cobs", "too_short", "too_long")), 50)

        def spoil(data):
            return bytes(b ^ 1 << rng.randrange(8) if rng.random() < 0.0005 else b for b in data)
        self.good("params", "set", "pose_hold=200")
        self.line.spoil = spoil
        poses = self.stream(self.track())["poses"]
        self.line.spoil = None
        self.assertTrue(poses["balances"])
        self.assertGreater(poses["lost"], 0)
        self.assertGreater(poses["accepted"], 0.8 * poses["sent"])

    def test_silence_ends_in_limp(self):
        self.wait_for_state("DISARMED")
        start = len(self.line.frames)
        tool = self.start_stream()
        self.wait_for_state("ACTIVE", after=start)
        tool.kill()  # without a word
        tool.wait()
        self.wait_for_state("LIMP", after=start, seconds=15)
        states = [line_log.angles(payload)[:2] for payload in self.line.of(line_log.ANGLES, start)]
        self.assertEqual(self.states_in_order(states), ["DISARMED", "ARMING", "ACTIVE", "HOLD", "RELAX", "LIMP"])
        in_state = {name: sum(line_log.STATES[state] == name for _, state in states) * 10 for name in ("HOLD", "RELAX")}
        self.assertTrue(450 <= in_state["HOLD"] <= 600, in_state)  # ms; ANGLES come every 10
        self.assertTrue(1950 <= in_state["RELAX"] <= 5100, in_state)
        beat = line_log.heartbeat(self.line.of(line_log.HEARTBEAT)[-1])
        self.assertFalse(beat["torque"])

    def replay(self, settings, log):
        """tick -> bits of all angles, on this machine."""
        lines = "".join(f"{tick} {state} {flags} {' '.join(f'{b:x}' for b in bits)}\n"
                        for tick, state, flags, bits in log)
        numbers = [text.replace("=elastic", "=1") for text in settings]
        told = self.run_program(firmware_case.choices.replay, *numbers, text=lines)
        return {int(words[0]): [int(word, 16) for word in words[1:]] for words in map(str.split, told.splitlines())}


if __name__ == "__main__":
    firmware_case.main()
