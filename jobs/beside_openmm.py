#!/usr/bin/env python3
"""Compares radii of gyration of many proteins on Catena's rigid links with plain OpenMM's harmonic bonds, and with measured radii.

Reads the table of proteins that jobs/replicas.py reads. Samples copies of each protein side by side in one system, first by Catena, then by
OpenMM's own integrator with harmonic bonds (`catena bench sampling`). Writes FOLDER/NAME.json for each protein, prints the table, and writes it
to FOLDER/beside-openmm.csv. Proteins whose file is there are not sampled again."""
import argparse
import csv
import json
import math
import os
import subprocess
import sys

import replicas
from replicas import ROOT, UserError

MODEL = "calvados2"
LONGEST_STEP = 0.06  # ps
MOST_APART = 3  # standard errors
FEW_COPIES = 10  # below which the errors themselves are uncertain by a quarter and more
TELLING = 0.05  # of the radius: differences from here on should be told by a comparison
KNOWN = -0.012  # of the radius: what rigid links in place of stiff bonds change, by `catena bench sampling` of alpha-synuclein


def parse_arguments():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="The program is build/release/catena, or what CATENA_PROGRAM names. A GPU is used where there is one.\n\nexample:\n"
               "  python3 jobs/beside_openmm.py inputs/saxs-radii.csv beside --copies 71 --duration 2000 --picture beside.svg")
    parser.add_argument("proteins", metavar="PROTEINS.csv", help="table of proteins")
    parser.add_argument("folder", metavar="FOLDER", help="where scenes, results and the table go")
    parser.add_argument("--copies", type=replicas.whole, default=71, metavar="N", help="copies of each protein (default: 71)")
    parser.add_argument("--duration", type=float, default=2000, metavar="PS", help="sampled time of each copy, ps (default: 2000)")
    parser.add_argument("--discard", type=float, default=500, metavar="PS",
                        help="time before sampling, ps (default: 500); another two times that on rigid links before both")
    parser.add_argument("--step", type=float, default=0.01, metavar="PS", help="time step of both, ps (default: 0.01)")
    parser.add_argument("--only", metavar="NAME,...", help="only these proteins of the table")
    parser.add_argument("--picture", metavar="FILE", help="also draw the table (PNG or SVG; needs matplotlib)")
    parser.add_argument("--json", metavar="FILE", help="also write the table, the conditions and the hardware as JSON")
    return parser.parse_args()


def result_path(name, folder):
    return os.path.join(folder, name + ".json")


def sample(name, asked):
    """Samples a protein unless its file is there, and is of the same conditions. Returns what the program wrote."""
    path = result_path(name, asked.folder)
    conditions = {"copies": asked.copies, "discard_ps": asked.discard}
    if not os.path.exists(path):
        program = os.environ.get("CATENA_PROGRAM", os.path.join(ROOT, "build", "release", "catena"))
        words = [program, "bench", "sampling", replicas.scene_path(name, asked.folder), "--methods", "rigid,bonds", "--copies", str(asked.copies),
                 "--steps", repr(asked.step), "--duration", repr(asked.duration), "--discard", repr(asked.discard),
                 "--equilibrate", repr(2 * asked.discard), "--json", path + ".part"]
        print(name, file=sys.stderr, flush=True)
        try:
            status = subprocess.run(words, check=False, stdout=subprocess.DEVNULL).returncode
        except OSError as error:
            raise UserError(f"cannot start the program ({program}): {error.strerror}; build it, or name it by CATENA_PROGRAM") from None
        if status not in (0, 1):  # 1: a row is INVALID, which the table says
            raise UserError(f"sampling of {name} ended with status {status} ({path}.part): see the line above")
        if not os.path.exists(path + ".part"):
            raise UserError(f"the program wrote no result ({program}): name catena by CATENA_PROGRAM")
        os.replace(path + ".part", path)
    try:
        with open(path, encoding="utf-8") as file:
            found = json.load(file)
    except (OSError, ValueError):
        raise UserError(f"a result cannot be read ({path}): delete it") from None
    if not found.get("results"):
        raise UserError(f"a result has no rows ({path}): delete it")
    other = [key for key, value in conditions.items() if found.get(key) != value]
    steps = {row["step_ps"] for row in found["results"]}
    # Whole blocks of steps are sampled, so that times differ from what was asked for by one block at most.
    wrong_time = any(row["valid"] and abs(row["ps_per_copy"] - asked.duration) > row["every_ps"] for row in found["results"])
    if other or steps != {asked.step} or wrong_time:
        raise UserError(f"a result is of other copies, times or steps ({path}): name another FOLDER, or delete it")
    return found


def number_of(value):
    """A number of a result. What could not be estimated is null there."""
    return float("nan") if value is None else value


def line_of(row, found):
    """A line of the table. The difference is in standard errors, as it is and with the known difference of rigid links taken out."""
    catena, openmm = (next(each for each in found["results"] if each["method"] == method) for method in ("rigid", "bonds"))
    (a, a_error), (b, b_error) = ((number_of(each["radius_of_gyration"]["mean"]), number_of(each["radius_of_gyration"]["error"]))
                                  for each in (catena, openmm))
    error = (a_error**2 + b_error**2) ** 0.5
    states = {name: (each.get("state", "VALID" if each["valid"] else "INVALID"), each.get("why") or "") for name, each in
              (("catena", catena), ("openmm", openmm))}
    return {"name": row["name"], "residues": int(row["n"]), "measured_nm": row["rg"], "measured_error_nm": row["rg_error"],
            "simulated_nm": round(a, 4), "simulated_error_nm": round(a_error, 4), "openmm_nm": round(b, 4), "openmm_error_nm": round(b_error, 4),
            "difference_percent": round(100 * (a - b) / b, 2), "standard_errors": round((a - b) / error, 2),
            "standard_errors_without_known": round((a - b - KNOWN * b) / error, 2), "valid": found["valid"],
            "plateau": catena["radius_of_gyration"]["plateau"] and openmm["radius_of_gyration"]["plateau"],
            "ns_in_all": round(catena["total_ns"], 1), "doi": row["doi"], "catena_state": states["catena"][0],
            "openmm_state": states["openmm"][0], "why": "; ".join(why for _, why in states.values() if why)}


def cell(each, method, state):
    """A radius with its error, or what became of the method that has none."""
    value = each[method + "_nm"]
    return f"{value:.3f} +- {each[method + '_error_nm']:.3f}" if math.isfinite(value) else each[state]


def reason(each):
    """Why the methods do not agree on a protein; empty if they do."""
    for label, state in (("rigid links", "catena_state"), ("bonds of OpenMM", "openmm_state")):
        if each[state] != "VALID":
            return f"{label} are {each[state]}" + (f" ({each['why']})" if each["why"] else "")
    if not each["valid"]:
        return "the result is INVALID" + (f" ({each['why']})" if each["why"] else "")
    apart = each["standard_errors_without_known"]
    if not math.isfinite(apart):
        return "its errors are unknown: sample longer"
    return f"{abs(apart):.1f} standard errors from OpenMM with the known difference, more than {MOST_APART}" if abs(apart) > MOST_APART else ""


def print_table(lines):
    print("| protein | residues | measured (nm) | Catena (nm) | OpenMM (nm) | difference | standard errors | with the known -1.2 % | ns |\n"
          "| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    for each in lines:
        compared = [f"{each['difference_percent']:.1f} %", f"{each['standard_errors']:.1f}", f"{each['standard_errors_without_known']:.1f}"]
        compared = [text if math.isfinite(each["difference_percent"]) else "-" for text in compared]
        print(f"| {each['name']} | {each['residues']} | {each['measured_nm']:.2f} +- {each['measured_error_nm']:.2f} | "
              f"{cell(each, 'simulated', 'catena_state')} | {cell(each, 'openmm', 'openmm_state')} | {' | '.join(compared)} | "
              f"{each['ns_in_all']:g} |")


def draw(lines, path):
    pyplot = replicas.plotting()
    figure, axes = pyplot.subplots(figsize=(7, 4), layout="constrained")
    places = range(len(lines))
    for shift, key, label, colour in ((-0.2, "measured", "measured", "#5b6773"), (0, "openmm", "OpenMM, harmonic bonds", "#d9822b"),
                                      (0.2, "simulated", "Catena, rigid links", "#0b6bcb")):
        axes.errorbar([k + shift for k in places], [each[key + "_nm"] for each in lines], [each[key + "_error_nm"] for each in lines], fmt="o",
                      markersize=4, color=colour, label=label)
    axes.set_xticks(list(places), [each["name"] for each in lines], rotation=30, ha="right")
    axes.set_ylabel("radius of gyration (nm)")
    axes.legend(frameon=False)
    figure.savefig(path, dpi=110, metadata={"Date": None} if path.endswith(".svg") else None)


def write_json(lines, found, asked):
    """The table with its conditions. `found` has what the program wrote for each protein."""
    asked_for = {"copies": asked.copies, "duration_ps": asked.duration, "discard_ps": asked.discard, "step_ps": asked.step}
    last = found[-1]
    table = {"bench": "radii beside OpenMM", "command": " ".join(["python3", "jobs/beside_openmm.py", *sys.argv[1:]]), **asked_for,
             "known_difference": KNOWN, "hardware": last["hardware"], "build": last["build"], "valid": not any(reason(line) for line in lines),
             "results": [{key: None if value != value else value for key, value in line.items()} for line in lines]}
    with open(asked.json, "w", encoding="utf-8") as file:
        json.dump(table, file, indent=1)
        file.write("\n")


def told(each):
    """Smallest difference of the methods that the errors of a protein can tell, relative to OpenMM's radius; NaN without errors."""
    error = math.hypot(each["simulated_error_nm"], each["openmm_error_nm"])
    return MOST_APART * error / each["openmm_nm"] if each["openmm_nm"] > 0 else math.nan


def say_notes(lines, found, copies):
    """Says the program's notes, each once with the proteins that have it, and where there are too few copies for a verdict."""
    proteins = {}
    for line, each in zip(lines, found):
        for note in each.get("notes", []):
            proteins.setdefault(note, []).append(line["name"])
    notes = [f"note on {names[0]}{f' and {len(names) - 1} more' if len(names) > 1 else ''}: {note}" for note, names in proteins.items()]
    if copies < FEW_COPIES:
        notes.append(f"{copies} copies are too few for a verdict: errors between copies are uncertain by {50 * (2 / (copies - 1)) ** 0.5:.0f} %; "
                     f"take {FEW_COPIES} at least (--copies)")
    for line in lines:
        if math.isfinite(told(line)) and told(line) > TELLING:
            notes.append(f"{line['name']}: the errors tell differences from {100 * told(line):.0f} % on: take more copies or a longer --duration")
    for note in notes:
        print(f"jobs/beside_openmm.py: {note}", file=sys.stderr)


def chosen(proteins, only):
    """The proteins of the table that --only names."""
    if only is None:
        return proteins
    names = [name.strip() for name in only.split(",")]
    if not all(names):
        raise UserError(f"--only {only!r} has an empty name: write NAME,NAME without more, or leave the option out")
    unknown = [name for name in names if name not in {row["name"] for row in proteins}]
    if unknown:
        raise UserError(f"the table has no protein {unknown[0]} (--only): it has {', '.join(row['name'] for row in proteins)}")
    return [row for row in proteins if row["name"] in names]


def main():
    asked = parse_arguments()
    for option, value, holds, form in (("--copies", asked.copies, asked.copies >= 2, "2 at least"),
                                       ("--duration", asked.duration, asked.duration > 0, "a time above 0 (ps)"),
                                       ("--discard", asked.discard, asked.discard >= 0, "a time of 0 or more (ps)"),
                                       ("--step", asked.step, asked.step > 0, "a time above 0 (ps)")):
        if not (holds and math.isfinite(value)):
            raise UserError(f"{option} is {value:g}: give {form}")
    if asked.step > LONGEST_STEP:
        raise UserError(f"--step {asked.step:g} ps is too long for either method: give 0.01 to 0.06 (ps)")
    if asked.picture is not None:
        replicas.check_picture(asked)
    if asked.json is not None and not os.path.isdir(os.path.dirname(asked.json) or "."):
        raise UserError(f"there is no folder for the table (--json {asked.json}): make it first")
    proteins = chosen(replicas.read_proteins(asked.proteins), asked.only)
    asked.model, asked.steps = MODEL, 1
    for row in proteins:
        replicas.refuse_other_scene(row, asked)
    replicas.write_scenes(proteins, asked)
    found = [sample(row["name"], asked) for row in proteins]
    lines = [line_of(row, each) for row, each in zip(proteins, found)]
    with open(os.path.join(asked.folder, "beside-openmm.csv"), "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(lines[0]))
        writer.writeheader()
        writer.writerows(lines)
    print_table(lines)
    say_notes(lines, found, asked.copies)
    if asked.picture:
        draw([each for each in lines if math.isfinite(each["simulated_nm"] + each["openmm_nm"])], asked.picture)
    if asked.json:
        write_json(lines, found, asked)
    wrong = [f"{each['name']}: {reason(each)}" for each in lines if reason(each)]
    if wrong:
        print("INVALID: " + "; ".join(wrong))
        sys.exit(1)
    least = max(told(each) for each in lines)
    print(f"VALID: all within {MOST_APART} standard errors of OpenMM with the known difference; smaller differences than {100 * least:.1f} % cannot be told")


if __name__ == "__main__":
    try:
        main()
    except UserError as error:
        print(f"jobs/beside_openmm.py: {error}", file=sys.stderr)
        sys.exit(2)
