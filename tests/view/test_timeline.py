#!/usr/bin/env python3
"""The timeline of a run in a real browser: keys, playing, and the marks of what happened.

    test_timeline.py --packs PROGRAM --pack GALACTIC_PACK --run GALACTIC_RUN
"""

import json
import sys

from browser import Page
from page_case import PageCase, run_tests


class Timeline(PageCase):
    pages = ("run",)

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

    def test_who_goes_on_while_an_episode_is_unpacked_sees_where_he_is(self):
        page = self.open("run", "env=0&t=0", "run 0")
        frames = json.loads((self.folder / "poses.json").read_text())
        # Each object takes less long than the one before: what began last is there first.
        page.evaluate(
            "(() => { const { home } = galactic.view; const load = home.objectFigure.bind(home); let wait = 120;"
            "home.objectFigure = async (name) => { wait = Math.max(0, wait - 20);"
            "await new Promise((done) => setTimeout(done, wait)); return load(name); }; })()"
        )
        # Of different episodes, in both envs; the last one is where somebody stays.
        for ways, env, frame in (
            ("[30, 10, 55, 12].map((frame) => view.timeline.go(frame))", 0, 12),
            ("[view.timeline.go(30), view.chooseEnv(1, 5), view.chooseEnv(0, 31)]", 0, 31),
            ("[view.timeline.go(2), view.chooseEnv(1, 40)]", 1, 40),
        ):
            shown = page.evaluate(
                f"(async () => {{ const {{ view }} = galactic; await Promise.all({ways});"
                "const { home } = view; const places = home.objects.map((one) => one.group.position.toArray());"
                "return { places, episode: home.episode.number, wanted: view.track.episode(view.frame),"
                "figures: home.group.children.length, at: [view.env, view.frame], clock: view.timeline.clock.textContent }; })()"
            )
            self.assertEqual(shown["at"], [env, frame])
            self.assertIn(f"Step {frame} ", shown["clock"])
            self.assertEqual(shown["episode"], shown["wanted"])
            wanted = frames[frame][env]["objects"]
            self.assertEqual(len(shown["places"]), len(wanted))
            for place, pose in zip(shown["places"], wanted):
                for a, b in zip(place, pose):
                    self.assertAlmostEqual(a, b, delta=6e-4)
            # Robot, scene, task, and each object once.
            self.assertEqual(shown["figures"], 3 + len(wanted))

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


if __name__ == "__main__":
    sys.exit(run_tests(__doc__))
