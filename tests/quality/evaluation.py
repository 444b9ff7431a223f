"""The evaluation data: where it is, its cases, and scores by its metrics.py.

The data lies beside the checkout in ../shared/evaluate, or where RECEDE_EVALUATE says. When its
cases are not made there yet, it is copied into the cache and those that are asked for are made.
Truths' raw numbers and scores are cached by the bytes they depend on, so no result is ever measured
twice.
"""
import hashlib
import importlib.util
import json
import os
import pickle
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

import cv2
import numpy as np

PROJECT = Path(__file__).resolve().parents[2]
CACHE = Path(os.environ.get('XDG_CACHE_HOME') or Path.home() / '.cache') / 'recede' / 'evaluate'
CASES = 30  # of make_cases.py
SIZE = 512  # px, of a rendered case
MAKE_ONE = f'''
import sys, types, make_cases
case = list(make_cases.cases({CASES}))[int(sys.argv[1])]
make_cases.one(types.SimpleNamespace(size={SIZE}, out=sys.argv[2]), case)
'''
# Large arrays, made and freed all the time, would cost a third more in fresh pages.
KEEP_PAGES = {'MALLOC_MMAP_MAX_': '0', 'MALLOC_TRIM_THRESHOLD_': str(1 << 32)}


@dataclass
class Case:
    """A picture with a hole whose truth is known."""
    name: str
    folder: Path
    slant: float | None  # degrees; None for a photo
    line: np.ndarray     # w = a x + b y + c, positive on the plane
    options: list = field(default_factory=list)  # the orientation, as recede's options
    source: list = field(default_factory=list)   # --source, for photos
    texture: str = ''    # of a rendered case

    def image(self, name, flags=cv2.IMREAD_COLOR):
        picture = cv2.imread(str(self.folder / f'{name}.png'), flags)
        if picture is None:
            raise SystemExit(f'{self.folder / name}.png: cannot be read')
        return picture

    @property
    def mask(self):
        return self.image('mask', cv2.IMREAD_GRAYSCALE)

    @property
    def is_photo(self):
        return self.slant is None

    def short(self):
        return self.name if self.is_photo else self.name[:3]


def digest(*parts):
    total = hashlib.sha256()
    for part in parts:
        total.update(part.read_bytes() if isinstance(part, Path) else str(part).encode())
    return total.hexdigest()[:20]


def cached(kind, key, make):
    """The value stored under the key, made and stored when there is none."""
    path = CACHE / kind / f'{key}.pickle'
    if path.exists():
        try:
            return pickle.loads(path.read_bytes())
        except (EOFError, pickle.UnpicklingError):  # written half
            pass
    value = make()
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_suffix(f'.{os.getpid()}')
    temporary.write_bytes(pickle.dumps(value))
    temporary.replace(path)
    return value


def data_folder():
    """The folder of the evaluation data, None where there is none."""
    named = os.environ.get('RECEDE_EVALUATE')
    folder = Path(named) if named else PROJECT.parent / 'shared' / 'evaluate'
    if (folder / 'metrics.py').exists():
        return folder.resolve()
    if named:
        raise SystemExit(f'RECEDE_EVALUATE={named}: holds no metrics.py')
    return None


def working_folder():
    """The data's folder if its cases are made there; else a copy in the cache, where they can be.
    """
    folder = data_folder()
    if folder is None:
        raise SystemExit('the evaluation data is not there: put it into ../shared/evaluate, or '
                         'name its folder in RECEDE_EVALUATE')
    if (folder / 'cases').is_dir() and (folder / 'photo_cases').is_dir():
        return folder
    copy = CACHE / 'data' / digest(*sorted(folder.glob('*.py')))
    if not copy.exists():
        copy.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=copy.parent) as temporary:
            copy_data(folder, Path(temporary) / 'evaluate')
            put(Path(temporary) / 'evaluate', copy)
    return copy


def put(made, place):
    """Moves a folder to its place, unless another process was first: theirs is the same."""
    try:
        made.rename(place)
    except OSError:
        if not place.exists():
            raise


def drawn_cases(script, draw, count, wanted=()):
    """Folders of the cases that draw(root, index, folder) draws, once; every one, or those whose
    name begins with one of the wanted words.
    """
    return [folder for folder in sorted(drawn_folder(script, draw, count).iterdir())
            if folder.name.startswith(tuple(wanted or ('',)))]


def drawn_folder(script, draw, count):
    root, script = working_folder(), Path(script)
    cases = root / f'{script.stem}-{digest(root / "make_cases.py", script)}'
    if cases.exists():
        return cases
    sys.path.insert(0, str(root))
    import make_cases
    for name in make_cases.PROC:
        make_cases.load_tex(name)  # draws it, once
    with tempfile.TemporaryDirectory(dir=root) as temporary:
        made = Path(temporary) / script.stem
        made.mkdir()
        with ProcessPoolExecutor(os.cpu_count()) as pool:
            list(pool.map(draw, [root] * count, range(count), [made] * count))
        put(made, cases)
    return cases


def copy_data(folder, copy):
    # copyfile: the original may be read-only, its modes must not come along.
    shutil.copytree(folder, copy, copy_function=shutil.copyfile)
    for path in [copy, *copy.rglob('*')]:
        path.chmod(0o755)
    (copy / 'cases').mkdir(exist_ok=True)
    subprocess.run([sys.executable, 'make_photo_cases.py'], cwd=copy, check=True,
                   stdout=subprocess.DEVNULL)


def case_name(case):
    """As make_cases.one() names its folder."""
    index, texture, slant, tilt, kind = case
    return f'{index:03d}_{texture}_s{slant}_t{tilt}_{kind}'


def camera_cases():
    """make_cases.py and what it is asked for: (index, texture, slant, tilt, kind of hole)."""
    sys.path.insert(0, str(working_folder()))
    import make_cases
    return make_cases, list(make_cases.cases(CASES))


def steep_names(least_deg):
    """Of the rendered cases with at least this slant."""
    return [case_name(case) for case in camera_cases()[1] if case[2] >= least_deg]


def rendered_folders(root, wanted):
    """Folders of the rendered cases, those that are wanted; made where they are not there yet."""
    if root == data_folder():
        return [path for path in sorted((root / 'cases').iterdir())
                if path.name.startswith(wanted)]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        made = [pool.submit(render, root, case) for case in camera_cases()[1]
                if case_name(case).startswith(wanted)]
        return [folder.result() for folder in made]


def render(root, case):
    """The case's folder; made when it is not there."""
    path = root / 'cases' / case_name(case)
    if not path.exists():
        with tempfile.TemporaryDirectory(dir=root) as temporary:
            subprocess.run([sys.executable, '-c', MAKE_ONE, str(case[0]), temporary], cwd=root,
                           check=True, stdout=subprocess.DEVNULL, env={**os.environ, **KEEP_PAGES})
            put(Path(temporary) / path.name, path)
    return path


def angles_of(meta):
    """A camera of make_cases.py as recede's options."""
    return [f'--{option}={meta[key]}' for option, key in
            (('slant', 'slant'), ('tilt', 'tilt'), ('fov', 'fov_deg'))]


def scale_maps():
    """(case's name, recede's options, {'across', 'along'}: px per texel) of every rendered case.

    A case that is not rendered yet has no scale.npz: rendering takes seconds, so its maps are made
    here by what would write them, make_cases.py's camera.
    """
    root = working_folder()
    make_cases, cases = camera_cases()
    for case in cases:
        folder = root / 'cases' / case_name(case)
        if folder.exists():
            maps = np.load(folder / 'scale.npz')
            yield folder.name, angles_of(json.loads((folder / 'meta.json').read_text())), maps
        else:
            _, _, slant, tilt, _ = case
            camera = make_cases.Plane(SIZE, SIZE, slant, tilt, make_cases.FOVS[slant])
            across, along = (values.astype(np.float32) for values in camera.scales())
            yield folder.name, angles_of(camera.meta()), {'across': across, 'along': along}


def synthetic_case(folder):
    meta = json.loads((folder / 'meta.json').read_text())
    angles = angles_of(meta)
    line = np.linalg.inv(np.array(meta['H_texture_to_image'], float))[2]
    centre = np.array([(meta['width'] - 1) / 2, (meta['height'] - 1) / 2, 1])
    return Case(folder.name, folder, float(meta['slant']), line / (line @ centre), angles,
                texture=meta['texture'])


def photo_case(folder):
    geometry = json.loads((folder / 'geo.json').read_text())
    case = Case(folder.name, folder, None, np.array(geometry['horizon'], float))
    left, right = geometry['horizon_y_left_right']
    height, width = case.mask.shape
    case.options = (['--frontal'] if left is None else
                    [f'--horizon=0,{left * height},{width},{right * height}'])
    case.source = ['--source', str(folder / 'valid.png')]
    return case


def load_cases(wanted=()):
    """Every case, or those whose name begins with one of the wanted words."""
    wanted = tuple(wanted or ('',))
    root = working_folder()
    cases = [synthetic_case(path) for path in rendered_folders(root, wanted)]
    cases += [photo_case(path) for path in sorted((root / 'photo_cases').iterdir())
              if path.name.startswith(wanted)]
    if not cases:
        raise SystemExit(f'no case begins with {" or ".join(wanted)}')
    return cases


_metrics = {}


def metrics_of(root):
    """The data's metrics.py as a module."""
    path = root / 'metrics.py'
    if path not in _metrics:
        spec = importlib.util.spec_from_file_location('metrics', path)
        _metrics[path] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(_metrics[path])
        cv2.setNumThreads(1)  # metrics sets 2; we measure in processes of our own
    return _metrics[path]


class Judge:
    """Scores results of one case; the truth is measured once."""

    def __init__(self, case):
        self.case = case
        self.metrics = metrics_of(case.folder.parents[1])
        mask = case.mask
        hole = mask > 127
        rows, columns = np.nonzero(hole)
        line = case.line / (case.line @ np.array([columns.mean(), rows.mean(), 1]))
        valid = case.image('valid', cv2.IMREAD_GRAYSCALE) if case.is_photo else None
        self.geometry = self.metrics.Geo(hole.shape, line, valid)
        self.hole = hole & self.geometry.ok
        self.known = (cv2.dilate(mask, np.ones((5, 5))) <= 127) & self.geometry.ok
        self.bands = self.metrics.bands(self.geometry, self.hole, self.known)
        self.key = digest(case.folder / 'truth.png', case.folder / 'mask.png', line,
                          case.folder.parents[1] / 'metrics.py')

    def raw(self, picture):
        picture = picture.astype(np.float32) / 255
        return self.metrics.raw(picture, picture, self.hole, self.known, self.geometry,
                                self.geometry, self.bands, True)

    def scale_error(self, picture):
        """The score's scale term of a picture in memory, in a tenth of the time of all terms."""
        truth = cached('scale', self.key, lambda: self.scales(self.case.image('truth')))
        return float(np.hypot(*(self.scales(picture) - truth)))

    def scales(self, picture):
        """Octaves by which the detail is off, along and across, against known pixels."""
        light = self.metrics.lum(picture.astype(np.float32) / 255)
        bank = self.metrics.bank_for(light.shape, self.geometry.d)
        found = self.metrics.m_scale(light, light, self.geometry, self.geometry, self.bands, bank,
                                     bank)
        return np.array([found['along'], found['across']])

    def measure(self, picture):
        truth = cached('truth', self.key, lambda: self.raw(self.case.image('truth')))
        terms = self.metrics.penalties(self.raw(picture), truth)
        return {'score': self.metrics.score(terms), 'terms': terms, 'losses': self.losses(terms)}

    def losses(self, terms):
        """What each term takes from the score, in its weighted sum; 0 within its unit."""
        return {term: weight * min(max(terms[term] / self.metrics.UNITS[term] - 1, 0), 4)
                for term, weight in self.metrics.WEIGHT.items() if term in terms}

    def score(self, path):
        """Of a file: what measure() gives, and 'changed_outside', pixels."""
        return cached('score', digest(self.key, path, 2), lambda: self.score_now(path))

    def score_now(self, path):
        picture = cv2.imread(str(path), cv2.IMREAD_COLOR)
        original = self.case.image('input')
        if picture is None or picture.shape != original.shape:
            raise ValueError(f'{path}: not a picture of the size of its case')
        outside = (picture != original).any(axis=2) & (self.case.mask == 0)
        return {**self.measure(picture), 'changed_outside': int(outside.sum())}
