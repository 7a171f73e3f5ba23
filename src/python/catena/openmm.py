"""Integrators for plain OpenMM scripts, whose constraints Catena solves.

Constraints are solved by the divide-and-conquer algorithm instead of CCMA: of every shape on the platforms CPU and
Reference, those that form chains on GPUs. Rigid water stays with SETTLE. All else is OpenMM's: states, forces, reporters, checkpoints, XML.

    from catena.openmm import ChainLangevinIntegrator
    integrator = ChainLangevinIntegrator(300 * unit.kelvin, 0.01 / unit.picosecond, 0.01 * unit.picosecond)
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterator
from typing import Any

from catena.errors import InputError

try:
    import openmm
    from openmm import unit
except ImportError as error:
    raise ImportError(f"catena.openmm needs OpenMM ({error}): pip install openmm, then install catena again") from error
try:
    from catena import _integrators  # after openmm, which loads the library that it needs
except ImportError as error:
    raise ImportError(
        f"catena was built without PyPI's openmm package, or for another OpenMM than {openmm.__version__} ({error}): "
        "install catena again"
    ) from error
try:
    _integrators.register()
except InputError as error:
    raise ImportError(str(error)) from None

__all__ = ["ChainLangevinIntegrator", "ChainVerletIntegrator", "prepared"]


def _number(value: Any, in_unit: unit.Unit, name: str) -> float:
    """Returns a number in a unit. Raises InputError for texts and for numbers that are not finite."""
    number = value.value_in_unit(in_unit) if unit.is_quantity(value) else value
    if isinstance(number, (str, bytes)) or not math.isfinite(number):
        raise InputError(f"the {name} is {value!r} (catena.openmm): give a finite number, or a quantity")
    return float(number)


def _made_of(name: str, **properties: float) -> openmm.Integrator:
    """Returns an integrator that OpenMM makes from XML, so that its Python package owns and wraps it."""
    numbers = {"version": 1, "constraintTolerance": 1e-5, "forceGroups": -1, **properties}
    written = " ".join(f'{key}="{value!r}"' for key, value in numbers.items())
    return openmm.XmlSerializer.deserialize(f'<Integrator type="{name}" {written}/>')


class ChainLangevinIntegrator(openmm.LangevinMiddleIntegrator):
    """OpenMM's LangevinMiddleIntegrator, with constraints solved by the divide-and-conquer algorithm.

    Parameters are those of OpenMM: temperature (K), friction (1/ps) and step (ps), as numbers or quantities. Creating
    a Context on a GPU raises an OpenMMException if constraints form rings, trees or nets. A step raises one if
    constraints stay open.
    """

    def __init__(self, temperature: Any, friction: Any, step: Any) -> None:
        made = _made_of(
            "ChainLangevinIntegrator",
            temperature=_number(temperature, unit.kelvin, "temperature (K)"),
            friction=_number(friction, unit.picosecond**-1, "friction (1/ps)"),
            stepSize=_number(step, unit.picosecond, "step (ps)"),
            randomSeed=0,
        )
        self.this = made.this


class ChainVerletIntegrator(openmm.VerletIntegrator):
    """OpenMM's VerletIntegrator, with constraints solved as by ChainLangevinIntegrator. The step is in ps."""

    def __init__(self, step: Any) -> None:
        self.this = _made_of("ChainVerletIntegrator", stepSize=_number(step, unit.picosecond, "step (ps)")).this


@contextlib.contextmanager
def prepared(system: openmm.System, integrator: openmm.Integrator) -> Iterator[None]:
    """Creates Contexts with many constraints quickly, within a ``with`` statement.

    OpenMM prepares its CCMA for every Context, which takes a minute with 100,000 constraints and hours with a million.
    Within the statement the System lacks its constraints until the integrator gets a Context; OpenMM prepares nothing.
    Only create or reinitialise the Context or Simulation within it. Raises InputError if none was made.
    """
    address = int(system.this), int(integrator.this)
    _integrators.take_constraints(*address)
    try:
        yield
    except BaseException:
        _integrators.put_constraints_back(*address)
        raise
    if _integrators.put_constraints_back(*address):
        raise InputError(
            "no Context was created with the integrator (catena.openmm.prepared): create it within the `with` "
            "statement; other Contexts that were created there have no constraints"
        )
