"""Output files are whole or untouched: full disks, signals, kill -9, two writers."""
import os
import random
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import harness
from harness import check, hole, read, recede, same_bits, strays, texture, write

SUFFIXES = {"png": "u8", "jpg": "u8", "tif": "u16", "exr": "half"}
SIZES = 20  # of room on a disk that is too small
PAGE = 4096
OLD = b"the old file, which must stay as it is\n" * 20


def job(folder, suffix="png", kind="u8"):
    """Arguments of a fill into out.suffix, which is what a complete output is compared with."""
    image = write(folder / f"in.{suffix}", texture(kind=kind), half=kind == "half")
    mask = write(folder / "mask.png", hole())
    return ["fill", image, "--mask", mask, "--frontal", "-q", *harness.DRAFT]


def expected(folder, arguments, suffix="png"):
    out = folder / f"expected.{suffix}"
    recede(*arguments, "-o", out, "--force")
    return out.read_bytes()


def start(*arguments):
    return subprocess.Popen([harness.RECEDE, *map(str, arguments)], stderr=subprocess.PIPE,
                            stdout=subprocess.DEVNULL)


def test_refuses_to_overwrite(folder):
    arguments = job(folder)
    out = folder / "out.png"
    out.write_bytes(OLD)
    check(b"--force" in recede(*arguments, "-o", out, code=4).stderr)
    check(out.read_bytes() == OLD)
    recede(*arguments, "-o", out, "--force")
    check(out.read_bytes() == expected(folder, arguments))


def test_places_that_cannot_be_written(folder):
    arguments = job(folder)
    recede(*arguments, "-o", folder / "none" / "out.png", code=4)
    recede(*arguments, "-o", folder / "in.png" / "out.png", code=4)
    (folder / "dir.png").mkdir()
    recede(*arguments, "-o", folder / "dir.png", "--force", code=4)
    recede(*arguments, "-o", folder / ("n" * 300 + ".png"), code=4)
    recede(*arguments, "-o", "/proc/out.png", code=4)
    os.mkfifo(folder / "pipe.png")
    recede(*arguments, "-o", folder / "pipe.png", "--force", code=4)
    if os.geteuid() != 0:  # root may write anywhere
        (folder / "locked").mkdir(mode=0o500)
        recede(*arguments, "-o", folder / "locked" / "out.png", code=4)


def test_the_input_may_be_the_output(folder):
    arguments = job(folder)
    whole = expected(folder, arguments)
    recede(*arguments, "-o", folder / "in.png", "--force")
    check((folder / "in.png").read_bytes() == whole)


def test_other_inputs_may_not_be_the_output(folder):
    arguments = job(folder)
    mask = folder / "mask.png"
    source = write(folder / "source.png", 255 - hole())
    (folder / "link.png").symlink_to("source.png")
    before = mask.read_bytes(), source.read_bytes()
    for name, option in (("mask.png", b"--mask"), ("source.png", b"--source"),
                         ("link.png", b"--source")):
        done = recede(*arguments, "--source", source, "-o", folder / name, "--force", code=2)
        check(b"the same file as " + option in done.stderr, done.stderr)
    recede("synthesize", folder / "in.png", "--source", source, "--size", "9x9", "--frontal", "-o",
           source, "--force", code=2)
    check((mask.read_bytes(), source.read_bytes()) == before, "a mask was replaced")


def test_the_other_pages_stay(folder):
    """A file of several pictures is not replaced by the one of them that was filled."""
    write(folder / "a.png", texture())
    pages = folder / "pages.tif"
    subprocess.run(["convert", folder / "a.png", folder / "a.png", pages], check=True)
    before = pages.read_bytes()
    mask = write(folder / "mask.png", hole())
    for command in (["fill", pages, "--mask", mask], ["synthesize", pages, "--size", "70x50"]):
        done = recede(*command, "--frontal", "-o", pages, "--force", code=4)
        check(b"another name" in done.stderr and pages.read_bytes() == before, done.stderr)


def test_links_and_permissions_stay(folder):
    arguments = job(folder)
    target = folder / "target.png"
    target.write_bytes(OLD)
    target.chmod(0o640)
    (folder / "link.png").symlink_to("target.png")
    recede(*arguments, "-o", folder / "link.png", "--force")
    check((folder / "link.png").is_symlink() and target.read_bytes() == expected(folder, arguments))
    check(target.stat().st_mode & 0o777 == 0o640, oct(target.stat().st_mode))
    recede(*arguments, "-o", folder / "new.png", prepare=lambda: os.umask(0o027))
    check((folder / "new.png").stat().st_mode & 0o777 == 0o640)


def test_a_link_to_nothing(folder):
    (folder / "link.png").symlink_to("none.png")
    said = recede(*job(folder), "-o", folder / "link.png", "--force", code=4).stderr
    check(b"link" in said and b"folder" not in said, said)


def test_standard_output_is_no_file(folder):
    arguments = job(folder)
    for more in (["-o", "/dev/stdout", "--force"], ["-o", folder / "x.png", "--json",
                                                    "/dev/stdout"]):
        run = subprocess.run([harness.RECEDE, *map(str, [*arguments, *more])], check=False,
                             timeout=60, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        check(run.returncode == 4 and b"no ordinary file; write to a file" in run.stderr, run)


POOR = """
#include <errno.h>
int renameat2(int a, const char *b, int c, const char *d, unsigned f) { errno = EINVAL; return -1; }
int link(const char *a, const char *b) { errno = EPERM; return -1; }
"""


def test_file_systems_without_links(folder):
    """Some FUSE mounts can neither link nor rename without replacing."""
    poor = harness.preloaded(folder, POOR)
    arguments = job(folder)
    out = folder / "out.png"
    recede(*arguments, "-o", out, environment=poor)
    check(out.read_bytes() == expected(folder, arguments))
    check(out.stat().st_mode & 0o777 == (folder / "in.png").stat().st_mode & 0o777)
    out.write_bytes(OLD)
    recede(*arguments, "-o", out, environment=poor, code=4)
    check(out.read_bytes() == OLD)


def check_failed_write(code, out, before):
    """A write that failed ends with 4; a file that was there stays, none appears that was not."""
    check(code == 4, out.name, "ended with", code)
    check((out.read_bytes() if out.exists() else None) == before, out.name, "changed")
    check(not strays(out.parent), out.name, "left", strays(out.parent))


def noisy_job(folder, suffix, kind, size=220):
    """An output of some hundred kB: noise packs badly; without the stages that look at it all."""
    noise = random.Random(5).randbytes(size * size * 3)
    pixels = harness.np.frombuffer(noise, harness.np.uint8).reshape(size, size, 3)
    if kind != "u8":
        pixels = pixels.astype(harness.np.uint16) * 257 if kind == "u16" \
            else (pixels / 255).astype(harness.np.float32)
    if suffix == "tga":  # cv2 writes none
        suffix = "png"
    image = write(folder / f"in.{suffix}", pixels, half=kind == "half")
    mask = write(folder / "mask.png", hole(size, size))
    fast = [f"--set=engine-{stage}=0" for stage in ("periods", "alike", "spots", "lines")]
    return ["fill", image, "--mask", mask, "--frontal", "-q", "--quality", "draft", *fast]


def test_file_size_limit(folder):
    with harness.Many(folder) as many:
        for suffix, kind in SUFFIXES.items():
            arguments = noisy_job(folder, suffix, kind)
            (folder / f"old.{suffix}").write_bytes(OLD)
            size = len(expected(folder, arguments, suffix))
            for part in (.001, .9) if harness.SANITIZED else (0, .001, .2, .5, .9, .9999):
                many.limit(resource.RLIMIT_FSIZE, int(size * part))
                for name, before in (("out", None), ("old", OLD)):
                    out = folder / f"{name}.{suffix}"
                    done = many.run(*arguments, "-o", out, "--force")
                    check_failed_write(done.returncode, out, before)


def test_full_disk(folder):
    """A small file system in memory, filled but for 0 .. 100 % of what the output takes."""
    disk = folder / "disk"
    disk.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=4m", "tmpfs", str(disk)],
                      stderr=subprocess.DEVNULL, check=False).returncode != 0:
        raise harness.Skip("mounting a file system is not allowed here")
    try:
        with harness.Many(folder) as many:
            for suffix, kind in {**SUFFIXES, "bmp": "u8", "tga": "u8"}.items():
                fill_up(many, folder, disk, suffix, kind)
    finally:
        subprocess.run(["umount", "--lazy", str(disk)], check=True)


def fill_up(many, folder, disk, suffix, kind):
    arguments = noisy_job(folder, suffix, kind, 300)
    size = len(expected(folder, arguments, suffix))
    check(size // PAGE > SIZES, suffix, "is too small for", SIZES, "sizes of room")
    out = disk / f"out.{suffix}"
    for number in range(0, SIZES, 7 if harness.SANITIZED else 1):
        for path in disk.iterdir():
            path.unlink()
        before = OLD if number % 2 else None
        if before:
            out.write_bytes(before)
        free = os.statvfs(disk).f_bavail * os.statvfs(disk).f_frsize
        (disk / "ballast").write_bytes(bytes(free - size * number // SIZES // PAGE * PAGE))
        done = many.run(*arguments, "-o", out, "--force")
        check_failed_write(done.returncode, out, before)


def test_kill_at_any_moment(folder):
    """After kill -9 the output is absent (or the old one) or complete."""
    source = random.Random(6)
    ends = {"absent": 0, "old": 0, "complete": 0}
    with harness.Many(folder) as many:
        for suffix, kind in SUFFIXES.items():
            arguments = job(folder, suffix, kind)
            whole = expected(folder, arguments, suffix)
            began = time.monotonic()
            many.run(*arguments, "-o", folder / f"usual.{suffix}")
            usual = time.monotonic() - began
            out = folder / f"out.{suffix}"
            for number in range(4 if harness.SANITIZED else 25):
                out.unlink(missing_ok=True)
                if number % 2:
                    out.write_bytes(OLD)
                many.run(*arguments, "-o", out, "--force",
                         kill_after_s=source.uniform(0, 1.2) * usual)
                content = out.read_bytes() if out.exists() else None
                check(content in ((OLD, whole) if number % 2 else (None, whole)), suffix, "torn")
                ends["complete" if content == whole else "old" if content else "absent"] += 1
    print("#", ends)
    check(harness.SANITIZED or ends["complete"], "killed before it wrote, each time")
    for path in strays(folder):  # allowed after kill -9, under this name
        check(path.name.endswith(".tmp"))
        path.unlink()


def test_signals(folder):
    """SIGINT and SIGTERM at any moment: 128 + number, no output, nothing left."""
    image = write(folder / "in.png", texture(96, 128))
    # Many times longer than the latest signal, however fast the machine.
    for number, stop in enumerate((signal.SIGINT, signal.SIGTERM) * 3):
        out = folder / f"{number}.png"
        run = start("synthesize", image, "--size", "1600x1200", "--slant", "40",
                    "--method", "paper", "--quality", "best", "-o", out, "-q")
        time.sleep((.3, .7, 1.2)[number // 2])
        run.send_signal(stop)
        began = time.monotonic()
        run.communicate(timeout=60)
        # Before the handlers stand, a signal ends the process as it ends any.
        check(run.returncode in (128 + stop, -stop), "ended with", run.returncode)
        check(time.monotonic() - began < 10, "took", time.monotonic() - began, "s to stop")
        check(not out.exists())


def test_a_pending_signal_while_writing(folder):
    """The signal comes while a large file is written: the temporary goes."""
    arguments = noisy_job(folder, "tif", "u16")
    old = folder / "old.tif"
    old.write_bytes(OLD)
    whole = expected(folder, arguments, "tif")
    # One that a shell has its background jobs ignore changes nothing: it ends with 0.
    for stop in (signal.SIGTERM, signal.SIGQUIT, signal.SIGXCPU, signal.SIGALRM, signal.SIGUSR1,
                 signal.SIGUSR2):
        run = start(*arguments, "-o", old, "--force")
        while run.poll() is None and not strays(folder):
            time.sleep(.0005)
        run.send_signal(stop)
        run.communicate(timeout=60)
        check(run.returncode in (0, 128 + stop), stop, run.returncode)
        check(old.read_bytes() in (OLD, whole), "torn")
        check(not strays(folder), "left", strays(folder))
        old.write_bytes(OLD)


def test_two_writers(folder):
    arguments = job(folder)
    whole = expected(folder, arguments)
    out = folder / "out.png"
    for round_ in range(2 if harness.SANITIZED else 5):
        runs = [start(*arguments, "-o", out) for _ in range(3)]
        codes = sorted((run.communicate(), run.returncode)[1] for run in runs)
        check(codes == [0, 4, 4], round_, codes)
        check(out.read_bytes() == whole)
        out.unlink()
    runs = [start(*arguments, "-o", out, "--force") for _ in range(3)]
    check([(run.communicate(), run.returncode)[1] for run in runs] == [0, 0, 0])
    check(same_bits(read(out), read(folder / "expected.png")))


def test_standard_output_full(folder):
    if not Path("/dev/full").exists():
        raise harness.Skip("no /dev/full here")
    with open("/dev/full", "w", encoding="ascii") as full:
        run = subprocess.run([harness.RECEDE, *map(str, job(folder)), "-o", folder / "out.png",
                              "--json", "-"], stdout=full, stderr=subprocess.PIPE, check=False,
                             timeout=60)
        check(run.returncode == 4, run)
        for words in (["orient", folder / "in.png", "--slant", "9"], ["--version"], ["--help"]):
            run = subprocess.run([harness.RECEDE, *map(str, words)], stdout=full,
                                 stderr=subprocess.PIPE, check=False, timeout=60)
            check(run.returncode == 4 and b"standard output" in run.stderr, words, run)


if __name__ == "__main__":
    sys.exit(harness.main(globals()))
