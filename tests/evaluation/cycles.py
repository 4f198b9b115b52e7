"""Compares a picture of framelet-bench reference with one of Cycles, the path tracer of Blender (Debian: `blender`).

Run by hand, of a glTF file. Both get a map of uniform light, a camera file, and sizes of lights:

    blender -b --python-exit-code 1 -P tests/evaluation/cycles.py -- --map uniform.hdr
    framelet-bench reference --scene X.glb --camera C.json --environment uniform.hdr --size 320x180 --paths 1024 \\
        --sun-size 0.53 --lamp-size 0.1 --output X.exr
    blender -b --python-exit-code 1 -P tests/evaluation/cycles.py -- --scene X.glb --camera C.json --picture X.exr \\
        --sun-size 0.53 --lamp-size 0.1

Choose what means the same in both. Blender knows neither ranges of lamps nor unlit surfaces that light others; spots
get its own edge, and clips stay as it reads them.
"""
import argparse
import json
import math
import sys

import numpy

numpy.bool = bool  # the importer of Blender 3.4 asks for it
import bpy  # noqa: E402
from mathutils import Vector  # noqa: E402

LUMENS_OF_WATT = 683  # by which the importer has divided; framelet takes candela and lux as radiometric units
BLOCK = 8  # pixels along the side of the squares that are compared: noise is below what materials differ


def blender_axes(point):
    return Vector((point[0], -point[2], point[1]))


def write_map(file, radiance):
    image = bpy.data.images.new("map", 16, 8, float_buffer=True)
    image.pixels = [radiance, radiance, radiance, 1.0] * (16 * 8)
    image.file_format = "HDR"
    image.filepath_raw = file
    image.save()


def pixels_of(image):
    """Radiance by row from below, pixel and colour."""
    width, height = image.size
    pixels = numpy.empty(width * height * 4, dtype=numpy.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(height, width, 4)[:, :, :3].astype(float)


def set_up(options, width, height):
    bpy.ops.import_scene.gltf(filepath=options.scene)
    for light in bpy.data.lights:
        light.energy *= LUMENS_OF_WATT
        if light.type == "SUN":
            light.angle = math.radians(options.sun_size)
        else:
            light.shadow_soft_size = options.lamp_size / 2
    world = bpy.data.worlds.new("world")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (*[options.radiance] * 3, 1)
    scene = bpy.context.scene
    scene.world = world
    with open(options.camera) as file:
        told = json.load(file)
    told = told.get("keys", [told])[0]
    camera = bpy.data.objects.new("view", bpy.data.cameras.new("view"))
    scene.collection.objects.link(camera)
    camera.location = blender_axes(told["position"])
    ahead = blender_axes(told["target"]) - camera.location
    camera.rotation_euler = ahead.to_track_quat("-Z", "Y").to_euler()
    camera.data.sensor_fit = "VERTICAL"
    camera.data.angle = math.radians(told["fov_degrees"])
    camera.data.clip_start, camera.data.clip_end = 1e-3, 1e5
    scene.camera = camera
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    render.filepath = options.output
    cycles.samples, cycles.use_adaptive_sampling, cycles.use_denoising = options.paths, False, False
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = 64
    cycles.transparent_max_bounces = 64
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    cycles.pixel_filter_type = "BOX"


def compare(ours, theirs):
    height, width = (side // BLOCK * BLOCK for side in ours.shape[:2])

    def blocks(picture):
        cut = picture[:height, :width].mean(axis=2)
        return cut.reshape(height // BLOCK, BLOCK, width // BLOCK, BLOCK).mean(axis=(1, 3))

    a, b = blocks(ours), blocks(theirs)
    seen = numpy.abs(b - options.radiance) > 0.01 * options.radiance  # the rest is background
    a, b = a[seen], b[seen]
    off = numpy.abs(a - b) / numpy.maximum(b, 0.01 * b.mean())
    print(json.dumps({"blocks": a.size, "framelet": a.mean(), "cycles": b.mean(),
                      "relative_error_of_mean": a.mean() / b.mean() - 1,
                      "median_error_of_blocks": float(numpy.median(off)), "mean_error_of_blocks": off.mean()}))


parser = argparse.ArgumentParser(prog="cycles.py")
parser.add_argument("--map", help="write a map of uniform light, and nothing else")
parser.add_argument("--radiance", type=float, default=0.05, help="of that light")
parser.add_argument("--scene", help="glTF file")
parser.add_argument("--camera", help="camera file: position, target, fov_degrees")
parser.add_argument("--picture", help="EXR of framelet-bench reference")
parser.add_argument("--paths", type=int, default=1024)
parser.add_argument("--sun-size", type=float, default=0)
parser.add_argument("--lamp-size", type=float, default=0)
parser.add_argument("--output", default="cycles.exr")
options = parser.parse_args(sys.argv[sys.argv.index("--") + 1:])
bpy.ops.wm.read_factory_settings(use_empty=True)
if options.map:
    write_map(options.map, options.radiance)
else:
    ours = pixels_of(bpy.data.images.load(options.picture))
    set_up(options, ours.shape[1], ours.shape[0])
    bpy.ops.render.render(write_still=True)
    compare(ours, pixels_of(bpy.data.images.load(options.output)))
