#!/usr/bin/env python3
"""tools/dev flash, with tools that only write down how they were called, and USB devices made of files; and what
tools/dev builds before it flashes, boots an image or helps."""
import contextlib
import io
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

TOOLS = pathlib.Path(__file__).resolve().parents[2] / "tools"
sys.path.insert(0, str(TOOLS / "firmware"))
import flash  # noqa: E402  (where it is found must be said first)

ST_LINK, DFU, OLIMEX = ("0483", "374b"), ("0483", "df11"), ("15ba", "002b")


class Flash(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        for name in ("bin", "usb", "dev"):
            (self.folder / name).mkdir()
        self.image = self.folder / "image.bin"
        self.image.write_bytes(bytes(80000))
        for patch in (mock.patch.object(flash, "USB", self.folder / "usb"),
                      mock.patch.object(flash, "DEVICES", self.folder / "dev"),
                      mock.patch.dict("os.environ", PATH=str(self.folder / "bin"))):
            patch.start()
            self.addCleanup(patch.stop)

    def install(self, *names, status=0):
        for name in names:
            tool = self.folder / "bin" / name
            tool.write_text(f"#!/bin/sh\necho {name} \"$@\" >>{self.folder}/called\nexit {status}\n")
            tool.chmod(0o755)

    def plug_in(self, *devices):
        for number, (vendor, product) in enumerate(devices):
            device = self.folder / "usb" / f"1-{number}"
            device.mkdir()
            (device / "idVendor").write_text(vendor + "\n")
            (device / "idProduct").write_text(product + "\n")

    def flash(self, *words):
        """(exit code, what was said, what was called)"""
        said = io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            code = flash.main(["--image", str(self.image), *words])
        called = self.folder / "called"
        return code, said.getvalue(), called.read_text().strip() if called.exists() else ""

    def test_a_debug_probe_comes_first(self):
        self.install("st-flash", "openocd", "dfu-util", "stm32flash")
        self.plug_in(DFU, ST_LINK)
        code, said, called = self.flash()
        self.assertEqual((code, called), (0, f"st-flash --reset write {self.image} 0x8000000"))
        self.assertIn(called, said)  # it says exactly what it runs

    def test_what_is_connected_counts_and_not_only_what_is_installed(self):
        self.install("st-flash", "openocd", "dfu-util")
        self.plug_in(DFU)
        self.assertEqual(self.flash()[2], f"dfu-util -d 0483:df11 -a 0 -s 0x8000000:leave -D {self.image}")

    def test_openocd_where_st_flash_is_missing_and_for_the_makers_own_probe(self):
        self.install("openocd")
        self.plug_in(ST_LINK)
        self.assertIn("interface/stlink.cfg", self.flash("--dry-run")[1])
        (self.folder / "usb" / "1-0" / "idVendor").write_text(OLIMEX[0])
        (self.folder / "usb" / "1-0" / "idProduct").write_text(OLIMEX[1])
        self.assertIn("interface/ftdi/olimex-arm-usb-ocd-h.cfg", self.flash()[2])

    def test_only_the_sectors_that_the_image_fills_are_erased(self):
        self.install("stm32flash")
        for bytes_n, sectors_n in ((1, 1), (16384, 1), (16385, 2), (65536, 4), (80000, 5), (131073, 6), (786432, 10)):
            self.image.write_bytes(bytes(bytes_n))
            said = self.flash("--port", "/dev/ttyUSB7", "--dry-run")[1]
            self.assertIn(f" -e {sectors_n} ", said)
            self.assertIn("/dev/ttyUSB7", said)

    def test_an_image_that_reaches_the_settings_is_refused(self):
        self.install("st-flash")
        self.plug_in(ST_LINK)
        self.image.write_bytes(bytes(786433))
        code, said, called = self.flash()
        self.assertEqual((code, called), (1, ""))
        self.assertIn("settings", said)

    def test_the_only_serial_port_will_do_but_not_one_of_two(self):
        self.install("stm32flash")
        (self.folder / "dev" / "ttyUSB0").touch()
        self.assertIn(f"{self.folder}/dev/ttyUSB0", self.flash()[2])
        (self.folder / "dev" / "ttyACM1").touch()
        code, said, _ = self.flash()
        self.assertEqual(code, 1)
        self.assertIn("--port", said)

    def test_a_serial_port_is_for_the_serial_tool(self):
        self.install("st-flash", "openocd", "dfu-util", "stm32flash")
        for tool in ("st-flash", "openocd", "dfu-util"):
            code, said, called = self.flash("--with", tool, "--port", "/dev/ttyUSB7")
            self.assertEqual((code, called, said.count("\n")), (1, "", 1))
            self.assertIn("--port /dev/ttyUSB7 is for stm32flash", said)
        self.assertIn("/dev/ttyUSB7", self.flash("--with", "stm32flash", "--port", "/dev/ttyUSB7")[2])

    def test_nothing_is_run_dry(self):
        self.install("dfu-util")
        code, said, called = self.flash("--with", "dfu-util", "--dry-run")
        self.assertEqual((code, called), (0, ""))
        self.assertIn("dfu-util -d", said)

    def test_what_to_do_where_nothing_is_there(self):
        code, said, _ = self.flash()
        self.assertEqual(code, 1)
        for word in ("BOOT0", "apt install stlink-tools", "apt install dfu-util", "PA10"):
            self.assertIn(word, said)
        self.plug_in(DFU)
        self.assertIn("no dfu-util: sudo apt install dfu-util", self.flash()[1])
        self.image.unlink()
        self.assertIn("tools/dev firmware", self.flash()[1])

    def test_a_tool_that_fails_fails_the_command(self):
        self.install("dfu-util", status=74)
        self.plug_in(DFU)
        code, said, _ = self.flash()
        self.assertEqual(code, 1)
        self.assertIn("dfu-util failed", said)


class Dev(unittest.TestCase):
    """tools/dev in a folder of its own, where its set-up, CMake and Python only write down how they were called."""

    SETUP = """SKIPPED_TIERS=()
QEMU_SYSTEM_ARM=qemu
setup() { echo "setup $*" >>called; }
"""
    STUB = "#!/bin/sh\necho \"${0##*/} $*\" >>called\n"
    IMAGE = ["setup demo target firmware", "cmake --preset stm32f405",
             "cmake --build build/stm32f405 --target limber-stm32f405", "python3 -B tools/firmware/report.py"]
    HOST = ["setup demo host target", "cmake --preset host", "cmake --build build/host",
            "cmake --build build/host --target limber limber-sim"]

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        for name in ("tools", "bin", "build/stm32f405", "build/host"):
            (self.folder / name).mkdir(parents=True)
        shutil.copy(TOOLS / "dev", self.folder / "tools")
        (self.folder / "CMakePresets.json").touch()
        (self.folder / "tools" / "setup.sh").write_text(self.SETUP)
        for name in ("bin", "elf"):  # of an earlier build
            (self.folder / "build" / "stm32f405" / f"limber-stm32f405.{name}").touch()
        self.stand_in("cmake")
        self.stand_in("python3")

    def stand_in(self, name, more=""):
        path = self.folder / "bin" / name
        path.write_text(self.STUB + more)
        path.chmod(0o755)

    def dev(self, *words):
        """(exit code, stdout, what was called)"""
        called = self.folder / "called"
        called.unlink(missing_ok=True)
        done = subprocess.run([self.folder / "tools" / "dev", *words], capture_output=True, text=True, check=False,
                              env={"PATH": f"{self.folder}/bin:/usr/bin:/bin"}, timeout=30)
        return done.returncode, done.stdout, called.read_text().splitlines() if called.exists() else []

    def calls(self, expected, *words):
        code, _, called = self.dev(*words)
        self.assertEqual((code, len(called)), (0, len(expected)), called)
        for line, start in zip(called, expected):
            self.assertTrue(line.startswith(start), (line, start))

    def test_what_is_flashed_or_booted_is_built_first(self):
        self.calls([*self.IMAGE, "python3 -B tools/firmware/flash.py --dry-run"], "flash", "--dry-run")
        image = [self.IMAGE[0], *self.IMAGE[2:]]  # configured before
        self.calls([*image, *self.HOST, "python3 -B tools/firmware/qemu.py --qemu qemu --links 5"],
                   "qemu", "--links", "5")

    def test_but_not_an_image_of_ones_own(self):
        self.calls(["python3 -B tools/firmware/flash.py --image mine.bin"], "flash", "--image", "mine.bin")
        self.calls(["python3 -B tools/firmware/flash.py --image=mine.bin"], "flash", "--image=mine.bin")
        self.calls([*self.HOST, "python3 -B tools/firmware/qemu.py --qemu qemu --elf mine.elf"],
                   "qemu", "--elf", "mine.elf")

    def test_nothing_is_flashed_or_booted_after_a_build_that_failed(self):
        self.stand_in("cmake", 'test "$1" != --build\n')
        for command in ("flash", "qemu"):
            code, _, called = self.dev(command)
            self.assertNotEqual(code, 0)
            self.assertTrue(called[-1].startswith("cmake --build build/stm32f405"), called)

    def test_help_sets_up_and_builds_nothing(self):
        for command in ("flash", "qemu"):
            for word in ("--help", "-h"):
                self.calls([f"python3 -B tools/firmware/{command}.py {word}"], command, word)
        code, said, called = self.dev("firmware", "--help")
        self.assertEqual((code, called), (0, []))
        self.assertIn("usage: tools/dev firmware", said)


if __name__ == "__main__":
    unittest.main()
