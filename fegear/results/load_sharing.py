"""Stage ``load-sharing``: one tooth pair followed from first to last contact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.citation import Citation, citing
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Subject
from fegear.models.pair_checks import check_relief
from fegear.results import forecasts
from fegear.results.followed_pair import FollowedPair, history_figure, history_tables, history_values
from fegear.results.loaded_pair import EFFECTS, needs_pair, plane_pairs
from fegear.results.sources import HERTZ

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.case.reading import Scene
    from fegear.contact import PairHistory
    from fegear.engine.stage import Upstream, Work
    from fegear.models.loaded_pair import LoadedPair


_POSITIONS = 200


#: One engagement followed over its path [s], and what corners off the path add to it.
_HISTORY, _HISTORY_CORNERS = 0.006, 0.02


@dataclass(frozen=True)
class LoadSharingData:
    """What the stage hands to pictures.

    Parameters
    ----------
    pair : LoadedPair
    history : PairHistory
        Under every load of the case.
    load_error : ndarray or None
        Estimated error of its loads [N].
    """

    pair: LoadedPair
    history: PairHistory
    load_error: Array | None


def _at_corner(pair: LoadedPair, h: PairHistory) -> Array:
    p = pair.engagement.pair
    return np.where((h.x < p.x_start) | (h.x > p.x_end), 1.0, 0.0)


def _compute(_inputs: Subject, upstream: Upstream, _work: Work) -> LoadSharingData:
    from fegear.contact import pair_history
    from fegear.contact.error_by_shift import load_shift

    (found,) = upstream.values()
    pair: LoadedPair = found.pair
    history = pair_history(pair.engagement, pair.loads, _POSITIONS)
    shifts = [load_shift(history, pair_history(other, pair.loads, _POSITIONS)) for other in pair.shifted]
    return LoadSharingData(pair, history, np.sum(shifts, axis=0) if shifts else None)


def _present(data: LoadSharingData, inputs: Subject) -> Outcome:
    name, pair, history = inputs.name, data.pair, data.history
    i, off_path = pair.loads.index(pair.nominal), _at_corner(pair, history)
    beyond = ", outside which tip corners touch" if pair.engagement.corner_contact else ""
    shown = FollowedPair(
        name, pair.engagement.pair, pair.loads, i, history, data.load_error, off_path,
        f"{beyond}. Compliances: {'; '.join(pair.sources)}.",
    )  # fmt: skip
    remarks = []
    worst = float((off_path * history.load[:, i]).max())
    if pair.engagement.corner_contact and worst > 0.0:
        remarks.append(
            f"Pair {name}: tip corners touch off the path and carry up to {worst:.4g} N ({worst / pair.nominal:.1%}); "
            "hertz_pressure there is that of smooth flanks, the true one is higher."
        )
    settings = {"positions": _POSITIONS}
    return Outcome(
        data, history_tables(shown), history_values(shown), settings, tuple(remarks), (history_figure(shown),)
    )


def _forecast(scene: Scene, name: str) -> Forecast:
    """One history for each engagement."""
    each = _HISTORY + (_HISTORY_CORNERS if scene.case.effects.corner_contact else 0.0)
    return Forecast(
        {"positions": 200, "loads": forecasts.loads(scene, name)}, each * forecasts.engagements(scene, name)
    )


LOAD_SHARING = Stage(
    subjects=plane_pairs,
    needs=needs_pair,
    inputs=Subject.of,
    compute=_compute,
    present=_present,
    check=check_relief,
    effects=EFFECTS,
    cites=citing(Citation("mark", "load sharing of the tooth pairs in reach", "Appendix A"), HERTZ),
    forecast=_forecast,
)
