"""Exact solutions: a dam at x0 with still water of depth `left` behind it and `right` before it breaks at t = 0."""
import functools
import math

G = 9.81


def ritter(x, t, left, x0):
    """Depth on dry ground [m] (Ritter 1892)."""
    c = math.sqrt(G * left)
    s = (x - x0) / t
    if s <= -c:
        return left
    return 0.0 if s >= 2 * c else (2 * c - s) ** 2 / (9 * G)


def ritter_front(t, left, x0, depth):
    """Where the depth is `depth` [m]."""
    return x0 + t * (2 * math.sqrt(G * left) - 3 * math.sqrt(G * depth))


@functools.cache  # asked for again in each cell
def stoker_middle(left, right):
    """(depth, velocity, shock speed) between rarefaction and shock (Stoker 1957), by bisection on the depth."""
    def mismatch(h):
        from_left = 2 * (math.sqrt(G * left) - math.sqrt(G * h))
        from_right = (h - right) * math.sqrt(0.5 * G * (1 / h + 1 / right))
        return from_left - from_right

    low, high = right, left
    for _ in range(200):
        h = 0.5 * (low + high)
        low, high = (h, high) if mismatch(h) > 0 else (low, h)
    u = 2 * (math.sqrt(G * left) - math.sqrt(G * h))
    return h, u, h * u / (h - right)


def stoker(x, t, left, right, x0):
    """Depth on wet ground [m] (Stoker 1957)."""
    h, u, shock = stoker_middle(left, right)
    s = (x - x0) / t
    if s <= -math.sqrt(G * left):
        return left
    if s <= u - math.sqrt(G * h):
        return (2 * math.sqrt(G * left) - s) ** 2 / (9 * G)
    return h if s <= shock else right


def simple_wave(x, t):
    """Depth [m] of a hump, 0.3 m high at 20 m on 1 m of water, that runs east: each depth keeps its speed 3 sqrt(g h) - 2 sqrt(g), until it
    breaks (some 4 s)."""
    def start(x0):
        return 1 + 0.3 * math.exp(-(x0 - 20) ** 2 / 16)

    low, high = x - 60, x  # where the depth that is at x now came from
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if middle + t * (3 * math.sqrt(G * start(middle)) - 2 * math.sqrt(G)) < x else (low, middle)
    return start(low)


BUMP_CREST, BUMP_AT = 0.2, 10


def bump(x):
    """Elevation of the bed [m] of the steady flows (Goutal and Maurel 1997)."""
    return max(0.0, BUMP_CREST - 0.05 * (x - BUMP_AT) ** 2)


@functools.cache
def depth_of_head(head, q, fast):
    """Depth [m] where h + q^2/(2 g h^2) = head, of the fast (supercritical) or the slow stream, by bisection."""
    critical = (q * q / G) ** (1 / 3)
    low, high = (1e-6, critical) if fast else (critical, head)
    for _ in range(200):
        h = 0.5 * (low + high)
        too_much = h + q * q / (2 * G * h * h) > head
        low, high = (h, high) if too_much == fast else (low, h)
    return 0.5 * (low + high)


def steady_over_bump(x, q, right, through_critical):
    """Depth [m] of q [m2/s] over the bump; `right`: the depth downstream, None where the stream leaves as fast as it became. Through
    critical depth at the crest; with a depth downstream it jumps back behind it."""
    def head(h):
        return h + q * q / (2 * G * h * h)

    if not through_critical:
        return depth_of_head(head(right) - bump(x), q, False)
    above = BUMP_CREST + head((q * q / G) ** (1 / 3))
    if x <= BUMP_AT:
        return depth_of_head(above - bump(x), q, False)
    jump = math.inf if right is None else jump_behind_bump(q, right, above)
    return depth_of_head(above - bump(x), q, True) if x < jump else depth_of_head(head(right) - bump(x), q, False)


@functools.cache
def jump_behind_bump(q, right, above):
    """Where the fast stream of head `above` and the slow one of depth `right` downstream have the same momentum [m]."""
    below = right + q * q / (2 * G * right * right)

    def too_strong(x):
        fast, slow = depth_of_head(above - bump(x), q, True), depth_of_head(below - bump(x), q, False)
        return q * q * (1 / fast - 1 / slow) + 0.5 * G * (fast * fast - slow * slow) > 0

    # The slow stream needs its head over the bed: no nearer to the crest than that.
    critical = 1.5 * (q * q / G) ** (1 / 3)
    low = BUMP_AT + math.sqrt(max(0.0, BUMP_CREST - (below - critical)) / 0.05) + 1e-9
    high = BUMP_AT + math.sqrt(BUMP_CREST / 0.05)
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if too_strong(middle) else (low, middle)
    return low


class PlanarBowl:
    """Thacker's (1981) plane surface that tilts to and fro in a parabolic valley; SI units, t = 0 at its steepest."""
    h0, a, length = 0.5, 1.0, 4.0
    omega = math.sqrt(2 * G * h0) / a
    period = 2 * math.pi / omega

    @classmethod
    def bed(cls, x):
        return cls.h0 * (((x - cls.length / 2) / cls.a) ** 2 - 1)

    @classmethod
    def depth(cls, x, t):
        return max(0.0, cls.h0 * (1 - ((x - cls.length / 2) / cls.a + 0.5 / cls.a * math.cos(cls.omega * t)) ** 2))

    @classmethod
    def tilt(cls, t):
        return -cls.h0 / cls.a**2 * math.cos(cls.omega * t)


def dupuit(x, length, left, right):
    """Depth [m] of the water that seeps through sand between two levels (Dupuit 1863): its square is linear."""
    return math.sqrt(left * left + (right * right - left * left) * min(max(x / length, 0.0), 1.0))


def incline_acceleration(slope, friction, share, together):
    """Of a layer of sand [m/s2], down a slope of which gravity takes the share g slope. share: weight of the water in it over the sand's own;
    together: the water moves with the sand instead of past it."""
    return G * (slope - friction * (1 - share) / (1 + share if together else 1))
