#!/usr/bin/env python3
"""Simulates many proteins, each several times, and compares their radii of gyration with measured ones.

Reads a table of proteins, one a line, with the columns name, ionic (mol/l), temperature (K), ph, rg, rg_error (nm), n (residues), doi and
sequence; text from # on is a comment. Writes a scene of each protein to FOLDER/scenes, runs it with the seeds 1, 2, ... into FOLDER/NAME-1,
FOLDER/NAME-2, ..., and prints the table, which is also FOLDER/radii.csv. Runs that are there are kept; unfinished ones go on.
On a GPU the scene key `replicas: N` samples N copies in one run (inputs/keys/replicas.md)."""
import argparse
import csv
import json
import math
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
COLUMNS = ("name", "ionic", "temperature", "ph", "rg", "rg_error", "n", "doi", "sequence")
BOND, BALL = 0.38, 0.246  # nm: length of a link; radius of gyration of a ball of one residue's volume
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


def whole(text):
    """A whole number, which may be written as 1e5."""
    value = float(text)
    if not value.is_integer():  # nor are inf and nan
        raise ValueError(text)
    return int(value)


def parse_arguments():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="The program is build/release/catena, or what CATENA_PROGRAM names.\n\nexamples:\n"
               "  python3 jobs/replicas.py inputs/saxs-radii.csv saxs --replicas 4 --steps 2000000\n"
               "  python3 jobs/replicas.py inputs/saxs-radii.csv saxs --steps 2000000 --only scenes && \\\n"
               "    sbatch --array=1-40 --ntasks=1 jobs/slurm-array.sh saxs/scenes saxs")
    parser.add_argument("proteins", metavar="PROTEINS.csv", help="table of proteins")
    parser.add_argument("folder", metavar="FOLDER", help="where scenes, runs and the table go")
    parser.add_argument("--replicas", type=whole, default=1, metavar="R", help="runs of each protein (default: 1)")
    parser.add_argument("--steps", type=whole, default=200000, metavar="N", help="steps of each run, of 10 fs (default: 200000)")
    parser.add_argument("--model", choices=("calvados2", "calvados3"), default="calvados2", help="the force field (default: calvados2)")
    parser.add_argument("--only", choices=("scenes", "table"), help="only write the scenes, or only the table of the runs that are there")
    parser.add_argument("--picture", metavar="FILE", help="also draw the table (PNG or SVG; needs matplotlib)")
    return parser.parse_args()


def number_of(row, name, where):
    """A number of a line that is finite and above 0 (the pH: 0 to 14; the ionic strength: from 0 on, as for the program)."""
    try:
        value = float(row[name])
    except ValueError:
        value = float("nan")
    kind = {"ph": "a pH", "ionic": "a number of 0 or more"}.get(name, "a number above 0")
    if not (0 <= value <= 14 if name == "ph" else 0 <= value < 1e6 and (value > 0 or name == "ionic")):
        raise UserError(f"`{name}` of {row['name']} is not {kind}: {row[name]} ({where})")
    return value


def checked_protein(row, path, line):
    """A line of the table with numbers where they belong."""
    where = f"{path}, line {line}"
    for name in COLUMNS:
        if not row.get(name):
            raise UserError(f"a protein has no `{name}` ({where}): the columns are {', '.join(COLUMNS)}")
    if not re.fullmatch(r"[A-Za-z0-9_.+-]+", row["name"]):
        raise UserError(f"a name has letters, digits and _ . + - alone, for it names files: {row['name']!r} ({where})")
    if not row["sequence"].isalpha():
        raise UserError(f"the sequence of {row['name']} has more than letters ({where})")
    for name in ("ionic", "temperature", "ph"):
        number_of(row, name, where)
    row.update({name: number_of(row, name, where) for name in ("rg", "rg_error", "n")})
    if len(row["sequence"]) != row["n"]:
        raise UserError(f"the sequence has {len(row['sequence'])} residues, not {row['n']:g} ({where}, {row['name']}): correct one of them")
    # Radii of a straight chain and of a ball as dense as a protein; half the latter leaves room for tables of few digits.
    most, least = BOND * (row["n"] - 1) / math.sqrt(12), 0.5 * BALL * row["n"] ** (1 / 3)
    if not least <= row["rg"] <= max(most, 2 * least):
        raise UserError(f"`rg` of {row['name']} is {row['rg']:g} nm, and {row['n']:g} residues have {least:.2g} to {max(most, 2 * least):.2g} nm "
                        f"({where}): give it in nm")
    return row


def read_proteins(path):
    """The lines of the table, as dictionaries."""
    try:
        with open(path, encoding="utf-8-sig") as file:
            lines = [(k, line) for k, line in enumerate(file, 1) if line.strip() and not line.startswith("#")]
    except OSError as error:
        raise UserError(f"cannot read the proteins ({path}): {error.strerror}") from None
    except UnicodeDecodeError:
        raise UserError(f"the proteins are not UTF-8 text ({path}): save them as such") from None
    missing = [name for name in COLUMNS if lines and name not in lines[0][1].strip().split(",")]
    if missing:
        raise UserError(f"there is no column `{missing[0]}` ({path}, line {lines[0][0]}): the columns are {', '.join(COLUMNS)}")
    rows, names = [], {}
    for row, (k, _) in zip(csv.DictReader(line for _, line in lines), lines[1:]):
        rows.append(checked_protein(row, path, k))
        if row["name"] in names:
            raise UserError(f"the name {row['name']} occurs twice ({path}, lines {names[row['name']]} and {k})")
        names[row["name"]] = k
    if not rows:
        raise UserError(f"there are no proteins ({path}): give one a line")
    return rows


def scene_path(name, folder):
    return os.path.join(folder, "scenes", name + ".yaml")


def without_steps(text):
    return re.sub(r"\bsteps: \d+", "steps:", text)


def refuse_other_scene(row, asked):
    """Refuses a scene of the folder that has another model, sequence or condition: its runs would be taken for those asked for."""
    path = scene_path(row["name"], asked.folder)
    try:
        with open(path, encoding="utf-8") as file:
            there = file.read()
    except OSError:
        return
    if without_steps(there) != without_steps(SCENE.format(**row, model=asked.model, steps=asked.steps)):
        raise UserError(f"a scene of this folder differs from the table or --model ({path}): name another FOLDER, or delete this one")


def write_scenes(proteins, asked):
    """A scene of each protein in FOLDER/scenes; returns their paths by name."""
    try:
        os.makedirs(os.path.join(asked.folder, "scenes"), exist_ok=True)
    except OSError as error:
        raise UserError(f"cannot make the folder ({asked.folder}): {error.strerror}") from None
    paths = {row["name"]: scene_path(row["name"], asked.folder) for row in proteins}
    for row in proteins:
        with open(paths[row["name"]], "w", encoding="utf-8") as file:
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


def steps_of(name, folder):
    """Number of steps that the scene of a protein asks for; 0 without one."""
    try:
        with open(scene_path(name, folder), encoding="utf-8") as file:
            found = re.search(r"\bsteps: (\d+)", file.read())
    except OSError:
        found = None
    return int(found.group(1)) if found else 0


def print_notes(proteins, folder):
    """Says the notes of the runs that are there, each once with the runs that have it: --quiet keeps the program from saying them."""
    names, runs = {row["name"] for row in proteins}, {}
    for each in sorted(os.listdir(folder)):
        found = re.fullmatch(r"(.+)-\d+", each)
        summary = summary_of(os.path.join(folder, each)) if found and found.group(1) in names else None
        for note in summary.get("notes", []) if summary else []:
            runs.setdefault(note, []).append(each)
    for note, those in runs.items():
        more = f" and {len(those) - 1} more" if len(those) > 1 else ""
        print(f"jobs/replicas.py: note on {those[0]}{more}: {note}", file=sys.stderr)


def runs_of(name, folder):
    """Radii of gyration of the protein's finished runs that are VALID: mean, standard error, whether that error is only a lower limit, and the
    time; then the number of folders whose runs are left out."""
    found, left_out, steps = [], 0, steps_of(name, folder)
    for each in sorted(os.listdir(folder)):
        if not re.fullmatch(re.escape(name) + r"-\d+", each):
            continue
        summary = summary_of(os.path.join(folder, each))
        if summary and summary["valid"] and summary["run"]["last_step"] >= steps:
            radius = summary["observables"]["radius_of_gyration"]
            found.append((radius["mean"], math.nan if radius["standard_error"] is None else radius["standard_error"], not radius.get("converged", True), summary["run"]["time"]))
        else:
            left_out += 1
    return found, left_out


def combine(runs):
    """Mean over runs. Its error is the larger of what the runs' own errors and their scatter give; runs of too few frames have no error, and
    one such run has neither: NaN."""
    count = len(runs)
    mean = sum(each[0] for each in runs) / count
    own = sum(each[1] ** 2 for each in runs) ** 0.5 / count
    scatter = (sum((each[0] - mean) ** 2 for each in runs) / (count - 1) / count) ** 0.5 if count > 1 else math.nan
    known = [error for error in (own, scatter) if math.isfinite(error)]
    return mean, max(known, default=math.nan), any(each[2] for each in runs)


def table_of(proteins, folder):
    """A line of each protein that has runs."""
    lines = []
    for row in proteins:
        runs, left_out = runs_of(row["name"], folder)
        if left_out:
            print(f"jobs/replicas.py: {left_out} of {left_out + len(runs)} runs of {row['name']} are unfinished or INVALID and left out", file=sys.stderr)
        elif not runs:
            print(f"jobs/replicas.py: there are no runs of {row['name']}", file=sys.stderr)
        if runs:
            mean, error, at_least = combine(runs)
            lines.append({"name": row["name"], "residues": int(row["n"]), "measured_nm": row["rg"], "measured_error_nm": row["rg_error"],
                          "simulated_nm": round(mean, 3), "simulated_error_nm": round(error, 3), "error_is_lower_limit": at_least,
                          "runs": len(runs), "time_ns": round(sum(each[3] for each in runs) / 1000, 3), "doi": row["doi"]})
    return lines


def print_table(lines):
    print("| protein | residues | measured (nm) | simulated (nm) | runs | ns in all | source |\n| --- | --- | --- | --- | --- | --- | --- |")
    for each in lines:
        least, error = "at least " if each["error_is_lower_limit"] else "", each["simulated_error_nm"]
        simulated = f"+- {least}{error:.2f}" if math.isfinite(error) else "(no error: too few frames)"
        print(f"| {each['name']} | {each['residues']} | {each['measured_nm']:.2f} +- {each['measured_error_nm']:.2f} | "
              f"{each['simulated_nm']:.2f} {simulated} | {each['runs']} | {each['time_ns']:g} | {each['doi']} |")


def write_table(lines, path):
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(lines[0]))
        writer.writeheader()
        writer.writerows(lines)


def plotting():
    """matplotlib's pyplot, for files whose bytes depend on what is drawn alone."""
    try:
        import matplotlib
    except ImportError:
        raise UserError("a Python package is missing (matplotlib): use build/venv/bin/python, or install it there") from None
    matplotlib.use("Agg")
    matplotlib.rcParams["svg.hashsalt"] = "catena"
    from matplotlib import pyplot
    return pyplot


def draw(lines, path):
    pyplot = plotting()
    figure, axes = pyplot.subplots(figsize=(5, 4.5), layout="constrained")
    largest = 1.1 * max(max(each["measured_nm"], each["simulated_nm"]) for each in lines)
    axes.plot([0, largest], [0, largest], color="#9aa7b4", linewidth=1)
    for each in lines:
        axes.errorbar(each["measured_nm"], each["simulated_nm"], each["simulated_error_nm"], each["measured_error_nm"], fmt="o", markersize=4,
                      color="#0b6bcb")
        axes.annotate(each["name"], (each["measured_nm"], each["simulated_nm"]), (5, -9), textcoords="offset points", fontsize=7)
    axes.set(xlabel="measured radius of gyration (nm)", ylabel="simulated radius of gyration (nm)", xlim=(1, largest), ylim=(1, largest))
    figure.savefig(path, dpi=110, metadata={"Date": None} if path.endswith(".svg") else None)


def check_picture(asked):
    """Refuses a picture that could not be written, before hours of runs."""
    if asked.only == "scenes":
        raise UserError("--only scenes draws no picture: leave --picture out")
    if not asked.picture.endswith((".png", ".svg")):
        raise UserError(f"--picture {asked.picture!r} does not end in .png or .svg: name such a file")
    if not os.path.isdir(os.path.dirname(asked.picture) or "."):
        raise UserError(f"there is no folder for the picture (--picture {asked.picture}): make it first")


def main():
    asked = parse_arguments()
    for option, value in (("--replicas", asked.replicas), ("--steps", asked.steps)):
        if value < 1:
            raise UserError(f"{option} is {value}: give 1 at least")
    if asked.picture is not None:
        check_picture(asked)
    proteins = read_proteins(asked.proteins)
    for row in proteins:
        refuse_other_scene(row, asked)
    if asked.only != "table":
        scenes = write_scenes(proteins, asked)
    if asked.only == "scenes":
        print(f"{len(scenes)} scene{'s' if len(scenes) > 1 else ''} in {asked.folder}/scenes")
        return
    if asked.only is None:
        for seed in range(1, asked.replicas + 1):
            for name, scene in scenes.items():
                print(f"{name}, run {seed} of {asked.replicas}", file=sys.stderr, flush=True)
                run(scene, seed, asked)
    if os.path.isdir(asked.folder):
        print_notes(proteins, asked.folder)
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
