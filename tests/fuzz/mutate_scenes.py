"""Damaged scenes from outside the process: takes the scenes of inputs/, tests/data/cases and tests/fuzz/scenes, changes keys, values, blocks
and the files they name, and runs check, solve, plan, run, a restart and a start from a frame on each. Folders of other tools are changed and
imported. A finding is a signal, an undocumented status, a refusal without its one line, control characters, no end, more than 1 GB, or an
imported scene that the program itself refuses. Every case depends on --seed and its number alone: --only NUMBER repeats it.
Usage: mutate_scenes.py [SECONDS] [--catena PROGRAM] [--seed S] [--only NUMBER] [--keep FOLDER]"""
import argparse
import collections
import glob
import os
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time

import damage
import scene_text

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), "..", ".."))
SECONDS = 20  # of processor time a command
GIGABYTE = 10**6  # of kilobytes, which is what the system counts in
LARGE_FILE = 10**6
COMMANDS = {"check": [], "solve": [], "plan": [], "run": ["--steps", "2", "--quiet", "--output", "o"]}
MANY = 10**4  # what a scene asks for from here on may take its time and memory
WRONG_START = b"catena: "
WARNING = b"catena: warning: "
PROGRESS = b"catena: relaxation, "  # of a start, every 5 s


def sources():
    """Scenes as they are, each a path; those of inputs/ and those made for this, which are right, more than once."""
    places = (["inputs"], ["tests", "fuzz", "scenes", "*"], ["tests", "data", "cases", "*"])
    right, made, cases = (sorted(glob.glob(os.path.join(ROOT, *folder, "*.yaml"))) for folder in places)
    return [path for path in 3 * right + 12 * made + cases if os.path.getsize(path) < LARGE_FILE]


PACKAGES = os.path.join(ROOT, "tests", "data", "cases", "calvados-folders")
SCRIPT = os.path.join(ROOT, "tests", "fuzz", "scenes", "script")
CONFIG = """sysname: {name}
temp: 293.15
friction_coeff: 0.02
random_number_seed: null
restart: checkpoint
frestart: restart.chk
runtime: 0
steps: 7000
wfreq: 70
slab_eq: {slab}
steps_eq: 100
box: [50, 50, 50]
"""


def make_folder(draw, folder):
    """A folder of the CALVADOS package, or of a script of OpenMM."""
    name = draw.choice(["idr", "slab", "two-domains", "script"])
    if name == "script":
        shutil.copytree(SCRIPT, folder)
        return
    os.mkdir(folder)
    shutil.copy(os.path.join(PACKAGES, name + ".xml"), folder)
    shutil.copy(os.path.join(PACKAGES, name + ".pdb"), os.path.join(folder, draw.choice(["top.pdb", "checkpoint.pdb"])))
    contents = {"config.yaml": CONFIG.format(name=name, slab="true" if name == "slab" else "false"),
                "components.yaml": f"defaults: {{restraint: false}}\nsystem:\n  {name}: {{restraint: true, nmol: 1}}\n"}
    for file, text in contents.items():
        with open(os.path.join(folder, file), "w", encoding="ascii") as to:
            to.write(text)


def copy_case(path, folder):
    """The scene with the files beside it that it names; where the scene is now."""
    with open(path, "rb") as file:
        text = file.read()
    for name in os.listdir(os.path.dirname(path)):
        beside = os.path.join(os.path.dirname(path), name)
        if os.path.isfile(beside) and name.encode() in text and beside != path and os.path.getsize(beside) < LARGE_FILE:
            shutil.copy(beside, folder)
    shutil.copy(path, os.path.join(folder, "scene.yaml"))
    return os.path.join(folder, "scene.yaml")


def limits():
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS + 2))
    resource.setrlimit(resource.RLIMIT_AS, (3 * 10**9, 3 * 10**9))
    resource.setrlimit(resource.RLIMIT_FSIZE, (10**9, 10**9))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


Ended = collections.namedtuple("Ended", "status out err kilobytes late")


def execute(words, folder):
    """A command to its end, within the limits."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        child = subprocess.Popen(words, cwd=folder, stdin=subprocess.DEVNULL, stdout=out, stderr=err, preexec_fn=limits,
                                 env={**os.environ, "OMP_NUM_THREADS": "1", "OPENMM_CPU_THREADS": "1"})
        end, late, pid = time.monotonic() + 10 * SECONDS, False, 0
        while pid == 0:
            pid, status, used = os.wait4(child.pid, os.WNOHANG)
            if pid == 0:
                time.sleep(0.002)
                if time.monotonic() > end and not late:
                    late = True
                    child.kill()
        child.returncode = os.waitstatus_to_exitcode(status)
        late = late or used.ru_utime + used.ru_stime >= SECONDS
        out.seek(0), err.seek(0)
        return Ended(child.returncode, out.read(10**6), err.read(10**6), used.ru_maxrss, late)


def fault(ended, many):
    """What is wrong with how a command ended; empty where nothing is."""
    said = ended.out + ended.err
    if ended.late:
        return "" if many else f"no end within {SECONDS} s"
    if ended.status not in (0, 1, 2, 3):
        return f"signal {-ended.status}" if ended.status < 0 else f"status {ended.status}"
    try:
        text = said.decode()
    except UnicodeDecodeError:
        return "text that is not UTF-8"
    if re.search("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]", text):
        return "control characters"
    if ended.status == 1 and not said.strip():
        return "status 1 without a word"
    lines = [line for line in ended.err.splitlines() if not line.startswith((WARNING, PROGRESS))]
    if ended.status == 2 and (len(lines) != 1 or not lines[0].startswith(WRONG_START)):
        return f"{len(lines)} lines for a refusal"
    if len(lines) > 1:
        return f"{len(lines)} lines on standard error"
    return f"{ended.kilobytes // 1000} MB" if ended.kilobytes > GIGABYTE and not many else ""


def asks_for_many(scene):
    """Whether a number in the scene excuses long times and much memory."""
    if not os.path.isfile(scene):
        return False
    with open(scene, "rb") as file:
        return any(float(value) >= MANY for value in re.findall(rb"\d+(?:\.\d+)?(?:[eE]\+?\d+)?", file.read()) if len(value) < 30)


def outcome(ended):
    return "late" if ended.late else {0: "good", 1: "failed", 2: "refused", 3: "stopped"}.get(ended.status, "broken")


class Campaign:
    def __init__(self, options):
        self.options = options
        self.counts = collections.Counter()
        self.findings = []
        self.sources = sources()

    def case(self, number):
        """One changed scene, under one or two commands."""
        draw = random.Random(f"{self.options.seed} {number}")
        with tempfile.TemporaryDirectory(prefix="catena-mutated-") as folder:
            if draw.random() < 0.2:
                return self.import_folder(draw, number, folder)
            scene = copy_case(draw.choice(self.sources), folder)
            if draw.random() < 0.15:
                return self.restart(draw, number, folder)
            files = [name for name in os.listdir(folder) if name != "scene.yaml"]
            damaged = files and draw.random() < 0.5
            if damaged:
                damage.file(draw, os.path.join(folder, draw.choice(sorted(files))))
            if not damaged or draw.random() < 0.3:
                scene_text.mutate(draw, scene, self.sources)
            for command in draw.sample(sorted(COMMANDS), 2):
                self.judge(number, folder, command, [command, "scene.yaml", *COMMANDS[command]])

    def restart(self, draw, number, folder):
        """A run, one of whose files is damaged before it goes on."""
        first = execute([self.options.catena, "run", "scene.yaml", "--steps", "2", "--quiet", "--output", "o"], folder)
        made = os.path.join(folder, "o")
        if first.status not in (0, 1) or not os.path.exists(os.path.join(made, "checkpoint.h5")):
            return
        name = draw.choice(["checkpoint.h5", "checkpoint.h5", "trajectory.h5md", "trajectory.h5md", "observables.csv", "summary.json", "timeline.json"])
        if os.path.exists(os.path.join(made, name)):
            damage.file(draw, os.path.join(made, name))
        if name.startswith("trajectory") and draw.random() < 0.5:
            self.judge(number, folder, "start", ["run", "scene.yaml", "--steps", "2", "--quiet", "--output", "p", "--set", "start={from: o}"])
            return
        self.judge(number, folder, "restart", ["run", "scene.yaml", "--steps", "4", "--quiet", "--restart", "o/checkpoint.h5"])

    def import_folder(self, draw, number, folder):
        """A changed folder of another tool. A scene that was written must be one that the program accepts."""
        made = os.path.join(folder, "tool")
        make_folder(draw, made)
        settings = [name for name in ("config.yaml", "components.yaml") if os.path.exists(os.path.join(made, name))]
        if settings and draw.random() < 0.6:
            scene_text.mutate(draw, os.path.join(made, draw.choice(settings)), self.sources)
        if not settings or draw.random() < 0.5:
            damage.file(draw, os.path.join(made, draw.choice(sorted(os.listdir(made)))))
        ended = self.judge(number, folder, "import", ["import", "tool", "--output", "scene.yaml"])
        if ended.status == 0 and not ended.late:
            again = self.judge(number, folder, "check", ["check", "scene.yaml"])
            if again.status == 2:
                self.find(number, folder, "import", "a scene that `check` refuses", again)

    def judge(self, number, folder, command, words):
        ended = execute([self.options.catena, *words], folder)
        self.counts[command, outcome(ended)] += 1
        wrong = fault(ended, asks_for_many(os.path.join(folder, "scene.yaml")))
        if wrong:
            self.find(number, folder, command, wrong, ended)
        return ended

    def find(self, number, folder, command, wrong, ended):
        self.findings.append(f"case {number}, {command}: {wrong}")
        print(f"FINDING  {self.findings[-1]}: {ended.err[:300]!r}", flush=True)
        if self.options.keep:
            shutil.copytree(folder, os.path.join(self.options.keep, f"{number}-{command}"), dirs_exist_ok=True)

    def report(self, cases, seconds):
        for command in sorted({command for command, _ in self.counts}):
            of = {word: count for (name, word), count in sorted(self.counts.items()) if name == command}
            print(f"{command:8} {sum(of.values()):7d}: {', '.join(f'{count} {word}' for word, count in of.items())}")
        print(f"{cases} changed scenes in {seconds:.0f} s, {len(self.findings)} findings")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("seconds", type=float, nargs="?", default=60)
    parser.add_argument("--catena", default=os.path.join(ROOT, "build", "release", "catena"))
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int, default=None)
    parser.add_argument("--keep", default="", help="where the findings' folders are put")
    campaign = Campaign(parser.parse_args())
    resource.setrlimit(resource.RLIMIT_AS, (4 * 10**9, 4 * 10**9))
    start, number = time.monotonic(), 0
    if campaign.options.only is not None:
        campaign.case(campaign.options.only)
    while campaign.options.only is None and time.monotonic() - start < campaign.options.seconds:
        campaign.case(number)
        number += 1
    campaign.report(number, time.monotonic() - start)
    sys.exit(1 if campaign.findings else 0)


main()
