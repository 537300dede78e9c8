"""Meshes of the movable objects: things that a gripper opening 0.09 m can take.

Meters, Y up, standing on y = 0 around the y axis. Handles and covers reach into the parts they are
fixed to, as those of the furniture do.
"""

from glb_writer import Mesh
from shapes import box, cylinder, lathe, moved, prism_x, sin_cos, tube

_WHOLE_LABEL = (0.0, 0.0, 1.0, 1.0)


def mug():
    body = [(0.0, 0.0), (0.036, 0.0), (0.0405, 0.006), (0.0415, 0.094), (0.0375, 0.094), (0.0365, 0.014),
            (0.0, 0.012)]
    bend = [sin_cos(angle) for angle in (-70, -40, -10, 10, 40, 70)]
    handle = [(0.0, 0.048 + 0.029 * s, 0.036 + 0.036 * c) for s, c in bend]
    return Mesh("mug", [lathe("blue_glaze", body, 16), tube("blue_glaze", handle, 0.0052, 6)])


def bowl():
    profile = [(0.0, 0.0), (0.034, 0.0), (0.037, 0.006), (0.061, 0.026), (0.075, 0.058), (0.0705, 0.06),
               (0.056, 0.03), (0.032, 0.014), (0.0, 0.012)]
    return Mesh("bowl", [lathe("glaze", profile, 18)])


def plate():
    profile = [(0.0, 0.0), (0.058, 0.0), (0.062, 0.004), (0.102, 0.018), (0.1025, 0.022), (0.066, 0.0135),
               (0.0, 0.0125)]
    return Mesh("plate", [lathe("porcelain", profile, 20)])


def cereal_box():
    low, high = (-0.081, 0.0, -0.029), (0.081, 0.238, 0.029)
    return Mesh("cereal_box", [box("yellow_label", low, high, _WHOLE_LABEL)])


def soup_can():
    shell = [(0.0, 0.0), (0.0335, 0.0), (0.0335, 0.003), (0.0327, 0.0045), (0.0327, 0.0975), (0.0335, 0.099),
             (0.0335, 0.102), (0.0305, 0.102), (0.0305, 0.0985), (0.0, 0.0985)]
    return Mesh("soup_can", [lathe("tin", shell, 16),
                             cylinder("red_label", 0.0331, 0.007, 0.095, 16, (0.0, 0.0, 2.0, 1.0))])


def bottle():
    body = [(0.0, 0.0), (0.031, 0.0), (0.0345, 0.005), (0.0345, 0.135), (0.028, 0.16), (0.0135, 0.185),
            (0.0125, 0.209), (0.0, 0.209)]
    return Mesh("bottle", [lathe("green_plastic", body, 16),
                           cylinder("white_plastic", 0.0152, 0.207, 0.228, 12)])


def book():
    """Lying on its back cover, the spine along x."""
    half_x, half_z, thickness, board = 0.104, 0.07, 0.031, 0.0025
    pages = box("pages", (-half_x + 0.004, board / 2, -half_z + 0.002),
                (half_x - 0.004, thickness - board / 2, half_z - 0.004))
    covers = [box("teal_cover", (-half_x, low, -half_z), (half_x, low + board, half_z), _WHOLE_LABEL)
              for low in (0.0, thickness - board)]
    spine = [(-half_z - 0.004, 0.004), (-half_z - 0.004, thickness - 0.004), (-half_z, thickness),
             (-half_z + 0.003, thickness), (-half_z + 0.003, 0.0), (-half_z, 0.0)]
    return Mesh("book", [pages, *covers, prism_x("teal_cover", spine, -half_x, half_x)])


def apple():
    flesh = [(0.0, 0.004), (0.009, 0.0), (0.024, 0.003), (0.0355, 0.019), (0.038, 0.037), (0.033, 0.056),
             (0.019, 0.069), (0.008, 0.068), (0.0, 0.061)]
    stem = moved(cylinder("stem", 0.0018, 0.0, 0.017, 5), (0.0, 0.06, 0.0), about_z=12.0)
    return Mesh("apple", [lathe("apple_skin", flesh, 12), stem])


def all_meshes():
    """Return one mesh per object, in the order of their names."""
    return [apple(), book(), bottle(), bowl(), cereal_box(), mug(), plate(), soup_can()]
