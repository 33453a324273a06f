"""What rows of ``fegear verify`` compare, kept in ``rows_of_verify.json``: one that compares less, or another thing.

    python tests/golden/rows_of_verify.py [ROW ...] [--accept]

That a row holds says nothing of its inputs: with other ones it holds, too. Of every row that the ordinary tests run it
is kept how many numbers it compares, what differences it allows, and a sum of the other side's numbers in which each
has a weight of its own; where that side is printed, of fegear's numbers as well, which formulas give.
`test_verify_unit.py` compares.
"""

import argparse
import json
from pathlib import Path

import numpy as np

KEPT = Path(__file__).with_suffix(".json")


def of_row(outcome):
    """What is kept of a row that has run: count, sum of the allowed differences, weighted means of both sides."""
    weights = np.cos(1.0 + 2.399963 * np.arange(len(outcome.compared)))  # turned by the golden angle: no two alike
    sizes = [one.wanted / one.scale + 0.01 * np.log(one.scale) for one in outcome.compared]
    allowed = sum(one.allowed for one in outcome.compared)
    both = [np.dot(weights, sizes) / len(sizes)]
    if outcome.row.against == "printed":
        both.append(np.dot(weights, [one.found / one.scale for one in outcome.compared]) / len(sizes))
    return [len(outcome.compared), float(f"{allowed:.6g}"), *(float(f"{one:.9g}") for one in both)]


def same(old, new):
    """Whether two of these say the same but for another processor's round-off."""
    counts = old[0] == new[0] and len(old) == len(new) and abs(old[1] - new[1]) <= 1e-5 * old[1]
    return counts and all(
        abs(one - other) <= 1e-6 * max(1.0, abs(one)) for one, other in zip(old[2:], new[2:], strict=True)
    )


def kept():
    """All that is kept, by row."""
    return json.loads(KEPT.read_text("utf-8")) if KEPT.exists() else {}


def main():
    """Compare, or keep."""
    from fegear.verify.row import run
    from fegear.verify.rows import ALL

    wishes = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    wishes.add_argument("rows", nargs="*", metavar="ROW")
    wishes.add_argument("--accept", action="store_true", help="keep what is found")
    asked = wishes.parse_args()
    known = kept()
    for row in ALL:
        if row.name in (asked.rows or known):
            new = of_row(run(row))
            print(row.name, known.get(row.name), new)
            known[row.name] = new
    if asked.accept:
        lines = [f" {json.dumps(name)}: {json.dumps(known[name])}" for name in sorted(known)]
        KEPT.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
