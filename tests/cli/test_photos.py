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


def elsewhere(picture, box):
    """How well what is in the box (top, bottom, left, right) correlates with the place that is most
    like it and does not touch it; joints count, light does not."""
    gray = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY).astype(np.float32)
    detail = cv2.GaussianBlur(gray, (0, 0), 1.2) - cv2.GaussianBlur(gray, (0, 0), 10)
    top, bottom, left, right = box
    found = cv2.matchTemplate(detail, detail[top:bottom, left:right], cv2.TM_CCOEFF_NORMED)
    found[max(2 * top - bottom, 0):bottom, max(2 * left - right, 0):right] = -1
    return found.max()


def test_a_roof_keeps_its_rows(folder):
    """Tiles laid by hand, in rows that bend. By chance copies lie half a tile off, and merge.
    Judged with half a tile of roof around the hole: a single copy is like its source anywhere."""
    image, box = IMAGES / "roofs.jpg", (379, 444, 285, 376)
    around = (box[0] - 10, box[1] + 10, box[2] - 10, box[3] + 10)
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
            kept[lattice].append(elsewhere(read(out), around))
    means = {lattice: np.mean(values) for lattice, values in kept.items()}
    print("#", kept, "the roof itself", elsewhere(picture, around))
    check(means[1] > .25 and means[1] > means[0] + .03, kept)


if __name__ == "__main__":
    sys.exit(harness.main(globals()))
