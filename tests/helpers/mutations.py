"""Random mutations of documents and texts, always the same for one number, and what may become of them."""

from __future__ import annotations

import copy
import datetime as dt
import math
import random  # noqa: TC003
import signal
from contextlib import contextmanager

from fegear.base.errors import FegearError

UNITS = [
    "mm",
    "um",
    "m",
    "inch",
    "deg",
    "rad",
    "N",
    "kN",
    "N*m",
    "MPa",
    "GPa",
    "rpm",
    "kg/m^3",
    "h",
    "degC",
    "",
    "lb",
    "°",
    "µm",
]
STRANGE = [
    "", " ", "x", "nan", "inf", "-inf mm", "0 mm", "-3 mm", "1e400 mm", "1e-400 mm", "3,175 mm", "1/2 inch", "齿轮",
    "Ω",
    "a\nb",
    "n" * 3000, "../../etc/passwd", "\u200b", "a.b", '"', "{}", "%s", "3 mm 4 mm", "٣ mm", "true",
    0, -1, 1, 10**9, 10**400, -(10**400), 0.0, -0.0, 1e-320, 1e308, math.nan, math.inf, True, False,
    [], [[]], ["1 mm"], [0, 1], [True], {}, {"a": 1}, {"": ""}, {"start": 0}, dt.date(2026, 1, 1),
    dt.time(1),
]  # fmt: skip


@contextmanager
def processor_seconds(most: float):
    """Nothing takes longer than so many seconds of the processor."""

    def stop(_number, _frame):
        raise TimeoutError(f"took more than {most} s")

    before = signal.signal(signal.SIGVTALRM, stop)
    signal.setitimer(signal.ITIMER_VIRTUAL, most)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
        signal.signal(signal.SIGVTALRM, before)


def places(table, path=()):
    """All keys of a document, tables included."""
    entries = table.items() if isinstance(table, dict) else enumerate(table)
    for key, value in list(entries):
        yield (*path, key)
        if isinstance(value, (dict, list)):
            yield from places(value, (*path, key))


def reached(table, place):
    """What stands at a place."""
    for step in place:
        table = table[step]
    return table


def changed_value(value, draw: random.Random):
    """A value near to another one, or far from it."""
    if draw.random() < 0.2:
        return draw.choice(STRANGE)
    if isinstance(value, bool):
        return not value
    if isinstance(value, (int, float)):
        factor = draw.choice([-1, 10, 0.1, 1e3, 1e-3, 1e6, 1e-6, 1e12, 1.001])
        try:
            return int(value * factor) if isinstance(value, int) and draw.random() < 0.7 else value * factor
        except OverflowError:  # of an integer of 400 digits
            return value
    if isinstance(value, str):
        head, _, unit = value.partition(" ")
        try:
            number = float(head)
        except ValueError:
            at = draw.randrange(len(value) + 1)
            return value[:at] + draw.choice(["", "x", "é", " ", value[at:] or "y"]) + value[at + 1 :]
        how = draw.random()
        if how < 0.4:
            return f"{number * draw.choice([-1, 0, 10, 1e3, 1e-3, 1e6, 1e-6, 1e15])!r} {unit}"
        return f"{head} {draw.choice(UNITS)}" if how < 0.8 else number
    if isinstance(value, list):
        return draw.choice([value * 50, value[:1], value[::-1], [*value, draw.choice(STRANGE)], [value], value[1:]])
    if isinstance(value, dict):
        return draw.choice([list(value), {**value, "x": 1}, dict(list(value.items())[1:]), list(value.values())])
    return draw.choice(STRANGE)


def mutated(document, draw: random.Random):
    """A document with one to three things changed."""
    made = copy.deepcopy(document)
    for _ in range(draw.choice([1, 1, 1, 2, 3])):
        every = list(places(made))
        ends = [place for place in every if not isinstance(reached(made, place), (dict, list))]
        every = ends if ends and draw.random() < 0.75 else every
        if not every:
            break
        *above, key = draw.choice(every)
        table = reached(made, above)
        how = draw.random()
        if how < 0.75:
            table[key] = changed_value(table[key], draw)
        elif how < 0.81:
            del table[key]
        elif how < 0.86 and isinstance(table, dict):
            table[draw.choice([f"{key}s", str(key)[:-1], str(key).upper(), "", "齿"])] = table.pop(key)
        elif how < 0.95:
            table[key] = copy.deepcopy(reached(made, draw.choice(every)))
        elif isinstance(table, dict):
            table |= dict.fromkeys([str(key), "extra"], draw.choice(STRANGE))
    return made


def torn(text: str, draw: random.Random) -> str:
    """A text with characters or lines lost, doubled, swapped, or of another kind."""
    for _ in range(draw.choice([1, 1, 2, 5])):
        at = draw.randrange(len(text) + 1)
        lines = text.splitlines(keepends=True)
        line = draw.randrange(len(lines) or 1)
        sign = draw.choice(['"', "[", "]", "{", "=", ".", "\n", "\0", "é", "\ufeff", "9", "-", "#", ","])
        text = draw.choice([
            text[:at] + text[at + 1 :], text[:at] + sign + text[at:], text[:at],
            "".join(lines[:line] + lines[line + 1 :]),
            "".join(lines[: line + 1] + lines[line:]), "".join(draw.sample(lines, len(lines))),
        ])  # fmt: skip
    return text


def sentence(refusal: FegearError) -> str:
    """Empty if a refusal is one sentence that can be read."""
    text = str(refusal)
    good = text and "\n" not in text and len(text) < 2500 and text.endswith((".", '"', "?"))
    return "" if good else f"no sentence: {text[:300]!r}"


def failures(judge, numbers) -> str:
    told = {number: judge(number) for number in numbers}
    return "\n".join(f"mutation {number}: {what}" for number, what in told.items() if what)
