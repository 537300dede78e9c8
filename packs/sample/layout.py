"""The numbers of the apartment: one place for the builders and for the landmarks.

Meters, Y up, the floor is y = 0. North is -z, east is +x. Sizes are those of a real home and
avoid round numbers, so that no wall lies exactly on a column of a likely grid.
"""

from typing import NamedTuple


class Box(NamedTuple):
    """An axis-aligned box in the world."""
    low: tuple
    high: tuple

    def volume(self):
        x, y, z = (b - a for a, b in zip(self.low, self.high))
        return x * y * z

    def contains(self, p):
        return all(a < v < b for a, v, b in zip(self.low, p, self.high))


class Opening(NamedTuple):
    """A hole in a wall: from `start` to `end` along the wall, `bottom` to `top` in height."""
    start: float
    end: float
    bottom: float
    top: float


RADII = (0.015, 0.05, 0.12)

OUTER_WALL, INNER_WALL = 0.118, 0.104
FLOOR_THICKNESS, CEILING_THICKNESS = 0.163, 0.147
LOW_CEILING, HIGH_CEILING = 2.613, 3.437
DOOR_WIDTH, DOOR_HEIGHT = 0.9, 2.05
WALL_GAP = 0.021  # furniture stands this far from a wall, clear of the skirting

_WEST, _NORTH, _SOUTH, _EAST = -4.027, -2.941, 2.916, 3.943
_MIDDLE_WEST, _MIDDLE_EAST = 0.586, 0.586 + INNER_WALL
_CORRIDOR_SOUTH, _B_NORTH = -1.478, -1.478 + INNER_WALL

ROOM_A = Box((_WEST, 0.0, _NORTH), (_MIDDLE_WEST, LOW_CEILING, _SOUTH))
CORRIDOR = Box((_MIDDLE_EAST, 0.0, _NORTH), (_EAST, LOW_CEILING, _CORRIDOR_SOUTH))
ROOM_B = Box((_MIDDLE_EAST, 0.0, _B_NORTH), (_EAST, HIGH_CEILING, _SOUTH))
OUTSIDE = Box((_WEST - OUTER_WALL, -FLOOR_THICKNESS, _NORTH - OUTER_WALL),
              (_EAST + OUTER_WALL, HIGH_CEILING + CEILING_THICKNESS, _SOUTH + OUTER_WALL))
ROOMS = {"room_a": ROOM_A, "corridor": CORRIDOR, "room_b": ROOM_B}

DOOR_A = Opening(-2.673, -2.673 + DOOR_WIDTH, 0.0, DOOR_HEIGHT)       # z, room A to corridor
DOOR_B = Opening(1.793, 1.793 + DOOR_WIDTH, 0.0, DOOR_HEIGHT)         # x, corridor to room B
DOOR_ENTRANCE = Opening(-2.659, -2.659 + DOOR_WIDTH, 0.0, DOOR_HEIGHT)  # z, closed by its leaf
WINDOW_WIDTH, WINDOW_HEIGHT, WINDOW_SILL = 1.263, 1.287, 0.871
WINDOWS_A = tuple(Opening(z, z + WINDOW_WIDTH, WINDOW_SILL, WINDOW_SILL + WINDOW_HEIGHT)
                  for z in (-1.487, 0.873))                            # z, west wall
WINDOW_B = Opening(-0.873, 0.390, 0.941, 0.941 + WINDOW_HEIGHT)        # z, east wall
WINDOW_LOFT = Opening(1.537, 2.379, 2.013, 2.013 + 0.858)              # z, east wall, above the loft

TILED_NORTH_OF = -1.307  # the kitchen end of room A is tiled up to this z

# Kitchen, along the north wall of room A. Local frame: x along the wall, z away from it.
COUNTER_LENGTH, COUNTER_DEPTH, COUNTER_TOP, COUNTER_SLAB = 2.174, 0.617, 0.903, 0.038
COUNTER_BODY_DEPTH = 0.581
COUNTER_X = _WEST + 0.002 + COUNTER_LENGTH / 2
COUNTER_Z = _NORTH + 0.0015
SINK_X, SINK_SIZE, SINK_Z = -0.587, (0.497, 0.387), 0.101  # middle, inner x and z, first z
SINK_FLOOR = 0.727
CUPBOARD_BOTTOM, CUPBOARD_TOP, CUPBOARD_DEPTH, CUPBOARD_LENGTH = 1.487, 2.163, 0.337, 1.316
FRIDGE_SIZE = (0.597, 1.787, 0.622)
FRIDGE_X = COUNTER_X + COUNTER_LENGTH / 2 + 0.017 + FRIDGE_SIZE[0] / 2

TABLE_SIZE, TABLE_SLAB = (1.573, 0.743, 0.857), 0.034
TABLE_AT = (-2.243, -0.337)
CHAIR_SEAT = 0.457
BEAMS_Z = (-1.123, 1.217)
BEAM_SIZE = (0.157, 0.173)  # width, height

RUG_THICKNESS = 0.0113
COFFEE_TABLE_TOP, COFFEE_TABLE_RADIUS = 0.402, 0.417
COFFEE_TABLE_AT = (-2.371, 1.303)
SOFA_SIZE = (2.083, 0.827, 0.893)
SOFA_SEAT = 0.463
SOFA_AT = (-2.417, _SOUTH - WALL_GAP - SOFA_SIZE[2] / 2)

# Bookshelf: against the east wall of room A, its front looks west.
SHELF_SIZE = (0.937, 2.237, 0.287)
SHELF_SIDE, SHELF_BACK, SHELF_BOARD, SHELF_FOOT = 0.023, 0.009, 0.0215, 0.061
SHELF_BOARDS = 10
SHELF_AT = (_MIDDLE_WEST - WALL_GAP - SHELF_SIZE[2] / 2, 1.633)
BOOK_DEPTH = 0.191  # no book is deeper, so that the front of each board stays free


def shelf_board_bottom(index):
    pitch = (SHELF_SIZE[1] - SHELF_BOARD - SHELF_FOOT) / (SHELF_BOARDS - 1)
    return SHELF_FOOT + index * pitch


# Loft and stairs of room B; the stairs rise southwards along the wall to room A.
LOFT_TOP, LOFT_SLAB = 1.527, 0.137
LOFT_NORTH = 1.127
LOFT = Box((_MIDDLE_EAST, LOFT_TOP - LOFT_SLAB, LOFT_NORTH), (_EAST, LOFT_TOP, _SOUTH))
STAIR_STEPS, STAIR_RUN, STAIR_WIDTH = 8, 0.247, 0.837
STAIR_RISE = LOFT_TOP / (STAIR_STEPS + 1)
STAIR_NORTH = LOFT_NORTH - STAIR_STEPS * STAIR_RUN
STAIR_WEST = _MIDDLE_EAST + WALL_GAP
STAIR_TREAD, STAIR_NOSING, STAIR_STRINGER = 0.036, 0.021, 0.031
RAIL_HEIGHT = 0.927

# The closed cabinet under the loft: empty, without any opening.
CABINET_SIZE, CABINET_PANEL, CABINET_FEET = (1.127, 0.943, 0.487), 0.019, 0.083
CABINET_AT = (2.523, _SOUTH - WALL_GAP - CABINET_SIZE[2] / 2)
CABINET_STILE = (0.061, 0.023)
CABINET_CAVITY = Box(
    (CABINET_AT[0] - CABINET_SIZE[0] / 2 + CABINET_PANEL, CABINET_FEET + CABINET_PANEL,
     CABINET_AT[1] - CABINET_SIZE[2] / 2 + CABINET_PANEL),
    (CABINET_AT[0] + CABINET_SIZE[0] / 2 - CABINET_PANEL, CABINET_SIZE[1] - CABINET_PANEL,
     CABINET_AT[1] + CABINET_SIZE[2] / 2 - CABINET_PANEL))

BED_SIZE, BED_MATTRESS_TOP, BED_CLEARANCE = (0.957, 0.937, 2.083), 0.491, 0.189
BED_AT = (_EAST - WALL_GAP - BED_SIZE[0] / 2, _B_NORTH + WALL_GAP + BED_SIZE[2] / 2)

BENCH_SIZE = (0.913, 0.447, 0.313)
BENCH_AT = (1.583, _NORTH + WALL_GAP + BENCH_SIZE[2] / 2)
BENCH_TOP = 0.031
