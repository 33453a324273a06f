"""What a run comes to: rounded numbers, sentences of sheets, the wanted results put together."""

import math
from dataclasses import dataclass, replace
from types import SimpleNamespace

import pytest

from fegear.base.printed import rounded
from fegear.base.shown import shown
from fegear.engine.answered import MOST, Answered, Deciding
from fegear.engine.outcome import Outcome
from fegear.engine.run_answer import answer_of_run, in_order, joined, plain_sentences
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Task
from fegear.engine.value import Value


@pytest.mark.parametrize(
    ("value", "error", "said"),
    [
        (11.7345, None, "11.7"),
        (11.7345, 0.0, "11.7"),
        (11.7345, 0.004, "11.7"),
        (11.7345, 0.3, "11.7"),
        (11.7345, 2.0, "12"),
        (1381.4, 0.1, "1380"),
        (1381.4, 150.0, "1400"),
        (-0.04567, 0.002, "-0.046"),
        (1.4, 3.0, "1 +- 3"),
        (0.0, 0.1, "0"),
        (math.inf, 1.0, "inf"),
    ],
)
def test_a_rounded_number_has_no_digit_beyond_its_error(value, error, said):
    assert rounded(value, error) == said


@dataclass(frozen=True)
class _Data:
    size: float = shown("um", "size")
    safety: float = shown("", "safety", name="S_H")
    name: str = "I"


_SHEET = Sheet(
    values=(Number("size", lambda _: 2e-6), "safety"),
    answer=Answer(
        "Pair {name}: size {v[size]}, {v[size]:1!} or so.",
        "Pair {name}: {v[absent]}.",
        Remark("Pair {name}: safe.", when=lambda seen: seen.data.safety >= 1.0),
        lambda seen: [f"S_H {seen.data.safety:.2f}."],
        figure="size_{name}",
        rank="safety",
        among="the weakest of {count}",
    ),
)


def test_a_sheet_says_its_values_rounded_and_leaves_out_what_it_has_not():
    data = _Data(11.7345e-6, 0.573)
    found = _SHEET.present(data, data).answer
    assert found == Answered(("Pair I: size 12 µm, 10 or so.", "S_H 0.57."), "size_I", 0.573, "the weakest of {count}")


def test_a_sheet_without_an_answer_leaves_none():
    assert Sheet().present(_Data(1.0, 1.0), _Data(1.0, 1.0)).answer is None


def test_an_answer_has_at_most_five_sentences():
    many = Answer(lambda _: [f"{n}." for n in range(9)])
    assert many.of(Seen(None), ()).sentences == ("0.", "1.", "2.", "3.", "4.")


def test_of_several_the_weakest_comes_first_and_says_among_how_many():
    answers = [Answered((f"Pair {n}: S_H {r}.", f"Pair {n}: more."), n, r, "the weakest of {count} pairs")
               for n, r in (("I", 1.2), ("II", 0.57), ("III", 0.9))]  # fmt: skip
    found = joined(answers)
    assert found.figure == "II"
    assert found.sentences == (
        "Pair II: S_H 0.57, the weakest of three pairs.", "Pair II: more.", "Pair III: S_H 0.9.", "Pair III: more.",
        "Pair I: S_H 1.2.",
    )  # fmt: skip


def test_of_two_both_are_said():
    answers = [Answered((f"Pair {n}: S_H {r}.",), n, r, "the weaker of {count} pairs", tables=(n,))
               for n, r in (("I", 1.2), ("II", 0.57))]  # fmt: skip
    found = joined(answers)
    assert found.sentences == ("Pair II: S_H 0.57, the weaker of two pairs.", "Pair I: S_H 1.2.")
    assert found.tables == ("II", "I")


def test_one_alone_is_not_compared():
    assert joined([Answered(("S_H 1.2.",), "", 1.2, "the weakest of {count}")]).sentences == ("S_H 1.2.",)


def test_many_have_five_sentences_of_which_the_first_to_act_on():
    answers = [Answered((f"Pair {n}: {n}.",), "", float(-n), "the largest of {count}") for n in range(14)]
    found = joined(answers).sentences
    assert found[0] == "Pair 13: 13, the largest of 14."
    assert len(found) == MOST


def test_a_result_without_an_answer_says_its_first_values_estimated_before_exact():
    values = [
        Value("I.ratio", 1.638, "", 0.0, "contact ratio"),
        Value("I.te", 7.6187e-6, "um", 0.04e-6, "mean; of the mesh"),
        Value("I.nothing", math.nan, "um"),
        Value("I.more", 1.0),
    ]
    assert plain_sentences(values) == ("I: transmission error 7.62 µm.", "I: ratio 1.64.")
    symbol = Value("I.driver.A_FF", 0.378, "", 0.001, "maximum material exposure; of all depths")
    assert plain_sentences([symbol]) == ("I: driver: A_FF 0.378 (maximum material exposure).",)


def run_of(*results):
    """Plan and outcomes of tasks: stage, result that it has, whether wanted, its sentences; without them a value."""
    steps, outcomes = [], {}
    for stage, result, wanted, sentences in results:
        task = Task(stage, "I")
        steps.append(SimpleNamespace(task=task, stage=SimpleNamespace(results=(result,)), wanted=wanted))
        answer = None if sentences is None else Answered(sentences, f"{stage}_I")
        outcomes[task] = Outcome(values=(Value(f"{stage}.size", 1.0, "", None, "size"),), answer=answer)
    return SimpleNamespace(steps=steps), outcomes


def test_a_run_says_one_sentence_of_every_wanted_result_and_five_in_all():
    plan, outcomes = run_of(
        ("serving", "serving", False, ("not wanted.",)), ("a", "A", True, ("a1.", "a2.", "a3.", "a4.")),
        ("b", "B", True, ("b1.", "b2.", "b3.")),
    )  # fmt: skip
    found = answer_of_run(plan, outcomes, ("B", "A"))
    assert found.sentences == ("b1.", "b2.", "b3.", "a1.", "a2.")  # in the order in which they are asked for
    assert found.figure == "b_I"
    many = [(f"s{n}", f"R{n}", True, (f"{n}.", "more.")) for n in range(7)]
    assert answer_of_run(*run_of(*many), [f"R{n}" for n in range(7)]).sentences == tuple(f"{n}." for n in range(7))


def test_sentences_to_decide_by_come_before_other_further_ones():
    four = [(f"s{n}", f"R{n}", True, (f"{n}.", f"{n} more.")) for n in range(4)]
    wanted = [f"R{n}" for n in range(6)]
    assert answer_of_run(*run_of(*four), wanted).sentences == ("0.", "0 more.", "1.", "2.", "3.")
    four[2] = ("s2", "R2", True, ("2.", "2 more.", Deciding("2 resonates.")))
    assert answer_of_run(*run_of(*four), wanted).sentences == ("0.", "1.", "2.", "2 resonates.", "3.")
    six = [*four, *((f"s{n}", f"R{n}", True, (f"{n}.", "more.")) for n in (4, 5))]  # one of them has room in any case
    assert answer_of_run(*run_of(*six), wanted).sentences == ("0.", "1.", "2.", "2 resonates.", "3.", "4.", "5.")


def test_what_two_results_say_of_the_same_is_said_once_with_more_about_where_it_holds():
    said = "transmission error 0.3 µm"
    plan, outcomes = run_of(
        ("a", "A", True, (f"Pair I: {said}.", "Pair I: K 1.2.", f"Pair II: {said}.")),
        ("b", "B", True, (f"Pair I at 190 N m: {said}.", "Pair I at end II: K 1.3.")),
    )
    found = answer_of_run(plan, outcomes, ("A", "B")).sentences
    assert set(found) == {
        "Pair I: K 1.2.",
        f"Pair II: {said}.",
        f"Pair I at 190 N m: {said}.",
        "Pair I at end II: K 1.3.",
    }
    first = Task("a", "I")
    assert answer_of_run(plan, {first: outcomes[first]}, ("A",)).sentences == outcomes[first].answer.sentences


def test_what_describes_the_gears_stands_behind_and_what_another_sums_up_is_left_out():
    plan, outcomes = run_of(
        ("drawn", "geometry", True, ("25 teeth.", "1 kg.")), ("a", "A", True, ("a1.",)),
        ("whole", "box", True, ("w1.", "w2.", "w3.", "w4.", "w5.")),
    )  # fmt: skip
    drawn, whole = Task("drawn", "I"), Task("whole", "I")
    outcomes[drawn] = replace(outcomes[drawn], answer=replace(outcomes[drawn].answer, background=True))
    wanted = ("geometry", "box", "A")
    found = answer_of_run(plan, outcomes, wanted)
    assert found.sentences == ("w1.", "w2.", "w3.", "w4.", "a1.", "25 teeth.")
    assert found.figure == "whole_I"
    assert [task.stage for task in in_order(outcomes, plan, outcomes, wanted)] == ["whole", "a", "drawn"]
    outcomes[whole] = replace(outcomes[whole], answer=replace(outcomes[whole].answer, covers=("A",)))
    assert answer_of_run(plan, outcomes, wanted).sentences == ("w1.", "w2.", "w3.", "w4.", "w5.", "25 teeth.")
    alone = answer_of_run(plan, {drawn: outcomes[drawn]}, ("geometry",))
    assert alone.sentences == ("25 teeth.", "1 kg.")


def test_what_leads_stands_first_whatever_the_order_asked_for():
    plan, outcomes = run_of(("a", "A", True, ("a1.", "a2.")), ("odd", "odd", True, ("o1.", "o2.")))
    task = Task("odd", "I")
    wanted = ("A", "odd")
    assert answer_of_run(plan, outcomes, wanted).sentences == ("a1.", "a2.", "o1.", "o2.")
    outcomes[task] = replace(outcomes[task], answer=replace(outcomes[task].answer, leads=True))
    found = answer_of_run(plan, outcomes, wanted)
    assert (found.sentences, found.figure) == (("o1.", "o2.", "a1.", "a2."), "odd_I")
    assert [one.stage for one in in_order(outcomes, plan, outcomes, wanted)] == ["odd", "a"]


def test_a_result_without_an_answer_and_one_by_its_former_name_are_said_too():
    plan, outcomes = run_of(("plain", "plain", True, None), ("renamed", "now", True, ("now.",)))
    assert answer_of_run(plan, outcomes, ("before", "plain")).sentences == ("plain: size 1.", "now.")


def test_what_has_no_outcome_yet_is_not_said():
    plan, _ = run_of(("a", "A", True, ("a1.",)))
    assert answer_of_run(plan, {}, ("A",)) == ((), "", (), ())
