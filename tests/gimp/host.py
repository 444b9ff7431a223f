"""Runs scripts in a real GIMP without a window, the same script in 2.10 and 3.

    host = Host("2" or "3", path of the built plug-in)
    output = host.run('(t-load "/a.png")' ...)

Scripts are Script-Fu; the t-... procedures below hide what differs between the hosts.
"""
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

FILL = ["orientation", "slant", "tilt", "fov", "surface", "source", "method", "quality", "seed",
        "result"]
SYNTHESIZE = ["width", "height"] + [key for key in FILL if key not in ("source", "result")]
DEFAULTS = {"width": 1024, "height": 768, "orientation": "auto", "slant": 45, "tilt": 0, "fov": 50,
            "surface": "auto", "source": None, "method": "plane", "quality": "normal", "seed": 0,
            "result": "in-place"}
CHOICES = {"orientation": ["auto", "angles", "frontal"], "surface": ["flat", "raised", "auto"],
           "method": ["plane", "paper", "kwatra"], "quality": ["draft", "normal", "best"],
           "result": ["in-place", "new-layer"], "exemplar": ["receding", "frontal"]}

PRELUDE = {
    "2": """
(define (t-load path) (car (gimp-file-load RUN-NONINTERACTIVE path path)))
(define (t-layer image) (car (gimp-image-get-active-drawable image)))
(define (t-select-layer image layer) (gimp-image-set-active-layer image layer))
(define (t-save image path)
  (gimp-file-save RUN-NONINTERACTIVE image (t-layer image) path path))
(define t-save-png t-save)
""",
    "3": """
(define (t-load path) (car (gimp-file-load RUN-NONINTERACTIVE path)))
(define (t-layer image) (vector-ref (car (gimp-image-get-selected-drawables image)) 0))
(define (t-select-layer image layer) (gimp-image-set-selected-layers image (vector layer)))
(define (t-save image path) (gimp-file-save RUN-NONINTERACTIVE image path -1))
; Profiles are left out of what scripts export, unless asked for.
(define (t-save-png image path)
  (file-png-export #:run-mode RUN-NONINTERACTIVE #:image image #:file path
                   #:include-color-profile TRUE))
""",
}
SYSTEM_PLUGINS = {"2": "/usr/lib/gimp/2.0/plug-ins",
                  "3": "/usr/lib/x86_64-linux-gnu/gimp/3.0/plug-ins"}
NEEDED = ["script-fu", "file-png", "file-compressor", "file-tiff", "script-fu-server", "file-jpeg",
          "file-glob"]


def choice(key, value):
    return CHOICES[key].index(value)


class Host:
    def __init__(self, name, plugin, needed=(), settings=()):
        self.name, self.folder = name, Path(tempfile.mkdtemp(prefix="recede-gimp"))
        plugins = self.folder / "plug-ins"
        (plugins / "recede").mkdir(parents=True)
        (plugins / "recede" / "recede").symlink_to(Path(plugin).resolve())
        for each in (*NEEDED, *needed):
            if (Path(SYSTEM_PLUGINS[name]) / each).exists():
                (plugins / each).symlink_to(Path(SYSTEM_PLUGINS[name]) / each)
        lines = [f'(plug-in-path "{plugins}")']
        if name == "3":
            lines.append("(show-welcome-dialog no)")
        lines += settings
        self.gimprc = self.folder / "gimprc"
        self.gimprc.write_text("\n".join(lines) + "\n")
        # A cache of its own, without babl's conversions, which cannot be written through the link:
        # Debian 12's babl takes a second of every process's start for reading them.
        self.cache = self.folder / "cache"
        (self.cache / "babl").mkdir(parents=True)
        (self.cache / "babl" / "babl-fishes").symlink_to(self.folder / "nowhere" / "babl-fishes")
        self.status = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        shutil.rmtree(self.folder, ignore_errors=True)

    def install(self, project, plugin):
        """As a user does with ./dev install, into a folder of its own. Returns what was said."""
        user, link = self.folder / "user", self.folder / "plug-ins" / "recede" / "recede"
        variable = "GIMP2_DIRECTORY" if self.name == "2" else "GIMP3_DIRECTORY"
        self.installer = f"{project}/plugin/install.sh"
        self.installing = {**os.environ, "XDG_CONFIG_HOME": str(self.folder / "config"),
                           variable: str(user),
                           "RECEDE_BUILD": str(Path(plugin).resolve().parents[2])}
        done = subprocess.run([self.installer, "install"], env=self.installing,
                              capture_output=True, text=True, check=False)
        self.gimprc.write_text(self.gimprc.read_text().replace(
            str(self.folder / "plug-ins"), f"{self.folder / 'plug-ins'}:{user / 'plug-ins'}"))
        link.unlink()
        self.installed = user / "plug-ins" / "recede"
        return done.stdout + done.stderr

    def uninstall(self):
        subprocess.run([self.installer, "uninstall"], env=self.installing, check=False)

    def environment(self, **more):
        kept = {key: value for key, value in os.environ.items() if key != "DISPLAY"}
        kept["GIMP2_DIRECTORY" if self.name == "2" else "GIMP3_DIRECTORY"] = str(
            self.folder / "profile")
        return {**kept, "XDG_CACHE_HOME": str(self.cache), "LC_ALL": "C.UTF-8", **more}

    def command(self, script, fonts):
        path = self.folder / "script.scm"
        path.write_text(PRELUDE[self.name] + "\n".join(script))
        load = f'(load "{path}")'
        common = ["-g", str(self.gimprc), "-i", "-d", "-s", *([] if fonts else ["-f"])]
        if self.name == "2":
            return ["gimp-console-2.10", *common, "-b", load, "-b", "(gimp-quit 1)"]
        return ["gimp-console-3", *common, "--quit",
                "--batch-interpreter=plug-in-script-fu-eval", "-b", load]

    def run(self, *script, seconds=240, fonts=False, **environment):
        """What GIMP wrote. `done` tells whether the script came to its end."""
        done = subprocess.run(
            ["timeout", "-k", "5", str(seconds),
             *self.command([*script, '(gimp-message "t-done")'], fonts)],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            env=self.environment(**environment), cwd=self.folder, check=False)
        output = done.stdout.decode(errors="replace")
        self.done, self.status = "t-done" in output, done.returncode
        return output

    def pluginrc(self):
        return (self.folder / "profile" / "pluginrc").read_text(errors="replace")

    def call(self, procedure, keys, image, layer, values):
        values = {**{key: DEFAULTS[key] for key in keys}, **values}
        if self.name == "2":
            return self.positional(procedure, keys, image, layer, values)
        words = [f"({procedure} #:run-mode RUN-NONINTERACTIVE #:image {image}"
                 f" #:drawables (vector {layer})"]
        for key in values:
            if values[key] is not None:
                quoted = f'"{values[key]}"' if key in CHOICES else values[key]
                words.append(f"#:{key} {quoted}")
        return " ".join(words) + ")"

    @staticmethod
    def positional(procedure, keys, image, layer, values):
        words = [f"({procedure} RUN-NONINTERACTIVE {image} {layer}"]
        for key in keys:
            value = -1 if values[key] is None else values[key]
            words.append(str(choice(key, value) if key in CHOICES else value))
        return " ".join(words) + ")"

    def fill(self, image="i", layer="d", **values):
        return self.call("plug-in-recede-fill", FILL, image, layer, values)

    def synthesize(self, image="i", layer="d", **values):
        return self.call("plug-in-recede-synthesize", SYNTHESIZE, image, layer, values)

    def precision(self, name):
        """A PRECISION constant: "u8", "u16-linear", "float" ..."""
        encoding = "LINEAR" if name.endswith("-linear") else (
            "GAMMA" if self.name == "2" else "NON-LINEAR")
        return f"PRECISION-{name.split('-')[0].upper()}-{encoding}"


class Tap:
    """Prints cases as TAP, the plan at the end."""

    def __init__(self):
        self.count = 0

    def case(self, good, name, detail=""):
        self.count += 1
        print(f"{'ok' if good else 'not ok'} {self.count} - {name}", flush=True)
        if not good and detail:
            print("\n".join("# " + line for line in str(detail).splitlines()[-25:]), flush=True)
        return good

    def plan(self):
        print(f"1..{self.count}")
