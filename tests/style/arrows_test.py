#!/usr/bin/python3
"""Checks who may know whom: the link lines of CMakeLists.txt files and the #include lines of C++ sources.

docs/architecture.md draws the libraries in levels (LEVELS_AFTER marks the drawing). Fails where a library links one of
its own level or of a level above, where a library is missing in the drawing, where a source includes a header of a
library that its own does not link, and where one of the rules below is broken. Before the check, the made-up links of
MISTAKES have to be found: a test that cannot fail shows nothing.
"""
import re
import sys

import sources

DRAWING = "docs/architecture.md"
LEVELS_AFTER = "tests/style/arrows_test.py reads this drawing"
FOLDERS = ("src", "service", "vdb")

# The only libraries of ours that these may reach by their links, directly or not.
ONLY = {
    "reference": {"view", "scene", "mesh", "volume", "vdb", "base"},  # the oracle rule
}
# Libraries of ours that these must not reach.
NEVER = {
    "protocol": {"render", "service_render", "service", "gpu"},
    "service_render": {"protocol", "service", "messages"},
    "client": {"render", "service_render", "service", "protocol"},
}
# Libraries of others, and the only ones of ours that may link them.
OWNERS = {
    "Boost::headers": {"service", "client", "medium"},  # Asio and Beast; Math
    "OpenVDB::openvdb": {"vdb"},
    "Vulkan::Headers": {"volk"},
    "lumulus_volk": {"gpu"},
    "PkgConfig::Systemd": {"service"},
}
# Link lines that must not pass, each with a part of what is said of it.
MISTAKES = {
    "target_link_libraries(lumulus_base PUBLIC lumulus_render)": "base links render, which stands above it",
    "target_link_libraries(lumulus_draw PRIVATE lumulus_fog)": "draw links fog, which stands beside it",
    "target_link_libraries(lumulus_reference PRIVATE lumulus_medium)": "reference reaches medium",
    "target_link_libraries(lumulus_protocol PRIVATE lumulus_render)": "protocol reaches render",
    "target_link_libraries(lumulus_service_render PRIVATE lumulus_protocol)": "service_render reaches protocol",
    "target_link_libraries(lumulus_service_render PRIVATE Boost::headers)": "service_render links Boost::headers",
    "target_link_libraries(lumulus_cloud PRIVATE lumulus_volk)": "cloud links lumulus_volk",
    "lumulus_library(lumulus_new SOURCES new.cpp PUBLIC lumulus_base)": "new is not in the drawing",
}

CALL = re.compile(r"\b(lumulus_library|add_library|add_executable|target_link_libraries)\s*\(([^()]*)\)")
KEYWORDS = {"SOURCES", "PUBLIC", "PRIVATE", "INTERFACE", "STATIC", "OBJECT"}


def short(name):
    """Name of a library of ours as the drawing has it, or the name of one of others."""
    return name[len("lumulus_"):] if name.startswith("lumulus_") else name


def links_of(files):
    """(links by library, folder by library) of CMakeLists.txt files, given as (folder, text)."""
    links, folders = {}, {}
    for folder, text in files:
        for call, arguments in CALL.findall(re.sub(r"#.*", "", text)):
            name, *words = arguments.split()
            if "$" in name or not name.startswith("lumulus"):
                continue
            if call != "target_link_libraries":
                folders[short(name)] = folder
            # the objects of a library are a link too
            words = [re.sub(r"^\$<TARGET_OBJECTS:(\w+)>$", r"\1", word) for word in words]
            links.setdefault(short(name), set()).update(
                word for word in words if word not in KEYWORDS and (word.startswith("lumulus_") or "::" in word))
    return links, folders


def levels():
    """Level of each library in the drawing, counted from the top."""
    found, after = {}, sources.read(DRAWING).split(LEVELS_AFTER, 1)[1]
    lines = after.split("\n\n", 2)[1].split("\n")
    for level, line in enumerate(lines):
        for name in re.split(r" {2,}", line.strip(" │▼"))[0].split(", "):
            found[name] = level
    return found


def reached(links, name):
    """All libraries of ours that a library links, directly or not."""
    found, waiting = set(), [name]
    while waiting:
        for link in links.get(waiting.pop(), ()):
            if link.startswith("lumulus_") and short(link) not in found:
                found.add(short(link))
                waiting.append(short(link))
    return {link for link in found if link != "options" and not link.endswith("_shaders")}


def offending_links(links, level):
    """What is wrong with the link lines, a sentence each."""
    found = [f"{name} is not in the drawing of {DRAWING}" for name in sorted(links) if name not in level]
    for name, linked in sorted(links.items()):
        for link in sorted(linked):
            other = short(link)
            if link in OWNERS and name not in OWNERS[link]:
                found.append(f"{name} links {link}, which only {', '.join(sorted(OWNERS[link]))} may")
            if name in level and other in level and level[other] <= level[name]:
                where = "above" if level[other] < level[name] else "beside"
                found.append(f"{name} links {other}, which stands {where} it")
        below = reached(links, name)
        wrong = (below - ONLY[name] if name in ONLY else set()) | (below & NEVER.get(name, set()))
        found += [f"{name} reaches {other} by its links, which it must not know" for other in sorted(wrong)]
    return found


def offending_includes(links, folders):
    """Sources that include a header of a library that their own library does not link."""
    library = {}
    for name, folder in folders.items():
        library.setdefault(folder, set()).add(name)

    def owners(path):
        """Libraries of the nearest folder that has some."""
        while "/" in path:
            path = path.rsplit("/", 1)[0]
            if path in library:
                return path, library[path]
        return None, set()

    found = []
    for name in sources.files(FOLDERS, (".cpp", ".h")):
        home, own = owners(name)
        below = set().union(*(reached(links, library_name) for library_name in own))
        for header in re.findall(r'^#include "([^"]+)"', sources.read(name), re.MULTILINE):
            place = next((path for path in (f"src/{header}", header) if (sources.ROOT / path).is_file()), "")
            folder, others = owners(place)
            if folder is not None and folder != home and not others & below:
                found.append(f"{name} includes {header}, but {', '.join(sorted(own))} does not link its library")
    return found


def main():
    files = [(name.rsplit("/", 1)[0], sources.read(name)) for name in sources.files(FOLDERS, (".txt",))
             if name.endswith("CMakeLists.txt")]
    links, folders = links_of(files)
    level = levels()
    found = offending_links(links, level) + offending_includes(links, folders)
    for mistake, sentence in MISTAKES.items():
        wrong, _ = links_of(files + [("src/made_up", mistake)])
        if not any(sentence in text for text in offending_links(wrong, level)):
            found.append(f'"{mistake}" was not found to be wrong')
    unknown = sorted(set(level) - set(links) - set(folders))
    found += [f"{DRAWING} draws {name}, which is no library" for name in unknown]
    print("\n".join(found) if found else f"{len(links)} libraries link downwards only")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
