"""How many random cases a property is tried on: 16 in the ordinary run, 40 with the dear tests; 1000 in the long run.

Tests that run another program ask the fixture `program` for it: where it is missing they are skipped, with the line
that installs it. ``--no-skips`` lets no test be skipped.

Tests marked ``dear`` take a second of a processor or more each, half of the time of all: ``--dear`` runs them too, as
`.ci/run` does at every change; who names one by its place (``FILE::TEST``) gets it anyway. ``dear("30", "ring")`` marks
those of a parametrised test that have these names.

``--last-bit SEED`` computes as another processor might: with noise of one unit in the last place where rounding enters
(`helpers/other_processor`). It runs the tests marked ``last_bit`` and every tenth of the others, always the same;
``--last-bit-every 1`` runs all.
"""

import gc
import importlib
import math
import os
import re
import shutil
import subprocess
import sys
import zlib
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

FEW, ORDINARY, LONG = 16, 40, 1000
#: Solves and long chains of laws take their time; what is slow shows in the durations, not as a failure.
_SHARED = {"deadline": None, "suppress_health_check": [HealthCheck.too_slow, HealthCheck.filter_too_much]}

settings.register_profile("few", max_examples=FEW, derandomize=True, database=None, **_SHARED)
settings.register_profile("ordinary", max_examples=ORDINARY, derandomize=True, database=None, **_SHARED)
settings.register_profile("long", max_examples=LONG, print_blob=True, **_SHARED)

#: Programs that some tests run: the names they go by, and the Debian package that has them.
PROGRAMS = {"ccx": (("ccx",), "calculix-ccx"), "chromium": (("chromium", "chromium-browser"), "chromium")}


@pytest.fixture(scope="session")
def program():
    """Find a program by name, or skip the test that asks for it."""

    def find(name):
        names, package = PROGRAMS[name]
        for known in names:
            if path := shutil.which(known):
                return path
        pytest.skip(f"{name} is missing; on Debian or Ubuntu run: apt-get install {package}")

    return find


@pytest.fixture(scope="module")
def scheduler():
    """Address of a Dask scheduler with one worker on this machine, while a module needs it: idle ones take time too."""
    program = (
        "from dask.distributed import LocalCluster\n"
        "import sys\n"
        "if __name__ == '__main__':\n"
        "    with LocalCluster(n_workers=1, threads_per_worker=2, dashboard_address=None) as cluster:\n"
        "        print(cluster.scheduler_address, flush=True)\n"
        "        sys.stdin.read()\n"
    )
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    process = subprocess.Popen(
        [sys.executable, "-c", program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment
    )
    yield process.stdout.readline().strip()
    process.stdin.close()
    process.wait(timeout=60)


def pytest_addoption(parser):
    parser.addoption("--no-skips", action="store_true", help="a test that cannot run here has failed")
    parser.addoption(
        "--dear", action="store_true", help="run the dear tests and more random cases, too, as .ci/run does"
    )
    parser.addoption("--last-bit", type=int, metavar="SEED", help="noise in the last place, of this seed")
    parser.addoption("--last-bit-every", type=int, default=10, metavar="N", help="run every N-th ordinary test with it")


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    return _not_skipped(item.config, (yield))


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(collector):
    return _not_skipped(collector.config, (yield))


def _not_skipped(config, report):
    if config.getoption("no_skips") and report.skipped and not hasattr(report, "wasxfail"):
        reason = report.longrepr[2] if isinstance(report.longrepr, tuple) else str(report.longrepr)
        report.outcome, report.longrepr = "failed", f"{reason} (with --no-skips no test may be skipped)"
    return report


def is_long_run(config):
    """Whether ``-m long`` asks for the long run."""
    expression = config.getoption("markexpr", "") or ""
    return bool(re.search(r"\blong\b", expression)) and not re.search(r"\bnot\s+long\b", expression)


def leaves_dear_ones(config):
    """Whether dear tests are left to `.ci/run`, and with them most of the random cases."""
    named = any("::" in one for one in config.args)
    return not (config.getoption("dear") or config.getoption("last_bit") is not None or is_long_run(config) or named)


def is_dear(item):
    """Whether a test is marked ``dear``, itself or by the name of its parameters."""
    return any(not mark.args or item.callspec.id in mark.args for mark in item.iter_markers("dear"))


def _refuse_names_that_no_test_has(items):
    """A name of parameters that is written wrong would leave a dear test in the ordinary run."""
    named = {}
    for item in items:
        for mark in item.iter_markers("dear"):
            if mark.args:
                named.setdefault((item.path, item.originalname), set(mark.args)).discard(item.callspec.id)
    for (path, name), left in named.items():
        if left:
            raise pytest.UsageError(f"{path}: {name} is marked dear for {sorted(left)}, which it does not have")


def profile_of(config):
    """Name of the profile of hypothesis."""
    return "long" if is_long_run(config) else "few" if leaves_dear_ones(config) else "ordinary"


@pytest.fixture(scope="session", autouse=True)
def _own_state(tmp_path_factory):
    """What the window keeps beyond a crash stays among the tests: one of them left a case of its own to the user.

    So does what runs keep for later ones, above all what their tasks took: tests did change the user's forecasts.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("FEGEAR_CACHE", str(tmp_path_factory.mktemp("cache")))
        patch.setenv("FEGEAR_STATE", str(tmp_path_factory.mktemp("state")))
        yield


def _advance(_self, fraction):
    assert -1e-9 <= fraction <= 1.0 + 1e-9, f"a task is done by {fraction}"


def pytest_runtest_setup():
    """Runs that nobody watches check their progress, whatever a test is about: it is a share of the task."""
    if run := sys.modules.get("fegear.engine.run"):
        run.Silence.advance = _advance


def pytest_configure(config):
    settings.load_profile(profile_of(config))
    if (seed := config.getoption("last_bit")) is not None:
        sys.path.insert(0, str(Path(__file__).parent / "helpers" / "other_processor"))
        importlib.import_module("last_bit").install(seed)


def _is_for_last_bit(config, item):
    """Whether a test is run with noise in the last place: those of hard cases, and a fixed share of all."""
    share = zlib.crc32(item.nodeid.encode()) % config.getoption("last_bit_every") == 0
    return share or item.get_closest_marker("last_bit") is not None


@pytest.hookimpl(wrapper=True)
def pytest_collection():
    """Collecting makes a million objects that all stay: they are not searched for garbage while it lasts, nor later."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config, items):
    """Every property belongs to all runs; ``examples(ordinary, long)`` is for those whose cases cost seconds."""
    long_run = is_long_run(config)
    profile = settings.get_profile(profile_of(config))
    seen = set()
    for item in items:
        function = getattr(item, "obj", None)
        if not getattr(function, "is_hypothesis_test", False):
            continue
        if long_run:
            item.add_marker(pytest.mark.long)
        marker = item.get_closest_marker("examples")
        if marker and function not in seen:
            seen.add(function)
            ordinary, many = marker.args
            few = math.ceil(ordinary * FEW / ORDINARY) if leaves_dear_ones(config) else ordinary
            settings(profile, max_examples=many if long_run else few)(function)
    if config.getoption("last_bit") is not None:
        _choose(config, items, lambda item: _is_for_last_bit(config, item))
    elif leaves_dear_ones(config):
        _refuse_names_that_no_test_has(items)
        _choose(config, items, lambda item: not is_dear(item))


def _choose(config, items, wanted):
    """Leave the tests that are wanted."""
    chosen = [wanted(item) for item in items]
    config.hook.pytest_deselected(items=[item for item, one in zip(items, chosen, strict=True) if not one])
    items[:] = [item for item, one in zip(items, chosen, strict=True) if one]
