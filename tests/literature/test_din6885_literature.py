"""Keyways of DIN 6885-1 by bore, as catalogues print the table."""

import pytest

from fegear.base.errors import InputError
from fegear.fem.plane.odd.keyway import din_6885

#: Bore above and up to, width, d + t_2 less d [mm]: Siemens, Flender gear units, catalogue MD 31.1 (2016), page 7/3.
FLENDER = (
    (38, 44, 12, 3.3), (44, 50, 14, 3.8), (50, 58, 16, 4.3), (58, 65, 18, 4.4), (65, 75, 20, 4.9), (75, 85, 22, 5.4),
    (85, 95, 25, 5.4), (95, 110, 28, 6.4), (110, 130, 32, 7.4), (130, 150, 36, 8.4), (150, 170, 40, 9.4),
    (170, 200, 45, 10.4), (200, 230, 50, 11.4),
)  # fmt: skip
#: The same below: engineeringhardware.com, guide to DIN 6885 parallel keys.
SMALL = (
    (6, 8, 2, 1.0), (8, 10, 3, 1.4), (10, 12, 4, 1.8), (12, 17, 5, 2.3), (17, 22, 6, 2.8), (22, 30, 8, 3.3),
    (30, 38, 10, 3.3),
)  # fmt: skip


@pytest.mark.parametrize(("above", "up_to", "width", "depth"), SMALL + FLENDER)
def test_keyways_are_those_of_printed_tables(above, up_to, width, depth):
    for bore in (above + 0.5, up_to):
        assert din_6885(1e-3 * bore) == pytest.approx((1e-3 * width, 1e-3 * depth), rel=1e-12)


@pytest.mark.parametrize("bore", [5.9, 230.5])
def test_bores_beyond_the_table_are_refused(bore):
    with pytest.raises(InputError, match="DIN 6885"):
        din_6885(1e-3 * bore)
