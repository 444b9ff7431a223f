#!/usr/bin/env python3
"""The procedures as GIMP registers them, held against the core's table as the command tells it, and
what they say when they cannot work.

procedures.py HOST PLUGIN TABLE: TABLE prints the core's table (tests/gimp/table.c).
"""
import re
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
from host import FILL, SYNTHESIZE, Host, Tap

TYPES = {"2": {"double": "3", "int": "0", "choice": "0", "drawable": "16"},
         "3": {"double": "GParamDouble", "int": "GParamInt", "choice": "GimpParamChoice",
               "drawable": "GimpParamDrawable"}}
HOST_CHOICES = {"orientation": 3}  # a line or four points are no arguments of a procedure
OWN = {  # arguments that only a host can have
    "width": ("int", "1", "262144", "1024"),
    "height": ("int", "1", "262144", "768"),
    "source": ("drawable",),
    "result": ("choice", ["in-place", "new-layer"], "in-place"),
}


def number(text):
    return f"{float(text):.12g}"


def core_table(program):
    """key -> (type, low, high, default) or ("choice", nicks, default), rows for hosts only."""
    table = {}
    for line in subprocess.run([program], capture_output=True, text=True,
                               check=True).stdout.splitlines():
        key, kind, low, high, default, nicks = line.split("\t")
        if kind == "choice":
            nicks = nicks.split()[: HOST_CHOICES.get(key)]
            table[key] = ("choice", nicks, nicks[int(float(default))])
        else:
            table[key] = (kind, number(low), number(high), number(default))
    return table


def registered(host, procedure):
    """key -> the same, as GIMP's own list of procedures has it, in its order."""
    text = host.pluginrc().split(f'(proc-def "{procedure}"')[1].split("(proc-def")[0]
    found = {}
    for line in re.findall(r"\(proc-arg (.*)\)", text)[3:]:
        words = re.findall(r'"(?:[^"\\]|\\.)*"|[^\s()"]+', line.split("\n")[0])
        words = [word.strip('"') for word in words]
        if host.name == "2":
            kind, key, blurb = words[0], words[1], words[2]
            found[key] = (kind, *from_blurb(blurb))
        else:
            kind, key, rest = words[1], words[3], words[7:]
            if kind == "GimpParamChoice":
                nicks = [rest[2 + 4 * i] for i in range(int(rest[1]))]
                found[key] = (kind, nicks, rest[0])
            elif kind == "GimpParamDrawable":
                found[key] = (kind,)
            else:
                found[key] = (kind, *map(number, rest[:3]))
    return found


def from_blurb(blurb):
    """2.10 knows no ranges: they stand in the description."""
    if match := re.search(r"\{ (.*) \} \(default (\d+)\)$", blurb):
        nicks = re.findall(r"([\w-]+) \(\d+\)", match[1])
        return nicks, nicks[int(match[2])]
    if match := re.search(r"\((\S+) <= [\w-]+ <= (\S+); default (\S+)\)$", blurb):
        return tuple(number(part) for part in match.groups())
    return ()


def check_arguments(host, tap, table):
    host.run("")
    table = {**table, **OWN}
    for procedure, keys in (("fill", FILL), ("synthesize", SYNTHESIZE)):
        theirs = registered(host, f"plug-in-recede-{procedure}")
        expected = [key for key in keys]
        tap.case(list(theirs)[: len(keys)] == expected, f"{procedure}: arguments and their order",
                 f"{list(theirs)}\n{expected}")
        for key in keys:
            want = (TYPES[host.name][table[key][0]], *table[key][1:])
            tap.case(theirs.get(key) == want, f"{procedure}: {key}", f"{theirs.get(key)}\n{want}")
    # Came after the order was fixed: in 2.10, whose scripts give all arguments, it has its default.
    theirs = registered(host, "plug-in-recede-synthesize")
    late = {"2": None, "3": ("GimpParamChoice", *table["exemplar"][1:])}[host.name]
    tap.case(theirs.get("exemplar") == late, "synthesize: exemplar", list(theirs))
    core_keys = [key for key in FILL if key not in ("source", "result")] + ["exemplar"]
    tap.case([key for key in table if key not in OWN] == core_keys, "the table's order",
             list(table))


def new_group(host):
    return ("(gimp-layer-group-new i)" if host.name == "2" else '(gimp-group-layer-new i "group")')


def errors(host):
    """(name, script after i and d are there, words that the message must have)."""
    select = "(gimp-image-select-rectangle i CHANNEL-OP-REPLACE 20 20 20 20)"
    frontal = {"orientation": "frontal"}
    yield "no selection", host.fill(**frontal), "Nothing is selected"
    yield ("a selection outside the layer",
           select + "(gimp-layer-set-offsets d 200 200)" + host.fill(**frontal),
           "outside the layer")
    yield ("everything selected", "(gimp-selection-all i)" + host.fill(**frontal),
           "covers all of the layer that is selected")
    other = "(define j (car (gimp-image-duplicate i)))(define e (t-layer j))" + select
    yield "another image's layer", other + host.fill(layer="e", **frontal), "another image"
    yield ("another image's texture", other + host.synthesize(layer="e", **frontal),
           "another image")
    yield ("a group", f"(define g (car {new_group(host)}))(gimp-image-insert-layer i g 0 0)"
           + select + host.fill(layer="g", **frontal), "layer group")
    yield ("indexed", select + "(gimp-image-convert-indexed i CONVERT-DITHER-NONE"
           ' CONVERT-PALETTE-GENERATE 16 FALSE FALSE "")' + host.fill(**frontal), "indexed")
    yield ("locked", "(gimp-item-set-lock-content d TRUE)" + select + host.fill(**frontal),
           "locked")
    yield ("in a locked group",
           f"(define g (car {new_group(host)}))(gimp-image-insert-layer i g 0 0)"
           "(gimp-image-reorder-item i d g 0)(gimp-item-set-lock-content g TRUE)" + select
           + host.fill(**frontal), "group around it, are locked")
    mask = "(car (gimp-layer-create-mask d ADD-MASK-WHITE))"
    yield ("the mask of a locked layer",
           f"(define m {mask})(gimp-layer-add-mask d m)(gimp-item-set-lock-content d TRUE)"
           + select + host.fill(layer="m", **frontal), "group around it, are locked")
    yield ("floating", select + ("(gimp-edit-copy d)(define f (car (gimp-edit-paste d TRUE)))"
                                 if host.name == "2" else
                                 "(gimp-edit-copy (vector d))"
                                 "(define f (vector-ref (car (gimp-edit-paste d TRUE)) 0))")
           + host.fill(layer="f", **frontal), "floating selection")
    # GIMP 3 loads fonts beside all else: the list waits for them, the context may have none yet.
    font = '"Sans"' if host.name == "2" else '(vector-ref (car (gimp-fonts-get-list "Sans")) 0)'
    text = f'(gimp-text-layer-new i "a" {font} 20 UNIT-PIXEL)'
    yield ("a text layer", f"(define t (car {text}))(gimp-image-insert-layer i t 0 0)" + select
           + host.fill(layer="t", **frontal), "Discard Text Information")
    yield ("beyond the horizon", select + host.fill(orientation="angles", slant=130),
           "beyond the horizon")
    yield ("slant out of range", select + host.fill(orientation="angles", slant=190),
           "slant.*190|190.*slant|out of range")
    yield ("a source that is none", select + host.fill(source=4711, **frontal),
           "source|invalid|argument")
    if host.name == "3":
        yield ("a texture from the front without angles", host.synthesize(exemplar="frontal"),
               "Set slant and tilt")
        yield ("a new layer above one with filters", select
               + '(gimp-drawable-append-new-filter d "gegl:invert-gamma" "" LAYER-MODE-REPLACE 1.0)'
               + host.fill(result="new-layer", **frontal), "has filters")
        yield ("two layers", select + "(define e (car (gimp-layer-copy d)))"
               "(gimp-image-insert-layer i e 0 0)" + host.fill(layer="d e", **frontal),
               "exactly one")
    if host.name == "2":
        yield ("too few arguments", select + "(plug-in-recede-fill RUN-NONINTERACTIVE i d 0)",
               "[Aa]rguments")


def check_errors(host, tap):
    random = np.random.default_rng(1)
    path = host.folder / "noise.png"
    cv2.imwrite(str(path), random.integers(0, 256, (64, 64, 3), np.uint8))
    for name, script, words in errors(host):
        output = host.run(f'(define i (t-load "{path}"))', "(define d (t-layer i))", script,
                          seconds=200, fonts="text" in name)
        tap.case(not host.done and re.search(words, output), f"says: {name}", output)


def main():
    name, plugin, table = sys.argv[1:4]
    tap = Tap()
    with Host(name, Path(plugin)) as host:
        check_arguments(host, tap, core_table(table))
        check_errors(host, tap)
    tap.plan()


main()
