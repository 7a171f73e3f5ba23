"""Reads the repository's pages: which there are, and their paragraphs, tables, links, commands and examples."""
import os
import re

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
LEFT_OUT = {"build", "__pycache__"}
FENCE = re.compile(r"^\s*```(\S*)\s*$")


def folders(root):
    """Every folder of the repository, relative to `root`, without hidden ones and builds."""
    for base, names, _ in os.walk(root):
        names[:] = sorted(n for n in names if n == ".github" or not n.startswith(".") and n not in LEFT_OUT)
        yield os.path.relpath(base, root)


def pages(root=ROOT):
    """Paths of all Markdown files, relative to `root`."""
    found = []
    for folder in folders(root):
        for name in sorted(os.listdir(os.path.join(root, folder))):
            if name.endswith(".md"):
                found.append(os.path.normpath(os.path.join(folder, name)))
    return found


def read(path, root=ROOT):
    with open(os.path.join(root, path), encoding="utf-8") as file:
        return file.read()


def split(text):
    """(prose lines, blocks): the lines outside of fences, and (language, lines) of each fence."""
    prose, blocks, block = [], [], None
    for line in text.split("\n"):
        fence = FENCE.match(line)
        if fence and block is None:
            block = (fence.group(1), [])
        elif fence:
            blocks.append(block)
            prose.append("")
            block = None
        elif block is not None:
            block[1].append(line)
        else:
            prose.append(line)
    return prose, blocks


def paragraphs(prose):
    """Paragraphs and list items as text; headings, tables, pictures, HTML comments and indented formulas are none."""
    found, now = [], []
    for line in prose + [""]:
        stripped = line.strip()
        ends = not stripped or stripped.startswith(("#", "|", "![", "<!--")) or line.startswith("    ")
        begins = re.match(r"^\s*([-*]|\d+\.)\s+", line)
        if (ends or begins) and now:
            found.append(" ".join(now))
            now = []
        if not ends:
            now.append(re.sub(r"^\s*([-*]|\d+\.)\s+", "", line).strip())
    return found


def cells(prose):
    """Cells of all tables."""
    found = []
    for line in prose:
        if line.lstrip().startswith("|"):
            found += [cell.strip() for cell in re.split(r"(?<!\\)\|", line.strip().strip("|"))]
    return found


def plain(text):
    """Text as it is read: code as one word, links as their text."""
    text = re.sub(r"`+[^`]*`+", "Code", text)
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)
    return re.sub(r"[*_]{1,3}", "", text)


def sentences(paragraph):
    return [s for s in re.split(r"(?<=[.!?])[)\]]?\s+(?=[A-Z(\[<*\d])", plain(paragraph)) if s]


def words(text):
    return len(re.findall(r"[^\s]*\w[^\s]*", plain(text)))


def links(text):
    """Targets of links and pictures, code left out."""
    without_code = re.sub(r"```.*?```", "", text, flags=re.S)
    return re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`\n]*`", "", without_code))


def anchors(text):
    """The anchors that a page's headings get."""
    prose, _ = split(text)
    names = [re.sub(r"^#+\s+", "", line) for line in prose if re.match(r"^#+\s", line)]
    return {re.sub(r"[^\w\- ]", "", name.lower()).replace(" ", "-") for name in names}


def inline_code(prose):
    return re.findall(r"`([^`]+)`", "\n".join(prose))
