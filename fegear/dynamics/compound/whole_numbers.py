"""Linear equations in whole numbers and fractions, solved exactly: what teeth make of speeds and of assembly."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

Row = list[Fraction]


def reduced(rows: Sequence[Sequence[Fraction | int]]) -> tuple[list[Row], list[int]]:
    """Reduced row echelon form without its zero rows, and the columns of its leading ones."""
    left = [[Fraction(one) for one in row] for row in rows]
    done: list[Row] = []
    leading: list[int] = []
    for column in range(len(left[0]) if left else 0):
        at = next((k for k, row in enumerate(left) if row[column]), None)
        if at is None:
            continue
        row = left.pop(at)
        row = [one / row[column] for one in row]
        left, done = ([_without(other, row, column) for other in part] for part in (left, done))
        done.append(row)
        leading.append(column)
    return done, leading


def _without(row: Row, pivot: Row, column: int) -> Row:
    times = row[column]
    return [one - times * other for one, other in zip(row, pivot, strict=True)] if times else row


def null_vectors(rows: Sequence[Sequence[Fraction | int]], size: int) -> list[Row]:
    """Basis of what all rows turn into zero, each vector of `size` numbers."""
    done, leading = reduced(rows)
    found = []
    for free in (column for column in range(size) if column not in leading):
        vector = [Fraction(0)] * size
        vector[free] = Fraction(1)
        for row, column in zip(done, leading, strict=True):
            vector[column] = -row[free]
        found.append(vector)
    return found


def solved(rows: Sequence[Sequence[Fraction | int]], right: Sequence[Fraction | int]) -> Row | None:
    """The only solution of a system; None where it has none, or several."""
    size = len(rows[0])
    done, leading = reduced([[*row, one] for row, one in zip(rows, right, strict=True)])
    if leading != list(range(size)):
        return None
    return [row[size] for row in done]


def echelon(rows: Sequence[Sequence[int]]) -> tuple[list[list[int]], list[list[int]], int]:
    """Row echelon form by whole multiples of rows: ``(made, form, rank)`` with ``made @ rows = form``.

    `made` has determinant 1 or -1; its rows below the rank are a basis of all whole multiples of rows that add up to
    zero.
    """
    form = [list(row) for row in rows]
    made = [[int(i == k) for k in range(len(form))] for i in range(len(form))]
    rank = 0
    for column in range(len(form[0]) if form else 0):
        while True:
            there = [k for k in range(rank, len(form)) if form[k][column]]
            if not there:
                break
            pivot = min(there, key=lambda k: abs(form[k][column]))
            for both in (form, made):
                both[rank], both[pivot] = both[pivot], both[rank]
            for k in range(rank + 1, len(form)):
                times = form[k][column] // form[rank][column]
                for both in (form, made):
                    both[k] = [one - times * other for one, other in zip(both[k], both[rank], strict=True)]
            if not any(form[k][column] for k in range(rank + 1, len(form))):
                rank += 1
                break
    return made, form, rank
