"""Tables and pictures of docs/cost.md, from the folders of two cost studies.

First the studies, some minutes of one core on a machine that does nothing else:

    fegear cost cases/nasa_four_square.toml --out NASA
    fegear cost cases/helical_load.toml --out HELICAL
    fegear cost cases/spur_over_the_face.toml --out SPUR

then ``python benchmarks/cost_study.py NASA HELICAL SPUR`` writes their numbers between the page's marks and takes
pictures.
"""

from __future__ import annotations

import csv
import re
import shutil
import sys
from pathlib import Path
from typing import Any

DOCS = Path(__file__).resolve().parents[1] / "docs"
PAGE = DOCS / "cost.md"
#: Quantities of the rig, as the study and as the page calls them.
RIG = {
    "c_0": "c_0", "c_1": "c_1", "root-stress": "root stress", "te-peak-to-peak": "peak-to-peak TE",
    "tooth-force": "largest tooth force",
}  # fmt: skip
PAIR = {"te-mean": "transmission error, mean", "te-peak-to-peak": "peak to peak", "face-load-factor": "K_Hbeta"}
TOLERANCES = ("0.1", "0.01", "0.001", "0.0001", "1e-05")
#: What stands in a table where there is no number.
NONE = ("", "nan")
PICTURES = (("cost.png", "cost_nasa_four_square.png"), ("cost_knobs.png", "cost_knobs.png"))


def rows(folder: Path, name: str) -> list[dict[str, str]]:
    """Lines of a table."""
    with (folder / "tables" / f"{name}.csv").open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def share(error: float) -> str:
    """An error as the page writes it: in per cent, below one of them with one digit that is not zero."""
    if 0.0 < error < 0.01:
        digits = -int(f"{100.0 * error:.0e}".partition("e")[2])
        return f"{100.0 * error:.{digits}f} %"
    return f"{100.0 * error:.0f} %" if error >= 0.0995 else f"{100.0 * error:.1f} %"


def seconds(value: str) -> str:
    """Two digits, none below a tenth of a millisecond."""
    return f"{float(value):.2g}" if float(value) >= 1e-4 else "0"


def table(head: list[str], body: list[list[str]]) -> str:
    """In Markdown."""
    lines = [head, ["---"] * len(head), *body]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def errors(folder: Path) -> str:
    """Closed forms, sectors and tolerances: error and seconds of each quantity."""
    found: dict[str, dict[str, str]] = {}
    for row in rows(folder, "cost"):
        known = row["family"], row["configuration"]
        if row["quantity"] in RIG and row["error"] not in NONE and known[0] in ("compliance-formula", "stress-formula"):
            name = known[1]
        elif row["quantity"] in RIG and row["error"] not in NONE and re.match(r"sector of|tolerance", known[1]):
            name = known[1].partition(",")[0]
        else:
            continue
        cell = f"{share(float(row['error']))} ({seconds(row['seconds [s]'])} s)"
        found.setdefault(name, {}).setdefault(row["quantity"], cell)
    return table(
        ["", *RIG.values()], [[name, *(found[name].get(q, "") for q in RIG)] for name in sorted(found, key=_rank)]
    )


def _rank(name: str) -> tuple[int, float]:
    """Compliances, root stresses, sectors by their teeth, tolerances from loose to tight."""
    number = re.search(r"[\d.e-]+(?= teeth$)|(?<== )[\d.e-]+$", name)
    if number is None:
        return int(name.endswith("root stress")), 0.0
    return (2, float(number[0])) if name.startswith("sector") else (3, -float(number[0]))


def cheapest(folder: Path) -> str:
    """Cheapest settings for each tolerance."""
    found: dict[str, dict[str, str]] = {}
    for row in rows(folder, "cost_cheapest"):
        short = re.sub(r"^whole gear, |, compliance$", "", row["configuration"])
        reached = row["seconds [s]"] not in NONE
        cell = f"{short}: {seconds(row['seconds [s]'])} s" if reached else row["configuration"]
        found.setdefault(row["quantity"], {})[row["tolerance"]] = cell
    body = [[quantity, *(one.get(t, "") for t in TOLERANCES)] for quantity, one in found.items()]
    return table(["", "1e-1", "1e-2", "1e-3", "1e-4", "1e-5"], body)


def orders(folder: Path) -> str:
    """Observed orders of each setting."""
    found: dict[str, dict[str, str]] = {}
    quantities = list(dict.fromkeys(row["quantity"] for row in rows(folder, "cost_orders")))
    for row in rows(folder, "cost_orders"):
        used = "none" if row["order"] in NONE else f"{float(row['order']):.1f}"
        if used != "none":
            used += f" ({row['configurations_used']} of {row['configurations']})"
        found.setdefault(row["knob"], {})[row["quantity"]] = used
    body = [[knob, *(one.get(q, "") for q in quantities)] for knob, one in found.items()]
    return table(["setting", *quantities], body)


def pair(folder: Path) -> str:
    """Bodies of a pair with a width at the panels of its case."""
    found: dict[str, dict[str, Any]] = {}
    floors: dict[str, float] = {}
    for row in rows(folder, "cost"):
        floors[row["quantity"]] = float(row["floor"])
        shown = re.fullmatch(r"(.+), order 3, edges (x [\d.]+), 16 panels", row["configuration"])
        if not shown:
            continue
        name = f"{shown[1]}, edges {shown[2]}" + (" (usual)" if shown[1] == "solid" and shown[2] == "x 1" else "")
        one = found.setdefault(name, {"seconds": seconds(row["seconds [s]"])})
        off = float(row["error"])
        floor = off <= floors[row["quantity"]]
        one[row["quantity"]] = f"{share(floors[row['quantity']])} (floor)" if floor else share(off)
    body = [[name, one["seconds"], *(one[q] for q in PAIR)] for name, one in found.items()]
    body.append(["the reference's own error (floor)", "", *(share(floors[q]) for q in PAIR)])
    return table(["configuration, the case's 16 panels", "seconds", *PAIR.values()], body)


def over_the_face(folder: Path, knob: str, usual: str, head: str) -> str:
    """One setting of a gear with its width alone."""
    found: dict[str, dict[str, str]] = {}
    for row in rows(folder, "cost_knobs"):
        quantity, _, over = row["quantity"].partition(" over")
        if over and row["knob"] == knob:
            one = found.setdefault(row["setting"], {"seconds": seconds(row["seconds [s]"])})
            one[quantity] = share(float(row["error"]))
    names = ("c_0", "c_1", "root tension", "seconds")
    body = [[at + " (usual)" * (at == usual), *(one[name] for name in names)] for at, one in found.items()]
    return table([head, *names], body)


def main(nasa: Path, helical: Path, spur: Path) -> None:
    """Fill the page and take the pictures."""
    text = PAGE.read_text("utf-8")
    for name, filled in (
        ("errors", errors(nasa)), ("cheapest", cheapest(nasa)), ("orders", orders(nasa)), ("pair", pair(helical)),
        ("functions", over_the_face(spur, "functions per module of face", "1.5", "functions per module of face")),
        ("edges", over_the_face(spur, "edges of the section", "0.2", "longest edge along the fillet [modules]")),
    ):  # fmt: skip
        mark = re.compile(rf"(<!-- {name} -->\n\n).*?(\n\n<!-- end of {name} -->)", re.DOTALL)
        text, count = mark.subn(lambda found, filled=filled: found[1] + filled + found[2], text)
        if count != 1:
            raise ValueError(name)
    PAGE.write_text(text, "utf-8")
    for drawn, picture in PICTURES:
        shutil.copyfile(nasa / "plots" / drawn, DOCS / "images" / picture)
    shutil.copyfile(helical / "plots" / "cost.png", DOCS / "images" / "cost_helical_load.png")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:4]))
