"""Runs a world and writes its frames, in pieces that leave a program's window alive. Needs wadi and NumPy alone."""
import time

import wadi

from . import cache

#: What every frame has: outputs of the world, by their names in wadi.Output.
SHAPE = ("sand_surface", "free_surface", "sand_depth", "water_depth", "saturation", "flow")
#: What a library may have beside: traces that a world carries where it is asked for them. Foam is that of the moment where it is not.
DRAWN = tuple(name for name in ("foam", "wetness", "silt") if name.upper() in wadi.Output.__members__)
PIECE = 0.03  # seconds that a piece of work may take, where a step does not take longer


def draws(drifting_foam):
    """What a world is asked to carry."""
    return tuple(name for name in DRAWN if drifting_foam or name != "foam")


class Bake:
    """One bake, in pieces of work: `tick` does some of them.

    make        a function that returns the world
    folder      of the cache
    seconds     simulated time that the frames show [s]
    fps         frames per second of simulated time
    skip        simulated time ahead of the first frame [s]
    about       goes into the cache's wadi.json
    """

    def __init__(self, make, folder, seconds, fps, skip=0.0, about=None):
        for name, value, least in (("seconds", seconds, 0), ("fps", fps, 1e-3), ("skip", skip, 0)):
            if not least <= value <= 1e6:
                raise ValueError(f"{name}: {value:g}, must be {least:g} ... 1e6")
        self._make, self._folder, self._about = make, folder, about or {}
        self.fps, self.skip, self.count = fps, skip, int(seconds * fps + 1e-6) + 1
        self.done = 0  # frames that are written
        self.share = 0.0
        self._work = self._pieces()

    def steps(self, frame, dt):
        """Steps that a world of that time step has made when a frame shows it."""
        return int((self.skip + frame / self.fps) / dt + 1e-6)

    def _pieces(self):
        with self._make() as world:
            about = {"nx": world.nx, "ny": world.ny, "dx": world.dx, "dt": world.dt, "name": world.name, "backend": world.backend,
                     "fps": self.fps, "skip": self.skip, "wadi": wadi.version(), "warnings": world.warnings}
            writer = cache.Writer(self._folder, {**about, **self._about})
            outputs = SHAPE + DRAWN
            world.set_outputs(*outputs, host=True)
            last, chunk = max(1, self.steps(self.count - 1, world.dt)), 1
            yield
            for frame in range(self.count):
                while (left := self.steps(frame, world.dt) - world.steps) > 0:
                    begun = time.perf_counter()
                    world.step(min(chunk, left))
                    world.wait()
                    taken = time.perf_counter() - begun
                    chunk = max(1, chunk // 2) if taken > PIECE else min(2 * chunk, 1024) if taken < PIECE / 2 else chunk
                    self.share = world.steps / last
                    yield
                world.publish()
                writer.add({name: world.output(name) for name in outputs}, hash=f"{world.hash():016x}")
                self.done = frame + 1
                yield

    def tick(self, seconds=0.05):
        """Works for about that long, at least one piece. True while there is more to do."""
        end = time.perf_counter() + seconds
        while True:
            more = next(self._work, self) is not self
            if not more:
                self.share = 1.0
            if not more or time.perf_counter() >= end:
                return more

    def stop(self):
        """Closes the world. Frames that are written stay."""
        self._work.close()
