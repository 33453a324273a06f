"""Plugin of pytest that tells `coverage` which test runs, so that the lines that each one executes are known.

What is made once and used by several tests is theirs too: a fixture of a file belongs to all its tests, a solution
that a test recalls makes it heir of the test that computed it, and tables that functions remember are forgotten
between tests.
"""

from __future__ import annotations

import functools
import json
import os
import sys
import time
from pathlib import Path

import coverage
import pytest

from fegear.base.solution_cache import SolutionCache

#: Remembered for the whole run: machine code, and what the schema is; they cost seconds.
KEPT = ("fegear.dynamics.motion.kernel", "fegear.case", "fegear.window", "fegear.output", "fegear.engine")
FOUND: dict[str, dict] = {"seconds": {}, "heirs": {}, "failed": {}}
_makers: dict[tuple[int, str], str] = {}


def context(name: str) -> None:
    """Lines from here on are executed for `name`, in programs that are started, too."""
    os.environ["MUTATION_TEST"] = FOUND["now"] = name
    coverage.Coverage.current().switch_context(name)


def _forget() -> None:
    for name, module in list(sys.modules.items()):
        if name.startswith("fegear.") and not name.startswith(KEPT):
            for one in list(vars(module).values()):
                if isinstance(one, functools._lru_cache_wrapper):
                    one.cache_clear()


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(collector):
    context(f"{collector.nodeid}::*" if isinstance(collector, pytest.Module) else "collection")
    return (yield)


@pytest.hookimpl(wrapper=True)
def pytest_fixture_setup(fixturedef, request):
    before = FOUND["now"]
    if fixturedef.scope != "function":
        context(f"{request.node.nodeid.split('::')[0]}::*")
    try:
        return (yield)
    finally:
        context(before)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item):
    _forget()
    context(item.nodeid)
    started = time.process_time()
    try:
        return (yield)
    finally:
        FOUND["seconds"][item.nodeid] = time.process_time() - started
        context("between")


def pytest_runtest_logreport(report):
    if not report.passed:
        FOUND["failed"][report.nodeid] = report.outcome


def pytest_configure():
    solve = SolutionCache.solve

    def noticed(self, key, compute, codec=None):
        known = key in self
        found = solve(self, key, compute, codec)
        maker = _makers.setdefault((id(self), key), FOUND["now"]) if known else FOUND["now"]
        if not known:
            _makers[id(self), key] = maker
        elif maker != FOUND["now"]:
            FOUND["heirs"].setdefault(maker, {})[FOUND["now"]] = True
        return found

    SolutionCache.solve = noticed


def pytest_unconfigure():
    FOUND["heirs"] = {maker: sorted(heirs) for maker, heirs in FOUND["heirs"].items()}
    Path(os.environ["MUTATION_FOUND"]).write_text(json.dumps(FOUND))
