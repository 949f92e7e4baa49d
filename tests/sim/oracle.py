#!/usr/bin/env python3
"""Independent float64 reference for the `contour` rod (oracle_rod.py) and for the replay of recordings (oracle_track.py).

Written from the mathematics alone (firmware/core/MODEL.md). It shares no line with the firmware, so where the two agree on
every row of a recording, a mistake would have to have been made twice. Needs numpy and nothing else.
"""
import argparse
import multiprocessing
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from oracle_rod import DEFAULTS, Rod, csv_header, settings_from, simulate
from oracle_track import UserError, awkward_track, replayed_poses

# ---------------------------------------------------------------- agreement with the simulator

TOLERANCE_RAD = 2e-3             # about 0.1 degree: no servo shows it
# How far the recording itself decides: the oracle runs twice, the second time with every tick's base position moved by
# up to 1e-7 m (on real tracks that usually moves the rod ten times as far as rounding the input to float32). From
# the first row at which this alone moved an angle by the whole tolerance, a difference says nothing about the code,
# and the cut is final: after a stop met or missed a rod may take another path for as long as it is shaken.
# Which rows are left depends on oracle and track alone, never on the simulator, and a stiff rod must keep most of them.
DISTURBANCE_M, SEED = 1e-7, 1
SHARE = 0.9                      # of the rows must be left, where the spring is stiff
SOFT_SPRING = 500.0              # below it a shaken rod is chaotic from its first contact with a stop: compared to there


def simulator_angles(sim, track, rate_hz, pairs, tick_s, links):
    """Angles as `limber-sim replay` writes them (ticks x N x 2)."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "angles.csv"
        command = [str(sim), "replay", str(track), "--rate", f"{rate_hz:.12g}", "--angles", str(out)]
        command += [word for pair in pairs for word in ("--set", pair)]
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=300)
            if done.returncode != 0:
                raise UserError(f"{sim} exit {done.returncode}: {' '.join(done.stderr.split()) or 'no message'}")
            header, *rows = out.read_text(encoding="utf-8").split()
            table = np.array([row.split(",") for row in rows], float)
        except (OSError, ValueError, subprocess.TimeoutExpired) as error:
            raise UserError(f"{sim}: {error}") from None
    if header != csv_header(links) or table.shape != (len(tick_s), 1 + 2 * links):
        raise UserError(f"{sim}: {len(rows)} rows under {header[:30]}…, expected {len(tick_s)} for {links} links")
    if not np.all(np.abs(table[:, 0] - tick_s) < 1e-6):
        raise UserError(f"{sim}: column t is not n / rate")
    return table[:, 1:].reshape(len(tick_s), links, 2)


def judge(case):
    """(sim, track, rate_hz, pairs, least share, least peak [rad]) -> (verdict, table line)."""
    sim, track, rate_hz, pairs, share, least_rad = case
    try:
        settings = settings_from(pairs)
        tick_s, position_m, rotation, restart = replayed_poses(track, rate_hz)
        rod, links, rows = Rod(settings, rate_hz), settings["links"], len(tick_s)
        expected, touched = simulate(rod, position_m, rotation, restart)
        push_m = np.random.default_rng(SEED).uniform(-DISTURBANCE_M, DISTURBANCE_M, position_m.shape)
        moved = np.abs(simulate(rod, position_m + push_m, rotation, restart)[0] - expected).max(axis=(1, 2))
        got = simulator_angles(sim, track, rate_hz, pairs, tick_s, links)
    except UserError as error:
        return "FAIL", f"{Path(track).name:<28} {rate_hz:>5g} {' '.join(pairs)}: FAIL {error}"
    soft = settings["spring"].min() < SOFT_SPRING
    end = (moved >= TOLERANCE_RAD) | (touched & soft)
    compared = int(np.argmax(end)) if end.any() else rows           # at least 1: row 0 is all zeros
    error_rad = np.nan_to_num(np.abs(got - expected)[:compared], nan=np.inf)
    worst = np.unravel_index(np.argmax(error_rad), error_rad.shape)
    peak_rad = np.abs(expected[:compared]).max()
    faults = [text for fault, text in (
        (error_rad[worst] > TOLERANCE_RAD, f"differs by more than {TOLERANCE_RAD:g} rad"),
        (not np.all(np.abs(got) <= settings["limit"][:, None] + 1e-6), "beyond a stop, or no number"),      # any row
        (not soft and compared < share * rows, f"under {share:.0%} of the rows comparable"),
        (not soft and peak_rad < least_rad, "hardly moves: shows nothing")) if fault]
    verdict = "FAIL" if faults else "ok" if compared > 0.02 * rows else "none"      # none: too little to call it a pass
    spring = "..".join(f"{k:g}" for k in dict.fromkeys(settings["spring"][[0, -1]]))
    where = f"{tick_s[worst[0]]:.3f} s {('theta', 'phi')[worst[2]]}{worst[1] + 1}"
    others = " ".join(p for p in pairs if p.split("=")[0] not in ("links", "hold", "spring"))[:32]
    return verdict, (f"{Path(track).name:<28} {rate_hz:>5g} {links:>3} {settings['hold']:>4} {spring:>10} {rows:>6} "
                     f"{compared:>8} {peak_rad:>6.3f} {error_rad[worst]:>9.1e} {where:<17} {verdict:<4} {others} "
                     + "; ".join(faults)).rstrip()


def judge_all(cases):
    if not Path(cases[0][0]).is_file():
        raise UserError(f"--sim {cases[0][0]}: no such file")
    print(f"{'':8}{'track':<28} {'rate':>5} {'N':>3} {'hold':>4} {'k':>10} {'rows':>6} {'compared':>8} {'peak':>6} "
          f"{'max error':>9} where", flush=True)
    verdicts = []
    with multiprocessing.Pool(min(2, len(cases))) as pool:
        for verdict, line in pool.imap(judge, cases):
            verdicts.append(verdict)
            print(f"{len(verdicts):>3}/{len(cases):<3} {line}", flush=True)
    agree, fail = verdicts.count("ok"), verdicts.count("FAIL")
    print(f"{agree} agree within {TOLERANCE_RAD:g} rad, {fail} FAIL, {len(cases) - agree - fail} with too little to compare")
    return 1 if fail or not agree else 0


TAPER = ["links=5", "spring=2600,2200,1800,1400,1000", "damper=12,11,10,9,8", "length=.04,.035,.03,.025,.02",
         "inertia=.3,.25,.2,.15,.12", "coupling=40,100,80,60,30", "smoothing=10,20,15,5,1000",   # the last is unused
         "drag=.5,.2,0,.1,.3", "limit=1.3,0.4,0.2,0.1,0.05"]


def suite(sim, folder, quick):
    def is_track(path):                                             # a folder may also list its tracks in a .csv
        return path.suffix == ".txt" or path.read_text(encoding="utf-8", errors="replace").startswith("#timestamp")
    tracks = [p for p in sorted(Path(folder).glob("*")) if p.suffix in (".txt", ".csv") and is_track(p)]
    if not tracks:
        print(f"SKIPPED: no tracks in {folder}")
        return 77
    cases = []

    def add(track, rate_hz, *pairs, share=SHARE):
        cases.append((sim, track, rate_hz, list(pairs), share, 5 * TOLERANCE_RAD))

    with tempfile.TemporaryDirectory() as made:
        for name in ("awkward.txt", "awkward.csv"):
            tracks.append(Path(made) / name)
            awkward_track(tracks[-1])
        for track in tracks:
            for rate_hz in (100,) if quick else (100, 500):
                for hold in ("hold=1", "hold=2"):
                    for links in ("links=4", "links=20"):
                        add(track, rate_hz, links, hold, "spring=2000", "damper=10")
                    add(track, rate_hz, *TAPER, hold)
                    # with the default damper, 2, a shaken rod rings from stop to stop: one recording leaves 17 %
                    add(track, rate_hz, "links=4", hold, "spring=2000", share=0.15)
                    add(track, rate_hz, "links=4", hold, "spring=80")
                add(track, rate_hz, "links=4", "spring=2000", "scheme=paper", share=0.15)
            for links in ("links=1", "links=2", "links=3"):
                add(track, 100, links, "hold=2", "spring=2000", "damper=10", "coupling=0", "smoothing=30")
        return judge_all(cases)


# ---------------------------------------------------------------- command line

def run(track, rate_hz, pairs, out):
    tick_s, position_m, rotation, restart = replayed_poses(track, rate_hz)
    rod = Rod(settings_from(pairs), rate_hz)
    angle_rad, touched = simulate(rod, position_m, rotation, restart)
    if out:
        table = np.column_stack([tick_s, angle_rad.reshape(len(tick_s), -1)])
        try:
            np.savetxt(out, table, fmt="%.9g", delimiter=",", header=csv_header(rod.links), comments="")
        except OSError as error:
            raise UserError(f"--angles {error}") from None
    met = f"a stop first met at {tick_s[np.argmax(touched)]:.3f} s" if touched.any() else "no stop met"
    print(f"{Path(track).name}: {len(tick_s)} ticks, {restart.sum() - 1} restarts, "
          f"largest angle {np.abs(angle_rad).max():.4f} rad, {met}")
    return 0


class OneLineParser(argparse.ArgumentParser):
    def error(self, message):
        self.exit(2, f"oracle.py: {message}\n")


def main():
    parser = OneLineParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, epilog=f"""\
examples:
  oracle.py run swing.txt --rate 500 --set links=20 --set spring=2000 --angles angles.csv
  oracle.py compare --sim build/host/limber-sim swing.txt shake.txt --set links=2 --set spring=2000,1500
  oracle.py suite --sim build/host/limber-sim tests/data/tracks --quick
keys for --set (one value, or one per joint separated by commas) and their defaults:
  {" ".join(f"{key}={value}" for key, value in DEFAULTS.items())}""")
    commands = parser.add_subparsers(dest="command", required=True)
    one = commands.add_parser("run", help="replay one track, write its angles")
    one.add_argument("track")
    one.add_argument("--angles", metavar="OUT.csv", help="columns t,theta1,phi1,theta2,phi2,…; seconds and radians")
    several = commands.add_parser("compare", help="replay tracks here and in limber-sim, compare row by row")
    several.add_argument("track", nargs="+")
    several.add_argument("--share", type=float, default=SHARE,
                         help=f"of the rows that must be comparable (default {SHARE}; soft springs: none)")
    everything = commands.add_parser("suite", help="compare a folder of tracks at many settings; exit 77 if it has none")
    everything.add_argument("folder", metavar="TRACKDIR")
    everything.add_argument("--quick", action="store_true", help="100 Hz only, under a minute")
    for command in (one, several):
        command.add_argument("--rate", type=float, default=100.0, metavar="HZ", help="ticks a second (default 100)")
        command.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="repeatable")
    for command in (several, everything):
        command.add_argument("--sim", required=True, help="path of limber-sim")
    given = parser.parse_args()
    try:
        if given.command == "run":
            return run(given.track, given.rate, given.set, given.angles)
        if given.command == "compare":
            for track in given.track:                               # a wrong command line is no disagreement
                replayed_poses(track, given.rate)
            Rod(settings_from(given.set), given.rate)
            return judge_all([(given.sim, track, given.rate, given.set, given.share, 0.0) for track in given.track])
        return suite(given.sim, given.folder, given.quick)
    except UserError as error:
        parser.error(str(error))


if __name__ == "__main__":
    sys.exit(main())
