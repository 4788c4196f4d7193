#!/usr/bin/python3
"""Checks the sizes of STYLE: one idea a file, one thing a function.

Fails where a file has more than 400 lines (a test 600, a shader 200), a function more than 60, or the GPU layer more
than 1,800 lines in total. Prints one line for each offender. With --list it prints the longest functions instead.
"""
import argparse
import ast
import re
import sys

import sources

FILE_LIMIT, TEST_LIMIT, SHADER_LIMIT, FUNCTION_LIMIT, GPU_LIMIT = 400, 600, 200, 60, 1800
SUFFIXES = sources.BRACES + (".py", ".sh", ".html", ".css", ".cmake", ".txt")

# What a brace opens when it opens no function: a scope that may hold functions, or data.
SCOPE = re.compile(r"^\s*(?:template\s*<[^{]*>\s*)?(?:export\s+)?(?:inline\s+)?"
                   r"(?:namespace|class|struct|union|enum|extern\s*\"|layout\s*\()")
FUNCTION = re.compile(r"\)\s*(?:const|noexcept|override|final|mutable|&|->[^;{}]*|:[^;]*|requires[^;{}]*|=>|\s)*$")
INITIALISER = re.compile(r"[\w>]\s*$")  # `name{`: braces that hold a value
INITIALISER_LIST = re.compile(r"\)[^{}()]*[^:]:[^:].*[\w>]\s*$", re.DOTALL)  # the same before a constructor's body


def file_limit(name):
    """Most lines that a file of this name may have."""
    if name.startswith("tests/"):
        return TEST_LIMIT
    return SHADER_LIMIT if name.endswith((".comp", ".glsl")) else FILE_LIMIT


def opens_function(head):
    """Whether the text before a brace, since the last brace or semicolon, is the head of a function."""
    if SCOPE.match(head) or INITIALISER_LIST.search(head) or not FUNCTION.search(head):
        return False
    before = re.sub(r"operator\s*[^\s(]+", "", head).split("(")[0]
    return "=" not in before or head.rstrip().endswith("=>")


def brace_functions(text):
    """(first line, lines, name) of each function of C++, GLSL or JavaScript that stands in no other function."""
    code = re.sub(r"^[ \t]*#(?:[^\n\\]|\\.|\\\n)*", lambda m: re.sub(r"[^\n]", " ", m.group(0)),
                  sources.without_comments(text), flags=re.MULTILINE | re.DOTALL)
    found, stack, start, parentheses = [], [], 0, 0
    for match in re.finditer(r"[{};()]", code):
        mark, at = match.group(0), match.start()
        if mark in "()":
            parentheses += 1 if mark == "(" else -1
        elif mark == "{":
            inside = any(kind == "function" for kind, *_ in stack)
            head = code[start:at]
            kind = "function" if not inside and parentheses == 0 and opens_function(head) else "other"
            # `b = {}` among the arguments, `member_{value}` before a constructor's body: the head goes on behind it
            if kind == "other" and (parentheses > 0 or INITIALISER.search(head) and not SCOPE.match(head)):
                kind = "initialiser"
            stack.append((kind, start + len(head) - len(head.lstrip()), parentheses))
            start, parentheses = at + 1 if kind != "initialiser" else start, 0
        elif mark == "}":
            kind, first, parentheses = stack.pop()  # the parentheses that are open around the brace
            if kind == "initialiser":
                start = first
                continue
            if kind == "function":
                name = re.search(r"([\w:~]+|operator\S+)\s*\(", code[first:at])
                lines = code.count("\n", first, at) + 1
                found.append((code.count("\n", 0, first) + 1, lines, name.group(1) if name else "?"))
            start = at + 1
        elif parentheses == 0:
            start = at + 1
    return found


def python_functions(text):
    """(first line, lines, name) of each function of a Python file."""
    return [(node.lineno, node.end_lineno - node.lineno + 1, node.name) for node in ast.walk(ast.parse(text))
            if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))]


def is_python(name, text):
    """Whether a file is Python, by its suffix or its first line."""
    return name.endswith(".py") or (text.startswith("#!") and "python" in text.split("\n", 1)[0])


def functions(name, text):
    """The functions of a file, whatever its language; none of a language that has no braces."""
    if is_python(name, text):
        return python_functions(text)
    return brace_functions(text) if name.endswith(sources.BRACES) else []


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--list", type=int, metavar="N", help="print the N longest functions")
    options = parser.parse_args()
    offenders, all_functions = [], []
    for name in sources.files(suffixes=SUFFIXES + ("",)):
        text = sources.read(name)
        lines = text.count("\n")
        if lines > file_limit(name):
            offenders.append(f"{name}: {lines} lines, at most {file_limit(name)}")
        for line, length, function in functions(name, text):
            all_functions.append((length, f"{name}:{line}: {function} has {length} lines, at most {FUNCTION_LIMIT}"))
    offenders += [text for length, text in all_functions if length > FUNCTION_LIMIT]
    layer = sum(sources.read(name).count("\n") for name in sources.files(["src/gpu"], (".cpp", ".h")))
    if layer > GPU_LIMIT:
        offenders.append(f"src/gpu: {layer} lines in total, at most {GPU_LIMIT}")
    if options.list:
        print("\n".join(text for _, text in sorted(all_functions, reverse=True)[:options.list]))
        return 0
    print("\n".join(offenders) if offenders else f"{len(all_functions)} functions within the limits")
    return 1 if offenders or not all_functions else 0


if __name__ == "__main__":
    sys.exit(main())
