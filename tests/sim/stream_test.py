#!/usr/bin/env python3
"""Device and tool together, as a user runs them: each track is streamed over a PTY in real time.

Every pose must be accounted for, and `replay --per-tick` of the device's own log must come to its angles bit for
bit. Exit 77 where the folder of tracks is missing.

    stream_test.py SIM LIMBER TRACK_OR_FOLDER... [--jobs 2]
"""
import argparse
import concurrent.futures
import json
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time


def rate_hz(track):
    times = [float(line.split()[0]) for line in track.read_text().splitlines() if line and line[0] not in "#\n"]
    return (len(times) - 1) / (times[-1] - times[0])


def hash_in(text):
    found = re.search(r"^hash\s+([0-9a-f]{16})", text, re.MULTILINE)
    return found.group(1) if found else "none"


def stream(sim, tool, track, folder):
    """Returns (good, a line for people)."""
    port, log = pathlib.Path(folder) / "rod", pathlib.Path(folder) / "body.log"
    device = subprocess.Popen([sim, "device", "--pty", port, "--log", log], stdout=subprocess.PIPE, text=True)
    try:
        deadline = time.monotonic() + 5
        while not port.is_symlink() and time.monotonic() < deadline:
            time.sleep(0.02)
        command = [tool, "stream", "--port", f"pty:{port}", "--json", str(track)]
        if rate_hz(track) < 40:
            refused = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
            if refused.returncode == 0 or "resample" not in refused.stderr:
                return False, f"{track.name}: slow, but not refused with what to do: {refused.stderr}"
            command += ["--resample", "100"]
        done = subprocess.run(command, capture_output=True, text=True, timeout=200, check=False)
    finally:
        device.send_signal(signal.SIGINT)
        said = device.communicate(timeout=20)[0]
    if done.returncode != 0:
        return False, f"{track.name}: exit {done.returncode}: {done.stderr.strip()}"
    summary = json.loads(done.stdout)
    again = subprocess.run([sim, "replay", "--per-tick", log], capture_output=True, text=True, check=False)
    same = hash_in(said) == hash_in(again.stdout) != "none"
    return same, (f"{track.name}: {json.dumps(summary.get('poses', summary))[:150]} "
                  f"hash {hash_in(said)} {hash_in(again.stdout)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sim")
    parser.add_argument("tool")
    parser.add_argument("tracks", nargs="+", type=pathlib.Path)
    parser.add_argument("--jobs", type=int, default=2)
    choices = parser.parse_args()
    tracks = [t for given in choices.tracks for t in (sorted(given.glob("*.txt")) if given.is_dir() else [given])]
    tracks = [t for t in tracks if t.exists()]
    if not tracks:
        print("SKIPPED: no tracks there")
        return 77

    def one(track):
        with tempfile.TemporaryDirectory() as folder:
            return stream(choices.sim, choices.tool, track, folder)

    with concurrent.futures.ThreadPoolExecutor(choices.jobs) as pool:
        results = []
        for good, line in pool.map(one, tracks):
            print(("ok   " if good else "FAIL ") + line, flush=True)
            results.append(good)
    print(f"{len(results)} tracks, {results.count(False)} failed")
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
