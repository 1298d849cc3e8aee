"""The package beside the program: RILIEVO=PROGRAM python -m unittest discover dist/python/tests"""

import pathlib
import sys
import tempfile
import unittest
import warnings

HERE = pathlib.Path(__file__).resolve()
sys.path.insert(0, str(HERE.parents[1]))
ROCKET = HERE.parents[3] / "sample_normals/rocket/flats.png"

import rilievo  # noqa: E402


class Drawing(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.program = rilievo.Program(force=True)
        self.addCleanup(self.program.close)
        warnings.simplefilter("ignore")

    def test_a_drawing_gets_a_shape_and_a_light_and_is_exported(self):
        drawing = self.program.open(ROCKET)
        light = drawing.shape()
        self.assertGreater(len(drawing.parts), 1)
        self.assertIn(light, [layer.path for layer in drawing.layers])
        pictures = []
        for mood in ["noon", "moon"]:
            drawing.mood(mood)
            drawing.export(self.folder / "lit.png")
            pictures.append((self.folder / "lit.png").read_bytes())
        self.assertEqual(pictures[0][:8], b"\x89PNG\r\n\x1a\n")
        self.assertNotEqual(pictures[0], pictures[1])

    def test_what_is_painted_is_saved_and_opened(self):
        page = self.program.new(64, 48, background="#ffffff")
        layer = page.add("strokes")
        page.brush(color="#204080", size=9)
        page.stroke([(10, 10, 0.5), (30, 24), (50, 40, 1)], layer=layer)
        kinds = [layer.kind for layer in page.layers]
        page.save(self.folder / "page.ora")
        again = self.program.open(self.folder / "page.ora")
        self.assertEqual(again.size, (64, 48))
        self.assertEqual([layer.kind for layer in again.layers], kinds)

    def test_a_refusal_is_raised_and_the_program_goes_on(self):
        with self.assertRaisesRegex(rilievo.RilievoError, "nothing.png"):
            self.program.open(self.folder / "nothing.png")
        with self.assertRaisesRegex(rilievo.RilievoError, "sculpture"):
            self.program.new(8, 8).add("sculpture")
        self.assertEqual(self.program.new(8, 6).size, (8, 6))

    def test_a_program_that_is_missing_is_said(self):
        with self.assertRaises(OSError):
            rilievo.Program(self.folder / "no program")


if __name__ == "__main__":
    unittest.main()
