"""Closed forms that the matrix holds the sand to: infinite slopes (Taylor 1948; Skempton and DeLory 1957), faces by Culmann (1875) and
upright ones by Rankine (1857). Slopes and frictions are tangents, cohesions Pa, depths and heights m; `wet` is the water in the pores as
a share of the sand's depth."""
import math

GRAVITY, DENSITY, WATER = 9.81, 2000.0, 1000.0
RETENTION = 0.4925  # share of the depth that drained pores hold, the levels' default


def passive(friction):
    """tan(45 deg + phi/2)."""
    return friction + math.sqrt(1 + friction**2)


def full_share(wet, retention=RETENTION):
    """Share of the depth below the table, where pores are full; above it they hold `retention`."""
    return min(1.0, max(0.0, (wet - retention) / (1 - retention)))


def sliding_slope(friction, wet, retention=RETENTION):
    """Slope from which a layer without cohesion slides whose pore water flows down the slope: its weight pushes, and bears less friction by
    the buoyancy of what lies below the table. Water held above the table only weighs."""
    ratio, full = WATER / DENSITY, full_share(wet, retention)
    held = ratio * (wet - full)
    return friction * (1 + held - ratio * full) / (1 + held)


def slab_cohesion(slope, depth, friction, wet=0.0):
    """What a slab of upright depth needs to stand on a bed of that slope, held water and all: c + w cos^2 mu = w sin cos."""
    weight = (DENSITY + WATER * wet) * GRAVITY * depth
    return weight * (slope - friction) / (1 + slope**2)


def block_speed(slope, friction, seconds):
    """Horizontal speed of a block that slides from rest."""
    return GRAVITY * max(0.0, slope - friction) / (1 + slope**2) * seconds


def face_cohesion(height, slope, friction):
    """What a face of that slope (math.inf: upright) needs to stand, by Culmann's plane at (beta + phi)/2."""
    beta, phi = math.atan(slope), math.atan(friction)
    if beta <= phi:
        return 0.0
    return DENSITY * GRAVITY * height * (1 - math.cos(beta - phi)) / (4 * math.sin(beta) * math.cos(phi))


def face_wedge(height, slope, friction):
    """Area between the face and that plane."""
    beta, phi = math.atan(slope), math.atan(friction)
    return height**2 / 2 * (1 / math.tan((beta + phi) / 2) - 1 / math.tan(beta))
