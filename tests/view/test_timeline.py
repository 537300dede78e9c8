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

    def marks(self, page: Page) -> list[dict]:
        """What stands on the track: where its middle is and ends are, in pixels of the track's width."""
        return page.evaluate(
            "(() => { const { marks } = galactic.view.timeline; const area = marks.marks.getBoundingClientRect();"
            "return [...marks.marks.children].map((one) => { const { left, right } = one.getBoundingClientRect();"
            "return { text: one.textContent, title: one.title, left: left - area.left, right: right - area.left, width: area.width }; }); })()"
        )

    def test_marks_stay_on_the_track(self):
        page = self.open("run", "env=0&t=0", "run 0")
        page.evaluate(
            "(() => { const { timeline, track } = galactic.view; const last = track.frameCount - 2; track.events.fill(0); track.endings.fill(0);"
            "for (const [step, events] of [[0, 1], [29, 1], [last, 7]]) track.events[step] = events;"
            "track.endings[last] = 5; timeline.marks.setTrack(track); })()"
        )
        first, middle, end = self.marks(page)
        self.assertEqual(
            [one["text"] for one in (first, middle, end)], ["▲", "▲", "▲▼↺✕"], "one for each moment"
        )
        self.assertEqual(middle["title"], "Step 30: grasped")
        self.assertEqual(len(end["title"].splitlines()), 4)
        self.assertAlmostEqual((middle["left"] + middle["right"]) / 2, middle["width"] / 2, delta=1)
        # A glyph may be a little wider than its place.
        self.assertGreater(first["left"], -2)
        self.assertGreater(2, end["right"] - end["width"])

    def test_marks_of_a_long_run_are_few_and_where_their_steps_are(self):
        page = self.open("run", "env=0&t=0", "run 0")
        page.evaluate(
            "(() => { const { marks } = galactic.view.timeline; const frameCount = 20001; const steps = frameCount - 1;"
            "const track = { frameCount, events: new Uint8Array(steps), endings: new Uint8Array(steps) };"
            # Thousands of them in the first half, and three, far from each other, in the second.
            "for (let n = 0; n < 10000; n += 3) track.events[n] = n % 2 ? 1 : 2;"
            "for (const n of [11999, 14999, 17999]) track.endings[n] = 1; marks.setTrack(track); })()"
        )
        marks = self.marks(page)
        self.assertLess(len(marks), 60)
        self.assertEqual([one["text"] for one in marks[-3:]], ["★"] * 3)
        for share, one in zip((0.6, 0.75, 0.9), marks[-3:]):
            self.assertAlmostEqual((one["left"] + one["right"]) / 2, share * one["width"], delta=1)
        for before, after in zip(marks, marks[1:]):
            self.assertLess(before["right"], after["left"] + 4)

    def test_a_mark_of_many_moments_lists_them(self):
        # Too narrow for one beside the other.
        page = self.open("run", "env=0&t=0", "run 0", (360, 520))
        page.evaluate(
            "(() => { const { timeline, track } = galactic.view; track.events.fill(0); track.endings.fill(0);"
            "for (const step of [29, 30]) track.events[step] = 1; timeline.marks.setTrack(track); })()"
        )
        self.assertEqual([one["text"] for one in self.marks(page)], ["▲2"])
        listed = "[...document.querySelectorAll('.moments button')].map((one) => one.textContent)"
        self.click(page, ".marks button", 0)
        self.assertEqual(page.evaluate(listed), ["Step 30: grasped", "Step 31: grasped"])
        self.assertFalse(page.evaluate("document.querySelector('.moments').hidden"))
        self.click(page, ".moments button", 1)
        page.wait("galactic.view.frame === 31")
        self.assertTrue(page.evaluate("document.querySelector('.moments').hidden"))

    def test_curves_are_drawn_once_and_the_cursor_each_time(self):
        page = self.open("run", "env=0&t=0", "run 0")
        drawn = page.evaluate(
            "(async () => { const { timeline } = galactic.view; const { curves } = timeline; let pictures = 0;"
            "const draw = curves.drawPicture.bind(curves); curves.drawPicture = (...all) => { ++pictures; draw(...all); };"
            "const look = () => curves.charts[0].canvas.toDataURL(); const shots = [];"
            "for (const frame of [5, 40, 5]) { await timeline.go(frame); shots.push(look()); }"
            "curves.draw(); shots.push(look()); return [pictures, shots[0] === shots[1], shots[0] === shots[2], shots[0] === shots[3]]; })()"
        )
        self.assertEqual(drawn[0], len(("Reward", "Distance")), "only what was asked for anew")
        self.assertEqual(drawn[1:], [False, True, True])

    def test_curves_have_numbers_beside_them_and_steps_below(self):
        page = self.open("run", "env=0&t=0", "run 0")
        charts = page.evaluate(
            "(() => { const { curves } = galactic.view.timeline; const { prototype } = CanvasRenderingContext2D; const { fillText } = prototype;"
            "const all = []; for (const chart of curves.charts) { const found = [];"
            "prototype.fillText = function (text, x, y) { found.push([text, x, y]); fillText.call(this, text, x, y); };"
            "curves.drawPicture(chart, getComputedStyle(document.documentElement));"
            "all.push({ found, least: chart.least, most: chart.most, width: chart.canvas.clientWidth }); }"
            "prototype.fillText = fillText; return all; })()"
        )
        for chart in charts:
            split = [text for text, *_ in chart["found"]].index("step")
            values = [(float(text), y) for text, _, y in chart["found"][:split]]
            steps = [(int(text), x) for text, x, _ in chart["found"][split + 1 :]]
            # Round, evenly spread, and the greater the higher.
            self.assertIn(len(values), range(2, 6))
            gaps = [b - a for (a, _), (b, _) in zip(values, values[1:])]
            for gap in gaps:
                self.assertAlmostEqual(gap, gaps[0], delta=1e-9)
                self.assertIn(f"{gap:e}"[0], "125")
            self.assertEqual([y for _, y in values], sorted((y for _, y in values), reverse=True))
            self.assertGreaterEqual(values[0][0], chart["least"] - 1e-9)
            self.assertLessEqual(values[-1][0], chart["most"] + 1e-9)
            # Of 60 steps.
            self.assertEqual([step for step, _ in steps], list(range(0, 61, 10)))
            for step, x in steps:
                self.assertAlmostEqual(x, 48 + step / 60 * (chart["width"] - 48), delta=1)
        # Marks stand over the steps, and a click leads to the step below the pointer.
        x, y, mark = page.evaluate(
            "(() => { const { timeline } = galactic.view; const { canvas } = timeline.curves.charts[0]; const area = canvas.getBoundingClientRect();"
            "const marks = timeline.marks.marks.getBoundingClientRect();"
            "return [area.left + timeline.curves.x(30, area.width), area.top + 20, marks.left + marks.width / 2]; })()"
        )
        self.assertAlmostEqual(x, mark, delta=0.5)
        page.click(x, y)
        page.wait("galactic.view.frame === 30")

    def test_ticks_are_round_at_all_sizes(self):
        page = self.open("run", "env=0&t=0", "run 0")
        for least, most, wanted in (
            (0, 1, ["0", "0.5", "1"]),
            (-1, 1, ["-1", "0", "1"]),
            (-0.3, 0.1, ["-0.2", "0"]),
            (-0.45, 0.45, ["-0.4", "0", "0.4"]),
            (-0.3, 0.3, ["-0.2", "0", "0.2"]),
            (-9.5, 9.5, ["-5", "0", "5"]),
            (-1.6, 1.6, ["-1", "0", "1"]),
            (0, 4.7e-4, ["0", "0.0002", "0.0004"]),
            (0, 123456, ["0", "50000", "100000"]),
        ):
            texts = page.evaluate(
                f"galactic.view.timeline.curves.ticks({least}, {most}).map((one) => one.text)"
            )
            self.assertEqual(texts, wanted)

    def test_sizes_that_change_while_a_page_is_laid_out_are_no_errors(self):
        page = self.open("run", "env=0&t=0", "run 0")
        drawn = page.evaluate(
            "(async () => { globalThis.problems = []; addEventListener('error', (event) => problems.push(event.message));"
            "const { stage, view: { timeline: { curves, marks } } } = galactic; const drawn = [];"
            "for (const [part, draw, element] of"
            " [[stage, 'resize', stage.canvas.parentElement], [marks, 'layOut', marks.marks], [curves, 'draw', curves.element]]) {"
            "  const before = part[draw].bind(part); let left = 1;"
            "  part[draw] = () => { drawn.push(draw); if (left-- > 0) element.style.width = 'calc(100% - 20px)'; before(); };"
            "  element.style.width = 'calc(100% - 10px)';"
            "  for (let left = 6; left > 0; --left) await new Promise(requestAnimationFrame); }"
            "return drawn; })()"
        )
        for draw in ("resize", "layOut", "draw"):
            self.assertGreaterEqual(drawn.count(draw), 2, "again in its new size")
        self.assertEqual(page.evaluate("problems"), [])

    def test_who_comes_back_to_a_run_that_waited_goes_on_where_he_was(self):
        page = self.open("run", "env=0&t=0", "run 0")
        # No picture was made for a minute.
        first = page.evaluate(
            "new Promise((done) => { const { timeline } = galactic.view; const show = timeline.show.bind(timeline);"
            "timeline.show = (frame) => { timeline.pause(); done(frame); return show(frame); };"
            "timeline.play(); timeline.playing.time -= 60000; })"
        )
        self.assertEqual(first, 5)


if __name__ == "__main__":
    sys.exit(run_tests(__doc__))
