"""What the tests of the command share: running it, pictures made for it, and TAP.

A test file defines functions named test_*; its last line is `harness.main(globals())`. The
arguments are the command and many.c. A test fails by an exception, mostly from check().
"""
import json
import os
import resource
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import traceback
from pathlib import Path

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
import cv2  # noqa: E402 - it reads the variable when it is imported
import numpy as np  # noqa: E402

RECEDE = os.path.abspath(sys.argv[1])
TEXTURE = Path(__file__).parents[1] / "data" / "brick_regular.png"
# recede() runs there what asks for no process of its own, and returns from main(): --help exits.
MANY = None
ONE_BY_ONE = "RECEDE_TEST_ONE_BY_ONE" in os.environ
# Generous: a sanitizer's build is twenty times slower than the command.
TIME_LIMIT_S = 60


# Under sanitizers the same code is run, less often: each run takes several times as long.
SANITIZED = "ASAN_OPTIONS" in os.environ
DRAFT = ["--quality", "draft"]
if SANITIZED:
    # Leaks of libraries are told by who allocated, which the fast unwinder does not see through
    # libraries without frame pointers.
    os.environ["ASAN_OPTIONS"] += ":fast_unwind_on_malloc=0"


class Failure(Exception):
    pass


class Skip(Exception):
    pass


def check(condition, *explanation):
    if not condition:
        raise Failure(" ".join(str(part) for part in explanation) or "condition not met")


def checked(done, more=b""):
    """Of a finished process: nothing that a sanitizer found, in its words or in more."""
    text = (done.stderr + more).decode(errors="replace")
    check("Sanitizer" not in text and "runtime error" not in text, done.args, text)
    return done


def recede(*arguments, code=0, environment=None, prepare=None, folder=None):
    """Runs the command, checks its exit code (None: any), and returns the finished process. Under
    sanitizers fills are drafts: what the engine does is run by its own tests."""
    words = [os.fspath(a) if isinstance(a, Path) else str(a) for a in arguments]
    if SANITIZED and words[:1] in (["fill"], ["synthesize"]) and "--quality" not in words:
        words[1:1] = DRAFT
    if all(words) and "--help" not in words and not (environment or prepare or folder
                                                     or ONE_BY_ONE):
        done = MANY.run(*words)
    else:
        try:
            done = checked(subprocess.run([RECEDE, *words], stdin=subprocess.DEVNULL, cwd=folder,
                                          capture_output=True, timeout=TIME_LIMIT_S,
                                          env={**os.environ, **(environment or {})},
                                          preexec_fn=prepare))
        except subprocess.TimeoutExpired as late:
            raise Failure(f"took more than {TIME_LIMIT_S} s: {words}") from late
    if code is not None:
        check(done.returncode == code, words, "ended with", done.returncode, "not", code,
              done.stderr.decode(errors="replace"))
    return done


class Many:
    """Runs the command in children of one process that has its libraries loaded already: a tenth
    of the time."""

    def __init__(self, folder, prepare=None, environment=None):
        self.paths = [folder / name for name in ("stdout", "stderr", "leaks")]
        self.process = subprocess.Popen([os.path.abspath(sys.argv[2])], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, preexec_fn=prepare,
                                        start_new_session=True,
                                        env={**os.environ, **(environment or {})})

    def __enter__(self):
        return self

    def limit(self, what, most):
        """The soft limit of a resource for the runs that follow."""
        _, hard = resource.getrlimit(what)
        resource.prlimit(self.process.pid, what, (most, hard))

    def __exit__(self, *_):
        self.process.stdin.close()
        self.process.wait(TIME_LIMIT_S)
        self.process.stdout.close()

    def run(self, *arguments, kill_after_s=None):
        """The finished process; for a run that a signal ended, its code is minus the number."""
        self.paths[2].write_bytes(b"")
        words = [*self.paths, *arguments, ""]
        self.process.stdin.write(b"".join(os.fsencode(str(word)) + b"\0" for word in words))
        self.process.stdin.flush()
        if kill_after_s is not None:
            time.sleep(kill_after_s)
            for child in Path(f"/proc/{self.process.pid}/task/{self.process.pid}/children") \
                    .read_text().split():
                os.kill(int(child), signal.SIGKILL)
        ready, _, _ = select.select([self.process.stdout], [], [], TIME_LIMIT_S)
        if not ready:
            os.killpg(self.process.pid, signal.SIGKILL)
            raise Failure(f"took more than {TIME_LIMIT_S} s: {arguments}")
        code = int(self.process.stdout.readline())
        out, error, leaks = (path.read_bytes() for path in self.paths)
        return checked(subprocess.CompletedProcess(arguments, code, out, error), leaks)


def preloaded(folder, source):
    """The environment in which functions of the C library are those of this C source."""
    if SANITIZED:
        raise Skip("a sanitizer wants to be the first library")
    (folder / "preloaded.c").write_text(source)
    library = folder / "preloaded.so"
    if subprocess.run(["cc", "-shared", "-fPIC", "-o", library, folder / "preloaded.c"],
                      check=False).returncode != 0:
        raise Skip("no compiler here")
    return {"LD_PRELOAD": str(library)}


def report_of(*arguments, **options):
    """The JSON that the command prints for these arguments."""
    return json.loads(recede(*arguments, "--json", "-", **options).stdout)


def texture(height=48, width=64, channels=3, kind="u8"):
    """A picture with structure at every size; float ones reach below 0 and above 1."""
    whole = cv2.imread(str(TEXTURE))
    rgb = cv2.resize(whole, (width, height), interpolation=cv2.INTER_AREA).astype(np.float64) / 255
    noise = np.random.default_rng(7).normal(0, .02, rgb.shape)
    colours = rgb + noise
    if channels < 3:
        colours = colours[:, :, 1:2]
    if channels % 2 == 0:
        colours = np.dstack([colours, np.ones((height, width))])
    if kind == "u8":
        made = (colours.clip(0, 1) * 255).round().astype(np.uint8)
    elif kind == "u16":
        made = (colours.clip(0, 1) * 65535).round().astype(np.uint16)
    else:
        made = (colours * 1.3 - .1).astype(np.float32)
        if channels % 2 == 0:
            made[:, :, -1] = 1
        if kind == "half":
            made = made.astype(np.float16).astype(np.float32)
    return made.squeeze()


def hole(height=48, width=64, box=(16, 30, 20, 40)):
    """A mask that is white in rows box[0]..box[1], columns box[2]..box[3]."""
    mask = np.zeros((height, width), np.uint8)
    mask[box[0]:box[1], box[2]:box[3]] = 255
    return mask


def write(path, pixels, half=False):
    """cv2 keeps channels in the order blue, green, red, here and when read again."""
    parameters = []
    if path.suffix == ".tif":
        parameters = [cv2.IMWRITE_TIFF_COMPRESSION, 8]  # cv2's default for floats is lossy
    if path.suffix == ".exr":
        parameters = [cv2.IMWRITE_EXR_TYPE,
                      cv2.IMWRITE_EXR_TYPE_HALF if half else cv2.IMWRITE_EXR_TYPE_FLOAT]
    if path.suffix == ".jpg":
        parameters = [cv2.IMWRITE_JPEG_QUALITY, 95]
    check(cv2.imwrite(str(path), pixels, parameters), "cannot write", path)
    return path


def read(path):
    flags = cv2.IMREAD_UNCHANGED
    pixels = cv2.imdecode(np.frombuffer(Path(path).read_bytes(), np.uint8), flags)
    check(pixels is not None, "not readable:", path)
    return pixels


def same_bits(a, b):
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()


def strays(folder):
    """Temporary files that were left behind."""
    return [path for path in Path(folder).rglob(".recede-*")]


def run_one(function):
    folder = Path(tempfile.mkdtemp(prefix="recede-test-"))
    try:
        function(folder)
        left = strays(folder)
        check(not left, "temporary files left:", left)
        return None
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def run_all(tests):
    """How many failed."""
    failed = 0
    for number, function in enumerate(tests, 1):
        name = function.__name__[5:].replace("_", " ")
        began = time.monotonic()
        try:
            run_one(function)
            print(f"ok {number} - {name}", flush=True)
        except Skip as why:
            print(f"ok {number} - {name} # SKIP {why}", flush=True)
        except Exception as error:  # noqa: BLE001 - every fault of a test is its failure
            failed += 1
            print(f"not ok {number} - {name}", flush=True)
            text = str(error) if isinstance(error, Failure) else traceback.format_exc()
            print("\n".join("# " + line for line in text.splitlines()), flush=True)
        print(f"# {time.monotonic() - began:.1f} s", flush=True)
    return failed


def main(names):
    global MANY
    signal.signal(signal.SIGINT, signal.default_int_handler)
    tests = [value for name, value in names.items() if name.startswith("test_")]
    print(f"1..{len(tests)}")
    with tempfile.TemporaryDirectory(prefix="recede-test-") as folder, Many(Path(folder)) as MANY:
        sys.exit(run_all(tests) > 0)
