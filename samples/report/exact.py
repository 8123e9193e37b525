"""Exact solutions: a dam at x0 with still water of depth `left` behind it and `right` before it breaks at t = 0."""
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
