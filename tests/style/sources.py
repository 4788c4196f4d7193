"""Reads the sources of the repository for the style tests: which files there are, and their code without comments."""
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ("src", "vdb", "service", "shaders", "scripts", "tests", "cmake", ".ci")
SKIPPED = ("tests/fuzz/corpus/", "__pycache__")
BRACES = (".cpp", ".h", ".comp", ".glsl", ".js")

# One alternative for each kind of text that is no code: comments, raw strings, strings, characters.
# An apostrophe between digits separates thousands and starts no character.
NO_CODE = re.compile(
    r'(?P<line>//(?:[^\n\\]|\\.|\\\n)*)|(?P<block>/\*.*?\*/)'
    r'|R"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)"'
    r'|"(?:[^"\\\n]|\\.)*"|`(?:[^`\\]|\\.)*`'
    r"|(?<![0-9a-fA-F])'(?:[^'\\\n]|\\.)+'", re.DOTALL)


def files(folders=FOLDERS, suffixes=None):
    """Paths of the files below the folders (relative to the root, sorted), of the given suffixes or all."""
    found = []
    for folder in folders:
        top = ROOT / folder
        below = [top] if top.is_file() else sorted(top.rglob("*"))
        for path in below:
            name = path.relative_to(ROOT).as_posix()
            if not path.is_file() or any(part in name for part in SKIPPED):
                continue
            if suffixes is None or path.suffix in suffixes:
                found.append(name)
    return found


def read(name):
    """Text of a file, by its name relative to the root."""
    return (ROOT / name).read_text(encoding="utf-8")


def without_comments(text):
    """The code with comments and the insides of strings replaced by spaces. Lines keep their numbers."""
    def blank(match):
        kept = '""' if match.group("line") is None and match.group("block") is None else "  "
        return kept[0] + re.sub(r"[^\n]", " ", match.group(0)[1:-1]) + kept[1]
    return NO_CODE.sub(blank, text)


def comments(text):
    """(line number, text) of each line of each comment."""
    found = []
    for match in NO_CODE.finditer(text):
        if match.group("line") is None and match.group("block") is None:
            continue
        first = text.count("\n", 0, match.start()) + 1
        found += [(first + i, line) for i, line in enumerate(match.group(0).split("\n"))]
    return found


def strings(text):
    """(line number, text) of each line of each string."""
    found = []
    for match in NO_CODE.finditer(text):
        if match.group(0)[0] in "\"R`":
            first = text.count("\n", 0, match.start()) + 1
            found += [(first + i, line) for i, line in enumerate(match.group(0).split("\n"))]
    return found
