"""Tables of scores."""
import statistics

from methods import ORACLE, PEERS

STEEP_DEG = 40.0  # from here on a fill without perspective fails
FULL_MARKS = 100.0
TERMS = ['regular', 'sharpness', 'seam']
# Rivals for the win rate; --frontal is our own engine without perspective.
RIVALS = [*PEERS, 'frontal']


def table(header, rows):
    """A markdown table, aligned for a terminal too."""
    rows = [[str(cell) for cell in row] for row in [header, *rows]]
    widths = [max(len(row[i]) for row in rows) for i in range(len(header))]
    lines = ['| ' + ' | '.join([row[0].ljust(widths[0])] +
                               [cell.rjust(width) for cell, width in zip(row[1:], widths[1:])]) +
             ' |' for row in rows]
    rule = '|' + '|'.join(['-' * (widths[0] + 2)] + ['-' * (width + 1) + ':'
                                                     for width in widths[1:]]) + '|'
    return '\n'.join([lines[0], rule, *lines[1:]]) + '\n'


def number(value, digits=1):
    return '' if value is None else f'{value:.{digits}f}'


def mean(values):
    values = list(values)
    return statistics.fmean(values) if values else None


def median_term(found, term):
    values = [entry['terms'][term] for entry in found if term in entry['terms']]
    return statistics.median(values) if values else None


def best_rival(found, method):
    """The best score of the rivals that were measured, None where none was."""
    return max((found[name]['score'] for name in RIVALS if name in found and name != method),
               default=None)


def duels(cases, scores, method):
    """[(case, the method's score, its best rival's)] of the cases where both were measured."""
    pairs = [(case, scores[case.name].get(method), best_rival(scores[case.name], method))
             for case in cases]
    return [(case, own['score'], rival) for case, own, rival in pairs
            if own is not None and rival is not None]


def wins(cases, scores, method):
    """Cases won against the best rival, and cases compared."""
    compared = duels(cases, scores, method)
    return sum(own > rival for _, own, rival in compared), len(compared)


def groups(cases):
    """Rendered cases, the steep ones of them, photos."""
    rendered = [case for case in cases if not case.is_photo]
    return (rendered, [case for case in rendered if case.slant >= STEEP_DEG],
            [case for case in cases if case.is_photo])


def figures(cases, scores, methods):
    """{method: the summary's numbers}."""
    rendered, steep, photos = groups(cases)
    out = {}
    for method in methods:
        def of(group):
            return [scores[case.name][method] for case in group if method in scores[case.name]]
        out[method] = {
            'mean': mean(entry['score'] for entry in of(rendered)),
            'mean_steep': mean(entry['score'] for entry in of(steep)),
            'wins_steep': wins(steep, scores, method) if method != ORACLE else (0, 0),
            **{term: median_term(of(rendered), term) for term in TERMS},
            'photos': mean(entry['score'] for entry in of(photos)),
            'wins_photos': wins(photos, scores, method) if method != ORACLE else (0, 0),
            'cpu': mean(entry['cpu'] for entry in of(cases) if 'cpu' in entry),
            'failed': sum('error' in entry for entry in of(cases)),
            'changed_outside': sum(entry.get('changed_outside', 0) > 0 for entry in of(cases)),
        }
    return out


def ratio(pair):
    return f'{pair[0]}/{pair[1]}' if pair[1] else ''


def summary(cases, scores, methods):
    header = ['method', 'mean', f'>= {STEEP_DEG:.0f} deg', 'wins', *TERMS, 'photos', 'wins',
              'CPU s', 'failed', 'outside']
    rows = [[method, number(row['mean']), number(row['mean_steep']), ratio(row['wins_steep']),
             *(number(row[term], 3) for term in TERMS), number(row['photos']),
             ratio(row['wins_photos']), number(row['cpu'], 2), row['failed'],
             row['changed_outside']]
            for method, row in figures(cases, scores, methods).items()]
    return table(header, rows)


def rivalry(name, cases, scores, method):
    """A sentence on what it wins and loses against the best rival, and how much can be won at all:
    where a rival has full marks nobody has more. Empty where nothing can be compared.
    """
    compared = duels(cases, scores, method)
    won, of = wins(cases, scores, method)
    lost = [f'{case.short()} {own:.0f}:{rival:.0f}' for case, own, rival in compared if own < rival]
    full = sum(rival >= FULL_MARKS for _, _, rival in compared)
    if not compared:
        return ''
    named = f' ({", ".join(lost)})' if lost else ''
    return (f'{method}, {name}: alone the best in {won} of {of}, shares the best score in '
            f'{of - won - len(lost)}, loses {len(lost)}{named}; a rival has full marks in {full}, '
            f'so that {of - full} can be won alone\n')


def rivalries(cases, scores, method):
    _, steep, photos = groups(cases)
    return (rivalry(f'slant >= {STEEP_DEG:.0f} deg', steep, scores, method) +
            rivalry('photos', photos, scores, method))


def surface_choice(scores):
    """A sentence on what --surface auto made of its choice; empty where that was not measured."""
    lost = []
    for found in scores.values():
        if {'plane', 'plane-flat', 'plane-raised'} <= found.keys():
            best = max(found['plane-flat']['score'], found['plane-raised']['score'])
            lost.append(best - found['plane']['score'])
    if not lost:
        return ''
    right = sum(loss < .1 for loss in lost)
    return (f'--surface auto: the better of flat and raised in {right} of {len(lost)}, '
            f'{max(lost):.1f} points lost at most, {mean(lost):.1f} on the average\n')


def per_case(cases, scores, methods):
    """Scores of every method, and the terms of the first that cost it most."""
    rows = []
    for case in cases:
        found = scores[case.name]
        first = found.get(methods[0], {})
        losses = sorted(first.get('losses', {}).items(), key=lambda item: -item[1])[:4]
        note = first.get('error') or ' '.join(f'{term} {first["terms"][term]:.2f}'
                                              for term, loss in losses if loss > 0)
        rows.append([case.name, *(number(found[method]['score'], 0) if method in found else ''
                                  for method in methods), note])
    return table(['case', *methods, f'{methods[0]}: terms that cost most'], rows)
