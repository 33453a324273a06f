"""Stated errors of loaded flanks: few roll positions, long panels, crowns to spots, several loads."""

import itertools
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fegear.base.solution_cache import SolutionCache
from fegear.case.built.pair_spec import pair_spec
from fegear.case.built.solid_influence import solid_gear_to_solve, solve_solid_influence
from fegear.case.reading import read_scene
from fegear.contact.wide.error import flank_error
from fegear.contact.wide.loaded import FlankPair
from fegear.contact.wide.maker import load_flanks
from fegear.contact.wide.over_pitch import over_pitch
from fegear.geometry.pair import MEMBERS
from tests.helpers.solved_once import CACHE

pytestmark = pytest.mark.last_bit

CASES = Path(__file__).parents[2] / "cases"
POSITIONS = (8, 12, 16, 24)
#: Crowning of the pair [um], tip edges and reliefs, loads besides the nominal one, panels over the face.
SCENES = (
    (0, True, False, (7200,), 16), (0, False, True, (1200,), 32), (20, False, False, (1200,), 16),
    (100, False, False, (900,), 16), (200, False, True, (1200, 7200), 64), (1000, False, False, (1200,), 24),
    (1000, True, False, (7200,), 16),
)  # fmt: skip
QUANTITIES = ("mean", "peak_to_peak", "face_load_factor", "largest_line_load", "largest_pressure")


def loaded(case, tolerance, scene, panels, positions):
    """A pair of a case, loaded, and what is stated of it."""
    crown, edges, relief, loads, _ = scene
    part = read_scene(CASES / f"{case}.toml", [
        f"accuracy.tolerance={tolerance}", f'pair.I.line_error.crowning="{crown} um"', "effects.misalignment=true",
        f"effects.corner_contact={str(edges).lower()}", f"effects.relief={str(relief).lower()}",
        f"pair.I.loads={[f'{load} N' for load in (*loads, 3600)]}",
    ])  # fmt: skip
    asked = replace(pair_spec(part, "I"), panels=panels, positions=positions)
    solved = [solve_solid_influence(solid_gear_to_solve(part, gear), CACHE) for gear in asked.gears]
    fine, coarse = (
        {m: getattr(one, key) for m, one in zip(MEMBERS, solved, strict=True)} for key in ("fine", "coarse")
    )
    flanks, gaps, found = load_flanks(asked, fine, SolutionCache())
    over = over_pitch(flanks, found, gaps, asked.nominal)
    assert isinstance(flanks, FlankPair)
    return asked, over, lambda: flank_error(flanks, found, coarse, gaps, over, asked.nominal)


@pytest.mark.long
@pytest.mark.parametrize(("case", "tolerance"), [("helical_load", 2e-2), ("spur_misaligned", 5e-2)])
def test_errors_cover_what_finer_everything_changes(case, tolerance):
    """Compared with gears of a fourth of the tolerance, 64 panels and 96 roll positions, peaks looked for as well."""
    ratios = []
    for scene in SCENES:
        _, true, _ = loaded(case, 5e-3, scene, 64, 96)
        for positions in POSITIONS if scene is SCENES[0] else POSITIONS[1:2]:
            _, over, error = loaded(case, tolerance, scene, scene[4], positions)
            stated, left = over.stated, error()
            for key, i in itertools.product(QUANTITIES, range(len(true.stated.mean))):
                off = abs(getattr(stated, key)[i] - getattr(true.stated, key)[i])
                ratios.append((off / getattr(left, key)[i], scene, positions, key, i))
    off = np.array([ratio for ratio, *_ in ratios])
    assert off.max() < 1.5, max(ratios)
    # and they are no blanket: a number may be right by chance, most are not by twenty times
    assert np.median(off) > 0.05
    assert np.quantile(off, 0.25) > 0.02
