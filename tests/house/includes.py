#!/usr/bin/python3
"""The direction of includes, as TAP. Usage: includes.py PROJECT

base <- image <- plane <- synthesis <- recede.c <- {cli, plugin}; kernels stand on base alone; the
command and the plug-in see only recede.h. Within synthesis, above its own headers, sources <-
structure <- search <- composition <- fill_plane.c, plane_bytes.c and steps.c, and paper by itself.
"""
import re
import sys
from pathlib import Path

INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.M)
# What all rooms of synthesis/ may include: what every method is asked, and the lower rooms.
SHARED = {"synthesis", "plane", "image", "base", "kernels"}
SOURCES = {"synthesis/sources"}
STRUCTURE = {"synthesis/structure"} | SOURCES
SEARCH = {"synthesis/search"} | STRUCTURE
COMPOSITION = {"synthesis/composition"} | SEARCH
PAPER = {"synthesis/paper"}
# What the files of a room may include from core/, besides recede.h. "": core's own top level.
MAY = {
    "base": {"base"},
    "kernels": {"kernels", "base"},
    "image": {"image", "base", "kernels"},
    "plane": {"plane", "image", "base", "kernels"},
    "synthesis/sources": SHARED | SOURCES,
    "synthesis/structure": SHARED | STRUCTURE,
    "synthesis/search": SHARED | SEARCH,
    "synthesis/composition": SHARED | COMPOSITION,
    "synthesis/paper": SHARED | PAPER,
    "synthesis": SHARED,
    "the stages": SHARED | COMPOSITION,
    "": {""} | SHARED | PAPER,
}
PUBLIC = "recede.h"


def core_room(path, core):
    folder = path.relative_to(core).parent.as_posix()
    if path.name in ("fill_plane.c", "plane_bytes.c", "steps.c"):
        return "the stages"
    return "" if folder == "." else folder


def target(source, name, project):
    """The project's file that `#include "name"` in source means, or None (a generated one)."""
    for folder in (source.parent, project / "core", project, project / "plugin" / "common"):
        path = (folder / name).resolve()
        if path.exists() and project in path.parents:
            return path
    return None


def faults(source, project):
    core = project / "core"
    for name in INCLUDE.findall(source.read_text(encoding="utf-8")):
        path = target(source, name, project)
        if path is None or path == core / PUBLIC:
            continue
        if core in source.parents:
            room = core_room(source, core)
            if room not in MAY:
                yield f"{name}: core/{room} is no room the rule knows"
            elif core not in path.parents:
                yield f"{name} is not in core/"
            elif core_room(path, core) not in MAY[room]:
                yield f"{name}: core/{room or '*.c'} may not include core/{core_room(path, core)}"
        elif core in path.parents:
            yield f"{name}: only {PUBLIC} may be seen outside core/"
        elif path.relative_to(project).parts[0] != source.relative_to(project).parts[0]:
            yield f"{name} belongs to {path.relative_to(project).parts[0]}/"


def main():
    project = Path(sys.argv[1]).resolve()
    sources = sorted(
        path
        for top in ("core", "cli", "plugin")
        for path in (project / top).rglob("*")
        if path.suffix in (".c", ".h", ".cpp")
    )
    print(f"1..{len(sources)}")
    for number, source in enumerate(sources, 1):
        found = list(faults(source, project))
        print(f"{'not ' if found else ''}ok {number} - {source.relative_to(project)}")
        for fault in found:
            print(f"# {fault}")
    return 1 if not sources else 0


sys.exit(main())
