"""Face load factors of a pair beside each other: what each includes follows what it was made of."""

import pytest

from fegear.formulas.iso6336.part1_face_load import Alignment, PinionShaft
from fegear.results.rating.face_load_factors import face_load_factors

SHAFT = PinionShaft("a", 0.2, 0.01, 0.04)


@pytest.mark.parametrize(
    ("alignment", "method", "included", "left_out"),
    [
        (Alignment(face_load_factor=1.3), "operation.face_load_factor", "as specified", ""),
        (Alignment(deformation=0.0), "ISO 6336-1, method C", "manufacturing deviations", "pinion shaft, deflection"),
        (Alignment(deformation=5e-6), "ISO 6336-1, method C", "f_sh as specified", "deflection of the wheel"),
        (Alignment(shaft=SHAFT, modification="crowned"), "ISO 6336-1, method C", "flank modification: crowned",
         "deflection of the wheel"),
        (Alignment(computed=1e-12), "ISO 6336-1, method C", "pinion shaft (shaft calculation)", ""),
    ],
)  # fmt: skip
def test_the_factor_of_the_standard_says_what_it_is_made_of(alignment, method, included, left_out):
    (row,) = face_load_factors(alignment, 1.3, None)
    assert (row.method, row.factor) == (method, 1.3)
    assert included in row.includes
    assert row.excludes.startswith(left_out)
    assert bool(row.excludes) == bool(left_out)


def test_computed_flanks_have_a_row_of_their_own():
    _, computed = face_load_factors(Alignment(deformation=0.0), 1.75, 2.58)
    assert computed.factor == 2.58
    assert "manufacturing deviations" in computed.excludes
    assert "running-in" in computed.excludes
