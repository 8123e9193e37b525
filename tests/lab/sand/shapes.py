"""Heights drawn by area coverage: the mean over samples inside each cell, so that a shape may be turned by any angle and looks alike
on every grid."""
import numpy as np


def centres(grid):
    """x and y of every cell's centre, counted from the middle of the grid."""
    x = (np.arange(grid["nx"]) + 0.5 - grid["nx"] / 2) * grid["dx"]
    y = (np.arange(grid["ny"]) + 0.5 - grid["ny"] / 2) * grid["dx"]
    return np.meshgrid(x, y)


def turned(x, y, degrees):
    """Coordinates along the axes of a shape that was turned anticlockwise."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return c * x + s * y, c * y - s * x


def draw(grid, height, turn=0.0, samples=8):
    """The map of height(x, y), given about the middle of the grid and turned about it."""
    x, y = centres(grid)
    offsets = ((np.arange(samples) + 0.5) / samples - 0.5) * grid["dx"]
    total = np.zeros_like(x)
    for oy in offsets:
        for ox in offsets:
            total += height(*turned(x + ox, y + oy, turn))
    return total / samples**2


def disc(radius, height):
    return lambda x, y: np.where(np.hypot(x, y) < radius, float(height), 0.0)


def block(length, width, height):
    return lambda x, y: np.where((np.abs(x) < length / 2) & (np.abs(y) < width / 2), float(height), 0.0)


def cone(slope, height):
    return lambda x, y: np.maximum(height - slope * np.hypot(x, y), 0.0)


def incline(grid, slope, turn=0.0):
    """Ground that falls along the turned x axis, exact at cell centres, 0 in the middle."""
    return -slope * turned(*centres(grid), turn)[0]
