// SPDX-License-Identifier: GPL-3.0-or-later

/**
 * The time of the page. While audio runs its clock is the time; without it the clock of the browser
 * is. Events: `time` (drawn time changed), `state` (playing, rate, loop or mute changed), `refused`
 * (the browser does not let the audio start; playback goes on in silence).
 */
export class Transport extends EventTarget {
  /**
   * @param {number} duration seconds
   * @param {number} fps frames per second, the step of `step`
   * @param {import('./sound.js').Sound | null} sound
   */
  constructor(duration, fps, sound) {
    super();
    Object.assign(this, { duration, fps, sound, time: 0, playing: false, rate: 1, loop: false, muted: false });
    this.last_ms = 0;
  }

  emit(name) { this.dispatchEvent(new Event(name)); }

  setTime(time) {
    this.time = Math.min(Math.max(time, 0), this.duration);
    this.emit('time');
  }

  startSound() {
    this.sound?.play(this.time, this.rate).catch((error) => {
      if (error.name !== 'AbortError') this.emit('refused');
    });
  }

  play() {
    if (this.playing) return;
    if (this.time >= this.duration) this.setTime(0);
    this.playing = true;
    this.last_ms = performance.now();
    this.startSound();
    this.emit('state');
  }

  pause() {
    if (!this.playing) return;
    this.playing = false;
    this.sound?.pause();
    this.emit('state');
  }

  toggle() { this.playing ? this.pause() : this.play(); }

  /** Sets the time; playback stops. */
  seek(time) {
    this.pause();
    this.setTime(time);
  }

  /** Sets the time; playback goes on from there. */
  jump(time) {
    const resume = this.playing;
    this.seek(time);
    if (resume) this.play();
  }

  /** Goes to the frame `frames` away from the nearest one. */
  step(frames) { this.seek((Math.round(this.time * this.fps) + frames) / this.fps); }

  setRate(rate) {
    this.rate = rate;
    if (this.sound) this.sound.rate = rate;
    this.emit('state');
  }

  setLoop(loop) {
    this.loop = loop;
    this.emit('state');
  }

  setMuted(muted) {
    this.muted = muted;
    if (this.sound) this.sound.muted = muted;
    this.emit('state');
  }

  /** Moves the time on; once for each drawn frame. */
  tick(now_ms) {
    if (!this.playing) return;
    const passed_s = Math.max(0, now_ms - this.last_ms) / 1000;
    this.last_ms = now_ms;
    const time = this.sound?.running ? this.sound.time : this.time + passed_s * this.rate;
    if (time < this.duration) {
      this.setTime(time);
    } else if (this.loop) {
      this.sound?.pause();
      this.setTime(0);
      this.startSound();
    } else {
      this.seek(this.duration);
    }
  }
}
