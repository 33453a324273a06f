"""Pictures of spaces beside each other: each keeps its own ordinate, which runs downwards."""

import numpy as np
import pytest

from fegear.engine.figure.axis import Axis
from fegear.engine.figure.items import Surface
from fegear.engine.figure.panel import Panel
from fegear.output.draw_png.sheet import Sheet


@pytest.mark.parametrize("columns", [1, 2])
def test_spaces_never_share_an_axis(columns):
    plane = Surface(np.stack([*np.meshgrid([0.0, 1.0], [0.0, 1.0]), np.zeros((2, 2))]), "blue")
    panels = [(Panel(Axis(), Axis(), (plane,), camera=((0, 0, 1), (0, 0, 0), (0, 1, 0))), "") for _ in range(4)]
    sheet = Sheet(None, panels, columns)
    assert not any(sheet._beside(i) for i in range(4))
    assert not any(sheet._joined(row, column) for row in range(sheet.rows) for column in range(columns))
