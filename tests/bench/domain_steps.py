#!/usr/bin/env python3
"""Which time step rigid domains allow: copies of a multi-domain protein in a wide box, one run of the same length for each step.

The radius of gyration, the potential energy and the kinetic temperature of each step are compared with those of the smallest one. A step is usable
if the bias of the radius is below 1 % and that of the temperature below 1 %, and shown if that holds with two standard errors more (as in
`catena bench sampling`). Runs whose verdict is INVALID are not usable."""
import argparse
import concurrent.futures
import itertools
import json
import os
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
MOST = 1.0  # per cent


def run(asked, step):
    """A run of that step in ps; returns its row."""
    folder = os.path.join(asked.output, f"{1000 * step:g}-fs")
    steps, every = round(asked.duration / step), max(1, round(asked.every / step))
    settings = [f"chains[0].count={asked.copies}", f"box={{periodic: [{asked.box}, {asked.box}, {asked.box}]}}", f"dynamics.step={step}",
                f"dynamics.friction={asked.friction}", f"output.every={every}", f"output.checkpoint_every={steps}",
                "output.observables=[energy, temperature, constraint_error, radius_of_gyration]"]
    words = [asked.catena, "run", asked.scene, "--output", folder, "--overwrite", "--steps", str(steps), "--quiet"]
    words += [word for setting in settings for word in ("--set", setting)]
    if asked.backend:
        words += ["--backend", asked.backend]
    status = subprocess.run(words, check=False).returncode
    if status not in (0, 1):
        sys.exit(f"the run of {1000 * step:g} fs ended with status {status}")
    subprocess.run([asked.catena, "analyse", folder, "--discard", str(asked.discard / asked.duration), "--cutoff", "0", "--quiet", "--json",
                    os.path.join(folder, "analysis.json")], check=True)
    with open(os.path.join(folder, "analysis.json"), encoding="utf-8") as file:
        radius = next(each for each in json.load(file)["quantities"] if each["name"] == "radius_of_gyration")
    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    seen = summary["observables"]
    errors = [each for each in (radius["error_by_blocking"], radius["error_between_copies"]) if each is not None] or [float("nan")]
    return {"step_ps": step, "steps": steps, "ps_per_copy": asked.duration, "valid": summary["valid"], "verdict": summary["verdict"],
            "radius_of_gyration_nm": radius["value"], "radius_of_gyration_error_nm": max(errors), "plateau": radius["plateau"],
            "temperature_K": seen["temperature"]["mean"],
            "temperature_error_K": float("nan") if seen["temperature"]["standard_error"] is None else seen["temperature"]["standard_error"],
            "potential_energy": seen["potential_energy"]["mean"], "potential_energy_error": seen["potential_energy"]["standard_error"],
            "speed": summary["speed"]}


def biases(row, reference, temperature):
    """Bias of the radius relative to the smallest step's and of the temperature relative to the thermostat's, each with its error, in per cent."""
    first, own = reference["radius_of_gyration_nm"], row["radius_of_gyration_nm"]
    error = (row["radius_of_gyration_error_nm"] ** 2 + reference["radius_of_gyration_error_nm"] ** 2) ** 0.5 if row is not reference else 0.0
    return {"radius": (100 * (own / first - 1), 100 * error / first),
            "temperature": (100 * (row["temperature_K"] / temperature - 1), 100 * row["temperature_error_K"] / temperature)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="?", default=os.path.join(ROOT, "inputs", "multi-domain.yaml"), help="scene of one chain (default: inputs/multi-domain.yaml)")
    parser.add_argument("--catena", default=os.path.join(ROOT, "build", "release", "catena"), help="the program (default: build/release/catena)")
    parser.add_argument("--steps", default="0.01,0.02,0.03,0.04,0.06", help="time steps, ps (default: 0.01,0.02,0.03,0.04,0.06)")
    parser.add_argument("--copies", type=int, default=64, help="copies (default: 64)")
    parser.add_argument("--box", type=float, default=200, help="edge of the box, nm (default: 200)")
    parser.add_argument("--duration", type=float, default=2000, help="length of each run, ps (default: 2000)")
    parser.add_argument("--discard", type=float, default=500, help="time left out at the start, ps (default: 500)")
    parser.add_argument("--every", type=float, default=2, help="time between frames, ps (default: 2)")
    parser.add_argument("--temperature", type=float, default=300, help="of the scene, K (default: 300)")
    parser.add_argument("--friction", type=float, default=0.01, help="1/ps (default: 0.01)")
    parser.add_argument("--backend", default="", help="of Catena (default: auto)")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="runs at a time; speeds are then those of runs beside each other (default: 1)")
    parser.add_argument("--output", default="domain-steps", help="folder of the runs")
    parser.add_argument("--json", help="file for the rows")
    asked = parser.parse_args()
    with concurrent.futures.ProcessPoolExecutor(max_workers=asked.jobs) as pool:
        rows = list(pool.map(run, itertools.repeat(asked), sorted(float(word) for word in asked.steps.split(","))))
    print("| step | radius of gyration (nm) | bias | temperature (K) | bias | ns/day of a copy | verdict | usable |\n| --- | --- | --- | --- | --- | --- | --- | --- |")
    for row in rows:
        found = row["biases_percent"] = biases(row, rows[0], asked.temperature)
        row["usable"] = row["valid"] and all(abs(value) < MOST and error < MOST for value, error in found.values())
        row["shown"] = row["usable"] and all(abs(value) + 2 * error < MOST for value, error in found.values())
        print(f"| {1000 * row['step_ps']:g} fs | {row['radius_of_gyration_nm']:.3f} +- {row['radius_of_gyration_error_nm']:.3f} | "
              f"{found['radius'][0]:+.2f} +- {found['radius'][1]:.2f} % | {row['temperature_K']:.1f} +- {row['temperature_error_K']:.1f} | "
              f"{found['temperature'][0]:+.2f} % | {row['speed'].get('ns_per_day', 0):.0f} | {'VALID' if row['valid'] else 'INVALID'} | "
              f"{'shown' if row['shown'] else 'yes' if row['usable'] else 'no'} |")
    if asked.json:
        with open(asked.json, "w", encoding="utf-8") as file:
            json.dump({"bench": "steps of rigid domains", "scene": os.path.relpath(asked.scene, ROOT), "command": " ".join(["python3", "tests/bench/domain_steps.py", *sys.argv[1:]]), "runs_at_a_time": asked.jobs, "copies": asked.copies, "box_nm": asked.box,
                       "friction": asked.friction, "discard_ps": asked.discard, "results": rows, "valid": any(row["usable"] for row in rows)}, file, indent=1)


if __name__ == "__main__":
    main()
