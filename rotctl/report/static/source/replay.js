// The page: reads its data, builds the parts, and draws whenever something has changed.

import { Clock } from "./clock.js";
import { Controls } from "./controls.js";
import { whenChanged } from "./palette.js";
import { read } from "./payload.js";
import { Plots } from "./plots.js";
import { Stage } from "./stage.js";

function complain(text) {
  const note = document.getElementById("note");
  note.textContent = text;
  note.hidden = false;
}

function stageOrNone(canvas, data, changed) {
  try {
    return new Stage(canvas, data, changed);
  } catch (error) {
    complain(`This browser gives no WebGL, so there are plots only. (${error.message})`);
    return null;
  }
}

function start(data) {
  let dirty = true;
  const changed = () => {
    dirty = true;
  };
  const canvas = document.getElementById("stage");
  const clock = new Clock(data.runs[0].frames.time, data.duration);
  const stage = stageOrNone(canvas, data, changed);
  const plots = new Plots(document.getElementById("plots"), data.panels, data.duration, (time) => {
    clock.seek(time);
    changed();
  });
  const controls = new Controls(clock, stage, changed);

  const resize = () => {
    const { clientWidth: width, clientHeight: height } = canvas.parentElement;
    if (width && height) stage?.resize(width, height, window.devicePixelRatio || 1);
    plots.paint();
    changed();
  };
  new ResizeObserver(resize).observe(canvas.parentElement);
  new ResizeObserver(resize).observe(document.getElementById("plots"));
  whenChanged(resize);

  // replay.html#t=4.5 opens at 4.5 s.
  const seekToHash = () => {
    const asked = /^#t=(\d+(?:\.\d+)?)$/.exec(location.hash);
    if (asked) clock.seek(Number(asked[1]));
    changed();
  };
  window.addEventListener("hashchange", seekToHash);
  seekToHash();
  resize();

  let before = performance.now();
  const tick = (now) => {
    const moved = clock.pass(Math.min(0.25, (now - before) / 1000));
    before = now;
    if (moved || dirty) {
      dirty = false;
      stage?.show(clock.time);
      stage?.draw();
      plots.show(clock.time);
      controls.show();
      document.body.dataset.ready = "true";
    }
    requestAnimationFrame(tick);
  };
  requestAnimationFrame(tick);

  // For the browser's console and for tests.
  window.replay = {
    clock,
    stage,
    pose: () => stage?.figure.bodies.flatMap((body) => body.position.toArray()),
  };
}

read().then(start, (error) => complain(`This page is damaged: ${error.message}`));
