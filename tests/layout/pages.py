#!/usr/bin/env python3
"""Checks that the repository's pages stay manuals: short sentences and paragraphs, links that resolve, a line for every folder.

What a page names in code must be there: files, functions, and the DCA chapter's equations, each once in src/dca and in its page.
Pages and code use the field's words.
usage: pages.py [ROOT]
"""
import os
import re
import sys

import markdown

LONG_SENTENCE, LONG_SHARE = 40, 0.05
LONGEST_PARAGRAPH, LONGEST_CELL = 120, 60
FIRST_PAGE = "README.md"  # shorter in everything: bytes, words of a sentence, words of a paragraph
FIRST_BYTES, FIRST_SENTENCE, FIRST_PARAGRAPH = 8192, 30, 80
ROOMS = ("src", "cuda", "mpi", "tests")
CODE = (".hpp", ".cpp", ".cuh", ".cu", ".py")
WRITTEN = {"my.yaml", "scene.yaml", "summary.json", "timeline.json", "report.json", "network.json", "figures.json",
           "error.py", "density.py", "a.json", "boom.json"}  # by users and programs
MATHEMATICS, EQUATIONS = "src/dca/README.md", range(1, 13)
RETIRED = re.compile(r"\bhinges?\b", re.IGNORECASE)  # the field's word is revolute
DEEPEST = 3  # below lie inputs that the line of their folder stands for


def check_prose(path, text):
    prose, _ = markdown.split(text)
    paragraphs = markdown.paragraphs(prose)
    counts = [markdown.words(s) for p in paragraphs for s in markdown.sentences(p)]
    long = [c for c in counts if c > LONG_SENTENCE]
    if len(long) > LONG_SHARE * len(counts):
        yield f"{path}: {len(long)} of {len(counts)} sentences have more than {LONG_SENTENCE} words"
    for paragraph in paragraphs:
        if markdown.words(paragraph) > LONGEST_PARAGRAPH:
            yield f"{path}: a paragraph has {markdown.words(paragraph)} words: {paragraph[:60]}..."
    for cell in markdown.cells(prose):
        if markdown.words(cell) > LONGEST_CELL:
            yield f"{path}: a table's cell has {markdown.words(cell)} words: {cell[:60]}..."


def check_first_page(text):
    if len(text.encode()) > FIRST_BYTES:
        yield f"{FIRST_PAGE} has {len(text.encode())} bytes, more than {FIRST_BYTES}"
    for paragraph in markdown.paragraphs(markdown.split(text)[0]):
        if markdown.words(paragraph) > FIRST_PARAGRAPH:
            yield f"{FIRST_PAGE}: a paragraph has {markdown.words(paragraph)} words: {paragraph[:60]}..."
        for sentence in markdown.sentences(paragraph):
            if markdown.words(sentence) > FIRST_SENTENCE:
                yield f"{FIRST_PAGE}: a sentence has {markdown.words(sentence)} words: {sentence[:60]}..."


def check_links(root, path, text):
    for target in markdown.links(text):
        if "://" in target or target.startswith("mailto:"):
            continue
        file, _, anchor = target.partition("#")
        resolved = os.path.normpath(os.path.join(os.path.dirname(path), file)) if file else path
        if not os.path.exists(os.path.join(root, resolved)):
            yield f"{path}: the link {target} leads nowhere"
        elif anchor and resolved.endswith(".md") and anchor not in markdown.anchors(markdown.read(resolved, root)):
            yield f"{path}: the link {target} names no heading"


def named_folders(path, text):
    """Folders that a page names in code, relative to the root: as written, and as seen from the page's folder."""
    prose, _ = markdown.split(text)
    for code in markdown.inline_code(prose):
        name = code.rstrip("/")
        yield os.path.normpath(name)
        yield os.path.normpath(os.path.join(os.path.dirname(path), name))


def check_folders(root, texts):
    named = {folder for path, text in texts.items() if path.endswith("README.md") for folder in named_folders(path, text)}
    for folder in markdown.folders(root):
        parts = folder.split(os.sep)
        if parts[0] in ROOMS and len(parts) <= DEEPEST and folder not in named:
            yield f"{folder}/: no README has a line that says what belongs there"


def sources(root):
    """All text of the code, and the names of its files."""
    texts, names = [], set()
    for folder in markdown.folders(root):
        for name in os.listdir(os.path.join(root, folder)):
            names.add(name)
            if folder.split(os.sep)[0] in ROOMS and name.endswith(CODE):
                texts.append((os.path.join(folder, name), markdown.read(os.path.join(folder, name), root)))
    return texts, names


def check_names(path, text, words, names):
    """Files and functions that a page names must be there."""
    for code in markdown.inline_code(markdown.split(text)[0]):
        file = re.fullmatch(r"(?:[\w.-]+/)*([\w.-]+\.(?:hpp|cpp|cuh|cu|py|sh|yaml|json))", code)
        if file and file[1] not in names and file[1] not in WRITTEN:
            yield f"{path}: there is no file {code}"
        function = re.fullmatch(r"(?:\w+::)*(\w+)\(\)", code)
        if function and function[1] not in words:
            yield f"{path}: there is no function {code}"


def check_vocabulary(texts):
    """No word that the glossary has replaced."""
    for path, text in texts:
        for found in RETIRED.finditer(text):
            yield f"{path}, line {text.count(chr(10), 0, found.start()) + 1}: `{found[0]}` is called revolute here"


def numbers_of(text):
    """Equations of the chapter that a text names, ranges as all of theirs."""
    for first, last in re.findall(r"\b2\.(\d+)(?:-2\.(\d+))?", text):
        yield from range(int(first), int(last or first) + 1)


def check_equations(texts, page):
    """Each of the chapter's equations is named once in src/dca, and once in the table of its page."""
    joined = (re.sub(r"\n\s*//+ *", " ", text) for path, text in texts if path.startswith("src/dca/"))
    cited = " ".join(found for text in joined for found in re.findall(r"chapter, eqs? ([\d.,\s-]+)", text))
    tabled = " ".join(line.split("|")[1] for line in page.split("\n") if re.match(r"\| 2\.\d", line))
    for where, text in (("src/dca", cited), ("src/dca/README.md", tabled)):
        found = sorted(numbers_of(text))
        if found != list(EQUATIONS):
            yield f"{where}: equations of the chapter named {found}, not each of 1 to {EQUATIONS[-1]} once"


def main():
    root = sys.argv[1] if len(sys.argv) > 1 else markdown.ROOT
    texts = {path: markdown.read(path, root) for path in markdown.pages(root)}
    faults = list(check_first_page(texts[FIRST_PAGE]))
    for path, text in texts.items():
        faults += check_prose(path, text)
        faults += check_links(root, path, text)
    faults += check_folders(root, texts)
    code, names = sources(root)
    words = set(re.findall(r"\w+", " ".join(text for _, text in code)))
    for path, text in texts.items():
        faults += check_names(path, text, words, names)
    faults += check_vocabulary([*code, *texts.items()])
    if MATHEMATICS in texts:
        faults += check_equations(code, texts[MATHEMATICS])
    print("\n".join(faults) if faults else f"{len(texts)} pages are in order")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
