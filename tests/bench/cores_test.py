"""The page of the cores benchmark."""

import unittest
import xml.etree.ElementTree as xml

from bench.cores.__main__ import page_of
from bench.harness.page import Chart


def job(name, *seconds):
    return {"job": name, "runs": [{"threads": threads, "wall_s": wall, "cpu_s": wall, "limit_s": seconds[0][1] / threads,
                                   "peak_bytes": 1e6 * threads} for threads, wall in seconds]}


class CoresPage(unittest.TestCase):
    def setUp(self):
        self.page = page_of({"machine": "a processor", "threads": [1, 2, 16],
                             "growing": [job("sheet, no file", (1, 8.0), (2, 4.0), (16, 1.0))],
                             "others": [job("scan", (1, 2.0), (16, 0.5))]})

    def test_efficiency_is_how_many_times_faster_by_the_number_of_threads(self):
        text = self.page.markdown()
        self.assertRegex(text, r"sheet, no file \| +8\.00 \| +4\.00 \| +1\.00 \| +8\.0 \| +50 % \| +0\.500 \| +2\.0 x \| +1 \| +16 \|")
        self.assertRegex(text, r"scan \| +2\.00 \| +0\.500 \| +4\.0 \| +25 % \|")

    def test_the_chart_has_a_line_for_the_limit(self):
        (chart,) = [block for block in self.page.blocks if isinstance(block, Chart)]
        lines = [line for line in xml.fromstring(chart.svg).iter("{http://www.w3.org/2000/svg}line") if line.get("stroke")]
        self.assertEqual(len(lines), 2)  # between three numbers of threads
        self.assertGreater(float(lines[0].get("y2")), float(lines[0].get("y1")))


if __name__ == "__main__":
    unittest.main()
