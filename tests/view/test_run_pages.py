#!/usr/bin/env python3
"""Pages of runs in a real browser: what is seen of each env is what the simulator did.

    test_run_pages.py --packs PROGRAM --pack GALACTIC_PACK --run GALACTIC_RUN
"""

import json
import sys

from page_case import PageCase, run_tests

# Poses on pages are whole numbers of 0.1 mm and 1/32767, joints of 0.0001; the hand is 1 m away.
POSE_TOLERANCE = 6e-4


class RunPages(PageCase):
    pages = ("run", "bare", "shares")

    def expect_poses(self, shown: list, wanted: list, frame: int):
        self.assertEqual(len(shown), len(wanted))
        for a, b in zip(shown, wanted):
            sign = 1 if sum(p * q for p, q in zip(a[3:], b[3:])) >= 0 else -1
            difference = max(
                *(abs(p - q) for p, q in zip(a[:3], b[:3])),
                *(abs(p - sign * q) for p, q in zip(a[3:], b[3:])),
            )
            self.assertLess(difference, POSE_TOLERANCE, f"frame {frame}")

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

    def test_long_names_stay_within_the_panel(self):
        page = self.open("run", "env=0&t=0", "run 0")
        widths = page.evaluate(
            "(() => { const panel = document.getElementById('panel');"
            "const before = panel.scrollWidth;"
            "for (const cell of panel.querySelectorAll('td')) cell.textContent = 'ACE_Coffee_Mug_Kristen_16_oz_cup_'.repeat(4);"
            "return [before, panel.scrollWidth, panel.clientWidth]; })()"
        )
        self.assertEqual(widths, [widths[2]] * 3, "nothing is beside it")

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

    def test_a_ghost_is_where_the_two_worlds_differ(self):
        page = self.open("run", "env=0&t=0", "run 0")
        parts = (
            "(() => { const { ghost, home } = galactic.view;"
            "return ghost.parts.filter(({ reach }) => reach > 0).map(({ figure, link, reach }) => {"
            "const [a, b] = [ghost.robot.poses[link], home.robot.poses[link]];"
            "return [figure.visible, a.position.distanceTo(b.position), a.rotation.angleTo(b.rotation), reach]; }); })()"
        )
        # Env 0 is its own twin, then the other one is.
        counts = {True: 0, False: 0}
        for twin in (0, 1):
            page.evaluate(
                f"(galactic.view.run.twins = [{twin}, 0], galactic.view.chooseEnv(0, 0).then(() => 1))"
            )
            for frame in (0, 20, 40):
                page.evaluate(f"galactic.view.timeline.go({frame}).then(() => 1)")
                found = page.evaluate(parts)
                self.assertGreater(len(found), 1)
                for is_visible, away, angle, reach in found:
                    counts[is_visible] += 1
                    self.assertGreater(reach, 0.01)
                    if twin == 0:
                        self.assertFalse(is_visible)
                    elif away > 0.001:
                        self.assertTrue(is_visible)
        self.assertGreater(counts[True], 2)
        self.assertGreater(counts[False], 2)

    def test_a_ghost_moves_as_evenly_as_the_robot(self):
        page = self.open("run", "env=0&t=0", "run 0")
        page.evaluate(
            "(galactic.view.run.twins = [1, 0], galactic.view.chooseEnv(0, 3).then(() => 1))"
        )
        roots = page.evaluate(
            "(() => { const { view } = galactic; const { ghost } = view; view.showBetween(3, 0.25);"
            "const root = (figure) => figure.poses[0].position.toArray();"
            "return [[view.track, root(view.home.robot)], [ghost.track, root(ghost.robot)]]"
            ".map(([track, shown]) => [shown, track.root(3).position.lerp(track.root(4).position, 0.25).toArray()]); })()"
        )
        for shown, wanted in roots:
            for a, b in zip(shown, wanted):
                self.assertAlmostEqual(a, b, delta=1e-6)
        self.assertNotEqual(roots[0][0], roots[1][0])

    def test_a_ghost_stays_one_whatever_the_light(self):
        page = self.open("run", "env=0&t=0", "run 0")
        colors = page.evaluate(
            "(async () => { const { view, library } = galactic; view.run.twins = [1, 0]; await view.chooseEnv(0, 3);"
            "const looks = () => { const all = new Set(); view.ghost.robot.group.traverse((one) => { if (one.isMesh) all.add(one.material.opacity); }); return [...all]; };"
            "const found = [looks()]; for (const on of [false, true]) { library.setShaded(on); found.push(looks()); } return found; })()"
        )
        self.assertEqual(colors, [[0.5]] * 3)

    def test_a_continuous_joint_goes_the_shorter_way_between_frames(self):
        page = self.open("run", "env=0&t=3", "run 0")
        # Its angle is kept within a turn: from 3.1 to -3.1 rad are 0.08 rad.
        angles = page.evaluate(
            "(() => { const { view } = galactic; const { track } = view; const { robot } = view.home;"
            "const { position } = robot.robot.links.find((one) => one.type === 2); const joints = track.joints.bind(track);"
            "track.joints = (frame) => joints(frame).map((one, n) => (n === position ? (frame === 3 ? 3.1 : -3.1) : one));"
            "let shown; const setPose = robot.setPose.bind(robot);"
            "robot.setPose = (root, positions) => { shown = positions; setPose(root, positions); };"
            "const others = joints(3).map((one, n) => (one + joints(4)[n]) / 2); view.showBetween(3, 0.5);"
            "return [shown[position], shown.filter((_, n) => n !== position), others.filter((_, n) => n !== position)]; })()"
        )
        self.assertAlmostEqual(abs(angles[0]), 3.14159, delta=1e-4)
        for a, b in zip(angles[1], angles[2]):
            self.assertAlmostEqual(a, b, delta=1e-6)

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

    def test_one_of_a_thing_is_not_many(self):
        page = self.open("run", "env=0&t=0", "run 0")
        said = page.evaluate(
            "[[60, 2], [1, 1]].map(([steps, envs]) => { const { run } = galactic.manifest;"
            "Object.assign(run, { steps, envs: run.envs.slice(0, envs) }); return galactic.subtitle(); })"
        )
        self.assertTrue(said[0].endswith("replay policy, 60 steps, 2 envs"), said)
        self.assertTrue(said[1].endswith("replay policy, 1 step, 1 env"), said)


if __name__ == "__main__":
    sys.exit(run_tests(__doc__))
