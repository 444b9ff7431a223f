#!/usr/bin/env python3
"""Fills every kind of pixels and takes it back: the fill is right, and after one undo every byte is
as before; and a plug-in that is killed leaves nothing behind. In a window: only there can one undo.

windowed.sh undo.py HOST PLUGIN ARTEFACTS
"""
import itertools
import os
import signal
import sys
import threading
import time
from pathlib import Path

import numpy as np
import xcf
from host import PRELUDE, Host, Tap
from pixels import (MODES, OFFSET, PRECISIONS, RECTANGLE, SELECTIONS, faults, mask_over, picture,
                    script_of)
from server import Server
from window import Window, wait_for

SHOW = "(define v (car (gimp-display-new i)))(gimp-displays-flush)"
UNSHOW = "(gimp-display-delete v)"


def same(one, other):
    return len(one.layers) == len(other.layers) and all(
        np.array_equal(a.bytes, b.bytes) and a.offsets == b.offsets
        for a, b in zip(one.layers, other.layers))


def cases():
    """(mode, precision, selection, offset, extra): all modes in all precisions, and new layers."""
    kinds = list(SELECTIONS)
    for number, (mode, precision) in enumerate(itertools.product(MODES, PRECISIONS)):
        yield mode, precision, kinds[number % len(kinds)], OFFSET if number % 3 == 1 else None, {}
    for mode, precision in (("rgb", "u8"), ("graya", "float-linear")):
        yield mode, precision, "feathered", OFFSET, {"fill": {"result": "new-layer"}}


def faults_of(before, after, case):
    if not case[4]:
        mask = mask_over(before.layers[0], before.channels[0])
        yield from faults(before.layers[0], after.layers[0], mask)
    elif len(after.layers) != len(before.layers) + 1:
        yield f"{len(after.layers)} layers"


def check_table(host, tap, window, server, frame):
    folder = host.folder
    for alpha in (False, True):
        picture(folder / f"picture-{alpha:d}.png", alpha)
    for number, case in enumerate(cases()):
        stem = folder / str(number)
        name = ' '.join(case[:3]) + ' offset' * bool(case[3]) + ' new layer' * bool(case[4])
        good, text = server.run(script_of(
            host, case, folder / f"picture-{MODES[case[0]][1]:d}.png", stem, SHOW))
        if not good:
            tap.case(False, name, text)
            continue
        before, after = (xcf.Image(f"{stem}-{when}.xcf") for when in ("before", "after"))
        wrong = list(faults_of(before, after, case))
        undone = window.undo(frame)
        if not wait_for(lambda: same(before, server.save(f"{stem}-undone.xcf")), 5):
            wrong.append(f"not as before after {undone}")
        tap.case(not wrong, f"{name}, and undone", "\n".join(wrong))
        server.run(UNSHOW)


def plug_in_process(host):
    """The plug-in that runs a procedure: it has GIMP's -run among its arguments."""
    for folder in Path("/proc").iterdir():
        try:
            words = (folder / "cmdline").read_bytes().split(b"\0")
        except OSError:
            continue
        if words[0] == str(host.folder / "plug-ins/recede/recede").encode() and b"-run" in words:
            return int(folder.name)
    return None


def check_killed(host, tap, window, server, frame):
    """At three moments of a run that lasts for seconds."""
    stem = host.folder / "killed"
    long = host.fill(orientation="angles", slant=35, method="kwatra", quality="best")
    server.run(f'(define i (t-load "{host.folder}/picture-0.png"))(define d (t-layer i))'
               "(gimp-image-scale i 960 720)" + SHOW)
    server.run("(gimp-image-select-rectangle i CHANNEL-OP-REPLACE 300 200 400 300)")
    before = server.save(f"{stem}-before.xcf")
    for after in (.05, .4, 1):
        answers = []
        thread = threading.Thread(target=lambda: answers.append(server.run(long)))
        thread.start()
        process = wait_for(lambda: plug_in_process(host), 20, step=.01)
        time.sleep(after)
        os.kill(process, signal.SIGKILL)
        thread.join(30)
        tap.case(answers and not answers[0][0] and same(before, server.save(f"{stem}-after.xcf")),
                 f"killed {after} s after its start: the picture is as before", answers)
    server.run(RECTANGLE)
    server.run(host.fill(orientation="frontal"))
    filled = server.save(f"{stem}-filled.xcf")
    undone = window.undo(frame)
    good = wait_for(lambda: same(before, server.save(f"{stem}-undone.xcf")), 5)
    tap.case(good and not same(before, filled), "and one undo takes back just the next fill",
             undone)
    name = window.undo(frame)
    tap.case("Rect" in name, "before which there is only the selection", name)


def main():
    name, plugin, artefacts = sys.argv[1:4]
    tap = Tap()
    with Host(name, plugin) as host, Window(host, Path(artefacts)) as window:
        server = Server(host)
        first = host.folder / "first.png"
        picture(first, False)
        window.start(first, server.script)
        frame = window.frame("96x72", 60)
        tap.case(frame is not None, "GIMP is up")
        server.run(PRELUDE[name])
        window.dismiss_welcome()
        check_table(host, tap, window, server, frame)
        check_killed(host, tap, window, server, frame)
    tap.plan()


if __name__ == "__main__":
    main()
