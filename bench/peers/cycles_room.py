"""Runs inside Blender: a room from a folder of arrays, rendered or baked by Cycles.

Usage: blender --background --factory-startup --python cycles_room.py -- FOLDER

FOLDER holds room.npz and jobs.json, both written by compare_with_cycles.py, which says what is in them. Every job
leaves FOLDER/NAME.exr (stills) or FOLDER/NAME.npy (vertex values), and jobs_done.json holds the seconds of all: those of
the call that renders or bakes, without starting Blender and without building its scene.
"""
import json
import pathlib
import sys
import time

import bpy
import mathutils
import numpy


def material(name, albedo, radiance, two_sided, albedo_of_vertices=False):
    """Lambertian reflection and emission of the front; a back that is black or like the front."""
    result = bpy.data.materials.new(name)
    result.use_nodes = True
    nodes, links = result.node_tree.nodes, result.node_tree.links
    nodes.clear()
    output = nodes.new("ShaderNodeOutputMaterial")
    diffuse = nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (*albedo, 1)
    if albedo_of_vertices:
        attribute = nodes.new("ShaderNodeAttribute")
        attribute.attribute_name = "albedo"
        links.new(attribute.outputs["Color"], diffuse.inputs["Color"])
    front = diffuse.outputs["BSDF"]
    strength = max(radiance)
    if strength > 0:
        emission = nodes.new("ShaderNodeEmission")
        emission.inputs["Color"].default_value = (*(v / strength for v in radiance), 1)
        emission.inputs["Strength"].default_value = strength
        add = nodes.new("ShaderNodeAddShader")
        links.new(front, add.inputs[0])
        links.new(emission.outputs["Emission"], add.inputs[1])
        front = add.outputs["Shader"]
    if not two_sided:
        black = nodes.new("ShaderNodeBsdfDiffuse")
        black.inputs["Color"].default_value = (0, 0, 0, 1)
        geometry = nodes.new("ShaderNodeNewGeometry")
        mix = nodes.new("ShaderNodeMixShader")
        links.new(geometry.outputs["Backfacing"], mix.inputs["Fac"])
        links.new(front, mix.inputs[1])
        links.new(black.outputs["BSDF"], mix.inputs[2])
        front = mix.outputs["Shader"]
    links.new(front, output.inputs["Surface"])
    return result


def add_mesh(name, vertices, triangles):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices.tolist(), [], triangles.tolist())
    mesh.update()
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def add_room(room):
    thing = add_mesh("room", room["vertices"], room["triangles"])
    for i, albedo in enumerate(room["albedo"]):
        thing.data.materials.append(
            material(f"material {i}", albedo.tolist(), room["radiance"][i].tolist(), bool(room["two_sided"][i])))
    thing.data.polygons.foreach_set("material_index", room["triangle_material"].astype(numpy.int32))
    return thing


def add_points(room):
    """The mesh whose vertices are baked, with an albedo at each."""
    thing = add_mesh("points", room["point_vertices"], room["point_triangles"])
    albedo = thing.data.color_attributes.new("albedo", "FLOAT_COLOR", "POINT")
    colours = numpy.ones((len(room["point_albedo"]), 4), numpy.float32)
    colours[:, :3] = room["point_albedo"]
    albedo.data.foreach_set("color", colours.ravel())
    thing.data.materials.append(material("points", (0, 0, 0), (0, 0, 0), True, albedo_of_vertices=True))
    thing.data.color_attributes.new("baked", "FLOAT_COLOR", "POINT")
    thing.data.color_attributes.active_color = thing.data.color_attributes["baked"]
    thing.data.color_attributes.render_color_index = thing.data.color_attributes.find("baked")
    return thing


def place_camera(job):
    scene = bpy.context.scene
    data = bpy.data.cameras.new("camera")
    data.sensor_fit = "VERTICAL"
    data.angle_y = numpy.radians(job["fov_deg"])
    data.clip_start, data.clip_end = 1e-4, 1e6
    camera = bpy.data.objects.new("camera", data)
    eye, look_at, up = (mathutils.Vector(job[k]) for k in ("eye", "look_at", "up"))
    backwards = (eye - look_at).normalized()
    right = up.cross(backwards).normalized()
    above = backwards.cross(right)
    camera.matrix_world = mathutils.Matrix.Translation(eye) @ mathutils.Matrix(
        (right, above, backwards)).transposed().to_4x4()
    scene.collection.objects.link(camera)
    scene.camera = camera


def set_up_cycles(threads):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.threads_mode, scene.render.threads = "FIXED", threads
    scene.world = bpy.data.worlds.new("dark")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0
    cycles = scene.cycles
    cycles.device = "CPU"
    # All light, as the other program has it: no end of the bounces, no clamping, no threshold.
    for bounces in ("max_bounces", "diffuse_bounces", "glossy_bounces", "transmission_bounces"):
        setattr(cycles, bounces, 1024)
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.light_sampling_threshold = 0
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False  # Debian's Blender has no denoiser
    cycles.pixel_filter_type = "BOX"
    cycles.filter_width = 1
    scene.view_settings.view_transform = "Raw"
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.use_persistent_data = False


def render(folder, job):
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = job["size"]
    scene.render.resolution_percentage = 100
    place_camera(job)
    scene.render.filepath = str(folder / job["name"])
    start = time.monotonic()
    bpy.ops.render.render(write_still=True)
    return time.monotonic() - start


def bake(folder, job, points):
    """Incoming light over pi at each vertex of the points."""
    bpy.context.view_layer.objects.active = points
    points.select_set(True)
    start = time.monotonic()
    bpy.ops.object.bake(type="DIFFUSE", pass_filter={"DIRECT", "INDIRECT"}, target="VERTEX_COLORS")
    seconds = time.monotonic() - start
    values = numpy.empty(4 * len(points.data.vertices), numpy.float32)
    points.data.color_attributes["baked"].data.foreach_get("color", values)
    numpy.save(folder / f"{job['name']}.npy", values.reshape(-1, 4)[:, :3])
    return seconds


def main():
    folder = pathlib.Path(sys.argv[sys.argv.index("--") + 1])
    room = numpy.load(folder / "room.npz")
    plan = json.loads((folder / "jobs.json").read_text())
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    set_up_cycles(plan["threads"])
    add_room(room)
    points = add_points(room) if "point_vertices" in room else None
    seconds = {}
    for job in plan["jobs"]:
        bpy.context.scene.cycles.samples = job["samples"]
        bpy.context.scene.cycles.seed = job["seed"]
        seconds[job["name"]] = render(folder, job) if job["kind"] == "still" else bake(folder, job, points)
    (folder / "jobs_done.json").write_text(json.dumps(seconds))


main()
