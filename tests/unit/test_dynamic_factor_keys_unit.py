"""Keys of dynamic factors that have a meaning only with some effects."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.case.reading import read_scene
from fegear.engine.plan import make_plan
from fegear.results.catalogue import STAGES
from fegear.results.train.dynamic_factor import _at_the_end

CASE = Path(__file__).parents[2] / "cases" / "lin_dynamic_factor.toml"


def planned(*changes):
    return make_plan(read_scene(CASE, ['results=["dynamic-factor"]', *changes]), STAGES)


def test_averaging_is_of_motions_in_time_and_other_methods_of_all():
    still = ("effects.contact_loss=false", "effects.parametric=false")
    assert planned('dynamics.method="averaging"').steps
    assert planned(*still).steps  # of the linear train no method is asked for
    with pytest.raises(InputError, match="applies to time-domain results only"):
        planned('dynamics.method="averaging"', *still)


def test_a_backlash_that_is_not_the_gears_needs_the_effect():
    assert planned("effects.contact_loss=false").steps
    for backlash in ("20 um", "35 um"):
        assert planned(f'train.mesh.I.backlash="{backlash}"').steps
        with pytest.raises(InputError, match=r"requires effects\.contact_loss = true"):
            planned(f'train.mesh.I.backlash="{backlash}"', "effects.contact_loss=false")


@pytest.mark.parametrize(
    ("factors", "unbounded", "said"),
    [
        ((1.1, 1.2, 1.5), 0, "; the maximum is at the end of the range and may be higher above it"),
        ((1.5, 1.2, 1.1), 0, "; the maximum is at the start of the range and may be higher below it"),
        ((1.1, 1.5, 1.2), 0, ""),
        ((1.2, 1.2, 1.2), 0, ""),
        ((1.1, 1.2, 1.5), 1, ""),  # beyond it the motion grows without bound, which has a note of its own
    ],
)
def test_a_maximum_at_an_end_of_the_speeds_is_named(factors, unbounded, said):
    speeds = 100.0 * np.arange(1, 4 + unbounded)
    held = SimpleNamespace(dynamic_factor=np.array(factors), speeds=speeds[:3])
    assert _at_the_end(held, SimpleNamespace(speeds=speeds)) == said
