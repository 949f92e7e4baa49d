"""The reference files, one a motion: two nodes of every rod, in micrometres. Needs numpy and nothing else."""
from pathlib import Path

import numpy as np

import cases

FOLDER = Path(__file__).resolve().parents[2] / "data" / "fidelity"
EVERY_TICKS = 20                 # a sample every 20 ms, which every tick rate in question meets


def kept_nodes(links):
    """The node in the middle and the tip."""
    return [links // 2, links]


def read_packed(motion):
    """Rod name -> second differences in time [um] (samples, kept nodes, 3): they pack three times as well."""
    path = FOLDER / f"{motion}.npz"
    if not path.exists():
        return {}
    with np.load(path) as packed:
        return dict(packed)


def write(motion, rod, nodes_m):
    """Adds or replaces one rod's nodes [m] (ticks at TRACK_HZ, nodes, 3)."""
    micrometres = np.rint(nodes_m[::EVERY_TICKS, kept_nodes(rod.links)] * 1e6).astype(np.int32)
    packed = {**read_packed(motion), rod.name: np.diff(micrometres, 2, axis=0, prepend=np.zeros((2, 2, 3), np.int32))}
    part = FOLDER / f"{motion}.part.npz"
    np.savez_compressed(part, **{name: packed[name] for name in sorted(packed)})
    part.replace(FOLDER / f"{motion}.npz")


def read(motion):
    """Rod name -> nodes [m] (samples, kept nodes, 3)."""
    return {name: np.cumsum(np.cumsum(differences, axis=0), axis=0) * 1e-6
            for name, differences in read_packed(motion).items()}
