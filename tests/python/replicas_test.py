#!/usr/bin/env python3
"""jobs/replicas.py: writes a scene of each protein with its conditions, means the finished runs that are VALID, and refuses wrong tables and
folders of other scenes. With --catena PROGRAM also: two proteins of inputs/saxs-radii.csv are simulated with two seeds each, and runs that are there are kept.

Exit status 0: all as it should be; 1: not."""
import argparse
import csv
import json
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCRIPT = os.path.join(ROOT, "jobs", "replicas.py")
HEAD = "name,ionic,temperature,ph,rg,rg_error,n,doi,sequence\n"


def call(words, **environment):
    return subprocess.run([sys.executable, SCRIPT, *words], env={**os.environ, **environment}, capture_output=True, text=True, check=False)


def write(path, text):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def summary(mean, valid):
    return json.dumps({"valid": valid, "run": {"last_step": 10, "time": 500.0},
                       "observables": {"radius_of_gyration": {"mean": mean, "standard_error": 0.01, "converged": True}}})


def table(folder):
    with open(os.path.join(folder, "radii.csv"), encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def made_up(folder):
    """Of runs that the test wrote."""
    proteins = write(os.path.join(folder, "p.csv"), "# a comment\n" + HEAD + "gly,0.2,280,7,0.5,0.1,6,10.1/x,GGGGSG\n")
    out = os.path.join(folder, "out")
    call([proteins, out, "--only", "scenes", "--steps", "1e1"])
    with open(os.path.join(out, "scenes", "gly.yaml"), encoding="utf-8") as file:
        scene = file.read()
    for words in ("sequence: GGGGSG", "ionic_strength: 0.2, ph: 7", "temperature: 280", "steps: 10"):
        if words not in scene:
            yield f"the scene does not say `{words}`: {scene}"
    for seed, mean, valid in ((1, 1.0, True), (2, 1.2, True), (3, 9.0, False)):
        write(os.path.join(out, f"gly-{seed}", "summary.json"), summary(mean, valid))
    done = call([proteins, out, "--only", "table"])
    found = table(out)[0]
    if (found["simulated_nm"], found["simulated_error_nm"], found["runs"], found["time_ns"]) != ("1.1", "0.1", "2", "1.0"):
        yield f"means of two runs: {found} {done.stderr}"
    alone = json.loads(summary(1.0, True))
    alone["observables"]["radius_of_gyration"]["standard_error"] = None  # of a single frame
    write(os.path.join(out, "gly-1", "summary.json"), json.dumps(alone))
    write(os.path.join(out, "gly-2", "summary.json"), summary(9.0, False))
    done = call([proteins, out, "--only", "table"])
    if "| 1.00 (no error: too few frames) |" not in done.stdout:
        yield f"a run without an error: {done.stdout} {done.stderr}"
    wrong = write(os.path.join(folder, "w.csv"), HEAD + "gly,0.2,280,7,0.5,0.1,7,10.1/x,GGGGSG\n")
    done = call([wrong, out])
    if done.returncode != 2 or "6 residues, not 7" not in done.stderr:
        yield f"a sequence of another length: status {done.returncode}: {done.stderr}"


def refused(folder):
    """Of wrong tables and folders: one line and status 2 each."""
    line = "gly,0.2,280,7,0.5,0.1,6,10.1/x,GGGGSG\n"
    tables = {"rg": (HEAD + line.replace("7,0.5", "7,abc"), "`rg` of gly"), "n": (HEAD + line.replace(",6,", ",6.5,"), "not 6.5"),
              "name": (HEAD + line.replace("gly,", "a/b,"), "names files"), "twice": (HEAD + line + line, "occurs twice"),
              "cold": (HEAD + line.replace("280", "cold"), "`temperature` of gly"), "error": (HEAD + line.replace("0.1,6", "-0.1,6"), "`rg_error` of gly"),
              "column": (HEAD.replace("rg_error,", "") + line, "no column `rg_error`"),
              "angstrom": (HEAD + line.replace("7,0.5", "7,5"), "`rg` of gly is 5 nm, and 6 residues have"),
              "metre": (HEAD + line.replace("7,0.5", "7,5e-10"), "give it in nm")}
    for name, (text, words) in tables.items():
        done = call([write(os.path.join(folder, name + ".csv"), text), os.path.join(folder, "not"), "--only", "scenes"])
        if done.returncode != 2 or words not in done.stderr or done.stderr.count("\n") != 1:
            yield f"{name}: status {done.returncode}: {done.stderr}"
    done = call([write(os.path.join(folder, "water.csv"), HEAD + line.replace("0.2,", "0,")), os.path.join(folder, "water"), "--only", "scenes"])
    if done.returncode != 0:
        yield f"an ionic strength of 0, which the program accepts: {done.stderr}"
    proteins, out = write(os.path.join(folder, "good.csv"), HEAD + line), os.path.join(folder, "kept")
    for words, part in ((["--replicas", "0"], "--replicas is 0"), (["--steps", "-1"], "--steps is -1"), (["--picture", ""], "--picture ''")):
        done = call([proteins, out, *words])
        if done.returncode != 2 or part not in done.stderr or done.stderr.count("\n") != 1:
            yield f"{words}: status {done.returncode}: {done.stderr}"
    call([proteins, out, "--only", "scenes", "--steps", "10"])
    for words in (["--model", "calvados3"], ["--picture", "a.xyz"], ["--picture", "no/a.png"]):
        done = call([proteins, out, "--only", "table", *words])
        if done.returncode != 2 or done.stderr.count("\n") != 1:
            yield f"{words}: status {done.returncode}: {done.stderr}"
    noted = json.loads(summary(1.0, True))
    noted["notes"] = ["water is frozen"]
    write(os.path.join(out, "gly-4", "summary.json"), json.dumps(noted))
    write(os.path.join(out, "gly-7", "summary.json"), summary(3.0, True).replace('"last_step": 10', '"last_step": 9'))
    done = call([proteins, out, "--only", "table"])
    if table(out)[0]["simulated_nm"] != "1.0" or "1 of 2 runs of gly" not in done.stderr:
        yield f"an unfinished run counts: {done.stdout}{done.stderr}"
    if "jobs/replicas.py: note on gly-4: water is frozen\n" not in done.stderr:
        yield f"a note of the program is lost: {done.stderr}"


def simulated(folder, catena):
    """Of runs of the program."""
    with open(os.path.join(ROOT, "inputs", "saxs-radii.csv"), encoding="utf-8") as file:
        lines = [line for line in file if not line.startswith("#")]
    first, proteins, out = None, write(os.path.join(folder, "two.csv"), "".join(lines[:3])), os.path.join(folder, "simulated")
    for turn in range(2):
        done = call([proteins, out, "--replicas", "2", "--steps", "4"], CATENA_PROGRAM=catena)
        written = [os.stat(os.path.join(out, name, "summary.json")).st_mtime_ns for name in ("Hst5-1", "Hst5-2", "Hst52-1", "Hst52-2")]
        if done.returncode != 0 or done.stdout.count("| 2 |") != 2:
            yield f"turn {turn + 1}: status {done.returncode}: {done.stdout}{done.stderr}"
        if turn == 1 and written != first:
            yield "finished runs are run again"
        first = written


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--catena", help="the program; without it no run is made")
asked = parser.parse_args()
with tempfile.TemporaryDirectory() as parent:
    faults = list(made_up(parent)) + list(refused(parent)) + (list(simulated(parent, os.path.abspath(asked.catena))) if asked.catena else [])
print("\n".join(faults) if faults else "passed")
sys.exit(1 if faults else 0)
