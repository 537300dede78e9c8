"""Where everything stands: the furniture of the three rooms."""

import decor
import furniture
import kitchen
import layout as L
from glb_writer import product, quaternion, yaw
from shapes import sin_cos

# Boards whose compartment holds books: (board, first x, number of books, the last one leans).
_BOOK_ROWS = ((0, -0.41, 9, False), (1, -0.41, 12, True), (2, -0.27, 8, False), (3, -0.41, 7, True),
              (4, -0.41, 13, False), (6, -0.41, 10, True), (7, -0.13, 9, False))


def _scramble(index):
    """A fixed number in [0, 1) for each index: sizes of books and leaves."""
    h = (index * 0x9E3779B1 + 0x7F4A7C15) & 0xFFFFFFFF
    h = ((h ^ (h >> 16)) * 0x45D9F3B) & 0xFFFFFFFF
    return ((h ^ (h >> 16)) & 0xFFFF) / 65536.0


def _books(shelf, meshes):
    """Rows of book instances, each scaled on its own in thickness, height and depth."""
    base_x, base_y, base_z = furniture.BOOK_SIZE
    back = -L.SHELF_SIZE[2] / 2 + L.SHELF_BACK + 0.003
    serial = 0
    for board, x, count, leans in _BOOK_ROWS:
        top = L.shelf_board_bottom(board) + L.SHELF_BOARD
        for i in range(count):
            thick, tall, deep = (_scramble(serial * 3 + k) for k in range(3))
            size = (0.023 + 0.033 * thick, 0.149 + 0.058 * tall,
                    L.BOOK_DEPTH - 0.003 - 0.061 * deep)
            rotation = None
            if leans and i == count - 1:
                rotation = quaternion("z", 13.0)
                # Turned about its left foot, the book rests against its neighbor.
                x += size[1] * sin_cos(13.0)[0]
            shelf.add_part(f"book_{serial:02d}", meshes[serial * 3 % len(meshes)],
                           at=(x, top, back), rotation=rotation,
                           scale=(size[0] / base_x, size[1] / base_y, size[2] / base_z))
            x += size[0] + 0.0013
            serial += 1


def _plant(room, name, at, meshes, count):
    plant = room.add(name, at=at)
    pot, leaves = meshes
    plant.add_part("pot", pot)
    for i in range(count):
        tilt, grow = 5.0 + 23.0 * _scramble(i + 70), 0.79 + 0.4 * _scramble(i + 90)
        turn = 137.5 * i
        s, c = sin_cos(turn)
        plant.add_part(f"leaf_{i:02d}", leaves[i % len(leaves)], at=(0.031 * s, 0.287, 0.031 * c),
                       rotation=product(yaw(turn), quaternion("x", tilt)),
                       scale=(0.91 * grow, grow, grow))


def _dining(room, shared):
    x, z = L.TABLE_AT
    table = room.add("dining_table", at=(x, 0.0, z))
    furniture.table(table)
    chair = furniture.chair()
    for i, (dx, dz, turn) in enumerate(((-0.387, -0.557, 3.0), (0.393, -0.563, -4.0),
                                        (-0.373, 0.573, 180.0), (0.443, 0.623, 197.0))):
        room.add(f"chair_{i}", chair, at=(x + dx, 0.0, z + dz), rotation=yaw(turn))
    top = L.TABLE_SIZE[1]
    bowl = room.add("fruit_bowl", shared["bowl"], at=(x - 0.237, top, z + 0.043))
    orange, apple = decor.fruit("orange", "orange"), decor.fruit("apple", "apple")
    for i, (mesh, at, turn) in enumerate(((orange, (0.037, 0.061, 0.021), 0.0),
                                          (apple, (-0.041, 0.062, 0.017), 40.0),
                                          (orange, (0.003, 0.064, -0.049), 100.0))):
        bowl.add_part(f"fruit_{i}", mesh, at=at, rotation=yaw(turn))
    room.add("table_vase", shared["vase"], at=(x + 0.307, top, z - 0.117))
    room.add("pendant_lamp", decor.pendant_lamp(0.887), at=(x, L.LOW_CEILING, z))


def _leaning_board(room):
    """Placed by a matrix, the only node that is: importers must read both forms."""
    length, lean = 1.637, 13.3
    s, c = sin_cos(lean)
    x, z = L.ROOM_A.high[0] - 0.001 - length * s, -0.273
    # Columns of Rz(-lean), then the translation.
    room.add("leaning_board", decor.plank(0.243, length, 0.0247),
             matrix=(c, -s, 0, 0, s, c, 0, 0, 0, 0, 1, 0, x, 0, z, 1))


def _room_a(room, shared):
    kitchen.build(room)
    _dining(room, shared)
    room.add("rug", decor.rug("rug", 2.237, 1.613), at=(L.COFFEE_TABLE_AT[0], 0.0, 1.357),
             rotation=yaw(3.7))
    room.add("coffee_table", shared["coffee_table"],
             at=(L.COFFEE_TABLE_AT[0], L.RUG_THICKNESS, L.COFFEE_TABLE_AT[1]))
    furniture.sofa(room.add("sofa", at=(L.SOFA_AT[0], 0.0, L.SOFA_AT[1]), rotation=yaw(180)))
    room.add("armchair", shared["armchair"], at=(-0.437, 0.0, 1.117), rotation=yaw(-107.0))
    shelf = room.add("bookshelf", at=(L.SHELF_AT[0], 0.0, L.SHELF_AT[1]), rotation=yaw(-90))
    furniture.bookshelf(shelf)
    _books(shelf, shared["books"])
    top = L.shelf_board_bottom(5) + L.SHELF_BOARD
    shelf.add_part("vase", shared["vase"], at=(0.193, top, -0.041), scale=(0.78, 0.78, 0.78))
    shelf.add_part("bowl", shared["bowl"], at=(-0.201, top, -0.037), scale=(0.63, 0.71, 0.63))
    room.add("floor_lamp_living", shared["floor_lamp"], at=(-3.707, 0.0, 2.593))
    _plant(room, "plant", (-3.493, 0.0, 0.397), shared["plant"], 10)
    room.add("picture_sofa", shared["picture"],
             at=(L.SOFA_AT[0] + 0.113, 1.577, L.ROOM_A.high[2] - 0.001),
             rotation=product(yaw(180), quaternion("z", 3.7)))
    room.add("clock", decor.clock(), at=(L.ROOM_A.high[0] - 0.001, 2.013, 0.613), rotation=yaw(-90))
    _leaning_board(room)


def _corridor(room, shared):
    room.add("bench", furniture.bench(), at=(L.BENCH_AT[0], 0.0, L.BENCH_AT[1]))
    rail = room.add("coat_rail", at=(L.BENCH_AT[0], 1.683, L.CORRIDOR.low[2]))
    decor.coat_rail(rail)
    room.add("runner", decor.rug("runner", 2.013, 0.637), at=(2.287, 0.0, -2.057), rotation=yaw(-1.3))
    room.add("picture_corridor", shared["picture"], at=(3.117, 1.543, L.CORRIDOR.low[2] + 0.001),
             rotation=quaternion("z", -2.1), scale=(0.83, 0.83, 1.0))


def _room_b(room, shared):
    room.add("bed", furniture.bed(), at=(L.BED_AT[0], 0.0, L.BED_AT[1]))
    cabinet = room.add("cabinet", at=(L.CABINET_AT[0], 0.0, L.CABINET_AT[1]), rotation=yaw(180))
    furniture.cabinet(cabinet)
    crate = furniture.crate()
    room.add("crate_0", crate, at=(1.213, 0.0, 2.571), rotation=yaw(17.0))
    room.add("crate_1", crate, at=(1.687, 0.0, 2.627), rotation=yaw(-8.3), scale=(0.81, 1.23, 0.87))
    shelf = room.add("wall_shelf", at=(L.ROOM_B.high[0], 1.573, 0.731), rotation=yaw(-90))
    shelf.add_part("board", decor.wall_shelf())
    for i, (x, mesh) in enumerate(((-0.377, 3), (-0.341, 5), (-0.299, 6), (-0.263, 1))):
        shelf.add_part(f"book_{i}", shared["books"][mesh], at=(x, 0.0, 0.021),
                       scale=(1.07 - 0.11 * i, 0.87 + 0.07 * (i % 3), 1.03))
    shelf.add_part("vase", shared["vase"], at=(0.213, 0.0, 0.097), scale=(0.71, 0.83, 0.71))
    loft = L.LOFT_TOP
    room.add("loft_rug", decor.rug("loft_rug", 1.517, 1.117), at=(2.657, loft, 2.113), rotation=yaw(11.0))
    room.add("loft_armchair", shared["armchair"], at=(3.263, loft + L.RUG_THICKNESS, 2.183),
             rotation=yaw(-71.0))
    room.add("loft_side_table", shared["coffee_table"], at=(2.437, loft + L.RUG_THICKNESS, 2.531),
             rotation=yaw(31.0), scale=(0.57, 1.19, 0.57))
    room.add("floor_lamp_loft", shared["floor_lamp"], at=(3.677, loft, 2.687), scale=(0.93, 0.89, 0.93))


def furnish(rooms):
    """Fill the nodes of the three rooms, {room name: node}."""
    shared = {
        "armchair": furniture.armchair(), "coffee_table": furniture.coffee_table(),
        "floor_lamp": decor.floor_lamp(), "picture": decor.picture(), "vase": decor.vase(), "bowl": decor.bowl(),
        "books": [furniture.book(i) for i in (0, 1, 2, 5, 7, 8, 9)],
        "plant": (decor.flower_pot(), (decor.leaf("leaf_light", "leaf"), decor.leaf("leaf_dark", "deep_leaf")))}
    _room_a(rooms["room_a"], shared)
    _corridor(rooms["corridor"], shared)
    _room_b(rooms["room_b"], shared)
