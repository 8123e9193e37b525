"""The report's exact solutions against the equations that define them, constants given here by value: residuals vanish, and do not for
another discharge or time.

usage: exact_solutions.py SAMPLES_REPORT_FOLDER"""
import math
import sys

sys.path.insert(0, sys.argv[1])
import exact  # noqa: E402

G = 9.81


def cubic(h, x, q, head):
    """h^3 + (z - head) h^2 + q^2/(2 g), z the bump of Goutal and Maurel."""
    z = 0.2 - 0.05 * (x - 10) ** 2 if 8 < x < 12 else 0
    return h**3 + (z - head) * h * h + q * q / (2 * G)


def jump(h1, h2, q):
    return q * q * (1 / h1 - 1 / h2) + 0.5 * G * (h1 * h1 - h2 * h2)


def steady():
    critical = lambda q: (q * q / G) ** (1 / 3)
    for q, right, through in ((4.42, 2.0, False), (1.53, None, True), (0.18, 0.33, True)):
        above = 0.2 + 1.5 * critical(q) if through else right + q * q / (2 * G * right * right)
        stop = exact.jump_behind_bump(q, right, above) if through and right else math.inf
        for n in range(250):
            x = 0.05 + 0.1 * n
            h = exact.steady_over_bump(x, q, right, through)
            head = above if x < stop else right + q * q / (2 * G * right * right)
            assert abs(cubic(h, x, q, head)) < 1e-9, (q, x)
            assert abs(cubic(h, x, 1.1 * q, head)) > 1e-4, (q, x)
            assert (h < critical(q)) == (through and 10 < x < stop), (q, x)  # fast behind the crest and up to the jump only
    above = 0.2 + 1.5 * critical(0.18)
    place = exact.jump_behind_bump(0.18, 0.33, above)
    sides = [exact.steady_over_bump(place + side, 0.18, 0.33, True) for side in (-1e-9, 1e-9)]
    assert abs(place - 11.666) < 1e-3 and sides[1] > 2 * sides[0] and abs(jump(*sides, 0.18)) < 1e-6 < abs(jump(*sides, 0.2)), (place, sides)


def bowl():
    """h0 = 0.5, a = 1, L = 4: volume stays, the surface is a plane, and its acceleration is -g times its slope."""
    h0, a, size, omega = 0.5, 1.0, 4.0, math.sqrt(2 * G * 0.5)
    places = [(n + 0.5) * size / 4000 for n in range(4000)]
    for t in (0, 0.2, 0.7, 1.1):
        depth = [exact.PlanarBowl.depth(x, t) for x in places]
        assert abs(math.fsum(depth) * size / 4000 - 4 / 3 * h0 * a) < 1e-5, t
        surface = [h0 * ((x - 2) ** 2 / a**2 - 1) + h for x, h in zip(places, depth) if h > 0]
        rise = (surface[-1] - surface[0]) / (len(surface) - 1)
        assert max(abs(s - surface[0] - n * rise) for n, s in enumerate(surface)) < 1e-9, t
        assert abs(rise / (size / 4000) - exact.PlanarBowl.tilt(t)) < 1e-9, t
        middle = lambda at: math.fsum(x * exact.PlanarBowl.depth(x, at) for x in places) / math.fsum(exact.PlanarBowl.depth(x, at) for x in places)
        speed_up = (middle(t + 1e-2) - 2 * middle(t) + middle(t - 1e-2)) / 1e-4
        assert abs(speed_up + G * exact.PlanarBowl.tilt(t)) < 0.01, t
    assert abs(omega * exact.PlanarBowl.period - 2 * math.pi) < 1e-12


def wave():
    """Depth is carried at 3 sqrt(g h) - 2 sqrt(g) and volume stays."""
    for t in (0.5, 2.0):
        x = 20.0 + 4.0
        h = exact.simple_wave(x, t)
        from_ = x - t * (3 * math.sqrt(G * h) - 2 * math.sqrt(G))
        assert abs(h - (1 + 0.3 * math.exp(-(from_ - 20) ** 2 / 16))) < 1e-9, t
        volumes = [math.fsum(exact.simple_wave(0.05 + 0.1 * n, at) - 1 for n in range(600)) for at in (0, t)]
        assert abs(volumes[1] / volumes[0] - 1) < 1e-4, volumes
    assert abs(exact.simple_wave(24, 2) - exact.simple_wave(24, 0)) > 0.01


def ground():
    heights = [exact.dupuit(2 * n / 10, 2, 1, 0.5) for n in range(11)]
    squares = [h * h for h in heights]
    assert heights[0] == 1 and heights[-1] == 0.5
    assert all(abs(squares[n + 1] - squares[n] + 0.075) < 1e-12 for n in range(10)) and abs(heights[5] - 0.75) > 0.01
    # Two columns of masses 1 and share, friction under the weight that buoyancy leaves; apart the water is not felt.
    assert abs(exact.incline_acceleration(0.3, 0.25, 0.5, False) - G * (0.3 - 0.25 * 0.5)) < 1e-12
    assert abs(exact.incline_acceleration(0.3, 0.25, 0.5, True) - (1.5 * G * 0.3 - G * 0.25 * 0.5) / 1.5) < 1e-12
    assert exact.incline_acceleration(0.3, 0.25, 0, True) == exact.incline_acceleration(0.3, 0.25, 0, False)


for check in (steady, bowl, wave, ground):
    check()
    print("OK", check.__name__)
