"""Random damage to files of any kind: bytes, lines and the numbers in them."""
import os
import re

NUMBERS = [b"0", b"-1", b"nan", b"inf", b"1e308", b"-1e-320", b"99999999999999999999", b"1e9", b"0x1p3", b"1,5", b"--2", b"", b"1e400"]
BYTES = [b"\x00", b"\x1b[31m", b"\xff\xfe", b"\r", b"\n\n\n", b"<", b">", b'"', b"&", b"<!--", b"\xc3", b"\t", b"," * 300, b"A" * 5000, b"\x7f"]


def flipped(draw, data):
    changed = bytearray(data)
    for _ in range(draw.choice([1, 1, 2, 8, 64])):
        if changed:
            changed[draw.randrange(len(changed))] = draw.choice([0, 255, 0x80, 0x7f, draw.randrange(256)])
    return bytes(changed)


def cut(draw, data):
    return data[:draw.randrange(len(data) + 1)]


def removed(draw, data):
    first = draw.randrange(len(data) + 1)
    return data[:first] + data[first + draw.choice([1, 8, 80, 512]):]


def inserted(draw, data):
    at = draw.randrange(len(data) + 1)
    return data[:at] + draw.choice(BYTES) + data[at:]


def repeated(draw, data):
    first = draw.randrange(len(data) + 1)
    part = data[first:first + draw.choice([1, 16, 80, 1000])]
    return data[:first] + part * draw.choice([2, 3, 50]) + data[first + len(part):]


def lines_changed(draw, data):
    lines = data.split(b"\n")
    for _ in range(draw.choice([1, 1, 3])):
        i, j = draw.randrange(len(lines)), draw.randrange(len(lines))
        draw.choice([lambda: lines.insert(j, lines[i]), lambda: len(lines) > 1 and lines.pop(i), lambda: lines.__setitem__(i, lines[j]),
                     lambda: lines.__setitem__(i, lines[i][::-1]), lambda: draw.shuffle(lines), lambda: lines.__setitem__(i, b"")])()
        if not lines:
            break
    return b"\n".join(lines)


def number_changed(draw, data):
    found = list(re.finditer(rb"-?\d+(\.\d*)?([eE][-+]?\d+)?", data))
    if not found:
        return inserted(draw, data)
    one = draw.choice(found)
    return data[:one.start()] + draw.choice(NUMBERS) + data[one.end():]


def word_changed(draw, data):
    found = list(re.finditer(rb"[A-Za-z]{2,}", data[:200000]))
    if not found:
        return flipped(draw, data)
    one, other = draw.choice(found), draw.choice(found)
    return data[:one.start()] + draw.choice([other.group(), one.group().lower(), one.group()[:1], b"X"]) + data[one.end():]


def file(draw, path):
    """Damages the file, or puts something else in its place."""
    kind = draw.random()
    if kind < 0.06:
        os.remove(path)
        if kind < 0.02:
            os.mkdir(path)
        return
    with open(path, "rb") as whole:
        data = whole.read()
    text = b"\0" not in data
    ways = [flipped, cut, removed, inserted, repeated] + ([lines_changed, number_changed, number_changed, word_changed] if text else [flipped] * 4)
    for _ in range(draw.choice([1, 1, 1, 2, 4])):
        data = draw.choice(ways)(draw, data)
    with open(path, "wb") as whole:
        whole.write(b"" if kind > 0.98 else data)
