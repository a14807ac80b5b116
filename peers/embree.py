"""Rays per second, build time and memory of the exact march and of Embree, on the same field with the same rays, in one run.

    python -m venv env && env/bin/pip install -r peers/requirements.txt
    cargo build --release -p relievo-march --example rays_per_second
    env/bin/python peers/embree.py [MATERIAL | HEIGHT.png] …

Embree gets the field as triangles, two to a cell, so its hits differ a little from those on the bilinear cells: how many by
more than a texel is printed. Both march on one thread; Embree by rtcIntersect1, as its Python package calls it, the rays
being neighbours in memory. Builds have all cores. The two sides are timed in turn, ROUNDS times; each side's best counts.
Embree's memory is what the process grows by while the scene is made, its copy of the triangles included.
"""

import json
import os
import subprocess
import sys
import tempfile
import time

import numpy as np
import psutil
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene

ROUNDS = 5
DEPTH = 25.0
HERE = os.path.dirname(os.path.abspath(__file__))
TARGET = os.environ.get("CARGO_TARGET_DIR", os.path.join(HERE, "..", "target"))
OURS = os.path.join(TARGET, "release/examples/rays_per_second")


def triangles(heights):
    """Vertices and indices, two triangles to a cell."""
    rows, columns = heights.shape
    x, y = np.meshgrid(np.arange(columns, dtype=np.float32), np.arange(rows, dtype=np.float32))
    vertices = np.stack([x, y, heights * np.float32(DEPTH)], -1).reshape(-1, 3)
    at = np.arange(rows * columns, dtype=np.int32).reshape(rows, columns)
    a, b, c, d = (p.ravel() for p in (at[:-1, :-1], at[:-1, 1:], at[1:, :-1], at[1:, 1:]))
    return vertices, np.concatenate([np.stack([a, b, d], -1), np.stack([a, d, c], -1)])


def main(field):
    process = psutil.Process()
    with tempfile.TemporaryDirectory() as folder:
        ours = json.loads(subprocess.check_output([OURS, "--json", "--dump", folder, field]))
        columns, rows = ours["size"]

        def read(name, shape):
            return np.fromfile(os.path.join(folder, name), dtype=np.float32).reshape(shape)

        vertices, indices = triangles(read("field.f32", (rows, columns)))
        angles = [row["degrees"] for row in ours["angles"]]
        rays = {a: read(f"rays-{a:g}.f32", (-1, 6)) for a in angles}
        depths = {a: read(f"depths-{a:g}.f32", -1) for a in angles}

    before, start = process.memory_info().rss, time.perf_counter()
    scene = EmbreeScene()
    TriangleMesh(scene, vertices, indices)
    # The first ray builds the tree.
    scene.run(np.array([[1, 1, 99]], np.float32), np.array([[0, 0, -1]], np.float32))
    build, memory = time.perf_counter() - start, process.memory_info().rss - before

    print(f"{field}, {columns}×{rows}: build {ours['build_ms']:.1f} ms and {build * 1e3:.0f} ms (×{build * 1e3 / ours['build_ms']:.0f}), "
          f"memory {ours['pyramid_bytes'] / 2**20:.2f} MiB and {memory / 2**20:.0f} MiB (×{memory / ours['pyramid_bytes']:.0f})")
    best = {a: [0.0, 0.0, 0.0] for a in angles}
    differ = {}
    for _ in range(ROUNDS):
        ours = json.loads(subprocess.check_output([OURS, "--json", field]))
        for row in ours["angles"]:
            a = row["degrees"]
            origins, directions = np.ascontiguousarray(rays[a][:, :3]), np.ascontiguousarray(rays[a][:, 3:])
            start = time.perf_counter()
            hits = scene.run(origins, directions, query="INTERSECT")
            rate = len(hits) / (time.perf_counter() - start)
            best[a] = [max(pair) for pair in zip(best[a], [row["scalar"], row["packets"], rate])]
            if a not in differ:
                distance = scene.run(origins, directions, query="DISTANCE")
                way = distance * np.linalg.norm(directions[:, :2], axis=1)
                reach = depths[a] * DEPTH * np.tan(np.radians(a))
                inside = hits >= 0
                differ[a] = np.mean(np.abs(way - reach)[inside] > 1), np.mean(~inside)
    print("      M rays/s: scalar  together   Embree   ratios to Embree   over a texel apart   beyond the triangles")
    for a, (scalar, packets, rate) in best.items():
        print(f"{a:5g}°        {scalar / 1e6:8.1f}  {packets / 1e6:8.1f} {rate / 1e6:8.1f}   ×{scalar / rate:.1f}   ×{packets / rate:.1f}"
              f"         {differ[a][0] * 100:.3f} %              {differ[a][1] * 100:.2f} %")
    scalar, packets, rate = (len(best) / sum(1 / rates[k] for rates in best.values()) for k in range(3))
    print(f"  all         {scalar / 1e6:8.1f}  {packets / 1e6:8.1f} {rate / 1e6:8.1f}   ×{scalar / rate:.1f}   ×{packets / rate:.1f}")


for field in sys.argv[1:] or ["brick-wall", "cobbles", "terrain"]:
    main(field)
