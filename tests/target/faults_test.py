#!/usr/bin/env python3
"""What goes wrong inside the board, provoked in the image that is flashed: each ends in a restart that tells why, with
nothing armed. And how deep the stack really gets.
"""
import pathlib
import sys

import firmware_case
import line_log
from emulated import PC, SP
from firmware_case import FirmwareCase, again_if_too_busy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools" / "firmware"))
import elf  # noqa: E402  (where they are found must be said first)
import report  # noqa: E402
import stack  # noqa: E402

CANARY, WATCHDOG, PROCESSOR = 3, 4, 11  # fault codes, PROTOCOL.md
BY_FAULT_HANDLER = 4  # reset cause
NOWHERE = 0x30000000  # no memory there
MMARVALID_DACCVIOL, MSTKERR = 0x82, 0x10  # of CFSR: ARMv7-M ARM, B3.2.15
PATTERN = 0xC5


class Faults(FirmwareCase):
    def setUp(self):
        super().setUp()
        self.image = firmware_case.choices.elf
        self.symbols = elf.symbols(self.image)
        self.boot()
        self.wait_for_state("DISARMED")

    def at_start_of_tick(self, gdb):
        """Interrupts are on there, and the stack is nearly empty."""
        gdb.run_to(self.symbols["device_tick"])

    def restart(self, change):
        """Lets change(gdb) loose on the halted board; returns the BOOT_REPORT that comes of it."""
        start = len(self.line.frames)
        with self.board.debugger() as gdb:
            self.at_start_of_tick(gdb)
            change(gdb)
        told = line_log.boot_report(self.line.wait_for(line_log.BOOT_REPORT, after=start))
        start = self.line.end_of_last(line_log.BOOT_REPORT)
        beat = line_log.heartbeat(self.line.wait_for(line_log.HEARTBEAT, after=start, good=lambda payload: (
            line_log.heartbeat(payload)["state"] not in ("BOOT", "SELFTEST"))))
        self.assertEqual((beat["state"], beat["torque"], beat["fault"]), ("FAULT", False, told["fault"]))
        return told

    def can_be_cleared(self):
        self.good("clear")
        self.assertEqual(self.good_json("info")["state"], "DISARMED")

    def test_a_jump_into_nowhere(self):
        told = self.restart(lambda gdb: gdb.set_register(PC, NOWHERE))
        self.assertEqual((told["cause"], told["fault"]), (BY_FAULT_HANDLER, PROCESSOR))
        self.assertEqual(told["pc"], NOWHERE)
        self.assertNotEqual(told["cfsr"], 0)
        boot = self.good_json("info")["boot"]  # the tool tells the same
        self.assertEqual((boot["cause"], boot["fault"], boot["pc"]), ("PROCESSOR", "PROCESSOR", NOWHERE))
        self.can_be_cleared()

    def test_a_jump_into_nowhere_while_it_follows(self):
        tool = self.start_stream()
        self.wait_for_state("ACTIVE")
        told = self.restart(lambda gdb: gdb.set_register(PC, NOWHERE))
        self.assertEqual((told["cause"], told["fault"]), (BY_FAULT_HANDLER, PROCESSOR))
        self.assertEqual(tool.wait(timeout=30), 4)
        self.assertEqual(self.good_json("info")["state"], "FAULT")
        self.assertEqual(self.limber("stream", self.track())[0], 4)  # and it does not arm again by itself

    def test_the_stack_runs_into_its_guard(self):
        told = self.restart(lambda gdb: gdb.set_register(SP, self.symbols["stack_bottom"] + 128))
        self.assertEqual((told["cause"], told["fault"]), (BY_FAULT_HANDLER, CANARY))
        self.assertTrue(told["cfsr"] & (MMARVALID_DACCVIOL | MSTKERR), hex(told["cfsr"]))
        self.can_be_cleared()

    def test_the_main_loop_does_not_come_round(self):
        image = elf.functions(self.image)
        forever = next(i.address for some in image.values() for i in some
                       if i.mnemonic.startswith("b.") and i.operands.startswith(f"{i.address:x} "))
        told = self.restart(lambda gdb: gdb.set_register(PC, forever))
        self.assertEqual((told["cause"], told["fault"], told["pc"]), (BY_FAULT_HANDLER, WATCHDOG, forever))
        self.can_be_cleared()

    def test_the_stacks_pattern_is_broken(self):
        """Something wrote over the end of the stack without touching the guard."""
        start = len(self.line.frames)
        with self.board.debugger() as gdb:
            gdb.write(self.symbols["stack_bottom"], b"\0" * 4)
        self.line.wait_for(line_log.FAULT, lambda payload: payload[0] == CANARY, after=start)
        self.wait_for_state("FAULT", after=start)

    def test_a_restart_that_was_asked_for_is_no_fault(self):
        start = len(self.line.frames)
        with self.board.debugger() as gdb:  # what hal.reboot comes to
            self.at_start_of_tick(gdb)
            gdb.set_register(PC, self.symbols["reboot"])
        told = line_log.boot_report(self.line.wait_for(line_log.BOOT_REPORT, after=start))
        self.assertEqual((told["cause"], told["fault"], told["pc"]), (2, 0, 0))
        self.wait_for_state("DISARMED", after=start)

    def test_flash_that_does_not_take_what_is_written(self):
        """Nothing behind it is modelled: every write reads back wrong."""
        code, _, err = self.limber("params", "save")
        self.assertEqual(code, 4)
        self.assertIn("flash", err)
        told = self.good_json("info")
        self.assertEqual((told["state"], told["fault"]), ("FAULT", "FLASH"))
        self.can_be_cleared()

    @again_if_too_busy
    def test_the_stack_stays_within_what_the_report_foresees(self):
        graph = stack.Graph(self.image, firmware_case.choices.build, report.ROOT)
        handlers = {name for name in elf.vectors(self.image)[1] if name}
        (most, _), interrupts = stack.worst(graph, handlers, report.OWN_STACK)
        most += sum(bytes_n for bytes_n, _ in interrupts)
        bottom, top = self.symbols["stack_bottom"], self.symbols["stack_top"]
        self.boot()
        with self.board.debugger() as gdb:
            self.at_start_of_tick(gdb)
            free = range(bottom + 64, gdb.register(SP) - 64)  # the board's own pattern stays
            gdb.write(free.start, bytes([PATTERN]) * len(free))
        self.exercise()
        with self.board.debugger() as gdb:
            memory = gdb.read(free.start, len(free))
        used = top - free.start - (len(memory) - len(memory.lstrip(bytes([PATTERN]))))
        print(f"stack: {used:,} bytes used, {most:,} foreseen, {top - bottom:,} there", flush=True)
        self.assertLessEqual(used, most)
        self.assertGreater(used, 0.3 * most)  # or nothing much was tried

    def exercise(self):
        self.good("params", "list")
        self.good("params", "defaults")
        self.good("params", "set", "links=64", "spring=2000")
        self.good("preset", "whip")
        self.good("params", "set", "links=64", "spring=2000", "smoothing=50", "nodes_rate=10", "pose_hold=200")
        self.stream(self.track())
        self.limber("params", "save")  # fails here: see above


if __name__ == "__main__":
    firmware_case.main()
