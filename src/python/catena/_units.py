"""Quantities of openmm.unit and pint as values of scenes, in the units of the key."""

from __future__ import annotations

import functools
import re
from typing import Any

from catena import _core
from catena.errors import InputError

#: Units of the words in declarations of keys, in nm, ps, amu, kJ/mol and in SI; names that openmm.unit and pint share.
_MD = {"length": ["nanometer"], "time": ["picosecond"], "mass": ["dalton"], "energy": ["kilojoule", "/mole"]}
_SI = {"length": ["meter"], "time": ["second"], "mass": ["kilogram"], "energy": ["joule"]}
_OTHERS = {"kelvin": ["kelvin"], "radians": ["radian"], "radian": ["radian"], "angstrom": ["angstrom"], "minutes": ["minute"], "mol/l": ["mole", "/liter"]}


def is_quantity(value: Any) -> bool:
    """True for a number or an array with a unit, of openmm.unit or pint."""
    return hasattr(value, "value_in_unit") or (hasattr(value, "magnitude") and hasattr(value, "to"))


def number_of(quantity: Any, key: str, si: bool) -> Any:
    """Returns the number or numbers of a quantity in the unit that a key of a scene has.

    Raises InputError for a key without unit, and for a quantity of another dimension.
    """
    wanted = _units_of_keys().get(_general(key), ())
    known = [powers for words in wanted if (powers := _powers(words, si)) is not None]
    if len(known) < max(1, len(wanted)):
        reason = f"the unit of the key depends on other keys, {wanted[0]}" if wanted else "the key takes no unit"
        raise InputError(f"{reason} ({key}): give a plain number instead of {quantity}")
    for powers in known:
        try:
            return _openmm_number(quantity, powers) if hasattr(quantity, "value_in_unit") else _pint_number(quantity, powers)
        except TypeError:
            pass
    raise InputError(f"{quantity} does not have the unit of the key, {' or '.join(wanted)} ({key}): give such a quantity, or a plain number")


def _openmm_number(quantity: Any, powers: list[tuple[str, int]]) -> Any:
    from openmm import unit

    wanted = unit.dimensionless
    for name, power in powers:
        wanted = wanted * getattr(unit, name) ** power
    return quantity.value_in_unit(wanted)


def _pint_number(quantity: Any, powers: list[tuple[str, int]]) -> Any:
    return quantity.to(quantity._REGISTRY.parse_units(" * ".join(f"{name} ** {power}" for name, power in powers))).magnitude


def _powers(words: str, si: bool) -> list[tuple[str, int]] | None:
    """Returns the units and exponents of a unit in words, such as ``mass length^2 / time``; None for other words."""
    units = {**(_SI if si else _MD), **_OTHERS}
    powers: list[tuple[str, int]] = []
    sign = 1
    for token in [words] if words in units else words.split():
        name, _, exponent = token.partition("^")
        if token == "/":
            sign = -1
        elif name in units and re.fullmatch(r"\d*", exponent):
            power = sign * int(exponent or 1)
            powers += [(each.lstrip("/"), -power if each.startswith("/") else power) for each in units[name]]
        elif token != "1":
            return None
    return powers


@functools.cache
def _units_of_keys() -> dict[str, tuple[str, ...]]:
    """Returns the units in words of each key, by its place without numbers, such as ``chains[].bodies[].mass``."""
    units: dict[str, tuple[str, ...]] = {}
    for places, name, words in _core.units_of_keys():
        for place in [""] if places == "the scene file" else places.split(", "):
            key = _general(f"{place.split(' ')[0]}.{name}".lstrip("."))
            units[key] = tuple(dict.fromkeys((*units.get(key, ()), words)))
    return units


def _general(key: str) -> str:
    """Returns a key without the numbers of entries; those at its end are of a list that is its value."""
    return re.sub(r"\[[^\]]*\]", "[]", re.sub(r"(\[\d+\])+$", "", key))
