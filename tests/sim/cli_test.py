#!/usr/bin/env python3
"""The command line of limber-sim as a contract: exit codes, one line for what is wrong, and help."""
import os
import pty
import resource
import subprocess
import unittest

import sim_case
from sim_case import TRACK, SimCase

BAD_TRACKS = {  # name: content, what the line says beside the file's name
    "empty.txt": ("", "no samples"),
    "comments.txt": ("# a\n# b\n", "no samples"),
    "binary.txt": (b"\x7fELF\x02\x01\x01\x00", ":1: not a text file"),
    "nul.txt": (b"1 0 0 0 0 0 0 1\n2 0 \x00 0 0 0 0 1\n", ":2: not a text file"),
    "short.txt": ("1 0 0 0 0 0 0 1\n2 0 0 0\n", ":2: 4 columns where 8 are expected"),
    "long.txt": ("1 0 0 0 0 0 0 1\n" + "2" * 5000, ":2: longer than 4095"),
    "words.txt": ("1 0 0 0 0 0 0 1\n2 zero 0 0 0 0 0 1\n", ":2: tx is not a number: 'zero'"),
    "nan.txt": ("1 nan 0 0 0 0 0 1\n", ":1: tx is not a finite"),
    "huge.txt": ("1 0 0 1e999 0 0 0 1\n", ":1: tz is not a finite"),
    "back.txt": ("2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", ":2: time runs backwards"),
    "far.txt": ("1 0 0 0 0 0 0 1\n2 5000 0 0 0 0 0 1\n", ":2: 5000 m away"),
    "zeros.txt": ("1 0 0 0 0 0 0 0\n", "every quaternion is all zeros"),
    "ages.txt": ("0 0 0 0 0 0 0 1\n1.5e9 0 0 0 0 0 0 1\n", "too many to keep"),
    "aeons.txt": ("0 0 0 0 0 0 0 1\n1e18 0 0 0 0 0 0 1\n", "too many to keep"),
    "header.csv": ("t,x,y,z,qx,qy,qz\n1,0,0,0,0,0,0\n", ":1: the header has no column for qw"),
    "bare.csv": ("1,0,0,0,0,0,0,1\n", ":1: comma-separated, but no header"),
    "escape.txt": (b"1 0 0 0 0 0 0 \x1b[31mred\n", ":1: not a text file"),
    "latin.txt": (b"1 0 0 0 0 0 0 \xe9t\xe9\n", ":1: qw is not a number"),
}
BAD_INI = {
    "empty.ini": ("", "empty"),
    "key.ini": ("[rod]\nlinks = 4\nsprung = 1\n", ":3: unknown key 'sprung'"),
    "device.ini": ("[rod]\nservo_kind = bus\nservo_kid = bus\n", ":3: unknown key 'servo_kid'"),
    "section.ini": ("[rods]\nlinks = 4\n", ":2: 'links' stands in section [rods]"),
    "number.ini": ("[rod]\nspring = soft\n", ":2: spring = soft: not a number"),
    "bounds.ini": ("[rod]\nspring = -1\n", ":2: spring = -1: out of bounds, must be 0 ... 1e+06 N m"),
    "list.ini": ("[rod]\nspring = 1 2 3\n", ":2: spring has 3 values for 4 links"),
    "damper.ini": ("[rod]\ndamper = 401\n", ":2: drag + damper of joint 1 is 401"),
    "line.ini": ("[rod]\nlinks\n", ":2: neither a [section], a key = value nor a comment"),
    "binary.ini": (b"[rod]\n\x00\x01", ":2: not a text file"),
    "long.ini": ("[rod]\nspring = " + "1 " * 200, ":2: longer than 198 characters"),
}
BAD_OPTIONS = [  # arguments after the track, what the line says
    (["--rate", "9"], "--rate 9: must be a number from 10 to 20000"),
    (["--rate", "20001"], "must be a number"), (["--rate", "1e3x"], "must be a number"),
    (["--rate", "nan"], "must be a number"), (["--rate", ""], "must be a number"),
    (["--rate"], "--rate"), (["--rat", "100"], "--rat: unknown option"),
    (["--up", "x"], "--up x: must be y or z"), (["--scale", "0"], "--scale 0: must be"),
    (["--scale", "-1"], "--scale -1"), (["--max-speed", "0"], "--max-speed 0: must be"),
    (["--left-handed=1"], "--left-handed"), (["--preset", "sword"], "there are foil, whip, ribbon"),
    (["--model", "rubber"], "model = rubber: must be contour or elastic"),
    (["--set", "spring"], "--set spring: must be key=value"), (["--set", "tick=1"], "set by --rate"),
    (["--set", "hold=3"], "hold = 3: out of bounds, must be 1 ... 2"),
    (["--set", "mass=1"], "--set mass: the contour model does not read it"),
    (["--model", "elastic", "--set", "coupling=1"], "--set coupling: the elastic model does not read it"),
    (["--model", "elastic", "--set", "mass=0"], "mass = 0: out of bounds, must be 1e-06 ... 1000 kg"),
    (["--set", "servo_kind=bus"], "unknown key 'servo_kind'"),
    (["--set", "scheme=euler"], "must be midpoint or paper"),
    (["--set", "links=65"], "out of bounds, must be 1 ... 64"),
    (["--set", "spring=1,2"], "spring has 2 values for 4 links"),
    (["--set", "damper=401"], "at most 400 is allowed"),
    (["--expect-hash", "123"], "must be the 16 hexadecimal digits"),
    (["--expect-hash", "0x23456789abcdef"], "must be the 16 hexadecimal digits"),
    (["--params", "no-such.ini"], "no-such.ini: No such file"), (["--params", "."], "Is a directory"),
    (["--params", "good.ini", "--preset", "foil"], "--params and --preset: give one of them"),
    (["second.txt"], "one track at a time, but there is also 'second.txt'"),
    (["--set", "spri\nng=1"], "unknown key 'spri?ng'"),
]


class Refusals(SimCase):
    def outputs(self):
        """Options for every kind of file; one of them is there already and must survive."""
        self.write("angles.csv", "mine\n")
        return ["--angles", "angles.csv", "--nodes", "nodes.csv", "--report", "report.html",
                "--picture", "picture.svg", "--capsule", "capsule"]

    def test_tracks(self):
        outputs = self.outputs()
        for name, (content, says) in BAD_TRACKS.items():
            self.write(name, content)
            self.refused(["replay", name, *outputs], f"{name}: " if says[0] != ":" else name, says)
        self.refused(["replay", "no-such.txt", *outputs], "no-such.txt: No such file")
        self.refused(["replay", ".", *outputs], ".: cannot be read: Is a directory")
        self.refused(["replay", "/dev/zero", *outputs], "/dev/zero:1: not a text file")

    def test_parameter_files(self):
        outputs = self.outputs()
        for name, (content, says) in BAD_INI.items():
            self.write(name, content)
            self.refused(["replay", self.track, "--params", name, *outputs], name, says)

    def test_options(self):
        outputs = self.outputs()
        self.write("good.ini", "[rod]\nlinks = 4\n")
        for arguments, says in BAD_OPTIONS:
            self.refused(["replay", self.track, *outputs, *arguments], says)
        self.refused(["replay", *outputs], "no track given")

    def test_other_commands(self):
        self.refused([], "no command given")
        self.refused(["play"], "unknown command 'play'")
        self.refused(["--verbose"], "unknown command '--verbose'")
        for arguments, says in ((["--preset", "sword"], "no such preset"), (["--set", "spring=x"], "not a number"),
                                (["--model", "rubber"], "--model: model = rubber: must be contour or elastic"),
                                (["foil"], "unexpected 'foil'"), (["--rate", "5"], "--rate: unknown option"),
                                (["--set", "spring=1,2"], "2 values for 4 links")):
            self.refused(["params", *arguments], says)
        self.refused(["tracks"], "no folder given")
        self.refused(["tracks", "a", "b"], "one folder at a time")
        self.refused(["tracks", "--all", "a"], "--all: unknown option")
        self.refused(["tracks", "no/such/place"], "no/such/place: No such file")
        self.refused(["tracks", "track.txt"], "Not a directory")
        (self.folder / "taken" / "star.txt").mkdir(parents=True)
        self.refused(["tracks", "taken"], "star.txt: cannot be written: Is a directory")
        self.assertEqual(len(list((self.folder / "taken").iterdir())), 1)

    def test_outputs_that_cannot_be_written(self):
        (self.folder / "folder").mkdir()
        for option in ("--angles", "--nodes", "--report", "--picture", "--capsule"):
            self.refused(["replay", "track.txt", option, "no-such/out"], "no-such/out: cannot be written: No such file")
            self.refused(["replay", "track.txt", option, "folder"], "folder: cannot be written: Is a directory")
            self.refused(["replay", "track.txt", option, "track.txt/x"], "Not a directory")
            self.refused(["replay", "track.txt", option, ""], "cannot be written")
        self.refused(["replay", "track.txt", "--angles", "/dev/full"], "No space left on device")
        self.refused(["replay", "track.txt", "--angles", "a.csv", "--nodes", "a.csv"], "a.csv: is to be written twice")
        # all files or none, and not the one that was there before
        outputs = self.outputs()
        for k in range(1, len(outputs), 2):
            arguments = list(outputs)
            arguments[k] = "no-such/" + arguments[k]
            self.refused(["replay", "track.txt", *arguments], f"{arguments[k]}: cannot be written")

    def test_what_others_may_not_touch(self):
        if os.geteuid() != 0:
            nobody = {}
        elif subprocess.run(["true"], user=65534, check=False).returncode == 0 and self.nobody_can_run():
            nobody = {"user": 65534, "group": 65534, "extra_groups": []}
        else:
            self.skipTest("root reads everything, and nobody cannot run the program")
        nobody["env"] = {**os.environ, "GCOV_ERROR_FILE": os.devnull}  # a coverage build's counts stay root's
        self.track.chmod(0)
        self.refused(["replay", "track.txt"], "track.txt: Permission denied", **nobody)
        self.track.chmod(0o644)
        shut = self.folder / "shut"
        shut.mkdir(mode=0o555)
        self.refused(["replay", "track.txt", "--angles", "shut/a.csv"], "Permission denied", **nobody)
        self.assertEqual(list(shut.iterdir()), [])

    def nobody_can_run(self):
        for folder in (self.home, self.folder):
            folder.chmod(0o755)
        try:
            return subprocess.run([sim_case.SIM, "--version"], user=65534, capture_output=True, check=False).returncode == 0
        except OSError:
            return False

    def test_names_of_any_kind(self):
        names = ["a b.txt", "new\nline.txt", "\x1b[31mred.txt", "%s%n%d.txt", "--odd.txt", "'\"<script>alert(1).txt",
                 "ü€😀.txt", b"\xff\xfe.txt", "x" * 250]
        lines = self.good("replay", self.track, "--report", "report.html").count("\n")
        for name in names:
            path = self.folder / os.fsdecode(name)
            path.write_text("1 0 0 0 0 0 0\n", encoding="ascii")
            self.refused(["replay", path], ":1: 7 columns where 8 are expected")
            path.write_text(TRACK, encoding="ascii")
            out = self.good("replay", path, "--report", "report.html")
            self.assertEqual(out.count("\n"), lines, name)
            self.assertNotRegex(out, r"[^\n\x20-\x7e\x80-\U0010ffff]")
            self.assertNotIn(b"<script>alert(1)", (self.folder / "report.html").read_bytes())
        self.refused(["replay", "--odd.txt"], "unknown option")
        self.good("replay", "--", "--odd.txt")


class ExitCodes(SimCase):
    def test_fine_and_differing_hash(self):
        plain = self.good("replay", self.track)
        own = sim_case.hash_in(plain)
        self.assertIn("30 samples, 0.290 s, 100.0 a second", plain)
        for same in (own, own.upper()):
            self.assertEqual(self.replay_hash(self.track, "--expect-hash", same), own)
        other = f"{int(own, 16) ^ 1:016x}"
        done = self.sim("replay", self.track, "--expect-hash", other, "--angles", "angles.csv")
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stderr, f"limber-sim: the hash differs: {own}, expected {other}\n")
        self.assertEqual(sim_case.hash_in(done.stdout), own)
        self.assertIn("angles.csv", self.files())  # to find out where it differs

    def test_out_of_memory_is_no_ones_fault(self):
        with open(sim_case.SIM, "rb") as program:
            if b"__asan_init" in program.read():
                self.skipTest("the address sanitizer needs all of the address space")
        track = self.write("hours.txt", "0 0 0 0 0 0 0 1\n25000 0 0 0 0 0 0 1\n")
        done = self.sim("replay", track, "--angles", "angles.csv",
                        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (300_000_000,) * 2))
        self.assertEqual((done.returncode, done.stdout), (3, ""))
        self.assertRegex(done.stderr, r"\Alimber-sim: out of memory.*\n\Z")
        self.assertEqual(set(self.files()), {"track.txt", "hours.txt"})

    def test_help_has_examples(self):
        self.assertIn("Commands:", self.good("--help"))
        self.assertEqual(self.good("-h"), self.good("help"))
        self.assertRegex(self.good("--version"), r"\Alimber-sim \d+\.\d+\.\d+\n\Z")
        for command in ("replay", "params", "tracks"):
            for option in ("--help", "-h"):
                text = self.good(command, option)
                self.assertIn(f"Usage: limber-sim {command}", text)
                self.assertIn(f"\nExamples:\n  limber-sim {command} ", text)
                self.assertLessEqual(max(map(len, text.splitlines())), 100)
        self.good("replay", "--help", "--rate", "x")  # the first one counts

    def test_a_full_disk_on_stdout_is_told(self):
        for arguments in (["params"], ["--help"], ["replay", self.track], ["tracks", "t"]):
            with open("/dev/full", "w", encoding="ascii") as full:
                done = subprocess.run([sim_case.SIM, *map(str, arguments)], stdout=full, stderr=subprocess.PIPE,
                                      text=True, cwd=self.folder, check=False)
            self.assertEqual((done.returncode, done.stderr),
                             (2, "limber-sim: the standard output cannot be written\n"))

    def test_progress_only_on_a_terminal(self):
        track = self.write("minute.txt", "".join(f"{0.2 * n:.1f} 0 0 0 0 0 0 1\n" for n in range(301)))
        arguments = ["replay", track, "--set", "links=64"]
        self.good(*arguments)  # nothing on stderr
        leader, terminal = pty.openpty()
        subprocess.run([sim_case.SIM, *map(str, arguments)], stdout=subprocess.DEVNULL, stderr=terminal, check=True)
        os.close(terminal)
        shown = b""
        try:
            while part := os.read(leader, 65536):
                shown += part
        except OSError:
            pass  # Linux: the other end is closed
        os.close(leader)
        self.assertIn(b"50 %", shown)
        self.assertTrue(shown.endswith(b"\r\x1b[K"), shown[-20:])


if __name__ == "__main__":
    sim_case.main()
