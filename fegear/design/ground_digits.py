"""Digits of a relief that a drawing bears and a shop can grind, and the relief with these digits."""

from __future__ import annotations

import math
from dataclasses import replace

from fegear.design.tip_relief.grindable import TipReliefPair
from fegear.geometry.gear import Gear
from fegear.geometry.pair import MEMBERS, GearPair
from fegear.geometry.relief import EndRelief, roll_of_radius

#: Steps of amounts [m], of diameters and lengths [m] and of angles [rad]: 0.1 µm, 0.001 mm, 0.01 deg.
AMOUNT_STEP, LENGTH_STEP, ANGLE_STEP = 1e-7, 1e-6, math.radians(0.01)


def amount_step(largest: float) -> float:
    """Step of the amounts of a design whose largest is this [m]; below 1 µm two digits of it."""
    size = abs(largest)
    if not 0.0 < size < 10.0 * AMOUNT_STEP:
        return AMOUNT_STEP
    return AMOUNT_STEP * 10.0 ** (math.floor(math.log10(size)) + 6)


def to_step(size: float, step: float) -> float:
    """The nearest multiple of a step; nan stays."""
    return size if math.isnan(size) else round(size / step) * step


def rounded_tips(pair: GearPair, ground: TipReliefPair) -> TipReliefPair:
    """Tip reliefs of a pair with the amounts and start diameters of the grinding table."""
    step = amount_step(max(ground.driver.amount, ground.driven.amount))
    driver, driven = (_rounded(pair.gear(member), getattr(ground, member), step) for member in MEMBERS)
    return replace(ground, driver=driver, driven=driven)


def _rounded(gear: Gear, tip: EndRelief, step: float) -> EndRelief:
    amount = to_step(tip.amount, step)
    radius = 0.5 * to_step(2.0 * gear.base_radius * math.hypot(1.0, tip.start), LENGTH_STEP)
    start = float(roll_of_radius(gear, radius)) if radius > gear.base_radius else tip.start
    if (tip.end - start) * math.copysign(gear.base_radius, tip.end - tip.start) < LENGTH_STEP:  # nothing would be left
        start = tip.start
    return replace(tip, amount=amount, start=start)
