#!/usr/bin/env python3
"""The examples in plugin/scripts, run as their first lines say, and the installation into a user's
folder.

scripts.py HOST PLUGIN PROJECT
"""
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
from host import Host, Tap

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "lib"))
import icc  # noqa: E402 - found by then

FOLDERS = {"2": "2.10", "3": "3.0"}


def checks(size=64):
    """A picture with a period of 8, so that a frontal fill can be judged."""
    y, x = np.mgrid[0:size, 0:size]
    tone = np.where((x // 4 + y // 4) % 2, 200, 60).astype(np.uint8)
    return np.dstack([tone, tone, 255 - tone])


def changed(before, after):
    rows, columns = np.nonzero((before != after).any(-1))
    return (columns.min(), rows.min(), columns.max(), rows.max()) if len(rows) else None


def check_fill(host, tap, scripts):
    source, out = host.folder / "a.png", host.folder / "out.png"
    picture = checks()
    picture[20:40, 24:44] = (0, 255, 0)
    cv2.imwrite(str(source), picture)
    output = host.run(f'(load "{scripts}/fill-selection.scm")',
                      f'(recede-fill-rectangle "{source}" "{out}" 22 18 24 24)')
    filled = cv2.imread(str(out))
    good = filled is not None and not (filled == (0, 255, 0)).all(-1).any()
    box = good and changed(picture, filled)
    tap.case(good and box[0] >= 22 and box[1] >= 18 and box[2] < 46 and box[3] < 42,
             "fill-selection.scm fills its rectangle", f"{box}\n{output}")


def check_batch(host, tap, scripts):
    folder = host.folder / "photos"
    folder.mkdir()
    mask = np.zeros((64, 64), np.uint8)
    mask[20:40, 24:44] = 255
    pictures = {}
    for name in ("one", "two"):
        pictures[name] = np.roll(checks(), len(pictures), 1)
        pictures[name][mask > 0] = (0, 255, 0)
        cv2.imwrite(str(folder / f"{name}.png"), pictures[name])
        cv2.imwrite(str(folder / f"{name}-mask.png"), mask)
    cv2.imwrite(str(folder / "unmasked.png"), checks())
    profile = icc.rgb_profile(icc.WIDE, 1.8)
    icc.embed(folder / "one.png", profile)
    orientation = "1" if host.name == "2" else '"angles"'
    output = host.run(f'(load "{scripts}/batch-folder.scm")',
                      f'(recede-batch "{folder}" "png" {orientation} 0 0)')
    for name, picture in pictures.items():
        filled = cv2.imread(str(folder / f"{name}-filled.png"))
        good = filled is not None and not (filled == (0, 255, 0)).all(-1).any()
        tap.case(good and np.array_equal(filled[mask == 0], picture[mask == 0]),
                 f"batch-folder.scm fills {name}.png", output)
    tap.case(icc.embedded(folder / "one-filled.png") == profile, "and keeps a profile")
    made = sorted(path.name for path in folder.glob("*-filled.png"))
    tap.case(made == ["one-filled.png", "two-filled.png"], "and nothing else", made)


def check_install(host, tap, project, plugin):
    """Into a profile of its own, found there by GIMP, and out again."""
    said = host.install(project, plugin)
    placed = host.installed / "recede"
    tap.case(placed.exists(), "install puts it where GIMP looks", said)
    catalogues = list((placed.parent / "locale").glob("*/LC_MESSAGES/recede.mo"))
    languages = [line for line in (project / "po/LINGUAS").read_text().split("\n")
                 if line and not line.startswith("#")]
    tap.case(len(catalogues) == len(languages), "with every catalogue", catalogues)
    host.run("")
    tap.case(str(placed) in host.pluginrc(), "and GIMP finds it there")
    host.uninstall()
    tap.case(not placed.parent.exists(), "uninstall takes it away")


def check_versions(host, tap):
    """Without a profile named, into that of every GIMP 3 the user has started."""
    profiles = [host.folder / "config" / "GIMP" / version for version in ("3.0", "3.2")]
    for profile in profiles:
        profile.mkdir(parents=True)
    del host.installing["GIMP3_DIRECTORY"]
    said = subprocess.run([host.installer, "install"], env=host.installing, capture_output=True,
                          text=True, check=False)
    placed = [profile / "plug-ins" / "recede" for profile in profiles]
    tap.case(all((folder / "recede").exists() for folder in placed),
             "GIMP 3.0 and 3.2 each get it", said.stdout + said.stderr)
    host.uninstall()
    tap.case(not any(folder.exists() for folder in placed), "and lose it")


def main():
    name, plugin, project = sys.argv[1:4]
    project = Path(project).resolve()
    tap = Tap()
    with Host(name, plugin) as host:
        scripts = project / "plugin" / "scripts" / FOLDERS[name]
        check_fill(host, tap, scripts)
        check_batch(host, tap, scripts)
        check_install(host, tap, project, plugin)
        if name == "3":
            check_versions(host, tap)
    tap.plan()


main()
