#!/usr/bin/env python3
"""The dialog in German, where numbers have a comma and words are long, on a small screen: its
labels, and a fill to the end.

windowed.sh --screen 1024x600 translated.py HOST PLUGIN PICTURE ARTEFACTS PROJECT
"""
import os
import subprocess
import sys
from pathlib import Path

from host import Host, Tap
from window import Window, plain, wait_for, walk

LANGUAGE, LOCALE = "de", "de_DE.UTF-8"
SCREEN = 1024, 600
LABELS = ["Neigung", "Richtung", "Bildwinkel", "Schätzen", "Gitter", "Entwurf der Füllung"]
CALL = {"2": "(plug-in-recede-fill RUN-INTERACTIVE i (t-layer i) 1 80.5 0 50 2 -1 0 0 0 0)",
        "3": "(plug-in-recede-fill #:run-mode RUN-INTERACTIVE #:image i"
             " #:drawables (vector (t-layer i)))"}
IMAGE = {"2": "(define i (vector-ref (cadr (gimp-image-list)) 0))",
         "3": "(define i (vector-ref (car (gimp-get-images)) 0))"}


def main():
    name, plugin, picture, artefacts, project = sys.argv[1:6]
    os.environ.update(RECEDE_TEST_LOCALE=LOCALE, LANGUAGE=LANGUAGE)
    tap = Tap()
    with Host(name, plugin) as host, Window(host, Path(artefacts)) as window:
        catalogue = host.folder / "plug-ins" / "recede" / "locale" / LANGUAGE / "LC_MESSAGES"
        catalogue.mkdir(parents=True)
        subprocess.run(["msgfmt", "-o", catalogue / "recede.mo", f"{project}/po/{LANGUAGE}.po"],
                       check=True)
        done = host.folder / "done.png"
        window.start(Path(picture).resolve(), IMAGE[name],
                     "(gimp-image-select-rectangle i CHANNEL-OP-REPLACE 400 400 90 60)",
                     CALL[name], f'(t-save i "{done}")')
        dialog = window.frame("Perspektivisch füllen", 60)
        tap.case(dialog is not None, "the dialog's title is German")
        for label in LABELS:
            found = wait_for(lambda label=label: any(plain(node.name) == label
                                                     for node in walk(dialog)), 10)
            tap.case(found, f"it says {label}")
        _, _, width, height = window.extents(dialog)
        tap.case(width <= SCREEN[0] and height <= SCREEN[1], "and is no larger than the screen",
                 f"{width}x{height}")
        window.screenshot("german")
        spin = window.spin(dialog, "Neigung").queryValue()
        spin.currentValue = 80.5
        tap.case(wait_for(lambda: spin.currentValue == 80.5, 5), "80,5 is 80.5")
        window.press(next(node for node in walk(dialog) if node.getRoleName() in
                          ("push button", "button") and plain(node.name) == "OK"))
        tap.case(wait_for(done.exists, 40), "and it fills")
        log = (Path(artefacts) / f"gimp{name}.log").read_text(errors="replace")
        tap.case("duplicate mnemonic" not in log.lower(), "no mnemonic twice", log[-2000:])
    tap.plan()


main()
