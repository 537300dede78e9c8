"""Meshes of the small things: lamps, plants, pictures, bowls, rugs."""

import layout as L
from glb_writer import Mesh
from shapes import (Part, box, box_at, cylinder, ellipsoid, lathe, moved, rect_uvs, rectilinear)
from textures import painting_rect, swatch


def rug(name, width, depth):
    half_x, half_z = width / 2, depth / 2
    block = box("rug", (-half_x, 0.0, -half_z), (half_x, L.RUG_THICKNESS, half_z))
    edge = (0.002, 0.002, 0.02, 0.02)
    uvs = [rect_uvs(block.points, [face], (0.0, 0.0, 1.0, 1.0) if side == 3 else edge)[0]
           for side, face in enumerate(block.faces)]
    return Mesh(name, [Part("rug", block.points, block.faces, uvs)])


def floor_lamp():
    shade = [(0.187, 1.327), (0.119, 1.617), (0.113, 1.617), (0.181, 1.327)]
    parts = [lathe("steel", [(0.0, 0.0), (0.147, 0.0), (0.147, 0.017), (0.021, 0.027), (0.0, 0.027)], 14),
             cylinder("steel", 0.0113, 0.027, 1.447, 6),
             lathe("prints", shade, 14, swatch("shade"), ring=True),
             moved(ellipsoid("prints", (0.047, 0.057, 0.047), 4, 8, swatch("porcelain")), (0.0, 1.493, 0.0))]
    return Mesh("floor_lamp", parts)


def pendant_lamp(drop):
    """Frame: the hook on the ceiling; the shade's rim hangs `drop` below."""
    low = -drop
    shade = [(0.227, low), (0.213, low + 0.061), (0.129, low + 0.143), (0.043, low + 0.187),
             (0.037, low + 0.181), (0.121, low + 0.137), (0.205, low + 0.058), (0.219, low)]
    parts = [cylinder("prints", 0.051, -0.023, 0.0, 10, swatch("charcoal")),
             cylinder("prints", 0.0047, low + 0.16, -0.023, 6, swatch("charcoal")),
             cylinder("prints", 0.041, low + 0.147, low + 0.193, 8, swatch("brass")),
             lathe("prints", shade, 16, swatch("teal"), ring=True),
             moved(ellipsoid("prints", (0.043, 0.053, 0.043), 4, 8, swatch("shade")), (0.0, low + 0.097, 0.0))]
    return Mesh("pendant_lamp", parts)


def bowl():
    profile = [(0.0, 0.0), (0.057, 0.0), (0.061, 0.009), (0.117, 0.041), (0.153, 0.093), (0.147, 0.095),
               (0.109, 0.049), (0.057, 0.019), (0.0, 0.015)]
    return Mesh("bowl", [lathe("prints", profile, 15, swatch("porcelain"))])


def fruit(name, color):
    return Mesh(name, [ellipsoid("prints", (0.039, 0.036, 0.039), 5, 7, swatch(color))])


def vase():
    profile = [(0.0, 0.0), (0.047, 0.0), (0.073, 0.061), (0.067, 0.127), (0.031, 0.193), (0.027, 0.223),
               (0.037, 0.247), (0.031, 0.247), (0.0, 0.203)]
    return Mesh("vase", [lathe("prints", profile, 11, swatch("teal"))])


def flower_pot():
    profile = [(0.0, 0.0), (0.121, 0.0), (0.167, 0.293), (0.179, 0.293), (0.179, 0.327), (0.161, 0.327),
               (0.149, 0.281), (0.0, 0.281)]
    return Mesh("flower_pot", [lathe("prints", profile, 11, swatch("terracotta")),
                               moved(ellipsoid("prints", (0.149, 0.021, 0.149), 3, 8, swatch("soil")),
                                     (0.0, 0.281, 0.0))])


def leaf(name, color):
    """A long closed leaf that stands on its stem. Frame: the stem's foot, the leaf along +y."""
    blade = moved(ellipsoid("prints", (0.067, 0.257, 0.0073), 5, 5, swatch(color)), (0.0, 0.477, 0.057),
                  about_x=14.0)
    stem = moved(cylinder("prints", 0.0057, 0.0, 0.273, 4, swatch(color)), about_x=4.0)
    return Mesh(name, [blade, stem])


def picture():
    """Frame: the middle of the back, z out of the wall."""
    half_x, half_y, bar = 0.437, 0.313, 0.031
    frame = rectilinear(
        "walnut", [-half_x, -half_x + bar, half_x - bar, half_x],
        [-half_y, -half_y + bar, half_y - bar, half_y], [0.0, 0.027],
        lambda i, j, k: (i, j) != (1, 1))
    canvas = box("prints", (-half_x + bar, -half_y + bar, 0.003), (half_x - bar, half_y - bar, 0.013),
                 painting_rect())
    return Mesh("picture", [frame, canvas])


def clock():
    """A round wall clock. Frame: the middle of the back, z out of the wall."""
    dial = cylinder("prints", 0.139, 0.0, 0.021, 14, swatch("porcelain"))
    rim = lathe("prints", [(0.139, 0.0), (0.153, 0.0), (0.153, 0.033), (0.139, 0.033)], 14,
                swatch("charcoal"), ring=True)
    hands = [moved(box_at("prints", 0.0, -0.012, 0.0, (0.007, length, 0.003), swatch("charcoal")),
                   (0.0, 0.0, 0.021 + lift), about_z=turn)
             for length, turn, lift in ((0.119, -61.0, 0.0035), (0.083, 37.0, 0.0075))]
    return Mesh("clock", [moved(dial, about_x=90), moved(rim, about_x=90)] + hands)


def coat_rail(node):
    """A board with five instances of one slanted peg."""
    node.add_part("board", Mesh("coat_rail_board", [
        box("oak", (-0.467, -0.047, 0.0), (0.467, 0.047, 0.019))]))
    outline = [(0.0, 0.0), (0.010, 0.0), (0.018, 0.083), (0.0, 0.091)]
    peg = Mesh("coat_peg", [moved(lathe("walnut", outline, 7), about_x=63.0)])
    for i in range(5):
        node.add_part(f"peg_{i}", peg, at=(-0.374 + 0.187 * i, -0.003, 0.017))


def plank(width, length, thickness):
    """A board that stands on the edge x = z = 0 of its foot. Frame: that edge, the board along +y."""
    return Mesh("leaning_board", [box("walnut", (-thickness, 0.0, -width / 2), (0.0, length, width / 2))])


def wall_shelf():
    return Mesh("wall_shelf", [box("oak", (-0.413, -0.023, 0.0), (0.413, 0.0, 0.197)),
                               box("steel", (-0.301, -0.113, 0.0), (-0.281, -0.023, 0.009)),
                               box("steel", (0.281, -0.113, 0.0), (0.301, -0.023, 0.009))])
