// Buttons, sliders and keys.

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4];
const find = (id) => document.getElementById(id);

export class Controls {
  /** @param stage may be null: no WebGL; @param changed called after every change. */
  constructor(clock, stage, changed) {
    this.clock = clock;
    this.changed = changed;
    this.play = find("play");
    this.scrub = find("scrub");
    this.scrub.max = clock.duration;
    this.play.addEventListener("click", () => this.do(() => clock.toggle()));
    this.scrub.addEventListener("input", () => this.do(() => clock.seek(this.scrub.valueAsNumber)));
    find("back").addEventListener("click", () => this.do(() => clock.step(-1)));
    find("forward").addEventListener("click", () => this.do(() => clock.step(1)));
    this.speed = find("speed");
    this.speed.addEventListener("change", () => this.setSpeed(Number(this.speed.value)));
    this.follow = find("follow");
    this.stage = stage;
    this.follow.addEventListener("click", () => this.setFollow(!stage.following));
    find("home").addEventListener("click", () => this.do(() => stage.home()));
    for (const box of document.querySelectorAll("[data-layer]")) {
      const apply = () => stage?.toggle(box.dataset.layer, box.checked);
      box.addEventListener("change", () => this.do(apply));
      apply();
    }
    find("layers").open = window.innerWidth > 860; // on a phone it would hide the character
    document.addEventListener("keydown", (event) => this.key(event));
  }

  do(action) {
    action();
    this.changed();
  }

  setSpeed(speed) {
    this.clock.speed = speed;
    this.speed.value = String(speed);
  }

  setFollow(following) {
    if (!this.stage) return;
    this.do(() => {
      this.stage.following = following;
      this.follow.setAttribute("aria-pressed", String(following));
      this.follow.textContent = following ? "Camera follows" : "Camera free";
    });
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { clock } = this;
    const on = event.target.tagName;
    // Space presses the button or ticks the box that has the focus; arrows choose in a list.
    if (on === "SELECT" || on === "SUMMARY") return;
    if (event.key === " " && (on === "BUTTON" || event.target.type === "checkbox")) return;
    const faster = (by) =>
      this.setSpeed(SPEEDS[Math.min(5, Math.max(0, SPEEDS.indexOf(clock.speed) + by))]);
    const actions = {
      " ": () => clock.toggle(),
      k: () => clock.toggle(),
      ArrowLeft: () => (event.shiftKey ? clock.seek(clock.time - 1) : clock.step(-1)),
      ArrowRight: () => (event.shiftKey ? clock.seek(clock.time + 1) : clock.step(1)),
      ArrowUp: () => faster(1),
      ArrowDown: () => faster(-1),
      Home: () => clock.seek(0),
      End: () => clock.seek(clock.duration),
      f: () => this.setFollow(!this.stage?.following),
      r: () => this.stage?.home(),
    };
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    this.do(action);
  }

  show() {
    const { clock } = this;
    this.scrub.value = String(clock.time);
    const now = `${clock.time.toFixed(2)} s`;
    this.scrub.setAttribute("aria-valuetext", `${now} of ${clock.duration.toFixed(2)} s`);
    find("now").textContent = `${now} / ${clock.duration.toFixed(1)} s`;
    const name = clock.playing ? "Pause" : "Play";
    if (this.play.getAttribute("aria-label") !== name) {
      this.play.setAttribute("aria-label", name);
      this.play.classList.toggle("playing", clock.playing);
    }
  }
}
