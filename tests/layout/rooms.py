#!/usr/bin/env python3
"""Checks that the folders of the sources are rooms: they include each other in one direction, and none is too full.

The order is the table "Folders" of src/README.md: a folder includes only folders above it.
usage: rooms.py [ROOT]
"""
import collections
import os
import re
import subprocess
import sys

ROOMS = ("src", "cuda", "mpi")
SOURCE = re.compile(r"\.(c|cpp|cu|cuh|h|hpp|inc)$")
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.M)
MOST_FILES = 40
ENTRANCE = "src/main.cpp"
ORDER = "src/README.md"


def sources(root):
    listed = subprocess.run(["git", "-C", root, "ls-files", *ROOMS], capture_output=True, text=True, check=True).stdout.split()
    return [path for path in listed if SOURCE.search(path)]


def room(path):
    return path if path == ENTRANCE else os.path.dirname(path)


def includes(root, paths):
    """{(including folder, included folder): (file, included file)}, one example of each."""
    known, found = set(paths), {}
    for path in paths:
        with open(os.path.join(root, path), encoding="utf-8") as file:
            for name in INCLUDE.findall(file.read()):
                beside = os.path.normpath(os.path.join(os.path.dirname(path), name))
                for included in ("src/" + name, name, beside):
                    if included in known and room(included) != room(path):
                        found.setdefault((room(path), room(included)), (path, included))
                        break
    return found


def reachable(edges):
    reach = collections.defaultdict(set)
    for start, end in edges:
        reach[start].add(end)
    for middle in list(reach):
        for start in list(reach):
            if middle in reach[start]:
                reach[start] |= reach[middle]
    return reach


def check_circles(edges):
    reach = reachable(edges)
    for (start, end), (path, included) in sorted(edges.items()):
        if start in reach[end]:
            yield f"{start} and {end} include each other: {path} includes {included}"


def check_order(root, edges):
    """No circle is necessary for an order, but a reader wants the one that the page shows."""
    with open(os.path.join(root, ORDER), encoding="utf-8") as file:
        rows = re.findall(r"^\| `([^`]+)` \|", file.read(), re.M)
    place = {name: number for number, name in enumerate(rows)}
    for (start, end), (path, included) in sorted(edges.items()):
        if start == ENTRANCE:
            continue
        start, end = (name if name in place else name.split("/")[0] for name in (start, end))
        if start in place and end in place and place[end] > place[start]:
            yield f"{ORDER} has {start} above {end}, but {path} includes {included}"


def check_sizes(paths):
    for name, files in collections.Counter(map(room, paths)).items():
        if files > MOST_FILES:
            yield f"{name} has {files} files, more than {MOST_FILES}"


def main():
    root = sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
    paths = sources(root)
    edges = includes(root, paths)
    faults = [*check_circles(edges), *check_order(root, edges), *check_sizes(paths)]
    print("\n".join(faults) if faults else f"{len(paths)} files in {len(set(map(room, paths)))} folders, no circle")
    return bool(faults) or not paths


if __name__ == "__main__":
    sys.exit(main())
