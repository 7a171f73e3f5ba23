#!/usr/bin/env python3
"""Runs the commands of the repository's pages, and checks their scenes.

usage: commands.py --catena PROGRAM [--mpirun WORD,WORD,...] [PAGE ...]

Of every command in code, also within a line, the options must be in the help of its program. Commands of fenced blocks are run too, those
of a block one after the other in a folder of its own: `check`, `plan`, `solve` and `run`, whose steps are made few, jobs/replicas.py with one
short run of each protein, and jobs/plot.py where its packages are there. What needs a GPU, a cluster, a network or minutes (bench, report,
calibration) is only looked at. Fenced YAML that has `chains` is read by `catena check`, and is the `my.yaml` of the blocks that follow it.

The blocks of a tutorial (inputs/tutorials) share one folder, and its Python programs are run there. A `text` block that begins with a prompt
(`$ command`) quotes the command's answer: each quoted line must be in it, `...` stands for anything.
"""
import argparse
import importlib.util
import os
import re
import shlex
import subprocess
import sys
import tempfile

import markdown

PROGRAM = re.compile(r"^(.*/)?catena$")
SUBCOMMANDS = ("check", "plan", "solve", "run", "report", "bench", "keys", "analyse", "convert", "import")
RUN = ("check", "plan", "solve", "run", "keys")
TUTORIALS = "tutorials"  # name of their folder
PLOT, REPLICAS = "jobs/plot.py", "jobs/replicas.py"
PLACEHOLDERS = {"SCENE", "scene.yaml", "DIR", "FILE", "OTHER"}
FEW_STEPS = 4
AS_ROOT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


class Help:
    """The options of programs and scripts, as their --help names them."""

    def __init__(self, catena):
        self.catena, self.known = catena, {}

    def options(self, command):
        key = tuple(command)
        if key not in self.known:
            answer = subprocess.run([*command, "--help"], capture_output=True, text=True, timeout=60, check=False)
            self.known[key] = set(re.findall(r"--?[a-z][\w-]*", answer.stdout)) if answer.returncode == 0 else None
        return self.known[key]


def commands_of(block):
    """Lines of a block as words; continued lines are joined, comments and prompts left out."""
    text = "\n".join(block).replace("\\\n", " ")
    for line in text.split("\n"):
        words = shlex.split(line.removeprefix("$ "), comments=True)
        if words:
            yield words


def catena_words(words):
    """What follows the program, whoever starts it; None of other commands."""
    for i, word in enumerate(words):
        if PROGRAM.match(word) and (i == 0 or words[0] in ("mpirun", "srun", "ncu")):
            return words[i + 1:]
    return None


def unknown_options(words, options):
    used = [w.split("=")[0] for w in words if re.match(r"--?[a-z]", w)]
    return [w for w in used if w not in options]


def faults_of_catena(words, help_of):
    command = [help_of.catena]
    if words and words[0] in SUBCOMMANDS:
        command.append(words[0])
    elif words and not words[0].startswith("-") and words[0].islower():
        yield f"catena has no command {words[0]}"
        return
    for option in unknown_options(words, help_of.options(command)):
        yield f"catena {words[0]} does not take {option}"
    for word in words:
        if word.startswith("inputs/") and not os.path.exists(os.path.join(markdown.ROOT, word)):
            yield f"{word} is not there"


def faults_of_script(words, help_of):
    """Scripts of the repository, started directly, by Python, bash or sbatch."""
    script = next((w for w in words if re.match(r"^(jobs|tests)/[\w./-]+\.(py|sh)$", w)), None)
    if script is None:
        return
    path = os.path.join(markdown.ROOT, script)
    if not os.path.exists(path):
        yield f"{script} is not there"
        return
    if script.endswith(".sh"):
        if subprocess.run(["bash", "-n", path], check=False).returncode != 0:
            yield f"{script} is no shell script"
        if words[0] == "sbatch" or "--help" not in markdown.read(script):
            return
        options = help_of.options(["bash", path])
    else:
        options = help_of.options([sys.executable, path])
    if options is None:
        return  # a script whose packages are not here
    for option in unknown_options(words[words.index(script) + 1:], options):
        yield f"{script} does not take {option}"


def faults_of(words, help_of):
    after = catena_words(words)
    if after is not None:
        yield from faults_of_catena(after, help_of)
    else:
        yield from faults_of_script(words, help_of)


def can_plot():
    return all(importlib.util.find_spec(name) for name in ("h5py", "matplotlib", "numpy"))


def quoted(line):
    """The pattern of a line that a page quotes from a program's answer."""
    return ".*".join(re.escape(part) for part in line.split("..."))


class Blocks:
    """Runs what can be run of a block."""

    def __init__(self, catena, mpirun):
        self.catena, self.mpirun, self.plots = catena, mpirun, can_plot()
        self.run_commands = self.checked_scenes = 0
        self.scene = ""
        self.shared = None  # folder of all blocks of a tutorial

    def begin(self, path, parent):
        """Begins a page."""
        self.scene, self.shared = "", None
        if os.path.basename(os.path.dirname(path)) == TUTORIALS:
            self.shared = self.folder(parent)

    def work(self, parent):
        """The folder of a block, with the page's last scene in it."""
        work = self.shared or self.folder(parent)
        with open(os.path.join(work, "my.yaml"), "w", encoding="utf-8") as file:
            file.write(self.scene)
        return work

    def folder(self, parent):
        work = tempfile.mkdtemp(dir=parent)
        for name in ("inputs", "jobs", "tests"):
            os.symlink(os.path.join(markdown.ROOT, name), os.path.join(work, name))
        with open(os.path.join(work, "asyn.fasta"), "w", encoding="utf-8") as file:
            file.write(">asyn\nMDVFMKGLSKAKEGVVAAAE\n")
        return work

    def can_run(self, words):
        after = catena_words(words)
        if not after or after[0] not in RUN or PLACEHOLDERS & set(after):
            return False
        return (words[0] == "mpirun" or PROGRAM.match(words[0])) and not any(re.search(r"cuda|hdf5|--calibrate|--network", w) for w in after)

    def shortened(self, after, runs):
        """Runs of few steps; one that goes on makes as many more."""
        words = list(after)
        if words[0] != "run":
            return words
        if "--steps" in words:
            del words[words.index("--steps"):words.index("--steps") + 2]
        return [*words, "--steps", str(FEW_STEPS * (runs + 1))]

    def command(self, words, runs):
        """The command line that stands for a page's; None for what is only looked at."""
        if self.plots and PLOT in words:
            return [sys.executable, *words[words.index(PLOT):]]
        if REPLICAS in words and (self.plots or "--picture" not in words):
            return [sys.executable, *words[words.index(REPLICAS):], "--replicas", "1", "--steps", str(FEW_STEPS)]
        if not self.can_run(words):
            return None
        command = [self.catena, *self.shortened(catena_words(words), runs)]
        return [*self.mpirun, "-n", "2", *command] if words[0] == "mpirun" and self.mpirun else command

    def answer(self, command, work):
        self.run_commands += 1
        environment = {**os.environ, **AS_ROOT, "CATENA_PROGRAM": self.catena}
        return subprocess.run(command, cwd=work, env=environment, capture_output=True, text=True, timeout=250, check=False)

    def run(self, block, parent):
        work, runs = self.work(parent), 0
        for words in commands_of(block):
            command = self.command(words, runs)
            if command is None:
                continue
            runs += "run" in command
            answer = self.answer(command, work)
            if answer.returncode != 0:
                yield f"{' '.join(words)} ended with status {answer.returncode}: {answer.stderr.strip() or answer.stdout.strip()[-300:]}"

    def quote(self, block, parent):
        """Runs a command whose answer the block quotes."""
        words = next(commands_of(block[:1]))
        command = self.command(words, 0)
        if command is None:
            return
        answer = self.answer(command, self.work(parent))
        for line in filter(None, block[1:]):
            if not re.search(quoted(line), answer.stdout + answer.stderr):
                yield f"{' '.join(words)} does not print `{line}`: {answer.stdout[-600:]}{answer.stderr}"

    def program(self, block):
        """Runs a tutorial's Python program."""
        if not self.shared or not self.plots:
            return
        answer = self.answer([sys.executable, "-W", "ignore", "-c", "\n".join(block)], self.shared)
        if answer.returncode != 0:
            yield f"its program `{block[0]} ...` fails: {answer.stderr.strip()[-300:]}"

    def check_scene(self, block, parent):
        self.scene = "\n".join(block) + "\n"
        work = self.work(parent)
        self.checked_scenes += 1
        few = ["--set=chains[0].count=2"] if re.search(r"count: *[1-9]\d\d", self.scene) else []
        answer = subprocess.run([self.catena, "check", "my.yaml", *few], cwd=work, capture_output=True, text=True, timeout=120, check=False)
        if answer.returncode != 0:
            yield f"its scene is refused: {answer.stderr.strip()}"


def faults_of_page(path, help_of, blocks, parent):
    prose, fenced = markdown.split(markdown.read(path))
    blocks.begin(path, parent)
    for code in markdown.inline_code(prose):
        try:
            words = shlex.split(code)
        except ValueError:
            continue
        if len(words) > 1:
            yield from faults_of([w for w in words if w != "..."], help_of)
    for language, block in fenced:
        if language == "yaml" and any(line.startswith("chains:") for line in block):
            yield from blocks.check_scene(block, parent)
        if language in ("", "sh", "bash"):
            for words in commands_of(block):
                yield from faults_of(words, help_of)
            yield from blocks.run(block, parent)
        if language == "text" and block and block[0].startswith("$ "):
            yield from blocks.quote(block, parent)
        if language == "python":
            yield from blocks.program(block)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--catena", required=True)
    parser.add_argument("--mpirun", default="", help="mpirun and its options, commas between them")
    parser.add_argument("pages", nargs="*")
    asked = parser.parse_args()
    catena = os.path.abspath(asked.catena)
    help_of, blocks = Help(catena), Blocks(catena, asked.mpirun.split(",") if asked.mpirun else [])
    faults = []
    with tempfile.TemporaryDirectory() as parent:
        for path in asked.pages or markdown.pages():
            faults += [f"{path}: {fault}" for fault in faults_of_page(path, help_of, blocks, parent)]
    faults += [] if blocks.run_commands and blocks.checked_scenes else ["the pages have nothing to run"]
    print("\n".join(faults) if faults else f"{blocks.run_commands} commands ran, {blocks.checked_scenes} scenes were read")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
