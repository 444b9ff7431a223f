#!/usr/bin/python3
"""A fill takes as many instructions as is written here. TAP.

test_work.py RECEDE MANY

Times on shared machines tell nothing; instructions, counted by valgrind on one thread, are the same
from run to run with one compiler, Debian 12's, at -O3. What rooms cost one by one was measured as
each was added, and together they broke the bar of half a second unseen. A change that moves a count
by more than a tenth writes the new one down here, and says in docs/measured.md what it buys.
"""
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parents[1] / part) for part in ('lib', 'bench')]
from scenes import scene  # noqa: E402
from tap import Tap  # noqa: E402

MAY_MOVE = .1
# Millions of instructions, with the kernel for AVX2, the best that valgrind runs.
WORK = {('brick-256', 'normal'): 6290, ('brick-256', 'draft'): 3450}


def runs_avx2():
    return ' avx2 ' in Path('/proc/cpuinfo').read_text()


def counted(binary, of, quality):
    """Millions of instructions of the fill itself, without the linker's and files'."""
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(
            ['valgrind', '--tool=callgrind', '--callgrind-out-file=/dev/null',
             '--toggle-collect=recede_job_fill', binary, 'fill', of.image, '--mask', of.mask,
             '-o', Path(folder) / 'out.ppm', '--threads=1', '--quality', quality, *of.options],
            capture_output=True, text=True, check=False)
    collected = re.search(r'Collected : (\d+)', done.stderr)
    if done.returncode != 0 or not collected:
        raise RuntimeError(f'{done.args}: {done.returncode}: {done.stderr[-1000:]}')
    return int(collected[1]) / 1e6


def main():
    tap = Tap()
    binary = sys.argv[1]
    if not runs_avx2():
        tap.skip('work', 'this machine does not run AVX2')
        return tap.finish()
    scenes = {name: scene(name) for name, _ in WORK}
    with ThreadPoolExecutor(2) as pool:
        found = pool.map(lambda key: counted(binary, scenes[key[0]], key[1]), WORK)
        for (name, quality), count in zip(WORK, found):
            written = WORK[name, quality]
            tap.check(abs(count / written - 1) < MAY_MOVE,
                      f'{name}, {quality}: {written} million instructions',
                      f'{count:.0f} million, {count / written - 1:+.1%}')
    return tap.finish()


if __name__ == '__main__':
    sys.exit(main())
