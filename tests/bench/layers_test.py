"""How two slicers' layers are compared."""

import unittest

from bench.harness.layers import Layer, agreement


def stack(count, contours=2, area=10.0):
    return [Layer(0.05 + 0.1 * i, contours, area, 20.0) for i in range(count)]


class Agreement(unittest.TestCase):
    def test_the_same_layers_are_equal(self):
        found = agreement(stack(5), stack(5))
        self.assertTrue(found.exact)
        self.assertEqual(found.text(), "equal")

    def test_a_slicer_that_reports_lengths_only_is_compared_by_these(self):
        found = agreement([Layer(layer.z, 2, perimeter_mm=20.0) for layer in stack(5)], stack(5))
        self.assertTrue(found.exact)
        self.assertIsNone(found.area_off)

    def test_one_layer_more_at_the_top_is_near_but_not_equal(self):
        found = agreement(stack(532), stack(531))
        self.assertFalse(found.exact)
        self.assertTrue(found.near)
        self.assertIn("one layer more or less", found.text())

    def test_a_stack_that_stands_one_layer_lower_is_reported(self):
        uneven = [Layer(0.05 + 0.1 * i, 2, 10.0 + 5 * (i % 3), 20.0) for i in range(200)]
        sunk = [Layer(layer.z - 0.1, 2, layer.area_mm2) for layer in uneven[1:]]
        self.assertFalse(agreement(sunk, uneven).near)
        found = agreement(sunk, uneven, layer_height=0.1)
        self.assertEqual(found.lowered, 1)
        self.assertTrue(found.near)
        self.assertFalse(found.exact)
        self.assertIn("one layer lower", found.text())

    def test_a_lost_contour_in_a_small_stack_does_not_count(self):
        other = stack(5)
        other[2].contours = 1
        self.assertFalse(agreement(other, stack(5)).near)

    def test_areas_off_by_two_percent_do_not_count(self):
        self.assertFalse(agreement(stack(5, area=10.2), stack(5)).near)

    def test_errors_of_opposite_sign_do_not_cancel(self):
        other = stack(2)
        other[0].area_mm2, other[1].area_mm2 = 5.0, 15.0
        self.assertAlmostEqual(agreement(other, stack(2)).area_off, 0.5)

    def test_layers_at_other_heights_are_no_partners(self):
        shifted = [Layer(layer.z + 0.05, 2, 10.0, 20.0) for layer in stack(5)]
        self.assertFalse(agreement(shifted, stack(5)).near)

    def test_nothing_is_not_the_same_as_something(self):
        self.assertFalse(agreement([], stack(5)).near)
        self.assertFalse(agreement([], []).near)


if __name__ == "__main__":
    unittest.main()
