"""What the photos in docs/images show, and how it goes on."""
import sys
from pathlib import Path

import cv2
import numpy as np

import harness
from harness import check, hole, read, recede, report_of, write

IMAGES = Path(__file__).resolve().parents[2] / "docs" / "images"


def test_orient_reads_photos(folder):
    """A road of one family of lines and a pier of two, each with a sky, trees or water."""
    for name, horizon in (("motorway", 310), ("pier", 362)):  # y by hand, level
        report = report_of("orient", IMAGES / f"{name}.jpg", "--mask", IMAGES / f"{name}-mask.png")
        found = report["orientation"]
        height, width = read(IMAGES / f"{name}.jpg").shape[:2]
        focal = width / 2 / np.tan(np.radians(25))
        slant = 90 + np.degrees(np.arctan((horizon - (height - 1) / 2) / focal))
        check(abs(found["slant_deg"] - slant) < 1.5, name, slant, found)
        check(abs(found["tilt_deg"]) < 3, name, found)
        check(found["confidence"] > .5, name, found)


def orient_hole(folder, name, across, down):
    """What is read of a small hole in a photo, whose middle is at these parts of its sides."""
    height, width = read(IMAGES / f"{name}.jpg").shape[:2]
    mask = np.zeros((height, width), np.uint8)
    middle = int(width * across), int(height * down)
    cv2.ellipse(mask, middle, (width // 12, height // 14), 0, 0, 360, 255, -1)
    write(folder / "mask.png", mask)
    return report_of("orient", IMAGES / f"{name}.jpg", "--mask", folder / "mask.png")["orientation"]


def test_orient_takes_level_floors_for_likelier(folder):
    """On a road, of which lines, cars and verges tell other planes as well."""
    for across, down, least in ((.8, .6, .5), (.4, .88, 0), (.6, .6, .6)):
        found = orient_hole(folder, "motorway", across, down)
        check(abs(found["slant_deg"] - 92) < 3 and abs(found["tilt_deg"]) < 6, across, down, found)
        check(found["confidence"] > least, across, down, found)


def test_orient_reads_a_roof_among_roofs(folder):
    """The photo as a whole is a floor of roofs; beside the hole there is one, which is surer."""
    found = orient_hole(folder, "roofs", .4, .75)
    check(abs(found["slant_deg"] - 55) < 6 and abs(found["tilt_deg"]) < 6, found)
    check(found["confidence"] > .5, found)


def test_orient_looks_beside_the_source(folder):
    """Planks alone do not tell where a pier leads; its edges do, which are no source."""
    picture, source = IMAGES / "pier.jpg", folder / "planks.png"
    planks = np.array([(564, 424), (648, 424), (960, 800), (204, 800)])
    write(source, cv2.fillPoly(np.zeros((800, 1200), np.uint8), [planks], 255))
    words = "orient", picture, "--mask", IMAGES / "pier-mask.png"
    check(report_of(*words, "--source", source)["orientation"] == report_of(*words)["orientation"])


def likeness(picture, other, box):
    """How well two pictures correlate in the box (top, bottom, left, right); joints count, light
    does not."""
    detail = []
    for one in picture, other:
        gray = cv2.cvtColor(one, cv2.COLOR_BGR2GRAY).astype(np.float32)
        bands = cv2.GaussianBlur(gray, (0, 0), 1.2) - cv2.GaussianBlur(gray, (0, 0), 10)
        detail.append(bands[box[0]:box[1], box[2]:box[3]].ravel())
    return np.corrcoef(*detail)[0, 1]


def test_a_roof_keeps_its_rows(folder):
    """Tiles laid by hand, in rows that bend. Each may have another's colour, but lies where it did;
    by chance copies lie half a tile off, and merge."""
    image, box = IMAGES / "roofs.jpg", (379, 444, 285, 376)
    picture = read(image)
    mask = write(folder / "mask.png", hole(*picture.shape[:2], box))
    slope = np.array([(205, 296), (339, 301), (474, 416), (422, 478), (141, 478), (173, 406)])
    source = cv2.fillPoly(np.zeros(picture.shape[:2], np.uint8), [slope], 255)
    source = write(folder / "source.png", source)
    kept = {}
    for lattice in 1, 0:
        kept[lattice] = []
        for seed in range(1 if harness.SANITIZED else 3):
            out = folder / f"{lattice}-{seed}.png"
            recede("fill", image, "--mask", mask, "--source", source, "-o", out, "--frontal", "-q",
                   "--seed", seed, "--set", f"engine-lattice={lattice}")
            kept[lattice].append(likeness(read(out), picture, box))
    means = {lattice: np.mean(values) for lattice, values in kept.items()}
    print("#", kept)
    check(means[1] > .78 and means[1] > means[0] + .04, kept)


def test_a_bent_crack_goes_on(folder):
    """The road runs along its lanes, but a crack across it bends, and is no edge of boards: moved
    along them it ends after a third of the hole."""
    image, middle = IMAGES / "motorway.jpg", (180, 476)
    mask = cv2.ellipse(np.zeros((540, 960), np.uint8), middle, (79, 53), 0, 0, 360, 255, -1)
    mask, out, kept = write(folder / "mask.png", mask), folder / "out.png", []
    for seed in range(1 if harness.SANITIZED else 3):
        recede("fill", image, "--mask", mask, "-o", out, "--horizon", "0,310,960,310", "-q",
               "--seed", seed, "--force")
        gray = cv2.cvtColor(read(out), cv2.COLOR_BGR2GRAY).astype(float)
        lighter = []
        for x in range(middle[0] - 76, middle[0] + 77):
            y = round(476 + (x - 70) * 5 / 277)
            lighter.append(gray[y - 1:y + 2, x].max() - np.median(gray[y - 8:y + 9, x]))
        kept.append(np.mean(np.array(lighter) > 6))
    print("#", kept)
    check(np.mean(kept) > .4, kept)


def test_light_is_not_negative(folder):
    """A roof in linear light, its hole's surroundings bright and black: what is joined gets no
    darker than black."""
    light = (read(IMAGES / "roofs.jpg").astype(np.float32) / 255) ** 2.2
    image = write(folder / "light.tif", light)
    mask, out = IMAGES / "roofs-mask.png", folder / "out.tif"
    recede("fill", image, "--mask", mask, "-o", out, "--frontal", "-q")
    out = cv2.imread(str(out), cv2.IMREAD_UNCHANGED)
    check(out.dtype == np.float32 and out.min() >= 0, out.dtype, out.min())
    check((out != light).any(), "nothing was filled")


def test_the_c_library_changes_nothing(folder):
    """It chooses other code by processor, whose sines and powers have other last bits. Angles are
    estimated by them."""
    if harness.SANITIZED:
        raise harness.Skip("the C library is the same there")
    plain = "glibc.cpu.hwcaps=-AVX2,-AVX512F,-FMA,-AVX2_Usable,-FMA_Usable"
    for name in "motorway", "roofs":
        made = []
        for environment in {}, {"GLIBC_TUNABLES": plain}:
            out = folder / f"{name}-{len(made)}.png"
            recede("fill", IMAGES / f"{name}.jpg", "--mask", IMAGES / f"{name}-mask.png", "-o", out,
                   "-q", environment=environment)
            made.append(out.read_bytes())
        check(made[0] == made[1], name)


if __name__ == "__main__":
    sys.exit(harness.main(globals()))
