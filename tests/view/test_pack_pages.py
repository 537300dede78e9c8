#!/usr/bin/env python3
"""Pages of packs in a real browser: their scenes, objects and robots are those of the packs.

    test_pack_pages.py --packs PROGRAM --pack GALACTIC_PACK --run GALACTIC_RUN
"""

import json
import struct
import sys

from browser import Page, decode_png
from page_case import OPTIONS, PageCase, run_tests, tool

# Of tests/support/homes/small_home_models.h.
ROOM, TABLE = (0xE0, 0xD8, 0xD0), (0x80, 0x50, 0x30)


def images_of(glb: bytes) -> dict[str, bytes]:
    """The images of a GLB file, as PNG, by name."""
    (length,) = struct.unpack("<I", glb[12:16])
    content = json.loads(glb[20 : 20 + length])
    binary = glb[28 + length :]
    found = {}
    for image in content["images"]:
        view = content["bufferViews"][image["bufferView"]]
        found[image["name"]] = binary[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]
    return found


class PackPages(PageCase):
    pages = ("world", "hostile_scene", "hostile_objects", "hostile_robot", "painted")

    def count(self, page: Page, color: tuple[int, int, int]) -> int:
        _, _, rgb = page.pixels()
        wanted = bytes(color)
        return sum(rgb[n : n + 3] == wanted for n in range(0, len(rgb), 3))

    def test_all_parts_of_a_world_open(self):
        page = self.open("world", "", "scene 0")
        self.assertGreater(self.show_all_parts(page), 8)

    def test_a_pack_that_is_opened_first_is_drawn(self):
        page = self.open("world", "", "scene 0")
        packs = page.evaluate("galactic.manifest.packs.map((one) => one.file)")
        self.assertIn("world.pack", packs)
        for number, file in enumerate(packs):
            page = self.open("world", f"view=pack&n={number}", f"pack {number}")
            readout = page.evaluate("document.getElementById('readout').textContent")
            self.assertEqual("Nothing in this pack" in readout, file == "world.pack", file)
            drawn = page.evaluate("galactic.stage.content.children.length")
            self.assertEqual(drawn > 0, file != "world.pack", file)
            # Beside it stands what is known about the pack, and the list has it as what is shown.
            panel = page.evaluate("document.getElementById('panel').innerText")
            self.assertIn(file, panel.lower())
            self.assertEqual(self.marked(page), [file])
            page.wait(f"location.hash.includes('view=pack&n={number}')")

    def test_the_mesh_has_the_colors_of_its_materials(self):
        page = self.open("world", "view=scene&shade=0&slice=1.2", "scene 0")
        whole = self.count(page, TABLE)
        self.assertGreater(whole, 2000)
        self.assertGreater(self.count(page, ROOM), 5000)
        # Cut off under the table top, it is not seen from above.
        page.evaluate("galactic.view.setHeight(0.3); galactic.stage.drawNow(); 1")
        self.assertLess(self.count(page, TABLE), whole / 3)

    def test_what_is_opened_fills_the_picture_and_is_seen_whole(self):
        # How far the corners of what is drawn reach from the middle of the picture, as shares of the way to its edges.
        reach = """(() => {
          const { stage, view } = galactic;
          const figure = view.mesh ?? view.figure?.group ?? view.home.robot.group;
          const most = view.isCut && view.layer ? view.layer.height : Infinity;
          const found = [0, 0];
          figure.updateMatrixWorld(true);
          figure.traverseVisible((one) => {
            const places = one.isInstancedMesh ? null : one.geometry?.attributes.position;
            for (let n = 0; n < (places?.count ?? 0); ++n) {
              const at = stage.camera.position.clone().fromBufferAttribute(places, n).applyMatrix4(one.matrixWorld);
              at.y = Math.min(at.y, most);
              at.project(stage.camera);
              [at.x, at.y].forEach((share, axis) => { found[axis] = Math.max(found[axis], Math.abs(share)); });
            }
          });
          return found;
        })()"""
        for kind in ("scene", "object", "robot", "episode"):
            for size in ((900, 520), (1280, 800), (400, 700)):
                page = self.open("world", f"view={kind}&n=0&theme=light", f"{kind} 0", size)
                found = page.evaluate(reach)
                self.assertLess(max(found), 1, f"{kind}, {size}")
                # An episode shows more than the robot.
                self.assertGreater(
                    max(found), 0.1 if kind == "episode" else 0.75, f"{kind}, {size}"
                )

    def test_scenes_open_cut_above_the_furniture_and_without_a_slice(self):
        page = self.open("world", "view=scene&radius=0.05", "scene 0")
        look = "[galactic.view.layer.slice.visible, galactic.view.layer.height, galactic.stage.cut.constant]"
        # The floor is at 0, and a sphere's center above it.
        for is_sliced, height in ((False, 1.65), (True, 0.65), (False, 1.65)):
            if is_sliced != page.evaluate(look)[0]:
                page.evaluate(f"(galactic.view.showSlice({str(is_sliced).lower()}), 1)")
            shown, *heights = page.evaluate(look)
            self.assertEqual(shown, is_sliced)
            for one in heights:
                self.assertAlmostEqual(one, height, delta=0.01)
            page.wait(f"location.hash.includes('sliced=1') === {str(is_sliced).lower()}")
        # A height that somebody chose stays.
        page.evaluate("(galactic.view.setHeight(1), galactic.view.showSlice(true), 1)")
        self.assertEqual(page.evaluate(look), [True, 1, 1])
        page = self.open("world", "view=scene&radius=0.05&slice=0.9&sliced=1", "scene 0")
        self.assertEqual(page.evaluate(look), [True, 0.9, 0.9])

    def test_marks_of_a_robot_have_their_colors_beside_their_names(self):
        page = self.open("world", "view=robot", "robot 0")
        rows = page.evaluate(
            "[...document.querySelectorAll('#panel label .text')].filter((one) => one.querySelector('.swatch'))"
            ".map((one) => [one.textContent, ...[...one.querySelectorAll('.swatch')].map((s) => [getComputedStyle(s).backgroundColor, s.clientWidth > 5])])"
        )
        self.assertEqual(
            rows,
            [
                ["Grasp point, camera, footprint"]
                + [
                    [f"rgb({color})", True]
                    for color in ("230, 159, 0", "0, 114, 178", "204, 121, 167")
                ]
            ],
        )

    def test_columns_are_those_of_the_pack(self):
        scene = self.folder / "scenes/kitchen.pack"
        page = self.open("world", "view=scene&radius=0.05", "scene 0")
        spans = 0
        for x, z in ((0.5, 0.5), (1.5, 1.5), (1.02, 1.4), (2.7, 0.31), (2.02, 2.0)):
            told = json.loads(
                tool(OPTIONS.pack, "column", scene, "--at", f"{x},{z}", "--radius", 0.05, "--json")
            )
            wanted = told["columns"][0]["spans"]
            shown = page.evaluate(
                f"(() => {{ const {{ grid }} = galactic.view.layer; galactic.view.mark(grid.cellAt({x}, {z}));"
                "return [...document.querySelectorAll('#panel td.number')].map((one) => one.textContent); })()"
            )
            for n, span in enumerate(wanted):
                low, high = (float(text) for text in shown[3 * n : 3 * n + 2])
                self.assertAlmostEqual(low, span["lo"], delta=1e-4)
                self.assertAlmostEqual(high, span["hi"], delta=1e-4)
                spans += 1
        self.assertGreater(spans, 5)

    def test_numbers_are_those_of_info(self):
        files = ("scenes/kitchen.pack", "objects.pack", "robots/helper.pack", "episodes.pack")
        scene, objects, robot, episodes = json.loads(
            tool(OPTIONS.pack, "info", "--json", *(self.folder / file for file in files))
        )
        page = self.open("world", "view=scene", "scene 0")
        grid = scene["scene"]["column_grids"][0]
        text = page.evaluate("document.getElementById('panel').innerText")
        self.assertIn(f"Spans\t{grid['content']['spans']}", text)
        self.assertIn(f"Columns\t{grid['columns_x']} × {grid['columns_z']}", text)
        for number, one in enumerate(objects["object_set"]["objects"]):
            page.evaluate(
                f"galactic.show(galactic.parts.find((one) => one.name === '{one['name']}')).then(() => 1)"
            )
            text = page.evaluate("document.getElementById('panel').innerText")
            self.assertIn(f"Spheres\t{len(one['spheres'])}", text)
            sides = " × ".join(f"{200 * half:.1f}" for half in one["box"]["half_extents"])
            self.assertIn(f"Box\t{sides} cm", text)
        page.evaluate(
            "galactic.show(galactic.parts.find((one) => one.kind === 'robot')).then(() => 1)"
        )
        names = page.evaluate(
            "[...document.querySelectorAll('#panel .slider span')].map((one) => one.textContent)"
        )
        self.assertEqual(names[:4], [one["name"] for one in robot["robot"]["controlled_joints"]])
        self.assertEqual(
            page.evaluate("galactic.episodes.count"), episodes["episode_set"]["episode_count"]
        )

    def test_blocks_are_decoded_as_the_renderer_does(self):
        page = self.open("world", "", "scene 0")
        # Red and blue, the two colors between them, and a block whose middle is one half.
        decoded = page.evaluate(
            "(() => { const decode = (...bytes) => [...galactic.library.constructor.decodeBlocks(new Uint8Array(bytes), 4)];"
            "return [decode(0, 0xf8, 0x1f, 0, 0b11100100, 0, 0, 0), decode(0x1f, 0, 0, 0xf8, 0b11100100, 0, 0, 0)]; })()"
        )
        self.assertEqual(
            decoded[0][:16], [255, 0, 0, 255, 0, 0, 255, 255, 170, 0, 85, 255, 85, 0, 170, 255]
        )
        self.assertEqual(
            decoded[1][:16], [0, 0, 255, 255, 255, 0, 0, 255, 128, 0, 128, 255, 0, 0, 0, 255]
        )
        self.assertEqual(decoded[0][16:20], [255, 0, 0, 255])

    def test_textures_have_the_texels_of_the_pack(self):
        glb = self.folder / "painted.glb"
        tool(OPTIONS.pack, "export", self.folder / "painted.pack", "-o", glb, "--what", "mesh")
        images = images_of(glb.read_bytes())
        page = self.open("painted", "", "object 0")
        textures = page.evaluate(
            "Promise.all(galactic.library.textures.map((_, n) => galactic.library.texture(n)"
            ".then((one) => [...one.image.data])))"
        )
        names = page.evaluate("galactic.library.textures.map((one) => one.name)")
        self.assertEqual(sorted(names), sorted(images))
        for name, texels in zip(names, textures):
            colors = bytes(value for n, value in enumerate(texels) if n % 4 != 3)
            self.assertEqual(colors, decode_png(images[name])[2], name)

    def test_the_grid_that_was_chosen_last_is_shown(self):
        page = self.open("world", "view=scene&radius=0.05", "scene 0")
        # What is unpacked first takes longest.
        shown = page.evaluate(
            "(async () => { const { view, data, stage } = galactic; const arrays = data.arrays.bind(data); let wait = 200;"
            "data.arrays = async (one) => { wait -= 100; await new Promise((done) => setTimeout(done, Math.max(0, wait))); return arrays(one); };"
            "const radii = view.stored.grids.map((one) => one.radius); const other = radii.filter((one) => one !== view.layer.grid.radius);"
            "const inputs = [...document.querySelectorAll('#panel input[type=radio]')];"
            "for (const one of other) inputs[radii.indexOf(one)].click();"
            "await galactic.show(galactic.parts.find((one) => one.kind === 'object'));"
            "return [other.length, other.at(-1) === view.layer.grid.radius, view.layer.group.parent === stage.content]; })()"
        )
        self.assertGreaterEqual(shown[0], 2)
        self.assertEqual(shown[1:], [True, False])

    def memory(self, page: Page) -> dict:
        """What the graphics processor holds, and what the page keeps for it."""
        return page.evaluate(
            "(galactic.stage.drawNow(), { ...galactic.stage.renderer.info.memory, kept: galactic.library.loaded.size })"
        )

    def show(self, page: Page, kind: str, number: int):
        page.evaluate(
            f"galactic.show(galactic.parts.find((one) => one.kind === '{kind}' && one.number === {number})).then(() => 1)"
        )

    def test_objects_that_are_left_free_their_textures(self):
        page = self.open("painted", "view=object&n=0", "object 0")
        before = self.memory(page)
        self.assertGreater(before["kept"], 0)
        self.assertGreaterEqual(before["textures"], before["kept"])
        for _ in range(2):
            self.show(page, "object", 1)
            self.show(page, "object", 0)
        self.assertEqual(self.memory(page), before)
        page.evaluate("galactic.stage.clear()")
        after = self.memory(page)
        self.assertEqual([after[key] for key in ("kept", "textures", "geometries")], [0, 0, 0])

    def test_views_that_are_left_free_all_that_they_drew(self):
        page = self.open("world", "view=scene&n=0&sliced=1", "scene 0")
        before = self.memory(page)
        page.evaluate(
            "(async () => { const { view } = galactic; for (const grid of view.stored.grids) { await view.chooseGrid(grid);"
            "view.layer.setFloors(true); galactic.stage.drawNow(); view.layer.setFloors(false); } return view.chooseGrid(view.stored.grids[0]); })().then(() => 1)"
        )
        self.assertGreater(self.memory(page)["textures"], before["textures"])
        self.show_all_parts(page)
        self.show(page, "scene", 0)
        self.assertEqual(self.memory(page), before)
        self.show(page, "episode", 0)
        episode = self.memory(page)
        for number in (1, 2, 3, 0):
            page.evaluate(
                f"galactic.view.go({number}).then(() => galactic.view.setReach({str(number % 2 == 1).lower()})).then(() => galactic.stage.drawNow())"
            )
        self.assertEqual(self.memory(page), episode)

    def test_a_click_marks_what_a_sphere_reaches(self):
        page = self.open("world", "view=scene&radius=0.05&slice=0.4&sliced=1", "scene 0")
        self.assertNotIn(
            "free space", page.evaluate("document.getElementById('panel').textContent")
        )
        x, y = page.evaluate(
            "(() => { const { stage, view } = galactic; const { x, z } = view.layer.grid.centerOf({ i: 9, k: 9 });"
            "const at = stage.camera.position.clone().set(x, 0.4, z).project(stage.camera); const area = stage.canvas.getBoundingClientRect();"
            "return [area.left + (at.x + 1) / 2 * area.width, area.top + (1 - at.y) / 2 * area.height]; })()"
        )
        page.click(x, y)
        page.wait("document.getElementById('panel').textContent.includes('of the free space')")
        self.assertEqual(page.evaluate("galactic.view.pinned.cell"), {"i": 9, "k": 9})

    def test_a_drag_turns_the_view(self):
        page = self.open("world", "view=object&n=0", "object 0")
        before = page.evaluate("galactic.stage.camera.position.toArray()")
        page.drag((330, 200), (420, 240))
        self.assertNotEqual(page.evaluate("galactic.stage.camera.position.toArray()"), before)

    def test_keys_move_a_joint(self):
        page = self.open("world", "view=robot", "robot 0")
        before = page.evaluate("galactic.view.figure.poses.at(-1).position.toArray()")
        page.evaluate("document.querySelector('#panel input[type=range]').focus()")
        page.key("ArrowRight")
        moved = page.evaluate(
            "[galactic.view.positions[0], galactic.view.robot.start[0], ...galactic.view.figure.poses.at(-1).position.toArray()]"
        )
        self.assertGreater(moved[0], moved[1])
        # The lift goes up, and the hand with it.
        self.assertAlmostEqual(moved[3] - before[1], moved[0] - moved[1], delta=1e-5)

    def test_parts_that_touch_from_the_start_are_not_shown_as_touching(self):
        page = self.open("world", "", "scene 0")
        # The hand in the arm, and a part of the base under the arm.
        touching = page.evaluate(
            "(async () => { const { robot } = galactic.robotPack; const { groups } = robot;"
            "const number = (link) => groups.findIndex((one) => one.link === link);"
            "groups[number(4)].spheres = [-0.08, 0, 0, 0.016]; groups[number(0)].spheres = [0.15, 0.4, 0, 0.12];"
            "robot.tested_pairs = [number(3), number(4), number(0), number(3)];"
            "await galactic.show(galactic.parts.find((one) => one.kind === 'robot'));"
            "const names = () => galactic.view.touching.map((pair) => pair.map((one) => galactic.view.figure.groupName(one)));"
            "const start = names(); galactic.view.set(0, 0); return [start, names()]; })()"
        )
        self.assertEqual(touching, [[], [["base", "arm"]]])

    def test_names_of_packs_are_no_markup(self):
        for name in ("hostile_scene", "hostile_objects", "hostile_robot"):
            page = self.open(
                name,
                "",
                {
                    "hostile_scene": "scene 0",
                    "hostile_objects": "object 0",
                    "hostile_robot": "robot 0",
                }[name],
            )
            self.show_all_parts(page)
            page.evaluate(
                "document.querySelectorAll('details').forEach((one) => { one.open = true; })"
            )
            self.assertEqual(
                page.evaluate(
                    "[document.querySelectorAll('img').length, document.title === 'owned']"
                ),
                [0, False],
            )
            self.assertIn("<img", page.evaluate("document.body.innerText"))


if __name__ == "__main__":
    sys.exit(run_tests(__doc__))
