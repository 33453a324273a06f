"""Stage ``flank-surface``: sliding, pressure, temperatures and lubricant film from A to E."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import RangeError
from fegear.base.notes import assuming, failing, neglecting
from fegear.base.printed import percent
from fegear.case.built.pair_surface import PairSurface, pair_surface, tip_reliefs
from fegear.engine.citation import Citation, citing
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Upstream, Work
from fegear.geometry.pair import MEMBER_WORDS
from fegear.results.pair.flank_surface_data import FlankSurfaceData, ShownSurface
from fegear.results.pair.flank_surface_sheet import FIGURES, TABLES, VALUES
from fegear.results.pair.loaded_teeth import check_teeth, loaded_teeth, teeth_stage

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.contact.surface import FlankSurface


@dataclass(frozen=True)
class FlankSurfaceInputs:
    """What is read of the case besides the loaded pair.

    Parameters
    ----------
    surface : PairSurface
    name : str
        Of the pair.
    """

    surface: PairSurface
    name: str = field(compare=False)


def _inputs(scene: Scene, name: str) -> FlankSurfaceInputs:
    return FlankSurfaceInputs(pair_surface(scene, name, tip_reliefs(scene, name)), name)


def _check(scene: Scene, name: str) -> None:
    check_teeth(scene, name)
    pair_surface(scene, name, tip_reliefs(scene, name))


def _standards(asked: PairSurface, computed: FlankSurface, *, wide: bool, outside: float) -> FlankSurfaceData:
    from fegear.formulas.iso6336 import part20_flash, part21_integral, part22_micropitting

    rated, tests = asked.rated, asked.tests
    integral, why = None, ""
    try:
        integral = part21_integral.integral_temperature(rated)
    except RangeError as error:
        why = str(error)
    scuffing = scuffing_integral = permissible = math.nan
    if tests.scuffing_stage is not None:
        scuffing = part20_flash.scuffing_temperature(rated, tests.scuffing_stage)
        scuffing_integral = part21_integral.scuffing_integral_temperature(rated, tests.scuffing_stage)
    elif tests.scuffing_temperature is not None:
        scuffing = tests.scuffing_temperature
    if tests.permissible_film is not None:
        permissible = tests.permissible_film
    elif tests.micropitting_stage is not None:
        permissible = part22_micropitting.permissible_ratio(
            rated.surface.oil, tests.micropitting_stage, tests.micropitting_temperature, tests.material_factor
        )
    return FlankSurfaceData(
        rated.pair, computed, wide, part20_flash.flash_temperatures(rated, computed.x),
        part22_micropitting.rated_film(rated, computed.x), part22_micropitting.least_ratio(rated), integral, scuffing,
        scuffing_integral, permissible, outside, why,
    )  # fmt: skip


def _compute(inputs: FlankSurfaceInputs, upstream: Upstream, _work: Work) -> FlankSurfaceData:
    from fegear.contact.surface import flank_surface

    asked, rated = inputs.surface, inputs.surface.rated
    found, factors = loaded_teeth(upstream, inputs.name).flank_load(rated.pair), rated.factors
    # uneven sharing is computed, and load over the face for teeth with a width; shocks and what machines add are not
    scale = factors.application * factors.dynamic * (1.0 if found.over_face else factors.face)
    law = asked.friction.of(rated.pair, rated.speed, rated.load * scale) if asked.friction else None
    computed = flank_surface(rated, found.x, found.z, found.line_load * scale, law)
    return _standards(asked, computed, wide=found.over_face, outside=found.outside)


def _settings(seen: Seen) -> dict[str, object]:
    rated, tests, friction = seen.data.asked.rated, seen.data.asked.tests, seen.data.asked.friction
    settings: dict[str, object] = {
        "friction": "mean coefficients of the standards" if friction is None else friction.law,
        "load_factors": rated.factors.product,
        "speed": rated.speed,
        "oil_temperature": rated.surface.temperature,
    }
    if tests.scuffing_stage is not None:
        settings["scuffing_load_stage"] = tests.scuffing_stage
    if tests.micropitting_stage is not None:
        settings["micropitting_load_stage"] = tests.micropitting_stage
    return settings


def _remarks(name: str, data: FlankSurfaceData, asked: PairSurface) -> list[str]:
    """What a reader must know of the numbers."""
    told: list[str] = []
    pair = data.pair
    if math.isnan(data.scuffing):
        told.append(
            f"Pair {name}: safety factor for scuffing not computed: lubricant.scuffing_load_stage or "
            "scuffing_temperature not specified."
        )
    oil = asked.rated.surface.temperature
    if data.scuffing <= oil:
        told.append(
            failing(
                f"Pair {name}: the oil temperature of {oil:.4g} degC is not below the scuffing temperature of "
                f"{data.scuffing:.4g} degC: S_B is zero or negative and has no quantitative meaning."
            )
        )
    if math.isnan(data.permissible_film):
        told.append(
            f"Pair {name}: safety factor for micropitting not computed: lubricant.micropitting_load_stage or "
            "permissible_film not specified."
        )
    if data.why_not:
        told.append(f"Pair {name}: no integral temperature: {data.why_not}")
    if pair.contact_ratio >= 2.0 and pair.driver.helix_angle == 0.0:
        told.append(
            assuming(
                f"Pair {name}: load sharing factors of ISO/TS 6336-20 and -22 are defined for contact ratios below 2; "
                "1 used here (see the FE load sharing)."
            )
        )
    if pair.internal:
        told.append(
            assuming(
                f"Pair {name}: ISO/TS 6336-22 applies to external gears; film computed with the signed curvature of "
                "the concave flank, safety factor for micropitting not verified by tests."
            )
        )
    told += _recalled(name, asked)
    if data.share_outside > 0.0:
        told.append(
            neglecting(
                f"Pair {name}: corner contact outside the path of contact carries up to {percent(data.share_outside)} "
                "of the load; no temperature and film computed there."
            )
        )
    if asked.rated.factors.product != 1.0:
        told.append(
            f"Pair {name}: load sharing at nominal load, multiplied by the load factors; the computed distribution "
            f"replaces {'K_Hbeta and K_Halpha' if data.wide else 'K_Halpha'}."
        )
    for member in ("driver", "driven"):
        gear = pair.gear(member)
        reach = float(np.abs(pair.flank_curvature_radius(np.array([pair.x_start, pair.x_end]), member)).min())
        if reach < 0.02 * gear.base_radius:
            told.append(
                f"Pair {name}: contact close to the base circle of the {MEMBER_WORDS[member]}: specific sliding "
                "becomes very large, film thickness and curvature radius approach zero."
            )
    return told


def _recalled(name: str, asked: PairSurface) -> list[str]:
    """Say which factors are those of no printed source."""
    from fegear.formulas.iso6336.part22_micropitting import narrow

    told: list[str] = []
    if narrow(asked.rated.pair):
        told.append(
            assuming(
                f"Pair {name}: X_Y of ISO/TS 6336-22 for overlap ratio {asked.rated.pair.overlap_ratio:.3g} is not "
                "verified against a printed source (verified from 1.2)."
            )
        )
    if asked.tests.micropitting_stage is not None:
        told.append(
            assuming(
                f"Pair {name}: line load at A of the FZG gears scaled with torque for lambda_GFP (published for load "
                "stage 10 only, 236.3 N/mm)."
            )
        )
    return told


_SHEET = Sheet(
    of=lambda data, asked: ShownSurface(data, asked.surface),
    tables=TABLES,
    values=VALUES,
    figures=FIGURES,
    remarks=(
        lambda seen: seen.data.asked.remarks,
        lambda seen: _remarks(seen.name, seen.data.data, seen.data.asked),
    ),
    settings=_settings,
)


def _forecast(_scene: Scene, _name: str) -> Forecast:
    return Forecast({}, 0.05)


_CITES = citing(
    Citation("iso-ts-6336-20", "flash temperature and scuffing safety S_B", "clauses 5 to 10"),
    Citation("iso-ts-6336-21", "integral temperature and scuffing safety S_intS", "clause 6.1"),
    Citation("iso-ts-6336-22", "film thickness and micropitting safety S_lambda", "clauses 5 to 11"),
    Citation("blok", "flash temperature of sliding flanks"),
)

FLANK_SURFACE = teeth_stage(
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    cites=_CITES,
    forecast=_forecast,
)
