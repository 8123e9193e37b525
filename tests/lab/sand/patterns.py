"""What grids and instabilities leave in sand: ripples by wavelength, lobes of fronts, differences between grids and between turned
drawings, lost relief. Heights are arrays [y, x], lengths metres."""
import numpy as np

import shapes


def cells_of(heights, dx):
    return {"nx": heights.shape[1], "ny": heights.shape[0], "dx": dx}


def ripples(heights, dx, longest, shortest=0.0, within=None):
    """rms of what is not the same all around the middle, of wavelengths from `shortest` to `longest`: of the disc `within`, or of the whole
    field as if all of it lay in a disc of 2.5 m. Under a Hann window over the field, whose loss is made good on average."""
    x, y = shapes.centres(cells_of(heights, dx))
    away = np.hypot(x, y)
    ring = np.floor(away / dx).astype(int).ravel()
    count = np.bincount(ring)
    # Between rings linear, or else each ring of a slope would be a ripple of one cell.
    mean = np.interp(away, np.bincount(ring, away.ravel()) / count, np.bincount(ring, heights.ravel()) / count)
    window = np.outer(*(np.sin(np.pi * (np.arange(size) + 0.5) / size) ** 2 for size in heights.shape))
    waves = np.hypot(*np.meshgrid(np.fft.fftfreq(heights.shape[1], dx), np.fft.fftfreq(heights.shape[0], dx)))
    kept = (waves > 1 / longest) & (waves <= (1 / shortest if shortest else np.inf))
    passed = np.fft.ifft2(np.where(kept, np.fft.fft2((heights - mean) * window), 0)).real
    if within:
        return np.sqrt((passed[away < within] ** 2).mean() / (window[away < within] ** 2).mean())
    return np.sqrt((passed**2).sum() * dx**2 / (np.pi * 2.5**2) / (window**2).mean())


def sample(heights, dx, x, y):
    """Bilinear between centres of cells, constant beyond the outermost; x and y from the middle of the grid."""
    column = np.clip(x / dx + heights.shape[1] / 2 - 0.5, 0, heights.shape[1] - 1)
    row = np.clip(y / dx + heights.shape[0] / 2 - 0.5, 0, heights.shape[0] - 1)
    west, south = (np.minimum(index.astype(int), size - 2) for index, size in ((column, heights.shape[1]), (row, heights.shape[0])))
    east, north = column - west, row - south
    low = heights[south, west] * (1 - east) + heights[south, west + 1] * east
    high = heights[south + 1, west] * (1 - east) + heights[south + 1, west + 1] * east
    return low * (1 - north) + high * north


def front(heights, dx, depth, angles=720):
    """Distance from the middle to the outermost place as deep as `depth`, at evenly spaced angles from the x axis on."""
    angle = np.arange(angles) * 2 * np.pi / angles
    away = np.arange(0, min(heights.shape) * dx / 2, dx / 4)
    along = sample(heights, dx, np.outer(np.cos(angle), away), np.outer(np.sin(angle), away))
    deep = along >= depth
    last = np.where(deep.any(axis=1), deep.shape[1] - 1 - np.argmax(deep[:, ::-1], axis=1), 0)
    after = np.minimum(last + 1, len(away) - 1)
    here, there = along[np.arange(angles), last], along[np.arange(angles), after]
    fall = np.where(here > there, here - there, 1)
    return away[last] + np.clip((here - depth) / fall, 0, 1) * (away[after] - away[last])


def lobes(radii, mode):
    """Amplitude of `mode` lobes along the axes; negative where they lie between them."""
    return 2 * np.fft.rfft(radii)[mode].real / len(radii)


def roughness(radii, first, last):
    """rms of a front's modes from first to last."""
    return np.sqrt(2 * (np.abs(np.fft.rfft(radii)[first : last + 1]) ** 2).sum()) / len(radii)


def restrict(heights, factor=2):
    ny, nx = heights.shape
    return heights.reshape(ny // factor, factor, nx // factor, factor).mean(axis=(1, 3))


def refinement(fine, coarse, start, least=0.0):
    """Mean difference between two grids over what moved on the coarser one, or over `least` [m] of mean movement where less did."""
    return np.abs(restrict(fine, len(fine) // len(coarse)) - coarse).mean() / max(np.abs(coarse - start).mean(), least)


def elsewhere(fine, coarse):
    """Share of all sand that lies in other cells on the finer grid."""
    return 0.5 * np.abs(restrict(fine, len(fine) // len(coarse)) - coarse).sum() / coarse.sum()


def turn_back(heights, dx, degrees):
    x, y = shapes.centres(cells_of(heights, dx))
    return sample(heights, dx, *shapes.turned(x, y, -degrees))


def rotation(turned, straight, start, dx, degrees):
    """Mean difference between a scene and the same one drawn turned, over what moved."""
    return np.abs(turn_back(turned, dx, degrees) - straight).mean() / np.abs(straight - start).mean()


def mean_around(heights, cells):
    """Mean over squares of side 2 `cells` about each cell, of which the outermost cells count in part; smaller at the sides."""
    whole = int(cells - 0.5)
    weights = [cells - 0.5 - whole, *[1] * (2 * whole + 1), cells - 0.5 - whole]
    mean, there = np.pad(heights, whole + 1), np.pad(np.ones_like(heights), whole + 1)
    for axis, size in enumerate(heights.shape):
        parts = [(weight, range(first, first + size)) for first, weight in enumerate(weights)]
        mean, there = (sum(weight * np.take(field, part, axis) for weight, part in parts) for field in (mean, there))
    return mean / there


def relief(heights, start, dx, width=1.0, above=0.5):
    """Share kept of the rms of heights less their mean over `width`, where sand was drawn above `above`."""
    rest = [field - mean_around(field, width / dx / 2) for field in (heights, start)]
    now, drawn = (np.sqrt((field[start > above] ** 2).mean()) for field in rest)
    return now / drawn


def in_place(heights, start, above):
    """Share of what stood in cells drawn deeper than `above` that is still there, cell by cell."""
    where = start > above
    return np.minimum(heights, start)[where].sum() / start[where].sum()
