"""No error of a designed relief is stated below what the last digits of a mesh's coordinates move."""

import numpy as np
import pytest

from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.design.loading import LoadingFunction
from fegear.design.relief_design import DesignTask, design_relief
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.results.relief.left_errors import left_error


def test_compliances_without_an_error_still_leave_the_last_digits():
    """Two estimates that agree to all digits stated 3.4e-15 where processors differ by 3e-10."""
    gear = Gear(Tooth(28), 3e-3, 0.015, 0.01)
    pair, load = GearPair(gear, gear), 2000.0
    source = closed_form_compliance(gear, "cornell")
    e = Engagement(PairCompliance(pair, source, source, hertz="linear", nominal_load=load))
    loading = LoadingFunction(1.3 * pair.base_pitch, pair.base_pitch, 0.5 * (pair.x_start + pair.x_end))
    task = DesignTask(loading, load, False, (), "peak_to_peak", (load,), 16, 12)
    design = design_relief(e, [e, e], task)
    for relief in design.reliefs.values():
        np.testing.assert_allclose(relief.error, 1e-9 * relief.table.deflection.max(), rtol=1e-12)
    te = design.te["designed"]
    assert left_error(te, [e, e]).peak_to_peak == pytest.approx(1e-9 * te.mean, rel=1e-3, abs=0.0)
    without = design_relief(e, [], task)
    assert left_error(without.te["designed"], []).peak_to_peak is None
    assert all(relief.error is None for relief in without.reliefs.values())
