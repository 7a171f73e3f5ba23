#!/usr/bin/env python3
"""jobs/timeline.py: bars where the phases are, a group of lanes a rank, every phase in the legend; one line where there is nothing to draw.

Usage: timeline_test.py [--catena PROGRAM [--mpirun LAUNCHER,OPTION,...]]: with the program also on the timelines of its runs.
Exit status 0: all as it should be; 1: not; 77: skipped, a package is missing."""
import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

try:
    import matplotlib.image
    import numpy as np
except ImportError as error:
    print(f"SKIPPED: the Python package {error.name} is missing (pip install matplotlib)")
    sys.exit(77)

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "jobs", "timeline.py")
LANES = ["catena", "messages", "openmm"]
FORCES = (0xd5, 0x5e, 0x00)  # the colour of the phase `forces`
SCENE = """\
chains:
  - {name: beads, velocities: thermal, generator: {freely_jointed: {beads: 600, length: 0.38}}}
dynamics: {integrator: g-baoab, step: 0.002, steps: 12, friction: 1, seed: 5}
output: {every: 4}
"""


def check(condition, message):
    if not condition:
        raise SystemExit(f"FAILED: {message}")


def draw(*arguments):
    return subprocess.run([sys.executable, SCRIPT, *arguments], capture_output=True, text=True, check=False)


def phases(pace):
    """Of a step with forces on a worker, as a run records them: seconds."""
    times = [("simple forces", "catena", 8e-3, 8.1e-3), ("matrix sweep", "catena", 2e-3, 8e-3), ("hand over positions", "catena", 0, 2e-3),
             ("exchange of positions", "messages", 0, 1e-3), ("wait for forces", "catena", 8.1e-3, 12e-3), ("forces", "openmm", 1e-3, 12e-3),
             ("projections and drift", "catena", 12e-3, 16e-3)]
    return [{"name": name, "lane": lane, "begin": pace * begin, "end": pace * end} for name, lane, begin, end in times]


def timeline(ranks):
    """Steps 0, 1 and 7, the last of which has the median length; later ranks take longer."""
    steps = {0: 2.0, 1: 0.5, 7: 1.0}
    return {"ranks": [{"rank": rank, "steps": [{"step": step, "phases": phases(pace * (1 + 0.5 * rank / ranks))} for step, pace in steps.items()]}
                      for rank in range(ranks)]}


def write(folder, content, name="timeline.json"):
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, name)
    with open(path, "w", encoding="utf-8") as file:
        file.write(content if isinstance(content, str) else json.dumps(content))
    return path


class Svg:
    """What a picture shows: its texts, and the boxes (left, right, top, bottom) of each group that has a name."""

    def __init__(self, path):
        self.root = xml.parse(path).getroot()
        self.texts = ["".join(node.itertext()).strip() for node in self.root.iter() if self.tag(node) == "text"]
        self.groups = {node.get("id", ""): node for node in self.root.iter() if self.tag(node) == "g"}
        self.ranks = [int(name[5:]) for name in self.groups if re.fullmatch(r"rank-\d+", name)]
        self.legend = ["".join(node.itertext()).strip() for node in self.groups["legend_1"].iter() if self.tag(node) == "text"]
        self.colours = [self.fill(node) for node in self.groups["legend_1"].iter() if self.tag(node) == "path"]

    @staticmethod
    def tag(node):
        return node.tag.rsplit("}", 1)[1]

    @staticmethod
    def fill(node):
        return re.search(r"fill: (#\w+)", node.get("style", "")).group(1)

    def bars(self, name):
        """[(colour, box), ...]; a path that is used elsewhere lies where it is used."""
        nodes = list(self.groups[name].iter())
        uses = [node for node in nodes if self.tag(node) == "use"]
        paths = [node for node in nodes if self.tag(node) == "path"]
        if not uses:
            return [(self.fill(node), self.box(node)) for node in paths]
        known = {"#" + node.get("id"): node for node in paths}
        link = "{http://www.w3.org/1999/xlink}href"
        return [(self.fill(use), self.box(known[use.get(link)], float(use.get("x")), float(use.get("y")))) for use in uses]

    @staticmethod
    def box(path, right=0.0, down=0.0):
        points = np.array([[float(word) for word in pair] for pair in re.findall(r"[ML] (\S+) (\S+)", path.get("d"))]) + [right, down]
        return points[:, 0].min(), points[:, 0].max(), points[:, 1].min(), points[:, 1].max()


def drawn(source, output, *options):
    done = draw(source, "--output", output, *options)
    check(done.returncode == 0 and done.stdout == output + "\n" and done.stderr == "", f"{source} {options}: {done.stdout}{done.stderr}")
    return Svg(output) if output.endswith(".svg") else matplotlib.image.imread(output)


def check_bars(svg, recorded):
    """Every phase of {rank: phases} lies where its times say, on the scale that a lane's band gives: 0 to the end of the longest step."""
    last = max(phase["end"] for entries in recorded.values() for phase in entries)
    colours = dict(zip((entry.split(":")[0] for entry in svg.legend), svg.colours))
    for rank, entries in recorded.items():
        bands = svg.bars(f"rank-{rank}")
        lanes = list(dict.fromkeys(phase["lane"] for phase in entries))
        check(len(bands) == len(lanes), f"rank {rank} has {len(bands)} lanes")
        for lane, (name, (_, band)) in enumerate(zip(lanes, bands)):
            bars = sorted(svg.bars(f"rank-{rank}-lane-{lane}"), key=lambda bar: bar[1][:2])
            wanted = sorted((phase for phase in entries if phase["lane"] == name), key=lambda phase: (phase["begin"], phase["end"]))
            check([colour for colour, _ in bars] == [colours[phase["name"]] for phase in wanted], f"bars of rank {rank}, {name}: {bars}")
            for (_, box), phase in zip(bars, wanted):
                begin, end = (last * (edge - band[0]) / (band[1] - band[0]) for edge in box[:2])
                check(abs(begin - phase["begin"]) < 1e-4 * last and abs(end - phase["end"]) < 1e-4 * last, f"{phase} is drawn from {begin} to {end}")
                check(box[2] > band[2] - 0.01 and box[3] < band[3] + 0.01, f"{phase} is not in its lane")


def check_few(scratch):
    folder = os.path.join(scratch, "few")
    recorded = timeline(3)
    write(folder, recorded)
    write(folder, {"title": "chains & $x$ <1>", "solver": {"backend": "segments"}, "parallel": {"ranks": 3, "threads": 2},
                   "forces": {"platform": "CPU", "path": "host"}}, "summary.json")
    svg = drawn(folder, os.path.join(scratch, "few.svg"))
    check(svg.ranks == [0, 1, 2], f"ranks drawn: {svg.ranks}")
    check([text for text in svg.texts if text.startswith("rank ")] == ["rank 0", "rank 1", "rank 2"], f"ranks named: {svg.texts}")
    check([text for text in svg.texts if text in LANES] == 3 * LANES, f"lanes named: {svg.texts}")
    check_bars(svg, {rank: recorded["ranks"][rank]["steps"][2]["phases"] for rank in range(3)})
    names = ["hand over positions", "exchange of positions", "forces", "matrix sweep", "simple forces", "wait for forces", "projections and drift"]
    check(sorted(entry.split(":")[0] for entry in svg.legend) == sorted(names), f"legend: {svg.legend}")
    check(len(set(svg.colours)) == len(names), f"colours: {svg.colours}")
    check("forces: 11 to 14.7 ms" in svg.legend and "simple forces: 0.1 to 0.133 ms" in svg.legend, f"times in the legend: {svg.legend}")
    for text in ("chains & $x$ <1>", "time from the step's beginning, on each rank's own clock [ms]",
                 "Step 7, of median length among the 3 recorded. 3 ranks, backend segments, 2 threads each, OpenMM on CPU, path host"):
        check(text in svg.texts, f"'{text}' is not in {svg.texts}")
    chosen = drawn(os.path.join(folder, "timeline.json"), os.path.join(scratch, "chosen.svg"), "--ranks", "2,0-0", "--step", "1")
    check(chosen.ranks == [0, 2] and any(text.startswith("Step 1. 2 of 3 ranks, backend") for text in chosen.texts), f"chosen: {chosen.texts}")
    check_bars(chosen, {rank: recorded["ranks"][rank]["steps"][1]["phases"] for rank in (0, 2)})
    done = draw(folder)
    check(done.returncode == 0 and os.path.getsize(os.path.join(folder, "timeline.png")) > 10000, f"no picture by default: {done.stderr}")


def rows_of_forces(picture):
    """In how many places, one below the other, a bar of `forces` is wider than a tenth of the picture."""
    bright = np.round(255 * picture[..., :3]).astype(int)
    wide = (bright == FORCES).all(axis=2).mean(axis=1) > 0.1
    return int((wide[1:] & ~wide[:-1]).sum()) + int(wide[0])


def check_many(scratch):
    """Any number of ranks; beyond 128 the caption says which."""
    for ranks, shown, told in ((1, 1, "1 rank"), (16, 16, "16 ranks"), (17, 17, "17 ranks"), (128, 128, "128 ranks"),
                               (1500, 125, "125 of 1,500 ranks, one in 12")):
        folder = os.path.join(scratch, f"ranks-{ranks}")
        write(folder, timeline(ranks))
        picture = drawn(folder, os.path.join(scratch, f"{ranks}.png"))
        check(rows_of_forces(picture) == shown, f"{ranks} ranks: forces in {rows_of_forces(picture)} places")
        check(picture.shape[0] < 4000, f"{ranks} ranks: {picture.shape}")
        svg = drawn(folder, os.path.join(scratch, f"{ranks}.svg"))
        check(svg.ranks == list(range(0, ranks, -(-ranks // shown))), f"{ranks} ranks: {svg.ranks}")
        check(f"Step 7, of median length among the 3 recorded. {told}" in svg.texts, f"{ranks} ranks: {svg.texts[-20:]}")
        check(("Lanes of a rank, from the top: catena, messages, openmm." in svg.texts) == (ranks > 16), f"{ranks} ranks: names of lanes")


def check_odd(scratch):
    """Phases that overlap are parted, names that nobody knows have colours of their own, a rank without the step is said to have none."""
    names = [f"part {k}" for k in range(12)]
    entries = [{"name": name, "lane": "gpu", "begin": 1e-3 * k, "end": 1e-3 * k + 5e-4} for k, name in enumerate(names)]
    long = {"name": "forces", "lane": "gpu", "begin": -1e-3, "end": 2e-2}
    path = write(os.path.join(scratch, "odd"), {"ranks": [{"rank": 0, "steps": [{"step": 3, "phases": entries + [long]}]}, {"rank": 4, "steps": []}]})
    svg = drawn(path, os.path.join(scratch, "odd.svg"))
    check(svg.ranks == [0, 4] and "nothing recorded" in svg.texts, f"a rank without phases: {svg.texts}")
    check(len(svg.legend) == 13 and len(set(svg.colours)) == 13, f"colours of 13 names: {svg.colours}")
    bars = [box for _, box in svg.bars("rank-0-lane-0")]
    crossing = [(a, b) for a in bars for b in bars
                if a is not b and min(a[1], b[1]) - max(a[0], b[0]) > 0.1 and min(a[3], b[3]) - max(a[2], b[2]) > 0.1]
    check(len(bars) == 13 and not crossing, f"bars on top of each other: {crossing}")


def check_refusal(message, *arguments):
    done = draw(*arguments)
    check(done.returncode == 2 and done.stdout == "", f"{arguments}: status {done.returncode}")
    check(done.stderr.startswith("timeline.py: ") and done.stderr.count("\n") == 1, f"not one line: {done.stderr}")
    check(message in done.stderr, f"'{message}' is not in: {done.stderr}")


def check_refusals(scratch):
    empty = os.path.join(scratch, "empty")
    os.makedirs(empty)
    file = os.path.join(empty, "timeline.json")
    check_refusal("no such file (nowhere): name the folder of a run that has ended, or its timeline.json", "nowhere")
    check_refusal(f"no such file ({file})", empty)
    phase = phases(1)[0]
    step = {"step": 0, "phases": [phase]}
    for content, message in (
            ("no JSON", f"not a timeline ({file}): Expecting value"), ('{"ranks": ', f"not a timeline ({file})"),
            ([], f"not a timeline ({file}): no 'ranks' where there should be one"),
            ({"steps": 3}, "no 'ranks'"), ({"ranks": 2}, "no 'ranks'"), ({"ranks": ["rank"]}, "no 'rank'"), ({"ranks": [{"rank": 0}]}, "no 'steps'"),
            ({"ranks": [{"rank": True, "steps": []}]}, "no 'rank'"), ({"ranks": [{"rank": 0, "steps": [{"step": 0}]}]}, "no 'phases'"),
            ({"ranks": 2 * [{"rank": 0, "steps": [step]}]}, "rank 0 twice"),
            ({"ranks": [{"rank": 0, "steps": [{"step": 0, "phases": [{**phase, "lane": None}]}]}]}, "no 'lane'"),
            ({"ranks": [{"rank": 0, "steps": [{"step": 0, "phases": [{**phase, "begin": 1}]}]}]}, "'simple forces' from 1 to"),
            ({"ranks": [{"rank": 0, "steps": [{"step": 0, "phases": [{**phase, "end": float("nan")}]}]}]}, "to nan"),
            ({"ranks": [{"rank": 0, "steps": [{"step": 0, "phases": [{**phase, "end": float("inf")}]}]}]}, "to inf"),
            ({"ranks": [{"rank": 0, "steps": [{"step": 0, "phases": [{**phase, "end": 10 ** 400}]}]}]}, "not a timeline"),
            ({"ranks": []}, f"no ranks ({file})"), ({"ranks": [{"rank": 0, "steps": []}]}, f"no steps ({file})")):
        write(empty, content)
        check_refusal(message, empty)
    with open(file, "wb") as binary:
        binary.write(b"\x89HDF\xff\xfe")
    check_refusal(f"not a timeline ({file})", file)
    write(empty, timeline(3))
    for ranks in ("3", "1-3", "0,999999999", "2-4,0"):
        check_refusal(f"no such ranks (--ranks {ranks}, {file}): there are 0 to 2", empty, "--ranks", ranks)
    for ranks in ("", "a", "2-1", "1-", "1;2", "0x1", "²", "9" * 5000):
        check_refusal(f"not a list of ranks (--ranks {ranks})", empty, f"--ranks={ranks}")
    for step in ("2", "-1", "one", "9" * 5000):
        check_refusal(f"no such step (--step {step}, {file}): recorded are 0, 1, 7", empty, f"--step={step}")
    check_refusal("not a kind of picture that is drawn (step.jpg): end its name in .png or .svg", empty, "--output", "step.jpg")
    check_refusal("the picture cannot be written (", empty, "--output", os.path.join(scratch, "missing", "step.png"))
    write(empty, {"ranks": timeline(1)["ranks"] + [{"rank": 1, "steps": []}]})
    check_refusal(f"nothing recorded of step 7 on these ranks ({file})", empty, "--ranks", "1")
    check(not os.path.exists(os.path.join(empty, "timeline.png")), "a picture was drawn of what was refused")


def check_runs(options, scratch):
    """What the program itself records."""
    scene = write(scratch, SCENE, "scene.yaml")
    environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_mpi_yield_when_idle": "1"}
    launchers = {1: []} | ({2: [word for word in options.mpirun.split(",") if word] + ["-n", "2"]} if options.mpirun else {})
    for ranks, launcher in launchers.items():
        folder = os.path.join(scratch, f"run-{ranks}")
        words = [*launcher, options.catena, "run", scene, "--backend", "segments", "--quiet", "--output", folder]
        done = subprocess.run(words, capture_output=True, text=True, stdin=subprocess.DEVNULL, env=environment, check=False)
        check(done.returncode == 0, f"{' '.join(words)}: {done.stdout}{done.stderr}")
        svg = drawn(folder, os.path.join(scratch, f"run-{ranks}.svg"), "--step", "4")
        with open(os.path.join(folder, "timeline.json"), encoding="utf-8") as file:
            recorded = {rank["rank"]: step["phases"] for rank in json.load(file)["ranks"] for step in rank["steps"] if step["step"] == 4}
        check(svg.ranks == list(range(ranks)) == list(recorded), f"a run on {ranks} ranks: {svg.ranks}")
        names = {entry.split(":")[0] for entry in svg.legend}
        check(names == {"matrix sweep", "simple forces", "projections and drift"}, f"phases of a run: {svg.legend}")
        check(f"Step 4. {ranks} rank{'s' if ranks > 1 else ''}, backend segments, 1 thread each" in svg.texts, f"caption of a run: {svg.texts}")
        check_bars(svg, recorded)
    return len(launchers)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--catena")
    parser.add_argument("--mpirun", default="")
    options = parser.parse_args()
    check("example" in draw("--help").stdout, "--help without an example")
    with tempfile.TemporaryDirectory() as scratch:
        check_few(scratch)
        check_many(scratch)
        check_odd(scratch)
        check_refusals(scratch)
        runs = check_runs(options, scratch) if options.catena else 0
    print(f"pictures of 1 to 1,500 ranks, refusals and {runs} runs are as they should be")


if __name__ == "__main__":
    main()
