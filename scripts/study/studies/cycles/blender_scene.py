"""Runs inside Blender: renders with Cycles what export_scene wrote.

    blender -b --factory-startup -P blender_scene.py -- FOLDER OUTPUT.exr SAMPLES SEED [STEP_RATE]

Prints `cycles seconds S`, the time of the rendering alone. Conventions: one Blender unit is 100 m; a sun's strength is
the irradiance on a plane that faces it, its light falls along the lamp's -Z; a world's colour times strength is radiance;
scattering and absorption of the same colour and density make albedo and extinction exact.
"""

import json
import math
import pathlib
import sys
import time

import bpy
from mathutils import Matrix, Vector


def clear():
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing, do_unlink=True)


def add_camera(scene, about):
    data = bpy.data.cameras.new("camera")
    data.sensor_fit = "VERTICAL"
    data.angle = math.radians(about["vertical_fov_degrees"])
    data.clip_start, data.clip_end = 1e-3, 1e5
    camera = bpy.data.objects.new("camera", data)
    # a camera looks along its -Z
    right, up, back = Vector(about["right"]), Vector(about["up"]), -Vector(about["forward"])
    matrix = Matrix((right, up, back)).transposed().to_4x4()
    matrix.translation = Vector(about["position"])
    camera.matrix_world = matrix
    scene.collection.objects.link(camera)
    scene.camera = camera


def strength_and_colour(rgb):
    strength = max(rgb)
    return strength, [value / strength if strength > 0.0 else 0.0 for value in rgb]


def add_sun(scene, about):
    strength, colour = strength_and_colour(about["sun_irradiance"])
    if strength == 0.0:
        return
    data = bpy.data.lights.new("sun", "SUN")
    data.energy, data.color = strength, colour
    data.angle = math.radians(about["sun_angular_diameter_degrees"])
    data.cycles.max_bounces = 1024
    sun = bpy.data.objects.new("sun", data)
    sun.matrix_world = Vector(about["sun_direction_to"]).to_track_quat("Z", "Y").to_matrix().to_4x4()
    scene.collection.objects.link(sun)


def add_sky(scene, about):
    strength, colour = strength_and_colour(about["sky_radiance"])
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (*colour, 1.0)
    background.inputs["Strength"].default_value = strength
    scene.world = world


def cloud_material(about):
    material = bpy.data.materials.new("cloud")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    grid = nodes.new("ShaderNodeAttribute")
    grid.attribute_name = "density"
    extinction = nodes.new("ShaderNodeMath")
    extinction.operation = "MULTIPLY"
    extinction.inputs[1].default_value = about["extinction_per_unit"]
    links.new(grid.outputs["Fac"], extinction.inputs[0])
    both = nodes.new("ShaderNodeAddShader")
    for slot, kind in enumerate(("ShaderNodeVolumeScatter", "ShaderNodeVolumeAbsorption")):
        node = nodes.new(kind)
        node.inputs["Color"].default_value = (*about["albedo"], 1.0)
        links.new(extinction.outputs[0], node.inputs["Density"])
        if kind == "ShaderNodeVolumeScatter":
            node.inputs["Anisotropy"].default_value = about["g"]
        links.new(node.outputs[0], both.inputs[slot])
    output = nodes.new("ShaderNodeOutputMaterial")
    links.new(both.outputs[0], output.inputs["Volume"])
    return material


def add_cloud(scene, folder, about):
    data = bpy.data.volumes.new("cloud")
    data.filepath = str((folder / "cloud.vdb").resolve())
    data.materials.append(cloud_material(about))
    scene.collection.objects.link(bpy.data.objects.new("cloud", data))


def set_up_cycles(scene, about, samples, seed, step_rate):
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = about["width"], about["height"]
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.image_settings.exr_codec = "ZIP"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples, cycles.seed = samples, seed
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
    cycles.max_bounces = cycles.volume_bounces = cycles.transparent_max_bounces = 1024
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.light_sampling_threshold = 0.0
    # rays march: steps of a quarter of a voxel are within .3 % of the truth, and their number must not lengthen them
    cycles.volume_step_rate, cycles.volume_max_steps = step_rate, 65536


def main():
    words = sys.argv[sys.argv.index("--") + 1:]
    folder, output, samples, seed = pathlib.Path(words[0]), words[1], int(words[2]), int(words[3])
    step_rate = float(words[4]) if len(words) > 4 else 1.0
    about = json.loads((folder / "scene.json").read_text())
    scene = bpy.context.scene
    clear()
    add_camera(scene, about)
    add_sun(scene, about)
    add_sky(scene, about)
    add_cloud(scene, folder, about)
    set_up_cycles(scene, about, samples, seed, step_rate)
    scene.render.filepath = str(pathlib.Path(output).resolve())
    start = time.monotonic()
    bpy.ops.render.render(write_still=True)
    print(f"cycles seconds {time.monotonic() - start:.6f}", flush=True)


main()
