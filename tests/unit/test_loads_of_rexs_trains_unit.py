"""Loads of REXS models: which meshes are one train, where it ends, what is assumed, and how long load cases last."""

from __future__ import annotations

import math
from types import SimpleNamespace as Space

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.exchange.rexs import loads
from fegear.exchange.rexs.drive import Mesh, Torque
from fegear.exchange.rexs.flow import Flow

#: A chain 0-1-2, a mesh 3-4 by itself, and a second path 0-5-2.
CHAIN = (Mesh((0, 1), (17, 40)), Mesh((3, 4), (20, 30)), Mesh((1, 2), (18, 54)))
RING = (*CHAIN, Mesh((0, 5), (17, 51)), Mesh((5, 2), (20, 80)))


def test_meshes_that_have_bodies_in_common_are_one_train():
    assert [loads._train(CHAIN, n) for n in range(3)] == [[0, 2], [1], [0, 2]]
    assert loads._train(RING, 4) == [0, 2, 3, 4]
    # whichever comes first: a chain whose links are in reverse order
    links = tuple(Mesh((n, n + 1), (20, 30)) for n in reversed(range(6)))
    assert all(loads._train(links, n) == [0, 1, 2, 3, 4, 5] for n in range(6))


def test_a_train_ends_at_bodies_with_one_mesh():
    assert loads._ends(CHAIN, [0, 2]) == [0, 2]
    assert loads._ends(CHAIN, [1]) == [3, 4]
    assert loads._ends(RING, [0, 2, 3, 4]) == []
    branched = (Mesh((1, 0), (20, 30)), Mesh((1, 2), (20, 30)), Mesh((1, 3), (20, 30)))
    assert loads._ends(branched, [0, 1, 2]) == [0, 2, 3]


class _Said:
    """Numbers of components by name."""

    def __init__(self, **of):
        self.notes, self.of = [], of

    def number(self, component, _quantity, *names):
        return next((self.of[component][name] for name in names if name in self.of[component]), None)

    needed = number


def _stage(name, kind="cylindrical_stage"):
    return Space(component=Space(type=kind, said=f"stage {name}"), gears=[f"gear {name}", f"mate {name}"])


@pytest.mark.parametrize("turns", [10.0, -10.0])
def test_an_assumed_torque_loads_no_mesh_above_what_is_usual(monkeypatch, turns):
    """10 MPa times face, half module squared and teeth: of 17 and of 18 teeth, the second at 40/17 of the torque."""
    monkeypatch.setattr(loads, "module_of", lambda said, gear: said.of[gear]["module"])
    given = {"gear 0": {"module": 2e-3, "face_width": 0.02}, "gear 2": {"module": 3e-3, "face_width": 0.03}}
    said = _Said(**given)
    stages = [_stage(0), _stage(1), _stage(2)]
    speeds = (turns, -turns, turns, math.nan, math.nan)
    found = loads._assumed_train(said, stages, CHAIN, [0, 2], speeds, [])
    usual = [10e6 * 0.02 * 0.5 * 2e-3**2 * 17, 10e6 * 0.03 * 0.5 * 3e-3**2 * 18 * 17 / 40]
    wanted = float(f"{min(usual):.3g}")
    assert found == [Torque(0, math.copysign(wanted, turns)), Torque(2, None)]
    assert said.notes == [
        f"No torque specified for stage 0, stage 2: {wanted:g} N m assumed at the input of the train."
    ]
    # where a torque leaves is where the model says; bevel stages have no usual load
    found = loads._assumed_train(said, stages, CHAIN, [0, 2], speeds, [Torque(0, None), Torque(1, None)])
    assert [one.body for one in found] == [0, 1]
    assert abs(found[0].value) == float(f"{usual[0]:.3g}")
    bevel = [_stage(0, loads.BEVEL), _stage(1), _stage(2, loads.BEVEL)]
    assert loads._assumed_train(said, bevel, CHAIN, [0, 2], speeds, [])[0].value == math.copysign(1.0, turns)


def test_a_train_without_ends_is_driven_at_its_first_mesh_and_left_at_its_last(monkeypatch):
    monkeypatch.setattr(loads, "module_of", lambda said, gear: said.of[gear]["module"])
    gear = {"module": 2e-3, "face_width": 0.02}
    said = _Said(**{f"gear {n}": gear for n in range(3)})
    meshes = (Mesh((0, 1), (20, 20)), Mesh((1, 2), (20, 20)), Mesh((2, 0), (20, 20)))
    found = loads._assumed_train(said, [_stage(n) for n in range(3)], meshes[:2], [0, 1], (1.0, -1.0, 1.0), [])
    assert [one.body for one in found] == [0, 2]
    monkeypatch.setattr(loads, "driven", lambda *_given: Space(mesh_torque=(2.0, 0.0, -0.5)))
    found = loads._assumed_train(said, [_stage(n) for n in range(3)], meshes, [0, 1, 2], (1.0, -1.0, 1.0), [])
    assert [(one.body, one.value is None) for one in found] == [(0, False), (2, True)]
    assert found[0].value == float(f"{10e6 * 0.02 * 0.5 * 2e-3**2 * 20 / 2.0:.3g}")  # what nothing loads does not count


def test_a_load_case_lasts_as_its_gear_unit_says():
    def lasting(**own):
        said = _Said(unit=own)
        unit = Space(id="unit")
        said.number = lambda _component, quantity, *names: (quantity, names, own[names[0]])
        said.model, said.loaded = Space(of=lambda kind: [unit] if kind == "gear_unit" else []), {"unit": own}
        return loads._time(said)

    assert lasting(load_duration_fraction=0.25) == (("share", ("load_duration_fraction",), 0.25), False)
    assert lasting(operating_time_fraction=0.5) == (("share", ("operating_time_fraction",), 0.5), False)
    assert lasting(load_duration=60.0) == (("time", ("load_duration",), 60.0), True)
    assert lasting(operating_time=7.0, load_duration_fraction=0.1)[1] is False
    assert lasting(torque=7.0) == (None, False)


def _flow(torque, speeds, teeth=(20, 60)):
    driven = Space(set_torque=(torque,), speed=speeds)
    return Space(driven=driven, sets=(Space(sun=0, carrier=1, teeth=teeth),))


def test_the_bins_of_a_set_are_factors_of_its_torque_and_meshes_of_its_sun():
    said, one = Space(notes=[]), Space(component=Space(said="set P"))
    nominal = _flow(-100.0, (50.0, 10.0))
    flows = [_flow(50.0, (-50.0, 10.0)), _flow(-250.0, (30.0, 40.0))]
    found = loads._of_set(said, one, 0, nominal, flows, [0.25, 0.75])
    np.testing.assert_allclose(found, [(0.5, 60.0 * 20, 0.25), (2.5, 10.0 * 20, 0.75)])
    assert said.notes == []
    for torque, speeds, base in ((math.nan, (1.0, 0.0), 1.0), (1.0, (2.0, 2.0), 1.0), (1.0, (math.nan, 0.0), 1.0),
                                 (1.0, (1.0, 0.0), 0.0)):  # fmt: skip
        said.notes.clear()
        flows = [_flow(torque, speeds)]
        assert loads._of_set(said, one, 0, _flow(base, (1.0, 0.0)), flows, [1.0]) == ()
        assert said.notes == ["set P: no load spectrum (a load case has no torque or speed for it)."]


def test_the_gear_that_drives_is_the_one_whose_mate_takes_power():
    def flow(torque, speed):
        driven = Space(mesh_torque=(torque,), speed=(speed, -speed * 20 / 50))
        return Flow(driven, {}, set(), (), (Mesh((0, 1), (20, 50)),))

    assert flow(-30.0, 100.0).into(0) == (True, 30.0, 100.0)
    assert flow(30.0, -100.0).into(0) == (True, 30.0, -100.0)
    assert flow(30.0, 100.0).into(0) == (False, 75.0, -40.0)
    assert flow(0.0, 100.0).into(0) == (True, 0.0, 100.0)


def test_load_cases_are_found_by_number_and_the_first_one_without():
    cases = [Space(id=7), Space(id=3)]
    model = Space(load_cases=cases)
    assert [loads.chosen_load_case(model, one) for one in (None, 3, 7)] == [cases[0], cases[1], cases[0]]
    assert loads.chosen_load_case(Space(load_cases=[]), None) is None
    with pytest.raises(InputError, match="it has 7, 3"):
        loads.chosen_load_case(model, 0)
    with pytest.raises(InputError, match="it has none"):
        loads.chosen_load_case(Space(load_cases=[]), 1)
