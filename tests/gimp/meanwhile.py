"""What the user does in the image while the fill's dialog is open or a fill runs."""
import re

import numpy as np
import pyatspi
from window import wait_for

SELECT = "(gimp-image-select-rectangle i CHANNEL-OP-REPLACE {} {} {} {})(gimp-displays-flush)"
FILL_ALL = {"2": "gimp-edit-fill", "3": "gimp-drawable-edit-fill"}
OLD, NEW = (330, 380, 300, 130), (100, 300, 350, 150)
COPY = "(define {} (car (gimp-layer-copy (t-layer i){})))(gimp-image-insert-layer i {} 0 0)"
# A channel that is white, c, beside a layer of its own to work on, e.
ITEMS = "(gimp-selection-all i)(define c (car (gimp-selection-save i)))(t-select-layer i e)"
SELECT_CHANNEL = {"2": "(gimp-image-set-active-channel i c)",
                  "3": "(gimp-image-set-selected-channels i (vector c))"}


def copy_as(name, window):
    return COPY.format(name, " FALSE" if window.host.name == "2" else "", name)


def inside(layer, box):
    x, y, width, height = box
    mask = np.zeros(layer.bytes.shape[:2], bool)
    mask[y : y + height, x : x + width] = True
    return mask


def fills_just(tap, before, after, box, name):
    changed = (before.layers[0].bytes != after.layers[0].bytes).any(-1)
    mask = inside(before.layers[0], box)
    tap.case(changed[mask].mean() > .5 and not changed[~mask].any(), name,
             f"{changed[mask].mean()} of it, {changed[~mask].sum()} px elsewhere")


def is_undone(tap, window, frame, server, before, path, name):
    undone = window.undo(frame)
    same = wait_for(lambda: np.array_equal(server.save(path).layers[0].bytes,
                                           before.layers[0].bytes), 5)
    tap.case(same, name, undone)


def start_run(dialog):
    dialog.press("OK")
    assert wait_for(lambda: dialog.status() in ("Searching for texture", "Hiding the seams",
                                                "Matching the detail"), 20, step=.02)


def check_before_ok(dialog, window, frame, server, folder):
    """Another selection while the dialog is open, and a lock."""
    tap = dialog.tap
    server.run(copy_as("e", window) + ITEMS + SELECT.format(*OLD))
    before = server.save(folder / "before.xcf")
    dialog.open(frame)
    dialog.set("Slant", 80)
    server.run("(gimp-item-set-lock-content e TRUE)")
    dialog.press("OK")
    tap.case(dialog.says("are locked") and dialog.alive(), "OK says that pixels are locked",
             dialog.status() if dialog.alive() else "")
    server.run("(gimp-item-set-lock-content e FALSE)(gimp-selection-none i)")
    dialog.press("OK")
    tap.case(dialog.says("Nothing is selected"), "OK says that nothing is selected any more",
             dialog.status())
    server.run(SELECT.format(*NEW))
    dialog.press("Estimate")
    dialog.choose("Selection Mask")
    estimate = window.button(dialog.root, "Estimate")
    tap.case(wait_for(lambda: estimate.getState().contains(pyatspi.STATE_SENSITIVE), 20),
             "another source is estimated with", dialog.status())
    dialog.set("Slant", 80)
    dialog.press("OK")
    tap.case(wait_for(lambda: not dialog.alive(), 40), "another selection is filled")
    fills_just(tap, before, server.save(folder / "after.xcf"), NEW, "it alone")
    is_undone(tap, window, frame, server, before, folder / "undone.xcf", "and undone")


def check_painted(dialog, window, frame, server, folder):
    """Painted over while the dialog is open, with the same selection: that is filled from."""
    tap, (x, y, width, height) = dialog.tap, OLD
    server.run(copy_as("p", window) + "(t-select-layer i p)" + SELECT.format(*OLD))
    dialog.open(frame)
    dialog.choose("Selection Mask")
    dialog.reset()
    tap.case(wait_for(lambda: dialog.chosen("Around the selection") == "Around the selection", 5),
             "Reset copies from around the selection", dialog.chosen("Around the selection"))
    dialog.set("Slant", 80)
    paint = f"({FILL_ALL[window.host.name]} p FILL-FOREGROUND)"
    server.run("(gimp-context-set-foreground '(0 255 0))(gimp-selection-none i)" + paint
               + SELECT.format(*OLD))
    before = server.save(folder / "before.xcf")
    server.run(f"(gimp-context-set-foreground '(0 0 255)){paint}(gimp-displays-flush)")
    dialog.press("OK")
    tap.case(wait_for(lambda: not dialog.alive(), 40), "what was painted over is filled",
             dialog.status() if dialog.alive() else "")
    after = server.save(folder / "after.xcf").layers[0].bytes
    tap.case(np.array_equal(before.layers[0].bytes, after), "from what is around it now",
             list(after[y : y + height, x : x + width].reshape(-1, after.shape[2]).mean(0)))
    server.run("(gimp-image-remove-layer i p)(t-select-layer i e)")


def check_channel(dialog, window, frame, server):
    """The channel that was copied from is now to be filled itself."""
    tap = dialog.tap
    server.run(SELECT_CHANNEL[window.host.name])
    dialog.open(frame)
    source = dialog.chosen("Around the selection")
    tap.case(source == "Around the selection", "nothing is copied from itself", source)
    dialog.choose("A new layer")
    dialog.press("OK")
    tap.case(dialog.says("can only be filled in place"), "a channel's fill needs its place",
             dialog.status() if dialog.alive() else "")
    dialog.press("Cancel")
    wait_for(lambda: not dialog.alive(), 10)
    server.run("(t-select-layer i e)")


def check_while_running(dialog, window, frame, server, folder):
    tap = dialog.tap
    server.run(SELECT.format(*OLD))
    before = server.save(folder / "before.xcf")
    dialog.open(frame)
    dialog.set("Slant", 80)
    dialog.choose("Best")
    start_run(dialog)
    server.run(SELECT.format(*NEW) + "(gimp-layer-set-offsets e 50 -30)")
    tap.case(wait_for(lambda: not dialog.alive(), 60),
             "a fill goes on when selection and layer move")
    fills_just(tap, before, server.save(folder / "after.xcf"), OLD, "what was selected is filled")
    _, text = server.run('(apply string-append (map (lambda (n) (string-append " " (number->string'
                         ' n))) (cdr (gimp-selection-bounds i))))')
    x, y, width, height = NEW
    tap.case([int(n) for n in re.findall(r"\d+", text)] == [x, y, x + width, y + height],
             "what is selected stays", text)
    is_undone(tap, window, frame, server, before, folder / "undone.xcf", "one undo takes it back")


def check_lost(dialog, window, frame, server, folder):
    tap = dialog.tap
    server.run(SELECT.format(*OLD))
    dialog.open(frame)
    dialog.set("Slant", 80)
    start_run(dialog)
    server.run("(gimp-layer-resize e 900 500 0 0)")
    before = server.save(folder / "before.xcf")
    tap.case(dialog.says("960 × 540 px when the fill began and is 900 × 500"),
             "a layer cropped meanwhile is said", dialog.status())
    after = server.save(folder / "after.xcf")
    tap.case(np.array_equal(before.layers[0].bytes, after.layers[0].bytes), "and not written to")
    start_run(dialog)
    server.run("(gimp-image-remove-layer i e)")
    tap.case(dialog.says("layer is gone"), "a layer deleted meanwhile is said", dialog.status())
    dialog.press("OK")
    tap.case(dialog.alive() and "layer is gone" in dialog.status(), "and again by OK")
    dialog.choose("Normal")
    dialog.press("Cancel")
    wait_for(lambda: not dialog.alive(), 10)


def check_meanwhile(dialog, window, frame, server, folder):
    check_before_ok(dialog, window, frame, server, folder)
    check_channel(dialog, window, frame, server)
    check_painted(dialog, window, frame, server, folder)
    check_while_running(dialog, window, frame, server, folder)
    check_lost(dialog, window, frame, server, folder)
