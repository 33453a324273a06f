"""Load sharing of arrays of pairs: what to call."""

from __future__ import annotations

import hashlib
import inspect
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fegear.base.errors import MissingLibraryError
from fegear.base.extras import install
from fegear.contact.many import changes, corners, followed_peaks, kernel, over_fillets, over_mesh

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    from fegear.base.arrays import Array
    from fegear.contact.many.arrays import ManyEngagements


_LONG = "Compiling load sharing of arrays of pairs: about 10 s, only once."


class ManyErrors(NamedTuple):
    """Transmission error of pairs under their loads; NaN where a pair has none.

    Attributes
    ----------
    mean, peak_to_peak : ndarray, shape (N, L)
        [m].
    largest_share : ndarray, shape (N, L)
        Of the load on one pair of teeth.
    """

    mean: Array
    peak_to_peak: Array
    largest_share: Array


class ManyShares(NamedTuple):
    """Load sharing of pairs at roll positions.

    Attributes
    ----------
    transmission_error : ndarray, shape (N, P)
        [m].
    shares : ndarray, shape (N, P, pairs)
        Of the load; pairs of teeth are one base pitch apart, the first of them `first`.
    first : ndarray of int, shape (N,)
    """

    transmission_error: Array
    shares: Array
    first: NDArray[np.int64]


def transmission_errors(
    engagements: ManyEngagements, loads: ArrayLike, *, waves: int = 6, samples: int = 24, order: int = 8
) -> ManyErrors:
    """Transmission error of each pair under each load, over a base pitch.

    Parameters
    ----------
    engagements : ManyEngagements
    loads : array_like, shape (N, L) or (L,)
        [N].
    waves, samples, order : int
        What trades accuracy for time: Gauss's points are those for so many harmonics, `order` a subdivision; changes
        of contact are looked for between so many samples of a base pitch.

    Raises
    ------
    MissingLibraryError
        If numba is not installed.
    """
    count = engagements.module.size
    given = np.asarray(loads, dtype=float)
    each = np.ascontiguousarray(np.broadcast_to(given, (count, given.shape[-1])))
    t, w = np.polynomial.legendre.leggauss(order)
    out = np.empty((count, each.shape[1], 3))
    compiled()["transmission_errors"](
        engagements.numbers, *tables_of(engagements), engagements.corner_contact, each, waves, samples,
        0.5 * (t + 1.0), 0.5 * w, out,
    )  # fmt: skip
    return ManyErrors(out[..., 0], out[..., 1], out[..., 2])


def shares_at(engagements: ManyEngagements, load: ArrayLike, at: ArrayLike) -> ManyShares:
    """Transmission error and shares of the load at roll positions.

    Parameters
    ----------
    engagements : ManyEngagements
    load : array_like, shape (N,) or ()
        [N].
    at : array_like, shape (P,)
        From the start of the path [base pitches], 0 to 1.

    Raises
    ------
    MissingLibraryError
        If numba is not installed.
    """
    n, (each, x) = engagements.numbers, placed(engagements, load, at)
    error, shares = np.empty(x.shape), np.zeros((*x.shape, kernel.MOST))
    first = np.zeros(n.shape[0], dtype=np.int64)
    compiled()["shared_at"](n, *tables_of(engagements), engagements.corner_contact, each, x, error, shares, first)
    return ManyShares(error, shares, first)


def placed(engagements: ManyEngagements, load: ArrayLike, at: ArrayLike) -> tuple[Array, Array]:
    """Load of each pair [N], shape (N,), and its roll positions [m], (N, P), of places in its base pitch (P,)."""
    n = engagements.numbers
    each = np.ascontiguousarray(np.broadcast_to(np.asarray(load, dtype=float), n.shape[:1]))
    return each, n[:, corners.START, None] + n[:, corners.PITCH, None] * np.asarray(at, dtype=float)


def tables_of(engagements: ManyEngagements) -> tuple[Array, Array, Array, Array]:
    """Compliances of both gears as machine code takes them."""
    f = engagements.flanks
    own1, own2 = (np.ascontiguousarray(one) for one in f.own)
    beside1, beside2 = (np.ascontiguousarray(one) for one in f.beside)
    return own1, own2, beside1, beside2


@cache
def compiled() -> dict[str, Callable[..., Any]]:
    """Functions of `over_mesh` and `over_fillets` as machine code, compiled at first use, kept on disk for later.

    Raises
    ------
    MissingLibraryError
        If numba is not installed.
    """
    try:
        from fegear.contact.machine_code import machine_code
    except ImportError:
        raise MissingLibraryError(f"{install('motion')}.") from None
    modules = (corners, kernel, changes, over_mesh, over_fillets, followed_peaks)
    digest = hashlib.sha256(b"".join(Path(str(one.__file__)).read_bytes() for one in modules)).hexdigest()
    long = (over_mesh.transmission_errors, over_fillets.root_stresses, followed_peaks.followed_stresses)
    made: dict[object, Callable[..., Any]] = {
        function: machine_code(function, digest, _LONG if function in long else "")
        for module in modules
        for _, function in inspect.getmembers(module, inspect.isfunction)
        if function.__module__ == module.__name__
    }
    for module in modules:
        functions = inspect.getmembers(module, inspect.isfunction)
        vars(module).update({name: made[one] for name, one in functions if one in made})
    return {
        "transmission_errors": over_mesh.transmission_errors,
        "shared_at": over_mesh.shared_at,
        "root_stresses": over_fillets.root_stresses,
        "followed_stresses": followed_peaks.followed_stresses,
        "root_stress_at": over_fillets.root_stress_at,
    }
