"""Changes of whole scenes as trees: maps are lists of pairs, so that a key may be there twice; scalars are their text."""
import copy
import re
import sys

try:
    import yaml
except ImportError:
    print("SKIPPED: the Python package PyYAML is missing (pip install PyYAML)")
    sys.exit(77)

VALUES = ["0", "-1", "1", "nan", ".nan", ".inf", "-.inf", "1e308", "-1e308", "1e-320", "1e400", "1e9", "1e-9", "1000000", "9223372036854775807",
          "-9223372036854775809", "18446744073709551616", "0.5", "0x10", "1_000", "1,5", "true", "null", "~", "''", "[]", "{}", "[1, 2]",
          "[[1]]", "{a: 1}", "free", "fixed", "auto", "thermal", "x.yaml", "scene.yaml", "/dev/null", "/dev/zero", "/", ".", "..",
          '"\\e[31mred"', '"\\0"', '"\\n"', '"\\u202e"', "é", "'" + "x" * 5000 + "'", "'%s%n'", "'<b>&\"'", "AAAA", "*a", "!!binary aGk=", "? x"]

LONGEST = 100000  # of what is there many times, in characters
GENTLE = [0.5, 0.9, 0.999, 1.001, 1.1, 2]
FACTORS = [10, 0.1, 1e3, 1e-3, 1e10, 1e-10, -1, 57.29577951308232, 4.184, 0.602214076]  # units and slips among them


class Map(list):
    """Pairs of key and value."""


def tree_of(node, depth=0):
    if depth > 50:
        return "deep"
    if isinstance(node, yaml.MappingNode):
        return Map([tree_of(key, depth + 1), tree_of(value, depth + 1)] for key, value in node.value)
    if isinstance(node, yaml.SequenceNode):
        return [tree_of(item, depth + 1) for item in node.value]
    return node.value if node.style is None else quoted(node.value)


def quoted(text):
    return "'" + text.replace("'", "''").replace("\n", " ") + "'"


def load(path):
    with open(path, "rb") as file:
        text = file.read().decode("latin-1")
    try:
        return tree_of(yaml.compose(text, Loader=yaml.BaseLoader))
    except (yaml.YAMLError, ValueError):
        return None


def write(tree):
    if isinstance(tree, Map):
        return "{" + ", ".join(f"{write(key)}: {write(value)}" for key, value in tree) + "}"
    if isinstance(tree, list):
        return "[" + ", ".join(write(item) for item in tree) + "]"
    return tree


def document(tree):
    """The first level one key a line."""
    if not isinstance(tree, Map):
        return write(tree) + "\n"
    return "".join(f"{write(key)}: {write(value)}\n" for key, value in tree)


def places(tree):
    """Every (container, index) that holds a value, and those of pairs and items that can be moved."""
    found = []
    stack = [tree]
    while stack:
        node = stack.pop()
        if not isinstance(node, list):
            continue
        for i, item in enumerate(node):
            value = item[1] if isinstance(node, Map) else item
            found.append((node, i))
            stack.append(value)
    return found


def get(place):
    node, i = place
    return node[i][1] if isinstance(node, Map) else node[i]


def put(place, value):
    node, i = place
    if isinstance(node, Map):
        node[i] = [node[i][0], value]
    else:
        node[i] = value


def scaled(draw, text):
    try:
        return repr(float(text) * draw.choice(draw.choice([GENTLE, FACTORS])) if "." in text or "e" in text else int(text) + draw.choice([-1, 1, 2, 10, -10]))
    except ValueError:
        return draw.choice(VALUES)


def set_value(draw, place, _):
    put(place, draw.choice(VALUES))


def scale(draw, place, _):
    old = get(place)
    put(place, scaled(draw, old) if isinstance(old, str) else draw.choice(VALUES))


def delete(draw, place, _):
    del place[0][place[1]]


def double(draw, place, _):
    place[0].insert(draw.randrange(len(place[0]) + 1), copy.deepcopy(place[0][place[1]]))


def many_times(draw, place, _):
    times = draw.choice([2, 10, 500])
    if times * len(write(get(place))) < LONGEST:
        place[0][place[1]:place[1] + 1] = [copy.deepcopy(place[0][place[1]]) for _ in range(times)]


def misspell(draw, place, _):
    node, i = place
    if isinstance(node, Map) and isinstance(node[i][0], str) and len(node[i][0]) > 1:
        key = node[i][0]
        at = draw.randrange(len(key) - 1)
        node[i] = [draw.choice([key[:at] + key[at + 1] + key[at] + key[at + 2:], key.upper(), key + "s", key[:-1]]), node[i][1]]
    else:
        put(place, draw.choice(VALUES))


def swap(draw, place, others):
    other = draw.choice(others)
    mine, theirs = get(place), get(other)
    if not contains(mine, other[0]) and not contains(theirs, place[0]):
        put(place, theirs), put(other, mine)


def contains(tree, node):
    return tree is node or isinstance(tree, list) and any(contains(part, node) for part in tree)


def wrap(draw, place, _):
    depth = draw.choice([1, 1, 3, 200])
    put(place, "[" * depth + write(get(place)) + "]" * depth)


def borrow(draw, place, others):
    put(place, copy.deepcopy(get(draw.choice(others))))


WAYS = [set_value, set_value, set_value, *[scale] * 9, delete, delete, double, many_times, misspell, swap, wrap]


def is_number(value):
    return isinstance(value, str) and re.fullmatch(r"[-+]?[0-9.]+([eE][-+]?[0-9]+)?", value) is not None


def change_numbers(draw, tree):
    """Numbers become others, which many scenes survive."""
    numbers = [place for place in places(tree) if is_number(get(place))]
    for place in draw.sample(numbers, min(len(numbers), draw.choice([1, 1, 2, 4]))):
        put(place, scaled(draw, get(place)))


def change_blocks(draw, tree, other):
    for _ in range(draw.choice([1, 1, 1, 2, 3, 6])):
        here = places(tree)
        if not here:
            break
        way = draw.choice(WAYS)
        if draw.random() < 0.2 and isinstance(other, Map) and other:
            if draw.random() < 0.5:
                tree.append(copy.deepcopy(draw.choice(other)))
            else:
                borrow(draw, draw.choice(here), places(other))
        else:
            way(draw, draw.choice(here), here)


def mutate(draw, path, sources):
    """Changes the scene at `path`, in a few places; keys and blocks also come from other scenes."""
    tree, other = load(path), load(draw.choice(sources))
    if not isinstance(tree, Map) or not tree:
        tree = Map([["title", "x"]])
    if draw.random() < 0.5:
        change_numbers(draw, tree)
    else:
        change_blocks(draw, tree, other)
    text = document(tree)
    text = re.sub(r"(count|beads|bodies|steps): \d{6,}", r"\1: 99999", text)
    with open(path, "w", encoding="utf-8", errors="replace") as file:
        file.write(text)
