"""recede scale-map: the values against the camera's geometry, done again here with matrices."""
import sys

import numpy as np

import harness
from harness import check, read, recede, report_of, texture, write


def plane_w(width, height, slant, tilt, fov):
    """Inverse depth of the plane at every pixel, by intersecting each pixel's ray with it."""
    focal = max(width, height) / 2 / np.tan(np.radians(fov) / 2)
    slant, tilt = np.radians([slant, tilt])
    # The plane recedes towards (sin tilt, -cos tilt): there the normal leans away from.
    normal = np.array([-np.sin(slant) * np.sin(tilt), np.sin(slant) * np.cos(tilt), np.cos(slant)])
    ys, xs = np.mgrid[:height, :width]
    rays = np.stack([(xs - (width - 1) / 2) / focal, (ys - (height - 1) / 2) / focal,
                     np.ones(xs.shape)])
    return np.tensordot(normal, rays, 1)


def made(folder, *more, size=(64, 48)):
    out = folder / "map.exr"
    report = report_of("scale-map", "--size", f"{size[0]}x{size[1]}", *more, "-o", out, "--force",
                       "-q")
    return read(out).astype(float), report


def test_values(folder):
    for slant, tilt, fov in ((0, 0, 50), (30, 0, 50), (60, 20, 50), (75, -150, 70), (85, 90, 40),
                             (95, 0, 60), (110, 45, 90)):
        w = plane_w(64, 48, slant, tilt, fov)
        options = ["--slant", slant, "--tilt", tilt, "--fov", fov]
        for kind, power in (("across", 1), ("along", 2), ("area", 3)):
            values, report = made(folder, *options, "--kind", kind)
            scale = report["scale"]
            x, y = scale["reference_x"], scale["reference_y"]
            reference = np.interp(0, [0], [w[int(y), int(x)]])
            if (x % 1, y % 1) != (0, 0):  # the centre lies between four pixels
                reference = w[int(y):int(y) + 2, int(x):int(x) + 2].mean()
            expected = np.where(w > 0, (np.maximum(w, 1e-12) / reference) ** power, np.nan)
            if power > 1:
                expected *= reference
            there = w > 1e-3
            off = abs(values[there] / expected[there] - 1).max()
            check(off < 2e-5, (slant, tilt, fov, kind), "off by", off)
            check(np.isnan(values[w < -1e-3]).all(), "values beyond the horizon")


def test_the_papers_equations(folder):
    """Eqs 1-3: from 1/cos(slant) near to cos(slant) far along the tilt, linear between."""
    for slant, tilt in ((30, 0), (45, 0), (60, 90)):
        values, report = made(folder, "--slant", slant, "--tilt", tilt, "--method", "paper")
        check(report["scale"]["kind"] == "paper")
        far = np.cos(np.radians(slant))
        ends = sorted((values.min(), values.max()))
        check(abs(ends[0] / far - 1) < .05 and abs(ends[1] * far - 1) < .05, slant, ends)
        near, away = (values[-1].mean(), values[0].mean()) if tilt == 0 else \
            (values[:, 0].mean(), values[:, -1].mean())
        check(near > away, "it recedes the wrong way")
    recede("scale-map", "--size", "9x9", "--slant", "95", "--kind", "paper", "-o",
           folder / "no.exr", code=2)


def test_formats(folder):
    for suffix in ("exr", "tif"):
        recede("scale-map", "--size", "40x30", "--slant", "60", "-o", folder / f"m.{suffix}")
        check(read(folder / f"m.{suffix}").dtype == np.float32)
    check(np.array_equal(read(folder / "m.exr"), read(folder / "m.tif")))
    done = recede("scale-map", "--size", "90x70", "--slant", "80", "-o", folder / "m.png")
    check(b"scale across" in done.stderr, done.stderr)
    picture = read(folder / "m.png").astype(int)
    check(picture.shape == (70, 90, 3))
    gray = (picture.max(axis=2) - picture.min(axis=2)) == 0
    near, far = picture[60:][gray[60:]].mean(), picture[25:32][gray[25:32]].mean()
    check(near > far + 30, "nearer is not brighter:", near, far)
    blue = (picture[:, :, 0] > picture[:, :, 2] + 50).any(axis=1).sum()
    check(blue >= 3, "no lines at the doublings")
    red = (picture[:, :, 2] > picture[:, :, 0] + 50).all(axis=1)
    check(red[0] and not red[-1], "the sky is not marked")


def test_says_nothing_when_quiet(folder):
    for suffix in ("exr", "tif", "png"):
        done = recede("scale-map", "--size", "40x30", "--slant", "60", "-q", "-o",
                      folder / f"m.{suffix}")
        check(done.stdout == b"" and done.stderr == b"", suffix, done.stdout, done.stderr)


def test_what_holds_no_map(folder):
    for suffix in ("webp", "hdr", "xyz"):
        done = recede("scale-map", "--size", "40x30", "--slant", "60", "-o", folder / f"m.{suffix}",
                      code=4)
        check(b".png" in done.stderr, done.stderr)


def test_of_a_picture(folder):
    image = write(folder / "in.png", texture())
    recede("scale-map", image, "--horizon", "0,-30,63,-30", "-o", folder / "a.exr")
    values = read(folder / "a.exr")
    check(values.shape == (48, 64))
    check(np.ptp(values, axis=1).max() < 1e-5, "a level horizon, but rows are not constant")
    expected = (np.arange(48) + 30) / (23.5 + 30)
    check(abs(values[:, 5] - expected).max() < 1e-5, "not linear down to the horizon")


if __name__ == "__main__":
    sys.exit(harness.main(globals()))
