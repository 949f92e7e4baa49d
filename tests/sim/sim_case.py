"""What the tests of limber-sim's command line share: a folder of its own for every test, and the tool."""
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SIM = None  # path of limber-sim, the first argument of the test program
TRACK = "".join(f"{0.01 * n:.2f} {0.002 * n * n:.6f} 0 0 0 0 0 1\n" for n in range(30))


def hash_in(text):
    """The hash that a replay prints last."""
    return re.search(r"^hash +([0-9a-f]{16})$", text, re.MULTILINE).group(1)


def columns(path):
    """A CSV file as (names, rows of texts)."""
    lines = Path(path).read_text(encoding="ascii").splitlines()
    return lines[0].split(","), [line.split(",") for line in lines[1:]]


class SimCase(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.home = Path(tempfile.mkdtemp(prefix="limber-test-"))
        cls.addClassCleanup(shutil.rmtree, cls.home)
        cls.tracks = cls.home / "tracks"
        subprocess.run([SIM, "tracks", cls.tracks], check=True, stdout=subprocess.DEVNULL)

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(dir=self.home))
        self.track = self.write("track.txt", TRACK)

    def write(self, name, content):
        path = self.folder / name
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    def files(self):
        """Everything in the test's folder, with its content."""
        return {path.name: path.read_bytes() if path.is_file() else None for path in self.folder.iterdir()}

    def sim(self, *arguments, **options):
        return subprocess.run([SIM, *map(str, arguments)], capture_output=True, text=True, errors="replace",
                              cwd=self.folder, timeout=120, **options)

    def good(self, *arguments, **options):
        """Runs, expects it to go well and say nothing on stderr; returns stdout."""
        done = self.sim(*arguments, **options)
        self.assertEqual((done.returncode, done.stderr), (0, ""), arguments)
        return done.stdout

    def refused(self, arguments, *says, **options):
        """Runs and expects a refusal: exit code 2, one line that says so, and nothing else changed."""
        before = self.files()
        done = self.sim(*arguments, **options)
        self.assertEqual((done.returncode, done.stdout), (2, ""), (arguments, done.stderr))
        self.assertRegex(done.stderr, r"\Alimber-sim: [^\x00-\x1f\x7f]+\n\Z", arguments)
        for words in says:
            self.assertIn(words, done.stderr, arguments)
        self.assertEqual(self.files(), before, arguments)

    def replay_hash(self, *arguments):
        return hash_in(self.good("replay", *arguments))


def main():
    global SIM
    if len(sys.argv) < 2:
        sys.exit(f"usage: {Path(sys.argv[0]).name} LIMBER_SIM [UNITTEST_ARGUMENT...]")
    SIM = str(Path(sys.argv.pop(1)).resolve())
    unittest.main(module="__main__")
