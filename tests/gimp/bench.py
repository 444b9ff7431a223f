#!/usr/bin/env python3
"""Times the plug-in in a running GIMP, on 12 megapixels of 16 bits with 1 megapixel selected.

windowed.sh bench.py HOST PLUGIN COMMAND
"""
import json
import os
import random
import resource
import subprocess
import sys
import time
from pathlib import Path

import cv2
import gi
import numpy as np

gi.require_version("Gdk", "3.0")
from dialog import Dialog  # noqa: E402
from gi.repository import Gdk  # noqa: E402
from host import PRELUDE, Host, Tap  # noqa: E402
from server import IMAGE, Server  # noqa: E402
from window import Window, wait_for  # noqa: E402

PROJECT = Path(__file__).resolve().parents[2]
SIZE, HOLE = (4000, 3000), (1400, 1900, 1150, 880)
TIMES = 5
TICKS = os.sysconf("SC_CLK_TCK")


def ms(values):
    values = sorted(1000 * value for value in values)
    return f"median {values[len(values) // 2]:.0f} ms, longest {values[-1]:.0f} ms ({len(values)})"


def make_photo(path, mask_path):
    """The pier, enlarged; noise fills the lower bytes. Uncompressed: reading costs little."""
    noise = np.random.default_rng(1)
    image = cv2.resize(cv2.imread(str(PROJECT / "docs/images/pier.jpg")), SIZE).astype(np.int32)
    image = (image * 257 + noise.integers(-400, 401, image.shape)).clip(0, 65535)
    cv2.imwrite(str(path), image.astype(np.uint16), [cv2.IMWRITE_TIFF_COMPRESSION, 1])
    mask = np.zeros(SIZE[::-1], np.uint8)
    x, y, width, height = HOLE
    mask[y : y + height, x : x + width] = 255
    cv2.imwrite(str(mask_path), mask)


def pixels(box):
    shot = Gdk.pixbuf_get_from_window(Gdk.get_default_root_window(), *box)
    return shot.get_pixels()


def until(change, start, limit=20):
    while time.monotonic() - start < limit:
        if change():
            return time.monotonic() - start
    raise TimeoutError


def preview_times(window, dialog, label, values):
    """From giving a slider another value to other pixels on the screen."""
    box = window.extents(dialog.preview)
    control, times = dialog.spin(label).queryValue(), []
    for value in values:
        before, start = pixels(box), time.monotonic()
        control.currentValue = value
        times.append(until(lambda: pixels(box) != before, start))
        time.sleep(.3)
    return times


def bench_preview(window, dialog):
    box = window.extents(dialog.preview)
    start = time.monotonic()
    for _ in range(10):
        pixels(box)
    print(f"reading the preview off the screen, a part of what follows:"
          f" {(time.monotonic() - start) * 100:.0f} ms")
    for show in ("Grid", "Scale map"):
        dialog.toggle(show)
        time.sleep(1)
        times = preview_times(window, dialog, "Slant", [60, 63, 66, 69, 72, 75, 78, 80] * 2)
        times += preview_times(window, dialog, "Tilt", [5, 10, -5, 0] * 2)
        print(f"preview, {show.lower()}: {ms(times)}")
    dialog.toggle("Grid")


def bench_run(dialog, method):
    """OK to the first message of progress, and Cancel, at some moment, to the answer."""
    first, answers = [], []
    status = dialog.status_label.queryText()
    ok, cancel = (dialog.window.button(dialog.root, name) for name in ("OK", "Cancel"))
    dialog.choose(*method)
    for _ in range(12):
        before, start = status.getText(0, -1), time.monotonic()
        dialog.window.press(ok)
        first.append(until(lambda: status.getText(0, -1) != before, start))
        time.sleep(random.uniform(.05, 3))
        start = time.monotonic()
        dialog.window.press(cancel)
        answers.append(until(lambda: status.getText(0, -1).startswith("Stopped"), start))
        time.sleep(.3)
    print(f"{method[0]}: OK to progress: {ms(first)}; Cancel to the answer: {ms(answers)}")


def cpu_of(process):
    """Of a process and the children it has waited for."""
    fields = Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()
    return sum(int(value) for value in fields[11:15]) / TICKS


def spent(act, cpu):
    """Wall and CPU seconds of act."""
    start, before = time.monotonic(), cpu()
    act()
    wall = time.monotonic() - start
    time.sleep(.3)  # a child is waited for a little later
    return wall, cpu() - before


def cpu_of_children():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def bench_overhead(server, window, host, command, photo, mask):
    """The same fill by the plug-in and by the command, in turns."""
    report, out = host.folder / "report.json", host.folder / "out.tif"
    options = ["--slant", "80", "--seed", "1", "--surface", "flat", "--force"]
    fill = host.fill(orientation="angles", slant=80, seed=1, surface="flat")

    def in_gimp():
        good, text = server.run(fill)
        assert good, text

    def by_command():
        subprocess.run([command, "fill", photo, "--mask", mask, "-o", out, *options, "--json",
                        report], check=True)

    rows = []
    for _ in range(TIMES):
        plugin = spent(in_gimp, lambda: cpu_of(window.process.pid))
        whole = spent(by_command, cpu_of_children)
        core = sum(json.loads(report.read_text())["stages"].values())
        rows.append((*plugin, *whole, core))
        print("  plug-in {:.2f} s, {:.2f} CPU s; command {:.2f} s, {:.2f} CPU s, of it"
              " the core's stages {:.2f} s".format(*rows[-1]), flush=True)
    best = np.min(rows, axis=0)
    print(f"least: the plug-in's call / the command: {best[0] / best[2]:.2f} wall,"
          f" {best[1] / best[3]:.2f} CPU; over the core's stages: {best[0] / best[4]:.2f} wall")


def main():
    name, plugin, command = sys.argv[1:4]
    random.seed(1)
    with Host(name, plugin) as host, Window(host, host.folder / "art") as window:
        photo, mask = host.folder / "photo.tif", host.folder / "mask.png"
        make_photo(photo, mask)
        server = Server(host)
        window.start(photo, server.script)
        frame = window.frame(f"{SIZE[0]}x{SIZE[1]}", 60)
        select = "(gimp-image-select-rectangle i CHANNEL-OP-REPLACE {} {} {} {})".format(*HOLE)
        good, text = server.run(PRELUDE[name] + IMAGE[name] + "(define d (t-layer i))" + select)
        assert good, text
        window.dismiss_welcome()
        dialog = Dialog(window, Tap())
        dialog.open(frame)
        dialog.says("confidence", seconds=60)
        dialog.set("Slant", 80)
        bench_preview(window, dialog)
        bench_run(dialog, ("Copies within the plane",))
        bench_run(dialog, ("Texture optimization", "baseline"))
        dialog.press("Cancel")
        wait_for(lambda: not dialog.alive(), 10)
        bench_overhead(server, window, host, Path(command).resolve(), photo, mask)


if __name__ == "__main__":
    main()
