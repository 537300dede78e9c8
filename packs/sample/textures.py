"""The procedural textures of the sample apartment, and the materials that use them.

Only additions, multiplications and integer hashes are used, no functions of the
C mathematics library, so every machine computes the same pixels.
"""

import png

# Where things lie on the `prints` texture, in pixels: x0, y0, x1, y1.
PRINTS_SIZE = 128
BOOK_COUNT = 16
PAINTING = (1, 66, 63, 110)
WINDOW_VIEW = (65, 66, 127, 110)
SWATCHES = {
    "cream": (226, 214, 184), "charcoal": (44, 45, 48), "orange": (226, 132, 40),
    "apple": (178, 52, 44), "leaf": (74, 124, 62), "deep_leaf": (48, 92, 54),
    "terracotta": (176, 98, 66), "porcelain": (236, 236, 230), "shade": (244, 226, 178),
    "soil": (70, 52, 40), "brass": (196, 158, 84), "teal": (52, 118, 122),
}

# material: (image, base color factor, metallic, roughness, meters per repeat in u and v)
MATERIALS = {
    "plaster": ("plaster", (1.0, 1.0, 1.0), 0.0, 0.95, (1.3, 1.3)),
    "planks": ("planks", (1.0, 1.0, 1.0), 0.0, 0.6, (1.46, 0.73)),
    "tiles": ("tiles", (1.0, 1.0, 1.0), 0.0, 0.35, (0.412, 0.412)),
    "oak": ("oak", (1.0, 1.0, 1.0), 0.0, 0.6, (0.9, 0.45)),
    "walnut": ("walnut", (1.0, 1.0, 1.0), 0.0, 0.5, (0.9, 0.45)),
    "lacquer": ("lacquer", (1.0, 1.0, 1.0), 0.0, 0.3, (0.7, 0.7)),
    "blue_weave": ("weave", (0.13, 0.26, 0.38), 0.0, 0.95, (0.19, 0.19)),
    "mustard_weave": ("weave", (0.72, 0.40, 0.07), 0.0, 0.95, (0.19, 0.19)),
    "linen": ("weave", (0.92, 0.88, 0.80), 0.0, 0.95, (0.19, 0.19)),
    "rug": ("rug", (1.0, 1.0, 1.0), 0.0, 1.0, (1.0, 1.0)),
    "steel": ("steel", (1.0, 1.0, 1.0), 0.5, 0.4, (0.4, 0.4)),
    "prints": ("prints", (1.0, 1.0, 1.0), 0.0, 0.7, (1.0, 1.0)),
}

# The same for the movable objects, each of which is a file of its own: most are plain colors, which
# need no image.
OBJECT_MATERIALS = {
    "glaze": (None, (0.89, 0.87, 0.80), 0.0, 0.25, (1.0, 1.0)),
    "blue_glaze": (None, (0.13, 0.30, 0.52), 0.0, 0.25, (1.0, 1.0)),
    "porcelain": (None, (0.93, 0.93, 0.91), 0.0, 0.2, (1.0, 1.0)),
    "tin": (None, (0.66, 0.67, 0.69), 0.8, 0.35, (1.0, 1.0)),
    "red_label": ("label", (0.84, 0.24, 0.20), 0.0, 0.6, (1.0, 1.0)),
    "yellow_label": ("label", (0.96, 0.72, 0.22), 0.0, 0.6, (1.0, 1.0)),
    "green_plastic": (None, (0.20, 0.47, 0.31), 0.0, 0.4, (1.0, 1.0)),
    "white_plastic": (None, (0.90, 0.90, 0.88), 0.0, 0.4, (1.0, 1.0)),
    "teal_cover": ("label", (0.16, 0.46, 0.50), 0.0, 0.7, (1.0, 1.0)),
    "pages": (None, (0.92, 0.89, 0.80), 0.0, 0.95, (1.0, 1.0)),
    "apple_skin": (None, (0.75, 0.15, 0.13), 0.0, 0.4, (1.0, 1.0)),
    "stem": (None, (0.33, 0.23, 0.13), 0.0, 0.9, (1.0, 1.0)),
}

# Materials whose texture has a grain along u: u follows the long side of a part.
GRAINED = frozenset(("planks", "oak", "walnut"))


def tile_size(material):
    """Meters per repeat of the material's image in u and v."""
    return (MATERIALS.get(material) or OBJECT_MATERIALS[material])[4]


def _hash01(x, y, seed):
    """A number in [0, 1) that depends only on the three integers."""
    h = (x * 0x9E3779B1 ^ y * 0x85EBCA77 ^ seed * 0xC2B2AE3D) & 0xFFFFFFFF
    h = ((h ^ (h >> 15)) * 0x2C1B3C6D) & 0xFFFFFFFF
    h = ((h ^ (h >> 12)) * 0x297A2D39) & 0xFFFFFFFF
    return (h ^ (h >> 15)) / 4294967296.0


def _noise(u, v, period_u, period_v, seed):
    """Smooth value noise in [0, 1) over the unit square, tiling, on a lattice of the periods."""
    x, y = u * period_u, v * period_v
    xi, yi = int(x), int(y)
    fx, fy = x - xi, y - yi
    fx, fy = fx * fx * (3 - 2 * fx), fy * fy * (3 - 2 * fy)
    x0, x1, y0, y1 = xi % period_u, (xi + 1) % period_u, yi % period_v, (yi + 1) % period_v
    top = _hash01(x0, y0, seed) * (1 - fx) + _hash01(x1, y0, seed) * fx
    bottom = _hash01(x0, y1, seed) * (1 - fx) + _hash01(x1, y1, seed) * fx
    return top * (1 - fy) + bottom * fy


def _mix(a, b, t):
    return tuple(p + (q - p) * t for p, q in zip(a, b))


def _levels(t, count):
    """`t` in [0, 1] on `count` levels: few colors make small PNG files."""
    return min(count - 1, max(0, int(t * count))) / (count - 1)


def _picture(size, color_at):
    out = bytearray()
    for y in range(size):
        for x in range(size):
            out += bytes(min(255, max(0, int(c + 0.5))) for c in color_at(x, y))
    return size, size, bytes(out)


def _plaster():
    def color(x, y):
        u, v = x / 64, y / 64
        t = 0.5 * _noise(u, v, 5, 5, 11) + 0.3 * _noise(u, v, 13, 13, 12) + 0.2 * _hash01(x, y, 13)
        return _mix((222, 214, 200), (240, 234, 222), _levels(t, 9))
    return _picture(64, color)


def _wood(u, v, seed, period_v):
    """Grain along u: streaks narrow in v, bent slowly by a coarse noise."""
    bend = v + 0.05 * _noise(u, v, 3, 2, seed)
    streak = _noise(u, bend - int(bend), 2, period_v, seed + 1)
    fine = _noise(u, v, 4, period_v * 3, seed + 2)
    return 0.65 * streak + 0.35 * fine


def _timber(dark, light, seed, size):
    def color(x, y):
        return _mix(dark, light, _levels(_wood(x / size, y / size, seed, 15), 12))
    return _picture(size, color)


def _planks():
    def color(x, y):
        row, inside = divmod(y, 32)
        start = (int(_hash01(row, 0, 21) * 4) * 16 + row * 40) % 128
        along = (x - start) % 128
        if inside == 0 or along == 0:
            return (104, 74, 48)
        t = 0.6 * _wood(x / 128, y / 128, 22, 24) + 0.4 * _hash01(row, 1, 23)
        return _mix((146, 104, 64), (204, 160, 108), _levels(t, 12))
    return _picture(128, color)


def _tiles():
    def color(x, y):
        if x % 32 < 2 or y % 32 < 2:
            return (150, 150, 144)
        t = 0.55 * _hash01(x // 32, y // 32, 31) + 0.45 * _noise(x / 64, y / 64, 9, 9, 32)
        edge = x % 32 in (2, 31) or y % 32 in (2, 31)
        return _mix((190, 200, 198), (222, 228, 222), _levels(t, 8) * (0.5 if edge else 1.0))
    return _picture(64, color)


def _lacquer():
    def color(x, y):
        t = 0.7 * _noise(x / 64, y / 64, 4, 4, 41) + 0.3 * _hash01(x // 2, y, 42)
        return _mix((168, 182, 166), (182, 195, 179), _levels(t, 5))
    return _picture(64, color)


def _weave():
    def color(x, y):
        over = ((x // 4) + (y // 4)) % 2
        across = (x % 4, y % 4)[over]
        t = (0.55, 1.0, 0.85, 0.4)[across] * 0.7 + 0.3 * _hash01(x // 4, y // 4, 51 + over)
        return _mix((168, 168, 168), (250, 250, 250), _levels(t, 10))
    return _picture(64, color)


def _rug():
    cream, red, navy, gold = (224, 208, 176), (150, 54, 46), (42, 56, 86), (200, 148, 72)

    def color(x, y):
        # The pattern is symmetric: fold the square, then draw one corner.
        a, b = min(x, 127 - x), min(y, 127 - y)
        rim = min(a, b)
        if rim < 4:
            base = navy
        elif rim < 7:
            base = cream
        elif rim < 17:
            base = gold if abs((a + b) % 10 - 5) + abs(rim - 12) < 5 else red
        elif rim < 20:
            base = cream
        else:
            diamond = (63 - a) + (63 - b)
            small = abs(a % 14 - 7) + abs(b % 14 - 7)
            if diamond < 34:
                base = (red, cream, gold, navy, red)[diamond // 7]
            else:
                base = gold if small < 3 else (cream if small < 5 else navy)
        return _mix(base, (255, 255, 255), 0.10 * _levels(_hash01(x, y // 2, 61), 4))
    return _picture(128, color)


def _steel():
    def color(x, y):
        t = 0.7 * _hash01(0, y, 71) + 0.3 * _noise(x / 64, y / 64, 3, 64, 72)
        return _mix((168, 171, 175), (198, 201, 204), _levels(t, 8))
    return _picture(64, color)


_BOOK_COLORS = (
    (134, 44, 40), (38, 70, 106), (52, 92, 66), (214, 184, 120), (92, 58, 92), (196, 106, 50),
    (48, 52, 58), (224, 218, 200), (28, 104, 112), (156, 132, 84), (110, 30, 48), (92, 124, 148),
    (70, 82, 44), (206, 158, 150), (62, 44, 36), (170, 176, 178))


def _book_color(x, y):
    base = _BOOK_COLORS[x // 8]
    light = sum(base) > 400
    ink = (60, 50, 44) if light else (222, 200, 142)
    if y in (8, 9, 54, 55) or (16 <= y < 40 and x % 8 in (3, 4) and _hash01(x // 8, y // 2, 81) > 0.3):
        return ink
    return _mix(base, (128, 128, 128), 0.12 * _levels(_hash01(x // 8, y // 4, 82), 4))


def _painting_color(x, y):
    """A sunset over hills: u and v in [0, 1] over the painting."""
    u, v = x / 62, y / 44
    if (u - 0.64) * (u - 0.64) * 2 + (v - 0.40) * (v - 0.40) < 0.021:
        return (246, 214, 130)
    ridges = (0.50 + 0.14 * _noise(u, 0.5, 4, 1, 91), 0.62 + 0.16 * _noise(u, 0.5, 5, 1, 92),
              0.78 + 0.14 * _noise(u, 0.5, 3, 1, 93))
    layers = ((150, 92, 104), (98, 66, 96), (52, 46, 76))
    for ridge, layer in reversed(tuple(zip(ridges, layers))):
        if v > ridge:
            return layer
    return _mix((86, 120, 158), (238, 156, 104), _levels(v * 1.7, 9))


def _view_color(x, y):
    """A bright sky with clouds over trees, as seen through a window."""
    u, v = x / 62, y / 44
    if v > 0.80 + 0.10 * _noise(u, 0.5, 9, 1, 95):
        return _mix((86, 122, 80), (120, 152, 100), _levels(_hash01(x // 2, y // 2, 96), 4))
    cloud = 0.6 * _noise(u, v, 3, 5, 97) + 0.4 * _noise(u, v, 8, 11, 98)
    sky = _mix((156, 194, 226), (220, 234, 240), _levels(v * 1.2, 7))
    return _mix(sky, (250, 250, 248), _levels((cloud - 0.45) * 3, 5))


def _prints():
    swatches = list(SWATCHES.values())

    def color(x, y):
        if y < 64:
            return _book_color(x, y)
        if y >= 112:
            return swatches[min(x // 8, len(swatches) - 1)]
        # The margin around each picture repeats its rim, against bleeding.
        inside_y = min(max(y - 66, 0), 44)
        if x < 64:
            return _painting_color(min(max(x - 1, 0), 62), inside_y)
        return _view_color(min(max(x - 65, 0), 62), inside_y)
    return _picture(PRINTS_SIZE, color)


def _label():
    """A printed label, bright so that the material's color shows: a seal over lines of print."""
    def color(x, y):
        u, v = (x + 0.5) / 64, (y + 0.5) / 64
        round_seal = (u - 0.5) * (u - 0.5) + (v - 0.36) * (v - 0.36)
        if v < 0.08 or v > 0.94:
            return (150, 150, 150)
        if round_seal < 0.012:
            return (255, 250, 236)
        if round_seal < 0.045:
            return (120, 120, 120)
        if 0.64 < v < 0.90 and 0.2 < u < 0.8 and int(v * 64) % 4 < 2:
            return (130, 130, 130) if _hash01(x // 2, y // 4, 101) > 0.3 else (255, 255, 255)
        return (255, 255, 255)
    return _picture(64, color)


def object_images():
    """Return [(name, PNG file bytes)] of OBJECT_MATERIALS in a fixed order."""
    return [("label", png.encode(*_label()))]


def images():
    """Return [(name, PNG file bytes)] in a fixed order."""
    pictures = (
        ("plaster", _plaster()), ("planks", _planks()), ("tiles", _tiles()),
        ("oak", _timber((168, 124, 78), (216, 176, 122), 25, 128)),
        ("walnut", _timber((66, 42, 28), (118, 80, 52), 28, 128)),
        ("lacquer", _lacquer()), ("weave", _weave()), ("rug", _rug()), ("steel", _steel()),
        ("prints", _prints()))
    return [(name, png.encode(*picture)) for name, picture in pictures]


def _uv_rect(x0, y0, x1, y1):
    return tuple(v / PRINTS_SIZE for v in (x0, y0, x1, y1))


def swatch(name):
    """Return the rectangle (u0, v0, u1, v1) of a plain color on the `prints` texture."""
    x = list(SWATCHES).index(name) * 8
    return _uv_rect(x + 2, 115, x + 6, 125)


def book_rects(index):
    """Return the rectangles of a book's spine and of its plain cover."""
    x = index % BOOK_COUNT * 8
    return _uv_rect(x + 0.5, 0.5, x + 7.5, 63.5), _uv_rect(x + 2, 57, x + 6, 63)


def painting_rect():
    return _uv_rect(*PAINTING)


def window_view_rect():
    return _uv_rect(*WINDOW_VIEW)
