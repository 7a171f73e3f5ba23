#!/usr/bin/env python3
"""The checks of pages find what they are for: each rule is broken once in a small repository of its own.

usage: checks_test.py [--catena PROGRAM]      (with it also commands and scenes of pages)
"""
import importlib.util
import json
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
FOLDERS = "| `src` | sources |\n| `src/scene` | scenes |\n"
LONG = "Every " + "very " * 45 + "long sentence has many words."


def write(root, path, text):
    os.makedirs(os.path.dirname(os.path.join(root, path)) or root, exist_ok=True)
    with open(os.path.join(root, path), "w", encoding="utf-8") as file:
        file.write(text)


def run(*command):
    answer = subprocess.run([sys.executable, *command], capture_output=True, text=True, check=False)
    return answer.returncode, answer.stdout + answer.stderr


def pages(readme, page="# Page\n\nShort.\n"):
    """What pages.py says of a repository with these two pages and a folder src/scene."""
    with tempfile.TemporaryDirectory() as root:
        write(root, "README.md", readme)
        write(root, "src/README.md", page)
        write(root, "src/scene/scene.cpp", "void load();\n")
        return run(os.path.join(HERE, "pages.py"), root)


def rooms(**files):
    """What rooms.py says of src/low, src/high and these files."""
    order = "| `src` | s |\n| `src/low` | l |\n| `src/high` | h |\n"
    with tempfile.TemporaryDirectory() as root:
        write(root, "src/README.md", order)
        for path, text in {"src/low/low.hpp": "", "src/high/high.hpp": '#include "low/low.hpp"\n', **files}.items():
            write(root, path, text)
        for command in (["init", "-q"], ["add", "-A"]):
            subprocess.run(["git", "-C", root, *command], check=True)
        return run(os.path.join(HERE, "rooms.py"), root)


def homes(**files):
    """What homes.py says of these files."""
    with tempfile.TemporaryDirectory() as root:
        for path, text in files.items():
            write(root, path, text)
        for command in (["init", "-q"], ["add", "-A"]):
            subprocess.run(["git", "-C", root, *command], check=True)
        return run(os.path.join(HERE, "homes.py"), root)


def commands(catena, page, path="page.md"):
    with tempfile.TemporaryDirectory() as root:
        write(root, path, page)
        return run(os.path.join(HERE, "commands.py"), "--catena", catena, os.path.join(root, path))


def expect(name, answer, status, words):
    if answer[0] == status and words in answer[1]:
        return True
    print(f"FAILED: {name}: status {answer[0]}, not {status} with `{words}`:\n{answer[1]}")
    return False


def of_rooms():
    yield expect("folders in order", rooms(), 0, "no circle")
    yield expect("a circle", rooms(**{"src/low/back.hpp": '#include "high/high.hpp"\n'}), 1, "src/high and src/low include each other")
    against = {"src/high/high.hpp": "", "src/low/low.hpp": '#include "high/high.hpp"\n'}
    yield expect("a wrong order", rooms(**against), 1, "has src/low above src/high")
    full = {f"src/low/{number}.hpp": "" for number in range(41)}
    yield expect("a full folder", rooms(**full), 1, "src/low has 42 files")


def of_homes():
    drag = "if (scene.forces.linear_drag > 0) return;\n"
    yield expect("one file with drag", homes(**{"src/run/a.cpp": drag, "src/terms/drag.hpp": drag}), 0, "drag: 1 of at most 1")
    yield expect("drag in two files", homes(**{"src/run/a.cpp": drag, "src/plan/b.cpp": drag}), 1, "drag: 2 of at most 1")
    yield expect("drag in a comment", homes(**{"src/run/a.cpp": drag, "src/plan/b.cpp": "// " + drag}), 0, "drag: 1 of at most 1")
    named = homes(**{"src/dynamics/a.hpp": "void verlet_move();\n"})
    yield expect("an integrator in the dynamics", named, 1, "integrators in the dynamics: 1 of at most 0")
    # Functions, types and what they hold are no data members; a{}, b = f() and c(0) are one each.
    inner = "    void f() const { int x = 0; g(x); }\n    int h(int i = 0) const;\n    struct Inner { int a, b; };\n    using A = int;\n"
    held = inner + "    std::map<int, std::function<void(int)>> a{}, b = f();\n" + "".join(f"    int m{i};  // one\n" for i in range(18))
    yield expect("20 data members", homes(**{"src/run/a.hpp": "class Full {\n" + held + "};\n"}), 0, "classes above")
    more = homes(**{"src/run/a.hpp": "class Full final : public Base<int> {\n" + held + "    int last = 0;\n};\n"})
    yield expect("21 data members", more, 1, "class Full has 26 lines and 21 data members")
    long = homes(**{"src/run/a.hpp": "struct Long {\n" + "    void f();\n" * 249 + "};\n"})
    yield expect("251 lines", long, 1, "class Long has 251 lines and 0 data members")


def of_pages():
    good = "# Catena\n\nShort. [Sources](src/README.md#page)\n\n" + FOLDERS
    yield expect("a good page", pages(good), 0, "2 pages are in order")
    yield expect("a large first page", pages(good + "\n" + "Short. \n\n" * 1200), 1, "more than 8192")
    yield expect("a long sentence on the first page", pages(good + "\n" + LONG), 1, "a sentence has")
    yield expect("long sentences elsewhere", pages(good, "# Page\n\n" + LONG), 1, "1 of 1 sentences")
    yield expect("a long paragraph", pages(good, "# Page\n\n" + "One short sentence. " * 50), 1, "a paragraph has 150 words")
    yield expect("a long cell", pages(good, "# Page\n\n| " + "word " * 70 + "| |\n"), 1, "a table's cell has 70 words")
    yield expect("code is no prose", pages(good, "# Page\n\n```\n" + "word " * 200 + "\n```\n"), 0, "in order")
    yield expect("a lost link", pages(good, "# Page\n\n[x](lost.md)\n"), 1, "the link lost.md leads nowhere")
    yield expect("a lost heading", pages(good.replace("#page", "#gone")), 1, "names no heading")
    yield expect("a lost file", pages(good + "\n`scene/lost.cpp` reads.\n"), 1, "no file scene/lost.cpp")
    yield expect("a lost function", pages(good + "\n`Scene::lost()` reads.\n"), 1, "no function Scene::lost()")
    yield expect("names that are there", pages(good + "\n`src/scene/scene.cpp` has `load()`.\n"), 0, "in order")
    yield expect("a retired word", pages(good + "\nA hin" + "ge turns.\n"), 1, "is called revolute here")
    yield expect("a folder that nobody names", pages(good.replace("| `src/scene` | scenes |\n", "")), 1, "src/scene/: no README")


SCENE = "```yaml\nunits: si\nchains: [{generator: {pendulum: {links: 2}}}]\ndynamics: {integrator: rk4, step: 0.01, steps: 2}\n```\n"


def of_commands(catena):
    good = SCENE + "```\ncatena check my.yaml   # a comment\ncatena run my.yaml \\\n  --output out\n```\n"
    yield expect("a good page", commands(catena, good), 0, "2 commands ran, 1 scenes were read")
    yield expect("an unknown option", commands(catena, good + "\n`catena solve inputs/arm.yaml --sise 3`\n"), 1, "does not take --sise")
    yield expect("an unknown command", commands(catena, good + "\n`catena simulate my.yaml`\n"), 1, "no command simulate")
    yield expect("a lost scene", commands(catena, good + "\n`catena check inputs/lost.yaml`\n"), 1, "inputs/lost.yaml is not there")
    yield expect("a lost script", commands(catena, good + "```\njobs/lost.sh\n```\n"), 1, "jobs/lost.sh is not there")
    yield expect("a script's option", commands(catena, good + "```\ntests/run.sh --fast\n```\n"), 1, "tests/run.sh does not take --fast")
    yield expect("a wrong scene", commands(catena, good.replace("links: 2", "link: 2")), 1, "its scene is refused")
    yield expect("a command that fails", commands(catena, good + "```\ncatena run lost.yaml --output x\n```\n"), 1, "ended with status 2")
    answer = "```text\n$ catena check my.yaml --set dynamics.step=0\ncatena: {} (my.yaml: dynamics.step...): give ...\n```\n"
    yield expect("a quoted answer", commands(catena, good + answer.format("step 0 ...")), 0, "3 commands ran")
    yield expect("a wrong quotation", commands(catena, good + answer.format("no such step")), 1, "does not print `catena: no such step")
    yield from of_tutorials(catena, good)
    yield expect("nothing to run", commands(catena, "# Page\n"), 1, "nothing to run")


def of_tutorials(catena, good):
    page = "tutorials/page.md"
    if importlib.util.find_spec("h5py") is None or importlib.util.find_spec("matplotlib") is None:
        return
    plot = good + "```\npython3 jobs/plot.py out\n```\n"
    program = plot + "```python\nopen('out/observables.csv').read()[0]\n```\n"
    yield expect("a folder of another block", commands(catena, plot), 1, "no such folder (out)")
    yield expect("a tutorial's folder", commands(catena, plot, page), 0, "3 commands ran")
    yield expect("a tutorial's program", commands(catena, program, page), 0, "4 commands ran")
    yield expect("a program that fails", commands(catena, program.replace("[0]", "[0][1]"), page), 1, "IndexError")


def keys(catena, change=None):
    """What keys.py says of a page with a table of each map, all of them current unless `change` changed the page."""
    maps = json.loads(subprocess.run([catena, "keys", "--json", "-"], capture_output=True, text=True, check=True).stdout)["maps"]
    script = [os.path.join(HERE, "keys.py"), "--catena", catena]
    with tempfile.TemporaryDirectory() as root:
        write(root, "inputs/README.md", "# Page\n\n" + "\n".join(f"<!-- keys {each['map']} -->\n<!-- end -->\n" for each in maps))
        written = run(*script, root)
        with open(os.path.join(root, "inputs/README.md"), encoding="utf-8") as file:
            page = file.read()
        write(root, "inputs/README.md", change(page) if change else page)
        return run(*script, "--check", root) if written[0] == 0 else written


def of_keys(catena):
    yield expect("current tables", keys(catena), 0, "tables of keys are current")
    yield expect("a changed default", keys(catena, lambda page: page.replace("| 300 |", "| 310 |")), 1, "tables of keys are not current")
    yield expect("a lost table", keys(catena, lambda page: page.replace("<!-- keys solver -->", "")), 1, "0 tables of the keys of solver")
    yield expect("an unknown table", keys(catena, lambda page: page + "<!-- keys wallpaper -->\n<!-- end -->\n"), 1, "no map wallpaper")


def main():
    results = [*of_pages(), *of_rooms(), *of_homes()]
    if sys.argv[1:2] == ["--catena"]:
        catena = os.path.abspath(sys.argv[2])
        results += [*of_commands(catena), *of_keys(catena)]
    print(f"{sum(results)} of {len(results)} checks passed")
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
