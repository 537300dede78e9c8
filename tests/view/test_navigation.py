#!/usr/bin/env python3
"""Ways through a page in a real browser: its list, its address, and whose the keys are.

    test_navigation.py --packs PROGRAM --pack GALACTIC_PACK --run GALACTIC_RUN
"""

import sys

from page_case import PageCase, run_tests


class Navigation(PageCase):
    pages = ("world", "run")

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

    def test_episodes_that_are_left_before_they_are_shown_leave_nothing(self):
        page = self.open("world", "view=episode&n=0", "episode 0")
        shown = page.evaluate(
            "(async () => { const { view } = galactic; const { home } = view; const load = home.objectFigure.bind(home); let wait = 100;"
            "home.objectFigure = async (name) => { wait = Math.max(0, wait - 20); await new Promise((done) => setTimeout(done, wait)); return load(name); };"
            "await Promise.all([view.go(1), view.go(3), view.setReach(true), view.setReach(false), view.go(2)]);"
            "return [home.episode.number, home.objects.length, home.episode.placements.length, home.group.children.length]; })()"
        )
        objects = shown[2]
        # Robot, scene, task, and each object once.
        self.assertEqual(shown, [2, objects, objects, 3 + objects])
        self.assertEqual(self.marked(page), ["Episode 2"])

    def test_a_link_into_an_open_run_leads_where_it_leads_in_a_new_page(self):
        look = (
            "(() => { const { view, library } = galactic; const { timeline } = view;"
            "return { at: [view.env, view.frame], camera: view.camera, speed: timeline.speed, shown: Number(timeline.speedChoice.value),"
            "curves: timeline.charts.map((one) => one.name).filter((name) => timeline.curves.charts.some((one) => one.name === name)),"
            "pressed: [...document.querySelectorAll('#timeline .transport [aria-pressed=true]')].map((one) => one.textContent),"
            "theme: document.documentElement.dataset.theme, shaded: [library.isShaded, galactic.shade.input.checked],"
            "own: galactic.stage.controls.enabled }; })()"
        )
        plain = self.open("run", "env=0&t=10", "run 0")
        before = plain.evaluate(look)
        self.assertEqual(before["curves"], ["Reward", "Distance"])
        self.assertEqual((before["camera"], before["speed"]), ("follow", 1))
        link = "env=1&t=20&camera=own&speed=3&curves=Contact,Actions&theme=dark&shade=0"
        fresh = self.open("run", link, "run 1").evaluate(look)
        self.assertEqual(fresh["at"], [1, 20])
        self.assertEqual(fresh["camera"], "own")
        self.assertFalse(fresh["own"])
        # The nearest that there is.
        self.assertEqual((fresh["speed"], fresh["shown"]), (4, 4))
        self.assertEqual(fresh["curves"], ["Contact", "Actions"])
        self.assertEqual(fresh["pressed"], fresh["curves"])
        self.assertEqual((fresh["theme"], fresh["shaded"]), ("dark", [False, False]))
        plain.evaluate(f"(location.hash = '#{link}', 1)")
        plain.wait("galactic.view.camera === 'own'")
        self.assertEqual(plain.evaluate(look), fresh)
        plain.evaluate("(location.hash = '#env=0&t=10', 1)")
        plain.wait("galactic.view.camera === 'follow'")
        self.assertEqual(plain.evaluate(look), before)

    def test_a_speed_that_is_none_is_the_usual_one(self):
        for speed in ("-2", "0", "fast"):
            page = self.open("run", f"env=0&t=10&speed={speed}", "run 0")
            self.assertEqual(page.evaluate("galactic.view.timeline.speed"), 1)
            page.evaluate("galactic.view.timeline.play()")
            page.wait("galactic.view.frame > 11")

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

    def test_letters_are_keys_with_caps_lock_too(self):
        page = self.open("run", "env=0&t=10&theme=light", "run 0")
        page.key("C", "KeyC", "C")
        page.wait("galactic.view.camera === 'own'")
        page.key("F", "KeyF", "F")
        page.wait("galactic.view.camera === 'follow'")
        page.key("D", "KeyD", "D")
        page.wait("document.documentElement.dataset.theme === 'dark'")

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

    def test_a_browser_without_webgl_shows_what_is_known(self):
        for name, fragment, shown, words in (
            ("world", "view=robot", "robot 0", "helper.pack"),
            ("run", "env=0", "run 0", "about the run"),
        ):
            page = self.browser.open(
                self.folder / f"{name}.html",
                "#" + fragment,
                before="HTMLCanvasElement.prototype.getContext = () => null;",
            )
            page.shown(shown)
            self.assertIn(
                "no WebGL 2", page.evaluate("document.getElementById('readout').textContent")
            )
            self.assertIn(
                words, page.evaluate("document.getElementById('panel').innerText").lower()
            )
            self.assertGreater(
                page.evaluate("document.querySelectorAll('#list li button').length"), 3
            )
            self.show_all_parts(page)
            page.key("d", "KeyD", "d")

    def test_a_picture_that_was_lost_is_drawn_again(self):
        page = self.open("world", "", "scene 0")
        page.evaluate("(galactic.stage.renderer.forceContextLoss(), 1)")
        page.wait("galactic.stage.renderer.getContext().isContextLost()")
        drawn = page.evaluate("galactic.stage.frames")
        page.evaluate("(galactic.stage.renderer.forceContextRestore(), 1)")
        page.wait(
            f"!galactic.stage.renderer.getContext().isContextLost() && galactic.stage.frames > {drawn}"
        )
        _, _, rgb = page.pixels()
        self.assertGreater(len({rgb[n : n + 3] for n in range(0, len(rgb), 300)}), 20)


if __name__ == "__main__":
    sys.exit(run_tests(__doc__))
