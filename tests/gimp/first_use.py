#!/usr/bin/env python3
"""A new user's first fill with the installed plug-in, step by step, with the pictures of
docs/first-use.md.

windowed.sh first_use.py HOST PLUGIN PICTURE FOLDER
"""
import subprocess
import sys
import time
from pathlib import Path

import pyatspi
from dialog import Dialog
from host import PRELUDE, Host, Tap
from server import IMAGE, Server
from window import Window, wait_for

PROJECT = Path(__file__).resolve().parents[2]
BOX = (155, 345, 275, 185)  # the lane markings left of the middle


def keep(window, folder, number, name):
    shot = window.screenshot(f"first-use-{number}")
    path = folder / f"first-use-{number}-{name}.jpg"
    subprocess.run(["convert", str(shot), "-bordercolor", "black", "-border", "1", "-trim",
                    "+repage", "-resize", "1000x", "-quality", "85", "-strip", str(path)],
                   check=True)
    return path


def main():
    name, plugin, picture, folder = sys.argv[1:5]
    folder, tap = Path(folder), Tap()
    with Host(name, plugin) as host, Window(host, host.folder / "art") as window:
        server = Server(host)
        host.install(PROJECT, plugin)
        window.start(Path(picture).resolve(), server.script)
        frame = window.frame("960x540", 60)
        server.run(PRELUDE[name] + IMAGE[name] + "(gimp-image-select-rectangle i "
                   f"CHANNEL-OP-REPLACE {BOX[0]} {BOX[1]} {BOX[2]} {BOX[3]})")
        window.dismiss_welcome()
        time.sleep(1)
        window.menu(frame, "View", "Zoom", "Fit Image in Window")
        time.sleep(1)
        start = time.monotonic()
        for menu in ("Filters", "Enhance"):
            window.press(window.find(frame, ("menu",), menu))
            time.sleep(.4)
        keep(window, folder, 1, "menu")
        pyatspi.Registry.generateKeyboardEvent(9, None, pyatspi.KEY_PRESSRELEASE)
        pyatspi.Registry.generateKeyboardEvent(9, None, pyatspi.KEY_PRESSRELEASE)
        dialog = Dialog(window, tap)
        dialog.open(frame)
        sure = dialog.says("with a confidence of", seconds=30)
        tap.case(sure, "the road is read", dialog.status())
        time.sleep(.5)
        keep(window, folder, 2, "dialog")
        dialog.toggle("Draft result")
        tap.case(dialog.says("Draft:", seconds=60), "the draft is shown", dialog.status())
        time.sleep(.5)
        keep(window, folder, 3, "draft")
        dialog.press("OK")
        gone = wait_for(lambda: not dialog.alive(), 60)
        tap.case(gone, "the fill is done", dialog.status() if not gone else "")
        print(f"# {time.monotonic() - start:.0f} s from the menu to the fill")
        server.run("(gimp-selection-none i)(gimp-displays-flush)")
        time.sleep(1)
        keep(window, folder, 4, "filled")
    tap.plan()


main()
