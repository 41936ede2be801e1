// The time shown: it plays, stops at the end, and is moved.

export class Clock {
  /** @param frames the times [s] that arrow keys step through. */
  constructor(frames, duration) {
    this.frames = frames;
    this.duration = duration;
    this.time = 0;
    this.speed = 1;
    this.playing = false;
  }

  toggle() {
    this.playing = !this.playing;
    if (this.playing && this.time >= this.duration) this.time = 0;
  }

  seek(time) {
    this.time = Math.min(this.duration, Math.max(0, time));
  }

  /** Steps to the next (+1) or previous (-1) frame, and stops there. */
  step(direction) {
    this.playing = false;
    const found =
      direction > 0
        ? this.frames.find((time) => time > this.time + 1e-4)
        : this.frames.findLast((time) => time < this.time - 1e-4);
    if (found !== undefined) this.seek(found);
  }

  /** Lets real seconds pass; true if the time has moved. */
  pass(seconds) {
    if (!this.playing) return false;
    this.seek(this.time + seconds * this.speed);
    if (this.time >= this.duration) this.playing = false;
    return true;
  }
}
