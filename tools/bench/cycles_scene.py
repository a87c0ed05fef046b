# cycles_scene.py -- builds a scene in Blender and renders it with Cycles at growing numbers of samples.
#
# Started by tools/bench/cycles: blender -b --factory-startup --debug-cycles -P cycles_scene.py -- JOB.json
# Blender takes the coordinates of the glTF file as they are: both cameras look along -Z with +Y up, both lights shine
# along -Z, and no axis is exchanged.
import json
import math
import os
import re
import struct
import sys
import time

import bpy
from mathutils import Matrix, Quaternion, Vector

NO_LIMIT = 1024  # bounces: the most that Cycles takes


class Unsupported(Exception):
    """What the scene holds is not built here: nothing is rendered."""


# ---- glTF -------------------------------------------------------------------------------------

def local_matrix(node):
    if "matrix" in node:
        m = node["matrix"]
        return Matrix([m[i::4] for i in range(4)])
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    return (Matrix.Translation(node.get("translation", (0, 0, 0))) @ Quaternion((w, x, y, z)).to_matrix().to_4x4()
            @ Matrix.Diagonal((*node.get("scale", (1, 1, 1)), 1)))


def walk(gltf, indices, above):
    """Every node below those of `indices` with its matrix to the world."""
    for index in indices:
        node = gltf["nodes"][index]
        matrix = above @ local_matrix(node)
        yield node, matrix
        yield from walk(gltf, node.get("children", []), matrix)


def unscaled(matrix):
    """Cameras and lights ignore the scale of their nodes."""
    columns = [matrix.col[i].to_3d().normalized() for i in range(3)]
    m = Matrix(columns).transposed().to_4x4()
    m.translation = matrix.translation
    return m


def rgb(value):
    return tuple(value) if isinstance(value, list) else (value,) * 3


def accessor(gltf, folder, index):
    """The rows of an accessor of floats or of unsigned numbers."""
    a = gltf["accessors"][index]
    view = gltf["bufferViews"][a["bufferView"]]
    with open(os.path.join(folder, gltf["buffers"][view["buffer"]]["uri"]), "rb") as file:
        data = file.read()
    kind = {5121: "B", 5123: "H", 5125: "I", 5126: "f"}[a["componentType"]]
    row = struct.Struct("<" + kind * {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[a["type"]])
    start = view.get("byteOffset", 0) + a.get("byteOffset", 0)
    stride = view.get("byteStride", row.size)
    return [row.unpack_from(data, start + i * stride) for i in range(a["count"])]


# ---- nodes of materials -----------------------------------------------------------------------

def empty_nodes(owner, output):
    owner.use_nodes = True
    tree = owner.node_tree
    tree.nodes.clear()
    return tree, tree.nodes.new(output)


def scaled(tree, density, factor):
    """A socket with `factor` times the density of the grid."""
    node = tree.nodes.new("ShaderNodeMath")
    node.operation = "MULTIPLY"
    tree.links.new(density, node.inputs[0])
    node.inputs[1].default_value = factor
    return node.outputs[0]


def volume_material(medium, density_grid):
    """Scattering: density x colour. Absorption: density x (1 - colour)."""
    material = bpy.data.materials.new("medium")
    tree, output = empty_nodes(material, "ShaderNodeOutputMaterial")
    material.cycles.homogeneous_volume = not density_grid
    density = None
    if density_grid:
        attribute = tree.nodes.new("ShaderNodeAttribute")
        attribute.attribute_name = "density"
        density = attribute.outputs["Fac"]
    parts = []
    for kind, sigma in (("Scatter", medium["sigma_s"]), ("Absorption", medium["sigma_a"])):
        if max(sigma) > 0:
            node = tree.nodes.new("ShaderNodeVolume" + kind)
            share = [s / max(sigma) for s in sigma]
            node.inputs["Color"].default_value = (*(share if kind == "Scatter" else [1 - s for s in share]), 1)
            node.inputs["Density"].default_value = max(sigma)
            if density:
                tree.links.new(scaled(tree, density, max(sigma)), node.inputs["Density"])
            if kind == "Scatter":
                node.inputs["Anisotropy"].default_value = medium["g"]
            parts.append(node.outputs[0])
    if len(parts) == 2:
        both = tree.nodes.new("ShaderNodeAddShader")
        tree.links.new(parts[0], both.inputs[0])
        tree.links.new(parts[1], both.inputs[1])
        parts = [both.outputs[0]]
    for part in parts:
        tree.links.new(part, output.inputs["Volume"])
    return material


def diffuse_material(gltf, index):
    source = gltf["materials"][index]
    pbr = source.get("pbrMetallicRoughness", {})
    if max(source.get("emissiveFactor", [0])) > 0 or "baseColorTexture" in pbr:
        raise Unsupported("materials that emit or have textures")
    albedo = [c * (1 - pbr.get("metallicFactor", 1)) for c in pbr.get("baseColorFactor", (1, 1, 1, 1))[:3]]
    material = bpy.data.materials.new("surface")
    tree, output = empty_nodes(material, "ShaderNodeOutputMaterial")
    node = tree.nodes.new("ShaderNodeBsdfDiffuse")
    node.inputs["Color"].default_value = (*albedo, 1)
    node.inputs["Roughness"].default_value = 0
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return material


# ---- objects ----------------------------------------------------------------------------------

def add_object(data, matrix):
    thing = bpy.data.objects.new(data.name, data)
    bpy.context.scene.collection.objects.link(thing)
    thing.matrix_world = matrix
    return thing


def add_mesh(name, corners, faces, matrix, material):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], faces)
    mesh.materials.append(material)
    add_object(mesh, matrix)


def add_medium(job, gltf, filling, matrix, inside_walls):
    source = gltf["extensions"]["TYN_participating_media"]["media"][filling["medium"]]
    if filling.get("shape") != "box" or "repeat" in filling or max(rgb(source.get("emission", 0))) > 0:
        raise Unsupported("media other than boxes that do not emit")
    g = job["scene"].get("g", source.get("anisotropy", 0))
    if len(set(rgb(g))) != 1:
        raise Unsupported("a mean cosine that differs between colours")
    medium = {"sigma_s": rgb(source.get("scattering", 0)), "sigma_a": rgb(source.get("absorption", 0)), "g": rgb(g)[0]}
    if "density" in source:
        medium = {**medium, **{k: tuple(s * source["density"].get("scale", 1) for s in medium[k]) for k in ("sigma_s", "sigma_a")}}
        volume = bpy.data.volumes.new("medium")
        volume.filepath = job["grid"]
        volume.render.space = "WORLD"  # coefficients are per metre of the world
        volume.render.step_size = 0  # the edge of a voxel, times the step rate
        volume.render.clipping = 0
        volume.render.precision = "FULL"
        volume.materials.append(volume_material(medium, True))
        # The value of voxel i stands at its corner i by OpenVDB's rule, with which the grid is written, and half a voxel
        # further on in the Cycles of Blender 3.4.
        half_voxel = Matrix.Translation([-0.5 / n for n in source["density"]["size"]])
        add_object(volume, matrix @ half_voxel)
        return
    # A wall that lies in a face of the box is then in front of it, whatever rounding does.
    half = [0.5 - (1e-4 / matrix.col[i].to_3d().length if inside_walls else 0) for i in range(3)]
    corners = [[h if k >> i & 1 else -h for i, h in enumerate(half)] for k in range(8)]
    faces = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
    add_mesh("medium", corners, faces, matrix, volume_material(medium, False))


def add_surfaces(gltf, folder, mesh, matrix):
    for primitive in gltf["meshes"][mesh]["primitives"]:
        if primitive.get("mode", 4) != 4 or "material" not in primitive:
            raise Unsupported("meshes other than triangles with a material")
        corners = accessor(gltf, folder, primitive["attributes"]["POSITION"])
        order = ([i for (i,) in accessor(gltf, folder, primitive["indices"])] if "indices" in primitive
                 else list(range(len(corners))))
        faces = [order[i:i + 3] for i in range(0, len(order), 3)]
        add_mesh("surface", corners, faces, matrix, diffuse_material(gltf, primitive["material"]))


def even_cone(light):
    """Blender's spot light has the cosine to its axis as a factor; glTF's does not. The lamp's nodes divide by it."""
    tree, output = empty_nodes(light, "ShaderNodeOutputLight")
    emission = tree.nodes.new("ShaderNodeEmission")
    direction = tree.nodes.new("ShaderNodeTexCoord")  # Normal: the direction of the light in the lamp's own axes
    parts = tree.nodes.new("ShaderNodeSeparateXYZ")
    positive, inverse = tree.nodes.new("ShaderNodeMath"), tree.nodes.new("ShaderNodeMath")
    positive.operation, inverse.operation = "ABSOLUTE", "DIVIDE"
    inverse.inputs[0].default_value = 1
    tree.links.new(direction.outputs["Normal"], parts.inputs[0])
    tree.links.new(parts.outputs["Z"], positive.inputs[0])
    tree.links.new(positive.outputs[0], inverse.inputs[1])
    tree.links.new(inverse.outputs[0], emission.inputs["Strength"])
    tree.links.new(emission.outputs[0], output.inputs["Surface"])


def add_light(source, matrix):
    kind = source["type"]
    if kind == "directional":
        light = bpy.data.lights.new("sun", "SUN")
        light.energy = source.get("intensity", 1)
        light.angle = 0
    elif kind == "spot":
        cone = source["spot"]
        outer = cone.get("outerConeAngle", math.pi / 4)
        if cone.get("innerConeAngle", 0) != outer:
            raise Unsupported("spot lights with a soft edge")
        light = bpy.data.lights.new("spot", "SPOT")
        light.energy = 4 * math.pi * source.get("intensity", 1)  # P watts are P / (4 pi) W/sr on the axis
        light.shadow_soft_size = 0
        light.spot_size = 2 * outer
        light.spot_blend = 0
        even_cone(light)
    else:
        raise Unsupported(f"lights of the type '{kind}'")
    light.color = source.get("color", (1, 1, 1))
    light.cycles.max_bounces = NO_LIMIT
    add_object(light, unscaled(matrix))


def add_camera(source, matrix):
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "VERTICAL"
    camera.clip_start, camera.clip_end = 1e-4, 1e4
    if source["type"] == "perspective":
        camera.type = "PERSP"
        camera.angle_y = source["perspective"]["yfov"]
    else:
        camera.type = "ORTHO"
        camera.ortho_scale = 2 * source["orthographic"]["ymag"]
    bpy.context.scene.camera = add_object(camera, unscaled(matrix))


def build(job):
    with open(job["file"], encoding="utf-8") as file:
        gltf = json.load(file)
    folder = os.path.dirname(job["file"])
    nodes = list(walk(gltf, gltf["scenes"][gltf.get("scene", 0)]["nodes"], Matrix.Identity(4)))
    wanted = job["scene"].get("camera")
    cameras = [(n, m) for n, m in nodes if "camera" in n and wanted in (None, n.get("name"), gltf["cameras"][n["camera"]].get("name"))]
    if not cameras or "TYN_environment_map" in gltf.get("extensions", {}):
        raise Unsupported("scenes without a camera, or with an environment")
    add_camera(gltf["cameras"][cameras[0][0]["camera"]], cameras[0][1])
    walls = any("mesh" in node for node, _ in nodes)
    for node, matrix in nodes:
        extensions = node.get("extensions", {})
        if "TYN_participating_media" in extensions:
            add_medium(job, gltf, extensions["TYN_participating_media"], matrix, walls)
        if "KHR_lights_punctual" in extensions:
            add_light(gltf["extensions"]["KHR_lights_punctual"]["lights"][extensions["KHR_lights_punctual"]["light"]], matrix)
        if "mesh" in node:
            add_surfaces(gltf, folder, node["mesh"], matrix)


# ---- rendering --------------------------------------------------------------------------------

def set_up(job):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    for name in ("max", "diffuse", "glossy", "transmission", "volume", "transparent_max"):
        setattr(cycles, name + "_bounces", NO_LIMIT)
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.light_sampling_threshold = 0
    # With Blender's usual pattern, tables of points that all pixels and seeds share, the mean of `cube g 0.9` is 0.4 % too
    # low whatever the seed.
    cycles.sampling_pattern = "SOBOL"
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1
    cycles.volume_step_rate, cycles.volume_max_steps = job["step_rate"], 65536
    scene.render.resolution_x, scene.render.resolution_y = job["size"]
    scene.render.resolution_percentage = 100
    scene.render.threads_mode, scene.render.threads = "FIXED", job["threads"]
    scene.render.film_transparent = False
    scene.view_settings.view_transform = "Raw"
    image = scene.render.image_settings
    image.file_format, image.color_mode, image.color_depth, image.exr_codec = "OPEN_EXR", "RGB", "32", "ZIP"
    world = bpy.data.worlds.new("black")
    tree, output = empty_nodes(world, "ShaderNodeOutputWorld")
    background = tree.nodes.new("ShaderNodeBackground")
    background.inputs["Strength"].default_value = 0
    tree.links.new(background.outputs[0], output.inputs["Surface"])
    world.cycles.sampling_method = "NONE"
    scene.world = world
    # What the media scatter towards the camera; surfaces that are seen through them are in other passes.
    layer = bpy.context.view_layer.cycles
    layer.use_pass_volume_direct = layer.use_pass_volume_indirect = True
    scene.use_nodes = True
    tree = scene.node_tree
    tree.nodes.clear()
    layers, add, out = (tree.nodes.new("CompositorNode" + kind) for kind in ("RLayers", "MixRGB", "Composite"))
    add.blend_type = "ADD"
    tree.links.new(layers.outputs["VolumeDir"], add.inputs[1])
    tree.links.new(layers.outputs["VolumeInd"], add.inputs[2])
    tree.links.new(add.outputs[0], out.inputs["Image"])


class Log:
    """What Cycles writes to the standard error, in a file."""

    def __init__(self, path):
        self.file = open(path, "w+b")
        sys.stderr.flush()
        os.dup2(self.file.fileno(), 2)

    def seconds(self):
        """The last rendering's own: without synchronization, which builds shaders and hierarchies and loads grids."""
        text = os.pread(self.file.fileno(), os.fstat(self.file.fileno()).st_size, 0).decode(errors="replace")
        found = re.findall(r"Render time \(without synchronization\): ([0-9.e+-]+)", text)
        if not found:
            raise Unsupported("a Blender whose --debug-cycles tells no render time")
        return float(found[-1])


def mean_of(path):
    """Of a picture that was written: over pixels and colours."""
    image = bpy.data.images.load(path)
    values = image.pixels[:]
    bpy.data.images.remove(image)
    return (sum(values) - sum(values[3::4])) / (len(values) // 4 * 3)


def render_all(job, log):
    """The pictures, with seeds from 0 on; stops before what would take longer than max_seconds."""
    scene, pictures, spp, seed = bpy.context.scene, [], 1, 0
    while spp <= job["max_samples"]:
        spent, times = 0, []
        while len(times) < job["frames"] and (not times or spent + times[-1] < job["timing_seconds"]):
            scene.cycles.samples, scene.cycles.seed = spp, seed
            scene.render.filepath = os.path.join(job["folder"], f"{spp}-{seed}.exr")
            cpu = time.process_time()
            bpy.ops.render.render(write_still=True)
            times.append(log.seconds())
            spent += times[-1]
            pictures.append({"spp": spp, "seed": seed, "seconds": times[-1], "cpu_seconds": time.process_time() - cpu,
                             "mean": mean_of(scene.render.filepath), "file": scene.render.filepath})
            seed += 1
        if 4 * min(times) > job["max_seconds"]:
            break
        spp *= 4
    return pictures


def main():
    with open(sys.argv[sys.argv.index("--") + 1], encoding="utf-8") as file:
        job = json.load(file)
    log = Log(os.path.join(job["folder"], "log.txt"))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    try:
        build(job)
        set_up(job)
        result = {"version": bpy.app.version_string, "pictures": render_all(job, log)}
    except Unsupported as what:
        result = {"unsupported": str(what)}
    with open(os.path.join(job["folder"], "result.json"), "w", encoding="utf-8") as file:
        json.dump(result, file)


main()
