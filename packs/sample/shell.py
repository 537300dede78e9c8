"""The building: floors, ceilings, walls, doors, windows, beams, loft and stairs."""

import layout as L
from glb_writer import Mesh, yaw
from shapes import box, box_at, cylinder, moved, prism_x, rectilinear, tube
from textures import window_view_rect

_CASING = (0.068, 0.014)
_LEAF = 0.041


def _cuts(low, high, inner):
    return [low] + sorted(v for v in set(inner) if low < v < high) + [high]


def _wall(low, high, openings=()):
    """One closed slab; it runs along its longer side in plan, and so do its openings."""
    along = 0 if high[0] - low[0] > high[2] - low[2] else 2
    cuts = [[low[k], high[k]] for k in range(3)]
    cuts[along] = _cuts(low[along], high[along], [v for o in openings for v in (o.start, o.end)])
    cuts[1] = _cuts(low[1], high[1], [v for o in openings for v in (o.bottom, o.top)])

    def is_solid(i, j, k):
        a, y = cuts[along][i if along == 0 else k], cuts[1][j]
        return not any(o.start <= a < o.end and o.bottom <= y < o.top for o in openings)
    return rectilinear("plaster", *cuts, is_solid)


def _slabs():
    """Return {name: part} of floors, ceilings and walls; together they close the building."""
    a, b, c, out = L.ROOM_A, L.ROOM_B, L.CORRIDOR, L.OUTSIDE
    west, east, north, south = a.low[0], b.high[0], a.low[2], a.high[2]
    middle, hall, bedroom = a.high[0], c.high[2], b.low[2]
    seam_x, seam_z = (a.high[0] + b.low[0]) / 2, (hall + bedroom) / 2
    low, high, under = L.LOW_CEILING, L.HIGH_CEILING, out.low[1]
    over = L.CEILING_THICKNESS
    tiled = L.TILED_NORTH_OF
    return {
        "floor/kitchen": box("tiles", (out.low[0], under, out.low[2]), (seam_x, 0.0, tiled)),
        "floor/living": box("planks", (out.low[0], under, tiled), (seam_x, 0.0, out.high[2])),
        "floor/corridor": box("tiles", (seam_x, under, out.low[2]), (out.high[0], 0.0, seam_z)),
        "floor/bedroom": box("planks", (seam_x, under, seam_z), (out.high[0], 0.0, out.high[2])),
        "ceiling/room_a": box("plaster", (out.low[0], low, out.low[2]), (middle, low + over, out.high[2])),
        "ceiling/corridor": box("plaster", (middle, low, out.low[2]), (out.high[0], low + over, hall)),
        "ceiling/room_b": box("plaster", (middle, high, hall), (out.high[0], out.high[1], out.high[2])),
        "wall/west": _wall((out.low[0], 0.0, out.low[2]), (west, low, out.high[2]), L.WINDOWS_A),
        "wall/north": _wall((west, 0.0, out.low[2]), (east, low, north)),
        "wall/east_corridor": _wall((east, 0.0, out.low[2]), (out.high[0], low, hall), (L.DOOR_ENTRANCE,)),
        "wall/east_bedroom": _wall((east, 0.0, hall), (out.high[0], high, out.high[2]),
                                   (L.WINDOW_B, L.WINDOW_LOFT)),
        "wall/south_living": _wall((west, 0.0, south), (middle, low, out.high[2])),
        "wall/south_bedroom": _wall((middle, 0.0, south), (east, high, out.high[2])),
        "wall/living_corridor": _wall((middle, 0.0, north), (b.low[0], low, hall), (L.DOOR_A,)),
        "wall/living_bedroom": _wall((middle, 0.0, hall), (b.low[0], high, south)),
        "wall/corridor_bedroom": _wall((b.low[0], 0.0, hall), (east, high, bedroom), (L.DOOR_B,)),
    }


def _casing():
    """Around one side of a doorway. Frame: the opening's middle on the floor, +z out of the wall."""
    half, (width, depth) = L.DOOR_WIDTH / 2, _CASING
    top = L.DOOR_HEIGHT + width
    return Mesh("door_casing", [
        box("oak", (-half - width, 0.0, 0.0), (-half, top, depth)),
        box("oak", (half, 0.0, 0.0), (half + width, top, depth)),
        box("oak", (-half, L.DOOR_HEIGHT, 0.0), (half, top, depth))])


def _leaf():
    """A door leaf with panels and handles. Frame: the hinge's foot, the leaf along +x."""
    half, parts = _LEAF / 2, []
    parts.append(box("oak", (0.0, 0.0, -half), (L.DOOR_WIDTH, L.DOOR_HEIGHT, half)))
    for side in (-1, 1):
        for bottom, top in ((0.163, 0.893), (1.087, 1.887)):
            z = sorted((side * half, side * (half + 0.007)))
            parts.append(box("lacquer", (0.131, bottom, z[0]), (L.DOOR_WIDTH - 0.131, top, z[1])))
        stem = moved(cylinder("steel", 0.009, 0.0, 0.047, 6), (0.837, 1.013, side * half),
                     about_x=90 * side)
        z = sorted((side * (half + 0.038), side * (half + 0.055)))
        parts += [stem, box("steel", (0.728, 1.003, z[0]), (0.848, 1.023, z[1]))]
    return Mesh("door_leaf", parts)


def _window(width, height, wall):
    """Frame, pane and sill. Frame: middle of the opening's lower edge, +z towards the room."""
    half, bar, deep = width / 2, 0.053, 0.029
    parts = [box("lacquer", (-half, 0.0, -deep), (half, bar, deep)),
             box("lacquer", (-half, height - bar, -deep), (half, height, deep))]
    for x in (-half, half - bar, -bar / 2):
        parts.append(box("lacquer", (x, bar, -deep), (x + bar, height - bar, deep)))
    panes = ((-half + bar, -bar / 2), (bar / 2, half - bar))
    for x0, x1 in panes:
        parts.append(box("prints", (x0, bar, -0.006), (x1, height - bar, 0.006), window_view_rect()))
    parts.append(box("oak", (-half - 0.041, -0.027, wall / 2), (half + 0.041, 0.0, wall / 2 + 0.087)))
    return Mesh("window", parts)


def _skirting(room, name, gaps):
    """Boards along the foot of a room's walls, interrupted at `gaps`: {side: [(start, end)]}."""
    (x0, _, z0), (x1, _, z1) = room.low, room.high
    thick, high, parts = 0.013, 0.077, []
    sides = {"north": (x0, x1), "south": (x0, x1), "west": (z0 + thick, z1 - thick),
             "east": (z0 + thick, z1 - thick)}
    for side, (start, end) in sides.items():
        for gap_start, gap_end in sorted(gaps.get(side, [])) + [(end, end)]:
            if gap_start > start:
                low, high_corner = {
                    "north": ((start, 0.0, z0), (gap_start, high, z0 + thick)),
                    "south": ((start, 0.0, z1 - thick), (gap_start, high, z1)),
                    "west": ((x0, 0.0, start), (x0 + thick, high, gap_start)),
                    "east": ((x1 - thick, 0.0, start), (x1, high, gap_start))}[side]
                parts.append(box("oak", low, high_corner))
            start = max(start, gap_end)
    return Mesh(f"skirting_{name}", parts)


def _add_doors(shell):
    casing, leaf = _casing(), _leaf()
    a, b, c = L.ROOM_A, L.ROOM_B, L.CORRIDOR
    for door, opening, sides in (
            ("door_a", L.DOOR_A, ((a.high[0], -90, "z"), (b.low[0], 90, "z"))),
            ("door_b", L.DOOR_B, ((c.high[2], 180, "x"), (b.low[2], 0, "x"))),
            ("door_entrance", L.DOOR_ENTRANCE, ((c.high[0], -90, "z"),))):
        node, middle = shell.add(door), (opening.start + opening.end) / 2
        for i, (plane, turn, along) in enumerate(sides):
            at = (plane, 0.0, middle) if along == "z" else (middle, 0.0, plane)
            node.add_part(f"casing_{i}", casing, at=at, rotation=yaw(turn))
        if door == "door_entrance":
            node.add_part("leaf", leaf, at=(c.high[0] + L.OUTER_WALL / 2, 0.0, opening.start),
                          rotation=yaw(-90))
        elif door == "door_a":
            # Open into room A, almost against the wall.
            node.add_part("leaf", leaf, at=(a.high[0] - 0.052, 0.007, opening.end + 0.013),
                          rotation=yaw(-101.3))
        else:
            node.add_part("leaf", leaf, at=(opening.end + 0.013, 0.007, c.high[2] - 0.052),
                          rotation=yaw(14.7))


def _add_windows(shell):
    mesh = _window(L.WINDOW_WIDTH, L.WINDOW_HEIGHT, L.OUTER_WALL)
    west = L.ROOM_A.low[0] - L.OUTER_WALL / 2
    east = L.ROOM_B.high[0] + L.OUTER_WALL / 2
    for name, opening, x, turn in (
            ("window_dining", L.WINDOWS_A[0], west, 90),
            ("window_living", L.WINDOWS_A[1], west, 90),
            ("window_bedroom", L.WINDOW_B, east, -90),
            ("window_loft", L.WINDOW_LOFT, east, -90)):
        # The mesh fits the wide windows; the loft's is the same one made smaller.
        scale = ((opening.end - opening.start) / L.WINDOW_WIDTH,
                 (opening.top - opening.bottom) / L.WINDOW_HEIGHT, 1.0)
        shell.add(name, mesh, at=(x, opening.bottom, (opening.start + opening.end) / 2),
                  rotation=yaw(turn), scale=scale)


def _add_stairs(room):
    inner = L.STAIR_WIDTH - 2 * L.STAIR_STRINGER
    step = Mesh("stair_step", [
        box("oak", (-inner / 2, -L.STAIR_TREAD, -L.STAIR_NOSING), (inner / 2, 0.0, L.STAIR_RUN)),
        box("lacquer", (-inner / 2, -L.STAIR_RISE, 0.0), (inner / 2, -L.STAIR_TREAD, 0.017))])
    length, slope = L.STAIR_STEPS * L.STAIR_RUN, L.STAIR_RISE / L.STAIR_RUN
    foot = 0.012
    stringer = Mesh("stair_stringer", [prism_x("walnut", [
        (foot, 0.0), (foot, slope * foot + 0.113), (length, slope * length + 0.113),
        (length, slope * length - 0.127), (0.127 / slope, 0.0)], 0.0, L.STAIR_STRINGER)])
    rail = Mesh("stair_handrail", [
        tube("walnut", [(0.0, 0.93, 0.05), (0.0, slope * length + 0.88, length - 0.02)], 0.021, 8)])
    post = Mesh("stair_post", [cylinder("steel", 0.013, 0.0, 0.81, 8)])
    stairs = room.add("stairs", at=(L.STAIR_WEST, 0.0, L.STAIR_NORTH))
    for i in range(L.STAIR_STEPS):
        stairs.add_part(f"step_{i}", step,
                        at=(L.STAIR_WIDTH / 2, (i + 1) * L.STAIR_RISE, i * L.STAIR_RUN))
    east = L.STAIR_WIDTH - L.STAIR_STRINGER
    stairs.add_part("stringer_west", stringer)
    stairs.add_part("stringer_east", stringer, at=(east, 0.0, 0.0))
    stairs.add_part("handrail", rail, at=(east + L.STAIR_STRINGER / 2, 0.0, 0.0))
    for i, z in enumerate((0.117, 1.003, 1.877)):
        stairs.add_part(f"post_{i}", post,
                        at=(east + L.STAIR_STRINGER / 2, slope * z + 0.087, z))


def _add_loft(room):
    loft = room.add("loft")
    loft.add_part("platform", Mesh("loft_platform", [box("planks", *L.LOFT)]))
    start = L.STAIR_WEST + L.STAIR_WIDTH + 0.023
    end, z = L.LOFT.high[0] - 0.003, L.LOFT_NORTH + 0.047
    support = Mesh("loft_support", [
        box_at("walnut", 0.0, 0.0, 0.0, (0.093, L.LOFT_TOP - L.LOFT_SLAB, 0.093))])
    baluster = Mesh("loft_baluster", [
        box_at("steel", 0.0, 0.0, 0.0, (0.019, L.RAIL_HEIGHT - 0.041, 0.019))])
    rail = Mesh("loft_rail", [
        box("walnut", (start, 0.0, z - 0.033), (end, 0.041, z + 0.033))])
    loft.add_part("support_0", support, at=(start + 0.047, 0.0, z))
    loft.add_part("support_1", support, at=(end - 0.061, 0.0, z))
    loft.add_part("rail", rail, at=(0.0, L.LOFT_TOP + L.RAIL_HEIGHT - 0.041, 0.0))
    count = 17
    for i in range(count):
        x = start + 0.017 + (end - start - 0.034) * i / (count - 1)
        loft.add_part(f"baluster_{i:02d}", baluster, at=(x, L.LOFT_TOP, z))


def build(root):
    """Add the building to the scene's root; return {room name: node for its furniture}."""
    shell = root.add("shell")
    for name, part in _slabs().items():
        shell.add(name, Mesh(name.replace("/", "_"), [part]))
    _add_doors(shell)
    _add_windows(shell)
    width, height = L.BEAM_SIZE
    beam = Mesh("ceiling_beam", [box("walnut", (L.ROOM_A.low[0], -height, -width / 2),
                                     (L.ROOM_A.high[0], 0.0, width / 2))])
    for i, z in enumerate(L.BEAMS_Z):
        shell.add(f"beam_{i}", beam, at=(0.0, L.LOW_CEILING, z))
    trim = _CASING[0]
    door_a = (L.DOOR_A.start - trim, L.DOOR_A.end + trim)
    door_b = (L.DOOR_B.start - trim, L.DOOR_B.end + trim)
    entrance = (L.DOOR_ENTRANCE.start - trim, L.DOOR_ENTRANCE.end + trim)
    kitchen_end = L.COUNTER_X + L.COUNTER_LENGTH / 2
    for name, gaps in (
            ("room_a", {"east": [door_a], "north": [(L.ROOM_A.low[0], kitchen_end)],
                        "west": [(L.ROOM_A.low[2], L.COUNTER_Z + L.COUNTER_DEPTH)]}),
            ("corridor", {"west": [door_a], "east": [entrance], "south": [door_b]}),
            ("room_b", {"north": [door_b]})):
        shell.add(f"skirting/{name}", _skirting(L.ROOMS[name], name, gaps))
    rooms = {name: root.add(name) for name in L.ROOMS}
    _add_stairs(rooms["room_b"])
    _add_loft(rooms["room_b"])
    return rooms
