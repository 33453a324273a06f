"""Mesh stiffness and transmission error of a run as functions of the rotation of the driver, under one of its loads."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, Protocol, cast

import numpy as np

from fegear.base.errors import InputError, shown
from fegear.case.nearest import nearest
from fegear.workbench.given import taken
from fegear.workbench.quantities import in_si

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.engine.run import Results
    from fegear.workbench.quantities import Quantity

#: Stages whose data hold such curves; over a revolution before over a tooth, as it has the odd teeth.
_STAGES = ("mesh-stiffness-revolution", "transmission-error")
#: Torques nearer than this, over one of them, are the same.
_SAME = 1e-6
Kind = Literal["tangent", "secant"]


class MeshCurve(Protocol):
    """Periodic in the rotation of the driver [rad]."""

    def stiffness(self, driver_angle: ArrayLike, *, secant: bool = False, under: int | None = None) -> Array:
        """[N/m]."""

    def error(self, driver_angle: ArrayLike, *, under: int | None = None) -> Array:
        """[m]."""

    def start(self, driver_angle: ArrayLike, *, under: int | None = None) -> Array:
        """Where the secant has no force [m]."""

    @property
    def driver_torque(self) -> Array:
        """Of the loads, shape (L,) [N m]."""


class _OverRevolution:
    """The same of a curve over a revolution, which is that under the nominal load."""

    def __init__(self, found: Any) -> None:
        self._found = found

    @property
    def driver_torque(self) -> Array:
        """Of its one load, shape (1,) [N m]."""
        return np.array([self._found.load * self._found.driver_base_radius])

    def stiffness(self, driver_angle: ArrayLike, *, secant: bool = False, under: int | None = None) -> Array:  # noqa: ARG002  (it has one load)
        """[N/m]."""
        found: Array = self._found.stiffness_at(driver_angle, secant=secant)
        return found

    def error(self, driver_angle: ArrayLike, *, under: int | None = None) -> Array:  # noqa: ARG002  (it has one load)
        """[m]."""
        found: Array = self._found.error_at(driver_angle)
        return found

    def start(self, driver_angle: ArrayLike, *, under: int | None = None) -> Array:  # noqa: ARG002  (it has one load)
        """[m]."""
        found: Array = self._found.start_at(driver_angle)
        return found


def curve_of(results: Results, pair: str) -> MeshCurve:
    """The curve of a pair.

    Parameters
    ----------
    results : Results
    pair : str
        Empty for the only one.

    Raises
    ------
    InputError
        If there is none, or several.
    """
    known: dict[str, MeshCurve] = {}
    for stage in _STAGES:
        for task, outcome in results.outcomes.items():
            if task.stage == stage and task.subject not in known:
                found: Any = getattr(outcome.data, "found", None)
                if found is not None:
                    known[task.subject] = _OverRevolution(found) if stage == _STAGES[0] else found
    if not known:
        raise InputError(
            "results", f'"{results.scene.name}"', "have no mesh stiffness over the rotation",
            'request "transmission-error" or "mesh-stiffness-revolution"',
        )  # fmt: skip
    if not pair and len(known) > 1:
        raise InputError("pair", "(not given)", f"is required: {len(known)} pairs have a curve", f"{', '.join(known)}")
    name = pair or next(iter(known))
    if name not in known:
        raise InputError("pair", shown(name), "has no mesh stiffness in these results", nearest(name, known))
    return known[name]


def load_number(curve: MeshCurve, torque: object) -> int | None:
    """Number of the load of a curve with this torque on the driver; None for the nominal one.

    Raises
    ------
    InputError
        If it was not computed.
    """
    if torque is None:
        return None
    wanted, known = in_si(cast("Quantity", torque), "torque", "torque"), curve.driver_torque
    near = int(np.argmin(np.abs(known - wanted)))
    if abs(known[near] - wanted) > _SAME * known[near]:
        raise InputError(
            "torque", f"{wanted:.6g} N*m", "is not a torque on the driver that was computed",
            f"use one of {', '.join(f'{one:.6g}' for one in known)} N*m",
        )  # fmt: skip
    return near


def is_secant(kind: object, *, secant: bool) -> bool:
    """Whether the secant stiffness is meant.

    Raises
    ------
    InputError
        If the kind is unknown, or contradicts `secant`.
    """
    if kind is None:
        return secant
    if kind not in ("tangent", "secant"):
        raise InputError("kind", shown(kind), 'must be "tangent" (slope dF/dTE) or "secant" (load over deflection)')
    if secant and kind == "tangent":
        raise InputError("kind", '"tangent"', "contradicts secant = True", "remove secant")
    return kind == "secant"


def angles_of(value: object) -> Array:
    """Rotations [rad] that somebody gave: numbers in rad, texts and quantities with a unit, or arrays of these.

    Raises
    ------
    InputError
        If they are none.
    """
    if isinstance(value, (int, float, np.ndarray)) and (plain := np.asarray(value)).dtype.kind in "iuf":
        return plain.astype(float)  # at once: integrators ask some thousand times
    try:
        return np.array(_in_radians(taken(value, "driver_angle")), dtype=float)
    except ValueError:  # rows of several lengths
        raise _refused(value) from None


def _in_radians(given: Any) -> Any:
    if isinstance(given, list):
        return [_in_radians(one) for one in given]
    if isinstance(given, (int, float)) and not isinstance(given, bool):
        return given
    if isinstance(given, str) or hasattr(given, "magnitude"):
        return in_si(given, "angle", "driver_angle")
    raise _refused(given)


def _refused(value: object) -> InputError:
    return InputError("driver_angle", shown(value), "must be angles", 'for example 0.1 (in rad) or "5 deg"')
