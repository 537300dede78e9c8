// The page: what it holds on the left, the picture, options and numbers on the right, a timeline below.
import { address, addressNumber, onAddress, setAddress } from "./address.js";
import { PageData } from "./data.js";
import { button, checkbox, counted, el, heading, keyOf, megabytes, note, tree } from "./dom.js";
import { EpisodeView } from "./episode_view.js";
import { EpisodeList } from "./home.js";
import { MeshLibrary } from "./meshes.js";
import { ObjectView } from "./object_view.js";
import { Queue } from "./queue.js";
import { RobotView } from "./robot_view.js";
import { RunView } from "./run_view.js";
import { envName } from "./track.js";
import { SceneView } from "./scene_view.js";
import { BlankStage, Stage } from "./stage.js";

const kKeys = [
  ["Drag, wheel, right button", "turn, come closer, move; on a touch screen one, two and two fingers"],
  ["/", "search the list"], ["D", "light or dark"], ["?", "these keys"],
  ["Page up, Page down", "scene: move the slice (with shift: further)"],
  ["Left, right", "episodes: previous, next; run: a step (with shift: ten)"],
  ["Space", "run: play or pause"], ["Home, End", "run: begin, end"], ["+, −", "run: faster, slower"],
  ["F, C", "run: follow the robot, see with its camera"],
];

/// Without WebGL 2 there is none that draws.
function stageOn(canvas) {
  try {
    return new Stage(canvas);
  } catch (problem) {
    return new BlankStage(problem);
  }
}

class Page {
  constructor(manifest, data) {
    this.manifest = manifest;
    this.data = data;
    this.stage = stageOn(document.getElementById("canvas"));
    this.library = new MeshLibrary(data, manifest.textures, this.stage);
    this.scenes = new Map();
    this.objects = new Map();
    this.listeners = [];
    this.parts = [];
    this.openings = new Queue();
    for (const pack of manifest.packs) this.addPack(pack);
    this.makeParts();
  }

  addPack(pack) {
    if (pack.scene) this.scenes.set(pack.scene.name, pack);
    (pack.objects ?? []).forEach((one, number) => this.objects.set(one.name, { pack, number }));
    if (pack.robot) this.robotPack = pack;
    if (pack.episodes) this.episodePack = pack;
  }

  /// What can be shown: { kind, number, name, hint, pack, make }.
  makeParts() {
    const add = (kind, number, more) => this.parts.push({ kind, number, hint: "", ...more });
    const { run, packs } = this.manifest;
    (run?.envs ?? []).forEach((_, n) => add("run", n, { name: envName(run, n), make: () => new RunView(this, run) }));
    [...this.scenes.values()].forEach((pack, n) => add("scene", n, { name: pack.scene.name, pack, make: () => new SceneView(this, pack) }));
    [...this.objects.values()].forEach(({ pack, number }, n) => add("object", n, { name: pack.objects[number].name, pack, make: () => new ObjectView(this, pack, number) }));
    const { robotPack, episodePack, episodes } = this;
    if (robotPack) add("robot", 0, { name: robotPack.robot.name, pack: robotPack, make: () => new RobotView(this, robotPack) });
    for (let n = 0; n < (episodes?.count ?? 0); ++n) {
      add("episode", n, { name: `Episode ${episodes.which[n]}`, hint: episodes.titleOf(n), pack: episodePack, make: () => new EpisodeView(this, n) });
    }
    packs.forEach((pack, n) => add("pack", n, { name: pack.file, hint: `${pack.kind}, ${megabytes(pack.bytes)}`, pack }));
  }

  async open() {
    if (this.episodePack) {
      this.episodes = await EpisodeList.load(this.data, this.episodePack.episodes);
      this.parts = [];
      this.makeParts();
    }
    document.getElementById("title").textContent = this.manifest.title;
    document.title = this.manifest.title;
    document.getElementById("subtitle").textContent = this.subtitle();
    this.makeList();
    this.listenForKeys();
    await this.show(this.wantedPart());
  }

  /// Theme and shade are as the address says.
  applyAddress() {
    this.setTheme(themeOfAddress());
    this.library.setShaded(address.get("shade") !== "0");
    if (this.shade) this.shade.input.checked = this.library.isShaded;
  }

  /// A link into the page was followed: shows what it leads to.
  followAddress() {
    this.applyAddress();
    return this.openings.add(() => {
      const stays = this.view instanceof RunView && this.current.kind === "run" && !address.has("view");
      return stays ? this.view.applyAddress() : this.showNow(this.wantedPart());
    }).catch((problem) => this.fail(problem));
  }

  setTheme(theme) {
    setTheme(theme);
    this.stage.setTheme();
    this.view?.timeline?.curves?.draw();
  }

  toggleTheme() {
    const theme = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
    this.setTheme(theme);
    setAddress({ theme });
  }

  subtitle() {
    const { generator, run, packs } = this.manifest;
    if (run) return `${generator}: ${run.facts?.policy ?? "a"} policy, ${counted(run.steps, "step")}, ${counted(run.envs.length, "env")}`;
    return `${generator}: ${packs.length === 1 ? packs[0].kind : counted(packs.length, "pack")}, ${megabytes(packs.reduce((sum, one) => sum + one.bytes, 0))}`;
  }

  /// What the address asks for; without that, what there is to see first.
  wantedPart() {
    // Older pages wrote the number of an episode under a key of its own, too.
    const number = addressNumber("n", addressNumber("episode", 0));
    return this.parts.find((one) => one.kind === address.get("view") && one.number === number) ?? this.firstPart();
  }

  firstPart() {
    if (address.has("env")) {
      const run = this.parts.find((one) => one.kind === "run" && one.number === Number(address.get("env")));
      if (run) return run;
    }
    const order = ["run", "scene", "robot", "object", "episode", "pack"];
    return order.map((kind) => this.parts.find((one) => one.kind === kind)).find((one) => one);
  }

  /// What somebody chose in the list: the address's pose was that of another object.
  choose(part) {
    setAddress({ pose: null });
    this.show(part);
  }

  show(part) {
    return this.openings.add(() => this.showNow(part)).catch((problem) => this.fail(problem));
  }

  async showNow(part) {
    delete document.documentElement.dataset.shown;
    // With facts of a pack beside it, a view has lost its panel.
    const stays = this.current?.kind === part.kind;
    this.current = part;
    setAddress({ episode: null, ...(part.kind === "run" ? { view: null, n: null, env: part.number } : { view: part.kind, n: part.number }) });
    this.markList();
    closeDrawers();
    if (this.stage instanceof BlankStage) this.showWords(part);
    else if (part.kind === "pack") await this.showFacts(part);
    else if (stays && this.view instanceof RunView) await this.view.chooseEnv(part.number, this.view.frame);
    else if (stays && this.view instanceof EpisodeView) await this.view.go(part.number);
    else await this.showView(part);
    document.getElementById("progress").hidden = true;
    this.stage.drawNow();
    document.documentElement.dataset.shown = `${part.kind} ${part.number}`;
  }

  async showView(part) {
    await this.view?.close?.();
    for (const [target, name, handler] of this.listeners.splice(0)) target.removeEventListener(name, handler);
    this.stage.clear();
    this.readout("");
    document.getElementById("timeline").hidden = true;
    const progress = document.getElementById("progress");
    this.data.wanted = this.data.done = 0;
    progress.hidden = false;
    this.view = part.make();
    await this.view.open();
  }

  /// What is written about a pack, in place of options. The picture stays; where there is none yet,
  /// it is of what the pack holds.
  async showFacts({ pack }) {
    this.view?.pause?.();
    if (!this.view) await this.showPicture(pack);
    this.fillPanel(wordsAbout(pack));
  }

  /// What can be told of a part where nothing can be drawn.
  showWords({ pack }) {
    this.readout(`This browser offers no WebGL 2, so that nothing can be drawn: ${this.stage.problem.message}. `
      + "Switch on its hardware acceleration, or open the page in another one. What is known stands in the panel.");
    const { run } = this.manifest;
    this.fillPanel(pack ? wordsAbout(pack) : [heading("About the run"), run.facts ? tree(run.facts, "facts") : note(this.subtitle())]);
  }

  async showPicture(pack) {
    const part = this.parts.find((one) => one.pack === pack && one.make);
    if (part) await this.showView(part);
    else this.readout("Nothing in this pack can be drawn: what is known about it stands in the panel.");
  }

  fail(problem) {
    const status = document.getElementById("progress");
    status.hidden = false;
    status.querySelector("span").textContent = `This part cannot be shown: ${problem.message}`;
    console.error(problem);
  }

  /// For views: forgotten when another one opens.
  on(target, name, handler) {
    target.addEventListener(name, handler);
    this.listeners.push([target, name, handler]);
  }

  fillPanel(children) {
    document.getElementById("panel").replaceChildren(...children.filter((child) => child));
  }

  readout(text) { document.getElementById("readout").textContent = text; }

  shadeBox() {
    this.shade = checkbox("Light and shade", this.library.isShaded, (on) => {
      setAddress({ shade: on ? null : 0 });
      this.library.setShaded(on);
    });
    return this.shade;
  }

  makeList() {
    const search = el("input", { type: "search", placeholder: "Search", "aria-label": "Search the list" });
    this.lists = el("div");
    search.addEventListener("input", () => this.fillList(search.value));
    document.getElementById("list").replaceChildren(search, this.lists);
    this.fillList("");
  }

  fillList(text) {
    const names = { run: "Run", scene: "Scenes", object: "Objects", robot: "Robot", episode: "Episodes", pack: "Packs" };
    const words = text.toLowerCase().split(/\s+/).filter((word) => word);
    const most = 300;
    const sections = [];
    this.listed = new Map();
    for (const [kind, title] of Object.entries(names)) {
      const all = this.parts.filter((one) => one.kind === kind);
      const fitting = all.filter((one) => words.every((word) => `${one.name} ${one.hint}`.toLowerCase().includes(word)));
      if (fitting.length === 0) continue;
      const items = fitting.slice(0, most).map((one) => {
        const item = button(one.name, () => this.choose(one));
        this.listed.set(item, one);
        if (one.hint) item.append(el("small", {}, one.hint));
        return el("li", {}, item);
      });
      sections.push(heading(fitting.length > 1 ? `${title} (${fitting.length})` : title), el("ul", {}, ...items));
      if (fitting.length > most) sections.push(note(`${fitting.length - most} more: search for them`));
    }
    this.lists.replaceChildren(...(sections.length > 0 ? sections : [el("div", { className: "none" }, "Nothing of this name")]));
    this.markList();
  }

  markList() {
    for (const [item, part] of this.listed) {
      if (part === this.current) item.setAttribute("aria-current", "true");
      else item.removeAttribute("aria-current");
    }
  }

  /// A view went on to another of its kind by itself.
  listPart(kind, number) {
    if (this.current.kind !== kind) return;
    this.current = this.parts.find((one) => one.kind === kind && one.number === number) ?? this.current;
    if (kind === "episode") setAddress({ n: number });
    this.markList();
  }

  listenForKeys() {
    addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (keepsKey(event.target, event.key) || document.getElementById("keys").open) return;
      const own = { "/": () => document.querySelector("#list input").focus(), "?": showKeys, d: () => this.toggleTheme() }[keyOf(event)];
      if (own) own();
      else if (this.current.kind === "pack" || !this.view?.key?.(event)) return;
      event.preventDefault();
    });
  }
}

function wordsAbout(pack) {
  const facts = pack.facts ? Object.entries(pack.facts).map(([key, value]) => tree(value, key)) : [note("The page was written without more about this pack.")];
  return [heading(pack.file), note(`${pack.kind}, ${megabytes(pack.bytes)}`), ...facts];
}

const kSwitches = "button, summary, input[type=checkbox], input[type=radio]";

/// Whether a focused control works with a key itself.
function keepsKey(control, key) {
  if (control.matches("input[type=search], select, textarea")) return true;
  if (control.matches("input[type=range], input[type=radio]") && /^(Arrow|Page|Home|End)/.test(key)) return true;
  return control.matches(kSwitches) && [" ", "Enter"].includes(key);
}

/// What somebody works with a pointer does not keep the keys: they are the view's again.
function releaseAfterPointer() {
  let isPointer = false;
  addEventListener("pointerdown", () => { isPointer = true; }, true);
  addEventListener("keydown", () => { isPointer = false; }, true);
  const release = (control) => { if (isPointer && control === document.activeElement) control?.blur(); };
  addEventListener("click", (event) => release(event.target.closest(kSwitches)), true);
  addEventListener("change", (event) => release(event.target.closest("select")), true);
}

function closeDrawers() {
  for (const id of ["list", "panel"]) {
    document.getElementById(id).classList.remove("open");
    document.getElementById(`show-${id}`).setAttribute("aria-expanded", "false");
  }
}

function makeDrawers() {
  for (const id of ["list", "panel"]) {
    document.getElementById(`show-${id}`).addEventListener("click", (event) => {
      const isOpen = document.getElementById(id).classList.contains("open");
      closeDrawers();
      document.getElementById(id).classList.toggle("open", !isOpen);
      event.target.setAttribute("aria-expanded", String(!isOpen));
    });
  }
}

function showKeys() {
  const dialog = document.getElementById("keys");
  dialog.replaceChildren(el("h2", {}, "Keys"), el("table", {}, ...kKeys.map(([key, what]) => el("tr", {}, el("td", {}, el("kbd", {}, key)), el("td", {}, what)))),
    el("div", { className: "buttons" }, button("Close", () => dialog.close())));
  dialog.showModal();
}

function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
}

function themeOfAddress() {
  const isDark = matchMedia("(prefers-color-scheme: dark)").matches;
  return ["light", "dark"].find((theme) => theme === address.get("theme")) ?? (isDark ? "dark" : "light");
}

async function main() {
  setTheme(themeOfAddress());
  makeDrawers();
  releaseAfterPointer();
  const status = document.getElementById("progress");
  try {
    const data = new PageData(document.querySelectorAll("script.chunk"));
    data.onProgress = (share) => { status.querySelector("progress").value = share; };
    const page = new Page(await data.manifest(), data);
    // For scripts, as tests are.
    globalThis.galactic = page;
    page.applyAddress();
    document.getElementById("help").addEventListener("click", showKeys);
    document.getElementById("theme").addEventListener("click", () => page.toggleTheme());
    onAddress(() => page.followAddress());
    await page.open();
  } catch (problem) {
    status.querySelector("progress").remove();
    status.querySelector("span").textContent = `The page cannot be opened: ${problem.message}`;
    console.error(problem);
  }
}

main();
