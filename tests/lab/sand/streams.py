"""Sand under waves and streams: the same on a finer grid, and when the whole scene is turned against the grid."""
import numpy as np

import patterns
import shapes
from cases import case
from scene import grid, level
from table import at_most, shown

FIELD = 16  # walled square, wide enough that nothing that returns from the walls counts [m]
TURNS = (30, 45)


def wave(depth, length, width, front):
    """Water of a depth whose face stands at x = front, ahead of which it will run along x."""
    return lambda x, y: np.where((x > front - length) & (x < front) & (np.abs(y) < width / 2), float(depth), 0.0)


def washed(name, sand, water, wet, seconds, limits, control, held=(None, None)):
    """limits: of the difference of two grids and of the difference to the scene turned, over what moved. held: what both keep to so far."""
    @case(name, dx=(0.1,), control=control)
    def measure(lab, dx):
        def scene(spacing, turn=0):
            cells = grid(FIELD, FIELD, spacing)
            drawn = shapes.draw(cells, sand, turn)
            return level(cells, sand=[{"file": drawn}], water=[{"file": shapes.draw(cells, water, turn) + wet * drawn}])

        straight, fine, *turned = lab.runs([(one, [0, seconds]) for one in (scene(dx), scene(dx / 2), *(scene(dx, turn) for turn in TURNS))])
        start, coarse = straight.field("hs", 0), straight.field("hs", seconds)
        return [
            at_most("difference of the two grids / moved", patterns.refinement(fine.field("hs", seconds), coarse, start), limits[0], held=held[0]),
            *(at_most(f"turned by {turn}: difference / moved", patterns.rotation(run.field("hs", seconds), coarse, start, dx, turn), limits[1],
                       held=held[1])
              for turn, run in zip(TURNS, turned)),
            shown("sand elsewhere on the finer grid", patterns.elsewhere(fine.field("hs", seconds), coarse)),
            shown("share in its place", patterns.in_place(coarse, start, 0)),
        ]


def dam(height, slope, crest, length):
    """A dam along y with sloping faces."""
    return lambda x, y: np.where(np.abs(y) < length / 2, np.clip(height - slope * np.maximum(np.abs(x) - crest / 2, 0), 0, None), 0.0)


washed("block_in_a_wave", shapes.block(2.4, 2.4, 1.2), wave(1.5, 4, 8, -2), 0.25, 2.5, (0.21, 0.26), {"dt": 0.03}, (0.24, None))
washed("dam_overtopped", dam(0.6, 0.45, 0.5, 6), wave(1, 4, 6, -1.5), 0.25, 3, (0.11, 0.1), {"dt": 0.03}, (None, 0.14))
washed("pile_in_a_stream", shapes.cone(0.45, 1), wave(1, 5, 8, -2.5), 0.1, 3, (0.11, 0.145), {"dt": 0.03}, (None, 0.205))


def cliff(lake):
    """A vertical face of sand without cohesion, free or under a lake, falls as fast on finer grids."""
    @case("cliff_drowned" if lake else "cliff_dry", dx=(0.1,), control={"dt": 0.03}, quick=(0.1,))
    def measure(lab, dx):
        times, spacings = (0.25, 0.5, 1), (dx, dx / 2, dx / 4)

        def scene(spacing):
            cells = {**grid(12.8, 0, spacing), "ny": 4}
            drawn = shapes.draw(cells, lambda x, y: np.where(np.abs(x) < 2, 0.8, 0.0))
            return level(cells, {"cohesion_wet": 0, "cohesion_capillary": 0}, sand=[{"file": drawn}],
                         water=[{"shape": "plane", "surface": 1.2}] if lake else [])

        runs = lab.runs([(scene(spacing), [0, *times]) for spacing in spacings])
        moved = {time: [np.abs(run.field("hs", time) - run.field("hs", 0))[0].sum() * run.dx for run in runs] for time in times}
        return [at_most(f"moved at {time} s, cells of {dx:g} m / of {dx / 4:g} m", volumes[0] / volumes[-1], 1.3)
                for time, volumes in moved.items()] + [shown(f"moved at {time} s", volumes[-1], "m2") for time, volumes in moved.items()]


cliff(lake=False)
cliff(lake=True)
