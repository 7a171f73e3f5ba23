#!/usr/bin/env python3
"""jobs/beside_openmm.py: compares both methods with the known difference taken out, keeps results that are there, and refuses those of other times.

The program is a stand-in that writes what `catena bench sampling` writes. Exit status 0: all as it should be; 1: not."""
import csv
import json
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCRIPT = os.path.join(ROOT, "jobs", "beside_openmm.py")
TABLE = """name,ionic,temperature,ph,rg,rg_error,n,doi,sequence
gly,0.2,280,7,0.5,0.1,6,10.1/x,GGGGSG
ser,0.2,280,7,0.3,0.1,4,10.1/y,GSSG
"""
PROGRAM = """#!{python}
import json, os, sys
words = sys.argv[1:]
value = dict(zip(words[3::2], words[4::2]))
with open({folder!r} + "/calls", "a") as calls:
    calls.write(os.path.basename(words[2]) + "\\n")
row = {{"step_ps": float(value["--steps"]), "ps_per_copy": float(value["--duration"]), "total_ns": 1.0, "every_ps": 1.0, "valid": True, "state": "VALID", "why": ""}}
radius = lambda mean: {{"radius_of_gyration": {{"mean": mean, "error": 0.01, "plateau": True}}}}
json.dump({{"copies": int(value["--copies"]), "discard_ps": float(value["--discard"]), "valid": True, "notes": ["water is frozen"], "hardware": {{"gpu": "none"}}, "build": {{}}, "results": [
    {{"method": "rigid", **row, **radius({rigid})}}, {{"method": "bonds", **row, **radius({bonds}), **{state}}}]}}, open(value["--json"], "w"))
"""


def call(folder, rigid, *words, bonds="1.5", state=None):
    """The script with a stand-in program whose rigid links give that radius, and whose bonds have that state."""
    program = os.path.join(folder, "program")
    with open(program, "w", encoding="utf-8") as file:
        file.write(PROGRAM.format(python=sys.executable, folder=folder, rigid=rigid, bonds=bonds, state=repr(state or {})))
    os.chmod(program, 0o755)
    return subprocess.run([sys.executable, SCRIPT, os.path.join(folder, "p.csv"), os.path.join(folder, "out"), "--copies", "3", *words],
                          env={**os.environ, "CATENA_PROGRAM": program}, capture_output=True, text=True, check=False)


def check(holds, what):
    if not holds:
        sys.exit(f"FAILED: {what}")


def main():
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "p.csv"), "w", encoding="utf-8") as file:
            file.write(TABLE)
        first = call(folder, 1.482, "--only", "gly")  # 1.2 % below: the known difference
        check(first.returncode == 0 and "VALID" in first.stdout, f"the known difference is no failure: {first.stdout}{first.stderr}")
        check("differences than 2.8 % cannot be told" in first.stdout, f"the verdict says what it can tell: {first.stdout}")
        check("jobs/beside_openmm.py: note on gly: water is frozen\n" in first.stderr, f"the program's notes: {first.stderr}")
        check("3 copies are too few for a verdict: errors between copies are uncertain by 50 %" in first.stderr, f"too few copies: {first.stderr}")
        with open(os.path.join(folder, "out", "beside-openmm.csv"), encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        check([row["name"] for row in rows] == ["gly"], "only the protein asked for")
        check(rows[0]["difference_percent"] == "-1.2" and rows[0]["standard_errors"] == "-1.27", f"difference of {rows[0]}")
        check(float(rows[0]["standard_errors_without_known"]) == 0, f"known difference of {rows[0]}")
        both = call(folder, 1.55, "--json", os.path.join(folder, "table.json"))  # 4.8 standard errors with the known difference
        check(both.returncode == 1 and "INVALID: ser:" in both.stdout, f"a large difference fails: {both.stdout}{both.stderr}")
        with open(os.path.join(folder, "table.json"), encoding="utf-8") as file:
            table = json.load(file)
        check([row["name"] for row in table["results"]] == ["gly", "ser"] and not table["valid"], f"the table as JSON: {table}")
        check(table["copies"] == 3 and table["hardware"] == {"gpu": "none"}, f"conditions of {table}")
        with open(os.path.join(folder, "calls"), encoding="utf-8") as file:
            check(file.read().split() == ["gly.yaml", "ser.yaml"], "results that are there are kept")
        other = call(folder, 1.5, "--duration", "100")
        check(other.returncode == 2 and "other copies, times or steps" in other.stderr, f"results of another time are refused: {other.stderr}")
        os.remove(os.path.join(folder, "out", "gly.json"))
        no_error = call(folder, "None", "--only", "gly")
        check(no_error.returncode == 1 and "INVALID: gly:" in no_error.stdout, f"an unknown radius fails: {no_error.stdout}{no_error.stderr}")
        check("its errors are unknown" in no_error.stdout, f"the verdict says why: {no_error.stdout}")
        check("ser: 4.8 standard errors from OpenMM" in both.stdout, f"the verdict names the protein and why: {both.stdout}")
        os.remove(os.path.join(folder, "out", "gly.json"))
        torn = {"state": "unstable", "why": "links torn at 0.06 ps", "valid": False, "every_ps": None, "ps_per_copy": None}
        unstable = call(folder, 1.5, "--only", "gly", "--json", os.path.join(folder, "torn.json"), bonds="None", state=torn)
        check(unstable.returncode == 1 and "| unstable | - | - | - |" in unstable.stdout and "nan" not in unstable.stdout, f"table: {unstable.stdout}")
        check("INVALID: gly: bonds of OpenMM are unstable (links torn at 0.06 ps)" in unstable.stdout, f"verdict: {unstable.stdout}{unstable.stderr}")
        with open(os.path.join(folder, "torn.json"), encoding="utf-8") as file:
            text = file.read()
        check("NaN" not in text and not json.loads(text)["valid"], f"the JSON has numbers or null: {text}")
        for words, part in ((["--only", ""], "--only '' has an empty name"), (["--copies", "1"], "--copies is 1: give 2"),
                            (["--duration", "0"], "--duration is 0"), (["--discard", "-1"], "--discard is -1"), (["--step", "nan"], "--step is nan"),
                            (["--picture", ""], "--picture ''")):
            refused = call(folder, 1.5, *words)
            check(refused.returncode == 2 and part in refused.stderr and refused.stderr.count("\n") == 1, f"{words}: {refused.stderr}")
        unknown = call(folder, 1.5, "--only", "ala")
        check(unknown.returncode == 2 and "no protein ala" in unknown.stderr, f"an unknown protein is refused: {unknown.stderr}")


if __name__ == "__main__":
    main()
