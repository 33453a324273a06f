"""A check that is silenced on a line says why, on that line: nobody later knows whether it still has to be."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

HOUSE = Path(__file__).resolve().parents[2] / "fegear"
#: The silence, and what follows it: a reason in parentheses, after a dash, or as a comment of its own.
SILENCED = re.compile(
    r"# (?:noqa|type: ignore)\b(?:: ?[A-Z]+[0-9]+(?:, ?[A-Z]+[0-9]+)*)?(?:\[[a-z, -]+\])?(?P<rest>.*)"
)
REASON = re.compile(r"\s+(?:\(.*[a-z]{2}.*\)|- .*[a-z]{2}|# .*[a-z]{2}).*")


def without_reason(source: str) -> list[int]:
    return [
        number
        for number, line in enumerate(source.splitlines(), 1)
        if (found := SILENCED.search(line)) and not REASON.match(found["rest"])
    ]


def test_silenced_checks_give_their_reason():
    found = {str(path.relative_to(HOUSE)): without_reason(path.read_text("utf-8")) for path in HOUSE.rglob("*.py")}
    assert {name: lines for name, lines in found.items() if lines} == {}


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("x = y  # noqa: ARG002", False),
        ("x = y  # noqa", False),
        ("x = y  # type: ignore[misc]", False),
        ("x = y  # type: ignore", False),
        ("x = y  # noqa: ARG002  (all alike)", True),
        ("x = y  # noqa: BLE001, S110 - printed below", True),
        ("x = y  # type: ignore[arg-type, misc]  # heirs are dataclasses", True),
        ("x = y  # type: ignore[arg-type]  # noqa: S301  (our own answer)", True),
    ],
)
def test_a_silence_without_a_word_is_seen(line, said):
    assert (without_reason(line) == []) is said
