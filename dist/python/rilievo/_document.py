"""The document in front, and its layers."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Layer:
    """One layer as it was when it was asked for.

    ``path`` says where it is: ``"0"`` is the bottom layer, ``"2.0"`` the bottom layer of the group
    that is third from the bottom. It changes when layers beneath come and go.
    """

    path: str
    name: str
    kind: str
    visible: bool


class Document:
    """The document that was opened last. Every method is one or a few actions of the program."""

    def __init__(self, program):
        self._program = program

    def do(self, room, action, **fields):
        """Perform any action; see docs/SCRIPTING.md."""
        return self._program.do(room, action, **fields)

    # What it holds.

    @property
    def size(self):
        """Width and height in pixels."""
        described = self._described()
        return described["width"], described["height"]

    @property
    def layers(self):
        """All layers, the bottom one first."""
        return [
            Layer(layer["layer"], layer["name"], layer["kind"], layer["visible"])
            for layer in self._described()["layers"]
        ]

    @property
    def parts(self):
        """The ids of the parts of the shape, with their names."""
        return {part["part"]: part["name"] for part in self._described()["parts"]}

    def _described(self):
        return self.do("query", "document")["document"]

    # Shape and light.

    def shape(self, layer="0", preset="pillow", flats=True):
        """Give a flat drawing a shape, a part for each flat color, and a light above it.

        ``flats`` may be ``False`` (one part) or ``"areas"`` (a part for each separate area).
        Returns the path of the layer of light.
        """
        return self.do("part", "shape", layer=layer, preset=preset, flats=flats)["layer"]

    def mood(self, mood, layer=None):
        """Set the light: noon, window, sunset, rim, studio or moon."""
        layer = layer or self._of_kind("shading")
        self.set(layer, "mood", mood=mood)

    # Layers.

    def add(self, kind):
        """Add a layer (paint, strokes, fill, gradient, normals, group …); returns its path."""
        return self.do("layer", "add", kind=kind)["layer"]

    def add_shading(self, model):
        """Add a layer of light (painter, phong, toon, mirror …); returns its path."""
        return self.do("layer", "add shading", model=model)["layer"]

    def adjust(self, kind, **settings):
        """Add an adjustment layer (curves, levels, exposure …); returns its path."""
        adjustment = {"kind": kind, **settings}
        return self.do("layer", "add adjustment", adjustment=adjustment)["layer"]

    def filter(self, kind, **settings):
        """Add a filter layer (gaussian-blur, unsharp-mask, grain …); returns its path."""
        return self.do("layer", "add filter", filter={"kind": kind, **settings})["layer"]

    def place(self, file, at):
        """Place a picture as an image layer, pinned at a point; returns its path."""
        return self.do("file", "place", file=file, at=list(at))["layer"]

    def set(self, layer, property, **values):
        """Change a property of a layer: ``set("1", "opacity", to=0.5)``."""
        self.do("layer", "set", layer=layer, to={"do": property, **values}, done=True)

    # Paint.

    def brush(self, preset=None, color=None, size=None, operator=None):
        """Take a brush, a color, a size in pixels, or a way of bending (as in a recipe)."""
        if preset is not None:
            self.do("hand", "preset", name=preset)
        if color is not None:
            self.do("hand", "color", color=color)
        if size is not None:
            self.do("hand", "size", to=size)
        if operator is not None:
            self.do("hand", "operator", operator=operator)

    def stroke(self, pens, layer=None, tool="brush"):
        """Paint a stroke through ``[x, y, pressure]`` points."""
        pens = [list(pen) for pen in pens]
        if not pens:
            return
        if layer is not None:
            self.do("layer", "select", layer=layer)
        self.do("pointer", "press", tool=tool, pen=pens[0], px_per_pt=1)
        if pens[1:]:
            self.do("pointer", "drag", pens=pens[1:])
        self.do("pointer", "release")

    def undo(self):
        """Take the last step back."""
        self.do("edit", "undo")

    def redo(self):
        """Do again what was taken back."""
        self.do("edit", "redo")

    # Files.

    def save(self, file):
        """Save as a project (.ora) or a Photoshop file (.psd)."""
        self.do("file", "save", file=file)

    def export(self, file, background=None, quality=90, bits=None):
        """Write the picture; the name's extension sets the format."""
        self.do("file", "export", file=file, background=background, quality=quality, bits=bits)

    def export_maps(self, file, maps=("_n", "_d", "_mask"), directx=False, bits=16):
        """Write the maps of the shape, named after ``file``."""
        self.do("file", "export maps", file=file, maps=list(maps), directx=directx, bits=bits)

    def _of_kind(self, kind):
        found = [layer.path for layer in self.layers if layer.kind == kind]
        if not found:
            raise ValueError(f"the document has no {kind} layer")
        return found[-1]
