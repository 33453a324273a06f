"""``fegear check``: gears solved whole by scikit-fem alone, compared with the stated errors."""

import json
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.cli import program
from fegear.fem.plane import ring_closure
from fegear.studies import check

CASES = Path(__file__).parents[2] / "cases"
CASE = """
results = ["stiffness"]
[gear.a]
teeth = 12
module = "3 mm"
face_width = "20 mm"
bore_radius = "9 mm"
profile_shift = 0.4
"""


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    path = tmp_path_factory.mktemp("check") / "pinion.toml"
    path.write_text(CASE, encoding="utf-8")
    return path


def said(capsys, *arguments):
    """Exit code, output and errors of a command."""
    with pytest.raises(SystemExit) as end:
        program()(["check", *map(str, arguments)])
    out, err = capsys.readouterr()
    return end.value.code or 0, out, err


@pytest.mark.dear
def test_the_whole_gear_by_scikit_fem_agrees_within_the_stated_errors(case, capsys, monkeypatch):
    """Neither ring nor condensation of fegear takes part in what it is compared with."""
    solved = []
    close = ring_closure._coupling
    monkeypatch.setattr(ring_closure, "_coupling", lambda *given: solved.append(1) or close(*given))
    code, out, _ = said(capsys, case, "--json", "--positions", "2")
    found = json.loads(out)
    rows = found["gears"]["a"]["compared"]
    assert code == 0
    # The solution, that of its estimate, one order lower, and both of accuracy.solver.
    assert len(solved) == 4
    assert (found["compared"], found["covered"]) == (10, 10)
    assert [row["quantity"] for row in rows[::2]] == ["c_self", "c_next", "c_prev", "root_tension", "root_compression"]
    for row in rows:
        assert 0.0 < row["difference"] <= row["stated_error"] + 2e-5 < 2e-3
        assert abs(row["scikit_fem"] / row["fegear"] - 1.0) < 1e-3
    assert found["gears"]["a"]["unknowns"] > 50_000
    solvers = found["gears"]["a"]["solvers"]
    assert solvers["difference"] < 1e-10
    assert solvers["ratio"] == solvers["scikit_fem"] / solvers["condensed"] > 0.0
    assert rows[0]["radius"] < rows[1]["radius"]


def test_what_an_error_does_not_cover_is_said_and_ends_in_one(case, capsys, monkeypatch):
    row = check.Compared("c_self", 20.0, 1.0, 1.002, "um.mm/N", 2e-3, 1e-3)
    gear = check.Checked("a", (row,), 7, 0.1, check.Solvers(2e-12, 0.1, 0.7))
    monkeypatch.setattr(check, "check_gear", lambda _scene, _name, _positions: gear)
    code, out, _ = said(capsys, case)
    assert code == 1
    assert "NOT COVERED" in out
    assert "within 2e-12, CPU time 0.7 s; nested dissection 0.1 s, 7.0 times faster." in out
    assert "0 of 1 differences are within the estimated error plus that of the check itself, 2e-05." in out


def test_cases_without_spur_gears_are_refused_in_a_sentence():
    with pytest.raises(InputError, match=r"gear = .*has no spur gear to check"):
        program()(["check", str(CASES / "khbeta_helical.toml")], standalone_mode=False)


def test_a_gear_with_a_mesh_of_its_own_is_refused_in_a_sentence(case):
    (case.parent / "own.msh").touch()
    with pytest.raises(InputError, match=r"gear.a.tooth_mesh = .*own.msh.*: replaces the outline"):
        program()(["check", str(case), "--set", 'gear.a.tooth_mesh="own.msh"'], standalone_mode=False)


@pytest.mark.dear
def test_a_small_gear_by_scikit_fem_alone_gives_what_it_gave():
    """Six teeth on few edges: 2 % from the condensed ring, but to the last digits what was accepted."""
    from fegear.fem.plane.scikit_fem_alone import solve_alone
    from fegear.fem.plane.settings import settings_at
    from fegear.geometry.external_tooth import Tooth
    from fegear.geometry.rack import BasicRack

    tooth = Tooth(6, BasicRack(1.0, 1.25, 0.25), 0.4)
    radius = np.sqrt(np.linspace(tooth.form_radius**2, tooth.involute_tip_radius**2, 6)[2:5:2])
    found = solve_alone(tooth, 1.2, 0.3, "stress", settings_at(-4).scaled(6.0), radius, 0.15)
    kept = {
        "c_self": (7.49313530, 10.86682715), "c_next": (0.85668843, 0.84201152), "c_prev": (0.85659704, 0.84173188),
        "root_tension": (3.53310081, 4.35007667), "root_compression": (-4.23141637, -5.6181069),
    }  # fmt: skip
    for name, values in kept.items():
        assert getattr(found, name) == pytest.approx(values, rel=1e-6)


@pytest.mark.long
def test_each_number_of_the_whole_gear_moves_with_what_it_depends_on():
    """A softer body, a load nearer the tip: directions that both solutions must show."""
    from fegear.fem.plane.scikit_fem_alone import solve_alone
    from fegear.fem.plane.settings import settings_at
    from fegear.geometry.external_tooth import Tooth
    from fegear.geometry.rack import BasicRack

    tooth = Tooth(8, BasicRack(1.0, 1.25, 0.25), 0.4)
    radius = np.sqrt(np.linspace(tooth.form_radius**2, tooth.involute_tip_radius**2, 6)[2:5:2])
    settings = settings_at(-3).scaled(3.0)
    strain, stress = (solve_alone(tooth, 1.5, 0.3, plane, settings, radius, 0.05) for plane in ("strain", "stress"))
    assert (stress.c_self > strain.c_self).all()
    for found in (strain, stress):
        assert (np.diff(found.c_self) > 0.0).all()
        assert (found.c_self > found.c_next).all()
        assert found.c_next == pytest.approx(found.c_prev, rel=1e-4)  # reciprocal, at one radius
        assert (np.diff(found.root_compression) < 0.0).all()


@pytest.mark.parametrize("ring", [False, True])
def test_the_fillet_of_the_whole_gear_is_seen_from_the_root_to_the_flank(ring):
    """Stretched along the tooth, the stress is the square of the tangent's part along it: it grows on the way."""
    from skfem import Basis

    from fegear.fem.plane.scikit_fem_alone import _Ring, _whole_gear
    from fegear.fem.plane.settings import settings_at
    from fegear.geometry.external_tooth import Tooth
    from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
    from fegear.geometry.rack import BasicRack

    tooth = InternalTooth(40, PinionCutter(20), tip_radius=19.2) if ring else Tooth(6, BasicRack(1.0, 1.25, 0.25), 0.4)
    bore = tooth.root_radius + 1.5 if ring else 1.2
    whole = _Ring(_whole_gear(tooth, bore, settings_at(-4).scaled(3.0 if ring else 6.0), []), tooth.side)
    basis = Basis(whole._grid, whole._vector, whole._curves, intorder=2)
    stretch = np.zeros((whole.dofs.N, 1))
    stretch[basis.element_dofs[1::2], 0] = basis.mapping.F(whole._vector.elem.doflocs.T)[1].T
    for name in ("fillet:0", "back_fillet:0"):
        arc, stress = whole.along(name, stretch, 3.0)
        low, high = sorted((tooth.root_radius, tooth.form_radius))
        assert high - low < arc[-1] < 3.0 * (high - low)
        assert stress.shape == (arc.size, 1)
        assert stress[0, 0] < 1.0
        assert stress[-1, 0] > 1.8
        assert (np.diff(arc) >= 0.0).all()
        assert np.abs(np.diff(stress[:, 0])).max() < 0.4  # one piece follows the other
