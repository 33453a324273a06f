"""How often each root-stress formula is how far off: tables and pictures of docs/kind-or-harsh.md.

Run as ``python benchmarks/kind_or_harsh_study.py`` (some minutes) to solve the population of spur gears anew into
docs/studies/root_stress_population.csv; ``--page`` draws from the committed tables and fills the page alone. The table
of helical pairs is made by benchmarks/helical_root_stress_study.py, that of K_Hbeta by benchmarks/khbeta_study.py.
"""

from __future__ import annotations

import csv
import math
import re
import sys
from pathlib import Path

import helical_root_stress_study as helical
import khbeta_study as khbeta
import numpy as np
import slices_study as slices

from fegear.contact.compared.formula_reach import off, reach, sentence
from fegear.contact.compared.population import drawn_gears
from fegear.contact.compared.root_stress_study import of_population, root_stress_study
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.load_factors import iso_face_load_factor
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve, Mark, Zone
from fegear.engine.figure.panel import Panel
from fegear.fem.plane.settings import MeshSettings
from fegear.formulas.root_stress_formulas import ROOT_STRESS_SOURCES
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.rack import BasicRack
from fegear.output.draw_png import draw_pictures
from fegear.results.gear.root_stress_spread import fe_error, sentences, spread, spread_figure

DOCS = Path(__file__).resolve().parents[1] / "docs"
TABLE = DOCS / "studies" / "root_stress_population.csv"
PAGE = DOCS / "kind-or-harsh.md"
COMMAND = "# python benchmarks/kind_or_harsh_study.py"
#: Gears of each pressure angle [deg]; their box; settings of the finite elements.
GEARS = {20: 128, 25: 64}
BOX = {
    "teeth": (12.0, 150.0), "profile_shift": (-0.4, 0.8), "rack_tip_radius": (0.1, 0.45), "rack_dedendum": (1.15, 1.4),
}  # fmt: skip
SEED, SETTINGS = 6336, MeshSettings(root_edge_length=0.04)
NAMES = tuple(ROOT_STRESS_SOURCES)
KEYS = ("teeth", "profile_shift", "rack_tip_radius", "rack_dedendum", "pressure_angle", "load_position")
HEAD = (*KEYS, "fe", "fe_error", *NAMES)
#: Pictures, formulas of helical pairs and how the page calls them.
SPUR, HELICAL = "root_stress_spread", "helical_root_stress_spread"
RATED = {"iso_2006": "ISO 6336-3:2006", "iso_2019": "ISO 6336-3:2019", "agma": "AGMA 908"}


def solve() -> None:
    """Solve the population and write its table: stresses times module over line load."""
    lines = [COMMAND, ",".join(HEAD)]
    for degrees, count in GEARS.items():
        base = Gear(Tooth(28, BasicRack(1.0, 1.25, 0.25, math.radians(degrees))), 1e-3, 6.375e-3)
        gears = of_population(drawn_gears(base, BOX, count, SEED + degrees))
        for one in root_stress_study(gears, (), SETTINGS, estimate_error=True):
            v = one.variant
            for i, at in enumerate(one.position.tolist()):
                dedendum = v.gear.tooth.rack.dedendum if v.gear else math.nan
                cells = [v.teeth, v.profile_shift, v.rack_tip_radius, dedendum, degrees, at, one.fe[i], one.fe_error[i]]
                cells += [one.answers[name].stress[i] if one.answers else math.nan for name in NAMES]
                lines.append(",".join(f"{c:.4g}" for c in cells))
        print(degrees, len(lines), flush=True)
    TABLE.write_text("\n".join(lines) + "\n", encoding="utf-8")


def population() -> dict[str, np.ndarray]:
    """The committed table in the columns of table ``root_stress_study``."""
    with TABLE.open(encoding="utf-8", newline="") as file:
        if file.readline().strip() != COMMAND:
            raise ValueError(f"{TABLE} does not start with its command")
        rows = list(csv.DictReader(file))
    known = {key: np.array([float(r[key]) for r in rows]) for key in HEAD}
    table = {key: np.tile(known[key], len(NAMES)) for key in KEYS}
    table["formula"] = np.repeat(np.array(NAMES), len(rows))
    table["stress_fe"] = np.tile(known["fe"], len(NAMES))
    table["stress_fe_error"] = np.tile(known["fe_error"], len(NAMES))
    table["ratio_to_fe"] = np.concatenate([known[name] / known["fe"] for name in NAMES])
    return table


def helical_ratios(against: str) -> dict[str, np.ndarray]:
    """Formula over finite elements of all helical gears; `against` is "fe_even" or "fe"."""
    rows = [r for r in helical.table() if float(r["tolerance"]) == helical.TOLERANCE]
    return {key: np.array([float(r[key]) / float(r[against]) for r in rows]) for key in RATED}


def helical_error(column: str = "fe_even") -> float:
    """Largest relative difference of finer settings, over the gears that were solved with both."""
    rows = helical.table()
    fine = {(r["pair"], r["member"]): float(r[column]) for r in rows if float(r["tolerance"]) == helical.FINE}
    coarse = {(r["pair"], r["member"]): float(r[column]) for r in rows if float(r["tolerance"]) == helical.TOLERANCE}
    return max(abs(coarse[key] / value - 1.0) for key, value in fine.items())


def helical_figure() -> Figure:
    """Cumulative distributions of both gears of all helical pairs."""
    panels = []
    for against, title in (("fe_even", "load even over the contact lines"), ("fe", "load as the flanks share it")):
        off = helical_error(against)
        known = {RATED[key]: spread(ratio) for key, ratio in helical_ratios(against).items()}
        curves = tuple(
            Curve(one.ratio, 100.0 * one.share, name, f"series:{i}", dash="steps", markers=False)
            for i, (name, one) in enumerate(known.items()) if one is not None
        )  # fmt: skip
        panels.append(
            Panel(
                Axis("root stress, formula / FE", limits=(0.5, 1.5)),
                Axis("gears with a smaller ratio", "%", limits=(0.0, 100.0)), curves,
                (Zone("x", 1.0 - off, 1.0 + off), Mark("x", 1.0), Mark("y", 50.0)), title=title,
            )
        )  # fmt: skip
    low, high = helical.LOW, helical.HIGH
    return Figure(
        HELICAL,
        "Root stress of helical pairs: formula over solid gears",
        f"Both gears of {helical.COUNT} pairs drawn evenly over pinions of {low[0]:.0f} to {high[0]:.0f} teeth, ratios "
        f"of {low[1]:g} to {high[1]:g}, shifts of {low[2]:g} to {high[2]:g},"
        f" {low[3]:g} to {high[3]:g} degrees, faces of "
        f"{low[4]:g} to {high[4]:g} modules and tip radii of {low[5]:g} to {high[5]:g}. Grey: largest change under "
        "finer settings.",
        tuple(panels), columns=2,
    )  # fmt: skip


#: Columns of the helical table of which a range may speak, and the words for them.
SPOKEN = {
    "teeth": ("z", ""), "profile_shift": ("x", ""), "helix_angle [deg]": ("helix angle", "°"),
    "face_width [modules]": ("face width", "modules"), "overlap_ratio": ("overlap ratio", ""),
    "rack_tip_radius": ("rack tip radius", "modules"),
}  # fmt: skip


def helical_sentences() -> list[str]:
    """A sentence for each formula: compared with uniform loads, and its deviation under computed load distributions."""
    rows = [r for r in helical.table() if float(r["tolerance"]) == helical.TOLERANCE]
    columns = {key: np.array([float(r[key]) for r in rows]) for key in SPOKEN}
    pair = np.array([int(r["pair"]) for r in rows])
    even, solved, found = helical_ratios("fe_even"), helical_ratios("fe"), []
    for key, name in RATED.items():
        one = reach(name, even[key], columns, pair, np.zeros(pair.size, dtype=bool))
        shared = reach(name, solved[key], columns, pair, np.zeros(pair.size, dtype=bool))
        ends = f"{off(shared.low)} to {off(shared.high)} (median {off(shared.median)})"
        near = f"{100.0 * shared.near:.0f} %"
        said = sentence(one, SPOKEN)[:-1].replace("over all loads", "under uniform loads")
        found.append(f"{said}, and {ends} under the computed load distribution, where {near} of gears are within 10 %.")
    return found


def khbeta_map() -> list[str]:
    """ISO 6336-1's K_Hbeta over that of the misaligned solid pairs of docs/studies/slices.csv."""
    known = {
        (float(r["helix_angle [deg]"]), float(r["face_width [modules]"])): float(r["face_load_factor_misaligned"])
        for r in slices.table()
        if r["body"] == "solid"
    }
    lines = ["| face width, modules |" + "".join(f" {a}° |" for a in slices.ANGLES)]
    lines.append("|---|" + "---|" * len(slices.ANGLES))
    for width in slices.WIDTHS:
        cells = []
        for angle in slices.ANGLES:
            pair = slices.the_pair(angle, width)
            half = 0.5 * pair.face_width
            line = np.array([-0.5, 0.5]) * slices.MISALIGNED
            gaps = FlankGaps(face_position=np.array([-half, half]), line_gap=line)
            iso = iso_face_load_factor(pair, gaps, slices.LOAD * pair.face_width)
            cells.append(f"{iso / known[float(angle), float(width)]:.2f}")
        lines.append(f"| {width} | " + " | ".join(cells) + " |")
    return lines


def khbeta_table() -> list[str]:
    """Rows of the table of causes."""
    lines = ["| given up | spur: K_Hbeta | change | aligned | helical: K_Hbeta | change | aligned |", "|" + "---|" * 7]
    rows = khbeta.table()
    for cause in khbeta.CAUSES:
        cells = [cause]
        for name in khbeta.STUDIED:
            r = next(r for r in rows if (r["case"], r["given_up"]) == (name, cause))
            change = f"{100.0 * float(r['change']):+.1f} %" if r["change"] else ""
            off = f" ± {float(r['error']):.2f}" if float(r["error"]) >= 0.005 else ""
            cells += [f"{float(r['K_Hbeta']):.3f}{off}", change, f"{float(r['K_Hbeta_aligned']):.3f}"]
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def blocks() -> dict[str, str]:
    """What the page has between its marks."""
    table = population()
    error = f"Estimated error of the finite elements: {100.0 * fe_error(table):.2g} % at 95 % of the points."
    return {
        "spur sentences": "\n".join(f"- {s}" for s in sentences(table)) + f"\n\n{error}",
        "helical sentences": "\n".join(f"- {s}" for s in helical_sentences()),
        "K_Hbeta": "\n".join(khbeta_table()),
        "K_Hbeta over face and helix": "\n".join(khbeta_map()),
    }


def filled(text: str) -> str:
    """The page with its computed blocks anew."""
    for mark, block in blocks().items():
        pattern = re.compile(rf"(<!-- {re.escape(mark)} -->\n).*?(<!-- end of {re.escape(mark)} -->)", re.DOTALL)
        if not pattern.search(text):
            raise ValueError(f"{PAGE} has no marks for {mark}")
        text = pattern.sub(lambda m, b=block: m[1] + "\n" + b + "\n\n" + m[2], text)
    return text


def main() -> None:
    """Solve unless only the page is wanted, draw, fill the page."""
    if "--page" not in sys.argv:
        solve()
    for figure in (spread_figure(population(), SPUR), helical_figure()):
        for _ in draw_pictures(figure, DOCS / "images"):
            pass
    PAGE.write_text(filled(PAGE.read_text("utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main()
