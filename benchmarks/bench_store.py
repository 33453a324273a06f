"""What a write costs in a store that holds many entries already, beside what looking at all of them costs.

    python benchmarks/bench_store.py [--entries 500,8000,50000] [--writes 200] [--size 1000]

For each number of entries, files of the names that a store gives are laid into a folder of its own, and more are
written into it. Printed: median, 95th percentile and mean of the milliseconds of a write, how many of the writes looked
at all entries, and what one such look takes. A store that looked at each write would take that for every one; as it is,
the mean must not grow with the number of entries, beyond the looks that fall into it.
"""

from __future__ import annotations

import argparse
import hashlib
import tempfile
import time
from pathlib import Path
from typing import ClassVar

import numpy as np

from fegear.base.store import Store


class Watched(Store):
    """A store that keeps how long each look at all entries took [s]."""

    looks: ClassVar[list[float]] = []

    def _prune(self) -> None:
        start = time.perf_counter()
        super()._prune()
        self.looks.append(time.perf_counter() - start)

    def lay(self, key: str, content: bytes) -> None:
        """Put a file where an entry would stand, without looking."""
        place = self._place(key)
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(content)

    def look(self) -> None:
        """Look at all entries once."""
        self._prune()


def filled(folder: Path, entries: int, size: int) -> Watched:
    """Lay so many entries of a size into a folder, as a store names them."""
    store = Watched(folder)
    for number in range(entries):
        store.lay(name(f"laid {number}"), b"\0" * size)
    return store


def name(text: str) -> str:
    """A key as good as random."""
    return hashlib.sha256(text.encode()).hexdigest()


def measured(store: Watched, writes: int, size: int) -> str:
    """One row: milliseconds of so many writes, and the looks among them."""
    Watched.looks.clear()
    payload, taken = b"\1" * size, []
    for number in range(writes):
        key = name(f"written {number}")
        start = time.perf_counter()
        store.write(key, payload)
        taken.append(1e3 * (time.perf_counter() - start))
    within = len(Watched.looks)
    store.look()
    median, high = np.percentile(taken, [50, 95])
    return f"{median:10.3f} {high:10.3f} {np.mean(taken):10.3f} {within:8d} {1e3 * Watched.looks[-1]:12.1f}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--entries", default="500,8000,50000", help="how many entries the stores hold")
    parser.add_argument("--writes", type=int, default=200)
    parser.add_argument("--size", type=int, default=1000, help="bytes of an entry")
    asked = parser.parse_args()
    print(f"{'entries':>8} {'median ms':>10} {'95 % ms':>10} {'mean ms':>10} {'looks':>8} {'one look ms':>12}")
    for entries in (int(count) for count in asked.entries.split(",")):
        with tempfile.TemporaryDirectory() as folder:
            store = filled(Path(folder), entries, asked.size)
            print(f"{entries:8d} {measured(store, asked.writes, asked.size)}", flush=True)


if __name__ == "__main__":
    main()
