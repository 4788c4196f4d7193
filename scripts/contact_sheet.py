#!/usr/bin/python3
"""A sheet of all shipped scenes: marched, billboards, reference and the difference of march and reference in false
colours, each picture with its relMSE. Needs Debian's python3-pil and python3-numpy.

    scripts/contact_sheet.py --vdb wdas_cloud_sixteenth.vdb --spp 256 -o docs/images/contact-sheet.png
"""

import pathlib

from measuring import Failure, Lumulus, finish, parser_of, read_exr, run, scene_values, size_sets

try:
    import numpy
    from PIL import Image, ImageDraw, ImageFont
except ImportError as missing:
    raise SystemExit(f"contact_sheet.py: {missing}: as root, run apt-get install python3-pil python3-numpy")

COLUMNS = ["march", "billboards", "reference", "difference"]
LARGEST = 1_000_000  # bytes
BAR = 16  # pixels for the words over a picture
FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"


def tone_mapped(path, exposure):
    """As base/tonemap.cpp: Narkowicz 2015, sRGB; without its dither, which would not compress."""
    width, height, layers, _ = read_exr(path)
    x = numpy.array([layers[name] for name in "RGB"], dtype=float).T.reshape(height, width, 3) * 2.0**exposure
    x = numpy.clip(x, 0.0, 1e6)
    x = numpy.minimum(1.0, x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14))
    x = numpy.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1.0 / 2.4) - 0.055)
    return Image.fromarray((255.0 * x + 0.5).astype("uint8"))


def row_of(lumulus, scene, spp):
    """Four pictures with their words."""
    exposure = scene_values(scene).get("image", {}).get("exposure", 0.0)
    truth = lumulus.reference(scene, lumulus.path(scene, "reference"), spp=spp)
    cells, figures = [], {"scene": scene}
    difference = lumulus.path(scene, "difference", suffix=".png")
    for mode in ("march", "billboards"):
        picture = lumulus.path(scene, mode)
        lumulus.render(scene, picture, [f"draw.mode={mode}"])
        found = lumulus.compare(picture, truth, words=["--diff", difference] if mode == "march" else [])
        figures[mode] = found["relmse"] - (found["reference_noise"] or 0.0)
        cells.append((tone_mapped(picture, exposure), f"{scene}, {mode}: {figures[mode]:.4f}"))
    cells.append((tone_mapped(truth, exposure), f"{scene}, reference"))
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


def main():
    parser = parser_of(__doc__, width=240)
    parser.add_argument("--scenes", nargs="+")
    parser.add_argument("--spp", type=int, default=128, help="of the references")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    options = parser.parse_args()
    lumulus = Lumulus(options)
    lumulus.sets += size_sets(options.width)
    rows, figures = [], []
    for scene in lumulus.scenes(options.scenes):
        cells, found = row_of(lumulus, scene, options.spp)
        rows.append(cells)
        figures.append(found)
        print(f"{scene}: march {found['march']:.4f}, billboards {found['billboards']:.4f}", flush=True)
    save(sheet_of(rows, options.width, options.width * 9 // 16), options.output)
    finish(options, figures)


if __name__ == "__main__":
    run(main)
