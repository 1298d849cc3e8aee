"""Drive Rilievo from Python: open, shape, paint, adjust, save and export.

The program runs in the background as ``rilievo replay -`` and performs one action after another;
docs/SCRIPTING.md lists them all. There is nothing to install but the program itself.

    import rilievo

    with rilievo.Program() as program:
        drawing = program.open("rocket.png")
        drawing.shape(flats=True)
        drawing.mood("noon")
        drawing.export("rocket_lit.png")
"""

from ._program import Program, RilievoError
from ._document import Document, Layer

__all__ = ["Document", "Layer", "Program", "RilievoError"]
