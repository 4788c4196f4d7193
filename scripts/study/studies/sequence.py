"""A sequence of a moving field under a moving sun in one process: seconds a frame, and of those on all cores together, which
other work on the machine hardly changes, beside a process for each frame, whether its memory stays flat, and whether a run
that is killed at random times and goes on with --skip-existing has the same files.
"""

import hashlib
import pathlib
import random
import resource
import subprocess
import time

from study.lumulus import Lumulus, add_common_options
from study.program import Failure
from study.tables import Table, write_figures

SCENE = """
[image]
width = {width}
height = {height}
[camera]
position = [0.0, 2.0, 6000.0]
target = [0.0, 1500.0, 0.0]
vertical_fov = 50.0
[photon_map]
photons = {photons}
[preparation]
samples = 500
[[field]]
kind = "cumulus"
cover = 0.3
base = 1000.0
area = [6000.0, 0.0, 6000.0]
smallest = 500.0
largest = 1500.0
wind = [10.0, 0.0, 3.0]
variants = 3
[animate]
fps = 0.2
"sun.elevation" = [[0, 10.0], [{last}, 50.0]]
"sun.azimuth" = [[0, 20.0], [{last}, 120.0]]
"""


def add_options(parser):
    add_common_options(parser, width=640)
    parser.add_argument("--frames", type=int, default=240)
    parser.add_argument("--photons", type=int, default=100_000)
    parser.add_argument("--alone", type=int, default=6, help="frames that have a process of their own")
    parser.add_argument("--kills", type=int, default=5)


def words_of(lumulus, scene, folder, first, last, *more):
    return list(map(str, [lumulus.program, "render", scene, "--frames", f"{first}-{last}", "-o", folder / "f_####.png",
                          "-o", folder / "f_####.exr", "--quiet", *more]))


def sums(folder):
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(folder.glob("f_*"))}


def resident(process):
    """MiB, 0 where it has ended."""
    try:
        for line in pathlib.Path(f"/proc/{process.pid}/status").read_text().splitlines():
            if line.startswith("VmRSS:"):
                return int(line.split()[1]) / 1024
    except OSError:
        pass
    return 0.0


def cores():
    """Seconds of all cores that processes of before have taken."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def whole(words):
    """Seconds, and MiB every quarter of a second."""
    begin, memory = time.monotonic(), []
    with subprocess.Popen(words) as process:
        while process.poll() is None:
            memory.append(resident(process))
            time.sleep(0.25)
    if process.returncode != 0:
        raise Failure("the sequence failed")
    return time.monotonic() - begin, [mib for mib in memory if mib > 0]


def killed(words, kills, seconds):
    """Runs until the end, killed at random times before. Returns how often that was while it worked."""
    chance, done = random.Random(1), 0
    for _ in range(kills):
        with subprocess.Popen([*words, "--skip-existing"]) as process:
            try:
                process.wait(chance.uniform(0.0, 1.0) * seconds / kills)
            except subprocess.TimeoutExpired:
                process.kill()
                done += 1
    subprocess.run([*words, "--skip-existing"], check=True)
    return done


def main(options):
    lumulus = Lumulus.of(options)
    last = options.frames - 1
    scene = lumulus.path("scene", suffix=".toml")
    scene.write_text(SCENE.format(width=options.width, height=options.width * 9 // 16, photons=options.photons, last=last))
    folders = {name: lumulus.folder / name for name in ("whole", "alone", "killed")}
    for folder in folders.values():
        folder.mkdir(exist_ok=True)
    sets = [word for one in options.set for word in ("--set", one)]
    before = cores()
    seconds, memory = whole(words_of(lumulus, scene, folders["whole"], 0, last, *sets))
    together = (cores() - before) / options.frames
    numbers = sorted({last * i // max(1, options.alone - 1) for i in range(options.alone)})
    begin, before = time.monotonic(), cores()
    for number in numbers:
        subprocess.run(words_of(lumulus, scene, folders["alone"], number, number, *sets), check=True)
    alone = (time.monotonic() - begin) / len(numbers)
    alone_cores = (cores() - before) / len(numbers)
    times = 0
    if options.kills > 0:
        times = killed(words_of(lumulus, scene, folders["killed"], 0, last, *sets), options.kills, seconds)
    files = sums(folders["whole"])
    figures = {"frames": options.frames, "seconds_a_frame": seconds / options.frames, "seconds_alone": alone,
               "core_seconds_a_frame": together, "core_seconds_alone": alone_cores,
               "mib_at_a_fifth": max(memory[: max(1, len(memory) // 5)]), "mib_at_most": max(memory), "killed": times,
               "files": len(files), "equal_alone": all(files[name] == sha for name, sha in sums(folders["alone"]).items()),
               "equal_killed": options.kills == 0 or files == sums(folders["killed"])}
    table = Table(["frames", "s a frame", "in a process each", "of all cores", "in a process each", "MiB in the first fifth",
                   "at most", "killed", "files", "those of single processes are the same", "those of the killed run"])
    table.add(figures, [str(options.frames), f"{figures['seconds_a_frame']:.2f}", f"{alone:.2f}", f"{together:.2f}",
                        f"{alone_cores:.2f}", f"{figures['mib_at_a_fifth']:.0f}",
                        f"{figures['mib_at_most']:.0f}", str(times), str(len(files)),
                        str(figures["equal_alone"]), str(figures["equal_killed"])])
    write_figures(options, table.figures)
    if not (figures["equal_alone"] and figures["equal_killed"]):
        raise Failure("files differ")
