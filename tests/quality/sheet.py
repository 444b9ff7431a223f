"""Contact sheets: for every case truth, input, ours and the best peer at 1:1 around the hole."""
import cv2
import numpy as np

MARGIN = 48          # px of surroundings: enough to see the seam and the pattern beside it
LARGEST = 420        # px, a crop's side; larger holes show their middle
ROWS_PER_SHEET = 6
LINE = 18            # px, height of the text above each crop


def window(mask):
    """Slices of the picture around the hole."""
    rows, columns = np.nonzero(mask)
    spans = []
    for values, size in ((rows, mask.shape[0]), (columns, mask.shape[1])):
        low, high = max(values.min() - MARGIN, 0), min(values.max() + MARGIN + 1, size)
        if high - low > LARGEST:
            low = (low + high - LARGEST) // 2
            high = low + LARGEST
        spans.append(slice(int(low), int(high)))
    return tuple(spans)


def titled(crop, text, width, height):
    tile = np.full((height + LINE, width, 3), 255, np.uint8)
    tile[LINE:LINE + crop.shape[0], :crop.shape[1]] = crop
    cv2.putText(tile, text, (2, LINE - 5), cv2.FONT_HERSHEY_SIMPLEX, .42, (0, 0, 0), 1,
                cv2.LINE_AA)
    return tile


def row(case, panels):
    """panels: (title, picture or path or None)."""
    area = window(case.mask)
    tiles = []
    for title, picture in panels:
        if picture is not None and not isinstance(picture, np.ndarray):
            picture = cv2.imread(str(picture), cv2.IMREAD_COLOR)
        crop = (np.full((40, 40, 3), 200, np.uint8) if picture is None else picture[area])
        tiles.append((title, crop))
    height = max(crop.shape[0] for _, crop in tiles)
    width = max(max(crop.shape[1] for _, crop in tiles), 200)
    return np.hstack([titled(crop, title, width + 4, height) for title, crop in tiles])


def write(rows, stem):
    """Writes stem-1.png, stem-2.png, ... and returns their paths."""
    paths = []
    for start in range(0, len(rows), ROWS_PER_SHEET):
        page = rows[start:start + ROWS_PER_SHEET]
        width = max(picture.shape[1] for picture in page)
        page = [np.pad(picture, ((0, 6), (0, width - picture.shape[1]), (0, 0)),
                       constant_values=255) for picture in page]
        path = f'{stem}-{start // ROWS_PER_SHEET + 1}.png'
        cv2.imwrite(path, np.vstack(page))
        paths.append(path)
    return paths
