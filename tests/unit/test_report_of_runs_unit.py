"""What stands where in the report of a run: titles of tasks, wanted values first, the pair in question first."""

import copy
import math
from types import SimpleNamespace

import numpy as np
import pytest

import fegear
from fegear.engine.stage import Task
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.output.report import run as reported
from fegear.output.report.blocks import Folded, Group, Heading, Switch, Values
from fegear.output.report.gear_data import gear_sections
from fegear.output.spoken_values import spoken_tables, spoken_values
from fegear.output.tables import brief_lines

GEARS = {
    name: {"teeth": z, "module": "3 mm", "face_width": "10 mm", "bore_radius": "10 mm"}
    for name, z in (("a", 20), ("b", 31), ("c", 41), ("d", 17))
}
CASE = {
    "results": ["geometry", "load-sharing"],
    "gear": GEARS,
    "pair": {
        name: {"driver": one, "driven": other, "load": "900 N", "compliance": {"source": "cornell"}}
        for name, one, other in (("I", "a", "b"), ("II", "b", "c"))
    },
}


@pytest.fixture(scope="module")
def ran():
    return fegear.run(CASE, progress=False)


def test_a_task_is_called_as_its_stage_with_what_it_is_about(ran):
    assert reported._title(ran, Task("load-sharing", "I")) == "Load sharing: I"
    assert reported._title(ran, Task("load-sharing", "II")) == "Load sharing: II"
    assert reported._title(ran, Task("geometry", "")) != reported._title(ran, Task("load-sharing", "I"))
    assert reported._title(ran, Task("some-other", "x")) == "Some other: x"
    assert reported._title(ran, Task("some-other", "")) == "Some other"


def test_the_pair_that_is_asked_about_comes_first(ran):
    def pairs(results):
        return [section.title for section in gear_sections(results)]

    assert pairs(ran) == ["Gear data: pair I", "Gear data: pair II", "Gear data"]
    document = copy.deepcopy(CASE) | {"stiffness": {"pair": "II"}}
    other = fegear.run(document | {"results": ["geometry"]}, progress=False)
    assert pairs(other) == ["Gear data: pair II", "Gear data: pair I", "Gear data"]


def values_of(*counts):
    """Results of tasks with so many values each: wanted or not, with errors or not."""
    steps, outcomes = [], {}
    for name, count, wanted, error in counts:
        task = Task(name, "")
        steps.append(
            SimpleNamespace(task=task, stage=SimpleNamespace(title=name.upper(), results=(name,)), wanted=wanted)
        )
        outcomes[task] = SimpleNamespace(
            values=tuple(Value(f"{name}{k}", 1.0, "", error) for k in range(count)), answer=None
        )
    case = SimpleNamespace(accuracy=SimpleNamespace(tolerance=1e-2), results=sorted(one[0] for one in counts if one[2]))
    return SimpleNamespace(plan=SimpleNamespace(steps=steps), outcomes=outcomes, scene=SimpleNamespace(case=case))


def told(results):
    found = []
    for block in reported._values(results):
        if isinstance(block, Folded):
            found.append(block.title)
        elif not isinstance(block, Switch):  # of all digits, before the values
            assert isinstance(block, Group)
            head, *rest = block.blocks
            assert isinstance(head, Heading)
            found.append((head.words, *(len(one.values) if isinstance(one, Values) else one.title for one in rest)))
    return found


def test_sixteen_values_are_open_and_the_others_folded():
    found = told(values_of(("a", 9, True, 0.1), ("b", 7, True, 0.1), ("c", 1, True, 0.1)))
    assert found == [("A", 9), ("B", 7), "C (1 values)"]
    found = told(values_of(("a", 20, True, 0.1), ("b", 1, True, 0.1)))
    assert found == [("A", 16, "4 more values"), "B (1 values)"]
    assert told(values_of(("a", 17, True, 0.1))) == [("A", 16, "1 more value")]
    assert told(values_of(("a", 16, True, 0.1))) == [("A", 16)]


def test_wanted_values_come_in_the_order_of_the_results_before_those_that_serve():
    found = told(
        values_of(
            ("serving", 1, False, 0.1), ("second", 1, True, 0.1), ("first", 1, True, None), ("none", 0, True, 0.1)
        )
    )
    assert found == [("FIRST", 1), ("SECOND", 1), ("SERVING", 1)]
    # Where nothing says why, all are alike.
    found = told(values_of(("b", 1, False, None), ("a", 1, False, 0.1)))
    assert found == [("B", 1), ("A", 1)]


def test_values_of_tasks_that_only_serve_others_stand_last_in_a_report(ran):
    """The order was lost with a word: reasons were looked through for how they began."""
    document = copy.deepcopy(CASE)
    document["train"] = {
        "body": {"motor": {"gears": ["a"]}, "brake": {"gears": ["b"]}},
        "torque": {"motor": f"{900.0 * 0.03 * math.cos(math.radians(20.0))} N*m"}, "balance": "brake",
        "mesh": {"I": {"driver": "motor", "driven": "brake", "damping_ratio": 0.05}},
    }  # fmt: skip
    document |= {"results": ["tooth-force"], "dynamics": {"speed": "2000 rpm"}}
    results = fegear.run(document, progress=False)
    wanted = {step.task.stage: step.wanted for step in results.plan.steps}
    assert wanted["tooth-force"]
    assert not any(asked for stage, asked in wanted.items() if stage != "tooth-force")
    heads = [one.blocks[0].words for one in reported._values(results) if isinstance(one, Group)]
    served = [task for task, outcome in results.outcomes.items() if outcome.values and not wanted[task.stage]]
    assert served  # the train and its modes have values, too, and are found before
    assert heads[0] == reported._title(results, Task("tooth-force", "I"))
    assert not any(step.wanted for step in ran.plan.steps if step.task.stage not in ("geometry", "load-sharing"))


def test_the_terminal_has_a_screen_of_values_of_what_is_wanted():
    def ran(*counts):
        results = values_of(*counts)
        results.values = [value for outcome in results.outcomes.values() for value in outcome.values]
        results.answer = SimpleNamespace(tables=())
        return results

    few = ran(("a", 5, True, None), ("b", 9, False, None))
    assert spoken_values(few) == (few.values, 0)
    many = ran(("a", 60, True, None), ("b", 30, False, None), ("c", 3, True, None), ("d", 50, True, None))
    found, further = spoken_values(many)
    counts = [sum(value.name.startswith(name) for value in found) for name in "abcd"]
    assert counts == [13, 0, 3, 24]
    assert further == 143 - 40
    answer = SimpleNamespace(covers=("a", "d"))
    many.outcomes[Task("c", "")] = SimpleNamespace(values=many.outcomes[Task("c", "")].values, answer=answer)
    found, further = spoken_values(many)  # of a result that sums others up their values are in the files
    assert {value.name[0] for value in found} == {"b", "c"}
    assert len(found) + further == 143


def test_tables_of_an_answer_stand_behind_it_in_place_of_what_it_sums_up_and_of_what_describes_the_gears():
    def table(name, *, printed=True, words=False):
        return Table(name, (Column("part", np.array(["I"])), Column("x", np.array(["a"] if words else [2.0]))), name,
                     printed=printed)  # fmt: skip

    results = values_of(("box", 1, True, None), ("rating", 1, False, None), ("data", 1, True, None),
                        ("other", 1, True, None))  # fmt: skip
    answers = {
        "box": SimpleNamespace(covers=("rating",), background=False),
        "data": SimpleNamespace(covers=(), background=True),
    }
    own = {"box": [table("shafts", printed=False), table("bearings", printed=False),
                   table("changes", printed=False, words=True)]}  # fmt: skip
    results.outcomes = {
        task: SimpleNamespace(values=outcome.values, answer=answers.get(task.stage),
                              tables=own.get(task.stage, [table(task.stage)]))
        for task, outcome in results.outcomes.items()
    }  # fmt: skip
    results.tables = [one for outcome in results.outcomes.values() for one in outcome.tables]
    results.values = [value for outcome in results.outcomes.values() for value in outcome.values]
    results.answer = SimpleNamespace(tables=("changes", "bearings", "shafts"))
    printed, behind = spoken_tables(results)
    assert [one.name for one in printed] == ["other"]
    assert [one.name for one in behind] == ["bearings", "shafts"]  # changes are in the sentences
    assert {value.name[0] for value in spoken_values(results)[0]} == {"b", "o"}
    results.answer = SimpleNamespace(tables=())
    assert [one.name for one in spoken_tables(results)[0]] == ["rating", "data", "other"]
    assert not spoken_tables(results)[1]


def test_a_brief_table_has_the_digits_of_a_person_and_no_errors():
    found = brief_lines(Table("t", (
        Column("bearing", np.array(["left", "b"])), Column("at", np.array([0.0464123, np.nan]), "mm"),
        Column("at_error", np.array([1.0, 2.0]), "mm"),
    ), "Bearings"))  # fmt: skip
    assert found[0] == "Bearings:"
    assert [line.split() for line in found[1:]] == [["bearing", "left", "b"], ["at", "[mm]", "46.4"]]
