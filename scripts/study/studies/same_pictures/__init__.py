"""Whether two builds of lumulus make the same pictures, bit by bit. Renders, references, composites and frames of the
service are made by both programs in small sizes and with few photons; all layers are compared as raw bits (attributes of
the files are not). Prints a Markdown table, one row a case; the exit code is 1 where a picture differs or is not made.

    scripts/study/run same_pictures OLD/lumulus NEW/lumulus --quick
    scripts/study/run same_pictures OLD/lumulus NEW/lumulus --vdb wdas_cloud_sixteenth.vdb
"""

import pathlib
import re
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor

from study.program import ROOT, Failure
from study.studies.same_pictures.difference import difference, pixels_of
from study.studies.same_pictures.frames import frame_cases
from study.studies.same_pictures.renders import render_cases
from study.studies.same_pictures.side import Side
from study.tables import print_head, print_row


def add_options(parser):
    parser.add_argument("old", type=pathlib.Path, help="the executable that made the right pictures")
    parser.add_argument("new", type=pathlib.Path, help="the executable that must make the same ones")
    parser.add_argument("--case", default="", metavar="REGEX", help="only cases whose name this matches somewhere")
    parser.add_argument("--quick", action="store_true", help="a dozen cases that touch most of the program")
    parser.add_argument("--list", action="store_true", help="print the names of the cases and end")
    parser.add_argument("--vdb", type=pathlib.Path, help="wdas_cloud_sixteenth.vdb, without which disney-cloud is left out")
    parser.add_argument("--scenes", type=pathlib.Path, default=ROOT / "configs/scenes",
                        help="folder of scene files (default: that of this checkout)")
    parser.add_argument("--layers", default="", metavar="REGEX",
                        help="compare only layers whose name this matches somewhere, where a build has new ones")
    parser.add_argument("--folder", type=pathlib.Path, help="for the pictures, which stay there (default: gone afterwards)")


def all_cases(options):
    """The cases that the options ask for, in the order of the table."""
    cases = [*render_cases(options.scenes, options.vdb), *frame_cases()]
    wanted = re.compile(options.case)
    return [case for case in cases if wanted.search(case.name) and (case.quick or not options.quick)]


def made(case, side):
    """Layers by name, or the Failure."""
    try:
        return case.make(side)
    except Failure as failure:
        return failure


def row_of(case, pictures, wanted):
    """The cells of a row, and whether the pictures are equal in the wanted layers."""
    failures = [f"{name}: {picture}" for name, picture in zip(("old", "new"), pictures) if isinstance(picture, Failure)]
    if failures:
        return [case.name, "", "", "**not made** " + "; ".join(failures)], False
    old, new = ({name: values for name, values in picture.items() if wanted.search(name)} for picture in pictures)
    found = difference(old, new)
    return [case.name, str(len(old)), pixels_of(old), f"**differs** {found}" if found else "equal"], not found


def compare(cases, sides, wanted):
    """Prints the table; returns how many cases differ."""
    print_head(["case", "layers", "pixels", "result"])
    differing = 0
    with ThreadPoolExecutor(2) as pool:
        for case in cases:
            cells, equal = row_of(case, list(pool.map(lambda side: made(case, side), sides)), wanted)
            differing += not equal
            print_row(cells)
    return differing


def main(options):
    cases = all_cases(options)
    if options.list:
        print("\n".join(case.name for case in cases))
        return 0
    if not cases:
        raise Failure("no case has such a name: --list shows them all")
    start = time.monotonic()
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.folder or pathlib.Path(temporary)
        sides = [Side(program.resolve(), folder.resolve() / name)
                 for program, name in ((options.old, "old"), (options.new, "new"))]
        try:
            differing = compare(cases, sides, re.compile(options.layers))
        finally:
            for side in sides:
                side.close()
    left_out = "" if options.vdb else "; disney-cloud is left out (--vdb names its file)"
    print(f"\n{len(cases) - differing} of {len(cases)} cases are equal{left_out}.")
    print(f"{time.monotonic() - start:.0f} s", file=sys.stderr)
    return 1 if differing else 0
