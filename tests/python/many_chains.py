#!/usr/bin/env python3
"""Opens the topology of 720 chains (100,800 beads) with other people's readers: each must see every chain and bead.

Usage: many_chains.py CATENA. The chains have more names than there are letters, and more atoms than serial numbers have digits. mdtraj is asked if it is there.
Exit status 0: all as it should be; 1: not; 77: skipped, a package is missing."""
import os
import subprocess
import sys
import tempfile
import warnings

try:
    import MDAnalysis
    import openmm.app
except ImportError as error:
    print(f"SKIPPED: the Python package {error.name} is missing (pip install openmm MDAnalysis)")
    sys.exit(77)
try:
    import mdtraj
except ImportError:
    mdtraj = None

CHAINS, BEADS = 720, 140
SCENE = f"""
chains: [{{name: p, count: {CHAINS}, sequence: {"GASKE" * (BEADS // 5)}, model: calvados2}}]
dynamics: {{integrator: rattle, step: 0.01, steps: 0}}
output: {{every: 1}}
"""


def seen_by_openmm(reader, path):
    topology = reader(path).topology
    return topology.getNumChains(), topology.getNumAtoms()


def seen_by_mdanalysis(path):
    universe = MDAnalysis.Universe(path)
    return len(universe.segments), len(universe.atoms)


def seen_by_mdtraj(path):
    topology = mdtraj.load(path).topology
    return topology.n_chains, topology.n_atoms


def main():
    warnings.simplefilter("ignore")
    with tempfile.TemporaryDirectory() as folder:
        scene = os.path.join(folder, "many.yaml")
        with open(scene, "w", encoding="utf-8") as file:
            file.write(SCENE)
        output = os.path.join(folder, "out")
        subprocess.run([sys.argv[1], "run", scene, "--output", output, "--quiet"], check=True)
        pdb, cif = os.path.join(output, "topology.pdb"), os.path.join(output, "topology.cif")
        seen = {
            "OpenMM's PDBFile": seen_by_openmm(openmm.app.PDBFile, pdb),
            "OpenMM's PDBxFile": seen_by_openmm(openmm.app.PDBxFile, cif),
            "MDAnalysis": seen_by_mdanalysis(pdb),
        }
        if mdtraj:
            seen |= {f"mdtraj ({os.path.basename(path)})": seen_by_mdtraj(path) for path in (pdb, cif)}
    wrong = {name: count for name, count in seen.items() if count != (CHAINS, CHAINS * BEADS)}
    if wrong:
        raise SystemExit(f"FAILED: not {CHAINS} chains and {CHAINS * BEADS} beads, but {wrong}")
    print(f"{CHAINS} chains and {CHAINS * BEADS} beads for {', '.join(seen)}")


main()
