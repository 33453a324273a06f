"""Measured natural frequencies beside the modes of a train: how far they are off, and what would explain it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.base.arrays import Array
    from fegear.dynamics.train.gear_train import GearTrain
    from fegear.dynamics.train.measured_modes import MeasuredModes
    from fegear.dynamics.train.one_cause import OneCause
    from fegear.engine.sheet.seen import Seen


def causes_of(data: GearTrain, measured: MeasuredModes | None) -> OneCause | None:
    """What would explain what was measured."""
    from fegear.dynamics.train.one_cause import one_cause

    return None if measured is None else one_cause(data.train, measured)


def measured_beside(given: list[float] | None, natural: Array) -> MeasuredModes | None:
    """What was measured beside the natural frequencies above zero."""
    if given is None:
        return None
    if len(given) > natural.size:
        raise InputError(
            "dynamics.measured_frequencies", f"{len(given)} frequencies",
            f"exceeds the {natural.size} natural frequencies above zero of the train "
            f"({', '.join(f'{one:.4g}' for one in natural)} Hz)",
            "remove those of other parts (bending, housing, supports), or add bodies",
        )  # fmt: skip
    from fegear.dynamics.train.measured_modes import beside_modes

    return beside_modes(np.array(given), natural)


def beside(seen: Seen) -> Iterator[str]:
    """How far measured frequencies are off."""
    if (found := seen.data.measured) is not None:
        one = found.measured.size == 1
        causes: OneCause = seen.data.causes
        judged = found.off if causes.said and not one else found.verdict  # beside a cause no common factor
        yield f"Measured natural {'frequency is' if one else 'frequencies are'} {judged}."


def explained(seen: Seen) -> list[str]:
    """Which spring or inertia explains measured frequencies."""
    causes: OneCause | None = seen.data.causes
    return [causes.said] if causes is not None and causes.said else []
