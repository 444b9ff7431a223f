"""recede scale-map against the scale maps of the evaluation's cases, which another program made
from its own camera: scale.npz, px per texel across and along the tilt."""
import os
import sys
from pathlib import Path

os.environ['OPENCV_IO_ENABLE_OPENEXR'] = '1'  # read when cv2 is imported
import numpy as np

sys.path[:0] = [str(Path(__file__).resolve().parents[1] / 'cli')]
import harness  # noqa: E402
from evaluation import data_folder, scale_maps  # noqa: E402

# Floats on both sides: three roundings of 6e-8.
MOST = 1e-6
KINDS = ('across', 'along')


def made(folder, shape, options):
    """{kind: values} as the command writes them, 1 across at the centre."""
    values = {}
    for kind in KINDS:
        out = folder / 'map.exr'
        harness.recede('scale-map', f'--size={shape[1]}x{shape[0]}', *options, f'--kind={kind}',
                       '-o', out, '--force', '-q')
        values[kind] = harness.read(out)
        harness.check(values[kind].dtype == np.float32, kind, 'is', values[kind].dtype)
    return values


def test_every_case_of_the_evaluation(folder):
    if data_folder() is None:
        raise harness.Skip('the evaluation data is not beside the checkout')
    ours, worst, count = {}, 0, 0
    for name, options, theirs in scale_maps():
        # Cases of one camera share a map: starting the command takes longer than all else.
        key = (*theirs['across'].shape, *options)
        if key not in ours:
            ours[key] = made(folder, theirs['across'].shape, options)
        texel_px = centre(theirs['across'])
        for kind in KINDS:
            expected = theirs[kind].astype(float) / texel_px
            harness.check(np.isfinite(expected).all(), name, 'has a horizon')
            off = abs(ours[key][kind] / expected - 1).max()
            harness.check(off <= MOST, name, kind, f'is off by {off:.1e}')
            worst = max(worst, off)
        count += 1
    harness.check(count == 30, count, 'cases, not 30')
    print(f'# {count} cases, {len(ours)} cameras, off by {worst:.1e} at most', flush=True)


def centre(values):
    """Linear across the tilt, so that the mean of any four around the centre is the centre's."""
    height, width = values.shape
    rows, columns = ([(n - 1) // 2, n // 2] for n in (height, width))
    return float(values[np.ix_(rows, columns)].astype(float).mean())


if __name__ == '__main__':
    sys.exit(harness.main(globals()))
