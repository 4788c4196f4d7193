#!/usr/bin/python3
"""Fails where one of the private words of early versions stands in a comment, a string (help, errors) or a document.

WORDS has each word with the term of the field to write instead. words_exceptions.txt has the phrases in which such a
word is plain English, each with its reason; an exception that nothing needs any more fails too. docs/experiments is the
laboratory record and keeps its words.
"""
import re
import sys
import pathlib

import sources

# The folders whose texts are checked. To widen: sources.FOLDERS + ("docs", "README.md", "configs").
CHECKED = ("src", "shaders", "service", "vdb", "docs", "README.md", "configs", "scripts", "tests/style")
SKIPPED = ("docs/experiments/", "docs/images/", "tests/style/words_")

WORDS = {
    r"turn(?:s|ed|ing)?": "scattering event, scattered",
    r"lattices?": "sampling grid (sparse sampling)",
    r"halves|half-?way points?": "refinement (blocks); even and odd generations, split sums (photon map)",
    r"bends?|bent": "needs refinement",
    r"stretch(?:es|ed)?": "ray segment",
    r"deposit(?:s|ed|ing)?": "collision estimator",
    r"sun(?:'s)? depths?": "shadow volume (grid), optical depth to the sun (value)",
    r"decay(?:s|ed|ing)?": "ageing",
}


def texts(name):
    """(line number, text) of all that is written for people in a file."""
    text = sources.read(name)
    if name.endswith(sources.BRACES):
        return sources.comments(text) + sources.strings(text)
    return list(enumerate(text.split("\n"), 1))


def exceptions():
    """The phrases that are plain English, as compiled patterns by their text."""
    lines = (pathlib.Path(__file__).parent / "words_exceptions.txt").read_text(encoding="utf-8").split("\n")
    phrases = [line.split("#")[0].strip() for line in lines]
    return {phrase: re.compile(rf"\b(?:{phrase})\b", re.IGNORECASE) for phrase in phrases if phrase}


def main():
    allowed, used, found, checked = exceptions(), set(), [], 0
    words = {re.compile(rf"\b(?:{word})\b", re.IGNORECASE): instead for word, instead in WORDS.items()}
    for name in sources.files(CHECKED, sources.BRACES + (".py", ".md", ".toml", ".txt", ".html", ".cmake", ".sh")):
        if name.startswith(SKIPPED):
            continue
        checked += 1
        for line, text in texts(name):
            for phrase, pattern in allowed.items():
                text, times = pattern.subn(lambda match: " " * len(match.group(0)), text)
                used.update([phrase] if times else [])
            for pattern, instead in words.items():
                found += [f'{name}:{line}: "{match.group(0)}": write {instead}' for match in pattern.finditer(text)]
    found += [f'words_exceptions.txt: nothing needs "{phrase}" any more' for phrase in sorted(set(allowed) - used)]
    print("\n".join(found) if found else f"{checked} files without private words")
    return 1 if found or checked == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
