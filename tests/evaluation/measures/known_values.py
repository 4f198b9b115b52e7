"""Values of the quality measures for the pattern of measures_test.cpp, straight from their definitions: double precision,
two-dimensional windows, no shared code. Prints mse, psnr, ssim and flip. SSIM: Wang et al. 2004. FLIP: Andersson et al. 2020."""
from math import ceil, exp, hypot, log10, pi, sqrt

W, H, PPD = 48, 40, 67.02


def pattern(shift):
    return [[((u * 5 + y * 2) % 256, 40 if (u // 8 + y // 8) % 2 == 0 else 210, (u * u + 3 * y * y) // 7 % 256)
             for u in range(shift, W + shift)] for y in range(H)]


def window(plane, x, y, kernel):
    """Sum over a kernel of (dx, dy, weight); the border repeats."""
    return sum(w * plane[min(max(y + dy, 0), H - 1)][min(max(x + dx, 0), W - 1)] for dx, dy, w in kernel)


def disc(radius, weight):
    return [(dx, dy, weight(dx, dy)) for dy in range(-radius, radius + 1) for dx in range(-radius, radius + 1)]


def normalised(kernel):
    total = sum(w for _, _, w in kernel)
    return [(dx, dy, w / total) for dx, dy, w in kernel]


def ssim(a, b):
    kernel = normalised(disc(5, lambda x, y: exp(-(x * x + y * y) / (2 * 1.5 ** 2))))
    luma = [[[(77 * r + 150 * g + 29 * bl + 128) // 256 for r, g, bl in row] for row in p] for p in (a, b)]
    c1, c2, values = (0.01 * 255) ** 2, (0.03 * 255) ** 2, []
    for y in range(5, H - 5):
        for x in range(5, W - 5):
            near = [(luma[0][y + dy][x + dx], luma[1][y + dy][x + dx], w) for dx, dy, w in kernel]
            ma, mb = sum(p * w for p, _, w in near), sum(q * w for _, q, w in near)
            va, vb = sum((p - ma) ** 2 * w for p, _, w in near), sum((q - mb) ** 2 * w for _, q, w in near)
            cov = sum((p - ma) * (q - mb) * w for p, q, w in near)
            values.append((2 * ma * mb + c1) * (2 * cov + c2) / ((ma * ma + mb * mb + c1) * (va + vb + c2)))
    return sum(values) / len(values)


M = [[10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794],
     [2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897],
     [1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382]]
WHITE = [sum(row) for row in M]


def invert(m):
    (a, b, c), (d, e, f), (g, h, i) = m
    det = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    return [[(e * i - f * h) / det, (c * h - b * i) / det, (b * f - c * e) / det],
            [(f * g - d * i) / det, (a * i - c * g) / det, (c * d - a * f) / det],
            [(d * h - e * g) / det, (b * g - a * h) / det, (a * e - b * d) / det]]


def times(m, v):
    return [sum(p * q for p, q in zip(row, v)) for row in m]


def linear(byte):
    v = byte / 255
    return v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4


def xyz(rgb):
    return [v / w for v, w in zip(times(M, rgb), WHITE)]


def hunt(rgb):
    f = [v ** (1 / 3) if v > (6 / 29) ** 3 else v / (3 * (6 / 29) ** 2) + 4 / 29 for v in xyz(rgb)]
    light = 116 * f[1] - 16
    return light, 0.01 * light * 500 * (f[0] - f[1]), 0.01 * light * 200 * (f[1] - f[2])


def distance(p, q):
    return (abs(p[0] - q[0]) + hypot(p[1] - q[1], p[2] - q[2])) ** 0.7


def perceive(picture):
    ycc = [[(lambda v: (116 * v[1] - 16, 500 * (v[0] - v[1]), 200 * (v[1] - v[2])))(xyz([linear(c) for c in p]))
            for p in row] for row in picture]
    planes = [[[p[c] for p in row] for row in ycc] for c in range(3)]
    radius = ceil(3 * sqrt(0.04 / (2 * pi * pi)) * PPD)

    def csf(*gaussians):
        return normalised(disc(radius, lambda x, y: sum(
            a * sqrt(pi / b) * exp(-pi * pi * (x * x + y * y) / PPD ** 2 / b) for a, b in gaussians)))

    kernels = csf((1, 0.0047)), csf((1, 0.0053)), csf((34.1, 0.04), (13.5, 0.025))
    sd = 0.5 * 0.082 * PPD
    r = ceil(3 * sd)

    def balanced(kernel):
        up = sum(w for _, _, w in kernel if w > 0)
        down = -sum(w for _, _, w in kernel if w < 0)
        return [(dx, dy, w / (up if w > 0 else down)) for dx, dy, w in kernel]

    g = lambda x, y: exp(-(x * x + y * y) / (2 * sd * sd))
    edge = [balanced(disc(r, lambda x, y: -x * g(x, y))), balanced(disc(r, lambda x, y: -y * g(x, y)))]
    point = [balanced(disc(r, lambda x, y: (x * x / sd ** 2 - 1) * g(x, y))),
             balanced(disc(r, lambda x, y: (y * y / sd ** 2 - 1) * g(x, y)))]
    light = [[(v + 16) / 116 for v in row] for row in planes[0]]
    back, result = invert(M), []
    for y in range(H):
        for x in range(W):
            o = [window(planes[c], x, y, kernels[c]) for c in range(3)]
            yn = (o[0] + 16) / 116
            rgb = times(back, [v * w for v, w in zip((yn + o[1] / 500, yn, yn - o[2] / 200), WHITE)])
            result.append((hunt([min(max(v, 0), 1) for v in rgb]),
                           hypot(*(window(light, x, y, k) for k in edge)),
                           hypot(*(window(light, x, y, k) for k in point))))
    return result


def flip(a, b):
    top = distance(hunt([0, 1, 0]), hunt([0, 0, 1]))
    knee, total = 0.4 * top, 0
    for (la, ea, pa), (lb, eb, pb) in zip(perceive(a), perceive(b)):
        d = distance(la, lb)
        color = d * 0.95 / knee if d < knee else 0.95 + (d - knee) / (top - knee) * 0.05
        total += color ** (1 - sqrt(max(abs(ea - eb), abs(pa - pb)) / sqrt(2)))
    return total / (W * H)


shown, reference = pattern(1), pattern(0)
mse = sum((p - q) ** 2 for r, s in zip(shown, reference) for u, v in zip(r, s) for p, q in zip(u, v)) / (3 * W * H * 255 ** 2)
print(f"mse {mse:.9f}\npsnr {-10 * log10(mse):.5f}\nssim {ssim(shown, reference):.6f}\nflip {flip(shown, reference):.6f}")
