"""GIMP in a window of its own display, driven by its accessibility tree.

    with Window(host, artefacts) as window: ...

Needs Xvfb, openbox, dbus-daemon, xdotool's place taken by AT-SPI's own key and mouse events. The
script under test runs inside `dbus-run-session` (see windowed.sh).
"""
import os
import re
import signal
import subprocess
import time

import pyatspi

NAMES = {"2": "gimp-2.10", "3": "gimp-3.0"}
TIMEOUT = 40


def wait_for(what, seconds=TIMEOUT, step=.2):
    """The first true value of what(), or None."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        try:
            value = what()
        except Exception:  # the tree changes while it is read
            value = None
        if value:
            return value
        time.sleep(step)
    return None


def walk(node, depth=0):
    yield node
    if depth > 24:
        return
    for index in range(node.childCount):
        child = node.getChildAtIndex(index)
        if child is not None:
            yield from walk(child, depth + 1)


def plain(text):
    return re.sub(r"\.\.\.$| \(.*\)$", "", re.sub(r"[:_…]", "", text or "")).strip()


class Window:
    def __init__(self, host, artefacts):
        self.host, self.artefacts = host, artefacts
        self.process = None
        artefacts.mkdir(parents=True, exist_ok=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process:
            os.killpg(self.process.pid, signal.SIGKILL)  # its plug-ins too
            self.process.wait()

    def start(self, picture, *script):
        """GIMP with a picture opened, and a script that it runs then."""
        from host import PRELUDE
        path = self.host.folder / "window.scm"
        path.write_text(PRELUDE[self.host.name] + "\n".join(script))
        command = [NAMES[self.host.name], "-g", str(self.host.gimprc), "-n", "-d", "-f", "-s"]
        if self.host.name == "3":
            command.append("--batch-interpreter=plug-in-script-fu-eval")
        environment = self.host.environment(DISPLAY=os.environ["DISPLAY"],
                                            GTK_MODULES="gail:atk-bridge", NO_AT_BRIDGE="0",
                                            LC_ALL=os.environ.get("RECEDE_TEST_LOCALE", "C.UTF-8"))
        self.log = open(self.artefacts / f"gimp{self.host.name}.log", "w", encoding="utf-8")
        self.process = subprocess.Popen([*command, "-b", f'(load "{path}")', str(picture)],
                                        env=environment, stdin=subprocess.DEVNULL, stdout=self.log,
                                        stderr=subprocess.STDOUT, start_new_session=True)

    def applications(self):
        desktop = pyatspi.Registry.getDesktop(0)
        return [desktop.getChildAtIndex(i) for i in range(desktop.childCount)]

    def frame(self, title, seconds=TIMEOUT):
        """A window whose title has title in it."""
        def look():
            for application in self.applications():
                for index in range(application.childCount):
                    window = application.getChildAtIndex(index)
                    if title in (window.name or ""):
                        return window
            return None
        return wait_for(look, seconds)

    @staticmethod
    def find(root, roles, name=None, seconds=10):
        def look():
            for node in walk(root):
                if node.getRoleName() in roles and (name is None or plain(node.name) == name):
                    return node
            return None
        return wait_for(look, seconds)

    @staticmethod
    def spin(root, label):
        """The spin button with a label: by its own name, its relation, or its place after it."""
        def look():
            nodes = list(walk(root))
            for node in nodes:
                if node.getRoleName() != "spin button":
                    continue
                if plain(node.name) == label:
                    return node
                for relation in node.getRelationSet():
                    if relation.getRelationType() == pyatspi.RELATION_LABELLED_BY:
                        if plain(relation.getTarget(0).name) == label:
                            return node
            for index, node in enumerate(nodes):
                if node.getRoleName() == "label" and plain(node.name) == label:
                    near = nodes[max(0, index - 12) : index + 12]
                    found = [n for n in near if n.getRoleName() == "spin button"]
                    if found:
                        return min(found, key=lambda n: abs(nodes.index(n) - index))
            return None
        return wait_for(look, 10)

    @staticmethod
    def press(node):
        node.queryAction().doAction(0)

    def button(self, root, name, seconds=10):
        return self.find(root, ("push button", "button"), name, seconds)

    def menu(self, frame, *path):
        for index, name in enumerate(path):
            roles = ("menu",) if index + 1 < len(path) else ("menu item",)
            item = self.find(frame, roles, name)
            if item is None:
                raise LookupError(f"no menu {name}")
            if index + 1 == len(path):
                self.press(item)
                return
            frame = item

    def undo(self, frame):
        """Edit > Undo, as GIMP names it."""
        edit = self.find(frame, ("menu",), "Edit")
        self.press(edit)  # its items are brought up to date when it opens
        item = wait_for(lambda: next((node for node in walk(edit) if (node.name or "").startswith(
            ("Undo", "_Undo"))), None), 10)
        name = item.name
        self.press(item)
        return name

    def dismiss_welcome(self):
        """GIMP 3 greets a new profile."""
        welcome = self.frame("Welcome", 2)
        if welcome:
            self.press(self.button(welcome, "Close"))

    def screenshot(self, name):
        path = self.artefacts / f"gimp{self.host.name}-{name}.png"
        subprocess.run(["import", "-window", "root", str(path)], check=False, timeout=20)
        return path

    @staticmethod
    def extents(node):
        box = node.queryComponent().getExtents(pyatspi.DESKTOP_COORDS)
        return box.x, box.y, box.width, box.height

    @staticmethod
    def drag(start, end, steps=8):
        move = pyatspi.Registry.generateMouseEvent
        move(int(start[0]), int(start[1]), "abs")
        time.sleep(.2)
        move(int(start[0]), int(start[1]), "b1p")
        for step in range(1, steps + 1):
            time.sleep(.04)
            move(int(start[0] + (end[0] - start[0]) * step / steps),
                 int(start[1] + (end[1] - start[1]) * step / steps), "abs")
        time.sleep(.1)
        move(int(end[0]), int(end[1]), "b1r")
        time.sleep(.3)
