#!/usr/bin/env python3
"""Damages track and parameter files at random and replays them: limber-sim refuses with exit code 2, one line and no
output, or goes through with finite angles inside the stops (elastic has none: half a turn). Anything else is a find: the
damaged files are kept.

    mutate_test.py LIMBER_SIM [--seconds 20] [--seed 1] [--keep FOLDER]
"""
import argparse
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

TIMEOUT_S = 60  # a run of the longest track that is still taken, under the sanitizers
NUMBERS = [b"nan", b"-inf", b"1e999", b"-1e999", b"1e-999", b"0", b"-0", b"1e18", b"-1e18", b"1e19", b"1e308", b"0x1p-3",
           b"1e", b"--1", b"+", b".", b"", b"9" * 400, b"0." + b"0" * 400 + b"1", b"1,5", b"9223372036854775807",
           b"9223372036854775808", b"-1", b"0.1", b"1000", b"1e-7", b"4", b"64", b"65", b"2147483648"]
PIECES = [b"\x00", b"\xff\xfe", b"\xef\xbb\xbf", b"\r", b"\n", b"\t", b" ", b",", b"#", b";", b"=", b"[", b"]", b"[rod]", b"\\",
          b"%n%s", b"\x1b[31m", b"x" * 300, b" " * 5000, b"1 " * 300, b"\xc3\xa9", b"timestamp", b"nan", b"[ns]", b"[mm]"]
KEYS = [b"model", b"scheme", b"links", b"hold", b"length", b"inertia", b"drag", b"coupling", b"smoothing", b"spring",
        b"damper", b"limit", b"tick", b"mass", b"gravity"]


def mutate(data, rng):
    """One damage of a file."""
    lines, i = data.split(b"\n"), 0
    if lines:
        i = rng.randrange(len(lines))
    kind = rng.randrange(14)
    if kind == 0 and data:                                  # one bit
        k = rng.randrange(len(data))
        return data[:k] + bytes([data[k] ^ 1 << rng.randrange(8)]) + data[k + 1:]
    if kind == 1:                                           # a piece put in anywhere
        k = rng.randrange(len(data) + 1)
        return data[:k] + rng.choice(PIECES) + data[k:]
    if kind == 2:                                           # cut off, or the beginning lost
        k = rng.randrange(len(data) + 1)
        return data[:k] if rng.random() < 0.7 else data[k:]
    if kind == 3:
        return data.replace(*rng.choice([(b"\n", b"\r\n"), (b"\n", b"\r"), (b" ", b","), (b",", b" "), (b" ", b"\t"),
                                         (b".", b","), (b"=", b":"), (b"\n", b"\n "), (b"\n", b"")]))
    if kind == 4:                                           # lines lost, repeated, swapped, moved
        del lines[i]
    elif kind == 5:
        lines[i:i] = [lines[i]] * rng.choice((1, 2, 100))
    elif kind == 6:
        k = rng.randrange(len(lines))
        lines[i], lines[k] = lines[k], lines[i]
    elif kind == 7:
        lines.insert(i, rng.choice(KEYS) + b" = " + b" ".join(rng.choice(NUMBERS) for _ in range(rng.choice((1, 1, 4, 64)))))
    elif kind == 8:
        lines[i] = b" " * rng.choice((1, 4)) + lines[i]
    else:                                                   # mostly: one word, changed, lost or added
        words = re.split(rb"([ ,=]+)", lines[i])
        k = rng.randrange(0, len(words), 2)
        if kind == 9:
            words[k] = b""
        elif kind == 10:
            words[k:k] = [rng.choice(NUMBERS), b" "]
        elif kind == 11 and words[k]:                       # one digit
            d = rng.randrange(len(words[k]))
            words[k] = words[k][:d] + rng.choice([b"0", b"9", b"-", b"e", b".", b"5", b""]) + words[k][d + 1:]
        else:
            words[k] = rng.choice(NUMBERS)
        lines[i] = b"".join(words)
    return b"\n".join(lines)


def seeds(sim, folder):
    """Good files to damage: the generated tracks, cut short, and parameter files of all kinds."""
    subprocess.run([sim, "tracks", folder / "tracks"], check=True, stdout=subprocess.DEVNULL)
    tracks = [b"".join(path.read_bytes().splitlines(keepends=True)[:60])
              for path in sorted((folder / "tracks").iterdir())]
    named = b"t,x,y,z,qw,qx,qy,qz,trust\n"
    tracks.append(named + b"".join(b"%.2f,%.3f,0,0,1,0,0,0,9\n" % (n / 10, n % 3 / 10) for n in range(20)))
    files = [subprocess.run([sim, "params", *arguments], check=True, capture_output=True).stdout
             for arguments in ([], ["--preset", "whip"], ["--preset", "ribbon", "--set", "links=64"],
                               ["--set", "scheme=paper", "--set", "spring=1,2,3,4"], ["--preset", "whip", "--model", "elastic"],
                               ["--preset", "foil", "--model", "elastic", "--set", "links=64"])]
    files += [b"[rod]\nlinks = 3\nspring = 80 70 ; two\n  60\n", b"[rod]\n"]
    return tracks, files


def fault(done, angles):
    """What is wrong with a run, or None."""
    if done.returncode not in (0, 2):
        return f"exit code {done.returncode}"
    if done.returncode == 2:
        if done.stdout or angles.exists():
            return "refused, yet with a result"
        if not re.fullmatch(rb"limber-sim: [^\x00-\x1f\x7f]+\n", done.stderr):
            return "refused, not in one line"
        return None
    if done.stderr:
        return "fine, yet something on stderr"
    found = re.search(rb"^steps +(\d+) at[^$]*^hash +[0-9a-f]{16}$", done.stdout, re.MULTILINE)
    if not found:
        return "no steps or no hash in the summary"
    if not angles.exists():
        return "no angles"
    rows, bound = 0, 3.1416 if re.search(rb"^rod .*, elastic$", done.stdout, re.MULTILINE) else 1.5708
    with open(angles, encoding="ascii") as table:
        names = next(table).count(",")
        for rows, row in enumerate(table, 1):
            if rows < 20000 and not (row.count(",") == names and all(abs(float(v)) < bound for v in row.split(",")[1:])):
                return f"row {rows} of the angles: {row[:60]!r}"
    return None if rows == int(found[1]) else f"{rows} rows of {int(found[1])} steps"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sim", metavar="LIMBER_SIM")
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, default=Path("mutate-finds"), help="where finds are kept (default %(default)s)")
    given = parser.parse_args()
    sim, rng, runs, finds, refused = str(Path(given.sim).resolve()), random.Random(given.seed), 0, 0, 0
    end = time.monotonic() + given.seconds
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        tracks, files = seeds(sim, folder)
        track, ini, angles = folder / "track", folder / "rod.ini", folder / "angles.csv"
        while time.monotonic() < end and finds < 10:
            data = [rng.choice(tracks), rng.choice(files)]
            which = rng.random() < 0.4
            for _ in range(rng.choice((1, 1, 1, 2, 3, 8))):
                data[which] = mutate(data[which], rng)
            track.write_bytes(data[0])
            ini.write_bytes(data[1])
            angles.unlink(missing_ok=True)
            arguments = ["replay", track, "--params", ini, "--rate", rng.choice(("10", "100", "1000")), "--angles", angles]
            arguments += rng.choice(([], [], ["--up", "y", "--left-handed"], ["--max-speed", "5"], ["--scale", "100"]))
            try:
                done = subprocess.run([sim, *arguments], capture_output=True, timeout=TIMEOUT_S, check=False)
                wrong = fault(done, angles)
                refused += done.returncode == 2
            except subprocess.TimeoutExpired:
                wrong = f"longer than {TIMEOUT_S} s"
            runs += 1
            if wrong:
                finds += 1
                place = given.keep / f"{given.seed}-{runs}"
                place.mkdir(parents=True, exist_ok=True)
                shutil.copy(track, place)
                shutil.copy(ini, place)
                options = " ".join(map(str, arguments[4:-1 if arguments[-1] == angles else None]))
                print(f"FOUND {wrong}: limber-sim replay {place}/track --params {place}/rod.ini {options}")
    print(f"seed {given.seed}: {runs} damaged files, {refused} refused, {runs - refused - finds} replayed, {finds} finds")
    return 1 if finds or runs == 0 or refused in (0, runs) else 0


if __name__ == "__main__":
    sys.exit(main())
