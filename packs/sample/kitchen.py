"""The kitchen along the north wall of room A: counter with a sink, hob, cupboard, hood, fridge."""

import layout as L
from glb_writer import Mesh
from shapes import (box, box_at, cushion, cylinder, lathe, moved, prism_x, rectilinear, sin_cos,
                    tube)
from textures import swatch

_PLINTH = 0.097
_FRONT = 0.019
_HOB_X = 0.573


def _handle(width, x, y, z):
    """A bar in front of the plane z."""
    return box("steel", (x - width / 2, y - 0.007, z), (x + width / 2, y + 0.007, z + 0.023))


def _counter():
    """Body, worktop and sink. Frame: middle of the wall's foot, z away from the wall."""
    half, top = L.COUNTER_LENGTH / 2, L.COUNTER_TOP
    under = top - L.COUNTER_SLAB
    x0, x1 = L.SINK_X - L.SINK_SIZE[0] / 2, L.SINK_X + L.SINK_SIZE[0] / 2
    z0, z1 = L.SINK_Z, L.SINK_Z + L.SINK_SIZE[1]
    steel, play = 0.009, 0.012

    def hole(i, j, k):
        return (i, k) == (1, 1)
    body = rectilinear(
        "lacquer", [-half, x0 - play, x1 + play, half], [_PLINTH, L.SINK_FLOOR - play, under],
        [0.0, z0 - play, z1 + play, L.COUNTER_BODY_DEPTH],
        lambda i, j, k: not (j == 1 and hole(i, j, k)))
    worktop = rectilinear("oak", [-half, x0, x1, half], [under, top],
                          [0.0, z0, z1, L.COUNTER_DEPTH], lambda i, j, k: not hole(i, j, k))
    basin = rectilinear(
        "steel", [x0 - steel, x0, x1, x1 + steel], [L.SINK_FLOOR - steel, L.SINK_FLOOR, under],
        [z0 - steel, z0, z1, z1 + steel], lambda i, j, k: not (j == 1 and hole(i, j, k)))
    plinth = box("walnut", (-half, 0.0, 0.0), (half, _PLINTH, L.COUNTER_BODY_DEPTH - 0.051))
    drain = moved(cylinder("steel", 0.031, 0.0, 0.003, 10),
                  (L.SINK_X, L.SINK_FLOOR, (z0 + z1) / 2))
    return Mesh("kitchen_counter", [body, plinth, worktop, basin, drain])


def _fronts(counter):
    """Doors in three bays and drawers in the fourth, hung on the counter's node."""
    width = L.COUNTER_LENGTH / 4
    low, high = _PLINTH + 0.011, L.COUNTER_TOP - L.COUNTER_SLAB - 0.013
    size = width - 0.005
    door = Mesh("kitchen_door", [box("lacquer", (-size / 2, 0.0, 0.0), (size / 2, high - low, _FRONT))]
                + [_handle(0.147, 0.0, high - low - 0.057, _FRONT)])
    tall = (high - low - 0.01) / 3
    drawer = Mesh("kitchen_drawer", [box("lacquer", (-size / 2, 0.0, 0.0), (size / 2, tall, _FRONT))]
                  + [_handle(0.217, 0.0, tall - 0.051, _FRONT)])
    z = L.COUNTER_BODY_DEPTH
    for bay in range(4):
        x = -L.COUNTER_LENGTH / 2 + (bay + 0.5) * width
        if bay == 2:
            for i in range(3):
                counter.add_part(f"drawer_{i}", drawer, at=(x, low + i * (tall + 0.005), z))
        else:
            counter.add_part(f"door_{bay}", door, at=(x, low, z))


def _tap():
    z, height, reach = 0.0, 0.263, 0.087
    path = [(0.0, 0.02, z), (0.0, height, z)]
    for i in range(1, 7):
        s, c = sin_cos(30 * i)
        path.append((0.0, height + reach * s, z + reach * (1 - c)))
    path.append((0.0, height - 0.047, z + 2 * reach))
    return Mesh("tap", [cylinder("steel", 0.027, 0.0, 0.023, 8), tube("steel", path, 0.0123, 6),
                        moved(tube("steel", [(0.0, 0.0, 0.0), (0.0, 0.012, 0.071)], 0.007, 6),
                              (0.011, 0.087, 0.0), about_y=90)])


def _hob(counter):
    """A glass plate with four instances of one ring, in two sizes."""
    x, y, z = _HOB_X, L.COUNTER_TOP, 0.307
    counter.add_part("hob", Mesh("hob", [
        box_at("prints", 0.0, 0.0, 0.0, (0.573, 0.006, 0.497), swatch("charcoal"))]), at=(x, y, z))
    ring = Mesh("hob_ring", [cylinder("steel", 0.091, 0.0, 0.004, 12)])
    for i, (dx, dz, size) in enumerate(((-0.147, -0.117, 0.8), (0.143, -0.113, 1.0), (-0.143, 0.119, 1.0),
                                        (0.149, 0.121, 0.8))):
        counter.add_part(f"hob_ring_{i}", ring, at=(x + dx, y + 0.006, z + dz), scale=(size, 1.0, size))


def _pot():
    outline = [(0.0, 0.0), (0.091, 0.0), (0.094, 0.127), (0.098, 0.127), (0.098, 0.131),
               (0.09, 0.131), (0.087, 0.006), (0.0, 0.006)]
    handles = [box_at("prints", x, 0.093, 0.0, (0.041, 0.013, 0.057), swatch("charcoal"))
               for x in (-0.1145, 0.1145)]
    return Mesh("cooking_pot", [lathe("steel", outline, 11)] + handles)


def _cupboard(node):
    """Hang a closed body and three doors on `node`. Frame: middle of the lower back edge."""
    half, height, depth = L.CUPBOARD_LENGTH / 2, L.CUPBOARD_TOP - L.CUPBOARD_BOTTOM, L.CUPBOARD_DEPTH
    node.add_part("body", Mesh("cupboard_body", [
        box("oak", (-half, 0.0, 0.0), (half, height, depth - _FRONT))]))
    width = L.CUPBOARD_LENGTH / 3
    leaf = width / 2 - 0.0025
    door = Mesh("cupboard_door", [box("lacquer", (-leaf, 0.003, 0.0), (leaf, height - 0.003, _FRONT))]
                + [_handle(0.113, 0.0, 0.047, _FRONT)])
    for i in range(3):
        node.add_part(f"door_{i}", door, at=((i - 1) * width, 0.0, depth - _FRONT))


def _hood():
    width = 0.597
    canopy = prism_x("steel", [(0.0, 0.0), (0.463, 0.0), (0.463, 0.041), (0.257, 0.227), (0.0, 0.227)],
                     -width / 2, width / 2)
    chimney = box("steel", (-0.121, 0.227, 0.0), (0.121, 0.963, 0.237))
    return Mesh("cooker_hood", [canopy, chimney])


def _fridge():
    width, height, depth = L.FRIDGE_SIZE
    half, seam, door = width / 2, 0.647, 0.057
    parts = [box("lacquer", (-half, 0.023, 0.0), (half, height, depth - door)),
             box("walnut", (-half + 0.02, 0.0, 0.03), (half - 0.02, 0.023, depth - door - 0.03)),
             cushion("steel", (-half, 0.031, depth - door + 0.004), (half, seam, depth), 0.009),
             cushion("steel", (-half, seam + 0.007, depth - door + 0.004), (half, height, depth), 0.009)]
    for low, high in ((seam - 0.287, seam - 0.047), (seam + 0.053, seam + 0.493)):
        parts.append(box("lacquer", (half - 0.073, low, depth), (half - 0.053, high, depth + 0.029)))
    return Mesh("fridge", parts)


def build(room):
    """Add the kitchen to room A's node."""
    x, z, top = L.COUNTER_X, L.COUNTER_Z, L.COUNTER_TOP
    kitchen = room.add("kitchen")
    counter = kitchen.add_part("counter", at=(x, 0.0, z))
    counter.add_part("body", _counter())
    _fronts(counter)
    counter.add_part("tap", _tap(), at=(L.SINK_X, top, 0.049))
    _hob(counter)
    pot_scale = (1.07, 0.93, 1.07)
    counter.add_part("pot", _pot(), at=(_HOB_X - 0.145, top + 0.01, 0.425), scale=pot_scale)
    half, splash = L.COUNTER_LENGTH / 2, 0.009
    backsplash = Mesh("backsplash", [box("tiles", (-half, top, 0.0),
                                         (half, L.CUPBOARD_BOTTOM, splash))])
    kitchen.add_part("backsplash", backsplash, at=(x, 0.0, z))
    _cupboard(kitchen.add_part("wall_cupboard",
                               at=(x - half + L.CUPBOARD_LENGTH / 2, L.CUPBOARD_BOTTOM, z)))
    kitchen.add_part("hood", _hood(), at=(x + _HOB_X, 1.637, z + splash))
    kitchen.add_part("fridge", _fridge(), at=(L.FRIDGE_X, 0.0, L.COUNTER_Z + L.WALL_GAP))
