#!/usr/bin/env python3
"""Opens the topology of a complex of two chains with other people's readers: each must see its members.

usage: open_members.py CATENA INPUTS. The complex is inputs/ubiquitin-pair.yaml; a second scene has so many chains beside it that its
topology is mmCIF. mdtraj is asked if it is there. Exit status 0: all as it should be; 1: not; 77: skipped, a package is missing."""
import os
import subprocess
import sys
import tempfile
import warnings

try:
    import h5py
    import MDAnalysis
    import numpy as np
    import openmm.app
except ImportError as error:
    print(f"SKIPPED: the Python package {error.name} is missing (pip install openmm MDAnalysis h5py)")
    sys.exit(77)
try:
    import mdtraj
except ImportError:
    mdtraj = None

RESIDUES = 76
MANY = """
chains:
  - {{pdb: {pdb}, chain: all, model: calvados2, rigid: [["A:1-72", "B:1-72"]]}}
  - {{name: p, count: 1000, sequence: {sequence}, model: calvados2}}
dynamics: {{integrator: rattle, step: 0.01, steps: 0}}
output: {{every: 1}}
"""


def check(condition, message):
    if not condition:
        raise SystemExit(f"FAILED: {message}")


def run(catena, scene, output, *more):
    subprocess.run([catena, "run", scene, "--output", output, "--quiet", *more], check=True)


def check_numbers(reader, chain, found):
    check(sorted(found) == list(range(1, RESIDUES + 1)), f"{reader}: chain {chain} has the residues {found}")


def check_bonds(reader, bonds):
    """`bonds`: chain and residue number of both ends."""
    pairs = {tuple(sorted(pair)) for pair in bonds}
    right = {((chain, k), (chain, k + 1)) for chain in "AB" for k in range(1, RESIDUES)}
    check(pairs == right, f"{reader}: bonds {sorted(pairs ^ right)[:4]} differ")


def check_with_mdanalysis(topology, trajectory):
    universe = MDAnalysis.Universe(topology, trajectory)
    check([s.segid for s in universe.segments] == ["A", "B"], f"MDAnalysis: segments {list(universe.segments)}")
    for segment in universe.segments:
        check_numbers("MDAnalysis", segment.segid, list(segment.residues.resids))
    check_bonds("MDAnalysis", [tuple((a.segid, int(a.resid)) for a in bond.atoms) for bond in universe.bonds])
    check(len(universe.atoms.fragments) == 2, f"MDAnalysis: {len(universe.atoms.fragments)} fragments")
    return len(universe.trajectory)


def check_with_openmm(reader, path, bonds):
    topology = reader(path).topology
    chains = list(topology.chains())[:2]
    check([c.id for c in chains] == ["A", "B"], f"OpenMM: chains {[c.id for c in chains]}")
    for chain in chains:
        check_numbers("OpenMM", chain.id, [int(r.id) for r in chain.residues()])
    if bonds:
        check_bonds("OpenMM", [tuple((a.residue.chain.id, int(a.residue.id)) for a in bond) for bond in topology.bonds()])
    return topology.getNumChains()


def check_with_mdtraj(pdb, trajectory, file):
    top = mdtraj.load(pdb).topology
    check([c.chain_id for c in top.chains] == ["A", "B"], f"mdtraj: {list(top.chains)}")
    for chain in top.chains:
        check_numbers("mdtraj", chain.chain_id, [r.resSeq for r in chain.residues])
    check_bonds("mdtraj", [tuple((a.residue.chain.chain_id, a.residue.resSeq) for a in bond) for bond in top.bonds])
    found = mdtraj.load(trajectory, top=pdb)
    check(np.max(np.abs(found.xyz - file["particles/trajectory/position/value"][:])) < 0.00051, "mdtraj: positions of the XTC file")


def check_members(file):
    members = file["catena/members"]
    check(list(members["identifier"][:]) == [b"A", b"B"] and list(members["chain"][:]) == [0, 0], "identifiers in the trajectory")
    for m, chain in enumerate("AB"):
        mine = members["member"][:] == m
        check_numbers("h5py", chain, list(members["number"][:][mine]))
        check(np.all(members["number"][:][mine] == members["place"][:][mine] + 1), "places in the trajectory")


def main():
    warnings.simplefilter("ignore")
    catena, inputs = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        output, xtc = os.path.join(folder, "pair"), os.path.join(folder, "pair.xtc")
        run(catena, os.path.join(inputs, "ubiquitin-pair.yaml"), output, "--steps", "20", "--set", "output.every=10")
        subprocess.run([catena, "convert", output, xtc, "--quiet"], check=True)
        pdb, psf, h5md = (os.path.join(output, name) for name in ("topology.pdb", "topology.psf", "trajectory.h5md"))
        for topology in (pdb, psf):
            for trajectory in (h5md, xtc):
                check(check_with_mdanalysis(topology, trajectory) == 3, "three frames")
        check(check_with_openmm(openmm.app.PDBFile, pdb, True) == 2, "OpenMM sees other chains than A and B")
        with h5py.File(h5md) as file:
            check_members(file)
            if mdtraj:
                check_with_mdtraj(pdb, xtc, file)
        scene = os.path.join(folder, "many.yaml")
        with open(scene, "w", encoding="utf-8") as file:
            file.write(MANY.format(pdb=os.path.abspath(os.path.join(inputs, "ubiquitin-pair.pdb")), sequence="GASKE" * 20))
        many = os.path.join(folder, "many")
        run(catena, scene, many)
        chains = check_with_openmm(openmm.app.PDBxFile, os.path.join(many, "topology.cif"), False)
        check(chains == 1002, f"OpenMM sees {chains} chains in mmCIF")
    readers = "MDAnalysis, OpenMM and mdtraj" if mdtraj else "MDAnalysis and OpenMM (mdtraj is missing)"
    print(f"two members of {RESIDUES} residues for {readers}")


main()
