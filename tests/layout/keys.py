#!/usr/bin/env python3
"""Writes the tables of keys in inputs/README.md and inputs/keys/*.md from what `catena keys` declares, between their markers.

usage: keys.py --catena PROGRAM [--check] [ROOT]     (--check: changes nothing, ends with status 1 where a table is not current)

The table of the map NAME stands between `<!-- keys NAME -->` and `<!-- end -->`. Each map that the program declares has one table.
"""
import argparse
import glob
import json
import os
import re
import subprocess
import sys

import markdown

MARKER = re.compile(r"(<!-- keys ([\w.]+) -->\n).*?(\n?<!-- end -->)", re.S)
COLUMNS = ("key", "type", "default", "unit", "meaning", "example")
IN_CODE = ("key", "example")


def declared(catena):
    """{name of the map: its keys}."""
    answer = subprocess.run([catena, "keys", "--json", "-"], capture_output=True, text=True, timeout=60, check=True)
    return {each["map"]: each["keys"] for each in json.loads(answer.stdout)["maps"]}


def cell(column, text):
    text = text.replace("|", "\\|")
    return f"`{text}`" if text and column in IN_CODE else text


def table(keys):
    """The keys as Markdown; a column in which no key has anything is left out."""
    columns = [c for c in COLUMNS if any(key[c] for key in keys)]
    lines = ["| " + " | ".join(columns) + " |", "|" + " --- |" * len(columns)]
    lines += ["| " + " | ".join(cell(c, key[c]) for c in columns) + " |" for key in keys]
    return "\n".join(lines)


def current(text, maps, seen):
    """The page with every table made anew; the names of its tables are appended to `seen`."""
    def made(match):
        seen.append(match[2])
        return match[1] + table(maps[match[2]]) + "\n<!-- end -->" if match[2] in maps else match[0]
    return MARKER.sub(made, text)


def faults_of(seen, maps):
    for name in sorted(set(seen) - set(maps)):
        yield f"catena keys has no map {name}"
    for name in maps:
        if seen.count(name) != 1:
            yield f"inputs/ has {seen.count(name)} tables of the keys of {name}, not one"


def main():
    options = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    options.add_argument("--catena", required=True)
    options.add_argument("--check", action="store_true")
    options.add_argument("root", nargs="?", default=markdown.ROOT)
    asked = options.parse_args()
    maps, seen, faults = declared(asked.catena), [], []
    for path in sorted([os.path.join(asked.root, "inputs/README.md"), *glob.glob(os.path.join(asked.root, "inputs/keys/*.md"))]):
        with open(path, encoding="utf-8") as file:
            text = file.read()
        made = current(text, maps, seen)
        if made == text:
            continue
        if asked.check:
            faults.append(f"{os.path.relpath(path, asked.root)}: tables of keys are not current: run tests/layout/keys.py --catena PROGRAM")
            continue
        with open(path, "w", encoding="utf-8") as file:
            file.write(made)
    faults += faults_of(seen, maps)
    print("\n".join(faults) if faults else f"{len(seen)} tables of keys are current")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
