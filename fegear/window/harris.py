"""The Harris map beside the load slider: made when the case is at rest, its present load followed while it moves."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.output.draw_plotly import darker, plotly_json
from fegear.results.harris_map import NOW, load_now, nominal_load, slider_map
from fegear.results.loaded_flanks import LoadedFlanksData
from fegear.results.loaded_pair import LoadedPairData

if TYPE_CHECKING:
    from fegear.engine.run import Results

#: A slider goes to so many times the load that it began with, and stands there until the load is beyond or below.
_MOST, _LEAST = 2.0, 0.02
#: What a pair under load is told as: plane teeth, and those with a width.
LOADED = (LoadedPairData, LoadedFlanksData)


class HarrisMaps:
    """Maps of the pairs of one case, over the range of their sliders."""

    def __init__(self) -> None:
        self._begun: dict[str, float] = {}

    def at_rest(self, results: Results) -> dict[str, dict[str, Any]]:
        """The map of every pair that is loaded, by the pair's name."""
        found = {}
        for task, outcome in results.outcomes.items():
            data = outcome.data
            if not isinstance(data, LOADED):
                continue
            load = nominal_load(data)
            begun = self._begun.get(task.subject, load)
            if not _LEAST * begun <= load <= _MOST * begun:
                begun = load
            self._begun[task.subject] = begun
            figure = slider_map(task.subject, data, _MOST * begun)
            drawn = {"key": figure.key, "heading": figure.heading, "caption": figure.caption, **plotly_json(figure)}
            found[task.subject] = {"figure": drawn, "darker": darker([figure]), "now": NOW}
        return found


def load_now_of(pair: str, data: LoadedPairData | LoadedFlanksData) -> dict[str, Any]:
    """The curve of the present load of a pair, for a map that is there."""
    load, x, te = load_now(data)
    return {"pair": pair, "load": load, "x": np.round(x, 6).tolist(), "te": np.round(te, 6).tolist()}
