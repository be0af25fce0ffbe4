"""How studies are judged: bars whatever the scheme, ranges by the scheme of the case, orders of the accurate scheme."""

import contextlib
import io
import unittest

from study import Study, scheme_in
from validate import print_level

usual_bars = {"drag": 0.1}
no_orders: dict[str, float] = {}
usual_ranges = {"published": {"rate": (0.8, 0.9)}, "accurate": {"rate": (0.98, 1.02)}}


def measure(run):
    raise AssertionError("rows are given")


def judged(error, value, scheme, bars=usual_bars, ranges=usual_ranges):
    """Whether a level with this error and this value is good, and what is printed."""
    study = Study("sphere", "Sphere", [], bars, measure, "", "", ranges=ranges)
    row = {"level": "x1", "scheme": scheme, "size": 1, "particles": 1, "steps": 1, "iterations": 1, "seconds": 1, "backend": "cpu",
           "errors": {"drag": error}, "values": {"rate": value}}
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        good = print_level(study, row, None, 0)
    return good, printed.getvalue()


def second(coarse, fine, scheme="accurate", orders=no_orders, number=1, bars=usual_bars):
    """Likewise of a level with half the spacing of the one before and this error after that one."""
    study = Study("sphere", "Sphere", [], bars, measure, "", "", orders=orders)
    row = {"level": "x2", "scheme": scheme, "size": 1, "particles": 1, "steps": 1, "iterations": 1, "seconds": 1, "backend": "cpu",
           "errors": {"drag": fine}, "values": {}}
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        good = print_level(study, row, row | {"size": 2, "errors": {"drag": coarse}}, number)
    return good, printed.getvalue()


class Judgement(unittest.TestCase):
    def test_ranges_are_those_of_the_scheme(self):
        self.assertTrue(judged(0.05, 0.85, "published")[0])
        self.assertFalse(judged(0.05, 1.0, "published")[0])
        self.assertTrue(judged(0.05, 1.0, "accurate")[0])
        good, printed = judged(0.05, 0.85, "accurate")
        self.assertFalse(good)
        self.assertIn("scheme accurate", printed)
        self.assertIn("rate: 0.85, range 0.98 to 1.02 of accurate: NOT MET", printed)

    def test_bars_hold_for_every_scheme(self):
        for scheme, value in ("published", 0.85), ("accurate", 1.0):
            self.assertTrue(judged(0.1, value, scheme)[0])
            self.assertFalse(judged(0.11, value, scheme)[0])
            self.assertFalse(judged(float("nan"), value, scheme)[0])

    def test_a_scheme_without_ranges_is_judged_only_where_the_study_says_so(self):
        self.assertFalse(judged(0.05, 0.85, "other")[0])
        self.assertTrue(judged(0.05, 0.85, "other", ranges={"published": {"rate": (0, 1)}, "other": {}})[0])
        self.assertTrue(judged(0.05, 0.85, "other", ranges={})[0])

    def test_the_published_scheme_may_have_other_bars(self):
        study = Study("sphere", "Sphere", [], {"drag": 0.1, "lift": 0.2}, measure, "", "", published={"drag": 0.3})
        self.assertEqual(study.bars_of("published"), {"drag": 0.3, "lift": 0.2})
        self.assertEqual(study.bars_of("accurate"), {"drag": 0.1, "lift": 0.2})

    def test_the_second_level_is_judged_by_its_order_until_the_error_is_small(self):
        good, printed = second(0.08, 0.04)
        self.assertTrue(good)
        self.assertIn("order 1.00, at least 0.9 down to 0.01: met", printed)
        good, printed = second(0.08, 0.05)
        self.assertFalse(good)
        self.assertIn("order 0.68, at least 0.9 down to 0.01: NOT MET", printed)
        self.assertTrue(second(0.009, 0.0099)[0])
        self.assertFalse(second(0.009, 0.011)[0])
        self.assertFalse(second(0.08, float("nan"))[0])
        self.assertTrue(second(0.05, 0.2, number=2)[0])
        self.assertTrue(second(1e-6, 1e-4, bars={"drag": 1e-3})[0])
        good, printed = second(1e-6, 1e-2 / 3, bars={"drag": 1e-3})  # small, but more than the bar
        self.assertFalse(good)
        self.assertIn("bar 0.001: NOT MET", printed)

    def test_a_study_may_ask_for_another_order_and_the_published_scheme_for_none(self):
        self.assertTrue(second(0.08, 0.05, orders={"drag": 0.6})[0])
        self.assertFalse(second(0.08, 0.07, orders={"drag": 0.6})[0])
        for scheme in "published", "isph":
            self.assertTrue(second(0.08, 0.09, scheme)[0])

    def test_what_was_not_measured_is_not_met(self):
        self.assertFalse(judged(0.05, 0.85, "published", bars={"lift": 0.1})[0])
        self.assertFalse(judged(0.05, 0.85, "published", ranges={"published": {"speed": (0, 1)}})[0])

    def test_the_scheme_stands_under_method(self):
        self.assertEqual(scheme_in('title = "x"\n\n[method]\nname = "mph-i"\nscheme = "published"\n\n[solver]\n'), "published")
        self.assertEqual(scheme_in('title = "x"\n\n[method]\nname = "mph-i"\n\n[solver]\nscheme = "published"\n'), "accurate")
        self.assertEqual(scheme_in('title = "x"\n'), "accurate")
        self.assertEqual(scheme_in('title = "x"\n\n[method]\nname = "isph"\nkernel = "wendland-c2"\n'), "isph")


if __name__ == "__main__":
    unittest.main()
