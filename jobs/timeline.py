#!/usr/bin/env python3
"""A Gantt picture of one step of a run: what each rank does when.

Reads timeline.json of the folder that `catena run` wrote, and summary.json for the title if it is there. Every rank's time begins with its
own step: ranks share no clock. More than 16 ranks get thin lanes without names; of more than 128 every second, third, ... is drawn."""
import argparse
import collections
import json
import math
import os
import sys

SURFACE, BAND, INK, SOFT, GRID = "#ffffff", "#f3f5f8", "#1b2733", "#66778a", "#dbe2e9"
# Okabe and Ito's colours, which colour-blind people tell apart; a name has the same one in every picture.
COLOURS = {"forces": "#d55e00", "matrix sweep": "#0072b2", "projections and drift": "#009e73", "exchange of positions": "#cc79a7",
           "hand over positions": "#e69f00", "simple forces": "#56b4e9", "evaluations": "#f0e442"}
WAITING = "#b4bcc5"
MOST_NAMED_RANKS = 16
MOST_RANKS = 128
WIDTH, RIGHT, BOTTOM, LEGEND_ROW = 13.0, 0.3, 0.62, 0.25  # inches
DOTS = 150  # an inch
GAP = 0.5  # between ranks, in lanes
SLIVER = 1e-3  # of the picture's width: phases of a lane that overlap by less are not parted

Phase = collections.namedtuple("Phase", "name lane begin end")  # milliseconds


class UserError(Exception):
    """What is wrong, where, and what to do."""


def parse_arguments():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="examples:\n  build/venv/bin/python jobs/timeline.py runs/alpha-synuclein\n"
               "  build/venv/bin/python jobs/timeline.py runs/long --ranks 0-3,60 --step 200 --output step.svg")
    parser.add_argument("source", metavar="FOLDER", help="folder of a run (catena run ... --output FOLDER), or its timeline.json")
    parser.add_argument("--output", metavar="FILE", help="where the picture goes, a .png or .svg (default: timeline.png beside timeline.json)")
    parser.add_argument("--ranks", metavar="LIST", help="which ranks, as in 0-3,8 (default: all)")
    parser.add_argument("--step", metavar="N", help="which recorded step (default: the one of median length on the first rank, as in report.html)")
    return parser.parse_args()


def import_packages():
    try:
        import matplotlib
    except ImportError as error:
        raise UserError(f"a Python package is missing ({error.name}): pip install matplotlib") from None
    matplotlib.use("Agg")


def timeline_file(source):
    path = os.path.join(source, "timeline.json") if os.path.isdir(source) else source
    if not os.path.isfile(path):
        raise UserError(f"no such file ({path}): name the folder of a run that has ended, or its timeline.json")
    return path


def read_json(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def part(entry, key, *types):
    value = entry.get(key) if isinstance(entry, dict) else None
    if type(value) not in types:
        raise ValueError(f"no '{key}' where there should be one")
    return value


def one_line(text):
    return " ".join(text.split())


def read_phase(entry):
    name, lane = (one_line(part(entry, key, str)) for key in ("name", "lane"))
    begin, end = (part(entry, key, int, float) for key in ("begin", "end"))
    if not (math.isfinite(begin) and math.isfinite(end) and begin <= end):
        raise ValueError(f"'{name}' from {begin} to {end}")
    return Phase(name, lane, 1e3 * begin, 1e3 * end)


def read_steps(rank):
    steps = {part(step, "step", int): [read_phase(entry) for entry in part(step, "phases", list)] for step in part(rank, "steps", list)}
    return {number: phases for number, phases in steps.items() if phases}


def read_timeline(path):
    """{rank: {step: [Phase, ...]}}, without steps that have no phases."""
    ranks = {}
    try:
        for rank in part(read_json(path), "ranks", list):
            if part(rank, "rank", int) in ranks:
                raise ValueError(f"rank {rank['rank']} twice")
            ranks[rank["rank"]] = read_steps(rank)
    except (ValueError, OverflowError, RecursionError) as error:
        raise UserError(f"not a timeline ({path}): {one_line(str(error))}; name the timeline.json that a run wrote") from None
    except OSError as error:
        raise UserError(f"cannot be read ({path}): {error.strerror}; name a file that you may read") from None
    if not ranks:
        raise UserError(f"no ranks ({path}): name the timeline.json of a run that has ended")
    if not any(ranks.values()):
        raise UserError(f"no steps ({path}): let the run take a step")
    return dict(sorted(ranks.items()))


def spans(numbers):
    """"0 to 3, 8" """
    runs = []
    for number in sorted(numbers):
        if runs and number == runs[-1][1] + 1:
            runs[-1][1] = number
        else:
            runs.append([number, number])
    return ", ".join(f"{first} to {last}" if last > first + 1 else ", ".join(map(str, sorted({first, last}))) for first, last in runs)


def wanted_spans(text):
    """[(first, last), ...] of "0-3,8"."""
    wanted = []
    for span in text.split(","):
        first, dash, last = (word.strip() for word in span.partition("-"))
        last = last if dash else first
        if not all(word.isascii() and word.isdigit() and len(word) < 10 for word in (first, last)) or int(last) < int(first):
            raise UserError(f"not a list of ranks (--ranks {text}): give numbers and spans, as in 0-3,8")
        wanted.append((int(first), int(last)))
    return wanted


def chosen_ranks(text, ranks, path):
    if text is None:
        return list(ranks)
    chosen = set()
    for first, last in wanted_spans(text):
        there = [rank for rank in ranks if first <= rank <= last]
        if len(there) <= last - first:
            raise UserError(f"no such ranks (--ranks {text}, {path}): there are {spans(ranks)}")
        chosen.update(there)
    return sorted(chosen)


def length(phases):
    return max(phase.end for phase in phases) - min(phase.begin for phase in phases)


def chosen_step(text, ranks, path):
    """Its number, and why it was chosen."""
    steps = next(steps for steps in ranks.values() if steps)
    if text is not None:
        recorded = set().union(*ranks.values())
        if not (text.isascii() and text.isdigit() and len(text) < 19 and int(text) in recorded):
            raise UserError(f"no such step (--step {text}, {path}): recorded are {spans(recorded)}")
        return int(text), ""
    number = sorted((length(phases), number) for number, phases in steps.items())[len(steps) // 2][1]
    return number, f", of median length among the {len(steps)} recorded" if len(steps) > 1 else ""


def picture_file(output, path):
    output = output or os.path.join(os.path.dirname(path), "timeline.png")
    if not output.lower().endswith((".png", ".svg")):
        raise UserError(f"not a kind of picture that is drawn ({output}): end its name in .png or .svg")
    return output


def read_facts(path):
    """The run's title and what else summary.json beside the timeline knows; of what it does not hold nothing is said."""
    try:
        summary = read_json(os.path.join(os.path.dirname(path), "summary.json"))
    except (OSError, ValueError, RecursionError):
        return "", []
    if not isinstance(summary, dict):
        return "", []
    known = {name: value for key in ("solver", "parallel", "forces") if isinstance(summary.get(key), dict) for name, value in summary[key].items()
             if type(value) in (str, int) and value != ""}
    threads = known.get("threads")
    facts = [f"backend {known['backend']}"] if "backend" in known else []
    facts += [f"{threads} thread{'s' if threads != 1 else ''} each"] if threads else []
    facts += [f"OpenMM on {known['platform']}"] if "platform" in known else []
    facts += [f"path {known['path']}"] if "path" in known else []
    title = next((summary[key] for key in ("title", "scene") if isinstance(summary.get(key), str) and summary[key].strip()), "")
    return one_line(title), [one_line(fact) for fact in facts]


def names_in_order(phases):
    """Each once, in the order in which they begin."""
    first = {}
    for phase in phases:
        first[phase.name] = min(phase.begin, first.get(phase.name, math.inf))
    return sorted(first, key=lambda name: (first[name], name))


def colours_of(names):
    """Unknown names take the colours that are left, then darker ones."""
    colours = {name: WAITING if name.startswith("wait") else COLOURS[name] for name in names if name.startswith("wait") or name in COLOURS}
    left = [colour for name, colour in COLOURS.items() if name not in names] + [darker(colour) for colour in COLOURS.values()]
    for place, name in enumerate(name for name in names if name not in colours):
        colours[name] = left[place % len(left)]
    return colours


def red_green_blue(colour):
    return [int(colour[k:k + 2], 16) / 255 for k in (1, 3, 5)]


def darker(colour):
    return "#" + "".join(f"{round(127.5 * value):02x}" for value in red_green_blue(colour))


def readable_on(colour):
    luminance = sum(weight * value ** 2.2 for weight, value in zip((0.2126, 0.7152, 0.0722), red_green_blue(colour)))
    return SURFACE if luminance < 0.3 else INK


def parted(phases, sliver):
    """(phase, row) of one lane, the longest first, and the number of rows: phases that overlap lie below each other."""
    placed, ends = [], []
    for phase in sorted(phases, key=lambda phase: (phase.begin, phase.end)):
        row = next((row for row, end in enumerate(ends) if min(end, phase.end) - phase.begin <= sliver), len(ends))
        ends[row:row + 1] = [max([phase.end, *ends[row:row + 1]])]
        placed.append((phase, row))
    return sorted(placed, key=lambda place: place[0].begin - place[0].end), max(len(ends), 1)


def readable_time(value):
    return f"{value:.0f}" if value >= 100 else f"{float(f'{value:.3g}'):.12g}" if value >= 1e-3 else "below 0.001" if value > 0 else "0"


def times_told(name, steps):
    """What a phase takes on the ranks that are drawn: "1.2 ms", "1.2 to 1.4 ms"."""
    found = [[phase.end - phase.begin for phase in phases if phase.name == name] for phases in steps]
    times = [sum(times) for times in found if times]
    low, high = readable_time(min(times)), readable_time(max(times))
    return f"{low} ms" if low == high else f"up to {high} ms" if low.startswith("below") else f"{low} to {high} ms"


class Picture:
    """Lanes in groups, a group a rank, the first on top."""

    def __init__(self, steps):
        """steps: {rank: [Phase, ...]} of one step"""
        everything = [phase for phases in steps.values() for phase in phases]
        self.steps = steps
        self.lanes = list(dict.fromkeys(phase.lane for phase in everything))
        self.names = names_in_order(everything)
        self.colours = colours_of(self.names)
        self.named = len(steps) <= MOST_NAMED_RANKS
        self.low = min(0.0, min(phase.begin for phase in everything))
        self.high = max(max(phase.end for phase in everything), self.low + 1e-6)
        self.group = len(self.lanes) + GAP
        self.entries = [f"{name}: {times_told(name, steps.values())}" for name in self.names]
        self.measure()

    def measure(self):
        """Everything in inches."""
        lanes = self.group * len(self.steps)
        self.lane = (0.32 if lanes < 24 else 0.22) if self.named else min(0.1, max(0.02, math.ceil(DOTS * 14 / lanes) / DOTS))
        self.left = 1.25 + 0.078 * max(map(len, self.lanes)) if self.named else 0.95
        self.columns = max(1, int((WIDTH - 0.6) / (0.6 + 0.078 * max(map(len, self.entries)))))
        self.top = 1.05 + LEGEND_ROW * -(-len(self.entries) // self.columns)
        self.note = "" if self.named or len(self.lanes) == 1 else f"Lanes of a rank, from the top: {', '.join(self.lanes)}."
        self.bottom = BOTTOM + (0.2 if self.note else 0)
        self.height = self.top + self.bottom + self.lane * lanes

    def draw(self, title, caption):
        import matplotlib.pyplot as plt
        plt.rcParams.update({"font.family": ["DejaVu Sans", "sans-serif"], "axes.facecolor": SURFACE, "figure.facecolor": SURFACE,
                             "text.parse_math": False, "svg.fonttype": "none"})
        figure = plt.figure(figsize=(WIDTH, self.height))
        across, up = 1 - (self.left + RIGHT) / WIDTH, 1 - (self.top + self.bottom) / self.height
        axes = figure.add_axes([self.left / WIDTH, self.bottom / self.height, across, up])
        axes.set(xlim=(self.low, self.low + 1.004 * (self.high - self.low)), ylim=(self.group * len(self.steps) - 0.5 * GAP, -0.5 * GAP))
        for place, (rank, phases) in enumerate(self.steps.items()):
            self.draw_rank(axes, place * self.group, rank, phases)
        self.draw_axes(axes)
        self.draw_head(figure, title, caption)
        return figure

    def draw_rank(self, axes, top, rank, phases):
        from matplotlib.collections import PolyCollection
        bands = [rectangle(self.low, self.high, top + lane + 0.06, top + lane + 0.94) for lane in range(len(self.lanes))]
        axes.add_collection(PolyCollection(bands, facecolors=BAND, linewidths=0, gid=f"rank-{rank}", zorder=0), autolim=False)
        for lane, name in enumerate(self.lanes):
            placed, rows = parted([phase for phase in phases if phase.lane == name], SLIVER * (self.high - self.low))
            high = 0.88 / rows
            bars = [rectangle(phase.begin, phase.end, top + lane + 0.06 + row * high, top + lane + 0.06 + (row + 1) * high) for phase, row in placed]
            colours = [self.colours[phase.name] for phase, _ in placed]
            if bars:  # edges of their colour, so that what is short can be seen
                axes.add_collection(PolyCollection(bars, facecolors=colours, edgecolors=colours, linewidths=0.6 if self.named else 0.3,
                                                   gid=f"rank-{rank}-lane-{lane}", zorder=2), autolim=False)
            if self.named and rows == 1:
                self.name_bars(axes, top + lane + 0.5, [phase for phase, _ in placed])
        if not phases and self.named:
            axes.text(self.low, top + 0.5 * len(self.lanes), "  nothing recorded", va="center", color=SOFT, fontsize=9)

    def name_bars(self, axes, y, phases):
        inch = (self.high - self.low) / (WIDTH - self.left - RIGHT)
        for phase in phases:
            if phase.end - phase.begin > (0.07 * len(phase.name) + 0.15) * inch:
                axes.text(phase.begin + 0.06 * inch, y, phase.name, va="center_baseline", color=readable_on(self.colours[phase.name]), fontsize=8.5,
                          clip_on=True)

    def draw_axes(self, axes):
        from matplotlib.ticker import MaxNLocator
        axes.xaxis.set_major_locator(MaxNLocator(10, steps=[1, 2, 2.5, 5, 10]))
        axes.ticklabel_format(axis="x", style="plain", useOffset=False)
        axes.grid(axis="x", color=GRID, linewidth=0.8)
        axes.set_axisbelow(True)
        axes.tick_params(colors=SOFT, labelsize=9, length=3)
        for side in ("top", "right", "left"):
            axes.spines[side].set_visible(False)
        axes.spines["bottom"].set_color(SOFT)
        axes.set_xlabel("time from the step's beginning, on each rank's own clock [ms]", color=SOFT, fontsize=10)
        if self.named:
            self.name_lanes(axes)
        else:
            self.number_ranks(axes)

    def name_lanes(self, axes):
        tops = [place * self.group for place in range(len(self.steps))]
        axes.set_yticks([top + lane + 0.5 for top in tops for lane in range(len(self.lanes))], self.lanes * len(tops))
        axes.tick_params(axis="y", length=0, labelcolor=INK)
        for top, rank in zip(tops, self.steps):
            axes.annotate(f"rank {rank}", (0, top + 0.5), xycoords=("figure fraction", "data"), xytext=(21, 0), textcoords="offset points",
                          va="center_baseline", color=INK, fontsize=10, fontweight="bold")

    def number_ranks(self, axes):
        """As many numbers as there is room for."""
        ranks = list(self.steps)
        apart = max(1, math.ceil(0.17 / (self.lane * self.group)))
        apart = next(step * 10 ** power for power in range(10) for step in (1, 2, 5) if step * 10 ** power >= apart)
        places = range(0, len(ranks), apart)
        axes.set_yticks([place * self.group + 0.5 * len(self.lanes) for place in places], [str(ranks[place]) for place in places])
        axes.tick_params(axis="y", labelcolor=INK)
        axes.set_ylabel("rank", color=SOFT, fontsize=10)
        axes.figure.text(self.left / WIDTH, 0.13 / self.height, self.note, color=SOFT, fontsize=9)

    def draw_head(self, figure, title, caption):
        from matplotlib.patches import Patch
        figure.text(0.3 / WIDTH, 1 - 0.45 / self.height, title, fontsize=min(17, 17 * 85 / max(len(title), 1)), fontweight="bold", color=INK)
        figure.text(0.3 / WIDTH, 1 - 0.75 / self.height, caption, fontsize=11, color=SOFT)
        handles = [Patch(facecolor=self.colours[name], label=entry) for name, entry in zip(self.names, self.entries)]
        figure.legend(handles=handles, loc="upper left", bbox_to_anchor=(0.26 / WIDTH, 1 - 0.9 / self.height), ncols=self.columns, fontsize=9.5,
                      frameon=False, labelcolor=INK, handlelength=1.4, handleheight=1.0, borderpad=0.3, columnspacing=2.2, borderaxespad=0)


def rectangle(left, right, top, bottom):
    return [(left, top), (right, top), (right, bottom), (left, bottom)]


def draw_picture(ranks, chosen, step, why, path, output):
    every = -(-len(chosen) // MOST_RANKS)
    drawn = chosen[::every]
    steps = {rank: ranks[rank].get(step, []) for rank in drawn}
    if not any(steps.values()):
        raise UserError(f"nothing recorded of step {step} on these ranks ({path}): choose others by --ranks or --step")
    title, facts = read_facts(path)
    told = f"{len(ranks):,} rank{'s' if len(ranks) > 1 else ''}"
    if every > 1:
        told = f"{len(drawn)} of {told}, one in {every}"
    elif len(drawn) < len(ranks):
        told = f"{len(drawn)} of {told}"
    figure = Picture(steps).draw(title or "A run of Catena", f"Step {step}{why}. " + ", ".join([told] + facts))
    try:
        figure.savefig(output, dpi=DOTS)
    except (OSError, ValueError) as error:
        raise UserError(f"the picture cannot be written ({output}): {error}") from None


def main():
    arguments = parse_arguments()
    try:
        path = timeline_file(arguments.source)
        output = picture_file(arguments.output, path)
        ranks = read_timeline(path)
        chosen = chosen_ranks(arguments.ranks, ranks, path)
        step, why = chosen_step(arguments.step, ranks, path)
        import_packages()
        draw_picture(ranks, chosen, step, why, path, output)
    except UserError as error:
        print(f"timeline.py: {error}", file=sys.stderr)
        return 2
    print(output)
    return 0


if __name__ == "__main__":
    sys.exit(main())
