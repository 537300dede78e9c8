"""The ground truth of landmarks.json, derived from the layout and measured on the finished GLB.

Heights and boxes come from layout.py; clearances are measured on the triangles by brute force. The
two must agree, else the generator stops.
"""

import geometry
import glb_reader
import layout as L

# A landmark may not lie so near to touching that rounding could decide: meters.
_DECISION_MARGIN = 0.004
_HEIGHT_TOLERANCE = 2e-6  # positions are rounded to a micrometer, then to float32


def _middle(box):
    return tuple((a + b) / 2 for a, b in zip(box.low, box.high))


def seeds():
    """A point free for the largest sphere in each connected space, {name: (point, component)}."""
    a, b, c = L.ROOM_A, L.ROOM_B, L.CORRIDOR
    stairs_east, bed_west = L.STAIR_WEST + L.STAIR_WIDTH, L.BED_AT[0] - L.BED_SIZE[0] / 2
    return {
        "room_a": ((a.high[0] - 1.103, 1.237, a.low[2] + 0.903), "interior"),
        "corridor": (_middle(c), "interior"),
        "room_b": (((stairs_east + bed_west) / 2, 1.097, 0.107), "interior"),
        "loft": ((b.low[0] + 0.763, L.LOFT_TOP + 0.613, (L.LOFT_NORTH + b.high[2]) / 2), "interior"),
        "under_loft": ((b.low[0] + 0.503, 0.837, L.LOFT_NORTH + 0.503), "interior"),
        "cabinet": (_middle(L.CABINET_CAVITY), "cabinet"),
        "outside": ((L.OUTSIDE.low[0] - 1.013, 1.097, 0.107), "outside"),
    }


def _probes():
    """More points, free for some radii only or for none, {name: point}."""
    a, b = L.ROOM_A, L.ROOM_B
    sink_x, sink_z = L.COUNTER_X + L.SINK_X, L.COUNTER_Z + L.SINK_Z + L.SINK_SIZE[1] / 2
    table_x, table_z = L.TABLE_AT
    door_z = (L.DOOR_A.start + L.DOOR_A.end) / 2 + 0.007
    door_x = a.high[0] + 0.37 * L.INNER_WALL
    shelf_front = L.SHELF_AT[0] - L.SHELF_SIZE[2] / 2
    between = (L.shelf_board_bottom(5) + L.SHELF_BOARD + L.shelf_board_bottom(6)) / 2
    fridge_gap = L.FRIDGE_X - L.FRIDGE_SIZE[0] / 2 - 0.0085
    stair_x = L.STAIR_WEST + L.STAIR_WIDTH / 2
    return {
        "doorway_a_middle": (door_x, 1.003, door_z),
        "doorway_a_under_lintel": (door_x, L.DOOR_HEIGHT - 0.083, door_z),
        "doorway_b_at_jamb": (L.DOOR_B.start + 0.033, 1.003, L.ROOM_B.low[2] - 0.37 * L.INNER_WALL),
        "wall_core": (a.high[0] + 0.3 * L.INNER_WALL, 1.203, 0.507),
        "floor_core": (-0.713, -L.FLOOR_THICKNESS / 2, 0.117),
        "beam_core": (-1.013, L.LOW_CEILING - L.BEAM_SIZE[1] / 2, L.BEAMS_Z[0] + 0.007),
        "under_beam": (-1.013, L.LOW_CEILING - L.BEAM_SIZE[1] - 0.083, L.BEAMS_Z[0] + 0.007),
        "above_beam_side": (-1.013, L.LOW_CEILING - 0.083, L.BEAMS_Z[0] + L.BEAM_SIZE[0] / 2 + 0.083),
        "under_table": (table_x + 0.013, 0.303, table_z + 0.019),
        "on_table": (table_x + 0.013, L.TABLE_SIZE[1] + 0.067, table_z - 0.243),
        "table_core": (table_x + 0.013, L.TABLE_SIZE[1] - L.TABLE_SLAB / 4, table_z + 0.019),
        "inside_pendant_shade": (table_x + 0.107, L.LOW_CEILING - 0.887 + 0.041, table_z + 0.009),
        "in_sink": (sink_x + 0.017, L.SINK_FLOOR + 0.093, sink_z + 0.011),
        "under_basin_in_counter": (sink_x + 0.017, L.SINK_FLOOR - 0.203, sink_z + 0.011),
        "counter_to_fridge_gap": (fridge_gap, 0.603, L.COUNTER_Z + 0.303),
        "under_sofa": (L.SOFA_AT[0] + 0.107, 0.0655, L.SOFA_AT[1] + 0.013),
        "bookshelf_free_compartment": (shelf_front + 0.051, between, L.SHELF_AT[1] + 0.013),
        "bookshelf_front_of_books": (shelf_front + 0.035, L.shelf_board_bottom(4) + 0.107, L.SHELF_AT[1] - 0.203),
        "under_bed": (L.BED_AT[0] + 0.013, L.BED_CLEARANCE / 2, L.BED_AT[1] + 0.107),
        "mattress_core": (L.BED_AT[0] + 0.013, L.BED_MATTRESS_TOP - 0.093, L.BED_AT[1] - 0.157),
        "over_stair_3": (stair_x + 0.013, 4 * L.STAIR_RISE + 0.093, L.STAIR_NORTH + 3.6 * L.STAIR_RUN),
        "under_stairs": (stair_x + 0.013, 0.427, L.STAIR_NORTH + 6.3 * L.STAIR_RUN),
        "loft_core": (_middle(L.LOFT)[0] + 0.013, L.LOFT_TOP - 0.061, _middle(L.LOFT)[2] + 0.017),
        "loft_ceiling": (b.low[0] + 0.763, L.HIGH_CEILING - 0.083, 2.003),
        "cabinet_corner": tuple(v + 0.031 for v in L.CABINET_CAVITY.low),
        "above_roof": (-1.013, L.LOW_CEILING + L.CEILING_THICKNESS + 0.503, 0.117),
    }


def _component(p, solid):
    if solid:
        return "solid"
    if L.CABINET_CAVITY.contains(p):
        return "cabinet"
    doorways = (L.Box((L.ROOM_A.high[0], 0.0, L.DOOR_A.start), (L.ROOM_B.low[0], L.DOOR_A.top, L.DOOR_A.end)),
                L.Box((L.DOOR_B.start, 0.0, L.CORRIDOR.high[2]), (L.DOOR_B.end, L.DOOR_B.top, L.ROOM_B.low[2])))
    inside = any(box.contains(p) for box in tuple(L.ROOMS.values()) + doorways)
    return "interior" if inside else "outside"


def _points(parts):
    listed = {f"seed_{name}": point for name, (point, _) in seeds().items()} | _probes()
    result = []
    for name, p in listed.items():
        p = tuple(round(v, 6) for v in p)
        distance, nearest = geometry.clearance(p, parts)
        solid = geometry.inside_solid(p, parts)
        if any(abs(distance - r) < _DECISION_MARGIN for r in L.RADII):
            raise ValueError(f"landmark {name}: a clearance of {distance:.6f} is too near a radius")
        result.append({"name": name, "position": list(p), "clearance": round(distance, 6),
                       "nearest": nearest, "component": _component(p, solid),
                       "free": {str(r): not solid and distance > r for r in L.RADII}})
    for name, (_, component) in seeds().items():
        entry = next(e for e in result if e["name"] == f"seed_{name}")
        if entry["component"] != component or not all(entry["free"].values()):
            raise ValueError(f"the seed of {name} is not free: {entry}")
    return result


def _shelf_column():
    """x and z of a column in front of the books, over all ten boards."""
    return L.SHELF_AT[0] - L.SHELF_SIZE[2] / 2 + 0.037, L.SHELF_AT[1] + 0.0137


def _supports():
    """{name: (x, z, height)}: upper surfaces, from the numbers that built them."""
    a = L.ROOM_A
    table_x, table_z = L.TABLE_AT
    sink_z = L.COUNTER_Z + L.SINK_Z + L.SINK_SIZE[1] / 2
    stair_x = L.STAIR_WEST + L.STAIR_WIDTH / 2 + 0.0173
    coffee_x, coffee_z = L.COFFEE_TABLE_AT
    result = {
        "floor_living": (-0.813, 0.1173, 0.0), "floor_kitchen": (-0.713, -1.913, 0.0),
        "floor_corridor": (1.013, -1.813, 0.0), "floor_bedroom": (2.213, 0.0173, 0.0),
        "table_top": (table_x + 0.0137, table_z + 0.3091, L.TABLE_SIZE[1]),
        "counter_top": (L.COUNTER_X + 0.0237, L.COUNTER_Z + 0.3113, L.COUNTER_TOP),
        "sink_floor": (L.COUNTER_X + L.SINK_X + 0.1137, sink_z + 0.0611, L.SINK_FLOOR),
        "wall_cupboard_top": (L.COUNTER_X - 0.5137, L.COUNTER_Z + 0.1171, L.CUPBOARD_TOP),
        "fridge_top": (L.FRIDGE_X + 0.0731, L.COUNTER_Z + 0.2173, L.FRIDGE_SIZE[1]),
        "sofa_seat": (L.SOFA_AT[0] + 0.0137, L.SOFA_AT[1] - 0.2173, L.SOFA_SEAT),
        "coffee_table_top": (coffee_x + 0.0537, coffee_z + 0.0919, L.RUG_THICKNESS + L.COFFEE_TABLE_TOP),
        "rug": (coffee_x + 0.6137, coffee_z + 0.3173, L.RUG_THICKNESS),
        "bench_top": (L.BENCH_AT[0] + 0.0137, L.BENCH_AT[1] + 0.0573, L.BENCH_SIZE[1]),
        "loft_top": (L.ROOM_B.low[0] + 0.7137, 1.9173, L.LOFT_TOP),
        "loft_side_table_top": (2.437 + 0.0337, 2.531 + 0.0519,
                                L.LOFT_TOP + L.RUG_THICKNESS + 1.19 * L.COFFEE_TABLE_TOP),
        "cabinet_top": (L.CABINET_AT[0] + 0.1137, L.CABINET_AT[1] + 0.0571, L.CABINET_SIZE[1]),
        "cabinet_inner_floor": (L.CABINET_AT[0] + 0.1137, L.CABINET_AT[1] + 0.0571, L.CABINET_CAVITY.low[1]),
        "roof": (a.low[0] + 1.0137, 0.1173, L.LOW_CEILING + L.CEILING_THICKNESS),
    }
    for i in range(L.STAIR_STEPS):
        result[f"stair_{i}"] = (stair_x, L.STAIR_NORTH + (i + 0.61) * L.STAIR_RUN, (i + 1) * L.STAIR_RISE)
    for i in range(L.SHELF_BOARDS):
        result[f"bookshelf_board_{i:02d}"] = _shelf_column() + (L.shelf_board_bottom(i) + L.SHELF_BOARD,)
    return result


def _measured_supports(parts):
    """Check each support against the triangles; add the free height above it."""
    result, columns = [], {}
    for name, (x, z, height) in _supports().items():
        key = (round(x, 6), round(z, 6))
        if key not in columns:
            columns[key] = geometry.crossings(*key, parts)
        hits = columns[key]
        if not any(facing > 0 and abs(y - height) < _HEIGHT_TOLERANCE for y, facing in hits):
            raise ValueError(f"support {name}: nothing at {height} in {hits}")
        above = [y for y, facing in hits if facing < 0 and y > height + _HEIGHT_TOLERANCE]
        result.append({"name": name, "x": key[0], "z": key[1], "height": round(height, 6),
                       "clear_above": round(above[0] - height, 6) if above else None})
    return result, [{"x": x, "z": z, "crossings": [[round(y, 6), facing] for y, facing in hits]}
                    for (x, z), hits in columns.items()]


def _box_json(box):
    return {"min": [round(v, 6) for v in box.low], "max": [round(v, 6) for v in box.high],
            "volume": round(box.volume(), 6)}


def _rooms(parts):
    """Boxes of the rooms; `solids_volume` adds up the parts inside, overlaps counted twice."""
    solids = dict.fromkeys(L.ROOMS, 0.0)
    for _, triangles in parts:
        corners = [v for t in triangles for v in t]
        middle = tuple((min(v[k] for v in corners) + max(v[k] for v in corners)) / 2 for k in range(3))
        for name, room in L.ROOMS.items():
            if room.contains(middle):
                solids[name] += geometry.signed_volume(triangles)
    return [{"name": name, **_box_json(room), "solids_volume": round(solids[name], 4),
             "free_volume": round(room.volume() - solids[name], 4)} for name, room in L.ROOMS.items()]


def _views():
    """Good places for a camera: position, target and horizontal field of view."""
    views = (("living", (-0.213, 1.607, -2.297), (-2.603, 0.703, 1.597), 75.0),
             ("kitchen", (-0.997, 1.653, 0.897), (-2.703, 0.903, -2.897), 75.0),
             ("bookshelf", (-2.603, 1.503, 2.197), (0.597, 1.103, 1.197), 75.0),
             ("corridor", (0.953, 1.603, -2.297), (3.503, 1.003, -2.197), 85.0),
             ("bedroom", (1.803, 1.503, -1.203), (2.953, 0.603, 1.197), 90.0),
             ("stairs", (3.697, 2.203, -1.103), (1.297, 1.103, 2.197), 85.0),
             ("loft", (1.203, 2.903, 1.597), (3.503, 1.703, 2.597), 80.0))
    return [{"name": n, "position": list(p), "target": list(t), "fov_degrees": f} for n, p, t, f in views]


def _counts(document):
    def triangles(mesh):
        return sum(document["accessors"][p["indices"]]["count"] // 3 for p in mesh["primitives"])
    meshes = document["meshes"]
    return {"nodes": len(document["nodes"]), "meshes": len(meshes),
            "materials": len(document["materials"]), "images": len(document["images"]),
            "triangles_stored": sum(triangles(m) for m in meshes),
            "triangles_placed": sum(triangles(meshes[n["mesh"]]) for n in document["nodes"] if "mesh" in n)}


def derive(glb):
    """Return the content of landmarks.json for the bytes of the GLB just written."""
    document, blob = glb_reader.load(glb)
    parts = glb_reader.world_parts(document, blob)
    supports, columns = _measured_supports(parts)
    boards = [{"name": f"bookshelf/board_{i:02d}", "bottom": round(L.shelf_board_bottom(i), 6),
               "top": round(L.shelf_board_bottom(i) + L.SHELF_BOARD, 6)} for i in range(L.SHELF_BOARDS)]
    shelf_x, shelf_z = _shelf_column()
    return {
        "frame": "right-handed, Y up, meters; the floor is y = 0, north is -z, east is +x",
        "asset": "apartment.glb", "counts": _counts(document), "radii": list(L.RADII),
        "bounds": _box_json(L.OUTSIDE), "rooms": _rooms(parts),
        "cavities": [{"name": "cabinet", **_box_json(L.CABINET_CAVITY)}],
        "points": _points(parts), "supports": supports,
        "bookshelf": {"x": round(shelf_x, 6), "z": round(shelf_z, 6), "boards": boards},
        "columns": columns, "views": _views()}
