// Plots over time with one cursor; a press on a plot moves the time there.

import { rowAt } from "./payload.js";

const LEFT = 44; // [px] room for the numbers of the y axis
const BOTTOM = 16;
const TOP = 5;
const RIGHT = 8;

const make = (tag, className, text) => {
  const element = document.createElement(tag);
  if (className) element.className = className;
  if (text !== undefined) element.textContent = text;
  return element;
};

/** Round numbers between two limits. */
export function ticks(low, high, most) {
  const raw = (high - low) / most || 1;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((size) => size >= raw - 1e-12);
  const found = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i += 1) {
    found.push(Number((i * step).toPrecision(12)));
  }
  return found;
}

const written = (value, digits) =>
  Number.isFinite(value) ? value.toFixed(digits).replace("-", "−") : "–";

/** The value of a series at a time [s], between its rows. */
function valueAt({ time: times, values, steps }, time) {
  const row = rowAt(times, time);
  if (steps || row + 1 >= times.length || time <= times[row]) return values[row];
  const part = (time - times[row]) / (times[row + 1] - times[row]);
  return values[row] + part * (values[row + 1] - values[row]);
}

class Plot {
  constructor(panel, duration, seek) {
    this.panel = panel;
    this.duration = duration;
    this.element = make("figure", "plot");
    const caption = make("figcaption");
    const heading = make("strong", "", panel.title);
    caption.append(heading, make("span", "unit", `[${panel.unit}]`));
    this.readings = panel.series.map((series) => {
      const key = make("span", `key ${series.role}`);
      const reading = make("output");
      key.append(make("i"), make("span", "", series.name), reading);
      caption.append(key);
      return reading;
    });
    this.canvas = make("canvas");
    this.canvas.setAttribute("role", "img");
    const names = panel.series.map((series) => series.name).join(", ");
    this.canvas.setAttribute("aria-label", `${panel.title} in ${panel.unit} over time: ${names}`);
    this.cursor = make("div", "cursor");
    this.chart = make("div", "chart");
    this.chart.append(this.canvas, this.cursor);
    this.element.append(caption, this.chart);
    this._listen(seek);
  }

  _listen(seek) {
    const moved = (event) => {
      const { left, width } = this.chart.getBoundingClientRect();
      const part = (event.clientX - left - LEFT) / (width - LEFT - RIGHT);
      seek(Math.min(1, Math.max(0, part)) * this.duration);
    };
    this.chart.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      if (event.pointerType !== "touch") this.chart.setPointerCapture(event.pointerId);
      moved(event);
    });
    this.chart.addEventListener("pointermove", (event) => {
      if (this.chart.hasPointerCapture(event.pointerId)) moved(event);
    });
  }

  /** Draws all but the cursor. */
  paint() {
    const { clientWidth: width, clientHeight: height } = this.chart;
    const ratio = window.devicePixelRatio || 1;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    const pen = this.canvas.getContext("2d");
    pen.scale(ratio, ratio);
    const style = getComputedStyle(this.element);
    const ink = (name) => style.getPropertyValue(`--${name}`);
    const [low, high] = this.panel.limits;
    const x = (time) => LEFT + (time / this.duration) * (width - LEFT - RIGHT);
    const y = (value) => TOP + ((high - value) / (high - low)) * (height - TOP - BOTTOM);

    pen.font = "11px system-ui, sans-serif";
    pen.lineWidth = 1;
    pen.fillStyle = ink("soft");
    pen.strokeStyle = ink("grid");
    pen.textBaseline = "middle";
    pen.textAlign = "right";
    for (const value of ticks(low, high, Math.max(2, height / 32))) {
      const at = Math.round(y(value)) + 0.5;
      pen.beginPath();
      pen.moveTo(LEFT, at);
      pen.lineTo(width - RIGHT, at);
      pen.stroke();
      pen.fillText(String(value).replace("-", "−"), LEFT - 6, at);
    }
    pen.textBaseline = "top";
    for (const time of ticks(0, this.duration, Math.max(2, width / 80))) {
      pen.textAlign = time === 0 ? "left" : "center";
      const label = time === 0 ? "0 s" : String(time);
      if (x(time) < width - RIGHT - 4) pen.fillText(label, x(time), height - BOTTOM + 3);
    }

    pen.save();
    pen.beginPath();
    pen.rect(LEFT, TOP - 2, width - LEFT - RIGHT, height - TOP - BOTTOM + 4);
    pen.clip();
    pen.lineJoin = "round";
    for (const { role, time, values, steps } of this.panel.series) {
      pen.strokeStyle = ink(role);
      pen.lineWidth = role === "commanded" ? 1.6 : 1.4;
      pen.setLineDash({ commanded: [6, 4], ghost: [3, 3] }[role] ?? []);
      pen.beginPath();
      let begun = false;
      for (let i = 0; i < time.length; i += 1) {
        if (!Number.isFinite(values[i])) {
          begun = false;
        } else if (!begun) {
          pen.moveTo(x(time[i]), y(values[i]));
          begun = true;
        } else {
          if (steps) pen.lineTo(x(time[i]), y(values[i - 1]));
          pen.lineTo(x(time[i]), y(values[i]));
        }
      }
      pen.stroke();
    }
    pen.restore();
    this.x = x;
  }

  show(time) {
    if (!this.x) return;
    this.cursor.style.transform = `translateX(${this.x(time).toFixed(1)}px)`;
    this.panel.series.forEach((series, i) => {
      this.readings[i].textContent = written(valueAt(series, time + 1e-6), series.steps ? 0 : 2);
    });
  }
}

export class Plots {
  /** @param seek called with a time [s] that was pressed on. */
  constructor(element, panels, duration, seek) {
    this.plots = panels.map((panel) => new Plot(panel, duration, seek));
    element.append(...this.plots.map((plot) => plot.element));
  }

  paint() {
    this.plots.forEach((plot) => plot.paint());
  }

  show(time) {
    this.plots.forEach((plot) => plot.show(time));
  }
}
