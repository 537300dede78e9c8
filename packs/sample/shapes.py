"""Closed parts: boxes, cushions, lathes, tubes and rectilinear solids.

A part is one closed surface of one material. Its faces are polygons, counter-clockwise
seen from outside, over shared points, so that closedness can be checked by index.
"""

import math

import textures

_BOX_FACES = ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6))
BOX_SIDES = ("-x", "+x", "-y", "+y", "-z", "+z")


class Part:
    """points: [(x, y, z)]; faces: [(point index, ...)]; uvs: one list of (u, v) per face."""

    def __init__(self, material, points, faces, uvs=None, crease=0.7):
        self.material = material
        self.points = points
        self.faces = faces
        # Faces whose normals differ by less than acos(crease) are shaded smoothly.
        self.crease = crease
        self.uvs = uvs if uvs is not None else planar_uvs(material, points, faces)


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(dot(a, a))
    return (a[0] / length, a[1] / length, a[2] / length)


def sin_cos(degrees):
    """Rounded, so that the last bit of the C library's result never reaches the file."""
    angle = math.radians(degrees)
    return round(math.sin(angle), 9), round(math.cos(angle), 9)


def area_vector(points, face):
    """Twice the area of a planar polygon times its normal."""
    total = (0.0, 0.0, 0.0)
    for i in range(1, len(face) - 1):
        n = cross(sub(points[face[i]], points[face[0]]), sub(points[face[i + 1]], points[face[0]]))
        total = (total[0] + n[0], total[1] + n[1], total[2] + n[2])
    return total


def signed_volume(points, faces):
    total = 0.0
    for face in faces:
        for i in range(1, len(face) - 1):
            total += dot(points[face[0]], cross(points[face[i]], points[face[i + 1]]))
    return total / 6


def planar_uvs(material, points, faces):
    """Project every face along its main axis, at the material's scale; the grain follows length."""
    tile_u, tile_v = textures.tile_size(material)
    extent = [max(p[k] for p in points) - min(p[k] for p in points) for k in range(3)]
    result = []
    for face in faces:
        normal = area_vector(points, face)
        axis = max(range(3), key=lambda k: (round(abs(normal[k]), 9), k))
        a, b = ((2, 1), (0, 2), (0, 1))[axis]
        if material in textures.GRAINED and extent[b] > extent[a]:
            a, b = b, a
        flip = -1 if b == 1 else 1
        result.append([(points[i][a] / tile_u, flip * points[i][b] / tile_v) for i in face])
    return result


def rect_uvs(points, faces, rect, axes=None):
    """Stretch every face over a texture rectangle; `axes` are the (u, v) axes, else the main ones."""
    u0, v0, u1, v1 = rect
    result = []
    for face in faces:
        normal = area_vector(points, face)
        axis = max(range(3), key=lambda k: (round(abs(normal[k]), 9), k))
        a, b = axes or ((2, 1), (0, 2), (0, 1))[axis]
        low = [min(points[i][k] for i in face) for k in range(3)]
        size = [max(points[i][k] for i in face) - low[k] or 1.0 for k in range(3)]
        corners = []
        for i in face:
            s, t = ((points[i][k] - low[k]) / size[k] for k in (a, b))
            # Right-handed pictures: u runs to the viewer's right on each side.
            if (a == 0 and normal[2] < 0) or (a == 2 and normal[0] > 0):
                s = 1 - s
            t = 1 - t if b == 1 else t
            corners.append((u0 + (u1 - u0) * s, v0 + (v1 - v0) * t))
        result.append(corners)
    return result


def box(material, low, high, rect=None):
    """An axis-aligned box; `rect` stretches a rectangle of the texture over each face."""
    if not all(a < b for a, b in zip(low, high)):
        raise ValueError(f"empty box from {low} to {high}")
    points = [tuple((low, high)[i >> k & 1][k] for k in range(3)) for i in range(8)]
    faces = list(_BOX_FACES)
    return Part(material, points, faces, rect_uvs(points, faces, rect) if rect else None)


def box_at(material, center_x, bottom, center_z, size, rect=None):
    """A box given by the middle of its bottom face and its size (x, y, z)."""
    half_x, half_z = size[0] / 2, size[2] / 2
    return box(material, (center_x - half_x, bottom, center_z - half_z),
               (center_x + half_x, bottom + size[1], center_z + half_z), rect)


def cushion(material, low, high, bevel):
    """A box with bevelled edges and corners, shaded smoothly."""
    points, at = [], {}
    for i in range(8):
        for face_axis in range(3):
            p = []
            for k in range(3):
                inset = 0 if k == face_axis else bevel
                p.append(high[k] - inset if i >> k & 1 else low[k] + inset)
            at[i, face_axis] = len(points)
            points.append(tuple(p))
    faces = []
    for axis, (first, second) in enumerate(zip(_BOX_FACES[0::2], _BOX_FACES[1::2])):
        faces += [tuple(at[i, axis] for i in first), tuple(at[i, axis] for i in second)]
    for along in range(3):
        a, b = (k for k in range(3) if k != along)
        for i in range(8):
            if not i >> along & 1:
                j = i | 1 << along
                faces.append((at[i, a], at[j, a], at[j, b], at[i, b]))
    faces += [(at[i, 0], at[i, 1], at[i, 2]) for i in range(8)]
    center = tuple((a + b) / 2 for a, b in zip(low, high))
    faces = [f if dot(area_vector(points, f), sub(points[f[0]], center)) > 0 else f[::-1]
             for f in faces]
    return Part(material, points, faces, crease=0.5)


def _is_level(points, face):
    return abs(unit(area_vector(points, face))[1]) > 0.9


def _outward(points, faces, uvs):
    if signed_volume(points, faces) < 0:
        return [f[::-1] for f in faces], [u[::-1] for u in uvs]
    return faces, uvs


def lathe(material, profile, segments, rect=None, ring=False, crease=0.45):
    """Turn `profile`, [(radius, y)], about the y axis.

    An open profile starts and ends on the axis (radius 0); with `ring` it is a loop off the axis.
    """
    tile_u, tile_v = textures.tile_size(material)
    lengths = [0.0]
    loop = profile + profile[:1] if ring else profile
    for (r0, y0), (r1, y1) in zip(loop, loop[1:]):
        lengths.append(lengths[-1] + math.sqrt((r1 - r0) * (r1 - r0) + (y1 - y0) * (y1 - y0)))
    widest = max(r for r, _ in profile)
    turns = max(1, round(2 * math.pi * widest / tile_u))

    def uv(column, row):
        s, t = column / segments, lengths[row] / lengths[-1]
        if rect:
            return (rect[0] + (rect[2] - rect[0]) * s, rect[1] + (rect[3] - rect[1]) * t)
        return (turns * s, -lengths[row] / tile_v)

    circle = [sin_cos(360 * i / segments) for i in range(segments)]
    points, start = [], []
    for r, y in profile:
        start.append(len(points))
        points += [(0.0, y, 0.0)] if r == 0 else [(r * c, y, r * s) for s, c in circle]
    faces, uvs = [], []
    rows = len(profile)
    for row in range(rows if ring else rows - 1):
        after = (row + 1) % rows
        for i in range(segments):
            j = (i + 1) % segments
            corners = [(row, i, i, row), (after, i, i, row + 1), (after, j, i + 1, row + 1),
                       (row, j, i + 1, row)]
            if profile[row][0] == 0:
                corners = [corners[0], corners[1], corners[2]]
            elif profile[after][0] == 0:
                corners = [corners[0], corners[1], corners[3]]
            faces.append(tuple(start[k] + (0 if profile[k][0] == 0 else column)
                               for k, column, _, _ in corners))
            uvs.append([uv(column, length_row) for _, _, column, length_row in corners])
    faces, uvs = _outward(points, faces, uvs)
    if material in textures.GRAINED:
        # A turned board shows straight grain on its flat sides, not rings.
        flat = planar_uvs(material, points, faces)
        uvs = [flat[i] if _is_level(points, f) else uvs[i] for i, f in enumerate(faces)]
    return Part(material, points, faces, uvs, crease)


def cylinder(material, radius, low, high, segments, rect=None):
    return lathe(material, [(0.0, low), (radius, low), (radius, high), (0.0, high)], segments, rect)


def ellipsoid(material, radii, rings, segments, rect=None):
    """An ellipsoid about the origin, poles on the y axis."""
    profile = []
    for i in range(rings + 1):
        s, c = sin_cos(180 * i / rings)
        profile.append((0.0 if i in (0, rings) else s, -c))
    part = lathe(material, profile, segments, rect, crease=0.2)
    part.points = [(p[0] * radii[0], p[1] * radii[1], p[2] * radii[2]) for p in part.points]
    return part


def tube(material, path, radius, segments):
    """A round tube along a polyline that stays in one plane x = constant, with flat ends."""
    tile_u, tile_v = textures.tile_size(material)
    points, rings, along = [], [], 0.0
    for i, p in enumerate(path):
        before, after = path[max(i - 1, 0)], path[min(i + 1, len(path) - 1)]
        forward = unit(sub(after, before))
        side = (1.0, 0.0, 0.0)
        up = cross(side, forward)
        if i:
            step = sub(p, before)
            along += math.sqrt(dot(step, step))
        rings.append((len(points), along))
        for k in range(segments):
            s, c = sin_cos(360 * k / segments)
            points.append(tuple(p[m] + radius * (c * side[m] + s * up[m]) for m in range(3)))
    faces, uvs = [], []
    for (base, a), (next_base, b) in zip(rings, rings[1:]):
        for k in range(segments):
            j = (k + 1) % segments
            faces.append((base + k, base + j, next_base + j, next_base + k))
            uvs.append([(k / segments, a / tile_v), ((k + 1) / segments, a / tile_v),
                        ((k + 1) / segments, b / tile_v), (k / segments, b / tile_v)])
    last = rings[-1][0]
    for face in (tuple(range(segments))[::-1], tuple(range(last, last + segments))):
        faces.append(face)
        uvs.append([(points[i][0] / tile_u, points[i][2] / tile_v) for i in face])
    faces, uvs = _outward(points, faces, uvs)
    return Part(material, points, faces, uvs, crease=0.45)


def prism_x(material, outline, low_x, high_x):
    """A convex outline [(z, y)] drawn out along x."""
    count = len(outline)
    points = [(x, y, z) for x in (low_x, high_x) for z, y in outline]
    faces = [tuple(range(count)), tuple(range(count, 2 * count))[::-1]]
    for i in range(count):
        j = (i + 1) % count
        faces.append((j, i, i + count, j + count))
    if signed_volume(points, faces) < 0:
        faces = [f[::-1] for f in faces]
    return Part(material, points, faces)


def rectilinear(material, cuts_x, cuts_y, cuts_z, is_solid):
    """The boundary of the cells of a grid for which is_solid(i, j, k); solids meet in faces only."""
    cuts = (cuts_x, cuts_y, cuts_z)
    counts = tuple(len(c) - 1 for c in cuts)

    def solid(cell):
        return all(0 <= c < n for c, n in zip(cell, counts)) and is_solid(*cell)

    points, index_of, faces = [], {}, []

    def point(corner):
        if corner not in index_of:
            index_of[corner] = len(points)
            points.append(tuple(cuts[k][corner[k]] for k in range(3)))
        return index_of[corner]

    cells = [(i, j, k) for i in range(counts[0]) for j in range(counts[1]) for k in range(counts[2])]
    for cell in cells:
        if not solid(cell):
            continue
        for side, face in enumerate(_BOX_FACES):
            axis, direction = side // 2, (-1, 1)[side % 2]
            beside = tuple(c + (direction if k == axis else 0) for k, c in enumerate(cell))
            if not solid(beside):
                faces.append(tuple(point(tuple(cell[k] + (i >> k & 1) for k in range(3)))
                                   for i in face))
    return Part(material, points, faces)


def moved(part, offset=(0.0, 0.0, 0.0), about_x=0.0, about_y=0.0, about_z=0.0):
    """Return the part turned about x, then y, then z (degrees), then shifted."""
    points = part.points
    for degrees, (a, b) in ((about_x, (1, 2)), (about_y, (2, 0)), (about_z, (0, 1))):
        if degrees:
            s, c = sin_cos(degrees)
            turned = []
            for p in points:
                q = list(p)
                q[a], q[b] = c * p[a] - s * p[b], s * p[a] + c * p[b]
                turned.append(tuple(q))
            points = turned
    points = [tuple(p[k] + offset[k] for k in range(3)) for p in points]
    return Part(part.material, points, part.faces, part.uvs, part.crease)
