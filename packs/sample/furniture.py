"""Meshes of the furniture. Frame of each: the middle of its footprint on the floor, front +z."""

import layout as L
from glb_writer import Mesh, product, quaternion, yaw
from shapes import (Part, box, box_at, cushion, ellipsoid, lathe, moved, rect_uvs,
                    rectilinear)
from textures import book_rects, swatch


def table(node):
    """Hang a top, an apron and four instances of one leg on `node`."""
    (width, height, depth), slab = L.TABLE_SIZE, L.TABLE_SLAB
    under, leg = height - slab, 0.063
    half_x, half_z = width / 2 - 0.057, depth / 2 - 0.053
    node.add_part("top", Mesh("table_top", [
        cushion("oak", (-width / 2, under, -depth / 2), (width / 2, height, depth / 2), 0.006)]))
    apron = [box("oak", (-half_x + leg / 2, under - 0.087, z - 0.011), (half_x - leg / 2, under, z + 0.011))
             for z in (-half_z, half_z)]
    apron += [box("oak", (x - 0.011, under - 0.087, -half_z + leg / 2), (x + 0.011, under, half_z - leg / 2))
              for x in (-half_x, half_x)]
    node.add_part("apron", Mesh("table_apron", apron))
    mesh = Mesh("table_leg", [box_at("oak", 0.0, 0.0, 0.0, (leg, under, leg))])
    for i, (x, z) in enumerate(((-1, -1), (1, -1), (1, 1), (-1, 1))):
        node.add_part(f"leg_{i}", mesh, at=(x * half_x, 0.0, z * half_z))


def chair():
    """A dining chair with a leaning back."""
    seat, leg, half_x, half_z = L.CHAIR_SEAT, 0.037, 0.197, 0.191
    parts = [cushion("blue_weave", (-0.207, seat - 0.041, -0.197), (0.207, seat, 0.213), 0.013),
             box_at("walnut", 0.0, seat - 0.083, 0.008, (0.394, 0.042, 0.386))]
    for x in (-half_x + leg / 2, half_x - leg / 2):
        for z in (-half_z + leg / 2 + 0.008, half_z - leg / 2 + 0.008):
            parts.append(box_at("walnut", x, 0.0, z, (leg, seat - 0.083, leg)))
    back = [box_at("walnut", x, -0.061, 0.0, (0.033, 0.503, 0.027)) for x in (-0.18, 0.18)]
    back += [box("walnut", (-0.1635, y, -0.009), (0.1635, y + 0.067, 0.009)) for y in (0.127, 0.237, 0.357)]
    parts += [moved(p, (0.0, seat, -0.2), about_x=-9.7) for p in back]
    return Mesh("chair", parts)


def sofa(node):
    """Hang a base, two arms, three seats, three backs and two pillows on `node`."""
    width, height, depth = L.SOFA_SIZE
    half, back, weave = width / 2, depth / 2, "blue_weave"
    arm, base, seat = 0.187, 0.131, L.SOFA_SEAT
    third = (width - 2 * arm) / 3
    feet = [box_at("walnut", x, 0.0, z, (0.057, base, 0.057))
            for x in (-half + 0.09, half - 0.09) for z in (-back + 0.09, back - 0.09)]
    node.add_part("base", Mesh("sofa_base", [
        box(weave, (-half + 0.01, base, -back + 0.01), (half - 0.01, 0.317, back - 0.03))] + feet))
    arm_mesh = Mesh("sofa_arm", [cushion(weave, (-arm / 2, base - 0.013, -back),
                                         (arm / 2, 0.613, back - 0.011), 0.037)])
    seat_mesh = Mesh("sofa_seat", [cushion(weave, (0.003 - third / 2, 0.311, -back + 0.207),
                                           (third / 2 - 0.003, seat, back), 0.033)])
    rest_mesh = Mesh("sofa_rest", [cushion(weave, (0.003 - third / 2, 0.0, -0.083),
                                           (third / 2 - 0.003, height - 0.317, 0.083), 0.041)])
    for i, side in enumerate((-1, 1)):
        node.add_part(f"arm_{i}", arm_mesh, at=(side * (half - arm / 2), 0.0, 0.0))
    for i in range(3):
        x = (i - 1) * third
        node.add_part(f"seat_{i}", seat_mesh, at=(x, 0.0, 0.0))
        node.add_part(f"rest_{i}", rest_mesh, at=(x, 0.321, -back + 0.177), rotation=quaternion("x", -10.3))
    for i, (x, turn, material) in enumerate(((-0.63, 17.0, "mustard_weave"), (0.587, -23.0, "linen"))):
        pillow = Mesh(f"pillow_{material}", [cushion(material, (-0.217, 0.0, -0.053), (0.217, 0.413, 0.053), 0.047)])
        node.add_part(f"pillow_{i}", pillow, at=(x, seat + 0.007, 0.057),
                      rotation=product(yaw(turn), quaternion("x", -19.0)))


def armchair():
    half, back, seat, weave = 0.383, 0.397, 0.431, "mustard_weave"
    parts = [box(weave, (-half + 0.05, 0.157, -back + 0.06), (half - 0.05, 0.297, back - 0.04))]
    for x0 in (-half, half - 0.127):
        parts.append(cushion(weave, (x0, 0.143, -back + 0.03), (x0 + 0.127, 0.577, back - 0.013), 0.041))
    parts.append(cushion(weave, (-half + 0.129, 0.291, -back + 0.15), (half - 0.129, seat, back), 0.037))
    rest = cushion(weave, (-half + 0.061, 0.0, -0.073), (half - 0.061, 0.603, 0.073), 0.047)
    parts.append(moved(rest, (0.0, 0.273, -back + 0.153), about_x=-13.0))
    for x in (-half + 0.09, half - 0.09):
        for z in (-back + 0.12, back - 0.09):
            parts.append(box_at("walnut", x, 0.0, z, (0.037, 0.161, 0.037)))
    return Mesh("armchair", parts)


def coffee_table():
    top, radius = L.COFFEE_TABLE_TOP, L.COFFEE_TABLE_RADIUS
    parts = [lathe("walnut", [(0.0, top - 0.029), (radius - 0.017, top - 0.029), (radius, top - 0.013),
                              (radius, top - 0.004), (radius - 0.004, top), (0.0, top)], 20)]
    leg = lathe("walnut", [(0.0, 0.0), (0.013, 0.0), (0.023, top - 0.033), (0.0, top - 0.033)], 6)
    for i in range(3):
        leaning = moved(leg, (0.0, 0.0027, 0.287), about_x=-11.7)
        parts.append(moved(leaning, about_y=120 * i + 20))
    return Mesh("coffee_table", parts)


def bookshelf(node):
    """Hang sides, back and ten instances of one board on `node`."""
    width, height, depth = L.SHELF_SIZE
    half, inner, back = width / 2, width / 2 - L.SHELF_SIDE, -depth / 2
    node.add_part("frame", Mesh("bookshelf_frame", [
        box("oak", (-half, 0.0, back), (-inner, height, -back)),
        box("oak", (inner, 0.0, back), (half, height, -back)),
        box("oak", (-inner, 0.0, back), (inner, height, back + L.SHELF_BACK)),
        box("oak", (-inner, 0.0, -back - 0.031), (inner, L.SHELF_FOOT, -back - 0.012))]))
    board = Mesh("bookshelf_board", [
        box("oak", (-inner, 0.0, back + L.SHELF_BACK), (inner, L.SHELF_BOARD, -back))])
    for i in range(L.SHELF_BOARDS):
        node.add_part(f"board_{i:02d}", board, at=(0.0, L.shelf_board_bottom(i), 0.0))


def book(index):
    """A closed book standing on its tail: x thickness, spine towards +z. Frame: back left foot."""
    spine, cover = book_rects(index)
    paper = swatch("cream")
    block = box("prints", (0.0, 0.0, 0.0), (0.031, 0.197, 0.143))
    rects = (cover, cover, paper, paper, paper, spine)
    uvs = [rect_uvs(block.points, [face], rect)[0] for face, rect in zip(block.faces, rects)]
    return Mesh(f"book_{index:02d}", [Part("prints", block.points, block.faces, uvs)])


BOOK_SIZE = (0.031, 0.197, 0.143)


def cabinet(node):
    """A closed, empty cabinet: six panels that leave a cavity, two doors on a stile."""
    (width, height, depth), t, feet = L.CABINET_SIZE, L.CABINET_PANEL, L.CABINET_FEET
    x, z, front = width / 2, depth / 2, depth / 2 - t
    stile, stile_depth = L.CABINET_STILE
    node.add_part("carcass", Mesh("cabinet_carcass", [
        box("walnut", (-x, feet, -z), (-x + t, height, front)),
        box("walnut", (x - t, feet, -z), (x, height, front)),
        box("walnut", (-x + t, feet, -z), (x - t, feet + t, front)),
        box("walnut", (-x + t, height - t, -z), (x - t, height, front)),
        box("walnut", (-x + t, feet + t, -z), (x - t, height - t, -z + t)),
        box("walnut", (-stile / 2, feet + t, front - stile_depth), (stile / 2, height - t, front))]))
    foot = Mesh("cabinet_foot", [box_at("walnut", 0.0, 0.0, 0.0, (0.049, feet, 0.049))])
    for i, (sx, sz) in enumerate(((-1, -1), (1, -1), (1, 1), (-1, 1))):
        node.add_part(f"foot_{i}", foot, at=(sx * (x - 0.061), 0.0, sz * (z - 0.057)))
    gap = 0.0015
    door = Mesh("cabinet_door", [
        box("lacquer", (gap - x / 2, feet, 0.0), (x / 2 - gap, height, t))])
    knob = Mesh("cabinet_knob", [moved(ellipsoid("steel", (0.016, 0.012, 0.016), 4, 6),
                                       (0.0, 0.0, 0.011), about_x=90)])
    for i, side in enumerate((-1, 1)):
        node.add_part(f"door_{i}", door, at=(side * x / 2, 0.0, front))
        node.add_part(f"knob_{i}", knob, at=(side * 0.053, height * 0.61, z))


def bed():
    """Head at -z."""
    width, head, length = L.BED_SIZE
    x, z, low, top = width / 2, length / 2, L.BED_CLEARANCE, L.BED_MATTRESS_TOP
    parts = [box("oak", (-x, low, -z + 0.037), (x, low + 0.113, z)),
             box("oak", (-x, 0.0, -z), (x, head, -z + 0.037)),
             cushion("linen", (-x + 0.013, low + 0.113, -z + 0.039), (x - 0.013, top, z - 0.011), 0.043),
             cushion("blue_weave", (-x - 0.007, low + 0.067, -z + 0.727), (x + 0.007, top + 0.027, z + 0.006), 0.033),
             moved(cushion("linen", (-0.327, 0.0, -0.193), (0.327, 0.117, 0.193), 0.053),
                   (0.013, top - 0.003, -z + 0.293), about_x=7.0, about_y=4.3)]
    parts += [box_at("oak", sx * (x - 0.061), 0.0, z - 0.067, (0.067, low, 0.067)) for sx in (-1, 1)]
    return Mesh("bed", parts)


def bench():
    width, height, depth = L.BENCH_SIZE
    x, z = width / 2, depth / 2
    parts = [box("oak", (-x, height - L.BENCH_TOP, -z), (x, height, z)),
             box("walnut", (-x + 0.041, 0.0, -z + 0.01), (-x + 0.073, height - L.BENCH_TOP, z - 0.01)),
             box("walnut", (x - 0.073, 0.0, -z + 0.01), (x - 0.041, height - L.BENCH_TOP, z - 0.01))]
    parts += [box("oak", (-x + 0.073, 0.143, a), (x - 0.073, 0.161, a + 0.051)) for a in (-0.131, -0.043, 0.047)]
    return Mesh("bench", parts)


def crate():
    """An open box of planks."""
    x, z, h, t = 0.213, 0.157, 0.273, 0.017
    return Mesh("crate", [rectilinear(
        "oak", [-x, -x + t, x - t, x], [0.0, t, h], [-z, -z + t, z - t, z],
        lambda i, j, k: not (j == 1 and i == 1 and k == 1))])
