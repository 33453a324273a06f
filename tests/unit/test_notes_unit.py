"""Notes of a run: classes that travel, repeats merged, the first ones open and the others counted."""

import copy
import json
import pickle
from dataclasses import dataclass

import pytest

from fegear.base.notes import (
    Note,
    NoteClass,
    assuming,
    class_of,
    counted,
    exceeding,
    failing,
    neglecting,
    open_and_folded,
    ordered,
)
from fegear.engine.sheet.sheet import Remark, Sheet


def test_a_note_is_a_text_and_its_class_travels():
    note = failing("Pair I: S_H = 0.6 is below 1.")
    assert note == "Pair I: S_H = 0.6 is below 1."
    assert json.loads(json.dumps([note])) == [str(note)]
    for again in (pickle.loads(pickle.dumps(note)), copy.deepcopy(note)):  # noqa: S301
        assert (again, again.kind) == (note, NoteClass.FAILS)
    assert class_of("plain") is NoteClass.INFORMATION


def test_the_class_to_act_on_comes_first_and_the_order_within_a_class_stays():
    notes = ordered(["b", assuming("c"), "a", neglecting("d"), exceeding("e"), failing("f"), assuming("c")])
    assert notes == ("f", "e", "d", "c", "b", "a")
    assert [note.kind.words for note in notes] == [
        "fails", "beyond the tolerance", "neglected", "assumed", "information", "information",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("notes", "merged"),
    [
        (
            [f"Gear {n}: bore_radius not specified; gear body fixed at half the root radius, {r} mm."
             for n, r in (("p1", "15.825"), ("w1", "40.725"))],
            ["Gears p1, w1: bore_radius not specified; gear body fixed at half the root radius, 15.825 and 40.725 mm."],
        ),
        (
            [f"Gear {n}: core hardness {r} HBW assumed." for n, r in (("a", "300"), ("b", "280.5"), ("c", "310"))],
            ["Gears a, b, c: core hardness 280.5 to 310 HBW assumed."],
        ),
        ([f"Mesh {n}: linearised." for n in "abcdefgh"], ["Meshes a, b, c, d, e, f and 2 more: linearised."]),
        (["Gear a: E assumed.", "Pair a: E assumed."], ["Gear a: E assumed.", "Pair a: E assumed."]),
        ([f"Gear {n} over its face: up to 3 %." for n in "ab"], ["Gears a, b over its face: up to 3 %."]),
        (["Pair I: pair.I.load is high.", "Pair II: pair.II.load is high."],
         ["Pair I: pair.I.load is high.", "Pair II: pair.II.load is high."]),
    ],
)  # fmt: skip
def test_what_is_said_of_several_is_said_once(notes, merged):
    assert list(ordered(notes)) == merged


def test_two_numbers_of_one_subject_are_two_notes():
    notes = ["Pair I: 3 % off.", "Pair I: 5 % off.", "Pair II: 3 % off."]
    assert list(ordered(notes)) == ["Pairs I, II: 3 % off.", "Pair I: 5 % off."]


def test_of_what_falls_short_the_worst_comes_first_behind_what_does_not_work_at_all():
    notes = [
        failing("Pair I: S_H = 0.9 is below.", 0.81), failing("Pair III: S_H 0.6 is below.", 0.36),
        failing("Tips jam."), failing("Pair II: S_F = 0.7 is low.", 0.5), exceeding("e"),
    ]  # fmt: skip
    found = ordered(notes)
    assert [one.partition(":")[0] for one in found] == ["Tips jam.", "Pair III", "Pair II", "Pair I", "e"]
    assert pickle.loads(pickle.dumps(found[1])).margin == 0.36  # noqa: S301


def test_notes_of_different_classes_are_not_merged():
    assert len(ordered([failing("Gear a: thin."), assuming("Gear b: thin.")])) == 2


def test_numbers_in_names_are_no_numbers_of_a_note():
    assert list(ordered(["Gear a: key x_1 of 3.", "Gear b: key x_2 of 3."])) == [
        "Gear a: key x_1 of 3.",
        "Gear b: key x_2 of 3.",
    ]


@pytest.mark.parametrize(("count", "shown"), [(0, 0), (1, 1), (3, 3), (4, 2), (65, 2)])
def test_at_most_three_stand_open(count, shown):
    first, others = open_and_folded([Note(str(n)) for n in range(count)])
    assert (len(first), len(others)) == (shown, count - shown)


@pytest.mark.parametrize(("fails", "others", "shown"), [(5, 9, 5), (5, 1, 6), (5, 2, 5), (1, 9, 2), (2, 1, 3)])
def test_all_that_fail_stand_open(fails, others, shown):
    notes = ordered([*(assuming(f"a{n}") for n in range(others)), *(failing(f"f{n}", 0.1 * n) for n in range(fails))])
    first, rest = open_and_folded(notes)
    assert (len(first), len(rest)) == (shown, fails + others - shown)
    assert not any(one.kind is NoteClass.FAILS for one in rest)


def test_folded_notes_are_counted_by_class():
    assert counted([assuming("a"), neglecting("b"), assuming("c")]) == "3 further notes (1 neglected, 2 assumed)"
    assert counted([assuming("a")]) == "1 further note (assumed)"


@dataclass(frozen=True)
class _Data:
    name: str = "I"


def test_a_sheet_keeps_the_class_of_a_template_and_of_what_a_function_gives():
    sheet = Sheet(
        remarks=(
            Remark(neglecting("Pair {name}: film.")), Remark(lambda seen: assuming(f"Pair {seen.name}: oil.")),
            Remark(lambda seen: f"Pair {seen.name}: plain."), lambda _: [failing("jam")],
        )
    )  # fmt: skip
    found = sheet.present(_Data(), _Data()).remarks
    assert found == ("Pair I: film.", "Pair I: oil.", "Pair I: plain.", "jam")
    assert [class_of(note).name for note in found] == ["NEGLECTED", "ASSUMED", "INFORMATION", "FAILS"]


def test_notes_of_several_torques_are_one():
    notes = [f"Encoders {name}, {torque} N m: {part} % below it." for name in ("a", "b")
             for torque, part in ((60, 1.5), (120, 2.5), (180, 2.0))]  # fmt: skip
    assert ordered(notes[:3]) == ("Encoders a, 60, 120, 180 N m: 1.5 to 2.5 % below it.",)
    assert ordered(notes) == ("Encoders a, 60, 120, 180 N m; b, 60, 120, 180 N m: 1.5 to 2.5 % below it.",)
    assert ordered(notes[2:4]) == ("Encoders a, 180 N m; b, 60 N m: 2.0 and 1.5 % below it.",)
    assert ordered(notes[:1]) == (notes[0],)
    read = [f"Encoders {name}: file read with {count} samples left out." for name, count in (("a", 48), ("b", 49))]
    assert ordered(read) == ("Encoders a, b: file read with 48 and 49 samples left out.",)
    kinds = [Note(one, NoteClass.FAILS) for one in notes[:2]] + notes[2:3]
    assert ordered(kinds) == ("Encoders a, 60, 120 N m: 1.5 and 2.5 % below it.", notes[2])
    assert len(ordered(f"Encoders e{k}, 60 N m: 1 %." for k in range(9))) == 1
    assert ordered(f"Encoders e{k}, 60 N m: 1 %." for k in range(9))[0].startswith("Encoders e0, 60 N m; e1, 60 N m; ")
    assert " and 3 more: 1 %." in ordered(f"Encoders e{k}, 60 N m: 1 %." for k in range(9))[0]
