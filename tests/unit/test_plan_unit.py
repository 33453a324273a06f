"""The plan holds what the wanted results need, in order, and nothing else; the runner does each task once."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.base.notes import NoteClass, class_of
from fegear.case.built.tooth_influence import seconds_of_gear
from fegear.case.measurements import unused_measurements
from fegear.case.reading import build_scene
from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.engine.catalogue import Catalogue, Entry
from fegear.engine.outcome import Outcome
from fegear.engine.plan import make_plan
from fegear.engine.plan_in_words import _short
from fegear.engine.run import run_plan
from fegear.engine.stage import Need, Stage, Task
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.fem.plane.settings import MeshSettings
from fegear.results.catalogue import STAGES

GEARS = {"a": {"teeth": 28, "module": "1 mm"}, "b": {"teeth": 35, "module": "1 mm"}}


def scene(*results: str, **parts):
    return build_scene({"results": list(results), "gear": GEARS, **parts}, "case", Path())


class Workshop:
    """Three stages that only write down that they ran."""

    def __init__(self):
        self.log = []

        def work(name):
            def compute(subject, upstream, work):
                work.progress(0.5)
                self.log.append((name, subject, tuple(upstream)))
                return name

            def present(data, subject):
                return Outcome(data=data, values=(Value(f"{name}.{subject}", 2e-3, "mm", 1e-6),))

            return (lambda _scene, subject: subject), compute, present

        def gears(scene):
            return tuple(scene.gears)

        self.stages = (
            Stage(gears, *work("blank"), name="blank", title="Blank"),
            Stage(
                gears,
                *work("tooth"),
                lambda s, g: (Task("blank", g),),
                effects=("relief",),
                name="tooth",
                title="Tooth",
                results=("teeth",),
            ),
            Stage(
                lambda s: ("I",),
                *work("pair"),
                lambda s, p: (Task("tooth", "a"), Task("tooth", "b")),
                name="pair",
                title="Pair",
                results=("pairs", "both"),
            ),
            Stage(lambda s: tuple(s.pairs), *work("noise"), name="noise", title="Noise", results=("noise",)),
        )


def test_needs_come_first_and_each_task_runs_once():
    shop = Workshop()
    plan = make_plan(scene("pairs", "teeth", "both"), shop.stages)
    tasks = [step.task for step in plan.steps]
    assert tasks == [Task("blank", "a"), Task("tooth", "a"), Task("blank", "b"), Task("tooth", "b"), Task("pair", "I")]
    results = run_plan(scene("pairs"), plan)
    assert [entry[:2] for entry in shop.log] == [tuple(task) for task in tasks]
    assert shop.log[-1][2] == (Task("tooth", "a"), Task("tooth", "b"))
    assert list(results.seconds) == tasks
    assert {value.name: value.value for value in results.values}["pair.I"] == 2.0


def test_nothing_is_computed_that_nothing_asks_for():
    shop = Workshop()
    plan = make_plan(scene("teeth"), shop.stages)
    assert {step.stage.name for step in plan.steps} == {"blank", "tooth"}
    assert dict(plan.skipped).keys() == {"pair", "noise"}
    assert '"noise" is not in results' in dict(plan.skipped)["noise"]
    assert plan.steps[0].reasons == ("required by tooth of a",)
    assert plan.steps[1].reasons == ('requested by results = ["teeth"]',)


def test_effects_are_assigned_to_the_steps_that_use_them():
    plan = make_plan(scene("teeth", effects={"relief": True, "friction": True}), Workshop().stages)
    assert {step.task: step.effects for step in plan.steps}[Task("tooth", "a")] == ("relief",)
    assert plan.idle_effects == ("friction",)


def test_measurements_that_nothing_is_compared_with_are_named():
    gauge, encoders = {"g": {"gear": "a"}}, {"e": {"traces": [{"file": "none.csv"}]}}
    dynamics = {"measured_frequencies": ["100 Hz"]}
    found = make_plan(scene("teeth", gauge=gauge, encoders=encoders, dynamics=dynamics), Workshop().stages).remarks
    unused = [one for one in found if "is not used by the requested results" in one]
    assert [one.partition(" ")[0] for one in unused] == ["gauge.g", "encoders.e", "dynamics.measured_frequencies"]
    assert all(class_of(one) is NoteClass.NEGLECTED for one in unused)
    assert 'request "measured-transmission-error", or remove it.' in unused[1]
    assert list(unused_measurements(scene("teeth", gauge=gauge).case, {"dynamic-strain"})) == []


def test_unknown_results_show_the_nearest():
    with pytest.raises(InputError, match='did you mean "teeth"'):
        make_plan(scene("teet"), Workshop().stages)


def test_a_result_about_something_that_is_not_there_is_refused():
    with pytest.raises(InputError, match="cannot be computed: the case does not define the required objects"):
        make_plan(scene("noise"), Workshop().stages)


def test_tables_are_read_only_and_rectangular():
    column = Column("r", np.array([1e-3, 2e-3]), "mm")
    assert column.head == "r [mm]"
    assert column.values == pytest.approx([1.0, 2.0])
    with pytest.raises(ValueError, match="read-only"):
        column.si[0] = 0.0
    with pytest.raises(ValueError, match="different length"):
        Table("t", (column, Column("n", np.arange(3))))


def test_a_number_and_its_unit_belong_together():
    speed = Column("speed", np.array([10.0 * np.pi, 20.0 * np.pi]), "rpm", "of the motor")
    table = Table("dynamic_factor_I", (speed, Column("motion", np.array(["periodic", "chaotic"]))))
    assert table["speed"] == pytest.approx([300.0, 600.0])
    assert table["speed [rpm]"] == pytest.approx([300.0, 600.0])
    assert table.column("speed").si == pytest.approx([10.0 * np.pi, 20.0 * np.pi])
    assert table.column("speed").quantity.to("rad/s").magnitude == pytest.approx(speed.si)
    assert repr(speed) == "<column speed [rpm]: 2 rows, 300, 600>"
    length = Value("I.te", 1.12e-4, "mm", 1e-6)
    assert (length.value, length.error, length.si) == pytest.approx((0.112, 0.001, 1.12e-4))
    assert repr(length) == "I.te = 0.1120 +- 0.0010 mm"
    assert length.quantity.to("um").magnitude == pytest.approx(112.0)
    with pytest.raises(KeyError, match=r'did you mean "speed \[rpm\]"'):
        table["sped"]


def test_every_unit_of_the_tables_is_pint_s_too():
    from fegear.base.units import PER_SI, quantity

    for unit, size in PER_SI.items():
        if unit == "degC":  # has an offset
            assert quantity(60.0, unit).to("kelvin").magnitude == pytest.approx(333.15)
            continue
        assert quantity(size, unit).to_base_units().magnitude == pytest.approx(1.0, rel=1e-12), unit


def test_a_result_without_an_effect_that_it_needs_is_refused_with_the_remedy():
    stages = tuple(
        replace(stage, requires=needs)
        for stage, needs in zip(
            Workshop().stages,
            ((), (Need("relief", "there is nothing to grind without it"),), (Need("friction", "so", ("both",)),), ()),
            strict=True,
        )
    )
    with pytest.raises(
        InputError, match=r"effects.relief = \(off\): is required by \"teeth\": there is nothing"
    ) as caught:
        make_plan(scene("teeth"), stages)
    assert "set relief = true under [effects]" in str(caught.value)
    with pytest.raises(InputError, match="is required by stage tooth"):  # as a need of another
        make_plan(scene("pairs"), stages)
    on = {"relief": True}
    assert make_plan(scene("teeth", effects=on), stages).steps
    assert make_plan(scene("pairs", effects=on), stages).steps, "only the other result of that stage needs friction"
    with pytest.raises(InputError, match=r"effects.friction = \(off\): is required by \"both\""):
        make_plan(scene("both", effects=on), stages)
    hertz = (replace(Workshop().stages[0], results=("blanks",), requires=(Need("hertz", "why"),)),)
    with pytest.raises(InputError, match='set hertz = "load-dependent" under \\[effects\\]'):
        make_plan(scene("blanks"), hertz)


def test_finer_settings_is_predicted_to_take_longer():
    usual = MeshSettings()
    seconds = [seconds_of_gear(settings) for settings in (usual.scaled(1.5), usual, usual.scaled(0.5))]
    assert 0.0 < seconds[0] < seconds[1] < seconds[2]
    assert seconds_of_gear(replace(usual, order=3)) < seconds[1]


def test_a_former_name_of_a_result_asks_for_it_and_gives_the_new_one():
    stages = Workshop().stages
    entries = [Entry(s.name, "", s.title, s.results, formerly="fangs" * ("teeth" in s.results)) for s in stages]
    renamed = Catalogue(entries, "")
    renamed._loaded.update({stage.name: stage for stage in stages})
    old, new = make_plan(scene("fangs", "teeth"), renamed), make_plan(scene("teeth"), renamed)
    assert [step.task for step in old.steps] == [step.task for step in new.steps]
    assert old.remarks == ('results: "fangs" was renamed "teeth"; update the case with fegear migrate.', *new.remarks)
    assert STAGES.former() == {
        "tooth-loss": "gear-mesh-power-loss", "followed-modes": "mode-tracking", "pair-forces": "pair-forced-response",
    }  # fmt: skip


@pytest.mark.parametrize(("bore", "refused"), [("24 mm", True), ("10 mm", False)])
def test_a_gear_outside_the_range_of_a_formula_is_refused_by_the_plan_as_by_its_table(bore, refused):
    gear = {"teeth": 30, "module": "2 mm", "face_width": "10 mm", "bore_radius": bore}
    pair = {"driver": "a", "driven": "a", "load": "500 N", "compliance": {"source": "potential-energy"}}
    scene = build_scene({"results": ["load-sharing"], "gear": {"a": gear}, "pair": {"I": pair}}, "c", None)
    if not refused:
        assert make_plan(scene, STAGES).steps
        assert closed_form_compliance(scene.gears["a"], "potential-energy").own(0, 30e-3) > 0.0
        return
    with pytest.raises(InputError, match=r"pair\.I\.compliance\.source.*requires another gear a: root radius / bore"):
        make_plan(scene, STAGES)
    with pytest.raises(InputError, match="root radius / bore radius"):
        closed_form_compliance(scene.gears["a"], "potential-energy")


@pytest.mark.parametrize(
    ("value", "said"),
    [
        ({"order": 3, "solver": "condensed", "wide": 0.12345678}, "(order 3, solver condensed, wide 0.123457)"),
        (["fe", "lewis"], "fe, lewis"), ((), "none"), (True, "yes"), (2.0, "2"), (None, "None"),
    ],
)  # fmt: skip
def test_settings_of_a_plan_are_no_python(value, said):
    assert _short(value) == said
