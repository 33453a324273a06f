"""Stage ``flank-load-sharing``: result ``load-sharing`` of pairs that are loaded with their width."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.engine.citation import Citation, citing
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Stage, Subject
from fegear.models.loaded_flanks import FLANK_EFFECTS
from fegear.results import forecasts
from fegear.results.followed_pair import FollowedPair, history_figure, history_tables, history_values
from fegear.results.loaded_flanks import loaded_flanks, needs_flanks, wide_pairs
from fegear.results.sources import HERTZ

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.contact import PairHistory
    from fegear.engine.stage import Upstream, Work
    from fegear.results.loaded_flanks import LoadedFlanksData


@dataclass(frozen=True)
class FlankLoadSharingData:
    """What the stage hands to tables and pictures.

    Parameters
    ----------
    loaded : LoadedFlanksData
    history : PairHistory
        Under every load of the case.
    load_error : ndarray, shape (P, L)
        Estimated error of its loads [N].
    pressure_error : float
        Of the largest pressure at the nominal load [Pa].
    """

    loaded: LoadedFlanksData
    history: PairHistory
    load_error: Array
    pressure_error: float


def _compute(inputs: Subject, upstream: Upstream, _work: Work) -> FlankLoadSharingData:
    from fegear.contact.flank.pair_history import flank_pair_history, history_error

    loaded = loaded_flanks(upstream, inputs.name)
    found, coarse, pair = loaded.found, loaded.error.coarse, loaded.found.pair
    history = flank_pair_history(found, loaded.gaps.at(pair, found.lines))
    again = flank_pair_history(coarse, loaded.gaps.at(pair, coarse.lines))
    largest, other = (one.hertz_pressure[:, loaded.nominal].max() for one in (history, again))
    missed = loaded.missed  # by slices, of compliances
    error = history_error(history, again) + missed * history.load * (1.0 - history.share)
    return FlankLoadSharingData(loaded, history, error, float(abs(other - largest) + 0.5 * missed * largest))


def _present(data: FlankLoadSharingData, inputs: Subject) -> Outcome:
    loaded, history, pair = data.loaded, data.history, data.loaded.found.pair
    helical = pair.driver.helix_angle != 0.0
    about = (
        " in the middle of the face, before and after which the contact line crosses a part of it. "
        if helical
        else ". "
    )
    shown = FollowedPair(
        inputs.name, pair, loaded.asked.loads, loaded.nominal, history, data.load_error, None,
        f"{about}Gears with their width, {'coupled slices' if loaded.asked.width == 'slices' else 'solid'}.",
        data.pressure_error,
    )  # fmt: skip
    settings = {"positions": history.x.size}
    return Outcome(data, history_tables(shown), history_values(shown), settings, (), (history_figure(shown),))


FLANK_LOAD_SHARING = Stage(
    subjects=wide_pairs,
    needs=needs_flanks,
    inputs=Subject.of,
    compute=_compute,
    present=_present,
    effects=FLANK_EFFECTS,
    cites=citing(Citation("mark", "load sharing of the tooth pairs in reach", "Appendix A"), HERTZ),
    forecast=lambda _scene, _name: forecasts.constant(0.05),
)
