"""Memory, sizes, processors and threads: what is too much is said before the work."""
import os
import re
import resource
import subprocess
import sys

import harness
from harness import check, hole, recede, report_of, texture, write


def pair(folder):
    return write(folder / "in.png", texture()), write(folder / "mask.png", hole())


def test_limits_are_5(folder):
    image = write(folder / "in.png", texture(400, 600))
    mask = write(folder / "mask.png", hole(400, 600, (50, 350, 50, 550)))
    done = recede("fill", image, "--mask", mask, "-o", folder / "out.png", "--frontal", "--memory",
                  "1", code=5)
    check(b"MiB" in done.stderr, done.stderr)
    recede("synthesize", image, "--size", "30000x30000", "--frontal", "-o", folder / "out.png",
           "--memory", "100", code=5)
    recede("scale-map", "--size", "60000x60000", "--frontal", "-o", folder / "out.exr", code=5)
    check(not (folder / "out.png").exists())


def test_sides_that_a_format_cannot_have(folder):
    """Said before the work, with 4, the limit and the size."""
    image = write(folder / "in.png", texture())
    for suffix, limit, side in (("jpg", 65500, 65501), ("tga", 65535, 65536),
                                ("png", 1000000, 1000001)):
        for size in (f"{side}x2", f"2x{side}"):
            out = folder / f"out.{suffix}"
            # Too little memory for the work: it is not reached.
            for command in (["synthesize", image, "--memory", "1"], ["scale-map"]):
                done = recede(*command, "--size", size, "--frontal", "-o", out, code=4)
                check(str(limit).encode() in done.stderr and str(side).encode() in done.stderr,
                      done.stderr)
                check(not out.exists() and done.stderr.startswith(b"recede: "))
    recede("scale-map", "--size", "65500x1", "--frontal", "-o", folder / "out.jpg")
    long = folder / "long.ppm"
    long.write_bytes(b"P5\n66000 2\n255\n" + bytes(range(250)) * 528)
    mask = folder / "mask.pgm"
    mask.write_bytes(b"P5\n66000 2\n255\n" + bytes(30000) + b"\xff" * 9 + bytes(101991))
    recede("fill", long, "--mask", mask, "--frontal", "-o", folder / "out2.jpg", code=4)


def test_threads_give_the_same_bytes(folder):
    image, mask = pair(folder)
    made = {}
    for threads in (0, 1, 3, 64, 10000):
        out = folder / f"{threads}.png"
        report = report_of("fill", image, "--mask", mask, "-o", out, "--slant", "40", "--threads",
                           threads, environment={"OMP_NUM_THREADS": "garbage"})
        check(1 <= report["threads"] <= 64, report["threads"])
        made[threads] = out.read_bytes()
    check(len(set(made.values())) == 1, "threads change the bytes")


def test_processors_and_memory_are_those_of_the_process(folder):
    """In a container, and under limits, there is less than the machine has."""
    image, _ = pair(folder)
    one = {min(os.sched_getaffinity(0))}
    report = report_of("orient", image, "--frontal", prepare=lambda: os.sched_setaffinity(0, one))
    check(report["threads"] == 1, report["threads"])
    if harness.SANITIZED:  # ASan's shadow does not fit in any limit of addresses
        return
    most = 2 << 30
    done = recede("synthesize", image, "--size", "8000x8000", "--frontal", "-o", folder / "out.png",
                  code=5, prepare=lambda: resource.setrlimit(resource.RLIMIT_AS, (most, most)))
    limit = re.search(rb"needs up to \d+ MiB, the limit is (\d+) MiB", done.stderr)
    check(limit and int(limit[1]) < 1536, done.stderr)


def test_a_container_has_less_memory(folder):
    """Files as control groups have them, of both versions, in the place of the true ones."""
    image, _ = pair(folder)
    groups = [line.strip().split(":", 2) for line in open("/proc/self/cgroup", encoding="ascii")]
    tried = 0
    for name, kind, root in (("memory.max", "", ""),
                             ("memory.limit_in_bytes", "memory", "/memory")):
        group = [path for _, kinds, path in groups if kind == kinds]
        for place in {"", *(path.rstrip("/") for path in group)} if group else ():
            made = f"/sys/fs/cgroup{root}{place}"  # a container sees its own group as the root
            script = (f"mount -t tmpfs recede /sys/fs/cgroup && mkdir -p '{made}' && "
                      f"echo 400000000 > '{made}/{name}' && exec \"$@\"")
            done = subprocess.run(
                ["unshare", "-m", "sh", "-c", script, "sh", harness.RECEDE, "synthesize", image,
                 "--size", "8000x8000", "--frontal", "-o", folder / "out.png"],
                check=False, timeout=60, capture_output=True)
            if b"recede: " not in done.stderr:
                raise harness.Skip("mounting a file system is not allowed here")
            check(done.returncode == 5 and b"the limit is 286 MiB" in done.stderr, made, done)
            tried += 1
    if not tried:
        raise harness.Skip("no control group has memory here")


NO_THREADS = """
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <locale.h>
#include <pthread.h>
static int begun; /* main() calls setlocale() first; some libraries have threads before */
static int started;
char *setlocale(int category, const char *name) {
  char *(*real)(int, const char *) = dlsym(RTLD_NEXT, "setlocale");
  begun = 1;
  return real(category, name);
}
int pthread_create(pthread_t *t, const pthread_attr_t *a, void *(*f)(void *), void *user) {
  int (*real)(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *) =
      dlsym(RTLD_NEXT, "pthread_create");
  return begun && ++started > 2 ? EAGAIN : real(t, a, f, user);
}
"""


def test_threads_that_cannot_be_started(folder):
    """The image library's are needed: with 5, and no crash at the end. The core does without."""
    environment = harness.preloaded(folder, NO_THREADS)
    image = write(folder / "in.exr", texture(kind="float"))
    done = recede("fill", image, "--mask", write(folder / "mask.png", hole()), "--frontal",
                  "--threads", "4", "-o", folder / "out.exr", environment=environment, code=None)
    check(done.returncode in (0, 5), done)
    check(done.returncode == 0 or b"thread" in done.stderr, done)


if __name__ == "__main__":
    sys.exit(harness.main(globals()))
