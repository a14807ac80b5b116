"""Time and memory of map operations, ours and those of NumPy, SciPy and OpenCV, in one run on one machine.

    python -m venv env && env/bin/pip install -r peers/requirements.txt
    cargo build --release -p relievo-make --example measure
    env/bin/python peers/maps.py [SIZE]

Every operation runs in a process of its own, so that its peak memory is its own. Each side has all cores; both are run in
turn, and the best of RUNS counts (of one, where the other side takes over 20 s).
"""

import os
import resource
import subprocess
import sys
import time

RUNS = 3
HERE = os.path.dirname(os.path.abspath(__file__))
OURS = os.path.join(os.environ.get("CARGO_TARGET_DIR", os.path.join(HERE, "..", "target")), "release/examples/measure")


def height(size):
    import numpy as np

    x = np.linspace(0, 2 * np.pi, size, endpoint=False, dtype=np.float32)
    return (0.5 + 0.2 * np.sin(3 * x)[None, :] * np.cos(5 * x)[:, None]).astype(np.float32)


def normal(h):
    """Central differences that wrap, unit length."""
    import numpy as np

    k = np.float32(0.05 * h.shape[1] / 2)
    nx = (np.roll(h, 1, 1) - np.roll(h, -1, 1)) * k
    ny = (np.roll(h, -1, 0) - np.roll(h, 1, 0)) * k
    scale = 1 / np.sqrt(nx * nx + ny * ny + 1)
    return np.stack([nx * scale, ny * scale, scale], -1)


def integrate(n):
    """Frankot and Chellappa with the central difference's transfer function."""
    import numpy as np
    from scipy import fft

    p, q = -n[..., 0] / n[..., 2], n[..., 1] / n[..., 2]
    rows, columns = p.shape
    sx = np.sin(2 * np.pi * fft.rfftfreq(columns))[None, :]
    sy = np.sin(2 * np.pi * fft.fftfreq(rows))[:, None]
    weight = sx * sx + sy * sy
    weight[weight < 1e-12] = np.inf
    spectrum = -1j * (sx * fft.rfft2(p.astype(np.float64), workers=-1) + sy * fft.rfft2(q.astype(np.float64), workers=-1))
    return fft.irfft2(spectrum / weight, s=p.shape, workers=-1).astype(np.float32)


def integrate_open(n):
    """The same on the mirrored field: sines and cosines."""
    import numpy as np
    from scipy import fft

    p, q = -n[..., 0].astype(np.float64) / n[..., 2], n[..., 1].astype(np.float64) / n[..., 2]
    p[:, [0, -1]] *= 0.5
    q[[0, -1], :] *= 0.5
    rows, columns = p.shape
    p = fft.dct(fft.dst(p, 2, axis=1, workers=-1), 2, axis=0, workers=-1)
    q = fft.dct(fft.dst(q, 2, axis=0, workers=-1), 2, axis=1, workers=-1)
    sx = np.sin(np.pi * np.arange(columns) / columns)[None, :]
    sy = np.sin(np.pi * np.arange(rows) / rows)[:, None]
    h = np.zeros_like(p)
    h[:, 1:] -= sx[:, 1:] * p[:, :-1]
    h[1:, :] -= sy[1:, :] * q[:-1, :]
    weight = sx * sx + sy * sy
    weight[0, 0] = np.inf
    return fft.idctn(h / weight, 2, workers=-1).astype(np.float32)


def fbm(size, octaves=8, gain=0.5):
    """Gradient noise on a lattice that closes, summed."""
    import numpy as np

    out = np.zeros((size, size), np.float32)
    at = (np.arange(size, dtype=np.float32) + 0.5) / size
    for k in range(octaves):
        cells = 4 << k
        gradients = np.random.default_rng(k).uniform(-1, 1, (cells, cells, 2)).astype(np.float32)
        i = (at * cells).astype(np.int32)
        f = at * cells - i
        t = f * f * f * (f * (f * 6 - 15) + 10)
        corners = []
        for dy in (0, 1):
            for dx in (0, 1):
                g = gradients[np.ix_((i + dy) % cells, (i + dx) % cells)]
                corners.append(g[..., 0] * (f[None, :] - dx) + g[..., 1] * (f[:, None] - dy))
        above = corners[0] + (corners[1] - corners[0]) * t[None, :]
        below = corners[2] + (corners[3] - corners[2]) * t[None, :]
        out += np.float32(gain**k) * (above + (below - above) * t[:, None])
    return out


def photo(image):
    """The same steps as ours with OpenCV's filters: two layers flattened, seven bands each, levels, a guided filter, normals.

    Wide blurs are done on smaller pictures, as one does who wants them soon; a sum of weighted bands is a sum of weighted
    blurs. Ambient occlusion is left out on both sides, roughness on this one, which is to its favour."""
    import cv2
    import numpy as np

    def blur(x, sigma):
        factor = 1
        while sigma / factor >= 8:
            factor *= 2
        size = (x.shape[1], x.shape[0])
        small = x if factor == 1 else cv2.resize(x, (size[0] // factor, size[1] // factor), interpolation=cv2.INTER_AREA)
        small = cv2.GaussianBlur(small, (0, 0), sigma / factor, borderType=cv2.BORDER_REFLECT)
        return small if factor == 1 else cv2.resize(small, size, interpolation=cv2.INTER_CUBIC)

    unit = image.shape[1] / 1024
    linear = np.where(image <= 0.04045, image / 12.92, ((image + 0.055) / 1.055) ** 2.4).astype(np.float32)
    light = linear @ np.array([0.2126, 0.7152, 0.0722], np.float32)
    black = np.float32(0.1 * np.median(light[::16, ::16]))
    light = np.log(light + black)
    most = linear.max(2)
    saturation = (most - linear.min(2)) / (most + black)
    del linear, most
    h = np.zeros_like(light)
    weights = ([0.1, 0.1, 0.1, 0.05, 0, 0, 0], [0, 0, 0.4, 1, 1, 1, 1])
    for layer, weight in zip((light, saturation), weights):
        layer = layer - blur(layer, 64 * unit)
        layer = np.clip(layer / layer.std(), -2, 2)
        h += np.float32(weight[0]) * layer
        for k in range(6):
            if weight[k + 1] != weight[k]:
                h += np.float32(weight[k + 1] - weight[k]) * blur(layer, unit * 2**k)
    low, high = np.percentile(h, [0.5, 99.5])
    h = np.clip((h - low) / (high - low), 0, 1).astype(np.float32)
    mean = blur(h, 2 * unit)
    variance = blur(h * h, 2 * unit) - mean * mean
    gain = variance / (variance + np.float32(0.01))
    h = blur(gain, 2 * unit) * h + blur(mean * (1 - gain), 2 * unit)
    return h, normal(h)


def theirs(operation, size):
    import numpy as np

    if operation == "fbm":
        start = time.perf_counter()
        fbm(size)
    elif operation == "height-to-normal":
        h = height(size)
        start = time.perf_counter()
        normal(h)
    elif operation.startswith("normal-to-height"):
        n = normal(height(size))
        start = time.perf_counter()
        (integrate_open if operation.endswith("open") else integrate)(n)
    else:
        h = height(size)
        image = np.stack([h, 0.8 * h, 0.6 * h + 0.1], -1).astype(np.float32)
        del h
        start = time.perf_counter()
        photo(image)
    seconds = time.perf_counter() - start
    print(f"{seconds:.3f} {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024}")


def measured(command):
    seconds, bytes = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()
    return float(seconds), int(bytes)


def main():
    size = int(sys.argv[1]) if len(sys.argv) > 1 else 4096
    picture = 4 * size * size
    print(f"{size}x{size}: seconds, and peak memory in float pictures of one channel ({picture >> 20} MiB), input included")
    print(f"{'operation':24}{'ours':>16}{'theirs':>16}{'time ratio':>12}{'memory ratio':>14}")
    for operation in ("fbm", "height-to-normal", "normal-to-height", "normal-to-height-open", "from-photo"):
        runs = []
        # What takes long is measured once: noise of a few per cent does not matter there.
        while len(runs) < RUNS and (not runs or runs[0][1][0] < 20):
            peer = [sys.executable, __file__, "--theirs", operation, str(size)]
            runs.append((measured([OURS, operation, str(size)]), measured(peer)))
        ours, peers = (tuple(min(run[side][k] for run in runs) for k in (0, 1)) for side in (0, 1))
        print(
            f"{operation:24}{ours[0]:8.2f} {ours[1] / picture:6.1f}x{peers[0]:8.2f} {peers[1] / picture:6.1f}x"
            f"{peers[0] / ours[0]:11.1f}x{peers[1] / ours[1]:13.1f}x",
            flush=True,
        )


if __name__ == "__main__":
    if sys.argv[1:2] == ["--theirs"]:
        theirs(sys.argv[2], int(sys.argv[3]))
    else:
        main()
