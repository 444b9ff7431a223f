#!/usr/bin/env python3
"""The fill's dialog in a real window: what a user does, by GIMP's menus and accessibility tree.

windowed.sh dialog.py HOST PLUGIN PICTURE ARTEFACTS: screenshots are kept in ARTEFACTS.
"""
import math
import sys
import time
from pathlib import Path

import cv2
import numpy as np
import pyatspi
from host import PRELUDE, Host, Tap
from meanwhile import check_meanwhile
from server import IMAGE, Server
from window import Window, plain, wait_for, walk

FOV, WIDTH, HEIGHT = 50, 960, 540
MARGIN = .07  # plugin/common/scene.c
SELECTION = (330, 380, 300, 130)

SELECT = "(gimp-image-select-rectangle i CHANNEL-OP-REPLACE {} {} {} {})"


ESTIMATE = "Estimate from the picture"
FILL_MENU = ("Filters", "Enhance", "Perspective Fill")


class Dialog:
    def __init__(self, window, tap, path=FILL_MENU):
        self.window, self.tap, self.path, self.root = window, tap, path, None

    def open(self, frame):
        start = time.monotonic()
        self.window.menu(frame, *self.path)
        self.root = self.window.frame(self.path[-1], 30)
        self.tap.case(self.root is not None, "opens from the menu",
                      f"after {time.monotonic() - start:.1f} s")
        self.preview = self.window.find(self.root, ("unknown", "drawing area", "panel", "canvas"),
                                        "Preview")
        self.status_label = self.window.find(self.root, ("label",), "Status")
        time.sleep(1)

    def picture(self):
        shot = cv2.imread(str(self.window.screenshot("now")))
        x, y, width, height = self.window.extents(self.preview)
        return shot[y : y + height, x : x + width].astype(int)

    def changes(self, act, name, share=.002, seconds=12):
        """act makes at least that share of the preview's pixels different."""
        before = self.picture()
        start = time.monotonic()
        act()
        good = wait_for(lambda: (np.abs(self.picture() - before).max(-1) > 12).mean() > share,
                        seconds)
        self.tap.case(good is not None, name, f"after {time.monotonic() - start:.1f} s")

    def spin(self, label):
        return self.window.spin(self.root, label)

    def value(self, label):
        return self.spin(label).queryValue().currentValue

    def set(self, label, value):
        self.spin(label).queryValue().currentValue = value

    def status(self):
        return self.status_label.queryText().getText(0, -1)

    def says(self, *words, seconds=20):
        return wait_for(lambda: any(word in self.status() for word in words), seconds, step=.02)

    def toggle(self, name):
        self.window.press(self.window.find(self.root, ("radio button",), name))

    def press(self, name):
        self.window.press(self.window.button(self.root, name))

    def choose(self, *words):
        """The first item that has all words: of a combo box, or, in GIMP 3.2, a radio button."""
        item = wait_for(lambda: next((node for node in walk(self.root)
                                      if node.getRoleName() in ("menu item", "radio button")
                                      and all(word in node.name for word in words)), None), 10)
        self.window.press(item)

    def chosen(self, item):
        """What the combo box that has this item shows."""
        return next(node.name for node in walk(self.root) if node.getRoleName() == "combo box"
                    and any(child.name == item for child in walk(node)))

    def named(self, *names):
        """Any node of the application so called, for menus that pop up."""
        def look():
            for application in self.window.applications():
                for node in walk(application):
                    if plain(node.name) in names and node.getRoleName() != "label":
                        return node
            return None
        return wait_for(look, 10)

    def reset(self):
        self.window.press(self.named("Reset"))
        if self.window.host.name == "3":
            self.window.press(self.named("Reset to Factory Defaults"))

    def alive(self):
        return self.window.frame(self.path[-1], 1) is not None


def on_screen(dialog, x, y):
    """A point of the picture, in the preview on the screen."""
    left, top, width, height = dialog.window.extents(dialog.preview)
    zoom = min(width * (1 - 2 * MARGIN) / WIDTH, height * (1 - 2 * MARGIN) / HEIGHT)
    return (left + (width - zoom * WIDTH) / 2 + zoom * x,
            top + (height - zoom * HEIGHT) / 2 + zoom * y)


def horizon_y(slant):
    focal = WIDTH / 2 / math.tan(math.radians(FOV / 2))
    return HEIGHT / 2 - focal / math.tan(math.radians(slant))


def check_sliders(dialog):
    for label, value in (("Slant", 78), ("Tilt", 12), ("Field of view", 70)):
        dialog.changes(lambda label=label, value=value: dialog.set(label, value),
                       f"{label} moves the preview")
    dialog.set("Tilt", 0)
    dialog.set("Field of view", FOV)
    dialog.set("Slant", 179)
    dialog.tap.case(dialog.says("lies beyond the horizon"), "a slant that shows nothing is said",
                    dialog.status())
    dialog.set("Slant", 78)
    dialog.tap.case(dialog.says("Drag"), "and no more when the horizon is back", dialog.status())
    dialog.changes(lambda: dialog.toggle("Scale map"), "the scale map is shown")
    dialog.window.screenshot("scale-map")
    dialog.changes(lambda: dialog.toggle("Draft result"), "the draft is shown")
    good = dialog.says("Draft:", seconds=40)
    dialog.tap.case(good, "the draft comes", dialog.status())
    dialog.window.screenshot("draft")
    dialog.changes(lambda: dialog.toggle("Grid"), "the grid comes back")


def check_estimate(dialog):
    dialog.press("Estimate")
    good = dialog.says("confidence", seconds=30)
    dialog.tap.case(good, "Estimate answers", dialog.status())
    slant, orientation = dialog.value("Slant"), dialog.chosen(ESTIMATE)
    dialog.set("Field of view", 100)
    good = wait_for(lambda: abs(dialog.value("Slant") - slant) > .5, 20)
    dialog.tap.case(good, "another field of view is estimated with",
                    f"{dialog.value('Slant')} {dialog.status()}")
    dialog.set("Slant", 70)
    good = wait_for(lambda: dialog.chosen(ESTIMATE) != orientation, 5)
    dialog.tap.case(good, "an angle set by hand is meant", dialog.chosen(ESTIMATE))
    dialog.reset()
    good = wait_for(lambda: dialog.value("Slant") == slant, 20)
    dialog.tap.case(good and dialog.value("Field of view") == FOV
                    and dialog.chosen(ESTIMATE) == orientation,
                    "Reset estimates as the dialog opened",
                    f"{dialog.value('Slant')}, not {slant}; {dialog.chosen(ESTIMATE)}")


def check_drag(dialog):
    dialog.set("Slant", 80)
    dialog.set("Tilt", 0)
    time.sleep(.5)
    y = horizon_y(80)
    start, end = on_screen(dialog, WIDTH / 2, y), on_screen(dialog, WIDTH / 2, y + 90)
    dialog.window.drag(start, end)
    wanted = math.degrees(math.atan2(1, (HEIGHT / 2 - y - 90) * math.tan(math.radians(FOV / 2))
                                     / (WIDTH / 2)))
    good = wait_for(lambda: abs(dialog.value("Slant") - wanted) < 1.5, 5)
    dialog.tap.case(good, "dragging the horizon sets the slant",
                    f"{dialog.value('Slant')}, not {wanted}")
    dialog.window.screenshot("dragged")
    left, top, width, height = dialog.window.extents(dialog.preview)
    handle = on_screen(dialog, WIDTH * .22, y + 90)
    before = dialog.value("Tilt")
    dialog.window.drag((left + width * .06 + (handle[0] - left) * .9, handle[1]),
                       (handle[0], handle[1] + 40))
    dialog.window.drag(on_screen(dialog, WIDTH * .5, HEIGHT * .9),
                       on_screen(dialog, WIDTH * .56, HEIGHT * .9))
    dialog.tap.case(abs(dialog.value("Tilt") - before) > .5, "dragging the grid sets the tilt",
                    f"{before} {dialog.value('Tilt')}")


def is_sensitive(node):
    return node.getState().contains(pyatspi.STATE_SENSITIVE)


def check_cancel(dialog, host):
    """A long run, stopped: the dialog and its values stay."""
    dialog.set("Slant", 80)
    dialog.set("Tilt", 0)
    slant = dialog.value("Slant")
    dialog.choose("Best")
    dialog.choose("Texture optimization", "baseline")  # the slowest
    time.sleep(.5)
    cancel = dialog.window.button(dialog.root, "Cancel")
    names = ["Reset", "Estimate", "New seed"] + ["Save Settings", "Load Saved Settings"] * (
        host.name == "3")
    buttons = {name: dialog.named(name) for name in names}
    if host.name == "3":
        dialog.window.press(buttons["Save Settings"])
        dialog.tap.case(wait_for(lambda: is_sensitive(buttons["Load Saved Settings"]), 5),
                        "settings can be saved and loaded")
    dialog.press("OK")
    working = wait_for(lambda: not any(word in dialog.status() for word in
                                       ("confidence", "Drag", "Draft")), 10, step=.05)
    dialog.window.screenshot("running")
    # GIMP 3's have no name of ours and lie beside the controls.
    usable = [name for name in buttons if is_sensitive(buttons[name])]
    dialog.tap.case(not usable, "Reset and all that changes settings wait for the run's end",
                    usable)
    start = time.monotonic()
    dialog.window.press(cancel)
    stopped = dialog.says("Stopped", seconds=5)
    took = time.monotonic() - start
    dialog.tap.case(working and stopped, "Cancel stops the run", dialog.status())
    usable = wait_for(lambda: all(map(is_sensitive, buttons.values())), 5)
    dialog.tap.case(usable, "and they can be used again")
    dialog.tap.case(dialog.alive() and dialog.value("Slant") == slant,
                    "and keeps the dialog and its values", f"{took:.2f} s")
    print(f"# {took * 1000:.0f} ms from Cancel to the answer, as the accessibility tree sees it")
    check_resumed(dialog, cancel)
    dialog.choose("Normal")
    dialog.choose("Copies within the plane")


def check_resumed(dialog, cancel):
    """What a stopped run interrupted goes on by itself, and takes no word from the answer."""
    ok, estimate = (dialog.window.button(dialog.root, name) for name in ("OK", "Estimate"))
    dialog.toggle("Draft result")
    dialog.set("Tilt", 1)  # whose draft has not begun yet when OK is pressed
    dialog.window.press(ok)
    time.sleep(.5)
    dialog.changes(lambda: dialog.window.press(cancel), "the draft comes after a stopped run",
                   seconds=40)
    dialog.tap.case(dialog.says("Stopped", seconds=1), "and the answer stays", dialog.status())
    dialog.toggle("Grid")
    dialog.window.press(estimate)
    dialog.window.press(ok)
    time.sleep(.5)
    dialog.window.press(cancel)
    assert dialog.says("Stopped", seconds=8), dialog.status()
    read = wait_for(lambda: dialog.value("Slant") != 80, 20)
    dialog.tap.case(read, "an estimate goes on after a stopped run", dialog.status())
    dialog.tap.case("Stopped" in dialog.status(), "and says nothing", dialog.status())
    dialog.set("Slant", 80)
    dialog.set("Tilt", 0)
    dialog.tap.case(dialog.says("Drag", seconds=5), "until a control is moved", dialog.status())


def check_fill_and_undo(dialog, window, frame, server, folder):
    before = server.save(folder / "before.xcf")
    dialog.press("OK")
    gone = wait_for(lambda: not dialog.alive(), 60)
    dialog.tap.case(gone, "OK fills and closes the dialog", "" if gone else dialog.status())
    after = server.save(folder / "after.xcf")
    x, y, width, height = SELECTION
    old, new = before.layers[0].bytes, after.layers[0].bytes
    changed = (old != new).any(-1)
    inside = np.zeros_like(changed)
    inside[y : y + height, x : x + width] = True
    dialog.tap.case(changed[inside].mean() > .5 and not changed[~inside].any(),
                    "the selection changed and nothing else",
                    f"{changed[inside].mean()} {changed[~inside].sum()}")
    window.screenshot("filled")
    name = window.undo(frame)
    restored = wait_for(lambda: np.array_equal(
        server.save(folder / "undone.xcf").layers[0].bytes, old), 10)
    dialog.tap.case(restored, "one undo restores every byte", name)


def check_last_values(dialog, window, frame):
    dialog.open(frame)
    dialog.tap.case(dialog.value("Slant") == 80, "the last values are back", dialog.value("Slant"))
    dialog.press("Cancel")
    dialog.tap.case(wait_for(lambda: not dialog.alive(), 10), "Cancel closes the dialog")


def main():
    name, plugin, picture, artefacts = sys.argv[1:5]
    tap = Tap()
    with Host(name, plugin) as host, Window(host, Path(artefacts)) as window:
        server = Server(host)
        window.start(Path(picture).resolve(), server.script)
        frame = window.frame(f"{WIDTH}x{HEIGHT}", 60)
        tap.case(frame is not None, "GIMP is up")
        ready, text = server.run(PRELUDE[name] + IMAGE[name] + SELECT.format(*SELECTION))
        tap.case(ready, "its server answers", text)
        window.dismiss_welcome()
        dialog = Dialog(window, tap)
        dialog.open(frame)
        dialog.says("confidence", seconds=30)  # the estimate that opening starts
        window.screenshot("opened")
        check_sliders(dialog)
        check_estimate(dialog)
        check_drag(dialog)
        check_cancel(dialog, host)
        check_fill_and_undo(dialog, window, frame, server, host.folder)
        check_last_values(dialog, window, frame)
        check_meanwhile(dialog, window, frame, server, host.folder)
        log = (Path(artefacts) / f"gimp{name}.log").read_text(errors="replace")
        tap.case("duplicate mnemonic" not in log.lower(), "no mnemonic twice", log[-2000:])
    tap.plan()


if __name__ == "__main__":
    main()
