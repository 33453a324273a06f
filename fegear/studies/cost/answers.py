"""From a source to the value of a quantity, by the stages that a run uses."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.contact import transmission_error
from fegear.dynamics.single_tooth import force_history
from fegear.engine.executor import Executor
from fegear.engine.stage import Task, Work
from fegear.errors import RangeError
from fegear.geometry.pair import MEMBERS
from fegear.models.loaded_pair import build_loaded_pair, engagement_at_rest
from fegear.models.motion import motion_inputs, motion_model
from fegear.models.neglected_effects import Neglected
from fegear.models.pair_inputs import pair_inputs
from fegear.models.train import train_inputs
from fegear.results.gear_train import compute_train
from fegear.results.loaded_pair import LoadedPairData
from fegear.solution_cache import SolutionCache

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.contact import TransmissionError
    from fegear.dynamics.gear_train import GearTrain
    from fegear.models.loaded_pair import LoadedPair
    from fegear.studies.cost.asked import Asked
    from fegear.studies.cost.quantities import Quantity
    from fegear.studies.cost.sources import Source


#: Places over the base pitch at which compliances of pairs are compared.
_PLACES = 12
#: Harmonics of the transmission error and of the forces that a run sums.
HARMONICS, FORCE_HARMONICS = 64, 256


def loaded(asked: Asked, source: Source, name: str) -> LoadedPair:
    """A pair with the compliances of a source."""
    driver, driven = (source.compliance(name, member, asked) for member in MEMBERS)
    inputs = pair_inputs(asked.scene, name)
    return build_loaded_pair(inputs, engagement_at_rest(inputs, (driver, driven)))


def pair_error(asked: Asked, source: Source, order: int = 16) -> TransmissionError:
    """Transmission error of the pair that is studied; `order` is the number of Gauss points between jumps."""
    pair = loaded(asked, source, asked.pair)
    return transmission_error(pair.engagement, pair.nominal, HARMONICS, order=order)


def pair_compliance(asked: Asked, source: Source) -> Array:
    """c_0 of both gears of the pair together where its tooth pairs stand over the path of contact, shape (P,) [m/N].

    Under the nominal load on one tooth pair; for every source at the same places.
    """
    pair = loaded(asked, source, asked.pair)
    e = pair.engagement
    grid = e.grid(e.pair.x_start + e.pair.base_pitch * (np.arange(_PLACES) + 0.5) / _PLACES)
    on = grid.contacts.present & (grid.contacts.gap == 0.0)
    alone = grid.matrices.at_load(np.full((*on.shape, 1), pair.nominal))[..., 0]
    return np.einsum("jjp->jp", alone)[on]


def train_of(asked: Asked, source: Source) -> GearTrain:
    """The train with the compliances of a source in all its meshes."""
    nothing = Neglected({}, {})
    done = {Task("loaded-pair", name): LoadedPairData(loaded(asked, source, name), nothing) for name in asked.pairs}
    work = Work(lambda _fraction: None, SolutionCache(), Executor(here=True))
    return compute_train(train_inputs(asked.scene), done, work)


def largest_force(asked: Asked, data: GearTrain, harmonics: int = FORCE_HARMONICS, positions: int = 0) -> float:
    """Largest force on one tooth pair [N], without the other meshes' share."""
    part = asked.scene.case.dynamics
    found = force_history(
        data, data.train.mesh_index(asked.mesh), part.one_speed, positions or part.positions,
        max(harmonics, part.harmonics) if harmonics == FORCE_HARMONICS else harmonics,
    )  # fmt: skip
    return float(found.total.max())


def factor_at(asked: Asked, data: GearTrain, speed: float, tolerance: float) -> float:
    """Dynamic factor of steady motion at a speed of the reference body [rad/s], started from static deflection."""
    from fegear.dynamics.steady_state import steady_state

    i = data.train.mesh_index(asked.mesh)
    state = steady_state(
        motion_model(motion_inputs(asked.scene), data, speed / data.speed_ratio), start="static", tolerance=tolerance
    )
    if state.kind == "growing":
        raise RangeError(
            "dynamics.speed", f"{speed:.9g} rad/s", f"lets the motion grow {state.multiplier:.4g} times a period",
            "give the meshes damping, let teeth part (effects.contact_loss), or take another speed",
        )  # fmt: skip
    return float(state.tooth_force[i]) / float(data.forces[i])


def speed_looked_at(asked: Asked) -> float:
    """The case's one speed, else the middle of its speeds [rad/s]."""
    part = asked.scene.case.dynamics
    return part.one_speed if np.isfinite(part.one_speed) else float(np.median(part.speed_values))


def answer(asked: Asked, quantity: Quantity, source: Source, order: int = 16) -> Array:
    """Values of a quantity, shape (P,) for a gear's, (1,) for a pair's; SI."""
    if quantity.of_gear:
        return source.of_gear(quantity.name, asked)
    if quantity.name == "te-peak-to-peak":
        return np.array([pair_error(asked, source, order).peak_to_peak])
    if quantity.name == "dynamic-factor":
        tolerance = asked.scene.case.dynamics.tolerance
        return np.array([factor_at(asked, train_of(asked, source), speed_looked_at(asked), tolerance)])
    if asked.mesh and quantity.subject == asked.mesh:
        return np.array([largest_force(asked, train_of(asked, source))])
    return np.array([float(pair_error(asked, source, order).loaded.loads.max())])
