#!/usr/bin/env python3
"""Checks that the repository's pages stay manuals: short sentences and paragraphs, links that resolve, a line for every folder.

usage: pages.py [ROOT]
"""
import os
import sys

import markdown

LONG_SENTENCE, LONG_SHARE = 40, 0.05
LONGEST_PARAGRAPH, LONGEST_CELL = 120, 60
FIRST_PAGE = "README.md"  # shorter in everything: bytes, words of a sentence, words of a paragraph
FIRST_BYTES, FIRST_SENTENCE, FIRST_PARAGRAPH = 8192, 30, 80
ROOMS = ("src", "cuda", "mpi", "tests")
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


def main():
    root = sys.argv[1] if len(sys.argv) > 1 else markdown.ROOT
    texts = {path: markdown.read(path, root) for path in markdown.pages(root)}
    faults = list(check_first_page(texts[FIRST_PAGE]))
    for path, text in texts.items():
        faults += check_prose(path, text)
        faults += check_links(root, path, text)
    faults += check_folders(root, texts)
    print("\n".join(faults) if faults else f"{len(texts)} pages are in order")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
