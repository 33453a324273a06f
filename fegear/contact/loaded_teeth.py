"""A pair of gears under all its loads: what every kind of model answers alike, whether its teeth are plane or wide.

`LoadedTeeth` is what results, Python and the window know of a loaded pair. Its makers are
`fegear.contact.plane.loaded_pair.LoadedPair` and `fegear.contact.wide.loaded_pair.LoadedWidePair`; a pair of another
kind is one more maker. What is known of one kind alone is a part of an answer that may be None or empty.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, Protocol

import numpy as np

from fegear.base.brief import Brief
from fegear.base.shown import shown, shows

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.base.errors import InputError
    from fegear.contact.error_over_pitch import ErrorOverPitch
    from fegear.contact.plane.pair_history import PairHistory
    from fegear.contact.plane.tooth_stress import ToothStress
    from fegear.contact.surface import FrictionLaw
    from fegear.contact.tooth_loss import ToothLoss
    from fegear.contact.wide.root_stress import StressOverFace
    from fegear.fem.plane.influence import Side
    from fegear.geometry.pair import GearPair, Member

#: Harmonics of the transmission error of plane teeth.
HARMONICS = 64
#: Roll positions of their curves over the base pitch, and positions of a pair over its path; those on either side of
#: every jump come in addition.
POSITIONS = 200
#: Largest number of base pitches over which rotational harmonics of spacing errors are computed.
MOST_CYCLES = 10_000
#: What may change with an effect that is neglected.
Answer = Literal["transmission error", "load on a tooth pair", "root tension", "mean transmission error", "K_Hbeta"]


@dataclass(frozen=True, slots=True)
class Change:
    """What one more effect does to one answer.

    Parameters
    ----------
    answer : str
        Which of a loaded pair.
    size : float
        Largest change over the base pitch [m, N or Pa], with its sign; for root tension, mean and factor that of the
        number itself.
    scale : float
        What it is compared with: mean transmission error, total load, largest root tension, K_Hbeta.
    load : float
        Load at which its share is largest [N].
    x : float
        Roll position where it is largest [m]; nan for numbers of the whole base pitch.
    """

    answer: Answer
    size: float
    scale: float
    load: float
    x: float

    @property
    def share(self) -> float:
        """Size over scale, positive."""
        return abs(self.size) / self.scale


@dataclass(frozen=True)
class Neglected:
    """Effects that are off.

    Parameters
    ----------
    changes : mapping of str to tuple of Change
        What each of them would change, if it were on.
    wrong : mapping of str to InputError
        Those whose data are wrong, which stops nothing while they are off.
    """

    changes: Mapping[str, tuple[Change, ...]] = field(default_factory=dict)
    wrong: Mapping[str, InputError] = field(default_factory=dict)


def silent(_fraction: float) -> None:
    """Report no progress."""


class LoadedTeeth(Protocol):
    """A pair of gears under every load of its case."""

    @property
    def pair(self) -> GearPair:
        """Both gears in mesh."""

    @property
    def loads(self) -> tuple[float, ...]:
        """Along the transverse line of action, ascending [N]."""

    @property
    def nominal(self) -> float:
        """The one of them that single numbers are for [N]."""

    @property
    def about(self) -> str:
        """Where its compliances come from, as a sentence for figures."""

    @property
    def neglected(self) -> Neglected:
        """What the effects that are off would change, as far as it has been asked for."""

    def neglects(self, answers: Sequence[Answer], loads: Sequence[float]) -> Neglected:
        """What each effect that is off would change.

        Parameters
        ----------
        answers : sequence of str
            What is looked at; teeth with a width look at mean transmission error and K_Hbeta whatever is asked.
        loads : sequence of float
            [N]; teeth with a width take the nominal one.
        """

    def history(self) -> LoadHistory:
        """One tooth pair over the path of contact under every load."""

    def transmission_error(self, progress: Callable[[float], None] = silent) -> ErrorOverPitch:
        """Transmission error and mesh stiffness over one base pitch under every load.

        Parameters
        ----------
        progress : callable
            Takes the fraction that is done.
        """

    def error_under(self, loads: ArrayLike, positions: int) -> tuple[Array, Array, Array]:
        """Transmission error under other loads, without its harmonics and errors.

        Parameters
        ----------
        loads : array_like, shape (L,)
            [N].
        positions : int
            Even roll positions of plane teeth; those of a pair with a width are its own.

        Returns
        -------
        x : ndarray, shape (P,)
            Roll positions over one base pitch [m].
        load : ndarray, shape (L,)
            [N].
        te : ndarray, shape (P, L)
            [m].
        """

    def root_stress(
        self,
        sources: Mapping[Member, Mapping[str, Any]],
        progress: Callable[[float], None] = silent,
        *,
        estimates: bool = True,
    ) -> RootStressInMesh:
        """Root stress of one tooth of either gear on its way through the mesh.

        Parameters
        ----------
        sources : mapping of member to mapping of str to source
            Where it comes from, by name: `RootStressInfluence` for plane teeth, `SolidInfluence` for wide ones.
        progress : callable
        estimates : bool
            Whether errors are estimated, where that is a choice, and plane teeth looked at for peaks between positions.
        """

    def losses(self, speed: float, law: Callable[[float], FrictionLaw]) -> tuple[tuple[ToothLoss, ...], float]:
        """Power that tooth friction takes under every load, and by which share the nominal one may be off.

        Parameters
        ----------
        speed : float
            Of the driver [rad/s].
        law : callable
            Friction law under a load [N].
        """

    def flank_load(self, pair: GearPair) -> FlankLoad:
        """Line load all over the flank at the nominal load.

        Parameters
        ----------
        pair : GearPair
            Whose path of contact is looked at, without errors of the housing.
        """


@dataclass(frozen=True)
class FlankLoad:
    """Line load over the path of contact and the face, without load factors.

    Parameters
    ----------
    x : ndarray, shape (X,)
        On the line of action [m].
    z : ndarray, shape (Z,)
        Along the face, from its middle [m]; one place for plane teeth.
    line_load : ndarray, shape (Z, X)
        [N/m].
    over_face : bool
        Whether its distribution over the face is computed.
    outside : float
        Largest share of the load that tip corners bear off the path.
    """

    x: Array
    z: Array
    line_load: Array
    over_face: bool
    outside: float


class Largest(NamedTuple):
    """Largest share of a tooth pair and largest pressure on it at the nominal load, between positions of tables, too.

    Parameters
    ----------
    share, share_error : float
        Of the load, and its estimated error; NaN where it is not known.
    pressure, pressure_error : float
        Of smooth flanks [Pa].
    place : str
        Where the pressure is largest, in words.
    """

    share: float
    share_error: float
    pressure: float
    pressure_error: float
    place: str


def in_a_sentence(teeth: LoadedTeeth) -> str:
    """What a loaded pair is, and what it is asked: whatever is within it would fill pages."""
    pair, width = teeth.pair, teeth.pair.driver.face_width
    others = [load for load in teeth.loads if load != teeth.nominal]
    under = f"{teeth.nominal:.6g} N" + (f" and {len(others)} more" if others else "")
    return (
        f"{type(teeth).__name__}: {pair.driver.teeth} on {pair.driven.teeth} teeth, module "
        f"{pair.driver.module * 1e3:.6g} mm, face width {width * 1e3:.6g} mm, under {under}. {teeth.about} "
        "Methods: history(), transmission_error(), root_stress(), losses()."
    )


@dataclass(frozen=True)
class LoadHistory(Brief):
    """One tooth pair followed over the path of contact, at P positions under L loads.

    Parameters
    ----------
    found : PairHistory
    at : int
        Number of the nominal load.
    load_error : ndarray, shape (P, L), or None
        Estimated error of its loads [N].
    corner : ndarray, shape (P,), or None
        1 where a tip corner touches off the path, whose pressure is not that of smooth flanks; None where none can.
    where : str
        What a figure adds to the points of the path.
    positions : int
        At which it was asked for.
    largest : Largest or None
        Largest share and pressure at the nominal load; None of a pair that bears nothing.
    """

    found: PairHistory
    at: int
    load_error: Array | None
    corner: Array | None = shown("", "1: corner contact outside the path of contact")
    where: str = ""
    positions: int = 0
    largest: Largest | None = None

    @property
    @shows("N", "load on one tooth pair")
    def largest_load(self) -> float:
        """At the nominal load [N]."""
        if not self.largest:
            return 0.0
        load, share = self.found.load[:, self.at], self.found.share[:, self.at]
        most = int(np.argmax(load))
        return float(load[most] / share[most]) * self.largest.share

    @property
    @shows("", "load of one tooth pair")
    def largest_share(self) -> float:
        """Of the nominal load."""
        return self.largest.share if self.largest else 0.0

    @property
    @shows("MPa", "smooth flanks")
    def largest_hertz_pressure(self) -> float:
        """At the nominal load [Pa]."""
        return self.largest.pressure if self.largest else 0.0

    @property
    def hardest_pressed_at(self) -> str:
        """Where that is, as the value's meaning has it."""
        return self.largest.place if self.largest else "nowhere"

    @property
    def largest_load_error(self) -> float | None:
        """Estimated [N]."""
        share = self.largest_share_error
        return share and share * self.largest_load / self.largest_share

    @property
    def largest_share_error(self) -> float | None:
        """Estimated; None where it is not known."""
        return _known(self.largest.share_error) if self.largest else None

    @property
    def largest_pressure_error(self) -> float | None:
        """Estimated [Pa], what Hertz neglects is not; None where it is not known."""
        return _known(self.largest.pressure_error) if self.largest else None


def _known(error: float) -> float | None:
    return None if np.isnan(error) else error


@dataclass(frozen=True)
class RootStressInMesh:
    """Root stress of one tooth of either gear on its way through the mesh.

    Parameters
    ----------
    stress : mapping of member to mapping of str to ToothStress
        By every source, under every load; the first source is the result.
    notes : mapping of member to mapping of str to tuple of str
        What sources say of their own values.
    over_face : mapping of member to mapping of side to StressOverFace
        At the nominal load; empty for plane teeth.
    across : mapping of member to (float, float)
        Helical gears: largest tension at right angles to the helix at the nominal load, and its estimated error [Pa].
    """

    stress: Mapping[Member, Mapping[str, ToothStress]]
    notes: Mapping[Member, Mapping[str, tuple[str, ...]]] = field(default_factory=dict)
    over_face: Mapping[Member, Mapping[Side, StressOverFace]] = field(default_factory=dict)
    across: Mapping[Member, tuple[float, float]] = field(default_factory=dict)
