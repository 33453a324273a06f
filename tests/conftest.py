"""How many random cases a property is tried on: 50 in the ordinary run, always the same; 1000 in the long run."""

import re

import pytest
from hypothesis import HealthCheck, settings

ORDINARY, LONG = 50, 1000
#: Solves and long chains of laws take their time; what is slow shows in the durations, not as a failure.
_SHARED = {"deadline": None, "suppress_health_check": [HealthCheck.too_slow, HealthCheck.filter_too_much]}

settings.register_profile("ordinary", max_examples=ORDINARY, derandomize=True, database=None, **_SHARED)
settings.register_profile("long", max_examples=LONG, print_blob=True, **_SHARED)


def is_long_run(config):
    """Whether ``-m long`` asks for the long run."""
    expression = config.getoption("markexpr", "") or ""
    return bool(re.search(r"\blong\b", expression)) and not re.search(r"\bnot\s+long\b", expression)


def pytest_configure(config):
    settings.load_profile("long" if is_long_run(config) else "ordinary")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config, items):
    """Every property belongs to both runs; ``examples(ordinary, long)`` is for those whose cases cost seconds."""
    long_run = is_long_run(config)
    profile = settings.get_profile("long" if long_run else "ordinary")
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
            settings(profile, max_examples=many if long_run else ordinary)(function)
