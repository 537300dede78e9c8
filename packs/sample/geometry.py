"""Questions to a triangle soup, answered by brute force: the reference for the landmarks."""

import math

from shapes import cross, dot, sub


def _segment_distance2(p, a, b):
    ab, ap = sub(b, a), sub(p, a)
    t = min(1.0, max(0.0, dot(ap, ab) / dot(ab, ab)))
    away = (ap[0] - t * ab[0], ap[1] - t * ab[1], ap[2] - t * ab[2])
    return dot(away, away)


def _triangle_distance2(p, triangle):
    a, b, c = triangle
    normal = cross(sub(b, a), sub(c, a))
    if all(dot(cross(sub(v, u), sub(p, u)), normal) >= 0 for u, v in ((a, b), (b, c), (c, a))):
        height = dot(sub(p, a), normal)
        return height * height / dot(normal, normal)
    return min(_segment_distance2(p, a, b), _segment_distance2(p, b, c), _segment_distance2(p, c, a))


def clearance(p, parts):
    """The distance from p to the nearest surface, and the name of the node it belongs to."""
    best, owner = math.inf, None
    for name, triangles in parts:
        gap2 = 0.0
        for k in range(3):
            low = min(v[k] for t in triangles for v in t)
            high = max(v[k] for t in triangles for v in t)
            gap = max(low - p[k], p[k] - high, 0.0)
            gap2 += gap * gap
        if gap2 >= best:
            continue
        for triangle in triangles:
            distance2 = _triangle_distance2(p, triangle)
            if distance2 < best:
                best, owner = distance2, name
    return math.sqrt(best), owner


def signed_volume(triangles):
    total = 0.0
    for a, b, c in triangles:
        total += dot(a, cross(b, c))
    return total / 6


def crossings(x, z, parts):
    """Where the vertical line through (x, z) meets surfaces: [(height, +1 up or -1 down facing)].

    Ascending. Raises ValueError where the line passes too near an edge to be sure.
    """
    found = []
    for name, triangles in parts:
        for a, b, c in triangles:
            if not (min(a[0], b[0], c[0]) <= x <= max(a[0], b[0], c[0])
                    and min(a[2], b[2], c[2]) <= z <= max(a[2], b[2], c[2])):
                continue
            weights = [(v[0] - x) * (w[2] - z) - (w[0] - x) * (v[2] - z)
                       for v, w in ((b, c), (c, a), (a, b))]
            area = weights[0] + weights[1] + weights[2]
            if abs(area) < 1e-12:
                continue
            shares = [w / area for w in weights]
            if min(shares) < -1e-6:
                continue
            if min(shares) < 1e-6:
                raise ValueError(f"the column at ({x}, {z}) meets an edge of {name}")
            height = shares[0] * a[1] + shares[1] * b[1] + shares[2] * c[1]
            # Seen from above, x right and z down: a positive area faces down.
            found.append((height, -1 if area > 0 else 1))
    return sorted(found)


def inside_solid(p, parts):
    """Whether p lies inside any closed part: an up-facing surface more above p than down-facing."""
    for part in parts:
        depth = 0
        for height, facing in crossings(p[0], p[2], [part]):
            if height > p[1]:
                depth += facing
        if depth > 0:
            return True
    return False
