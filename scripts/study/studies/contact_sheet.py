"""A sheet of all shipped scenes. Each row is marched, billboards, reference and the difference of march and reference in
false colours, each picture with its relMSE.

    scripts/study/run contact_sheet --vdb wdas_cloud_sixteenth.vdb --spp 256 -o docs/images/contact-sheet.png
"""

import pathlib

from PIL import Image, ImageDraw, ImageFont

from study.lumulus import Lumulus, add_common_options, scene_values
from study.pictures import as_image, read_exr, rgb, tone_mapped
from study.program import Failure, size_sets
from study.tables import write_figures

COLUMNS = ["march", "billboards", "reference", "difference"]
LARGEST = 1_000_000  # bytes
BAR = 16  # pixels for the words over a picture
FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"


def shown(path, exposure):
    return as_image(tone_mapped(rgb(read_exr(path)), exposure))


def row_of(lumulus, scene, spp):
    """Four pictures with their words, and the figures."""
    exposure = scene_values(scene).get("image", {}).get("exposure", 0.0)
    truth = lumulus.reference(scene, lumulus.path(scene, "reference"), spp=spp)
    cells, figures = [], {"scene": scene}
    difference = lumulus.path(scene, "difference", suffix=".png")
    for mode in ("march", "billboards"):
        picture = lumulus.path(scene, mode)
        lumulus.render(scene, picture, [f"draw.mode={mode}"])
        found = lumulus.compare(picture, truth, words=["--diff", difference] if mode == "march" else [])
        figures[mode] = found["relmse"] - (found["reference_noise"] or 0.0)
        cells.append((shown(picture, exposure), f"{scene}, {mode}: {figures[mode]:.4f}"))
    cells.append((shown(truth, exposure), f"{scene}, reference"))
    with Image.open(difference) as image:
        cells.append((image.convert("RGB"), f"{scene}, march − reference"))
    return cells, figures


def sheet_of(rows, width, height):
    sheet = Image.new("RGB", (width * len(COLUMNS), (height + BAR) * len(rows)), "white")
    draw, font = ImageDraw.Draw(sheet), ImageFont.truetype(FONT, 10)
    for j, row in enumerate(rows):
        for i, (picture, words) in enumerate(row):
            draw.text((i * width + 3, j * (height + BAR) + 2), words, fill="black", font=font)
            sheet.paste(picture, (i * width, j * (height + BAR) + BAR))
    return sheet


def save(sheet, path):
    """With as few colours as it takes to stay below the limit."""
    for colours in (None, 256, 96, 32):
        image = sheet if colours is None else sheet.quantize(colours, dither=Image.Dither.NONE)
        image.save(path, optimize=True)
        if path.stat().st_size < LARGEST:
            return
    raise Failure(f"{path} is larger than {LARGEST} bytes: make it narrower (--width)")


def add_options(parser):
    add_common_options(parser, width=240)
    parser.add_argument("--scenes", nargs="+")
    parser.add_argument("--spp", type=int, default=128, help="of the references")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)


def main(options):
    lumulus = Lumulus.of(options, size_sets(options.width))
    rows, figures = [], []
    for scene in lumulus.scenes(options.scenes):
        cells, found = row_of(lumulus, scene, options.spp)
        rows.append(cells)
        figures.append(found)
        print(f"{scene}: march {found['march']:.4f}, billboards {found['billboards']:.4f}", flush=True)
    save(sheet_of(rows, options.width, options.width * 9 // 16), options.output)
    write_figures(options, figures)
