#!/usr/bin/env python3
"""The matrix' own measures and laws on fields and functions whose answers are known."""
import math
import pathlib
import sys
import unittest

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(1, str(HERE.parent))
import shapes  # noqa: E402
from scene import grid  # noqa: E402

import beds  # noqa: E402
import gauges  # noqa: E402
import laws  # noqa: E402
import resting  # noqa: E402

CELLS = grid(6.4, 6.4, 0.1)
FLAT = np.zeros((64, 64))
MIDDLE = np.hypot(*shapes.centres(CELLS)) < 2.6


class Slopes(unittest.TestCase):
    def test_an_incline_has_its_slope_in_any_direction(self):
        for turn in (0, 22.5, 45, 90):
            sand = 3 + shapes.incline(CELLS, 0.5, turn)
            self.assertAlmostEqual(gauges.steepest(FLAT, sand, 0.1, MIDDLE), 0.5, 6)
            self.assertAlmostEqual(gauges.steepest(sand, FLAT + 0.3, 0.1, MIDDLE), 0.5, 6)

    def test_a_cone_has_its_slope(self):
        self.assertAlmostEqual(gauges.steepest(FLAT, shapes.draw(CELLS, shapes.cone(0.5, 1)), 0.1), 0.5, 2)

    def test_a_wall_of_one_cell_is_seen(self):
        self.assertAlmostEqual(gauges.steepest(FLAT, shapes.draw(CELLS, beds.SHAPES["step"](1)) + 0.5, 0.1), 10, 6)

    def test_bare_ground_is_no_slope_of_sand(self):
        self.assertEqual(gauges.steepest(1 + shapes.incline(CELLS, 3), FLAT, 0.1), 0)

    def test_nothing_outside_counts(self):
        sand = FLAT + 1
        sand[0, 0] = 2
        self.assertEqual(gauges.steepest(FLAT, sand, 0.1, MIDDLE), 0)


class Load(unittest.TestCase):
    def of(self, slope, water_of):
        sand = 3 + shapes.incline(CELLS, slope, 22.5)
        return gauges.load(FLAT, sand, water_of(sand), 0.1, 0.5, MIDDLE)

    def test_dry_is_slope_over_friction(self):
        self.assertAlmostEqual(self.of(0.4, lambda sand: 0 * sand), 0.8, 6)

    def test_soaked_slides_from_half_the_friction(self):
        self.assertAlmostEqual(self.of(0.25, lambda sand: sand), 1, 6)

    def test_drowned_slides_from_the_friction(self):
        self.assertAlmostEqual(self.of(0.5, lambda sand: 6 - 0 * sand), 1, 6)

    def test_held_water_changes_nothing(self):
        self.assertAlmostEqual(self.of(0.4, lambda sand: 0.25 * sand), 0.8, 6)


class Cohesion(unittest.TestCase):
    def test_a_face_needs_what_its_law_says(self):
        needed = laws.face_cohesion(1.2, 2.0, 0.5)
        surface = shapes.draw(CELLS, lambda x, y: np.clip(2 * x, 0, 1.2), 0)
        self.assertAlmostEqual(gauges.needed_cohesion(surface, 0.1, 0.5) / needed, 1, delta=0.2)
        self.assertEqual(gauges.needed_cohesion(surface / 5, 0.1, 0.5), 0)

    def test_what_is_not_a_number_does_not_count(self):
        surface = FLAT.copy()
        surface[0], surface[1] = np.nan, 3
        self.assertGreater(gauges.needed_cohesion(surface, 0.1, 0.5), 0)
        surface[1] = 0
        self.assertEqual(gauges.needed_cohesion(surface, 0.1, 0.5), 0)


class Critical(unittest.TestCase):
    def test_finds_a_known_law(self):
        self.assertAlmostEqual(gauges.critical(lambda slope: slope > 0.317, 0.05, 0.85, 10), 0.317, 3)
        self.assertAlmostEqual(gauges.critical_share(lambda share: share >= 1.3), 1.3, 1)

    def test_says_so_where_nothing_changes(self):
        self.assertEqual(gauges.critical(lambda slope: True, 0.1, 0.9, 5), 0.1)
        self.assertEqual(gauges.critical(lambda slope: False, 0.1, 0.9, 5), 0.9)

    def test_area_that_went(self):
        before, after = FLAT[:4].copy(), FLAT[:4].copy()
        before[:, :10], after[:, 5:15] = 2, 1
        self.assertAlmostEqual(gauges.lost(before, after, 0.1), 0.1 * (5 * 2 + 5 * 1))


class Laws(unittest.TestCase):
    def test_sliding_slopes(self):
        for wet, slope in ((0, 0.5), (0.25, 0.5), (0.4925, 0.5), (0.6, 0.4557), (0.75, 0.3869), (1, 0.25)):
            self.assertAlmostEqual(laws.sliding_slope(0.5, wet), slope, 4)

    def test_slabs(self):
        self.assertEqual(laws.slab_cohesion(0.5, 1, 0.5), 0)
        angle = math.atan(1.2)
        weight = 2000 * 9.81 * 0.3
        self.assertAlmostEqual(laws.slab_cohesion(1.2, 0.3, 0.5), weight * (math.sin(angle) * math.cos(angle) - math.cos(angle) ** 2 * 0.5))

    def test_an_upright_face_is_rankines(self):
        for friction in (0.2, 0.8):
            self.assertAlmostEqual(laws.face_cohesion(2, math.inf, friction), 2000 * 9.81 * 2 / (4 * laws.passive(friction)))
            self.assertAlmostEqual(laws.face_wedge(2, math.inf, friction), 2 / laws.passive(friction))

    def test_a_face_of_the_friction_needs_none(self):
        self.assertEqual(laws.face_cohesion(2, 0.5, 0.5), 0)

    def test_culmanns_plane_is_the_worst(self):
        """Of all planes through the foot: cohesion along it and friction on it hold the wedge above."""
        slope, friction, height = 1.5, 0.4, 2.0
        beta, phi = math.atan(slope), math.atan(friction)
        worst = 0
        for plane in np.linspace(phi, beta, 2001)[1:-1]:
            weight = 2000 * 9.81 * height**2 / 2 * (1 / math.tan(plane) - 1 / math.tan(beta))
            worst = max(worst, weight * (math.sin(plane) - friction * math.cos(plane)) * math.sin(plane) / height)
        self.assertAlmostEqual(worst / laws.face_cohesion(height, slope, friction), 1, 4)


class Table(unittest.TestCase):
    def test_steep_shapes_are_steeper_than_their_friction(self):
        for friction in (0.35, 0.5, 0.7):
            for name, shape in beds.SHAPES.items():
                sand = 0.5 + shapes.draw(CELLS, shape(friction / beds.NORMAL))
                slope = gauges.steepest(FLAT, sand, 0.1, MIDDLE) / friction
                self.assertEqual(slope > resting.STEEP, name != "cone_0.48", f"{name} {slope}")

    def test_every_shape_and_bed_is_in_the_table(self):
        keys = resting.combinations()
        self.assertEqual({key[0] for key in keys}, set(beds.SHAPES))
        self.assertEqual({key[1] for key in keys}, set(beds.BEDS))
        self.assertLessEqual(resting.QUICK, set(keys))


if __name__ == "__main__":
    unittest.main()
