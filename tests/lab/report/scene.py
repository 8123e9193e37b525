"""What a scene with a known answer is, and the norms in which it errs."""
import math

G = 9.81


class Scene:
    """n: cells along x of its base size; step(dx): its base time step; make(n): the level without dt; measure(run, summary, level): list
    of (name, unit, value, right answer or None), the first an error in percent."""

    def __init__(self, key, kind, title, n, seconds, make, measure, *, step, fields=("W", "hs", "surface"), files=None):
        self.key, self.kind, self.title, self.n, self.seconds, self.make, self.measure = key, kind, title, n, seconds, make, measure
        self.step, self.fields, self.files = step, fields, files


def base(name, nx, ny, dx, **rest):
    return {"format_version": 1, "name": name, "grid": {"nx": nx, "ny": ny, "dx": dx}, **rest}


def norms(got, truth, scale=None):
    """Measures of the error of a depth, all in percent: of `scale` [m], or each of the truth's own norm."""
    off = [abs(a - b) for a, b in zip(got, truth)]
    count = len(off)
    ones = [scale] * count if scale else truth
    return [("L1 error of depth", "%", 100 * math.fsum(off) / math.fsum(ones), 0),
            ("L2 error of depth", "%", 100 * math.sqrt(math.fsum(x * x for x in off) / math.fsum(x * x for x in ones)), 0),
            ("max error of depth", "%", 100 * max(off) / max(ones), 0)]


def middle_row(run, name, time):
    """A field along the middle of a channel of three rows."""
    return run.field(name, time)[run.nx:2 * run.nx]
