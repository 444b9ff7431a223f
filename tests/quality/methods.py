"""Ways to fill a hole: ours, through the real command, and the peers that artists have.

Peers run with the defaults that their users get and see the whole picture; they have no way to be
told the plane or the source. Their results do not change, so they are cached.
"""
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile

import cv2

from evaluation import CACHE, digest
from oracle import moved_truth

# Options of `recede fill` besides the case's orientation.
OURS = {
    'plane': [],
    'plane-flat': ['--surface=flat'],
    'plane-raised': ['--surface=raised'],
    'draft': ['--quality=draft'],
    'best': ['--quality=best'],
    'estimated': [],
    'frontal': ['--frontal'],
    'paper': ['--method=paper'],
    'kwatra': ['--method=kwatra'],
}
# What the GIMP plug-in G'MIC-Qt calls with its defaults: "Inpaint [Multi-Scale]" and "Inpaint
# [Patch-Based]", whose lookup and blend sizes are 16 and 1.2 patches.
GMIC = {
    'gmic-multiscale': 'inpaint_matchpatch[0] [1],0,9,10,5,1',
    'gmic-patch': 'inpaint[0] [1],7,112,0.1,1,8.4,0,0.05,10,1',
}
SHIFTMAP = 'shiftmap'
ORACLE = 'oracle'
PEERS = [SHIFTMAP, *GMIC]
ALL = [*OURS, *PEERS, ORACLE]
TIMEOUT_SECONDS = 300

# In a process of its own, so that its CPU time can be told. Its mask is 0 in the hole, and its
# documentation recommends Lab.
SHIFTMAP_SCRIPT = '''
import cv2, numpy as np, sys
cv2.setRNGSeed(1)
picture, mask = cv2.imread(sys.argv[1]), cv2.imread(sys.argv[2], cv2.IMREAD_GRAYSCALE)
lab = cv2.cvtColor(picture, cv2.COLOR_BGR2Lab)
out = np.zeros_like(lab)
cv2.xphoto.inpaint(lab, np.where(mask > 127, 0, 255).astype(np.uint8), out,
                   cv2.xphoto.INPAINT_SHIFTMAP)
out = cv2.cvtColor(out, cv2.COLOR_Lab2BGR)
out[mask <= 127] = picture[mask <= 127]
cv2.imwrite(sys.argv[3], out)
'''


# Between us and the program: a child's peak memory begins with what its parent held at the fork,
# and we hold pictures.
LAUNCHER = '''
import json, os, sys, time
began = time.monotonic()
program = os.posix_spawnp(sys.argv[2], sys.argv[2:], os.environ)
_, status, used = os.wait4(program, 0)
with open(sys.argv[1], "w") as file:
    json.dump({"cpu": used.ru_utime + used.ru_stime, "wall": time.monotonic() - began,
               "rss_bytes": used.ru_maxrss * 1024}, file)
sys.exit(os.waitstatus_to_exitcode(status))
'''


class Failed(Exception):
    """A method gave no result; says why."""


def run(command, timeout_seconds=TIMEOUT_SECONDS):
    """Runs it; {'cpu', 'wall'} in seconds and 'rss_bytes'. Failed with its last words."""
    with tempfile.TemporaryFile() as words, tempfile.NamedTemporaryFile() as usage:
        launcher = [sys.executable, '-I', '-S', '-c', LAUNCHER, usage.name]
        process = subprocess.Popen(launcher + [str(part) for part in command],
                                   stdin=subprocess.DEVNULL, stdout=words,
                                   stderr=subprocess.STDOUT, start_new_session=True)
        try:
            process.wait(timeout_seconds)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            raise Failed(f'no result after {timeout_seconds} s') from None
        words.seek(0)
        said = words.read().decode(errors='replace').strip().splitlines()
        if process.returncode != 0:
            raise Failed(f'exit {process.returncode}: {said[-1] if said else "nothing said"}')
        return json.loads(usage.read())


def gmic_command(method, image, mask, out):
    # cut: it blends past white, and would then write 16 bits.
    return ['gmic', image, mask, *GMIC[method].split(' ', 1), 'keep[0]', 'round', 'cut', '0,255',
            'output', out]


def shiftmap_command(image, mask, out):
    return [sys.executable, '-c', SHIFTMAP_SCRIPT, image, mask, out]


def peer_command(method, image, mask, out):
    if method == SHIFTMAP:
        return shiftmap_command(image, mask, out)
    return gmic_command(method, image, mask, out)


def recede_command(binary, method, case, out, extra=()):
    orientation = [] if method in ('frontal', 'estimated') else case.options
    return [binary, 'fill', case.folder / 'input.png', '--mask', case.folder / 'mask.png',
            '-o', out, '--force', '--threads=1', *orientation, *case.source, *OURS[method],
            *extra]


def peer_result(method, case):
    """Path of the peer's result and what it cost when it was made."""
    image, mask = case.folder / 'input.png', case.folder / 'mask.png'
    path = CACHE / 'peers' / f'{digest(image, mask, method, GMIC.get(method))}.png'
    times = path.with_suffix('.txt')
    if not times.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary = path.with_suffix(f'.{os.getpid()}.png')
        used = run(peer_command(method, image, mask, temporary))
        temporary.replace(path)
        times.write_text(str(used['cpu']))
    return path, float(times.read_text())


def oracle_result(case, path):
    if not case.is_photo:
        return case.folder / 'oracle.png'
    picture = moved_truth(case)
    if picture is None:
        raise Failed('its plane shows no other piece of that scale')
    cv2.imwrite(str(path), picture)
    return path


def result(method, case, binary, extra, folder):
    """Fills the case's hole: path of the picture and CPU seconds. May raise Failed."""
    path = folder / f'{case.name}.{method}.png'
    if method == ORACLE:
        return oracle_result(case, path), 0.0
    if method in PEERS:
        return peer_result(method, case)
    path.unlink(missing_ok=True)
    return path, run(recede_command(binary, method, case, path, extra))['cpu']


def missing_programs(methods, binary):
    """Sentences about what the methods need and is not there."""
    if set(methods) & set(OURS) and not os.access(binary, os.X_OK):
        yield f'{binary}: no such program; build it, or name one by --binary'
    if set(methods) & set(GMIC) and not shutil.which('gmic'):
        yield 'gmic: not installed (Debian package gmic)'
