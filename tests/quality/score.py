#!/usr/bin/python3
"""Scores fills of the evaluation data: ours by the real command, and the peers'.

    score.py                                       every case, every method of the summary
    score.py --cases 000,003 --methods plane       the fast way while working on the engine
    score.py --binary other/recede --set engine-join=0

Prints a table, writes scores.json and contact sheets into --out. Score: 0 to 100, >= 80 is as
good as the same plane at another offset (the oracle). A method that gives no result scores 0.
"""
import argparse
import json
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import report
import sheet
from evaluation import PROJECT, Judge, load_cases
from floors import load_floors
from holes import load_holes
from methods import ALL, ORACLE, OURS, PEERS, Failed, missing_programs, result

DEFAULT = ['plane', 'frontal', 'paper', *PEERS, ORACLE]


def words(text):
    return [word for word in text.split(',') if word]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--binary', type=Path, default=PROJECT / 'build' / 'cli' / 'recede')
    parser.add_argument('--methods', type=words, default=DEFAULT,
                        help='comma-separated, of ' + ', '.join(ALL))
    parser.add_argument('--cases', type=words, help="comma-separated beginnings of cases' names")
    kind = parser.add_mutually_exclusive_group()
    kind.add_argument('--photos', action='store_true', help='only the photos')
    kind.add_argument('--synthetic', action='store_true', help='only the rendered cases')
    kind.add_argument('--floors', action='store_true', help='floors of two textures instead')
    kind.add_argument('--holes', action='store_true', help='more holes in the photos instead')
    parser.add_argument('--set', action='append', default=[], metavar='KEY=VALUE',
                        help="a developers' parameter for our methods; may be repeated")
    parser.add_argument('--seed', type=int, help='for our methods')
    parser.add_argument('--out', type=Path, default=PROJECT / 'out' / 'quality')
    parser.add_argument('--jobs', type=int, default=2)
    parser.add_argument('--no-sheet', action='store_true')
    chosen = parser.parse_args()
    for method in chosen.methods:
        if method not in ALL:
            parser.error(f'no method {method}; there are {", ".join(ALL)}')
    return chosen


def score_case(case, methods, binary, extra, folder):
    """{method: {score, terms, cpu, path} or {error}} of one case."""
    judge = Judge(case)
    found = {}
    for method in methods:
        try:
            path, cpu = result(method, case, binary, extra, folder)
            found[method] = {**judge.score(path), 'cpu': round(cpu, 3), 'path': str(path)}
        except (Failed, ValueError) as error:
            if method == ORACLE:
                continue
            found[method] = {'score': 0.0, 'terms': {}, 'error': str(error)}
    return found


def score_all(cases, methods, binary, extra, folder, jobs=2):
    """{case's name: {method: ...}}, in the cases' order; says how far it is on a terminal."""
    folder.mkdir(parents=True, exist_ok=True)
    scores = {}
    with ProcessPoolExecutor(jobs) as pool:
        pending = [pool.submit(score_case, case, methods, binary, extra, folder)
                   for case in cases]
        for case, answer in zip(cases, pending):
            scores[case.name] = answer.result()
            if sys.stderr.isatty():
                print(f'\r{len(scores)}/{len(cases)} ', end='', file=sys.stderr)
    return scores


def contact_sheets(cases, scores, methods, stem):
    ours = next((method for method in methods if method in OURS), None)
    rows = []
    for case in cases:
        found = scores[case.name]
        panels = [(case.name, case.image('truth')), ('input', case.image('input'))]
        best_peer = max((method for method in PEERS if method in found), default=None,
                        key=lambda method: found[method]['score'])
        for method in filter(None, (ours, best_peer)):
            panels.append((f'{method} {found[method]["score"]:.0f}', found[method].get('path')))
        rows.append(sheet.row(case, panels))
    return sheet.write(rows, stem)


def main():
    chosen = arguments()
    problems = list(missing_programs(chosen.methods, chosen.binary))
    if problems:
        sys.exit('\n'.join(problems))
    if chosen.floors or chosen.holes:
        cases = (load_floors if chosen.floors else load_holes)(chosen.cases)
    else:
        cases = [case for case in load_cases(chosen.cases)
                 if case.is_photo and not chosen.synthetic
                 or not case.is_photo and not chosen.photos]
    extra = [f'--set={setting}' for setting in chosen.set]
    extra += [] if chosen.seed is None else [f'--seed={chosen.seed}']
    scores = score_all(cases, chosen.methods, chosen.binary, extra, chosen.out, chosen.jobs)
    print(report.per_case(cases, scores, chosen.methods))
    print(report.summary(cases, scores, chosen.methods))
    print(report.rivalries(cases, scores, chosen.methods[0]), end='')
    print(report.surface_choice(scores), end='')
    (chosen.out / 'scores.json').write_text(json.dumps(
        {'settings': extra, 'summary': report.figures(cases, scores, chosen.methods),
         'cases': scores}, indent=1))
    if not chosen.no_sheet:
        for path in contact_sheets(cases, scores, chosen.methods, chosen.out / 'sheet'):
            print(path)


if __name__ == '__main__':
    main()
