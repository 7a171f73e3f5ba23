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
    """Returns the number or numbers of a quantity in the unit that a key of a scene has; a text with unit for ``concentration``.

    Quantities per particle, such as a force in pN or a mass in g/mol, are converted to those per mole or back. Raises
    InputError for a key without unit, and for a quantity of another dimension.
    """
    if _general(key).endswith("concentration"):
        return _concentration(quantity, key)
    wanted = _units_of_keys().get(_general(key), ())
    known = [powers for words in wanted if (powers := _powers(words, si)) is not None]
    if len(known) < max(1, len(wanted)):
        if not wanted:
            raise InputError(f"the key takes no unit, or is unknown ({key}): give a plain number instead of {quantity}, or another key")
        raise InputError(f"the unit of the key depends on other keys, {wanted[0]} ({key}): give a plain number in that unit instead of {quantity}")
    for powers in known:
        number = _in_units(quantity, powers)
        if number is not None:
            return number
    units = " or ".join(_shown(powers) for powers in known)
    raise InputError(f"{quantity} does not have the unit of the key, {' or '.join(wanted)} ({key}): give a quantity that {units} can express, or a plain number")


def _concentration(quantity: Any, key: str) -> str:
    """Returns a concentration as scenes write it."""
    for name, powers in (("g/l", [("gram", 1), ("liter", -1)]), ("mol/l", [("mole", 1), ("liter", -1)])):
        number = _in_units(quantity, powers)
        if number is not None:
            return f"{float(number)!r} {name}"
    raise InputError(f"{quantity} is no concentration ({key}): give one such as '5 mg/ml' or '2 mmol/l', or a quantity of this kind")


def _in_units(quantity: Any, powers: list[tuple[str, int]]) -> Any:
    """Returns the number of a quantity in the product of units, also of one per particle instead of per mole; None for other dimensions."""
    convert = _openmm_number if hasattr(quantity, "value_in_unit") else _pint_number
    for moles in (0, 1, -1):
        try:
            return convert(quantity, powers, moles)
        except TypeError:  # pint's DimensionalityError is one
            pass
    return None


def _shown(powers: list[tuple[str, int]]) -> str:
    return " ".join(name if power == 1 else f"{name}^{power}" for name, power in powers)


def _openmm_number(quantity: Any, powers: list[tuple[str, int]], moles: int) -> Any:
    """Returns the number of a quantity, times Avogadro's to the power of ``moles``, in the product of units."""
    from openmm import unit

    wanted = unit.dimensionless
    for name, power in powers:
        wanted = wanted * getattr(unit, name) ** power
    return (quantity * unit.AVOGADRO_CONSTANT_NA**moles if moles else quantity).value_in_unit(wanted)


def _pint_number(quantity: Any, powers: list[tuple[str, int]], moles: int) -> Any:
    """Returns what ``_openmm_number`` does."""
    units = quantity._REGISTRY
    if moles:
        quantity = quantity * (6.02214076e23 / units.mole) ** moles
    return quantity.to(units.parse_units(" * ".join(f"{name} ** {power}" for name, power in powers))).magnitude


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
