"""Plain data (numbers, texts, arrays, lists, dictionaries) as bytes and back.

Everything that fegear keeps on disk between runs goes through here. No code is ever loaded from such a file, floats
come back bit for bit, and equal data give equal bytes.
"""

from __future__ import annotations

import copyreg
import json
import struct
from collections.abc import Mapping
from types import MappingProxyType
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

K = TypeVar("K")
V = TypeVar("V")
_ALIGN = 64
#: Kinds of arrays that are plain data.
PLAIN_KINDS = "biufcSU"


def read_only(content: Mapping[K, V]) -> MappingProxyType[K, V]:
    """Copy a mapping into one that no one changes, which travels between processes as other data do."""
    return MappingProxyType(dict(content))


# Python itself cannot pickle its read-only mappings: a solved gear could not be sent to another process.
copyreg.pickle(MappingProxyType, lambda mapping: (read_only, (dict(mapping),)))


def pack(value: object) -> bytes:
    """Write plain data as bytes.

    Parameters
    ----------
    value : None, bool, int, float, str, ndarray, or list, tuple, dict of these
        Arrays of numbers or texts; contiguous ones keep their memory order.

    Raises
    ------
    TypeError
        If something in it is not plain.
    """
    arrays: list[tuple[int, bytes]] = []
    end = 0

    def encode(item: object) -> object:
        nonlocal end
        if isinstance(item, np.generic):
            item = item.item()
        if item is None or isinstance(item, (bool, int, float, str)):
            return item
        if isinstance(item, np.ndarray):
            if item.dtype.kind not in PLAIN_KINDS:
                raise TypeError(f"an array of {item.dtype} is not plain data")
            columns_first = item.flags.f_contiguous and not item.flags.c_contiguous
            order, data = ("F", item.tobytes("F")) if columns_first else ("C", item.tobytes("C"))
            arrays.append((end, data))
            placed = {"a": [item.dtype.str, list(item.shape), order, end]}
            end += -(-len(data) // _ALIGN) * _ALIGN
            return placed
        if isinstance(item, list):
            return {"l": [encode(x) for x in item]}
        if isinstance(item, tuple):
            return {"t": [encode(x) for x in item]}
        if isinstance(item, Mapping):
            return {"d": [[encode(k), encode(v)] for k, v in item.items()]}
        raise TypeError(f"{type(item).__name__} is not plain data")

    head = json.dumps(encode(value), ensure_ascii=False, separators=(",", ":")).encode()
    body = bytearray(end)
    for start, data in arrays:
        body[start : start + len(data)] = data
    return struct.pack("<Q", len(head)) + head + bytes(body)


def unpack(data: bytes | memoryview) -> object:
    """Read what `pack` wrote.

    Raises
    ------
    ValueError
        If the bytes are not what `pack` writes.
    """
    try:
        (length,) = struct.unpack_from("<Q", data)
        start = 8 + length
        return _decode(json.loads(bytes(data[8:start])), memoryview(data)[start:])
    except (struct.error, KeyError, IndexError, TypeError, UnicodeDecodeError) as problem:
        raise ValueError(f"not packed data: {problem}") from None


def _decode(item: object, body: memoryview) -> object:
    if not isinstance(item, dict):
        return item
    ((kind, content),) = item.items()
    if kind == "a":
        return _array(content, body)
    if kind == "l":
        return [_decode(x, body) for x in content]
    if kind == "t":
        return tuple(_decode(x, body) for x in content)
    return {_decode(k, body): _decode(v, body) for k, v in content}


def _array(content: tuple[str, list[int], str, int], body: memoryview) -> NDArray[np.generic]:
    kind, shape, order, start = content
    count = int(np.prod(shape, dtype=np.int64))
    flat = np.frombuffer(body, kind, count, start) if count else np.empty(0, kind)
    return flat.reshape(shape, order="F" if order == "F" else "C").copy(order="K")
