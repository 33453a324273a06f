"""The root-stress formulas by the names that case files use, and their table over load positions."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from fegear.formulas import cornell_heywood, dolan_broghamer, heywood
from fegear.formulas.agma import agma908
from fegear.formulas.iso6336 import part3_root_stress
from fegear.formulas.outcome import Outcome, RootStress, RootStressSource, attempt
from fegear.geometry.external_tooth import Tooth

ROOT_STRESS_SOURCES: dict[str, RootStressSource] = {
    s.name: s
    for s in (
        cornell_heywood.SOURCE,
        cornell_heywood.TROCHOID_SOURCE,
        heywood.SOURCE,
        part3_root_stress.SOURCE,
        agma908.SOURCE,
        dolan_broghamer.SOURCE,
    )
}


def root_stress_table(tooth: Tooth, radii: ArrayLike) -> dict[str, tuple[Outcome[RootStress], ...]]:
    """Every root-stress formula at every load radius [modules]; a point out of range carries its reason in words."""
    points = [float(r) for r in np.atleast_1d(np.asarray(radii, dtype=float))]
    return {
        name: tuple(attempt(partial(source.formula, tooth, r)) for r in points)
        for name, source in ROOT_STRESS_SOURCES.items()
    }
