"""Processes that compute point after point hand back the memory that is free."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

from fegear.base import memory
from fegear.base.solution_cache import SolutionCache
from fegear.engine import processes


@pytest.fixture
def sizes(monkeypatch):
    """What the system is to say of this process, one after the other, and how often memory was handed back."""
    said, given = [], []
    monkeypatch.setattr(processes, "resident", lambda: said.pop(0))
    monkeypatch.setattr(processes, "give_back", lambda: given.append(True))
    monkeypatch.setattr(processes, "_left", {"memory": 0})
    return said, given


def test_memory_is_handed_back_once_a_process_has_grown(sizes):
    said, given = sizes
    said += [900 << 20, 400 << 20]
    processes.tidy()
    assert len(given) == 1
    for now in (500 << 20, 650 << 20):  # no more than 256 MB above what was left
        said.append(now)
        processes.tidy()
    assert len(given) == 1
    said += [700 << 20, 410 << 20]
    processes.tidy()
    assert len(given) == 2


def test_solutions_that_are_not_used_go_beyond_a_limit(sizes, monkeypatch):
    monkeypatch.setattr(processes, "_KEPT", 100_000)
    said, _ = sizes
    cache = SolutionCache()
    for point in range(4):
        cache.solve(f"gear {point}", lambda: np.zeros(10_000))
        said += [(1 + point) << 30, 0]
        processes.tidy(cache)
    # 80 kB each: the last one was used since, of the others one fits
    assert "gear 3" in cache
    assert sum(f"gear {point}" in cache for point in range(4)) <= 2


def test_systems_that_do_not_say_are_left_alone(monkeypatch):
    monkeypatch.setattr(processes, "resident", lambda: None)
    monkeypatch.setattr(processes, "give_back", lambda: pytest.fail("handed back"))
    processes.tidy(SolutionCache())


FREED = """
import numpy as np
from fegear.base import memory
before = memory.resident()
pieces = [np.ones(5_000) for _ in range(4_000)]  # 40 kB each, 160 MB
grown = memory.resident()
assert grown > before + (120 << 20), (before, grown)
del pieces[::2], pieces[:-1]  # the last one stays on top
memory.give_back()
assert memory.resident() < before + (40 << 20), (before, memory.resident())
"""


def test_what_is_freed_in_pieces_goes_back_to_the_system():
    """In a process of its own: one in which much was freed before grows by nothing."""
    if memory.resident() is None:
        pytest.skip("no /proc")
    done = subprocess.run([sys.executable, "-c", FREED], capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 0, done.stderr
