# SPDX-License-Identifier: MIT OR Apache-2.0
"""Paint in Rilievo: renders the shape that the camera sees and opens it to be painted on.

Install with Edit > Preferences > Add-ons > Install from Disk. The command is in the Render menu, and its
settings in the output properties.
"""

import json
import math
import os
import shutil
import subprocess

import bpy
from mathutils import Matrix, Vector

bl_info = {
    "name": "Paint in Rilievo",
    "author": "The founders of Rilievo",
    "version": (0, 1, 0),
    "blender": (4, 2, 0),
    "location": "Render > Paint in Rilievo",
    "description": "Paint over the shape that the camera sees",
    "category": "Render",
}


class RilievoSettings(bpy.types.PropertyGroup):
    """Where pictures go, and how many views are rendered."""

    folder: bpy.props.StringProperty(
        name="Folder",
        description="Where the maps and the recipe are written",
        subtype="DIR_PATH",
        default="//rilievo/",
    )
    views: bpy.props.IntProperty(
        name="Views",
        description="How many pictures are rendered around the vertical axis: 1 is the camera's own",
        min=1,
        max=360,
        default=1,
    )
    with_picture: bpy.props.BoolProperty(
        name="Render beneath",
        description="Put the rendered picture beneath as a layer",
        default=True,
    )


class RilievoPreferences(bpy.types.AddonPreferences):
    bl_idname = __name__

    program: bpy.props.StringProperty(
        name="Program",
        description="The program Rilievo, if it is not among the installed programs",
        subtype="FILE_PATH",
    )

    def draw(self, _context):
        self.layout.prop(self, "program")


def program(context):
    """The program's path, or None."""
    addon = context.preferences.addons.get(__name__)
    named = addon.preferences.program if addon and addon.preferences else ""
    return bpy.path.abspath(named) if named else os.environ.get("RILIEVO") or shutil.which("rilievo")


class Kept:
    """Settings of the scene that are changed for the passes, and put back."""

    def __init__(self):
        self._before = []

    def set(self, owner, name, value):
        self._before.append((owner, name, getattr(owner, name)))
        setattr(owner, name, value)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for owner, name, value in reversed(self._before):
            setattr(owner, name, value)


def render_passes(scene, layer, name):
    """Render one view to NAME.exr, with all passes, and NAME.png; settings are put back."""
    image = scene.render.image_settings
    with Kept() as kept:
        for one in ("use_pass_z", "use_pass_normal", "use_pass_cryptomatte_object"):
            kept.set(layer, one, True)
        kept.set(scene.render, "filepath", name + ".exr")
        kept.set(scene.render, "use_file_extension", False)
        kept.set(scene.render, "film_transparent", True)
        # The kind of media decides which formats there are; Blender 4 has no such setting.
        if hasattr(image, "media_type"):
            kept.set(image, "media_type", "MULTI_LAYER_IMAGE")
        kept.set(image, "file_format", "OPEN_EXR_MULTILAYER")
        kept.set(image, "color_depth", "32")
        bpy.ops.render.render(write_still=True, scene=scene.name)
    result = bpy.data.images.get("Render Result")
    if result is None or not os.path.exists(name + ".exr"):
        raise RuntimeError("nothing was rendered")
    with Kept() as kept:
        if hasattr(image, "media_type"):
            kept.set(image, "media_type", "IMAGE")
        kept.set(image, "file_format", "PNG")
        kept.set(image, "color_mode", "RGBA")
        result.save_render(name + ".png", scene=scene)


def world_to_camera(camera):
    """The rows of the rotation from the world to the camera: x right, y up, z to the eye."""
    turn = camera.matrix_world.to_3x3().normalized().transposed()
    return [list(row) for row in turn]


def field_of_view(scene, camera):
    """Degrees across the picture, or None without perspective."""
    if camera.data.type != "PERSP":
        return None
    frame = camera.data.view_frame(scene=scene)
    return math.degrees(2 * math.atan(max(abs(v.x / v.z) for v in frame)))


def recipe(scene, camera, layer, name, with_picture):
    """The document: its maps, and the picture beneath as a layer."""
    exr = os.path.basename(name) + ".exr"
    depth = {"file": exr, "channel": layer.name + ".Depth", "encoding": "planar", "near": "low"}
    fov = field_of_view(scene, camera)
    if fov is not None:
        depth["fov"] = fov
    convention = {"space": "world", "world_to_camera": world_to_camera(camera)}
    normal = {"file": exr, "channel": layer.name + ".Normal", "convention": convention}
    layers = []
    if with_picture:
        picture = os.path.basename(name) + ".png"
        layers.append({"kind": "pixels", "name": "Render", "file": picture})
    document = {"format": "rilievo", "surface": {"normal": normal, "depth": depth}, "layers": layers}
    with open(name + ".json", "w", encoding="utf-8") as file:
        json.dump(document, file, indent=2)


def turned(camera, target, share):
    """Where the camera is after a share of a whole turn around the vertical axis through a point."""
    move = Matrix.Translation(target)
    turn = Matrix.Rotation(share * 2 * math.pi, 4, "Z")
    return move @ turn @ move.inverted() @ camera


def middle(context):
    """The middle of what is rendered."""
    corners = [
        obj.matrix_world @ Vector(corner)
        for obj in context.scene.objects
        if obj.type == "MESH" and not obj.hide_render
        for corner in obj.bound_box
    ]
    if not corners:
        return Vector()
    low = Vector(min(c[i] for c in corners) for i in range(3))
    high = Vector(max(c[i] for c in corners) for i in range(3))
    return (low + high) / 2


def write_views(context):
    """Render all views; returns the names of the recipes."""
    scene, layer = context.scene, context.view_layer
    camera, settings = scene.camera, context.scene.rilievo
    if camera is None:
        raise RuntimeError("the scene has no camera")
    folder = bpy.path.abspath(settings.folder)
    if settings.folder.startswith("//") and not bpy.data.filepath:
        folder = os.path.join(bpy.app.tempdir, "rilievo")
    os.makedirs(folder, exist_ok=True)
    stem = bpy.path.clean_name(scene.name)
    start, target, written = camera.matrix_world.copy(), middle(context), []
    try:
        for view in range(settings.views):
            if settings.views > 1:
                camera.matrix_world = turned(start, target, view / settings.views)
                context.view_layer.update()
            number = f"_{view:03}" if settings.views > 1 else ""
            name = os.path.join(folder, stem + number)
            render_passes(scene, layer, name)
            recipe(scene, camera, layer, name, settings.with_picture)
            written.append(name + ".json")
    finally:
        camera.matrix_world = start
    return written


class RILIEVO_OT_paint(bpy.types.Operator):
    """Render the normals and the depth that the camera sees, and paint on them in Rilievo"""

    bl_idname = "rilievo.paint"
    bl_label = "Paint in Rilievo"

    opens: bpy.props.BoolProperty(name="Open Rilievo", default=True)

    def execute(self, context):
        path = program(context)
        if self.opens and path is None:
            self.report({"ERROR"}, "Rilievo is not installed; name it in the add-on's preferences")
            return {"CANCELLED"}
        try:
            written = write_views(context)
        except (OSError, RuntimeError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        if self.opens:
            subprocess.Popen([path, "open", *written])
        self.report({"INFO"}, f"Written: {', '.join(written)}")
        return {"FINISHED"}


class RILIEVO_PT_output(bpy.types.Panel):
    bl_label = "Rilievo"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "output"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        settings = context.scene.rilievo
        self.layout.use_property_split = True
        for name in ("folder", "views", "with_picture"):
            self.layout.prop(settings, name)
        self.layout.operator(RILIEVO_OT_paint.bl_idname)


def menu(self, _context):
    self.layout.operator(RILIEVO_OT_paint.bl_idname)


CLASSES = (RilievoSettings, RilievoPreferences, RILIEVO_OT_paint, RILIEVO_PT_output)


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Scene.rilievo = bpy.props.PointerProperty(type=RilievoSettings)
    if not bpy.app.background:
        bpy.types.TOPBAR_MT_render.append(menu)


def unregister():
    if not bpy.app.background:
        bpy.types.TOPBAR_MT_render.remove(menu)
    del bpy.types.Scene.rilievo
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)


if __name__ == "__main__":
    register()
