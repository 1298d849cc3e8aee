# SPDX-License-Identifier: MIT OR Apache-2.0
"""Renders a monkey with the add-on and reads it with the program: python test.py PROGRAM"""

import json
import os
import subprocess
import sys
import tempfile

import bpy
from mathutils import Vector

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import rilievo  # noqa: E402


def scene(folder):
    """A monkey, a sun and a camera that looks at it from the side."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    rilievo.register()
    made = bpy.context.scene
    bpy.ops.mesh.primitive_monkey_add()
    bpy.ops.object.shade_smooth()
    bpy.ops.object.light_add(type="SUN", rotation=(0.6, 0.3, 0))
    bpy.ops.object.camera_add(location=(2.2, -3.6, 1.4))
    camera = bpy.context.object
    camera.rotation_euler = (-Vector(camera.location)).to_track_quat("-Z", "Y").to_euler()
    made.camera = camera
    made.render.engine, made.cycles.device, made.cycles.samples = "CYCLES", "CPU", 1
    made.render.resolution_x, made.render.resolution_y = 120, 100
    made.rilievo.folder = folder
    return made


def run(program, *arguments):
    done = subprocess.run([program, *arguments], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout + done.stderr


def main(program):
    with tempfile.TemporaryDirectory() as folder:
        made = scene(folder)
        before = (made.render.filepath, made.render.image_settings.file_format)
        made.rilievo.views = 2
        assert bpy.ops.rilievo.paint(opens=False) == {"FINISHED"}
        assert before == (made.render.filepath, made.render.image_settings.file_format)
        names = sorted(os.listdir(folder))
        assert names == [f"Scene_{i:03}.{e}" for i in range(2) for e in ("exr", "json", "png")], names
        name = os.path.join(folder, "Scene_000")
        assert "on a surface" in run(program, "info", name + ".json")
        # The rotation to the camera that the recipe gives is the one that the maps show.
        with open(name + ".json", encoding="utf-8") as file:
            given = json.load(file)["surface"]["normal"]["convention"]["world_to_camera"]
        # The trace of a rotation is 1 + 2 cos(angle).
        cosine = (sum(given[i][i] for i in range(3)) - 1) / 2
        read = run(program, "info", name + ".exr")
        found = float(read.split("the rotation to the camera (")[1].split("°")[0])
        assert abs(rilievo.math.degrees(rilievo.math.acos(cosine)) - found) < 4, read
        run(program, "view", name + ".json", "--show", "normals", "-o", name + "_normals.png")
        rilievo.unregister()


if __name__ == "__main__":
    main(sys.argv[1])
