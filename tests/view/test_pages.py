#!/usr/bin/env python3
"""Pages in a real browser: they open without an error or a request, and show what the packs hold.

    test_pages.py --packs PROGRAM --pack GALACTIC_PACK --run GALACTIC_RUN

PROGRAM writes the packs. Ends with 77 where there is no Chromium.
"""

import argparse
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

from browser import Browser, Page, decode_png, find_chromium

SKIPPED = 77
OPTIONS = argparse.Namespace()
# Of tests/support/homes/small_home_models.h.
ROOM, TABLE = (0xE0, 0xD8, 0xD0), (0x80, 0x50, 0x30)
# Poses on pages are whole numbers of 0.1 mm and 1/32767, joints of 0.0001; the hand is 1 m away.
POSE_TOLERANCE = 6e-4
# Of the PNG's filters in the test's own reader: small pictures suffice.
SMALL = (900, 520)


def tool(program: str, *arguments: object) -> str:
    return subprocess.run(
        [program, *map(str, arguments)], check=True, capture_output=True, text=True
    ).stdout


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


class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory(prefix="galactic-pages-")
        cls.folder = pathlib.Path(cls.scratch.name)
        tool(OPTIONS.packs, cls.folder)
        for name in ("world", "hostile_scene", "hostile_objects", "hostile_robot", "painted"):
            tool(
                OPTIONS.pack, "view", cls.folder / f"{name}.pack", "-o", cls.folder / f"{name}.html"
            )
        tool(
            OPTIONS.run,
            cls.folder / "world.pack",
            "--policy",
            f"replay:{cls.folder}/run.rec",
            "--view",
            cls.folder / "run.html",
            "--view-envs",
            2,
        )
        tool(
            OPTIONS.run,
            *(cls.folder / "bare/world.pack", "--envs", 1, "--steps", 5),
            *("--view", cls.folder / "bare.html"),
        )
        # Three of four episodes can be played: env 1 has one of them, env 0 two.
        tool(
            OPTIONS.run,
            *(cls.folder / "world.pack", "--envs", 2, "--order", "partition"),
            *("--episode-steps", 10, "--view", cls.folder / "shares.html"),
        )
        cls.browser = Browser()

    @classmethod
    def tearDownClass(cls):
        cls.browser.__exit__()
        cls.scratch.cleanup()

    def open(self, name: str, fragment: str, shown: str, size: tuple[int, int] = SMALL) -> Page:
        page = self.browser.open(self.folder / f"{name}.html", "#" + fragment, size)
        self.addCleanup(self.expect_peace, page)
        page.shown(shown)
        return page

    def expect_peace(self, page: Page):
        """Neither an error nor a request but for the page itself."""
        page.evaluate("1")
        self.assertEqual(page.errors, [])
        self.assertEqual({url.split("#")[0] for url in page.requests}, {page.url})

    def click(self, page: Page, selector: str, number: int = 0):
        x, y = page.evaluate(
            f"(() => {{ const one = document.querySelectorAll({json.dumps(selector)})[{number}];"
            "const area = one.getBoundingClientRect();"
            "return [area.left + area.width / 2, area.top + area.height / 2]; })()"
        )
        page.click(x, y)

    def marked(self, page: Page) -> list[str]:
        """The entries of the list that are marked as shown."""
        return page.evaluate(
            "[...document.querySelectorAll('#list [aria-current=true]')].map((one) => one.firstChild.textContent)"
        )

    def show_all_parts(self, page: Page) -> int:
        count = page.evaluate("galactic.parts.length")
        for number in range(count):
            page.evaluate(f"galactic.show(galactic.parts[{number}]).then(() => 1)")
            problem = page.evaluate(
                "document.getElementById('progress').hidden ? '' : document.getElementById('progress').textContent"
            )
            self.assertEqual(problem, "", f"part {number}")
        return count

    def count(self, page: Page, color: tuple[int, int, int]) -> int:
        _, _, rgb = page.pixels()
        wanted = bytes(color)
        return sum(rgb[n : n + 3] == wanted for n in range(0, len(rgb), 3))

    def test_all_parts_of_a_world_open(self):
        page = self.open("world", "", "scene 0")
        self.assertGreater(self.show_all_parts(page), 8)

    def test_the_mesh_has_the_colors_of_its_materials(self):
        page = self.open("world", "view=scene&shade=0&sliced=0&slice=1.2", "scene 0")
        self.assertGreater(self.count(page, TABLE), 1000)
        self.assertGreater(self.count(page, ROOM), 5000)
        # Cut off under the table top, it is not seen from above.
        page.evaluate("galactic.view.setHeight(0.3); galactic.stage.drawNow(); 1")
        self.assertLess(self.count(page, TABLE), 1000)

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

    def test_a_click_marks_what_a_sphere_reaches(self):
        page = self.open("world", "view=scene&radius=0.05&slice=0.4", "scene 0")
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

    def test_the_list_is_searched(self):
        page = self.open("world", "", "scene 0")
        page.key("/", "Slash", "/")
        page.call("Input.insertText", text="episode 1")
        names = page.evaluate(
            "[...document.querySelectorAll('#list li button')].map((one) => one.firstChild.textContent)"
        )
        self.assertEqual(names, ["Episode 1"])

    def test_the_list_marks_what_is_shown(self):
        page = self.open("world", "", "scene 0")
        self.assertEqual(self.marked(page), ["kitchen"])
        self.click(page, "#list li button", 1)
        page.shown("object 0")
        self.assertEqual(self.marked(page), ["bowl"])
        page.evaluate("galactic.show(galactic.parts.find((one) => one.kind === 'episode'))")
        page.shown("episode 0")
        page.evaluate("galactic.view.go(2).then(() => 1)")
        self.assertEqual(self.marked(page), ["Episode 2"])
        # Also when the list is made anew.
        page.evaluate("galactic.fillList('episode')")
        self.assertEqual(self.marked(page), ["Episode 2"])

    def test_the_view_has_the_keys_after_a_click(self):
        page = self.open("run", "env=0&t=10", "run 0")
        self.click(page, "#list li button", 0)
        page.key("ArrowRight")
        page.wait("galactic.view.frame === 11")
        # One step back and one step on.
        self.click(page, "#timeline .transport button", 1)
        page.wait("galactic.view.frame === 10")
        page.key("End")
        page.wait("galactic.view.frame === 60")
        page.key("Home")
        page.wait("galactic.view.frame === 0")
        # A box of the panel, too.
        self.click(page, "#panel label", 0)
        self.assertFalse(page.evaluate("galactic.view.home.shown.scene"))
        page.key(" ", "Space", " ")
        page.wait("galactic.view.timeline.playing")
        self.assertFalse(page.evaluate("galactic.view.home.shown.scene"))
        self.click(page, "#timeline .transport button", 0)
        page.wait("!galactic.view.timeline.playing")

    def test_a_button_that_was_reached_by_keyboard_keeps_space_and_enter(self):
        page = self.open("run", "env=0&t=10", "run 0")
        page.evaluate("document.querySelectorAll('#timeline .transport button')[2].focus()")
        page.key(" ", "Space", " ")
        page.wait("galactic.view.frame === 11")
        self.assertIsNone(page.evaluate("galactic.view.timeline.playing"))
        page.key("ArrowRight")
        page.wait("galactic.view.frame === 12")

    def test_keys_are_the_dialogs_while_it_is_open(self):
        page = self.open("run", "env=0&t=10", "run 0")
        self.click(page, "#help")
        page.key("ArrowRight")
        page.key("Enter", "Enter", "\r")
        page.wait("!document.getElementById('keys').open")
        self.assertEqual(page.evaluate("galactic.view.frame"), 10)

    def test_a_run_shows_the_poses_of_the_simulator(self):
        page = self.open("run", "env=1&t=0", "run 1")
        frames = json.loads((self.folder / "poses.json").read_text())
        self.assertEqual(len(frames), 61)
        for env in (0, 1):
            page.evaluate(f"galactic.view.chooseEnv({env}, 0).then(() => 1)")
            for number in range(0, len(frames), 3):
                shown = page.evaluate(
                    f"galactic.view.timeline.go({number}).then(() => ({{"
                    "links: galactic.view.home.robot.poses.map((one) => [...one.position.toArray(), ...one.rotation.toArray()]),"
                    "objects: galactic.view.home.objects.map((one) => [...one.group.position.toArray(), ...one.group.quaternion.toArray()]) }))"
                )
                self.expect_poses(shown["links"], frames[number][env]["links"], number)
                self.expect_poses(shown["objects"], frames[number][env]["objects"], number)

    def test_the_twin_of_an_env_is_shown_as_a_ghost(self):
        page = self.open("run", "env=0&t=0", "run 0")
        frames = json.loads((self.folder / "poses.json").read_text())
        page.evaluate(
            "(galactic.view.run.twins = [1, 0], galactic.view.run.names = ['here', 'there'],"
            " galactic.view.chooseEnv(0, 0).then(() => 1))"
        )
        for number in range(0, len(frames), 7):
            shown = page.evaluate(
                f"galactic.view.timeline.go({number}).then(() => ({{"
                "own: galactic.view.home.robot.poses.map((one) => [...one.position.toArray(), ...one.rotation.toArray()]),"
                "twin: galactic.view.ghost.robot.poses.map((one) => [...one.position.toArray(), ...one.rotation.toArray()]) }))"
            )
            self.expect_poses(shown["own"], frames[number][0]["links"], number)
            self.expect_poses(shown["twin"], frames[number][1]["links"], number)
        visible = "galactic.view.ghost.robot.group.visible"
        self.assertTrue(page.evaluate(visible))
        page.evaluate("galactic.view.ghost.setShown(false)")
        self.assertFalse(page.evaluate(visible))

    def test_nothing_stands_before_a_robot_that_is_followed(self):
        page = self.open("run", "env=0&t=0", "run 0")
        # From all around, low and high, inside the room and outside: what the mesh itself hides before and after.
        hidden = page.evaluate(
            """(() => {
              const { stage, view } = galactic;
              const { camera, controls, raycaster } = stage;
              const cut = view.cutHeight();
              const base = view.home.robot.poses[0].position;
              const aim = [0.6, 0.4, 0.2, 0.1].map((h) => base.clone().setY(base.y + h)).find((p) => view.sight.isFree(p));
              const isHidden = (from) => [[from, aim], [aim, from]].some(([a, b]) => {
                const way = b.clone().sub(a);
                raycaster.set(a, way.clone().normalize());
                raycaster.far = way.length() - 0.01;
                return raycaster.intersectObject(view.home.scene.mesh, true).some((hit) => hit.point.y < cut);
              });
              const counts = { places: 0, wanted: 0, shown: 0, moved: 0 };
              for (const distance of [2, 4, 8]) for (const rise of [0.1, 0.4, 0.8]) for (let n = 0; n < 12; ++n) {
                const turn = (n * Math.PI) / 6;
                camera.position.set(Math.cos(turn) * Math.cos(rise), Math.sin(rise), Math.sin(turn) * Math.cos(rise))
                  .multiplyScalar(distance).add(controls.target);
                const wanted = camera.position.clone();
                stage.drawNow();
                ++counts.places;
                counts.wanted += isHidden(wanted);
                counts.shown += isHidden(stage.seenFrom);
                counts.moved += stage.seenFrom.distanceTo(wanted) > 1e-6;
                if (camera.position.distanceTo(wanted) > 1e-9) throw new Error("the user's camera moved");
              }
              raycaster.far = Infinity;
              return counts;
            })()"""
        )
        self.assertEqual(hidden["places"], 108)
        self.assertGreater(hidden["wanted"], 11)
        self.assertLess(hidden["wanted"], 97)
        self.assertEqual(hidden["shown"], 0)
        self.assertGreater(hidden["places"] - hidden["moved"], 11, "what is seen is not moved")

    def test_the_first_picture_shows_the_whole_robot(self):
        page = self.open("run", "env=0&t=0", "run 0")
        # At all places of a run, what the mesh of the room hides of the robot's spheres.
        hidden = page.evaluate(
            """(async () => {
              const { stage, view } = galactic;
              const { raycaster } = stage;
              const counts = [];
              for (const env of [0, 1]) for (let frame = 0; frame <= 60; frame += 6) {
                await view.chooseEnv(env, frame);
                view.frameHome();
                stage.drawNow();
                const points = view.home.robot.clouds.flatMap((_, n) => view.home.robot.centersOf(n));
                const cut = view.cutHeight();
                counts.push(points.filter(({ center }) => {
                  const way = center.clone().sub(stage.seenFrom);
                  raycaster.set(stage.seenFrom, way.clone().normalize());
                  raycaster.far = way.length() - 0.01;
                  return raycaster.intersectObject(view.home.scene.mesh, true).some((hit) => hit.point.y < cut);
                }).length);
              }
              raycaster.far = Infinity;
              return counts;
            })()"""
        )
        self.assertEqual(hidden, [0] * 22)

    def expect_poses(self, shown: list, wanted: list, frame: int):
        self.assertEqual(len(shown), len(wanted))
        for a, b in zip(shown, wanted):
            sign = 1 if sum(p * q for p, q in zip(a[3:], b[3:])) >= 0 else -1
            difference = max(
                *(abs(p - q) for p, q in zip(a[:3], b[:3])),
                *(abs(p - sign * q) for p, q in zip(a[3:], b[3:])),
            )
            self.assertLess(difference, POSE_TOLERANCE, f"frame {frame}")

    def test_worlds_without_meshes_show_spheres_boxes_and_floors(self):
        page = self.open("bare", "", "run 0")
        seen = page.evaluate(
            "(() => { const { scene, robot, objects } = galactic.view.home;"
            "return [scene.mesh.children.some((one) => one.visible && one.geometry), robot.clouds[0].mesh.visible, objects[0].box.visible]; })()"
        )
        self.assertEqual(seen, [True, True, True])
        _, _, rgb = page.pixels()
        self.assertGreater(len({rgb[n : n + 3] for n in range(0, len(rgb), 300)}), 20)
        self.show_all_parts(page)

    def test_the_timeline_is_worked_with_keys(self):
        page = self.open("run", "env=0&t=10", "run 0")
        self.assertEqual(page.evaluate("galactic.view.frame"), 10)
        page.key("ArrowRight")
        page.key("ArrowRight")
        page.wait("galactic.view.frame === 12")
        page.wait("location.hash.includes('t=12')")
        page.key("End")
        page.wait("galactic.view.frame === 60")
        page.key("Home")
        page.wait("galactic.view.frame === 0")
        page.key(" ", "Space", " ")
        page.wait("galactic.view.frame > 3")
        page.key(" ", "Space", " ")
        self.assertIsNone(page.evaluate("galactic.view.timeline.playing"))

    def play(self, page: Page):
        page.evaluate("galactic.view.timeline.play()")
        page.wait("galactic.view.frame > 11")

    def expect_rest(self, page: Page, frame: int):
        """The run is at a frame, and stays there for longer than a frame takes to be drawn."""
        page.wait(f"galactic.view.frame === {frame}")
        drawn = page.evaluate("galactic.stage.frames")
        page.evaluate("galactic.stage.draw()")
        page.wait(f"galactic.stage.frames > {drawn}")
        page.evaluate("new Promise((done) => setTimeout(() => done(1), 300))")
        self.assertEqual(
            page.evaluate("[galactic.view.frame, galactic.view.timeline.playing]"), [frame, None]
        )

    def test_a_run_that_plays_goes_where_it_is_told(self):
        page = self.open("run", "env=0&t=10&speed=0.5", "run 0")
        for key, frame in (("Home", 0), ("End", 60)):
            page.evaluate("galactic.view.timeline.go(10).then(() => 1)")
            self.play(page)
            page.key(key)
            self.expect_rest(page, frame)
        page.evaluate("galactic.view.timeline.go(10).then(() => 1)")
        self.play(page)
        page.evaluate("(location.hash = '#env=1&t=42', 1)")
        self.expect_rest(page, 42)
        self.assertEqual(page.evaluate("galactic.view.env"), 1)
        page.wait("location.hash.includes('t=42')")
        # What is not there is as near as can be.
        page.evaluate("(location.hash = '#env=77&t=99999', 1)")
        self.expect_rest(page, 60)

    def test_a_run_that_is_paused_and_played_again_keeps_its_speed(self):
        page = self.open("run", "env=0&t=0&speed=0.25", "run 0")
        # Somebody is as fast as that while a frame is made ready.
        page.evaluate(
            "(() => { const { timeline } = galactic.view; const show = timeline.show.bind(timeline);"
            "timeline.show = async (frame) => { await show(frame); timeline.show = show; timeline.pause(); timeline.play(); };"
            "globalThis.between = 0; timeline.onBetween = () => { ++between; }; timeline.play(); })()"
        )
        page.wait("galactic.view.frame > 0 && between > 0")
        twice = page.evaluate(
            "new Promise((done) => { between = 0; let left = 10;"
            "const count = () => (left-- > 0 ? requestAnimationFrame(count) : done(between)); requestAnimationFrame(count); })"
        )
        self.assertLess(twice, 15, "a picture of a screen is made once")

    def test_a_run_stops_when_something_else_is_opened(self):
        for other in ("scene", "pack"):
            page = self.open("run", "env=0&t=10&speed=0.25", "run 0")
            self.play(page)
            page.evaluate(
                f"(globalThis.left = galactic.view, galactic.show(galactic.parts.find((one) => one.kind === '{other}')).then(() => 1))"
            )
            self.assertIsNone(page.evaluate("left.timeline.playing"), other)
            page.evaluate("galactic.show(galactic.parts[0]).then(() => 1)")
            self.assertIn("Its step", page.evaluate("document.getElementById('panel').innerText"))

    def test_marks_stay_on_the_track(self):
        page = self.open("run", "env=0&t=0", "run 0")
        marks = page.evaluate(
            "(() => { const { timeline, track } = galactic.view; const last = track.frameCount - 2;"
            "for (const [step, events] of [[0, 1], [last, 7]]) track.events[step] = events;"
            "track.endings[last] = 5; timeline.fillMarks();"
            "const area = timeline.marks.getBoundingClientRect();"
            "return [...timeline.marks.children].map((one) => { const { left, right } = one.getBoundingClientRect();"
            "return [one.title, left - area.left, area.right - right]; }); })()"
        )
        self.assertGreaterEqual(sum(title.startswith("Step 60:") for title, _, _ in marks), 4)
        for title, left, right in marks:
            # A glyph may be a little wider than its place.
            self.assertGreater(left, -2, title)
            self.assertGreater(right, -2, title)
        places = [left for _, left, _ in marks]
        self.assertEqual(places, sorted(places))
        self.assertEqual(len(set(places)), len(places))

    def test_an_env_that_has_played_its_share_is_idle(self):
        page = self.open("shares", "env=1&t=9", "run 1")
        facts = "document.getElementById('panel').innerText"
        clock = "document.querySelector('#timeline .clock').textContent"
        self.assertIn("Its step\t9", page.evaluate(facts))
        for frame in (10, 11, 20):
            page.evaluate(f"galactic.view.timeline.go({frame}).then(() => 1)")
            text = page.evaluate(facts)
            self.assertIn("idle: has played its share", text, frame)
            for word in ("Its step", "Target\t"):
                self.assertNotIn(word, text, frame)
            # What ended the episode is told where it ended.
            self.assertEqual("out of time" in text, frame == 10)
            self.assertEqual("Reward\t" in text, frame == 10)
            self.assertIn("idle", page.evaluate(clock))
            self.assertFalse(page.evaluate("galactic.view.home.task.visible"))
        page.evaluate("galactic.view.chooseEnv(0, 15).then(() => 1)")
        self.assertIn("Its step\t5", page.evaluate(facts))
        self.assertTrue(page.evaluate("galactic.view.home.task.visible"))

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

    def test_one_of_a_thing_is_not_many(self):
        page = self.open("run", "env=0&t=0", "run 0")
        said = page.evaluate(
            "[[60, 2], [1, 1]].map(([steps, envs]) => { const { run } = galactic.manifest;"
            "Object.assign(run, { steps, envs: run.envs.slice(0, envs) }); return galactic.subtitle(); })"
        )
        self.assertTrue(said[0].endswith("replay policy, 60 steps, 2 envs"), said)
        self.assertTrue(said[1].endswith("replay policy, 1 step, 1 env"), said)

    def test_an_address_names_an_episode_once(self):
        page = self.open("world", "view=episode&n=2", "episode 2")
        self.assertEqual(page.evaluate("galactic.view.number"), 2)
        page.key("ArrowRight")
        page.wait("location.hash.includes('n=3')")
        self.assertNotIn("episode=", page.evaluate("location.hash"))
        # What earlier pages wrote.
        for link in ("view=episode&episode=1", "view=episode&n=1&episode=1"):
            page = self.open("world", link, "episode 1")
            self.assertEqual(page.evaluate("galactic.view.number"), 1)
            page.wait("!location.hash.includes('episode=')")

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


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    for name in ("packs", "pack", "run"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("tests", nargs="*")
    parser.parse_args(namespace=OPTIONS)
    if not find_chromium():
        print("skipped: no Chromium found (Debian: chromium), pages are not tested in a browser")
        return SKIPPED
    result = unittest.main(argv=[sys.argv[0], "-v", *OPTIONS.tests], exit=False).result
    return 0 if result.wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(main())
