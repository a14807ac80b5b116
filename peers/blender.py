"""Reliefs on meshes by Blender's Cycles, beside what `edge = "silhouette"` draws: outlines, depths, normals, FLIP.

    python3.11 -m venv env && env/bin/pip install bpy==4.5.15 "numpy<2" OpenEXR==3.4.4 flip-evaluator==1.7
    cargo build --release
    env/bin/python peers/blender.py target/release/relievo [FOLDER]

Three low-poly meshes with smooth normals (a torus, a cube, a terrain) carry one height map. Here each is cut into a dense grid, whose
vertices are moved along the interpolated normals; Cycles traces that as plain triangles. Relievo marches the same relief over the
low-poly mesh. Fails where outlines overlap by less than 0.995, the 99th percentile of the depths is off by more than a tenth of a
texel, or FLIP of the pictures of the depths is above 0.02. Normals are printed alone: Cycles' are those of the facets, Relievo shades
with the mesh's smooth normals, tilted by the slopes of the map.
"""

import math
import os
import struct
import subprocess
import sys
import tempfile
import zlib

import bpy
import flip_evaluator
import numpy as np
import OpenEXR

TEXELS = 32
PER_TEXEL = 6
DEPTH = 0.12
MIDLEVEL = 0.5
SIZE = (320, 240)
EYE, FOV = np.array([1.9, 1.6, 3.4]), 40.0


def heights():
    wave = lambda x, n: np.sin((x + 0.5) / TEXELS * n * math.tau)
    y, x = np.mgrid[0:TEXELS, 0:TEXELS].astype(float)
    return np.round((0.5 + 0.25 * wave(x, 2) * wave(y, 3) + 0.25 * wave(y, 1)) * 65535) / 65535


def lattice(columns, rows, surface):
    v, u = np.mgrid[0 : rows + 1, 0 : columns + 1].astype(float)
    u, v = u.ravel() / columns, v.ravel() / rows
    p, n = surface(u, v)
    i, j = np.meshgrid(np.arange(columns), np.arange(rows))
    a = (j * (columns + 1) + i).ravel()
    b, c, d = a + 1, a + columns + 1, a + columns + 2
    triangles = np.concatenate([np.stack([a, c, b], 1), np.stack([b, c, d], 1)])
    return p, n / np.linalg.norm(n, axis=1, keepdims=True), np.stack([u, v], 1), triangles


def torus():
    def surface(u, v):
        s, c = np.sin(u * math.tau), np.cos(u * math.tau)
        sin, cos = np.sin(-v * math.tau), np.cos(-v * math.tau)
        n = np.stack([cos * s, sin, cos * c], 1)
        return np.stack([s, 0 * s, c], 1) + 0.4 * n, n

    return lattice(20, 10, surface)


def terrain():
    def surface(u, v):
        x, z = 3 * u - 1.5, 3 * v - 1.5
        y = 0.25 * np.sin(2.3 * x) * np.cos(1.9 * z)
        dx = 0.25 * 2.3 * np.cos(2.3 * x) * np.cos(1.9 * z)
        dz = -0.25 * 1.9 * np.sin(2.3 * x) * np.sin(1.9 * z)
        return np.stack([x, y, z], 1), np.stack([-dx, np.ones_like(x), -dz], 1)

    return lattice(8, 8, surface)


def cube():
    positions, uvs, triangles = [], [], []
    for u, v in [([1, 0, 0], [0, -1, 0]), ([0, 0, -1], [0, -1, 0]), ([-1, 0, 0], [0, -1, 0]),
                 ([0, 0, 1], [0, -1, 0]), ([1, 0, 0], [0, 0, 1]), ([1, 0, 0], [0, 0, -1])]:
        u, v = np.array(u, float), np.array(v, float)
        first = len(positions)
        for s, t in [(-1, -1), (1, -1), (1, 1), (-1, 1)]:
            positions.append(np.cross(v, u) + s * u + t * v)
            uvs.append([(s + 1) / 2, (t + 1) / 2])
        triangles += [[first, first + 2, first + 1], [first, first + 3, first + 2]]
    p = np.array(positions)
    return p, p / np.linalg.norm(p, axis=1, keepdims=True), np.array(uvs), np.array(triangles)


def sample(map_, uv):
    x = uv * TEXELS - 0.5
    i = np.floor(x).astype(int)
    f = x - i
    at = lambda di, dj: map_[(i[:, 1] + dj) % TEXELS, (i[:, 0] + di) % TEXELS]
    top = at(0, 0) * (1 - f[:, 0]) + at(1, 0) * f[:, 0]
    bottom = at(0, 1) * (1 - f[:, 0]) + at(1, 1) * f[:, 0]
    return top * (1 - f[:, 1]) + bottom * f[:, 1]


def displaced(mesh, map_):
    """Vertices and triangles of the relief, each triangle cut into n² ones."""
    p, n, uv, triangles = mesh
    span = max(np.abs(uv[t] - uv[np.roll(t, 1)]).max() for t in triangles)
    cuts = math.ceil(span * TEXELS * PER_TEXEL)
    weights = np.array([[i, j, cuts - i - j] for i in range(cuts + 1) for j in range(cuts + 1 - i)]) / cuts
    number = {(i, j): k for k, (i, j) in enumerate((i, j) for i in range(cuts + 1) for j in range(cuts + 1 - i))}
    pieces = []
    for i in range(cuts):
        for j in range(cuts - i):
            pieces.append([number[i, j], number[i + 1, j], number[i, j + 1]])
            if i + j < cuts - 1:
                pieces.append([number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]])
    pieces = np.array(pieces)
    vertices, faces = [], []
    for k, corners in enumerate(triangles):
        normal = weights @ n[corners]
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        h = sample(map_, weights @ uv[corners])
        vertices.append(weights @ p[corners] + normal * ((h - MIDLEVEL) * DEPTH)[:, None])
        faces.append(pieces + k * len(weights))
    return np.concatenate(vertices), np.concatenate(faces)


def by_cycles(vertices, faces, folder):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="cycles")
    scene = bpy.context.scene
    data = bpy.data.meshes.new("relief")
    # Blender has z up.
    data.from_pydata((vertices * [1, 1, -1])[:, [0, 2, 1]].tolist(), [], faces.tolist())
    scene.collection.objects.link(bpy.data.objects.new("relief", data))
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit, camera.angle = "VERTICAL", math.radians(FOV)
    holder = bpy.data.objects.new("camera", camera)
    forward = -EYE / np.linalg.norm(EYE)
    right = np.cross(forward, [0, 1, 0])
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    turn = lambda v: [v[0], -v[2], v[1]]
    from mathutils import Matrix

    columns = [turn(right), turn(up), turn(-forward), turn(EYE)]
    holder.matrix_world = Matrix([[columns[c][r] for c in range(4)] for r in range(3)] + [[0, 0, 0, 1]])
    scene.collection.objects.link(holder)
    scene.camera, scene.render.engine = holder, "CYCLES"
    scene.cycles.samples, scene.cycles.pixel_filter_type = 1, "BOX"
    scene.cycles.filter_width, scene.cycles.use_denoising = 0.01, False
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.view_layers[0].use_pass_position = True
    scene.view_layers[0].use_pass_normal = True
    scene.render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = os.path.join(folder, "cycles.exr")
    bpy.ops.render.render(write_still=True)
    channels = OpenEXR.File(scene.render.filepath, separate_channels=True).channels()
    part = lambda name, axes: np.stack(
        [next(c.pixels for k, c in channels.items() if k.endswith(f"{name}.{a}")) for a in axes], -1)
    position, normal = part("Position", "XYZ"), part("Normal", "XYZ")
    # From Blender's axes to ours.
    ours = lambda v: np.stack([v[..., 0], v[..., 2], -v[..., 1]], -1)
    position, normal = ours(position), ours(normal)
    seen = np.linalg.norm(normal, axis=-1) > 0.5
    return np.where(seen, (position - EYE) @ forward, np.inf), normal


def by_relievo(binary, mesh, map_, folder):
    p, n, uv, triangles = mesh
    with open(os.path.join(folder, "mesh.obj"), "w") as file:
        for v in p:
            print("v", *v, file=file)
        for t in uv:
            print("vt", t[0], 1 - t[1], file=file)
        for v in n:
            print("vn", *v, file=file)
        for t in triangles + 1:
            print("f", *(f"{i}/{i}/{i}" for i in t), file=file)
    write_png(os.path.join(folder, "height.png"), map_)
    with open(os.path.join(folder, "scene.toml"), "w") as file:
        file.write(f"""
[image]
width = {SIZE[0]}
height = {SIZE[1]}
[camera]
position = {EYE.tolist()}
target = [0.0, 0.0, 0.0]
vertical_fov = {FOV}
[[lights]]
kind = "directional"
direction = [-0.3, -0.4, -1.0]
[materials.m]
height = "height.png"
depth = {DEPTH}
midlevel = {MIDLEVEL}
[materials.m.relief]
edge = "silhouette"
[[objects]]
mesh = "mesh.obj"
material = "m"
""")
    out = lambda name: os.path.join(folder, name)
    subprocess.run([binary, "--quiet", "render", out("scene.toml"), "-o", out("ours.png"), "--aov", f"depth={out('depth.exr')}",
                    "--aov", f"normal={out('normal.exr')}"], check=True)
    read = lambda name, channels: np.stack([OpenEXR.File(out(name), separate_channels=True).channels()[c].pixels for c in channels], -1)
    return read("depth.exr", "Y")[..., 0], read("normal.exr", "RGB")


def write_png(path, map_):
    """A grey PNG of 16 bits."""
    rows = b"".join(b"\0" + row.astype(">u2").tobytes() for row in np.round(map_ * 65535))
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    header = struct.pack(">IIBBBBB", TEXELS, TEXELS, 16, 0, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def main(binary, folder):
    failed = False
    for name, mesh in [("torus", torus()), ("cube", cube()), ("terrain", terrain())]:
        with tempfile.TemporaryDirectory() as work:
            map_ = heights()
            depth, normal = by_cycles(*displaced(mesh, map_), work)
            our_depth, our_normal = by_relievo(binary, mesh, map_, work)
        both = np.isfinite(depth) & np.isfinite(our_depth)
        overlap = both.sum() / (np.isfinite(depth) | np.isfinite(our_depth)).sum()
        # The shortest side of a texel on these meshes.
        texel = min(np.linalg.norm(mesh[0][t] - mesh[0][np.roll(t, 1)], axis=1).min() for t in mesh[3]) / TEXELS
        texel /= max(np.abs(mesh[2][t] - mesh[2][np.roll(t, 1)]).max() for t in mesh[3])
        far = np.percentile(np.abs(depth[both] - our_depth[both]), 99) / texel
        # Facets and the map's slopes: the pictures of both passes, as they are looked at.
        near, span = our_depth[both].min(), np.ptp(our_depth[both])
        picture = lambda d, seen: np.repeat(np.where(seen, 1 - (np.where(seen, d, 0) - near) / span * 0.9, 0)[..., None], 3, -1).astype(np.float32)
        flips = [flip_evaluator.evaluate(a, b, "LDR")[1] for a, b in [
            (picture(depth, both), picture(our_depth, both)),
            (np.where(both[..., None], normal * 0.5 + 0.5, 0).astype(np.float32),
             np.where(both[..., None], our_normal * 0.5 + 0.5, 0).astype(np.float32))]]
        angle = np.degrees(np.arccos(np.clip((normal * our_normal).sum(-1)[both], -1, 1)))
        print(f"{name}: outlines overlap {overlap:.4f}; depths p99 {far:.4f} texels; FLIP of depths {flips[0]:.4f}, of normals "
              f"{flips[1]:.4f}; normals {np.median(angle):.2f}° off in the middle")
        failed |= overlap < 0.995 or far > 0.1 or flips[0] > 0.02
        if folder:
            os.makedirs(folder, exist_ok=True)
            np.savez(os.path.join(folder, name), depth=depth, normal=normal, our_depth=our_depth, our_normal=our_normal)
    if failed:
        sys.exit("more than the limits")


if len(sys.argv) not in (2, 3):
    sys.exit(__doc__)
main(os.path.abspath(sys.argv[1]), sys.argv[2] if len(sys.argv) == 3 else None)
