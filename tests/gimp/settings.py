#!/usr/bin/env python3
"""The texture's dialog in a real window, of an installed plug-in: a new image, last values,
presets, Reset, the help page, the icon.

windowed.sh settings.py HOST PLUGIN PROJECT ARTEFACTS
"""
import os
import re
import sys
import time
from pathlib import Path
from urllib.parse import unquote, urlparse

import numpy as np
import pyatspi
import xcf
from dialog import Dialog
from host import PRELUDE, Host, Tap
from server import IMAGE, Server
from window import Window, plain, wait_for, walk

MENU = ("Filters", "Render", "Pattern", "Perspective Texture")
SELECTION = (200, 330, 560, 200)
# What takes a web page: a script that writes down which one.
BROWSER = """[Desktop Entry]
Type=Application
Name=Reader
Exec=/bin/sh -c "echo %u >> {pages}"
MimeType=text/html;x-scheme-handler/file;x-scheme-handler/http;x-scheme-handler/https;
"""
NEWEST = {"2": "(define n (vector-ref (cadr (gimp-image-list)) 0))",
          "3": "(define n (vector-ref (car (gimp-get-images)) 0))"}
COUNT = {"2": "(car (gimp-image-list))", "3": "(vector-length (car (gimp-get-images)))"}


def install_browser(folder):
    """The user's only application for web pages. Returns the list it keeps."""
    applications, pages = folder / "data" / "applications", folder / "pages"
    applications.mkdir(parents=True)
    (applications / "reader.desktop").write_text(BROWSER.format(pages=pages))
    types = ("text/html", "x-scheme-handler/file", "x-scheme-handler/http",
             "x-scheme-handler/https", "application/xhtml+xml")
    (applications / "mimeapps.list").write_text(
        "[Default Applications]\n" + "".join(f"{kind}=reader.desktop\n" for kind in types))
    os.environ.update(XDG_DATA_HOME=str(folder / "data"), XDG_CONFIG_HOME=str(folder / "config"))
    return pages


def images(server, host):
    good, text = server.run(f"(number->string {COUNT[host.name]})")
    return int(re.search(r"\d+", text)[0]) if good else None


def check_dialog(dialog):
    dialog.set("Slant", 60)
    dialog.changes(lambda: dialog.set("Slant", 80), "Slant moves the preview", .0005)
    dialog.set("Slant", 60)
    dialog.changes(lambda: dialog.toggle("Scale map"), "the scale map is shown")
    names = [plain(node.name) for node in walk(dialog.root)
             if node.getRoleName() == "radio button"]
    dialog.tap.case(names == ["Grid", "Scale map"], "there is no draft of a texture", names)
    dialog.toggle("Grid")
    dialog.tap.case(dialog.says("Drag", seconds=5), "its legend goes with it", dialog.status())
    dialog.window.screenshot("texture")


def waits_for_draft(dialog):
    """What the plane has on it then: the grid's lines alone leave most of the picture one grey."""
    def grey():
        return (np.ptp(dialog.picture(), axis=2) == 0).mean()
    shown = wait_for(lambda: "The new image, as a draft" in dialog.status() and grey() < .6, 30)
    dialog.window.screenshot("texture-laid")
    dialog.tap.case(shown is not None, "the draft is shown", f"{dialog.status()} {grey():.2f}")


def check_laid(dialog):
    """A texture seen from the front: the preview is the new image, onto which it is laid."""
    dialog.set("Width", 800)
    dialog.set("Height", 500)
    dialog.changes(lambda: dialog.choose("From the front"), "a texture from the front is laid", .1)
    waits_for_draft(dialog)
    estimate = dialog.window.button(dialog.root, "Estimate")
    dialog.tap.case(not estimate.getState().contains(pyatspi.STATE_SENSITIVE),
                    "it has no orientation to be read")
    dialog.changes(lambda: dialog.set("Slant", 70), "Slant lays it anew", .05)
    waits_for_draft(dialog)
    dialog.choose("Texture optimization", "baseline")
    dialog.press("OK")
    dialog.tap.case(dialog.says("Choose the one that copies within the plane"),
                    "a method that cannot lay it is told", dialog.status())
    dialog.choose("Copies within the plane")
    waits_for_draft(dialog)
    dialog.set("Slant", 60)


def check_run(dialog, server, host):
    before = server.save(host.folder / "before.xcf")
    count = images(server, host)
    dialog.set("Width", 300)
    dialog.set("Height", 200)
    dialog.press("OK")
    gone = wait_for(lambda: not dialog.alive(), 60)
    dialog.tap.case(gone, "OK closes the dialog", "" if gone else dialog.status())
    dialog.tap.case(images(server, host) == count + 1, "there is one image more")
    dialog.tap.case(dialog.window.frame("300x200", 20) is not None, "and it is shown")
    server.run(NEWEST[host.name] + f'(t-save n "{host.folder}/made.xcf")')
    made = xcf.Image(host.folder / "made.xcf")
    after = server.save(host.folder / "after.xcf")
    dialog.tap.case((made.width, made.height) == (300, 200)
                    and made.layers[0].values.std() > 5, "of the size asked for")
    dialog.tap.case(np.array_equal(before.layers[0].bytes, after.layers[0].bytes),
                    "the picture it was made from is unchanged")


def values(dialog):
    return tuple(dialog.value(label) for label in ("Width", "Height", "Slant"))


def settles_at(dialog, wanted, name):
    good = wait_for(lambda: values(dialog) == wanted, 5)
    dialog.tap.case(good, name, f"{values(dialog)}, not {wanted}")


def check_presets_2(dialog):
    entry = next(node for node in walk(dialog.root) if node.getRoleName() == "text"
                 and node.getState().contains(pyatspi.STATE_EDITABLE))
    text = entry.queryEditableText()
    text.setTextContents("small")
    dialog.press("Save preset")
    dialog.reset()
    settles_at(dialog, (1024, 768, 45), "Reset sets the defaults")
    dialog.choose("small")
    settles_at(dialog, (300, 200, 60), "a preset brings its values back")
    dialog.set("Width", 320)
    dialog.choose("small")
    settles_at(dialog, (300, 200, 60), "and again, after a change")
    dialog.set("Width", 320)
    text.setTextContents("")
    for place, letter in enumerate("small"):
        text.insertText(place, letter, 1)
    time.sleep(.5)
    settles_at(dialog, (320, 200, 60), "typing its name does not")
    dialog.press("Save preset")
    dialog.reset()
    settles_at(dialog, (1024, 768, 45), "Reset sets the defaults again")
    dialog.choose("small")
    settles_at(dialog, (320, 200, 60), "but lets it be saved anew")


def check_presets_3(dialog):
    dialog.window.press(dialog.named("Save Settings"))
    dialog.reset()
    settles_at(dialog, (1024, 768, 45), "Reset sets the defaults")
    dialog.window.press(dialog.named("Load Saved Settings"))
    settles_at(dialog, (300, 200, 60), "saved settings bring their values back")


def check_help(dialog, host, pages):
    dialog.press("Help")
    page = wait_for(lambda: pages.exists() and pages.read_text(), 20)
    url = urlparse((page or "").split("\n")[0])
    path = Path(unquote(url.path))
    good = page and path.is_relative_to(host.installed) and path.exists()
    dialog.tap.case(good and f'id="{url.fragment}"' in path.read_text(),
                    "Help opens the installed page at its place", page)


def check_icon(host, tap):
    entry = host.pluginrc().split('"plug-in-recede-synthesize"')[1].split("(proc-def")[0]
    path = re.search(r'"([^"]*recede\.svg)"', entry)
    tap.case(path and Path(path[1].replace("file://", "")).exists(), "GIMP knows the icon",
             entry[:600])


def main():
    name, plugin, project, artefacts = sys.argv[1:5]
    tap, project = Tap(), Path(project)
    with Host(name, plugin, needed=("help", "web-browser"), settings=[
            "(help-browser web-browser)", "(user-manual-online no)"]) as host, \
            Window(host, Path(artefacts)) as window:
        pages = install_browser(host.folder)
        host.install(project, plugin)
        server = Server(host)
        window.start(project / "docs/images/motorway.jpg", server.script)
        frame = window.frame("960x540", 60)
        server.run(PRELUDE[name] + IMAGE[name] + "(gimp-image-select-rectangle i "
                   "CHANNEL-OP-REPLACE {} {} {} {})".format(*SELECTION))
        window.dismiss_welcome()
        dialog = Dialog(window, tap, MENU)
        dialog.open(frame)
        dialog.says("confidence", seconds=30)
        check_dialog(dialog)
        check_laid(dialog)
        check_run(dialog, server, host)
        dialog.open(frame)
        settles_at(dialog, (300, 200, 60), "the last values are back")
        (check_presets_2 if name == "2" else check_presets_3)(dialog)
        check_help(dialog, host, pages)
        dialog.window.screenshot("texture-again")
        check_icon(host, tap)
        time.sleep(.5)
        log = (Path(artefacts) / f"gimp{name}.log").read_text(errors="replace")
        tap.case("duplicate mnemonic" not in log.lower(), "no mnemonic twice", log[-2000:])
    tap.plan()


main()
