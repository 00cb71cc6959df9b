// Slider and play button over the steps: `Timeline`.

const PLAY_INTERVAL_MS = 250;

class Timeline {
  /** `onStep(index)` shows a step, and may return a promise that is waited for before the next. */
  constructor(steps, onStep) {
    Object.assign(this, { steps, onStep, index: steps.length - 1, playing: false });
    this.slider = byId("step");
    this.button = byId("play");
    this.slider.max = steps.length - 1;
    this.slider.addEventListener("input", () => { this.stop(); this.go(Number(this.slider.value)); });
    this.button.addEventListener("click", () => this.toggle());
    this.button.disabled = this.slider.disabled = steps.length < 2;
  }

  label(step) {
    const parts = [`step ${step.step}`];
    if (step.cycles !== null) parts.push(`${number(step.cycles, 4)} cycles`);
    if (step.load_factor !== null && step.load_factor !== 1) parts.push(`load × ${number(step.load_factor, 4)}`);
    return parts.join(" · ");
  }

  go(index) {
    this.index = Math.min(Math.max(index, 0), this.steps.length - 1);
    const text = this.label(this.steps[this.index]);
    this.slider.value = this.index;
    this.slider.setAttribute("aria-valuetext", text);
    byId("step-label").textContent = text;
    return this.onStep(this.index);
  }

  toggle() {
    if (this.playing) this.stop();
    else this.play();
  }

  async play() {
    if (this.steps.length < 2) return;
    this.setPlaying(true);
    if (this.index === this.steps.length - 1) await this.go(0);
    while (this.playing && this.index < this.steps.length - 1) {
      const pause = new Promise((done) => setTimeout(done, PLAY_INTERVAL_MS));
      await pause;
      if (this.playing) await this.go(this.index + 1);
    }
    this.setPlaying(false);
  }

  stop() {
    this.setPlaying(false);
  }

  setPlaying(playing) {
    this.playing = playing;
    this.button.setAttribute("aria-label", playing ? "Pause" : "Play");
    this.button.firstElementChild.textContent = playing ? "❚❚" : "▶";
  }
}
