#!/usr/bin/python3
"""Times `recede fill` on fixed scenes, interleaved with the peers on the same files.

    ./dev bench fill                          all of it: minutes
    ./dev bench fill --scenes brick-256 --repeats 1 --no-peers

Prints CPU and wall seconds (medians of the repeats), peak memory, the ratio of each method's CPU
time to ours at normal quality on one thread, and our stages. On a shared machine only the CPU
seconds and the ratios mean something. Writes fill.json into --out.
"""
import argparse
import json
import os
import statistics
import sys
from pathlib import Path

from scenes import SCENES, scene  # puts tests/quality on the path

from evaluation import PROJECT
from methods import PEERS, Failed, missing_programs, peer_command, run
from report import number, table

OURS = 'recede'
BASE = ('normal', 1)  # what ratios are of: quality, threads
MEGA = 1e6


def words(text):
    return [word for word in text.split(',') if word]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--binary', type=Path, default=PROJECT / 'build' / 'cli' / 'recede')
    parser.add_argument('--scenes', type=words, default=SCENES)
    parser.add_argument('--qualities', type=words, default=['draft', 'normal', 'best'])
    parser.add_argument('--threads', type=words, default=['1', str(os.cpu_count())])
    parser.add_argument('--repeats', type=int, default=3)
    parser.add_argument('--peers', type=words, default=PEERS)
    parser.add_argument('--no-peers', dest='peers', action='store_const', const=[])
    parser.add_argument('--set', action='append', default=[], metavar='KEY=VALUE')
    parser.add_argument('--out', type=Path, default=PROJECT / 'out' / 'fill')
    chosen = parser.parse_args()
    for name in chosen.scenes:
        if name not in SCENES:
            parser.error(f'no scene {name}; there are {", ".join(SCENES)}')
    return chosen


def run_ours(binary, place, quality, threads, extra, folder):
    """What one run cost, with what the command's own JSON says."""
    report = folder / 'report.json'
    report.unlink(missing_ok=True)
    used = run([binary, 'fill', place.image, '--mask', place.mask, '-o', folder / 'out.ppm',
                '--force', *place.options, f'--quality={quality}', f'--threads={threads}',
                '--json', report, *extra])
    said = json.loads(report.read_text())
    return {**used, 'core': sum(said['stages'].values()), 'stages': said['stages'],
            'peak_bytes': said['peak_bytes'], 'output_hash': said['output_hash']}


def configurations(chosen):
    """(method, quality, threads): ours in every setting, and the peers."""
    for quality in chosen.qualities:
        for threads in dict.fromkeys(chosen.threads):
            yield OURS, quality, int(threads)
    for peer in chosen.peers:
        yield peer, '', 1


def measure(place, chosen, folder):
    """{configuration: [run, ...] or the reason why there is none}; one round after the other, so
    that what else the machine does falls on all alike."""
    runs = {configuration: [] for configuration in configurations(chosen)}
    extra = [f'--set={setting}' for setting in chosen.set]
    for _ in range(chosen.repeats):
        for configuration, done in runs.items():
            method, quality, threads = configuration
            if isinstance(done, str):
                continue
            try:
                if method == OURS:
                    done.append(run_ours(chosen.binary, place, quality, threads, extra, folder))
                else:
                    done.append(run(peer_command(method, place.image, place.mask,
                                                 folder / 'peer.ppm')))
            except Failed as error:
                runs[configuration] = str(error)
    return runs


def median(runs, key):
    values = [entry[key] for entry in runs if key in entry]
    return statistics.median(values) if values else None


def summarize(runs):
    """Medians of a configuration's runs."""
    if isinstance(runs, str):
        return {'error': runs}
    row = {key: median(runs, key) for key in ('cpu', 'wall', 'core', 'peak_bytes', 'rss_bytes')}
    if 'stages' in runs[0]:
        row['stages'] = {stage: statistics.median(entry['stages'].get(stage, 0) for entry in runs)
                         for stage in runs[0]['stages']}
        row['hashes'] = sorted({str(entry['output_hash']) for entry in runs})
    return row


def ratio_to(base, row):
    return row['cpu'] / base['cpu'] if 'cpu' in row and base and 'cpu' in base else None


def megabytes(value):
    return number(value and value / MEGA, 0)


def cost_table(measured):
    rows = []
    for name, (hole_pixels, summaries) in measured.items():
        base = summaries.get((OURS, *BASE))
        for (method, quality, threads), row in summaries.items():
            title = f'{method} {quality}'.strip()
            if 'error' in row:
                rows.append([name, title, threads, row['error'], '', '', '', '', ''])
                continue
            rows.append([name, title, threads, number(row['cpu'], 2), number(row['wall'], 2),
                         number(row['core'], 2), number(ratio_to(base, row), 2),
                         megabytes(row['peak_bytes']), megabytes(row['rss_bytes'])])
    return table(['scene', 'method', 'threads', 'CPU s', 'wall s', 'core wall s', 'CPU ratio',
                  'core MB', 'RSS MB'], rows)


def stage_table(measured):
    """Seconds of every stage, normal quality, one thread."""
    columns = {name: summaries[(OURS, *BASE)]['stages']
               for name, (_, summaries) in measured.items()
               if 'stages' in summaries.get((OURS, *BASE), {})}
    stages = list(dict.fromkeys(stage for column in columns.values() for stage in column))
    return table(['stage', *columns],
                 [[stage, *(number(column.get(stage), 3) for column in columns.values())]
                  for stage in stages])


def main():
    chosen = arguments()
    problems = [problem for problem in missing_programs(['plane', *chosen.peers], chosen.binary)]
    if problems:
        sys.exit('\n'.join(problems))
    chosen.out.mkdir(parents=True, exist_ok=True)
    measured = {}
    for name in chosen.scenes:
        place = scene(name)
        if place is None:
            print(f'{name}: left out, the evaluation data is not there', file=sys.stderr)
            continue
        print(name, file=sys.stderr)
        runs = measure(place, chosen, chosen.out)
        measured[name] = place.hole_pixels(), {key: summarize(value)
                                               for key, value in runs.items()}
    print(cost_table(measured))
    print(stage_table(measured))
    (chosen.out / 'fill.json').write_text(json.dumps(
        {name: {'hole_pixels': pixels,
                'runs': [{'method': key[0], 'quality': key[1], 'threads': key[2], **row}
                         for key, row in summaries.items()]}
         for name, (pixels, summaries) in measured.items()}, indent=1))


if __name__ == '__main__':
    main()
