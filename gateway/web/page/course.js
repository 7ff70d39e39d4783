// The course of some values over the last ten minutes, a point a second; uPlot.
import uPlot from './vendor/uPlot.esm.js';

const kSeconds = 600;
const kColours = ['#d9480f', '#1971c2', '#2f9e44', '#9c36b5', '#e67700', '#0c8599'];
const kHeight = 180, kLeastWidth = 120;

export class Course {
  #times = [];
  #values = [];
  #labels = null;
  #plot = null;

  /// `top`: of the axis where no value is as high.
  constructor(element, top) {
    this.element = element;
    this.top = top;
    new ResizeObserver(() => this.#plot?.setSize(this.#size())).observe(element);
  }

  begin(labels) {
    this.#labels = labels;
    this.#times = [];
    this.#values = labels.map(() => []);
    this.recolour();
  }

  #size() {
    return { width: Math.max(this.element.clientWidth, kLeastWidth), height: kHeight };
  }

  recolour() {
    if (!this.#labels) return;
    this.#plot?.destroy();
    const style = getComputedStyle(document.documentElement);
    const text = style.getPropertyValue('--soft'), line = style.getPropertyValue('--line');
    const axis = { stroke: text, grid: { stroke: line, width: 1 }, ticks: { stroke: line } };
    this.#plot = new uPlot({
      ...this.#size(),
      legend: { show: false },
      cursor: { show: false },
      axes: [axis, { ...axis, size: 40 }],
      scales: { y: { range: (plot, min, max) => [0, Math.max(max ?? 0, this.top) * 1.1] } },
      series: [{}, ...this.#labels.map((label, i) => ({ label, stroke: kColours[i % kColours.length], width: 2, points: { show: false } }))],
    }, [this.#times, ...this.#values], this.element);
  }

  /// The element says how many points it shows.
  #draw() {
    this.element.dataset.points = this.#times.length;
    this.#plot?.setData([this.#times, ...this.#values]);
  }

  /// What was before: seconds ago, ascending to 0, and the values of each label.
  fill(ages, values) {
    const now = Math.floor(Date.now() / 1000);
    const first = this.#times[0] ?? Infinity;
    const times = ages.map((age) => now - Math.round(age));
    const old = [...times.keys()].filter((i) => times[i] < first && times[i] >= now - kSeconds && times[i] !== times[i + 1]);
    this.#times.unshift(...old.map((i) => times[i]));
    this.#values.forEach((course, label) => course.unshift(...old.map((i) => values[label][i] ?? null)));
    this.#draw();
  }

  /// A value for each label; null: not known.
  add(values) {
    const now = Math.floor(Date.now() / 1000);
    if (!this.#labels || this.#times.at(-1) === now) return;
    this.#times.push(now);
    this.#values.forEach((course, i) => course.push(values[i] ?? null));
    while (this.#times[0] < now - kSeconds) {
      this.#times.shift();
      for (const course of this.#values) course.shift();
    }
    this.#draw();
  }
}
