#!/usr/bin/env python3
"""Simulates many proteins, each several times, and compares their radii of gyration with measured ones.

Reads a table of proteins, one a line, with the columns name, ionic (mol/l), temperature (K), ph, rg, rg_error (nm), n (residues), doi and
sequence; text from # on is a comment. Writes a scene of each protein to FOLDER/scenes, runs it with the seeds 1, 2, ... into FOLDER/NAME-1,
FOLDER/NAME-2, ..., and prints the table, which is also FOLDER/radii.csv. Runs that are there are kept; unfinished ones go on."""
import argparse
import csv
import json
import os
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
COLUMNS = ("name", "ionic", "temperature", "ph", "rg", "rg_error", "n", "doi", "sequence")
SCENE = """title: {name}, {model}
units: md
chains:
  - {{name: {name}, sequence: {sequence}, model: {model}, conformation: self_avoiding}}
forces:
  openmm: {{builder: {model}, ionic_strength: {ionic}, ph: {ph}}}
dynamics: {{integrator: g-baoab, step: 0.01, steps: {steps}, temperature: {temperature}, friction: 0.01, seed: 1}}
output: {{every: 100, observables: [temperature, constraint_error, radius_of_gyration]}}
"""


class UserError(Exception):
    """What is wrong, where, and what to do."""


def parse_arguments():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="The program is build/release/catena, or what CATENA_PROGRAM names.\n\nexamples:\n"
               "  python3 jobs/replicas.py inputs/saxs-radii.csv saxs --replicas 4 --steps 2000000\n"
               "  python3 jobs/replicas.py inputs/saxs-radii.csv saxs --only scenes && sbatch --array=1-40 jobs/slurm-array.sh saxs/scenes saxs")
    parser.add_argument("proteins", metavar="PROTEINS.csv", help="table of proteins")
    parser.add_argument("folder", metavar="FOLDER", help="where scenes, runs and the table go")
    parser.add_argument("--replicas", type=int, default=1, metavar="R", help="runs of each protein (default: 1)")
    parser.add_argument("--steps", type=int, default=200000, metavar="N", help="steps of each run, of 10 fs (default: 200000)")
    parser.add_argument("--model", choices=("calvados2", "calvados3"), default="calvados2", help="the force field (default: calvados2)")
    parser.add_argument("--only", choices=("scenes", "table"), help="only write the scenes, or only the table of the runs that are there")
    parser.add_argument("--picture", metavar="FILE", help="also draw the table (PNG or SVG; needs matplotlib)")
    return parser.parse_args()


def read_proteins(path):
    """The lines of the table, as dictionaries with numbers where they belong."""
    try:
        with open(path, encoding="utf-8") as file:
            rows = list(csv.DictReader(line for line in file if line.strip() and not line.startswith("#")))
    except OSError as error:
        raise UserError(f"cannot read the proteins ({path}): {error.strerror}") from None
    for row in rows:
        missing = [name for name in COLUMNS if not row.get(name)]
        if missing:
            raise UserError(f"a protein has no `{missing[0]}` ({path}, {row.get('name')}): the columns are {', '.join(COLUMNS)}")
        row.update({name: float(row[name]) for name in ("rg", "rg_error")})
        if len(row["sequence"]) != int(row["n"]):
            raise UserError(f"the sequence has {len(row['sequence'])} residues, not {row['n']} ({path}, {row['name']}): correct one of them")
    if not rows:
        raise UserError(f"there are no proteins ({path}): give one a line")
    return rows


def write_scenes(proteins, asked):
    """A scene of each protein in FOLDER/scenes; returns their paths by name."""
    folder = os.path.join(asked.folder, "scenes")
    os.makedirs(folder, exist_ok=True)
    paths = {}
    for row in proteins:
        paths[row["name"]] = path = os.path.join(folder, row["name"] + ".yaml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(SCENE.format(**row, model=asked.model, steps=asked.steps))
    return paths


def summary_of(folder):
    """What a run wrote at its end, None before."""
    try:
        with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError):
        return None


def run(scene, seed, asked):
    """Runs a scene unless it has all its steps; goes on from a checkpoint."""
    folder = os.path.join(asked.folder, f"{os.path.splitext(os.path.basename(scene))[0]}-{seed}")
    summary = summary_of(folder)
    if summary and summary["run"]["last_step"] >= asked.steps:
        return
    program = os.environ.get("CATENA_PROGRAM", os.path.join(ROOT, "build", "release", "catena"))
    words = [program, "run", scene, "--output", folder, "--set", f"dynamics.seed={seed}", "--quiet"]
    checkpoint = os.path.join(folder, "checkpoint.h5")
    words += ["--restart", checkpoint] if os.path.exists(checkpoint) else ["--overwrite"]
    try:
        status = subprocess.run(words, check=False).returncode
    except OSError as error:
        raise UserError(f"cannot start the program ({program}): {error.strerror}; build it, or name it by CATENA_PROGRAM") from None
    if status != 0:
        raise UserError(f"a run ended with status {status} ({folder}): see the line above")


def runs_of(name, folder):
    """Radii of gyration of the protein's runs that are VALID: mean, standard error, and whether that error is only a lower limit."""
    found = []
    for seed in range(1, 1 + sum(each.startswith(name + "-") for each in os.listdir(folder))):
        summary = summary_of(os.path.join(folder, f"{name}-{seed}"))
        if summary and summary["valid"]:
            radius = summary["observables"]["radius_of_gyration"]
            found.append((radius["mean"], radius["standard_error"] or 0.0, not radius.get("converged", True), summary["run"]["time"]))
    return found


def combine(runs):
    """Mean over runs. Its error is the larger of what the runs' own errors and their scatter give."""
    count = len(runs)
    mean = sum(each[0] for each in runs) / count
    own = sum(each[1] ** 2 for each in runs) ** 0.5 / count
    scatter = (sum((each[0] - mean) ** 2 for each in runs) / (count - 1) / count) ** 0.5 if count > 1 else 0.0
    return mean, max(own, scatter), any(each[2] for each in runs)


def table_of(proteins, folder):
    """A line of each protein that has runs."""
    lines = []
    for row in proteins:
        runs = runs_of(row["name"], folder)
        if runs:
            mean, error, at_least = combine(runs)
            lines.append({"name": row["name"], "residues": int(row["n"]), "measured_nm": row["rg"], "measured_error_nm": row["rg_error"],
                          "simulated_nm": round(mean, 3), "simulated_error_nm": round(error, 3), "error_is_lower_limit": at_least,
                          "runs": len(runs), "time_ns": round(sum(each[3] for each in runs) / 1000, 3), "doi": row["doi"]})
    return lines


def print_table(lines):
    print("| protein | residues | measured (nm) | simulated (nm) | runs | ns in all | source |\n| --- | --- | --- | --- | --- | --- | --- |")
    for each in lines:
        least = "at least " if each["error_is_lower_limit"] else ""
        print(f"| {each['name']} | {each['residues']} | {each['measured_nm']:.2f} +- {each['measured_error_nm']:.2f} | "
              f"{each['simulated_nm']:.2f} +- {least}{each['simulated_error_nm']:.2f} | {each['runs']} | {each['time_ns']:g} | {each['doi']} |")


def write_table(lines, path):
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(lines[0]))
        writer.writeheader()
        writer.writerows(lines)


def draw(lines, path):
    try:
        import matplotlib
    except ImportError:
        raise UserError("a Python package is missing (matplotlib): pip install matplotlib") from None
    matplotlib.use("Agg")
    matplotlib.rcParams["svg.hashsalt"] = "catena"
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=(5, 4.5), layout="constrained")
    largest = 1.1 * max(max(each["measured_nm"], each["simulated_nm"]) for each in lines)
    axes.plot([0, largest], [0, largest], color="#9aa7b4", linewidth=1)
    for each in lines:
        axes.errorbar(each["measured_nm"], each["simulated_nm"], each["simulated_error_nm"], each["measured_error_nm"], fmt="o", markersize=4,
                      color="#0b6bcb")
        axes.annotate(each["name"], (each["measured_nm"], each["simulated_nm"]), (5, -9), textcoords="offset points", fontsize=7)
    axes.set(xlabel="measured radius of gyration (nm)", ylabel="simulated radius of gyration (nm)", xlim=(1, largest), ylim=(1, largest))
    figure.savefig(path, dpi=110, metadata={"Date": None} if path.endswith(".svg") else None)


def main():
    asked = parse_arguments()
    if asked.replicas < 1 or asked.steps < 1:
        raise UserError("--replicas and --steps are 1 at least")
    proteins = read_proteins(asked.proteins)
    if asked.only != "table":
        scenes = write_scenes(proteins, asked)
    if asked.only == "scenes":
        print(f"{len(scenes)} scenes in {asked.folder}/scenes")
        return
    if asked.only is None:
        for seed in range(1, asked.replicas + 1):
            for scene in scenes.values():
                run(scene, seed, asked)
    lines = table_of(proteins, asked.folder) if os.path.isdir(asked.folder) else []
    if not lines:
        raise UserError(f"there are no finished runs ({asked.folder}): leave --only out to make them")
    write_table(lines, os.path.join(asked.folder, "radii.csv"))
    print_table(lines)
    if asked.picture:
        draw(lines, asked.picture)


if __name__ == "__main__":
    try:
        main()
    except UserError as error:
        print(f"jobs/replicas.py: {error}", file=sys.stderr)
        sys.exit(2)
