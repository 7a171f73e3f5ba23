#!/usr/bin/env python3
"""Measures what each way to walk a tree earns: the time with it, and without it, when the next best way is taken.

usage: walks.py measure SET FOLDER --catena PROGRAM [--seconds S] [--repeat R] [--cpu-time]
       walks.py collect SET FOLDER_OR_TAR FILE     (FILE: a new tests/bench/results/walks-SET-HARDWARE.json)

SET is `host` or `gpu`. `measure` runs the cases of WALKS in turns until S seconds have passed, and writes the JSON of each program run
to FOLDER/WALK@with@CASE@PASS.json or FOLDER/WALK@without@CASE@PASS.json. `collect` keeps the smallest median of each case,
or the smallest time with --cpu-time.

Options of the program switch vectors and backends. It has no switch for the other walks: their cases need a program built for the
measurement, which obeys the environment variable CATENA_WALK_OFF, a list of walks that it does not take. --cpu-time counts the time of
the thread instead of the time that passes, for a machine that other programs use (one thread, no GPU; needs gcc).
"""
import argparse
import io
import json
import os
import subprocess
import sys
import tarfile
import tempfile
import time
from dataclasses import dataclass


@dataclass(frozen=True)
class Case:
    """Chains of the same length on which a walk is measured. `chains`: 1, or several of each length."""
    bench: str  # evaluation, solve, or run (time steps)
    joints: str
    sizes: str
    chains: int = 1


@dataclass(frozen=True)
class Walk:
    """A way to walk a tree. `does`: what it does, and after a semicolon what replaces it. `options` are those of the program with it,
    `others` those without it; `off`: its name in CATENA_WALK_OFF. A walk that was removed from the program has no cases."""
    does: str
    cases: tuple
    options: str
    others: str
    off: str = ""


VECTORS = "--backend segments --threads 1"
GPU = "--backend cuda"


def on_gpu(name, does, *cases):
    return Walk(does, cases, GPU, GPU, name)


def removed(does):
    """A walk that the program had when it was measured. Its figures stay in the results and tables."""
    return Walk(does, (), "", "")


WALKS = {
    "host": {
        "vectors": Walk(
            "runs and merges side by side in vectors (`side_by_side.hpp`); one after the other",
            (Case("evaluation", "link,spherical,revolute", "100,1000,10000"), Case("evaluation", "link,revolute", "100", 200),
             Case("evaluation", "link,spherical,revolute", "100000"), Case("evaluation", "link,spherical,revolute", "1000000")),
            VECTORS, VECTORS + " --simd off"),
        "host-levels": Walk(
            "the DCA chapter's pairwise tree, backend `serial` (`level_solver.hpp`); `segments`",
            (Case("solve", "link,spherical,revolute", "100,1000,10000"), Case("solve", "link,spherical,revolute", "100000")),
            "--backend serial", VECTORS),
        "host-blocks": Walk(
            "a thread takes a whole chain through a step (`host_blocks.hpp`); loops over all chains",
            (Case("run", "link", "10", 2000), Case("run", "link", "100", 200), Case("run", "link", "500", 200),
             Case("run", "link", "5000", 20)),
            VECTORS, VECTORS, "host-blocks"),
    },
    "gpu": {
        "short-lanes": on_gpu(
            "short-lanes", "both passes of a short chain of links in one cluster (`short_lanes.cuh`); stages",
            Case("evaluation", "link", "128,512,2048,4096,8192")),
        "short-teams": on_gpu(
            "short-teams", "the same on other joints (`short_teams.cuh`); stages",
            Case("evaluation", "planar,spherical", "128,512,2048,8192"), Case("evaluation", "universal", "128,512,2048")),
        "together": on_gpu(
            "together", "both passes of the last two stages in one launch (`top_launch.cuh`); a launch for each stage and pass",
            Case("evaluation", "link,spherical,planar", "16384,65536,131072"),
            Case("evaluation", "universal,revolute", "4096,16384,131072"),
            Case("evaluation", "link", "100", 1000), Case("evaluation", "spherical", "500", 200)),
        "runs-in-stage": on_gpu(
            "runs-in-stage", "the runs in the lowest stage (`stage_block.cuh`); a launch of their own",
            Case("evaluation", "link,spherical,planar", "16384,65536,131072"), Case("evaluation", "link", "100", 1000)),
        "group-lanes": on_gpu(
            "group-lanes", "one cluster takes the tree above groups of runs (`group_lanes.cuh`); stages above runs",
            Case("evaluation", "link", "147456,262144,524288,1048576")),
        "groups": removed("a warp merges its 32 runs, stages above; stages above runs"),
        # Its measured figures compare it with narrow-teams. Since those were removed, one thread for a run replaces it.
        "broad-teams": on_gpu(
            "broad-teams", "16 lanes for a run on revolute joints (`revolute_teams.cuh`); 4 lanes (`narrow-teams`)",
            Case("evaluation", "revolute", "512,2048,8192,32768"),
            Case("evaluation", "revolute", "100", 200), Case("evaluation", "revolute", "500", 50)),
        "narrow-teams": removed("4 lanes for a run on revolute joints; one thread"),
        "merge-teams": on_gpu(
            "merge-teams", "8 lanes for a merge of four or five directions (`merge_teams.cuh`); one thread, matrices and biases apart",
            Case("evaluation", "universal", "4096,16384,131072"),
            Case("evaluation", "revolute", "512,2048,16384,131072,1048576"), Case("evaluation", "revolute", "500", 200)),
        "scan-cluster": removed("a scan and the loop after it in one cluster; two launches or more"),
        "register-teams": on_gpu(
            "register-teams", "a team of threads takes a chain of beads through a step in registers (`team_tree.hpp`); stages and loops",
            Case("run", "link", "10", 2000), Case("run", "link", "100", 20), Case("run", "link", "100", 1000),
            Case("run", "link", "500", 200), Case("run", "link", "1000", 100)),
        "cuda-levels": Walk(
            "the DCA chapter's pairwise tree, lowest levels on the GPU, backend `cuda-levels` (`space_levels.hpp`); `cuda`",
            (Case("solve", "link,revolute", "1000,16384,131072,1048576"),), "--backend cuda-levels", GPU),
    },
}
STEPS_OF_RUN = {"host": 100, "gpu": 5000}
RUN = """title: freely-jointed chains
units: md
chains:
  - name: chain
    count: {chains}
    generator: {{freely_jointed: {{beads: {beads}, length: 0.38, mass: 100}}}}
dynamics: {{integrator: g-baoab, step: 0.01, steps: {steps}, temperature: 300, friction: 5, seed: 1}}
output: {{every: {steps}, observables: [energy]}}
"""
CPU_CLOCK = """#define _GNU_SOURCE
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>
int clock_gettime(clockid_t id, struct timespec* t) {
    return (int)syscall(SYS_clock_gettime, id == CLOCK_MONOTONIC ? CLOCK_THREAD_CPUTIME_ID : id, t);
}
"""


class Measurement:
    """Program runs of one `measure`."""

    def __init__(self, options):
        self.options = options
        self.end = time.monotonic() + options.seconds
        self.environment = dict(os.environ)
        if options.cpu_time:
            library = os.path.join(options.folder, "cpu_clock.so")
            subprocess.run(["gcc", "-x", "c", "-O2", "-shared", "-fPIC", "-o", library, "-"], input=CPU_CLOCK.encode(), check=True)
            self.environment["LD_PRELOAD"] = os.path.abspath(library)

    def command(self, case, options, folder):
        program, repeat = os.path.abspath(self.options.catena), str(self.options.repeat)
        if case.bench == "run":
            scene = os.path.join(folder, "scene.yaml")
            with open(scene, "w", encoding="utf-8") as file:
                file.write(RUN.format(chains=case.chains, beads=case.sizes, steps=STEPS_OF_RUN[self.options.set]))
            return [program, "run", scene, "--output", os.path.join(folder, "out"), "--quiet"] + options.split()
        several = [] if case.chains == 1 else ["--set", f"chains[0].count={case.chains}"]
        return [program, "bench", case.bench, "--joints", case.joints, "--sizes", case.sizes, "--repeat", repeat,
                "--json", os.path.join(folder, "out.json"), "--quiet"] + options.split() + several

    def one(self, name, side, number, turn, case, options, off):
        """Runs the program once, unless the time is over."""
        left = self.end - time.monotonic()
        if left <= 0:
            return
        with tempfile.TemporaryDirectory() as folder:
            command = self.command(case, options, folder)
            answer = os.path.join(folder, "out", "summary.json") if case.bench == "run" else os.path.join(folder, "out.json")
            started = time.monotonic()
            try:
                ended = subprocess.run(command, env={**self.environment, "CATENA_WALK_OFF": off}, timeout=min(self.options.limit, left), check=False,
                                       stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
                status, said = ended.returncode, ended.stdout.decode(errors="replace").strip()[-300:]
            except subprocess.TimeoutExpired:
                status, said = "timeout", ""
            print(f"{name} {side} {case.joints} {case.chains} x {case.sizes}: {status}, {time.monotonic() - started:.1f} s {said}", flush=True)
            if not os.path.exists(answer):
                return
            with open(answer, encoding="utf-8") as file:
                found = json.load(file)
            found["measured"] = {"command": ["catena"] + [w for w in command[1:] if folder not in w and w not in ("--json", "--output")],
                                 "off": off, "cpu_time": self.options.cpu_time, "chains": case.chains, "status": status}
            with open(os.path.join(self.options.folder, f"{name}@{side}@{number}@{turn}.json"), "w", encoding="utf-8") as file:
                json.dump(found, file)

    def all(self):
        turn = 0
        while time.monotonic() < self.end and turn < self.options.turns:
            for name in self.options.only.split(",") if self.options.only else WALKS[self.options.set]:
                walk = WALKS[self.options.set][name]
                for number, case in enumerate(walk.cases):
                    self.one(name, "with", number, turn, case, walk.options, "")
                    self.one(name, "without", number, turn, case, walk.others, walk.off)
            turn += 1


def rows_of(answer):
    """(joint, chains, bodies of a chain, microseconds, valid) of one program run: of an evaluation, or of a time step."""
    chains = answer["measured"]["chains"]
    if "speed" in answer:
        group = answer["system"]
        rate = answer["speed"]["steps_per_second_of_second_half"]
        yield "link", chains, group["bodies"] // chains, 1e6 / rate, answer["valid"]
    # Other programs lengthen the median of a thread's own time too.
    which = "min" if answer["measured"]["cpu_time"] else "median"
    for r in answer.get("results", []):
        # `bodies` is a chain's length.
        time_of = r["microseconds"][which] if "microseconds" in r else r["ns_per_body"]["evaluation"][which] * r["bodies"] / 1000
        yield r["joint"], chains, r["bodies"], time_of, r["valid"]


def files_of(place):
    """(name, contents) of the JSON files of a folder or of a tar archive."""
    if os.path.isdir(place):
        for name in sorted(os.listdir(place)):
            if "@" in name:
                with open(os.path.join(place, name), encoding="utf-8") as file:
                    yield name, json.load(file)
        return
    with tarfile.open(place) as archive:
        for member in archive.getmembers():
            if "@" in member.name and member.name.endswith(".json"):
                yield os.path.basename(member.name), json.load(io.TextIOWrapper(archive.extractfile(member), encoding="utf-8"))


JOINTS = ("link", "planar", "spherical", "universal", "revolute")


def order(item):
    walk, joint, chains, bodies = item[0]
    return walk, JOINTS.index(joint), chains > 1, bodies, chains


def collect(walks, place, target):
    best, about, invalid = {}, {}, 0
    for name, answer in files_of(place):
        walk, side, _, _ = name.split("@")
        if walk not in walks:
            continue
        for joint, chains, bodies, microseconds, valid in rows_of(answer):
            if not valid:
                print(f"{name}: {joint}, {bodies} bodies is INVALID and left out", file=sys.stderr)
                invalid += 1
                continue
            row = best.setdefault((walk, joint, chains, bodies), {})
            row[side] = min(row.get(side, microseconds), microseconds)
            row.setdefault("command", {})[side] = " ".join(answer["measured"]["command"])
        about.setdefault("hardware", answer.get("hardware"))
        about["hardware"] = about["hardware"] or answer.get("hardware")
        about["build"] = about.get("build") or answer.get("build")
        about["cpu_time"] = answer["measured"]["cpu_time"]
    rows = [{"walk": walk, "joint": joint, "chains": chains, "bodies": bodies, "microseconds_with": row["with"],
             "microseconds_without": row["without"], "commands": row["command"], "valid": True}
            for (walk, joint, chains, bodies), row in sorted(best.items(), key=order) if "with" in row and "without" in row]
    with open(target, "w", encoding="utf-8") as file:
        json.dump({"bench": "walks", **about, "results": rows}, file, indent=1)
        file.write("\n")
    print(f"{len(rows)} cases of {len({r['walk'] for r in rows})} walks")
    return 1 if invalid else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    actions = parser.add_subparsers(dest="action", required=True)
    measure = actions.add_parser("measure")
    measure.add_argument("set", choices=sorted(WALKS))
    measure.add_argument("folder")
    measure.add_argument("--catena", required=True)
    measure.add_argument("--seconds", type=float, default=600)
    measure.add_argument("--repeat", type=int, default=7)
    measure.add_argument("--turns", type=int, default=3)
    measure.add_argument("--limit", type=float, default=90, help="seconds of one program run")
    measure.add_argument("--only", help="names of walks in the order to measure them, separated by commas")
    measure.add_argument("--cpu-time", action="store_true")
    gather = actions.add_parser("collect")
    gather.add_argument("set", choices=sorted(WALKS))
    gather.add_argument("place")
    gather.add_argument("target")
    options = parser.parse_args()
    if options.action == "collect":
        return collect(WALKS[options.set], options.place, options.target)
    os.makedirs(options.folder, exist_ok=True)
    Measurement(options).all()
    return 0


if __name__ == "__main__":
    sys.exit(main())
