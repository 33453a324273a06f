"""What is said of a flank that marking compound is printed on."""

from __future__ import annotations

import numpy as np
import pytest

from fegear.results.pair.contact_pattern import PrintedFlank


def test_the_share_that_is_printed_is_said_in_per_cent():
    flank = PrintedFlank(5e3, 0.37, np.zeros(3), np.ones(4), np.zeros((4, 3)))
    assert flank.printed_percent == pytest.approx(37.0)
