#!/usr/bin/env python3
"""Measures catena.openmm beside OpenMM's own integrators: seconds per step of polymers whose bonds are constraints.

Rows: `chain` is ChainLangevinIntegrator, `ccma` LangevinMiddleIntegrator with the same constraints, `bonds` the same with harmonic bonds in
place of constraints. Columns: creation of the Context, first step, one step, its time on all cores together (which other programs on the
machine change less), largest relative error of a bond's length. `first` creates
one Context of many links by `prepared` and takes one step. The answer is a table, and with --json a file.
"""
import argparse
import json
import os
import sys
import time

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "python_package"))
import openmm
from openmm_systems import LENGTH, chain_parents, constraint_error, make_system, positions, walk

from catena.openmm import ChainLangevinIntegrator, prepared

TEMPERATURE, FRICTION, STEP, STIFFNESS = 300, 1.0, 0.01, 8033.0


def polymer(beads, forces):
    """A System of a polymer on constraints, its positions, and the names of forces: pairs (soft spheres) and angles."""
    parents = chain_parents(beads)
    system, x = make_system(parents), walk(parents)
    if "angles" in forces:
        force = openmm.CustomAngleForce("5*(theta-2.2)^2")
        for k in range(1, beads - 1):
            force.addAngle(k - 1, k, k + 1, [])
        system.addForce(force)
    if "pairs" in forces:
        force = openmm.CustomNonbondedForce("20*(1-r/0.5)^2")
        force.setNonbondedMethod(openmm.CustomNonbondedForce.CutoffNonPeriodic)
        force.setCutoffDistance(0.5)
        for _ in range(beads):
            force.addParticle([])
        force.createExclusionsFromBonds([(k - 1, k) for k in range(1, beads)], 1)
        system.addForce(force)
    return system, x


def with_bonds(system):
    """The System with harmonic bonds in place of its constraints."""
    bonded, force = openmm.XmlSerializer.clone(system), openmm.HarmonicBondForce()
    for i in reversed(range(bonded.getNumConstraints())):
        a, b, _ = bonded.getConstraintParameters(i)
        force.addBond(a, b, LENGTH, STIFFNESS)
        bonded.removeConstraint(i)
    bonded.addForce(force)
    return bonded


def context_of(system, integrator, options):
    platform = openmm.Platform.getPlatform(options.platform)
    if options.platform == "CPU":
        return openmm.Context(system, integrator, platform, {"Threads": str(options.threads)})
    if options.platform == "Reference":
        return openmm.Context(system, integrator, platform)
    return openmm.Context(system, integrator, platform, {"Precision": options.precision})


def wait(context):
    context.getState(velocities=True)


def measure(name, system, x, options):
    """One row: seconds of creation, first step and step, and the error of the bonds."""
    kind = ChainLangevinIntegrator if name == "chain" else openmm.LangevinMiddleIntegrator
    used = with_bonds(system) if name == "bonds" else system
    integrator, begun = kind(TEMPERATURE, FRICTION, STEP), time.perf_counter()
    try:
        if name == "chain":
            with prepared(used, integrator):
                context = context_of(used, integrator, options)
        else:
            context = context_of(used, integrator, options)
    except openmm.OpenMMException as refused:
        return {"integrator": name, "refused": str(refused)}
    made = time.perf_counter()
    context.setPositions(x)
    context.setVelocitiesToTemperature(TEMPERATURE, 1)
    started = time.perf_counter()
    integrator.step(1)
    wait(context)
    first = time.perf_counter()
    integrator.step(options.warm)
    wait(context)
    times, computing = [], time.process_time()
    for _ in range(options.repeat):
        start = time.perf_counter()
        integrator.step(options.steps)
        wait(context)
        times.append((time.perf_counter() - start) / options.steps)
    computing = (time.process_time() - computing) / options.steps / options.repeat
    error = constraint_error(system, positions(context))
    return {"integrator": name, "beads": len(x), "creation_s": made - begun, "first_step_s": first - started, "step_s": float(np.median(times)),
            "step_s_all": times, "processor_s": computing, "bond_error": float(error)}


def first_step(links, options):
    """Seconds from a System with many constraints to the end of the first step."""
    system, x = polymer(links + 1, ())
    integrator, begun = ChainLangevinIntegrator(TEMPERATURE, FRICTION, STEP), time.perf_counter()
    try:
        with prepared(system, integrator):
            context = context_of(system, integrator, options)
    except openmm.OpenMMException as refused:
        return {"integrator": "first", "refused": str(refused)}
    made = time.perf_counter()
    context.setPositions(x)
    started = time.perf_counter()
    integrator.step(1)
    wait(context)
    done = time.perf_counter()
    return {"integrator": "first", "beads": links + 1, "creation_s": made - begun, "first_step_s": done - started, "both_s": made - begun + done - started,
            "bond_error": float(constraint_error(system, positions(context)))}


def show(row):
    if "refused" in row:
        print(f"{row['integrator']:8} refused: {row['refused']}", flush=True)
        return
    step = f"{1e3 * row['step_s']:10.4f} {1e3 * row['processor_s']:10.4f}" if "step_s" in row else " " * 21
    print(f"{row['integrator']:8} {row['beads']:9} {row['creation_s']:12.3f} {row['first_step_s']:12.4f} {step} {row['bond_error']:10.1e}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--platform", default="CPU")
    parser.add_argument("--precision", default="mixed", help="of GPU platforms")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--beads", type=int, nargs="*", default=[1000, 10000, 100000])
    parser.add_argument("--integrators", nargs="*", default=["chain", "ccma", "bonds"], choices=["chain", "ccma", "bonds"])
    parser.add_argument("--forces", nargs="*", default=["angles", "pairs"], choices=["angles", "pairs"])
    parser.add_argument("--steps", type=int, default=100, help="steps per measurement")
    parser.add_argument("--warm", type=int, default=20, help="steps before the first measurement")
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--first", type=int, default=1000000, help="links of the first step; 0: leave it out")
    parser.add_argument("--json", help="file for all figures")
    options = parser.parse_args()
    print(f"OpenMM {openmm.__version__}, {options.platform}, threads {options.threads}, forces {' '.join(options.forces) or 'none'}")
    print(f"{'':8} {'beads':>9} {'creation [s]':>12} {'first [s]':>12} {'step [ms]':>10} {'cores [ms]':>10} {'error':>10}")
    rows = []
    for beads in options.beads:
        system, x = polymer(beads, options.forces)
        for name in options.integrators:
            rows.append(measure(name, system, x, options))
            show(rows[-1])
    if options.first:
        rows.append(first_step(options.first, options))
        show(rows[-1])
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            shown = {name: value for name, value in vars(options).items() if name != "json"}
            json.dump({"openmm": openmm.__version__, "options": shown, "rows": rows}, file, indent=1)


if __name__ == "__main__":
    main()
