"""Tables, pages and charts."""

import tempfile
import unittest
import xml.etree.ElementTree as xml
from pathlib import Path

from bench.harness import chart
from bench.harness.page import Chart, Page, Table, brief


class Pages(unittest.TestCase):
    def test_columns_of_a_markdown_table_are_aligned(self):
        table = Table(["part", "s"])
        table.add("rook | white", 0.5)
        table.add("sheet", "> 60")
        page = Page("Title")
        page.show(table)
        lines = page.markdown().splitlines()[2:]
        self.assertEqual(len({len(line) for line in lines}), 1, lines)
        self.assertIn("rook \\| white", lines[2])
        self.assertTrue(lines[1].endswith("-:|"))

    def test_a_row_of_another_length_is_a_mistake(self):
        with self.assertRaises(ValueError):
            Table(["a", "b"]).add(1)

    def test_the_html_page_needs_nothing_else_and_escapes_text(self):
        page = Page("A < B")
        page.say("**bold** & `code <x>`")
        page.show(Chart("chart", "chart", chart.bars([chart.Bar("g", "s", 1.0)], "t", "s")))
        text = page.html()
        self.assertIn("<b>bold</b> &amp; <code>code &lt;x&gt;</code>", text)
        self.assertNotIn("src=", text)
        self.assertNotIn("href=", text)
        with tempfile.TemporaryDirectory() as folder:
            page.write(folder, "page")
            self.assertEqual({path.name for path in Path(folder).iterdir()}, {"page.md", "page.html", "chart.svg"})

    def test_numbers_have_three_digits_that_count(self):
        self.assertEqual([brief(value) for value in (0, 0.00012345, 0.5, 12.345, 1234.5, 98765)],
                         ["0", "0.000123", "0.500", "12.3", "1,234", "98,765"])


class Charts(unittest.TestCase):
    @staticmethod
    def widths(text):
        return [float(rect.get("width")) for rect in xml.fromstring(text).iter("{http://www.w3.org/2000/svg}rect")
                if rect.get("x") == "150"]

    def test_ten_times_as_long_is_one_decade_longer(self):
        text = chart.bars([chart.Bar("part", f"slicer {i}", 10.0**i) for i in range(4)], "Time", "s")
        widths = self.widths(text)
        steps = [b - a for a, b in zip(widths, widths[1:])]
        self.assertEqual(len(widths), 4)
        for step in steps:
            self.assertAlmostEqual(step, steps[-1], delta=2)

    def test_a_cell_without_a_value_keeps_its_row_and_says_why(self):
        text = chart.bars([chart.Bar("part", "a", 2.0), chart.Bar("part", "b", None, note="killed by SIGSEGV")], "Time", "s")
        self.assertEqual(len(self.widths(text)), 1)
        self.assertIn("killed by SIGSEGV", text)

    def test_a_run_that_was_stopped_is_an_outline(self):
        text = chart.bars([chart.Bar("part", "a", 2.0, hollow=True)], "Time", "s")
        self.assertEqual([rect.get("fill") for rect in xml.fromstring(text).iter("{http://www.w3.org/2000/svg}rect")
                          if rect.get("x") == "150"], ["none"])

    def test_a_scatter_chart_is_well_formed_and_names_the_power(self):
        text = chart.scatter([chart.Series("ECC <worst>", [(1, 1), (10, 100)], (1.0, 2.0))], "Growth", "k", "lists")
        xml.fromstring(text)
        self.assertIn("power 2.00", text)


if __name__ == "__main__":
    unittest.main()
