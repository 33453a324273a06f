"""What slices get wrong over helix angle and face width: the table docs/studies/slices.csv, and its picture.

Run as ``python benchmarks/slices_study.py`` (a quarter of an hour) to make both anew; ``--picture`` draws the committed
table.
"""

from __future__ import annotations

import csv
import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.loaded import FlankPair
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve
from fegear.engine.figure.panel import Panel
from fegear.fem.solid.settings import solid_settings
from fegear.fem.solid.slices import solve_slices, solve_thin_slices
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.output.draw_png import draw_pictures

if TYPE_CHECKING:
    from fegear.fem.solid.flank_body import FlankBody
    from fegear.geometry.pair import Member

TABLE = Path(__file__).resolve().parents[1] / "docs" / "studies" / "slices.csv"
IMAGES = Path(__file__).resolve().parents[1] / "docs" / "images"
PICTURE = "slices_study"
#: The first line of the table.
COMMAND = "# python benchmarks/slices_study.py"
HEAD = (
    "helix_angle [deg]", "face_width [modules]", "body", "mean_te [um]", "peak_to_peak [um]", "face_load_factor",
    "face_load_factor_misaligned",
)  # fmt: skip
#: Teeth, normal module [m], load per face width [N/m], misalignment over the face [m].
TEETH, MODULE, LOAD, MISALIGNED = (23, 57), 3e-3, 300e3, 10e-6
ANGLES, WIDTHS = range(0, 36, 5), (4, 6, 8, 12, 16)
#: Of the solid gears; 1 % moves what the table says of them by less than its errors (see the test).
TOLERANCE, POSITIONS, PANEL = 2e-2, 24, 0.5
SOLVERS = {"solid": solve_solid, "slices": solve_slices, "thin slices": solve_thin_slices}


def the_pair(angle: float, width: float) -> GearPair:
    """The pair of the study at a helix angle [deg] and a face width [modules]."""
    beta = math.radians(angle)
    gears = []
    for teeth, hand in zip(TEETH, ("right", "left"), strict=True):
        tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25), helix_angle=beta)
        bore = 0.5 * tooth.root_radius * MODULE
        gears.append(Gear(tooth, MODULE, bore, width * MODULE, hand=hand if angle else "spur"))
    return GearPair(*gears)


def bodies(pair: GearPair, body: str, tolerance: float = TOLERANCE) -> dict[Member, FlankBody]:
    """Both gears as solids, as slices or as thin slices."""
    found: dict[Member, FlankBody] = {}
    for member in ("driver", "driven"):
        gear, settings = pair.gear(member), solid_settings(tolerance)
        size = gear.twist * MODULE, gear.face_width / MODULE, gear.material.poisson_ratio, gear.bore_radius / MODULE
        found[member] = SOLVERS[body](gear.tooth, *size, settings, reach=1)
    return found


def row(angle: float, width: float, body: str, tolerance: float = TOLERANCE, positions: int = POSITIONS,
        panel: float = PANEL) -> tuple[float | str, ...]:  # fmt: skip
    """A row of the table."""
    pair = the_pair(angle, width)
    flanks = FlankPair(pair, bodies(pair, body, tolerance), panel=panel, positions=positions)
    load = LOAD * pair.face_width
    known = flanks.compliance(load)
    half = 0.5 * pair.face_width
    tilted = FlankGaps(face_position=np.array([-half, half]), line_gap=np.array([-0.5, 0.5]) * MISALIGNED)
    found, askew = (flanks.solve(load, gaps, known) for gaps in (FlankGaps(), tilted))
    error = found.transmission_error[:, 0] * 1e6
    return (angle, width, body, float(found.mean_transmission_error[0]) * 1e6, float(np.ptp(error)),
            float(found.face_load_factor[0]), float(askew.face_load_factor[0]))  # fmt: skip


def table() -> list[dict[str, str]]:
    """The committed table."""
    with TABLE.open(encoding="utf-8", newline="") as file:
        if file.readline().strip() != COMMAND:
            raise ValueError(f"{TABLE} does not start with its command")
        return list(csv.DictReader(file))


def figure() -> Figure:
    """Over the helix angle: how far mean, peak to peak and face load factor of slices are from the solid's."""
    rows = table()

    def values(body: str, width: int, column: str) -> np.ndarray:
        return np.array([float(r[column]) for r in rows
                         if r["body"] == body and float(r["face_width [modules]"]) == width])  # fmt: skip

    shown = {
        "mean_te [um]": ("mean transmission error", "over the solid's"),
        "peak_to_peak [um]": ("peak to peak", "over the solid's"),
        "face_load_factor_misaligned": ("K_{Hβ}, 10 µm askew", "over the solid's"),
    }
    panels = []
    for body in ("thin slices", "slices"):
        for column, (title, unit) in shown.items():
            curves = tuple(
                Curve(np.array(ANGLES, dtype=float), values(body, w, column) / values("solid", w, column),
                      f"{w} modules wide", f"series:{i}", markers=True)
                for i, w in enumerate(WIDTHS)
            )  # fmt: skip
            panels.append(Panel(Axis("helix angle", "deg"), Axis(unit), curves, title=f"{body}: {title}"))
    return Figure(
        PICTURE, "What slices get wrong",
        f"z = {TEETH[0]}/{TEETH[1]}, m_n = 3 mm, {LOAD * 1e-3:.0f} N/mm, no modifications. Above: thin slices, "
        "uncoupled. Below: slices coupled along the face.",
        tuple(panels), columns=3,
    )  # fmt: skip


def main() -> None:
    """Make the table, unless asked for the picture alone, and draw it."""
    if "--picture" not in sys.argv:
        make_table()
    for _ in draw_pictures(figure(), IMAGES):
        pass


def make_table() -> None:
    """Make the table."""
    lines = [COMMAND, ",".join(HEAD)]
    for width in WIDTHS:
        for angle in ANGLES:
            for body in SOLVERS:
                cells = row(float(angle), float(width), body)
                lines.append(",".join(f"{c:.6g}" if isinstance(c, float) else c for c in cells))
                print(lines[-1], flush=True)
    TABLE.parent.mkdir(exist_ok=True)
    TABLE.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
