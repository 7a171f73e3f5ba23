"""Python values as YAML, without loss: numbers keep all their digits, and strings are quoted."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Mapping
from typing import Any

from catena._units import is_quantity, number_of
from catena.errors import InputError

_PLAIN = re.compile(r"[A-Za-z_][A-Za-z0-9_-]*\Z")


def value_text(value: Any, where: str, si: bool = False) -> str:
    """Returns one value in YAML's flow style. ``where`` is its key, ``si`` says whether the scene's units are SI.

    It takes None, bool, numbers, str, paths, mappings, lists, tuples, NumPy's numbers and arrays, and quantities of
    openmm.unit and pint, which get the unit of the key. Raises InputError for anything else.
    """
    if is_quantity(value):
        return value_text(number_of(value, where, si), where, si)
    if isinstance(value, Mapping):
        entries = (f"{_key(key, where)}: {value_text(item, f'{where}.{key}', si)}" for key, item in value.items())
        return "{" + ", ".join(entries) + "}"
    if isinstance(value, (list, tuple)):
        return _list_text([value_text(item, f"{where}[{i}]", si) for i, item in enumerate(value)])
    if isinstance(value, float):
        return _number_text(float(value))
    if value is None or isinstance(value, (bool, int, str)):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, os.PathLike):
        return json.dumps(os.fspath(value), ensure_ascii=False)
    if type(value).__module__.partition(".")[0] == "numpy" and hasattr(value, "tolist"):
        return value_text(value.tolist(), where, si)
    raise InputError(
        f"a {type(value).__name__} cannot be a value of a scene ({where}): give a number, a string, a list or a dict"
    )


def scene_text(scene: Mapping[str, Any], si: bool) -> str:
    """Returns a scene as the text of a scene file. Each key and each chain has a line."""
    return "".join(f"{_key(key, 'scene')}: {value_text(value, str(key), si)}\n" for key, value in scene.items())


def _key(key: Any, where: str) -> str:
    if not isinstance(key, str):
        raise InputError(f"the key {key!r} is not a string ({where}): give strings as keys")
    return key if _PLAIN.match(key) else json.dumps(key, ensure_ascii=False)


def _list_text(items: list[str]) -> str:
    """Returns a list in flow style, with a line for each entry that is a list or a map itself."""
    is_long = any(item[0] in "{[" for item in items)
    return "[\n  " + ",\n  ".join(items) + "]" if is_long else "[" + ", ".join(items) + "]"


def _number_text(number: float) -> str:
    if number != number:
        return ".nan"
    if number in (float("inf"), float("-inf")):
        return ".inf" if number > 0 else "-.inf"
    return repr(number)
