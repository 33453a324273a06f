"""Why K_Hbeta of ISO 6336-1 and of loaded solid flanks differ, cause by cause: docs/studies/khbeta.csv.

Run as ``python benchmarks/khbeta_study.py`` (some minutes) to make the table anew. From the closed formula one
assumption after the other is given up, until the loaded solid flanks of `cases/khbeta_spur.toml` and
`cases/khbeta_helical.toml` remain; each row is K_Hbeta with all assumptions above it given up.
"""

from __future__ import annotations

import csv
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fegear.case.reading import read_scene
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.load_factors import iso_face_load_factor
from fegear.contact.wide.loaded import FlankPair
from fegear.contact.wide.tip_edges import usual_gap
from fegear.fem.solid.settings import solid_settings
from fegear.fem.solid.slices import solve_thin_slices
from fegear.fem.solid.solution import solve_solid
from fegear.formulas.iso6336.part1_face_load import face_load_factor

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.fem.solid.flank_body import FlankBody
    from fegear.geometry.pair import GearPair, Member

DOCS = Path(__file__).resolve().parents[1] / "docs"
CASES = DOCS.parent / "cases"
TABLE = DOCS / "studies" / "khbeta.csv"
COMMAND = "# python benchmarks/khbeta_study.py"
HEAD = ("case", "given_up", "K_Hbeta", "change", "K_Hbeta_aligned", "error")
STUDIED = ("khbeta_spur", "khbeta_helical")
#: Of the solid gears, and that of a second run whose difference is the estimated error.
TOLERANCE, COARSE, POSITIONS, PANEL = 1e-2, 3e-2, 16, 0.5
CAUSES = (
    "nothing: ISO 6336-1, closed formula",
    "c_gamma_beta of the standard, for the mean stiffness of thin slices",
    "a row of equal springs, for thin slices with their pairs, Hertz and ends of lines",
    "uncoupled slices, for one body along the face, held axially",
    "no axial displacement, for free end faces and a body that bends",
    "tooth pairs that do not feel each other, for one body",
    "lines that end at the tips, loaded tip edges included",
)


def bodies(pair: GearPair, solver: Callable[..., FlankBody], tolerance: float) -> dict[Member, FlankBody]:
    """Both gears solved."""
    found: dict[Member, FlankBody] = {}
    m = pair.driver.module
    for member in ("driver", "driven"):
        gear = pair.gear(member)
        size = gear.twist * m, gear.face_width / m, gear.material.poisson_ratio, gear.bore_radius / m
        found[member] = solver(gear.tooth, *size, solid_settings(tolerance), reach=1)
    return found


def ladder(name: str, tolerance: float) -> list[tuple[float, float]]:
    """K_Hbeta of every row: misaligned, and aligned."""
    scene = read_scene(CASES / f"{name}.toml", [])
    pair, load = scene.pairs["I"], float(scene.case.pair["I"].load)
    half, lead = 0.5 * pair.face_width, scene.case.pair["I"].line_error.over_face
    gaps = FlankGaps(face_position=np.array([-half, half]), line_gap=np.array([-0.5, 0.5]) * lead)

    def both(found: dict[Member, FlankBody], coupling: bool, edge: float) -> tuple[float, float]:
        flanks = FlankPair(pair, found, coupling=coupling, most_gap=edge, positions=POSITIONS, panel=PANEL)
        known = flanks.compliance(load)
        askew, straight = (flanks.solve(load, g, known).face_load_factor[0] for g in (gaps, FlankGaps()))
        return float(askew), float(straight)

    thin = bodies(pair, solve_thin_slices, tolerance)
    aligned = FlankPair(pair, thin, coupling=False, positions=POSITIONS, panel=PANEL).solve([0.9 * load, 1.1 * load])
    stiffness = 0.2 * load / float(np.diff(aligned.mean_transmission_error)[0]) / pair.face_width
    held, solid = (bodies(pair, partial(solve_solid, plane_strain=p), tolerance) for p in (True, False))
    return [
        (iso_face_load_factor(pair, gaps, load), 1.0),
        (face_load_factor(lead, stiffness, load / pair.face_width), 1.0),
        both(thin, False, 0.0),
        both(held, False, 0.0),
        both(solid, False, 0.0),
        both(solid, True, 0.0),
        both(solid, True, usual_gap(pair, load)),
    ]


def table() -> list[dict[str, str]]:
    """The committed table."""
    with TABLE.open(encoding="utf-8", newline="") as file:
        if file.readline().strip() != COMMAND:
            raise ValueError(f"{TABLE} does not start with its command")
        return list(csv.DictReader(file))


def main() -> None:
    """Make the table."""
    lines = [COMMAND, ",".join(HEAD)]
    for name in STUDIED:
        before = None
        for cause, fine, coarse in zip(CAUSES, ladder(name, TOLERANCE), ladder(name, COARSE), strict=True):
            change = "" if before is None else f"{fine[0] / before - 1.0:.4f}"
            off = abs(fine[0] - coarse[0])
            lines.append(f'{name},"{cause}",{fine[0]:.5g},{change},{fine[1]:.5g},{off:.2g}')
            print(lines[-1], flush=True)
            before = fine[0]
    TABLE.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
