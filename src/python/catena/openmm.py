"""Integrators for plain OpenMM scripts, whose constraints Catena solves.

Constraints that form chains, rings and trees are solved by the divide-and-conquer algorithm instead of CCMA. Rigid
water stays with SETTLE. All else is OpenMM's: states, forces, reporters, checkpoints, XML.

    from catena.openmm import ChainLangevinIntegrator
    integrator = ChainLangevinIntegrator(300 * unit.kelvin, 0.01 / unit.picosecond, 0.01 * unit.picosecond)
"""

from __future__ import annotations

from typing import Any

from catena import _core

try:
    import openmm
    from openmm import unit
except ImportError as error:
    raise ImportError(f"catena.openmm needs OpenMM ({error}): pip install openmm, then install catena again") from error

if not _core.has_openmm_integrators:
    raise ImportError(
        "catena.openmm: catena was built without PyPI's openmm package: pip install openmm, then install catena again"
    )
_core.register_openmm_integrators()

__all__ = ["ChainLangevinIntegrator", "ChainVerletIntegrator"]


def _number(value: Any, in_unit: unit.Unit) -> float:
    return float(value.value_in_unit(in_unit) if unit.is_quantity(value) else value)


def _made_of(name: str, **properties: float) -> openmm.Integrator:
    """Returns an integrator that OpenMM makes from XML, so that its Python package owns and wraps it."""
    numbers = {"version": 1, "constraintTolerance": 1e-5, "forceGroups": -1, **properties}
    written = " ".join(f'{key}="{value!r}"' for key, value in numbers.items())
    return openmm.XmlSerializer.deserialize(f'<Integrator type="{name}" {written}/>')


class ChainLangevinIntegrator(openmm.LangevinMiddleIntegrator):
    """OpenMM's LangevinMiddleIntegrator, with constraints solved by the divide-and-conquer algorithm.

    Parameters are those of OpenMM: temperature (K), friction (1/ps) and step (ps), as numbers or quantities. Creating
    a Context raises an OpenMMException if constraints form loops with branches, or on a platform other than CPU and
    Reference. A step raises one if constraints stay open.
    """

    def __init__(self, temperature: Any, friction: Any, step: Any) -> None:
        made = _made_of(
            "ChainLangevinIntegrator",
            temperature=_number(temperature, unit.kelvin),
            friction=_number(friction, unit.picosecond**-1),
            stepSize=_number(step, unit.picosecond),
            randomSeed=0,
        )
        self.this = made.this


class ChainVerletIntegrator(openmm.VerletIntegrator):
    """OpenMM's VerletIntegrator, with constraints solved as by ChainLangevinIntegrator. The step is in ps."""

    def __init__(self, step: Any) -> None:
        self.this = _made_of("ChainVerletIntegrator", stepSize=_number(step, unit.picosecond)).this
