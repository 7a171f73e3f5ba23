#!/usr/bin/env python3
"""Writes the tables of tests/bench/README.md and tests/bench/walks.md from tests/bench/results/*.json, between their markers.

usage: tables.py [--check]      (--check: changes nothing, ends with status 1 where a table is not current)

A table named NAME stands between `<!-- table NAME -->` and `<!-- end -->`. All of its figures must be VALID in their files.
"""
import glob
import json
import os
import re
import sys

from walks import WALKS

HERE = os.path.dirname(os.path.abspath(__file__))
PAGES = ("README.md", "walks.md")
PLATFORM = {"amd-epyc": "AMD EPYC (Zen 5)", "intel-xeon": "Intel Xeon", "nvidia-h200": "NVIDIA H200", "nvidia-h100": "NVIDIA H100"}
SIX_SIZES = (100, 500, 2048, 16384, 131072, 1048576)


def load(name):
    with open(os.path.join(HERE, "results", name + ".json"), encoding="utf-8") as file:
        return json.load(file)


def rows_of(name, **wanted):
    """Results of a file whose keys have these values; all must be VALID."""
    found = [r for r in load(name)["results"] if all(r.get(k) == v for k, v in wanted.items())]
    for r in found:
        if not r.get("valid", False):
            raise SystemExit(f"results/{name}.json: {wanted} is not VALID")
    return found


def row_of(name, **wanted):
    found = rows_of(name, **wanted)
    return found[0] if found else None


def short(value):
    """Three digits, or two below 10 and above 0.1 where the third says nothing."""
    if value >= 99.5:
        return f"{value:.0f}"
    return f"{value:.1f}" if value >= 9.95 else f"{value:.2f}"


def time(microseconds):
    return f"{short(microseconds)} us" if microseconds < 999.5 else f"{short(microseconds / 1000)} ms"


def bodies(n):
    return f"{n:,}"


def ns_per_body(name, joint, n):
    row = row_of(name, joint=joint, bodies=n)
    if row is None:
        return None
    return row["ns_per_body"]["evaluation"]["median"] if "ns_per_body" in row else 1000 * row["microseconds"]["median"] / n


def microseconds(name, joint, n):
    row = row_of(name, joint=joint, bodies=n)
    return None if row is None else row["microseconds"]["median"]


def cell(text):
    return "-" if text is None else text


def with_and_without_vectors(file, joint, n):
    wide, off = ns_per_body(file.format("avx512"), joint, n), ns_per_body(file.format("off"), joint, n)
    return f"{short(wide)} ({short(off)})"


def one_core():
    header = ["joints (directions per handle)"] + [bodies(n) for n in SIX_SIZES] + ["131,072, AVX2"]
    kinds = [("link (1), solver alone", "evaluation", "link"), ("spherical (3), solver alone", "evaluation", "spherical"),
             ("planar (2)", "solve", "planar"), ("spherical (3)", "solve", "spherical"), ("universal (4)", "solve", "universal"),
             ("revolute (5)", "solve", "revolute")]
    rows = [[name] + [with_and_without_vectors(f"{bench}-simd-{{}}-amd-epyc", joint, n) for n in SIX_SIZES]
            + [short(ns_per_body(f"{bench}-simd-avx2-amd-epyc", joint, 131072))] for name, bench, joint in kinds]
    sizes = ",".join(str(n) for n in SIX_SIZES)
    return header, rows, ["evaluation-simd-{off,avx2,avx512}-amd-epyc", "solve-simd-{off,avx2,avx512}-amd-epyc"], [
        f"catena bench evaluation --backend segments --joints link,spherical --sizes {sizes} --threads 1 --repeat 15 --simd avx512",
        f"catena bench solve --backend segments --joints planar,spherical,universal,revolute --loads torques --sizes {sizes} --threads 1 "
        "--repeat 15 --simd avx512"]


def two_threads():
    kinds = [("link, solver alone", "evaluation", "link"), ("spherical, solver alone", "evaluation", "spherical"), ("planar", "solve", "planar"),
             ("spherical", "solve", "spherical"), ("universal", "solve", "universal"), ("revolute", "solve", "revolute")]
    rows = []
    for name, bench, joint in kinds:
        ratios = [ns_per_body(f"{bench}-1-thread-amd-epyc", joint, n) / ns_per_body(f"{bench}-2-threads-amd-epyc", joint, n)
                  for n in SIX_SIZES[-2:]]
        rows.append([name] + [f"{r:.2f}" for r in ratios])
    return ["joints"] + [bodies(n) for n in SIX_SIZES[-2:]], rows, ["evaluation-{1-thread,2-threads}-amd-epyc", "solve-{1-thread,2-threads}-amd-epyc"], [
        "catena bench solve --backend openmp --joints planar,spherical,universal,revolute --loads torques --sizes 131072,1048576 --threads 2"]


def sixteen_cores():
    threads = (1, 2, 4, 8, 16)
    rows = []
    for joint in ("link", "spherical", "revolute"):
        for n in (131072, 1048576):
            ns = [ns_per_body(f"solve-16-cores-{t}-threads-intel-xeon", joint, n) for t in threads]
            rows.append([f"{joint}, {bodies(n)}"] + [short(x) for x in ns] + [f"{ns[0] / ns[-1]:.1f}"])
    return ["joints, bodies"] + [f"{t} threads" if t > 1 else "1 thread" for t in threads] + ["16 over 1"], rows, [
        "solve-16-cores-{1,2,4,8,16}-threads-intel-xeon"], [
        "catena bench solve --backend openmp --joints link,spherical,revolute --loads torques --sizes 131072,1048576 --threads 16 --repeat 11"]


def scaling():
    kinds = ("link", "planar", "spherical", "universal", "revolute", "mixed")
    rows = []
    for joint in kinds:
        found = rows_of("scaling-amd-epyc-1-thread", joint=joint)
        first, last = found[0], found[-1]
        rows.append([joint, short(first["ns_per_body"]), short(last["ns_per_body"]), f"{last['ns_per_body'] / first['ns_per_body']:.2f}",
                     f"{last['peak_memory_bytes'] / 1e9:.1f} GB"])
    return ["joints", "10,000 bodies", "10,000,000 bodies", "ratio", "memory"], rows, ["scaling-amd-epyc-1-thread"], [
        "python3 tests/bench/scaling.py --sizes 1e4,1e5,1e6,1e7"]


PEERS = ("simbody", "pinocchio, world", "pinocchio, local", "mujoco")
PEER_SIZES = (100, 200, 500, 1000, 10000, 100000)


def peer_time(row):
    if row is None:
        return "-"
    return short(row["over_catena"]) + ("" if row["valid"] else " (INVALID)")


def peers():
    """A peer's time over Catena's on the same chain; a dash where it stopped."""
    results = load("peers-amd-epyc")["results"]
    rows = []
    for joint in ("link", "planar", "spherical", "revolute"):
        for peer in PEERS:
            found = {r["bodies"]: r for r in results if r["joint"] == joint and r.get("peer") == peer}
            if found:
                rows.append([f"{joint}: {peer}"] + [peer_time(found.get(n)) for n in PEER_SIZES])
    return ["peer's time over Catena's"] + [bodies(n) for n in PEER_SIZES], rows, ["peers-amd-epyc"], [
        "catena bench peers --joints link,planar,spherical,revolute --sizes 100,200,500,1000,10000,100000 --loads torques --backend segments"]


def peer_errors():
    """The largest forward error of each program's VALID and INVALID answers, over the sizes that it could do."""
    results = load("peers-amd-epyc")["results"]
    joints = ("link", "planar", "spherical", "revolute")
    rows = []
    for name in (None, *PEERS):
        row = [name or "Catena, segments"]
        for joint in joints:
            found = [r for r in results if r["joint"] == joint and r.get("peer") == name and (name or r["backend"] == "segments")
                     and r["forward_error"] is not None]
            worst = max(found, key=lambda r: r["forward_error"], default=None)
            row.append(f"{worst['forward_error']:.0e} ({bodies(worst['bodies'])})" if worst else "-")
        rows.append(row)
    return ["largest error (bodies)", *joints], rows, ["peers-amd-epyc"], [
        "catena bench peers --joints link,planar,spherical,revolute --sizes 100,200,500,1000,10000,100000 --loads torques --backend segments"]


GPU_SIZES = (2048, 16384, 131072, 1048576, 4194304, 16777216)


def one_gpu():
    rows = []
    for name, file in (("", "evaluation-nvidia-h200"), (", alike", "evaluation-alike-nvidia-h200")):
        for joint in ("link", "spherical"):
            largest = row_of(file, joint=joint, bodies=GPU_SIZES[-1])
            rows.append([joint + name] + [time(microseconds(file, joint, n)) for n in GPU_SIZES] + [f"{largest['floor_over_time']:.2f}"])
    return ["joints, solver alone"] + [bodies(n) for n in GPU_SIZES] + ["floor over time"], rows, ["evaluation-nvidia-h200", "evaluation-alike-nvidia-h200"], [
        "catena bench evaluation --backend cuda --joints link,spherical --sizes 2048,16384,131072,1048576,4194304,16777216 --repeat 15"]


def one_gpu_joints():
    sizes = (2048, 16384, 131072, 262144, 1048576, 4194304)
    rows = []
    for name, file in ((", wrenches", "evaluation-joints-nvidia-h200"), (", torques", "evaluation-joints-torques-nvidia-h200")):
        for joint in ("planar", "universal", "revolute"):
            rows.append([joint + name] + [time(microseconds(file, joint, n)) for n in sizes])
    return ["joints, loads"] + [bodies(n) for n in sizes], rows, ["evaluation-joints-nvidia-h200", "evaluation-joints-torques-nvidia-h200"], [
        "catena bench evaluation --backend cuda --joints planar,universal,revolute --sizes 2048,16384,131072,262144,1048576,4194304 --repeat 15"]


def several_gpus(gpus, one, many):
    """One GPU with n bodies beside `gpus` with n each."""
    sizes = (2048, 65536, 524288, 4194304)
    rows = []
    for joint in ("link", "spherical", "planar", "universal", "revolute"):
        row = [joint]
        for n in sizes:
            alone, together = microseconds(one, joint, n), microseconds(many, joint, gpus * n)
            row.append(cell(f"{time(alone)}, {time(together)}" if alone and together else None))
        rows.append(row)
    return ["joints: one GPU, " + ("two" if gpus == 2 else "four")] + [f"{bodies(n)} per GPU" for n in sizes], rows, [one, many], [
        f"mpirun -n {gpus} catena bench evaluation --backend cuda --joints link,planar,spherical,universal,revolute --sizes "
        f"{','.join(str(gpus * n) for n in sizes)} --repeat 15"]


def two_gpus():
    return several_gpus(2, "evaluation-1-gpu-nvidia-h200", "evaluation-2-gpus-nvidia-h200")


def four_gpus():
    return several_gpus(4, "evaluation-1-gpu-beside-4-nvidia-h200", "evaluation-4-gpus-nvidia-h200")


def openmm(file, command):
    rows = []
    for r in rows_of(file):
        step = {k: 1e6 * r[k]["seconds_per_step"]["median"] for k in ("catena", "openmm_harmonic", "openmm_constrained")
                if r[k]["seconds_per_step"]["median"]}
        hidden = r["catena"].get("matrix_sweep_hidden")
        constrained = step.get("openmm_constrained")
        rows.append([bodies(r["beads"]), time(step["catena"]), time(step["openmm_harmonic"]), cell(time(constrained) if constrained else None),
                     f"{r['catena_over_harmonic']:.2f}", cell(f"{constrained / step['catena']:.1f}" if constrained else None),
                     f"{100 * hidden:.0f} %"])
    return ["beads", "Catena", "OpenMM, bonds", "OpenMM, constraints", "Catena over bonds", "constraints over Catena", "matrix sweep hidden"], rows, [file], [command]


def openmm_gpu():
    header, rows, files, commands = openmm("openmm-since-nvidia-h200", "catena bench openmm --backend cuda --sizes 140,9940,99960")
    million = openmm("openmm-nvidia-h200", "")[1][-1]
    return header, rows + [million], files + ["openmm-nvidia-h200"], commands


def openmm_cpu():
    return openmm("openmm-amd-epyc", "catena bench openmm --backend segments --sizes 140,9940,99960 --repeat 11")


def million_beads():
    rows, alone = [], {}
    for r in rows_of("c4-nvidia-h200"):
        pace = r["milliseconds_a_step"]
        alone.setdefault(r["chains"], pace)
        rows.append([str(r["ranks"]), bodies(r["chains"]), r["split"], f"{pace:.2f} ms", f"{alone[r['chains']] / pace:.2f}"])
    return ["GPUs", "chains", "split", "per step", "times one GPU"], rows, ["c4-nvidia-h200"], [
        "mpirun -n 4 catena run inputs/condensate.yaml --set chains[0].count=7143 --set box.periodic=[80.41,80.41,80.41] "
        "--set dynamics.steps=8000 --backend cuda"]


def radii():
    file, rows = "radii-beside-openmm-nvidia-h200", []
    for r in rows_of("radii-beside-openmm-nvidia-h200"):
        ours, theirs, measured = (f"{r[key + '_nm']:.{digits}f} +- {r[key + '_error_nm']:.{digits}f}"
                                  for key, digits in (("simulated", 3), ("openmm", 3), ("measured", 2)))
        rows.append([r["name"], str(r["residues"]), measured, ours, theirs, f"{r['difference_percent']:+.1f} %", f"{r['standard_errors_without_known']:+.1f}"])
    return ["protein", "residues", "measured (nm)", "Catena (nm)", "OpenMM (nm)", "difference", "standard errors beyond the known -1.2 %"], rows, [file], [
        load(file)["command"]]


def slab():
    file = "slab-beside-openmm-nvidia-h200"
    names = {"dense_concentration": ("dense phase (mg/ml)", 1), "slab_thickness": ("thickness (nm)", 2), "radius_of_gyration": ("radius of gyration (nm)", 3)}
    rows = []
    for key, (name, digits) in names.items():
        found = load(file)["quantities"][key]
        rows.append([name] + [f"{found[which][0]:{sign}.{digits}f} +- {found[which][1]:.{digits}f}"
                              for which, sign in (("catena", ""), ("openmm", ""), ("difference", "+"))])
    return ["of the slab", "Catena", "OpenMM", "difference of pairs"], rows, [file], [load(file)["command"]]


def domain_steps():
    file, rows = "domain-steps-nvidia-h200", []
    for r in rows_of("domain-steps-nvidia-h200"):
        bias = {name: f"{value:+.1f} +- {error:.1f} %" for name, (value, error) in r["biases_percent"].items()}
        rows.append([f"{1000 * r['step_ps']:g} fs", f"{r['radius_of_gyration_nm']:.3f} +- {r['radius_of_gyration_error_nm']:.3f}",
                     bias["radius"] if rows else "", bias["temperature"], f"{r['speed']['ns_per_day']:.0f}"])
    return ["time step", "radius of gyration (nm)", "bias to 10 fs", "bias of the temperature", "ns/day of each copy"], rows, [file], [load(file)["command"]]


def plan():
    """Predictions over measurements of what was chosen."""
    files = ("plan-intel-xeon", "plan-large-intel-xeon", "plan-amd-epyc", "plan-nvidia-h200", "plan-large-nvidia-h200")
    rows = []
    for file in files:
        results = rows_of(file, failure=None)
        ratios = [a["ratio"] for r in results for a in r["arrangements"] if a["arrangement"] == r["chosen"]]
        sizes = sorted({r["bodies"] for r in results})
        rows.append([file, str(len(results)), f"{bodies(sizes[0])} to {bodies(sizes[-1])}", f"{min(ratios):.2f} to {max(ratios):.2f}",
                     f"{100 * max(r['slower_by'] for r in results):.1f} %"])
    return ["file", "cases", "bodies", "predicted over measured", "slower than the best choice, at most"], rows, list(files), ["catena bench plan --json plan.json"]


EARNS = 1.1  # times as long without a walk that is worth its code


def longer_steps():
    """Biases of longer steps in a condensate and a slab, and simulated time per day beside OpenMM's harmonic bonds at 10 fs."""
    files, rows = ["sampling-condensate-nvidia-h200", "sampling-slab-nvidia-h200"], []
    for file, system in zip(files, ("condensate", "slab")):
        usual = row_of(file, method="bonds", step_ps=0.01)["ns_per_day"]
        for verdict in load(file)["verdicts"]:
            for bias in verdict["biases"][1:]:
                row = row_of(file, method=verdict["method"], step_ps=bias["step_ps"])
                shown = [f"{bias[name]['percent']:+.2f} +- {bias[name]['error']:.2f}" for name in (
                    "radius_of_gyration", "configurational_temperature", "ashbaugh-hatch energy", "pairs within 0.8 nm")]
                rows.append([system, {"rigid": "Catena, rigid links", "bonds": "OpenMM, harmonic bonds"}[verdict["method"]],
                             f"{1e3 * bias['step_ps']:.0f} fs", *shown, bias["usable"], f"{row['ns_per_day']:,.0f}", f"{row['ns_per_day'] / usual:.1f}"])
    return ["system", "method", "step", "radius of gyration, %", "configurational temperature, %", "energy of contacts, %", "pairs within 0.8 nm, %", "bias below 1 %",
            "ns/day", "times OpenMM at 10 fs"], rows, files, [load(file)["command"] for file in files]


def walks_measured():
    """(walk, file, its rows) of every walk, in the order of walks.py and by length; without those that were not measured."""
    files = sorted(os.path.basename(path)[:-len(".json")] for path in glob.glob(os.path.join(HERE, "results", "walks-*.json")))
    for walks in WALKS.values():
        for name in walks:
            for file in files:
                if found := rows_of(file, walk=name):
                    yield name, file, found


def earned(row):
    return row["microseconds_without"] / row["microseconds_with"]


def length(row):
    return bodies(row["bodies"]) if row["chains"] == 1 else f"{bodies(row['chains'])} x {bodies(row['bodies'])}"


def commands_of_walks(files):
    return [f"python3 tests/bench/walks.py measure {file.split('-')[1]} walks --catena build/release/catena" + (" --cpu-time" if load(file)["cpu_time"] else "")
            for file in files]


def walks():
    """One row for each walk and machine: where it earns least and most."""
    rows, files = [], []
    for name, file, found in walks_measured():
        files += [file] if file not in files else []
        least, most = min(found, key=earned), max(found, key=earned)
        does, instead = next(w[name].does for w in WALKS.values() if name in w).split("; ")
        worth = sum(earned(r) >= EARNS for r in found)
        rows.append([name, does, instead] + [f"{earned(r):.2f} ({r['joint']}, {length(r)})" for r in (least, most)] + [f"{worth} of {len(found)}"])
    return ["walk", "what it does", "otherwise", "least", "most", "1.1 or more"], rows, files, commands_of_walks(files)


def every_walk():
    """One row for each walk, joint and length."""
    rows, files = [], []
    for name, file, found in walks_measured():
        files += [file] if file not in files else []
        for r in found:
            rows.append([name, r["joint"], length(r), time(r["microseconds_with"]), time(r["microseconds_without"]), f"{earned(r):.2f}",
                         next(PLATFORM[p] for p in PLATFORM if p in file)])
    return ["walk", "joints", "bodies", "with it", "without it", "ratio", "on"], rows, files, commands_of_walks(files)


TABLES = {"one core": one_core, "two threads": two_threads, "sixteen cores": sixteen_cores, "scaling": scaling, "peers": peers, "peers' errors": peer_errors,
          "one GPU": one_gpu,
          "one GPU, joints": one_gpu_joints, "two GPUs": two_gpus, "four GPUs": four_gpus, "OpenMM on a GPU": openmm_gpu,
          "OpenMM on two threads": openmm_cpu, "a million beads": million_beads, "radii": radii, "slab": slab, "domain steps": domain_steps, "longer steps": longer_steps, "plan": plan, "walks": walks, "every walk": every_walk}


def markdown(name):
    header, rows, files, commands = TABLES[name]()
    lines = ["| " + " | ".join(header) + " |", "|" + " --- |" * len(header)]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    hardware = "; ".join(sorted({PLATFORM[p] for p in PLATFORM for f in files if p in f}))
    lines += ["", f"{hardware}. Files: {', '.join(f'`{f}.json`' for f in files)}."]
    lines += ["", "Commands:" if len(commands) > 1 else "Command:", ""]
    lines += [f"- `{command}`" for command in commands]
    return "\n".join(lines)


def current(text):
    """The page with every table made anew."""
    return re.sub(r"(<!-- table ([\w ,']+) -->\n).*?(\n<!-- end -->)", lambda m: m[1] + "\n" + markdown(m[2]) + "\n" + m[3], text, flags=re.S)


def main():
    texts = {}
    for page in PAGES:
        with open(os.path.join(HERE, page), encoding="utf-8") as file:
            texts[page] = file.read()
    missing = [name for name in TABLES if not any(f"<!-- table {name} -->" in text for text in texts.values())]
    if missing:
        print(f"{' and '.join(PAGES)} of tests/bench have no table {', '.join(missing)}")
        return 1
    made = {page: current(text) for page, text in texts.items()}
    if "--check" in sys.argv[1:]:
        for page in PAGES:
            if made[page] != texts[page]:
                print(f"tables of tests/bench/{page} are not current: run tests/bench/tables.py")
                return 1
        print(f"{len(TABLES)} tables are current")
        return 0
    for page in PAGES:
        with open(os.path.join(HERE, page), "w", encoding="utf-8") as file:
            file.write(made[page])
    return 0


if __name__ == "__main__":
    sys.exit(main())
