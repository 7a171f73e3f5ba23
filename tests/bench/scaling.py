"""Time a body and memory of one evaluation from 1e4 to 1e7 bodies, every kind of handle, one thread: `catena solve` on random chains.
Prints a table and writes JSON. Usage: scaling.py [--sizes 1e4,1e6,1e7] [--joints link,planar,...] [--json FILE] [--catena PROGRAM]"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), "..", ".."))
KINDS = "link,planar,spherical,universal,revolute,mixed"

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--sizes", default="1e4,1e5,1e6,1e7")
parser.add_argument("--joints", default=KINDS)
parser.add_argument("--backend", default="segments")
parser.add_argument("--json", help="file to write")
parser.add_argument("--catena", default=os.path.join(ROOT, "build", "release", "catena"))
options = parser.parse_args()


def evaluate(folder, joint, bodies):
    """The program's own JSON and its largest resident memory."""
    scene, out = os.path.join(folder, "scene.yaml"), os.path.join(folder, "out.json")
    base = "free" if joint == "link" else "fixed"
    with open(scene, "w") as file:
        file.write(f"title: random chain, {joint}, {bodies} bodies\nunits: si\n"
                   f"chains: [{{name: random, base: {base}, generator: {{random: {{bodies: {bodies}, joint: {joint}, seed: 1}}}}}}]\n"
                   "forces: {gravity: [0, 0, -9.81]}\n")
    repeat = max(3, min(101, 3000000 // bodies))
    process = subprocess.Popen([options.catena, "solve", scene, "--backend", options.backend, "--repeat", str(repeat), "--json", out, "--quiet"])
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"catena solve on {bodies} bodies on {joint} joints ended with status {os.waitstatus_to_exitcode(status)}")
    with open(out) as file:
        return json.load(file), usage.ru_maxrss * 1024, repeat


def processor():
    with open("/proc/cpuinfo") as file:
        return next((line.split(":")[1].strip() for line in file if line.startswith("model name")), "unknown")


rows = []
print(f"{'joints':<10}{'bodies':>10}{'ns a body':>11}{'ratio':>7}{'GB':>8}{'residual':>11}{'bound':>10}", flush=True)
with tempfile.TemporaryDirectory() as folder:
    for joint in options.joints.split(","):
        first = None
        for bodies in (int(float(size)) for size in options.sizes.split(",")):
            answer, memory, repeat = evaluate(folder, joint, bodies)
            time = 1e9 * answer["seconds"]["median"] / bodies
            first = first or time
            rows.append({"joint": joint, "bodies": bodies, "ns_per_body": time, "repeat": repeat, "peak_memory_bytes": memory,
                         "residual": answer["residual"], "residual_bound": answer["residual_bound"], "valid": answer["valid"]})
            print(f"{joint:<10}{bodies:>10}{time:>11.1f}{time / first:>7.2f}{memory / 1e9:>8.2f}{answer['residual']:>11.1e}"
                  f"{answer['residual_bound']:>10.1e}  {'VALID' if answer['valid'] else 'INVALID'}", flush=True)
result = {"benchmark": "scaling", "backend": options.backend, "hardware": {"processor": processor(), "memory_bytes": os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")},
          "results": rows}
if options.json:
    with open(options.json, "w") as file:
        json.dump(result, file, indent=1)
        file.write("\n")
